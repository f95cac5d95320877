//! Why a robot had stopped, as a record says it.

use planner_core::Reason;

/// What the action of a robot that had stopped begins with; the reason's number is added.
pub(crate) const STOPPED: u8 = 32;

/// The action of a robot that had stopped for this reason: 32 and [`Reason::code`].
pub(crate) const fn action_of(reason: Reason) -> u8 {
    STOPPED + reason.code()
}

/// The reason with this action.
pub(crate) fn reason_of(action: u8) -> Option<Reason> {
    Reason::from_code(action.checked_sub(STOPPED)?)
}

/// The action with the highest number.
pub(crate) const fn last_action() -> u8 {
    STOPPED + Reason::ALL.len() as u8 - 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reason_is_its_action() {
        for reason in Reason::ALL {
            assert_eq!(reason_of(action_of(reason)), Some(reason));
        }
        for action in (0..STOPPED).chain(last_action() + 1..=u8::MAX) {
            assert_eq!(reason_of(action), None);
        }
    }
}
