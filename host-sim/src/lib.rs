//! The simulator around planner-core.
//!
//! ```text
//! scenario (world, robots, planner, seed) -> run -> trace -> picture | table
//! ```
//! A [`Scenario`](run::Scenario) holds everything that a run follows from;
//! [`run::run`] gives its outcome and, if asked, the [`Trace`](trace::Trace)
//! that everything else is drawn from.

#[cfg(unix)]
pub mod chip;
mod coverage;
pub mod draw;
pub mod experiments;
pub mod fleet;
pub mod live;
pub mod measured;
pub mod medium;
pub mod peers;
pub mod planners;
pub mod run;
pub mod sensor;
pub mod summary;
pub mod trace;
pub mod world;
