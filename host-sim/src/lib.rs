//! The simulator around planner-core.

pub mod survey;
