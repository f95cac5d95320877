//! What fleets of flying robots leave behind, drawn and summed up.

pub mod baselines;
#[cfg(not(target_arch = "wasm32"))]
pub mod figures;
mod mapped;
mod summary;
mod trace;
pub mod voxels;

pub use crate::record::Deed;
pub use mapped::octree;
pub use summary::{RobotSummary, Summary};
pub use trace::{Record, Safety, Trace};
