//! Fleets of flying robots over unknown surfaces.

pub mod baselines;
mod error;
#[cfg(not(target_arch = "wasm32"))]
pub mod figures;
mod foreign;
mod mapped;
pub mod octree;
mod run;
mod scenario;
mod sensor;
mod summary;
mod terrain;
mod terrain_file;
mod terrain_source;
mod trace;
pub mod voxels;

pub use crate::record::Deed;
pub use error::SurveyError;
pub use mapped::octree;
pub use run::{Here, Host, Stepping, open, run, run_on};
pub use scenario::{DEFAULT_BYTE_BUDGET, Kill, Planner, Scenario};
pub use sensor::look;
pub use summary::{RobotSummary, Summary};
pub use terrain::Terrain;
pub use terrain_file::TerrainError;
pub use terrain_source::TerrainSource;
pub use trace::{Record, Safety, Trace};
