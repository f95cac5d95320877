//! The simulator around planner-core.
//!
//! ```text
//! scenario (world, robots, planner, seed) -> run -> trace -> picture | table
//! ```
//! A [`Scenario`](scenario::grid::Scenario) holds everything that a run follows from;
//! [`run::run`] gives its outcome and, if asked, the [`Trace`](record::grid::Trace)
//! that everything else is drawn from.
//!
//! Compiled for the browser (`wasm32`), the library lacks `chip`, `experiments`,
//! `files` and `live`, which need processes, threads, sockets or a file system.

pub mod baselines;
mod bytes;
#[cfg(unix)]
pub mod chip;
mod coverage;
#[cfg(test)]
mod damage;
mod dice;
pub mod draw;
mod excerpt;
#[cfg(not(target_arch = "wasm32"))]
pub mod experiments;
pub mod export;
#[cfg(not(target_arch = "wasm32"))]
pub mod files;
pub mod fleet;
mod limits;
#[cfg(not(target_arch = "wasm32"))]
pub mod live;
pub mod measured;
pub mod medium;
mod mission;
mod motion;
pub mod options;
mod pixels;
pub mod planners;
pub mod record;
pub mod robot;
pub mod run;
mod saves;
pub mod scans;
pub mod scenario;
pub mod scene;
pub mod senses;
pub mod sensor;
pub mod summary;
pub mod terrain;
pub mod world;

/// The main loop in docs/porting.md compiles.
#[cfg(doctest)]
#[doc = include_str!("../../docs/porting.md")]
struct Porting;
