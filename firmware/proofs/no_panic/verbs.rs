//! Every call that robots make of their planners, with arguments that the compiler
//! knows nothing of.

mod air;
mod ground;

/// Calls them all.
pub(crate) fn call_all() {
    ground::call_all();
    air::call_all();
}

/// What the compiler knows nothing of.
mod any {
    use core::hint::black_box;

    use planner_core::radio::{LinkConfig, MAX_LEN};
    use planner_core::{Cell, Extent, RobotId};

    pub(super) fn cell() -> Cell {
        black_box(Cell::new(1, 1))
    }

    pub(super) fn radius() -> u8 {
        black_box(5)
    }

    pub(super) fn extent() -> Extent {
        black_box(Extent::new(9, 9))
    }

    pub(super) fn id() -> RobotId {
        black_box(RobotId(1))
    }

    pub(super) fn link() -> LinkConfig {
        black_box(LinkConfig::new())
    }

    /// A frame of any length, to be received.
    pub(super) fn bytes(frame: &[u8; MAX_LEN]) -> &[u8] {
        let length = black_box(frame.len());
        black_box(frame.get(..length).unwrap_or_default())
    }
}
