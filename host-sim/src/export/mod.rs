//! What other programs open: missions for autopilots, and maps as point clouds.

mod mission;
mod ply;

pub use mission::{Home, plan, way_in_metres, waypoints};
pub use ply::ply;
