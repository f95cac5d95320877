//! Robots as processes that talk by UDP, one of which is killed on the way.

use std::io::{BufRead, BufReader, Read};
use std::net::{SocketAddr, UdpSocket};
use std::process::{Child, ChildStdout, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

use assert_cmd::cargo::cargo_bin;
use host_sim::live::{RobotReport, WorldReport};

const ROBOTS: u8 = 3;
/// No line of the world takes longer than this to come.
const PATIENCE: Duration = Duration::from_secs(30);

/// A process that does not outlive its test.
struct Process(Child);

impl Process {
    fn start(arguments: &[String]) -> Self {
        let mut command = Command::new(cargo_bin("host-sim"));
        command.args(arguments).stdout(Stdio::piped());
        Self(command.spawn().unwrap())
    }

    fn stdout(&mut self) -> ChildStdout {
        self.0.stdout.take().unwrap()
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn words(line: &str) -> Vec<String> {
    line.split_whitespace().map(str::to_owned).collect()
}

/// The lines of a process as they come.
fn lines(from: ChildStdout) -> Receiver<String> {
    let (to, lines) = channel();
    std::thread::spawn(move || {
        for line in BufReader::new(from).lines().map_while(Result::ok) {
            let _ = to.send(line);
        }
    });
    lines
}

/// Addresses that are free now.
fn free_addresses() -> Vec<SocketAddr> {
    let sockets: Vec<_> = (0..ROBOTS)
        .map(|_| UdpSocket::bind("127.0.0.1:0").unwrap())
        .collect();
    sockets
        .iter()
        .map(|socket| socket.local_addr().unwrap())
        .collect()
}

fn robot(id: u8, world: &str, addresses: &[SocketAddr]) -> Process {
    let mut arguments = words(&format!("robot --id {id} --world {world}"));
    for (&address, other) in addresses.iter().zip(0..) {
        let option = if other == id { "--listen" } else { "--peer" };
        arguments.extend([option.to_owned(), address.to_string()]);
    }
    Process::start(&arguments)
}

fn report(mut robot: Process) -> RobotReport {
    let mut text = String::new();
    robot.stdout().read_to_string(&mut text).unwrap();
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

/// Runs three robots; kills and restarts robot 1 once after `kill_at` ticks.
fn explore(kill_at: Option<u32>) {
    let folder = tempfile::tempdir().unwrap();
    let map = folder.path().join("rooms.txt");
    let world = host_sim::world::generate(host_sim::world::Family::Rooms, 40, 30, 5).unwrap();
    world.write(&map, 1).unwrap();

    let mut arguments = words("world --listen 127.0.0.1:0 --pace 2 --absence 20 --robots");
    arguments.extend([ROBOTS.to_string(), map.display().to_string()]);
    let mut served = Process::start(&arguments);
    let lines = lines(served.stdout());
    let next = || {
        lines
            .recv_timeout(PATIENCE)
            .expect("the world says nothing")
    };
    let address = next().strip_prefix("listening on ").unwrap().to_owned();

    let addresses = free_addresses();
    let mut robots: Vec<_> = (0..ROBOTS)
        .map(|id| robot(id, &address, &addresses))
        .collect();
    let result = loop {
        let line = next();
        if line.starts_with('{') {
            break line;
        }
        if kill_at.is_some_and(|tick| line.starts_with(&format!("tick {tick}:"))) {
            drop(robots.remove(1));
            robots.insert(1, robot(1, &address, &addresses));
        }
    };
    let result: WorldReport = serde_json::from_str(&result).unwrap();
    assert!(result.is_complete(), "{result:?}");
    assert!(
        kill_at.is_none_or(|tick| tick < result.ticks),
        "killed too late"
    );
    for report in robots.into_iter().map(report) {
        assert!(
            report
                .stop
                .as_ref()
                .is_some_and(|stop| stop.starts_with("complete"))
        );
        assert_eq!(
            report.free_cells_known, result.reachable_cells,
            "{report:?}"
        );
        assert!(
            report.frames_heard > 0 && report.frames_refused == 0,
            "{report:?}"
        );
        assert!(report.bytes_sent <= 55 * result.ticks);
    }
}

#[test]
fn three_processes_explore_a_map() {
    explore(None);
}

#[test]
fn a_robot_that_is_killed_and_comes_back_empty_learns_everything_again() {
    explore(Some(60));
}
