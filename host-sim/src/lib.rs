//! The simulator around planner-core.

pub mod world;
