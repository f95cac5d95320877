//! Why a robot had stopped, as a record says it.

use planner_core::Reason;

/// What the action of a robot that had stopped begins with; the reason's number is added.
const STOPPED: u8 = 32;

/// The action of a robot that had stopped for this reason: 32 and [`Reason::code`].
pub(crate) const fn action_of(reason: Reason) -> u8 {
    STOPPED + reason.code()
}

/// The reason with this action, where the last one of a robot that has not stopped is
/// `last`.
///
/// # Errors
/// What actions there are.
pub(crate) fn reason_of(action: u8, last: u8) -> Result<Reason, String> {
    let code = action.checked_sub(STOPPED);
    code.and_then(Reason::from_code).ok_or_else(|| {
        let end = STOPPED + Reason::ALL.len() as u8 - 1;
        format!("an action, 0 to {last} or {STOPPED} to {end}")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reason_is_its_action() {
        for reason in Reason::ALL {
            assert_eq!(reason_of(action_of(reason), 2), Ok(reason));
        }
        for action in (0..32).chain(44..=u8::MAX) {
            assert!(reason_of(action, 2).is_err());
        }
    }
}
