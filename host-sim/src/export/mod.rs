//! What other programs open: missions and trajectories for autopilots, maps as point clouds.

mod mission;
mod ply;
mod trajectory;
mod way;

pub use mission::{Home, plan, waypoints};
pub use ply::ply;
pub use trajectory::{Segment, segments, trajectory};
pub use way::{Way, among_voxels, over_heights};
