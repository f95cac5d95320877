//! Fleets of flying robots over unknown surfaces.

pub mod baselines;
pub mod draw;
pub mod octree;
mod run;
mod scenario;
mod sensor;
mod terrain;
mod trace;

pub use run::run;
pub use scenario::{Kill, Planner, Scenario};
pub use sensor::look;
pub use terrain::Terrain;
pub use trace::{Record, Safety, Trace};
