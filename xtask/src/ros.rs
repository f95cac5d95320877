//! The ROS 2 node, which is no part of the workspace: its tests, and an office that three
//! robots of another simulator explore with it over another vendor's DDS. And recordings.

use std::path::PathBuf;

use anyhow::{Result, bail};

use crate::shell::{Command, cargo, command};
use crate::{host, install};

/// Explorations; each takes 40 s, for robots move in real time, and longer where two stand in
/// each other's way.
const RUNS: u32 = 3;

/// The node's own tests pass, and it explores the office in each run, though one robot is
/// killed on the way.
pub(crate) fn explores() -> Result<String> {
    install::ip()?;
    let python = install::python()?;
    in_node(cargo(["fmt"])).arg("--check").run()?;
    built(cargo(["clippy"]))
        .arg("--all-targets")
        .args(["--", "-Dwarnings"])
        .run()?;
    built(cargo(["test"])).run()?;
    built(cargo(["build"])).run()?;
    command(&python)
        .arg("ros2/tests/launch.py")
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .run()?;
    let node = target().join("release/explore");
    alone()?
        .arg(python)
        .arg("ros2/tests/office.py")
        .arg(node)
        .arg(format!("--runs={RUNS}"))
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .env("MPLBACKEND", "Agg")
        .run()?;
    Ok(format!("{RUNS} of {RUNS} runs complete"))
}

/// The recording of an exploration has what it should, for a reader that is not ours.
pub(crate) fn recording_is_read() -> Result<String> {
    const TOPICS: [&str; 5] = [
        "/map=nav_msgs/msg/OccupancyGrid",
        "/tf=tf2_msgs/msg/TFMessage",
        "/robot2/pose=geometry_msgs/msg/PoseStamped",
        "/robot2/goal=geometry_msgs/msg/PoseStamped",
        "/robot2/scan=sensor_msgs/msg/LaserScan",
    ];

    let python = install::python()?;
    let programs = host::build_simulator()?;
    let folder = host::built().join("mcap");
    let file = folder.join("office.mcap");
    command(programs.join("host-sim"))
        .args(["explore", "fixtures/maps/office.png", "--mcap"])
        .arg(&file)
        .arg("--out")
        .arg(&folder)
        .run()?;
    command(python)
        .arg("ros2/tests/recording.py")
        .arg(&file)
        .args(TOPICS)
        .run()?;
    Ok(format!("{} bytes", std::fs::metadata(file)?.len()))
}

/// A command for the node instead of the workspace.
fn in_node(command: Command) -> Command {
    command.arg("--manifest-path=ros2/Cargo.toml")
}

fn built(command: Command) -> Command {
    in_node(command)
        .args(["--release", "--locked", "--target-dir"])
        .arg(target())
}

fn target() -> PathBuf {
    host::built().join("ros2")
}

/// A network of its own for a command: nothing of it leaves this machine, and nobody else is
/// heard. Who is not root becomes it in there alone.
fn alone() -> Result<Command> {
    let is_root = command("id").arg("-u").output()?.stdout.trim() == "0";
    let unshare = || {
        let unshare = command("unshare").arg("--net");
        let unshare = match is_root {
            true => unshare,
            false => unshare.arg("--map-root-user"),
        };
        unshare.arg("ros2/tests/alone.sh")
    };
    let can = unshare().arg("true").output()?;
    if !can.success() {
        bail!(
            "this machine gives no command a network of its own; run the check as root, or allow \
             user namespaces:\n{}",
            can.stderr
        );
    }
    Ok(unshare())
}
