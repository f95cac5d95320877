//! What became of a decision of a robot that flies.

use planner_core::Reason;

use super::{action_of, last_action, reason_of};

/// What a robot did in a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Deed {
    /// It flew.
    Flew,
    /// The flight controller refused its flight, for another robot's sake.
    Refused,
    /// It stayed.
    Hovered,
    /// It had stopped.
    Stopped(Reason),
}

impl Deed {
    /// Its number in files and digests.
    pub(crate) const fn action(self) -> u8 {
        match self {
            Self::Flew => 0,
            Self::Refused => 1,
            Self::Hovered => 2,
            Self::Stopped(reason) => action_of(reason),
        }
    }

    /// What has this number.
    pub(crate) fn of_action(action: u8) -> Option<Self> {
        Some(match action {
            0 => Self::Flew,
            1 => Self::Refused,
            2 => Self::Hovered,
            _ => Self::Stopped(reason_of(action)?),
        })
    }

    /// Which numbers there are, in words.
    pub(crate) fn actions() -> String {
        let (first, last) = (action_of(Reason::Complete), last_action());
        format!("an action, 0 to 2 or {first} to {last}")
    }
}
