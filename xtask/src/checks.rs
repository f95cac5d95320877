//! Every check, in the order in which they run: quick ones first.

use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail};

use crate::shell::{Command, cargo, command, root};
use crate::{
    c_interface, c_library, crazyflie, documents, embassy, figures, firmware, fuzz, host, install,
    lab, notices, output, ros, site, slurm, worst,
};

/// One thing that must hold.
#[derive(Debug)]
pub(crate) struct Check {
    name: &'static str,
    title: &'static str,
    /// Returns a remark for the summary, or nothing.
    run: fn() -> Result<String>,
}

/// Checks that keep one core busy, with target folders and toolchains of their own: they
/// run beside the others.
const ASIDE: [&str; 3] = ["miri", "fuzz", "ros"];

const CHECKS: &[Check] = &[
    Check {
        name: "format",
        title: "the sources are formatted",
        run: || cargo(["fmt", "--all", "--check"]).run().map(nothing),
    },
    Check {
        name: "clippy",
        title: "clippy has no complaints",
        run: || {
            cargo([
                "clippy",
                "--workspace",
                "--all-targets",
                "--features=host-sim/parquet,host-sim/mcap",
                "--locked",
                "--",
                "-Dwarnings",
            ])
            .run()
            .map(nothing)
        },
    },
    Check {
        name: "clippy-features",
        title: "nor with every feature of planner-core, and with none",
        run: || {
            for features in ["--all-features", "--no-default-features"] {
                cargo(["clippy", "-p=planner-core", features, "--", "-Dwarnings"]).run()?;
            }
            Ok(String::new())
        },
    },
    Check {
        name: "clippy-chip",
        title: "nor with the image for the chip",
        run: || {
            install::target(firmware::TARGET)?;
            cargo([
                "clippy",
                "-p=firmware",
                "--lib",
                "--bins",
                "--examples",
                "--target",
                firmware::TARGET,
            ])
            .args(["--", "-Dwarnings"])
            .run()?;
            cargo([
                "clippy",
                "-p=c-api",
                "-p=stm32f405",
                "--lib",
                "--bins",
                "--target",
            ])
            .args([firmware::TARGET, "--", "-Dwarnings"])
            .run()
            .map(nothing)
        },
    },
    Check {
        name: "doc",
        title: "the documentation builds without warnings",
        run: || site::document().map(nothing),
    },
    Check {
        name: "notices",
        title: "all that the programs embed may be passed on with its notice",
        run: notices::write,
    },
    Check {
        name: "workflow",
        title: "the workflow of the code host has no mistake",
        run: || {
            command(install::actionlint()?)
                .arg(".github/workflows/ci.yml")
                .run()
                .map(nothing)
        },
    },
    Check {
        name: "test",
        title: "unit, property, cross-crate and documentation tests",
        run: || {
            // OctoMap's have a check of their own.
            repeatable(host::test().args(["--no-fail-fast", "--", "--skip=octomap"]))
                .run()
                .map(nothing)
        },
    },
    Check {
        name: "octomap",
        title: "OctoMap's own tools read the maps of surveys",
        run: || {
            install::octomap()?;
            repeatable(host::test().args(["--test=survey", "octomap"]))
                .run()
                .map(nothing)
        },
    },
    Check {
        name: "lab",
        title: "the lab's window: buttons, keys, pictures of the screen",
        run: || lab::window_works().map(nothing),
    },
    Check {
        name: "lab-web",
        title: "the lab's page in a browser decides as the host",
        run: lab::page_works,
    },
    Check {
        name: "site",
        title: "the site has no dead link, and no complaint in a browser",
        run: site::works,
    },
    Check {
        name: "test-keyed",
        title: "planner-core's tests of signed frames; the simulator's build has the key",
        // Of all packages together, planner-core is built with the features that any of
        // them wants: `test` runs every other of its tests with the key as well.
        run: || {
            repeatable(host::test().args(["--lib", "--", "keyed", "signed"]))
                .run()
                .map(nothing)
        },
    },
    Check {
        name: "test-micromath",
        title: "planner-core's tests with approximate mathematics, and without the key",
        run: || {
            // What steers in the air is all that asks for these functions; frames are
            // unsigned here.
            repeatable(cargo(["test", "-p=planner-core", "--features=micromath"]))
                .args(["--lib", "--", "math::", "cao::", "survey::", "radio::"])
                .arg("--skip=voxel_survey::")
                .env("PROPTEST_CASES", "256")
                .run()
                .map(nothing)
        },
    },
    Check {
        name: "commands",
        title: "the commands in the documents exist",
        run: documents::check,
    },
    Check {
        name: "figures",
        title: "the figures in the documents are what quick commands say",
        run: figures::check,
    },
    Check {
        name: "mcap",
        title: "the field's reader opens the recording of an exploration",
        run: ros::recording_is_read,
    },
    Check {
        name: "slurm",
        title: "an array of jobs with one stopped midway gives the bytes of one run",
        run: slurm::sweeps_as_one_run,
    },
    Check {
        name: "targets",
        title: "planner-core builds for every chip, with and without its features",
        run: core_builds_for_chips,
    },
    Check {
        name: "msrv",
        title: "planner-core builds with the oldest compiler that its manifest names",
        run: core_builds_with_its_oldest_compiler,
    },
    Check {
        name: "package",
        title: "crates that can be published are packaged; planner-core stands alone",
        run: crates_are_packaged,
    },
    Check {
        name: "firmware",
        title: "the image explores its map in the emulator, within the budget",
        run: firmware::explores,
    },
    Check {
        name: "loop",
        title: "every planner decides on emulated chips as on the host",
        run: firmware::decides_as_the_host,
    },
    Check {
        name: "loop-micromath",
        title: "with approximate mathematics too, flying robots decide as on the host",
        run: firmware::decides_as_the_host_with_micromath,
    },
    Check {
        name: "worst",
        title: "calls keep to the budget where they cost most",
        run: worst::keeps_to_the_budget,
    },
    Check {
        name: "stack-overflow",
        title: "a stack overflow faults at once",
        run: firmware::stack_overflow_faults,
    },
    Check {
        name: "too-large",
        title: "an image that does not fit in RAM does not link",
        run: firmware::too_large_is_refused,
    },
    Check {
        name: "no-panic",
        title: "no path from any planner leads to a panic",
        run: firmware::has_no_panic,
    },
    Check {
        name: "c-library",
        title: "the library for C is one object that cannot panic, for every chip and size",
        run: c_library::links_anywhere,
    },
    Check {
        name: "c-header",
        title: "the header of the C interface is current",
        run: c_interface::header_is_current,
    },
    Check {
        name: "c-misuse",
        title: "a program in C that does everything wrongly gets answers, under sanitizers",
        run: c_interface::misuse_is_answered,
    },
    Check {
        name: "c-example",
        title: "the example in C explores in the emulator",
        run: c_interface::example_explores,
    },
    Check {
        name: "crazyflie",
        title: "three emulated Crazyflies explore a room with the app, 20 times",
        run: crazyflie::explores,
    },
    Check {
        name: "example",
        title: "the robot to start from explores in the emulator, and its logs can be read",
        run: firmware::example_explores,
    },
    Check {
        name: "embassy",
        title: "the robot on embassy links for both of its chips",
        run: embassy::links,
    },
    Check {
        name: "miri",
        title: "unit tests of planner-core and of the interface for C under Miri",
        run: miri,
    },
    Check {
        name: "fuzz",
        title: "each fuzz target for a short while",
        run: || fuzz::run(20),
    },
    Check {
        name: "ros",
        title: "three robots of another simulator explore an office with the ROS 2 node",
        run: ros::explores,
    },
];

/// The check of that name.
pub(crate) fn named(name: &str) -> Result<&'static Check, String> {
    CHECKS
        .iter()
        .find(|check| check.name == name)
        .ok_or_else(|| "no such check; `cargo xtask test --list` names them".to_owned())
}

/// Prints the names of all checks.
pub(crate) fn list() {
    for check in CHECKS {
        println!("{:<16} {}", check.name, check.title);
    }
}

/// Runs the given checks, or all of them, and sums up.
pub(crate) fn run(only: &[&'static Check]) -> Result<()> {
    let chosen: Vec<&Check> = match only {
        [] => CHECKS.iter().collect(),
        only => only.to_vec(),
    };
    let begin = Instant::now();
    let numbered = chosen.iter().zip(1..);
    let (aside, rest): (Vec<_>, Vec<_>) =
        numbered.partition(|(check, _)| chosen.len() > 1 && ASIDE.contains(&check.name));
    let perform = |(check, number): (&&'static Check, usize)| {
        println!(
            "\n=== {number}/{} {}: {}",
            chosen.len(),
            check.name,
            check.title
        );
        let begin = Instant::now();
        let result = (check.run)();
        if let Err(error) = &result {
            println!("FAILED: {error:#}");
        }
        (*check, begin.elapsed(), result)
    };
    let mut results = Vec::new();
    std::thread::scope(|scope| {
        let beside = scope.spawn(|| {
            let kept = aside
                .into_iter()
                .map(|check| output::keep(|| perform(check)));
            kept.collect::<Vec<_>>()
        });
        results.extend(rest.into_iter().map(perform));
        for (result, said) in beside.join().expect("no check panics") {
            output::write(&said, std::io::stdout());
            results.push(result);
        }
    });

    println!("\n=== summary");
    for (check, time, result) in &results {
        let (verdict, remark) = match result {
            Ok(remark) => ("ok", remark.as_str()),
            Err(_) => ("FAILED", ""),
        };
        println!(
            "{verdict:<6} {:>7}  {:<16} {remark}",
            seconds(*time),
            check.name
        );
    }
    let failed: Vec<&str> = results
        .iter()
        .filter(|(_, _, result)| result.is_err())
        .map(|(check, ..)| check.name)
        .collect();
    println!("{} checks in {}", results.len(), seconds(begin.elapsed()));
    if !failed.is_empty() {
        bail!(
            "{} failed; run one again with `cargo xtask test --only {}`",
            failed.join(", "),
            failed[0]
        );
    }
    Ok(())
}

fn core_builds_for_chips() -> Result<String> {
    const CHIPS: [&str; 4] = [
        "thumbv6m-none-eabi",
        firmware::TARGET,
        "thumbv8m.main-none-eabihf",
        "riscv32imac-unknown-none-elf",
    ];
    for chip in CHIPS {
        install::target(chip)?;
    }
    // Built, not checked: only then are the assertions on sizes evaluated. They are the
    // same at every level of optimisation.
    let build = || {
        cargo(["build", "-p=planner-core"])
            .args(["--config=profile.dev.opt-level=0"])
            .args(["--config=profile.dev.package.planner-core.opt-level=0"])
            .args(CHIPS.map(|chip| format!("--target={chip}")))
    };
    build().arg("--no-default-features").run()?;
    build().arg("--all-features").run()?;
    Ok(CHIPS.join(", "))
}

/// What others build with may be older than what this project is built with.
fn core_builds_with_its_oldest_compiler() -> Result<String> {
    let manifest = std::fs::read_to_string(root().join("planner-core/Cargo.toml"))?;
    let oldest = manifest
        .lines()
        .find_map(|line| line.strip_prefix("rust-version = \"")?.strip_suffix('"'))
        .context("the manifest of planner-core names no rust-version")?;
    install::toolchain(oldest)?;
    for features in ["--all-features", "--no-default-features"] {
        command("rustup")
            .args(["run", oldest, "cargo", "check", "-p=planner-core", features])
            .run()?;
    }
    Ok(format!("Rust {oldest}"))
}

/// Crates as their users get them carry what one needs to read, and each needs only those
/// before it. planner-core is unpacked and built, without what it has for surveys.
fn crates_are_packaged() -> Result<String> {
    const CARRIES: [&str; 3] = ["README.md", "LICENSE-APACHE", "LICENSE-MIT"];
    /// In the order in which they are to be published.
    const CRATES: [&str; 5] = [
        "planner-core",
        "host-sim-bridge",
        "ros-messages",
        "host-sim",
        "lab",
    ];
    let package = |name: &str| cargo(["package", "--allow-dirty", "-p"]).arg(name);
    let mut files = 0;
    for name in CRATES {
        let list = package(name).arg("--list").output()?;
        for file in CARRIES {
            if !list.stdout.lines().any(|line| line == file) {
                bail!("{name} does not carry {file}");
            }
        }
        files += list.stdout.lines().count();
    }
    package(CRATES[0]).arg("--no-default-features").run()?;
    let all = CRATES[1..]
        .iter()
        .fold(package(CRATES[0]), |all, name| all.args(["-p", name]));
    all.args(["--no-verify", "--locked"]).run()?;
    Ok(format!("{} crates of {files} files", CRATES.len()))
}

/// The same cases of each property every time, so that a check says the same of the
/// same sources; new cases are what `cargo test` and `cargo xtask soak` look for.
fn repeatable(test: Command) -> Command {
    const VARIABLE: &str = "PROPTEST_RNG_SEED";
    match std::env::var_os(VARIABLE) {
        Some(_) => test,
        None => test.env(VARIABLE, "1"),
    }
}

/// Miri is a thousand times slower than the chip: few cases of each property, and
/// only the modules that pack bits and bytes.
fn miri() -> Result<String> {
    /// Take minutes even so, or a square root, which Miri does not know.
    const SKIPPED: [&str; 6] = [
        "sight::tests::metres::a_mirrored_robot_is_noticed_by_the_others",
        "sight::tests::metres::a_robot_in_metres_maps_the_room_as_it_is",
        "sight::tests::scan::a_scan_within_its_tolerance_tells_no_lie",
        "sight::tests::scan::ranges_in_millimetres_leave_no_cell_unseen",
        "sight::tests::zones::",
        "radio::tests::maps_converge_under_loss",
    ];

    /// Compare all bytes of a planner, its padding too; explore a whole hall, or a box, or look
    /// about one until they stop; and take square roots.
    const SKIPPED_IN_C: [&str; 7] = [
        "a_failed_create",
        "two_robots_explore_a_hall_and_hear_each_other",
        "voxels::a_box_is_",
        "voxels::looks::",
        "zones_and_rays_show_what_they_do_in_rust",
        "a_wall_is_seen_above_the_floor",
        "zones_make_the_beams_of_rust",
    ];

    install::miri()?;
    let miri = || {
        command("rustup")
            .args(["run", install::NIGHTLY, "cargo", "miri", "test", "--lib"])
            .env("PROPTEST_CASES", "2")
            // proptest reads the clock and its file of past failures.
            .env("MIRIFLAGS", "-Zmiri-disable-isolation")
    };
    miri()
        .args(["-p=planner-core", "--"])
        .args([
            "cell::",
            "list::",
            "map::",
            "radio::",
            "sight::",
            "tile::",
            "role::path",
            "explorer::patch",
        ])
        .args(SKIPPED.map(|test| format!("--skip={test}")))
        .run()?;
    // The only unsafe code.
    miri()
        .args(["-p=c-api", "--"])
        .args(SKIPPED_IN_C.map(|test| format!("--skip={test}")))
        .run()?;
    Ok(format!("without {}", SKIPPED.join(", ")))
}

fn nothing((): ()) -> String {
    String::new()
}

fn seconds(time: Duration) -> String {
    format!("{:.1} s", time.as_secs_f64())
}
