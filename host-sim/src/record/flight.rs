//! What became of a decision of a robot that flies.

use planner_core::Reason;

use super::{action_of, reason_of};

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

/// Its number in files and digests.
impl From<Deed> for u8 {
    fn from(deed: Deed) -> Self {
        match deed {
            Deed::Flew => 0,
            Deed::Refused => 1,
            Deed::Hovered => 2,
            Deed::Stopped(reason) => action_of(reason),
        }
    }
}

impl TryFrom<u8> for Deed {
    type Error = String;

    fn try_from(action: u8) -> Result<Self, String> {
        match action {
            0 => Ok(Self::Flew),
            1 => Ok(Self::Refused),
            2 => Ok(Self::Hovered),
            _ => reason_of(action, 2).map(Self::Stopped),
        }
    }
}
