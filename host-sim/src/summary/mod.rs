//! A run in one JSON object: one head for all worlds, and the rest for each.

mod grid;
pub mod heights;
pub mod voxels;

use serde::Serialize;

use crate::scenario::Conditions;

pub use grid::{BodySummary, MotionSummary, RobotSummary, Summary};

/// What every summary says of a run, in any kind of world.
#[derive(Clone, Debug, Serialize)]
pub struct Head {
    /// Whether everything that can be seen was seen by somebody, without a violation.
    pub complete: bool,
    /// Ticks until it was.
    pub ticks_to_seen: Option<u32>,
    /// Ticks until every living robot had stopped.
    pub ticks_to_stopped: Option<u32>,
    /// Ticks that were run.
    pub ticks: u32,
    /// Places to see: free cells that can be reached from any start; columns; occupied
    /// voxels that can be seen.
    pub reachable_cells: u32,
    /// Those that somebody has seen.
    pub seen_cells: u32,
    /// Largest work of one planner in one tick.
    pub max_work_per_tick: u32,
    /// Digest of the trace.
    pub trace_digest: String,
    /// Name of the world.
    pub map: String,
    /// Whether frames were signed.
    pub keyed: bool,
    /// What the fleet worked under.
    #[serde(flatten)]
    pub conditions: Conditions,
}
