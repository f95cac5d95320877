//! Whatever dies, the others end, and somebody says why.

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::Arc;
use std::thread::sleep;
use std::time::{Duration, Instant};

use host_sim::chip::{ChipError, Machine, Swarm};
use host_sim::planners::PlannerKind::{self, Explorer};
use host_sim::run::Options;
use host_sim::scenario::MediumKind::Radio;
use host_sim::world::World;
use planner_core::Extent;

use crate::explorations::scenario;
use crate::image;

/// Many times what any of it takes.
const SOON: Duration = Duration::from_secs(30);

/// Two robots in an open square.
fn failure(swarm: Swarm, side: u16, planner: PlannerKind) -> ChipError {
    let world = World::from_fn("open", Extent::new(side, side), |_| false).unwrap();
    let scenario = scenario(&Arc::new(world), planner, 2, Radio, 0.0, false);
    swarm.explore(&scenario, Options::default()).unwrap();
    swarm.finish().unwrap_err()
}

fn assert_says(error: &ChipError, what: &str) {
    assert!(error.to_string().contains(what), "{error}");
}

#[test]
#[ignore = "needs QEMU and the images: cargo xtask test --only loop"]
fn a_chip_that_cannot_go_on_ends_the_run_with_a_reason() {
    let swarm = |name| Swarm::new(Machine::Netduinoplus2, image(Machine::Netduinoplus2, name));
    let error = failure(swarm("robot"), 129, Explorer);
    assert_says(&error, "does not fit a map compiled for 128×128");
    let error = failure(swarm("robot"), 9, PlannerKind::Greedy);
    assert_says(&error, "no chip has");
    let error = failure(swarm("no-such-image"), 9, Explorer);
    assert_says(&error, "cargo xtask build-firmware");
    // It speaks to people only.
    let error = failure(swarm("firmware"), 9, Explorer);
    assert_says(&error, "do not understand each other");
    // It faults at once.
    let error = failure(swarm("examples/stack-overflow"), 9, Explorer);
    assert_says(&error, "ended (exit status: 1)");
    assert_says(&error, "the stack overflowed");
}

#[test]
#[ignore = "needs QEMU and the images: cargo xtask test --only loop"]
fn a_chip_that_hangs_is_not_waited_for_for_ever() {
    let image = image(Machine::Netduinoplus2, "examples/hangs");
    let limit = Duration::from_secs(1);
    let swarm = Swarm::new(Machine::Netduinoplus2, image).patient_for(limit);
    let begin = Instant::now();
    let error = failure(swarm, 9, Explorer);
    assert_says(&error, "has not answered within 1 s");
    assert!(begin.elapsed() < SOON);
}

/// The command, with two robots on a map that takes it a while.
fn command(out: &Path) -> Command {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_host-sim"));
    command
        .current_dir(root)
        .args(["firmware", "fixtures/maps/office.png", "--robots", "2"])
        .arg("--image")
        .arg(image(Machine::Netduinoplus2, "robot"))
        .arg("--out")
        .arg(out.join("run"))
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped());
    command
}

/// The processes that a process has started, and that still run.
fn children(parent: u32) -> Vec<u32> {
    let processes = fs::read_dir("/proc").unwrap().flatten();
    let ids = processes.filter_map(|entry| entry.file_name().to_str()?.parse().ok());
    ids.filter(|id: &u32| {
        // "id (name) state parent …"; one that has ended is a zombie, Z.
        let stat = fs::read_to_string(format!("/proc/{id}/stat")).unwrap_or_default();
        let mut fields = stat.rsplit(") ").next().unwrap_or_default().split(' ');
        fields.next() != Some("Z") && fields.next() == Some(&parent.to_string())
    })
    .collect()
}

fn kill(process: u32) {
    let status = Command::new("kill")
        .args(["-KILL", &process.to_string()])
        .status();
    assert!(status.unwrap().success());
}

fn wait_until(what: &str, mut holds: impl FnMut() -> bool) {
    let begin = Instant::now();
    while !holds() {
        assert!(begin.elapsed() < SOON, "waited in vain: {what}");
        sleep(Duration::from_millis(10));
    }
}

/// Starts the command and returns its chips when they are at work.
fn start(command: &mut Command) -> (Child, Vec<u32>) {
    let host = command.spawn().unwrap();
    wait_until("two chips start", || children(host.id()).len() == 2);
    let chips = children(host.id());
    sleep(Duration::from_millis(200));
    (host, chips)
}

#[test]
#[ignore = "needs QEMU and the images: cargo xtask test --only loop"]
fn a_killed_chip_ends_the_run_with_a_reason() {
    let out = tempfile::tempdir().unwrap();
    let (host, chips) = start(&mut command(out.path()));
    kill(chips[1]);
    let output = host.wait_with_output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(!output.status.success(), "{message}");
    assert!(
        message.contains("the chip of robot 1 ended (signal: 9 (SIGKILL))"),
        "{message}"
    );
    assert!(
        !Path::new(&format!("/proc/{}", chips[0])).exists(),
        "the other chip still runs"
    );
}

#[test]
#[ignore = "needs QEMU and the images: cargo xtask test --only loop"]
fn chips_end_when_the_simulator_is_killed() {
    let out = tempfile::tempdir().unwrap();
    let (mut host, chips) = start(&mut command(out.path()));
    kill(host.id());
    let mut stderr = host.stderr.take().unwrap();
    host.wait().unwrap();
    for chip in chips {
        wait_until("a chip ends", || {
            let stat = fs::read_to_string(format!("/proc/{chip}/stat"));
            stat.is_err() || stat.is_ok_and(|stat| stat.contains(") Z "))
        });
    }
    let mut said = String::new();
    std::io::Read::read_to_string(&mut stderr, &mut said).unwrap();
    assert_eq!(said, "");
}

#[test]
#[ignore = "needs QEMU and the images: cargo xtask test --only loop"]
fn without_an_emulator_the_command_says_how_to_install_it() {
    let out = tempfile::tempdir().unwrap();
    let output = command(out.path()).env("PATH", "").output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(!output.status.success(), "{message}");
    assert!(
        message.contains("sudo apt-get install --no-install-recommends qemu-system-arm"),
        "{message}"
    );
    assert!(!message.contains("panicked"), "{message}");
}
