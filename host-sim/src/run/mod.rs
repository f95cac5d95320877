//! From a scenario to what happened: three loops over the same parts, one for each kind
//! of world. What stands here is of grids.

mod book;
mod claims;
mod grid;
pub mod heights;
mod outcome;
mod site;
mod stepping;
pub mod voxels;

pub use grid::{Host, Options, fleet, open, run, run_compiled, run_on};
pub use outcome::{Assignments, Outcome, Progress, RobotOutcome};
pub use site::{Here, Site};
pub use stepping::{Running, Seen, Stepping};
