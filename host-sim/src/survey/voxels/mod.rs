//! What fleets of flying robots leave behind in scenes of voxels.

mod file;
mod trace;

pub use file::Record;
pub use trace::VoxelTrace;
