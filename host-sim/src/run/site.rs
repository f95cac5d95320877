//! Where the planners of a run are, in any world.

/// The place of all planners of a run; each world's `Host` says how it makes one.
pub trait Site: Clone + 'static {
    /// Whether the run has to end because a planner is lost.
    fn has_failed(&self) -> bool {
        false
    }
}

/// In this process.
#[derive(Clone, Copy, Debug)]
pub struct Here;

impl Site for Here {}
