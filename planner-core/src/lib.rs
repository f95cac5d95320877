//! Exploration planners for swarms of microcontroller-class robots.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

mod cell;
pub mod explorer;
pub mod local_frontiers;
pub mod map;
mod math;
mod planner;
pub mod radio;
pub mod sight;

pub use cell::{Cell, Direction, Extent};
pub use map::{Learnt, Map, TileSet};
pub use planner::{Action, Activity, Motion, Planner, RobotId, Status, Stop};
pub use sight::Sighting;
