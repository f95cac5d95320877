//! What fleets of flying robots leave behind, drawn and summed up.

mod mapped;
mod summary;
mod trace;
pub mod voxels;

pub use crate::record::Deed;
pub use mapped::octree;
pub use summary::{RobotSummary, Summary};
pub use trace::{Record, Safety, Trace};
