//! Firmware in the loop: robots whose planners run in emulated chips.
//!
//! Each robot is a QEMU process that runs the image `robot` of the package
//! `firmware`. A `Proxy` stands for it in the fleet: a
//! [`Planner`](planner_core::Planner) whose verbs are messages to the chip, so
//! that world, media, trace and pictures are those of any other run. It decides
//! nothing. Media and traces look at a robot's map: the proxy keeps a copy, fed
//! with what the chip is fed with, and in every tick the chip's grid_hash of its
//! own map must be that of the copy. A `SurveyProxy` is the same for a robot that
//! flies, and a `VoxelProxy` for one among voxels, which runs the image `voxels`.

mod book;
mod dialogue;
mod emulator;
mod error;
mod proxy;
mod surveyor;
mod swarm;
mod voxels;

pub use emulator::Machine;
pub use error::ChipError;
pub use swarm::Swarm;
