//! Exploration planners for swarms of microcontroller-class robots.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

pub mod cao;
mod cell;
pub mod coordinated_survey;
pub mod explorer;
pub mod fcao;
mod list;
pub mod local_frontiers;
pub mod map;
mod math;
mod planner;
mod point;
pub mod radio;
pub mod rng;
mod robot;
pub mod role;
pub mod sight;
pub mod surface;
pub mod survey;
pub mod tile;
pub mod volume;
pub mod voxel_survey;
mod zeroed;

pub use cell::{Cell, Direction, Extent, ExtentError};
pub use map::{Learnt, Map};
pub use planner::{AnyPlanner, Contact, Inspect, Planner};
pub use point::Point;
pub use robot::{Action, Activity, Motion, Reason, RobotId, Status, Stop, Wait};
pub use sight::Sighting;
pub use tile::TileSet;
