//! The simulator around planner-core.
fn main() {}
