//! What can go wrong with an emulated chip, and what to do about it.

use std::io;
use std::path::PathBuf;
use std::process::ExitStatus;

use planner_core::ExtentError;
use planner_core::RobotId;
use planner_core::survey::SetupError;
use thiserror::Error;

use super::emulator::Machine;
use crate::planners::PlannerKind;

/// Why robots cannot run, or go on, in emulated chips.
#[derive(Debug, Error)]
pub enum ChipError {
    /// See the message.
    #[error(
        "{program} does not start ({problem}); install it with \
         `sudo apt-get install --no-install-recommends qemu-system-arm`"
    )]
    NoEmulator {
        /// Its name.
        program: &'static str,
        /// What the system says.
        problem: io::Error,
    },
    /// See the message.
    #[error(
        "there is no image {}; build it with `cargo xtask build-firmware --machine {machine}`",
        path.display()
    )]
    NoImage {
        /// Where it should be.
        path: PathBuf,
        /// The board that it is for.
        machine: Machine,
    },
    /// See the message.
    #[error(
        "{0} decides with a view of all robots, which no chip has; firmware hosts explorer, local-frontiers and local-frontiers-second-chance"
    )]
    HostOnly(PlannerKind),
    /// See the message.
    #[error("the chip of robot {0} takes another map: {1}", robot.0, problem)]
    Extent {
        /// Whose chip.
        robot: RobotId,
        /// What does not fit.
        problem: ExtentError,
    },
    /// See the message.
    #[error("robot {} cannot fly like this: {problem}", robot.0)]
    Grounded {
        /// Which robot.
        robot: RobotId,
        /// Why.
        problem: SetupError,
    },
    /// See the message.
    #[error(
        "the image in the chip of robot {} hosts no planner of this kind; for robots that fly \
         the one for netduinoplus2 does, and among voxels its image `voxels`",
        robot.0
    )]
    NotHosted {
        /// Whose chip.
        robot: RobotId,
    },
    /// See the message.
    #[error("the chip of robot {} ended ({status}){}", robot.0, quoted(messages))]
    Ended {
        /// Whose chip.
        robot: RobotId,
        /// How it ended.
        status: ExitStatus,
        /// What it printed.
        messages: String,
    },
    /// See the message.
    #[error("the chip of robot {} has not answered within {seconds} s{}", robot.0, quoted(messages))]
    Silent {
        /// Whose chip.
        robot: RobotId,
        /// How long it was waited for.
        seconds: u64,
        /// What it printed.
        messages: String,
    },
    /// See the message.
    #[error(
        "the chip of robot {} and the simulator do not understand each other ({problem}); \
         build the image anew with `cargo xtask build-firmware`",
        robot.0
    )]
    Dialogue {
        /// Whose chip.
        robot: RobotId,
        /// What was not understood.
        problem: String,
    },
    /// See the message.
    #[error("the map in the chip of robot {} is not what it was told: a bug", robot.0)]
    OtherMap {
        /// Whose chip.
        robot: RobotId,
    },
    /// See the message.
    #[error("cannot talk to the chip of robot {}: {problem}", robot.0)]
    System {
        /// Whose chip.
        robot: RobotId,
        /// What the system says.
        problem: io::Error,
    },
}

fn quoted(messages: &str) -> String {
    match messages.trim() {
        "" => String::new(),
        messages => format!(":\n{messages}"),
    }
}
