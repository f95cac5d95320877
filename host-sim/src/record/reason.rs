//! Why a robot had stopped, as a record says it.

use clap::ValueEnum;
use planner_core::Stop;

/// What the action of a robot that had stopped begins with; the reason's number is added.
pub(crate) const STOPPED: u8 = 32;

/// A [`Stop`] without the numbers and places that it names: those are not in a record.
/// In the order of [`Stop::code`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Reason {
    /// [`Stop::Complete`].
    Complete,
    /// [`Stop::Enclosed`].
    Enclosed,
    /// [`Stop::Blocked`].
    Blocked,
    /// [`Stop::BackAtStart`].
    BackAtStart,
    /// [`Stop::NoTrace`].
    NoTrace,
    /// [`Stop::AtEdge`].
    AtEdge,
    /// [`Stop::OutOfReach`].
    OutOfReach,
    /// [`Stop::Unseen`].
    Unseen,
    /// [`Stop::Held`].
    Held,
}

impl<P> From<Stop<P>> for Reason {
    fn from(stop: Stop<P>) -> Self {
        match stop {
            Stop::Complete => Self::Complete,
            Stop::Enclosed { .. } => Self::Enclosed,
            Stop::Blocked { .. } => Self::Blocked,
            Stop::BackAtStart { .. } => Self::BackAtStart,
            Stop::NoTrace { .. } => Self::NoTrace,
            Stop::AtEdge { .. } => Self::AtEdge,
            Stop::OutOfReach { .. } => Self::OutOfReach,
            Stop::Unseen { .. } => Self::Unseen,
            Stop::Held { .. } => Self::Held,
        }
    }
}

impl Reason {
    /// The action of a robot that had stopped for this reason: 32 and [`Stop::code`].
    pub(crate) const fn action(self) -> u8 {
        STOPPED + self as u8
    }

    /// The reason with this action.
    pub(crate) fn of_action(action: u8) -> Option<Self> {
        let code = action.checked_sub(STOPPED)?;
        Self::value_variants().get(usize::from(code)).copied()
    }

    /// The action with the highest number.
    pub(crate) fn last_action() -> u8 {
        STOPPED + Self::value_variants().len() as u8 - 1
    }
}

#[cfg(test)]
mod tests {
    use planner_core::Cell;

    use super::*;

    #[test]
    fn a_reason_has_the_number_of_its_stop() {
        let (frontiers, at) = (7, Cell::new(3, 4));
        for stop in [
            Stop::Complete,
            Stop::Enclosed { frontiers },
            Stop::Blocked { frontiers, at },
            Stop::BackAtStart { frontiers },
            Stop::NoTrace { frontiers },
            Stop::AtEdge { cells: 7 },
            Stop::OutOfReach { frontiers },
            Stop::Unseen { frontiers, at },
            Stop::Held { frontiers, at },
        ] {
            let reason = Reason::from(stop);
            assert_eq!(reason.action(), 32 + stop.code());
            assert_eq!(Reason::of_action(reason.action()), Some(reason));
        }
        for action in (0..STOPPED).chain(Reason::last_action() + 1..=u8::MAX) {
            assert_eq!(Reason::of_action(action), None);
        }
    }
}
