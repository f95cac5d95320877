//! Fleets of flying robots over unknown surfaces.

mod args;
pub mod baselines;
pub mod draw;
mod figures;
mod mapped;
pub mod octree;
mod run;
mod scenario;
mod sensor;
mod terrain;
mod terrain_source;
mod trace;

pub use args::{Summary, SurveyArgs};
pub use figures::figures;
pub use mapped::octree;
pub use run::{Stepping, open, run};
pub use scenario::{Kill, Planner, Scenario};
pub use sensor::look;
pub use terrain::Terrain;
pub use terrain_source::TerrainSource;
pub use trace::{Record, Safety, Trace};
