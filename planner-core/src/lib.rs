#![doc = include_str!("../README.md")]
#![no_std]
#![forbid(unsafe_code)]
// What surveys alone need of the common parts is small, and told apart nowhere else.
#![cfg_attr(not(feature = "survey"), allow(dead_code, unused_imports))]

#[cfg(test)]
extern crate std;

#[macro_use]
mod logging;

#[cfg(feature = "survey")]
pub mod cao;
mod cell;
#[cfg(feature = "survey")]
pub mod coordinated_survey;
pub mod explorer;
#[cfg(feature = "survey")]
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
#[cfg(feature = "survey")]
pub mod surface;
#[cfg(feature = "survey")]
pub mod survey;
pub mod tile;
#[cfg(feature = "survey")]
pub mod volume;
#[cfg(feature = "survey")]
pub mod voxel_survey;
mod zeroed;

pub use cell::{Cell, Direction, Extent, ExtentError};
pub use map::{CellSet, Learnt, Map};
pub use planner::{
    AnyPlanner, Contact, Errands, Inspect, KeepOutError, LongSight, Persist, Planner, RestoreError,
};
pub use point::Point;
pub use robot::{Action, Activity, Motion, Reason, RobotId, Status, Stop, Wait};
pub use sight::Sighting;
pub use tile::TileSet;
