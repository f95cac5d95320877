//! The simulator around planner-core.
