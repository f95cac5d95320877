//! Fleets of flying robots in boxes of voxels: streets, undersides, rooms.

mod file;
mod run;
mod scene;

pub use file::Record;
pub use run::{Scenario, Simulation, VoxelTrace, look, run};
pub use scene::Scene;
