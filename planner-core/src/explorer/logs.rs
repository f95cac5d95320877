//! What the explorer logs, once for each change and not in every tick.

use super::Explorer;
use crate::cell::Cell;
use crate::map::Learnt;
use crate::robot::{Action, Wait};
use crate::zeroed::Maybe;

impl<const TW: usize, const TH: usize> Explorer<TW, TH> {
    /// A pose that it takes nothing from.
    pub(super) fn log_astray(&self, was_astray: bool, at: Cell) {
        if !was_astray {
            log!(warn, "robot {}: no use for the pose {}", self.id.0, at);
        }
    }

    /// What a look has changed.
    pub(super) fn log_look(&self, was_lost: bool, learnt: Learnt) {
        let (id, at) = (self.id.0, self.around.position);
        let is_lost = self.evidence.is_lost();
        if is_lost && !was_lost {
            log!(warn, "robot {}: looks contradict its map at {}", id, at);
        } else if was_lost && !is_lost {
            log!(info, "robot {}: looks agree with its map again", id);
        }
        let Learnt { opened, closed, .. } = learnt;
        if opened | closed > 0 {
            log!(
                debug,
                "robot {}: sees {} walls free, {} free cells blocked, from {}",
                id,
                opened,
                closed,
                at
            );
        }
    }

    /// What it stops for, and what it waits for, where it did not before.
    pub(super) fn log_decision(&self, had_stopped: bool, waited: Maybe<Wait>, action: Action) {
        let (id, at) = (self.id.0, self.around.position);
        match (action, self.waiting.get()) {
            (Action::Stop(stop), _) if !had_stopped && stop.is_complete() => {
                log!(info, "robot {}: stops at {}: {}", id, at, stop);
            }
            (Action::Stop(stop), _) if !had_stopped => {
                log!(warn, "robot {}: stops at {}: {}", id, at, stop);
            }
            (Action::Wait, Some(reason)) if waited.get() != Some(reason) => match reason {
                Wait::Look(side) => log!(trace, "robot {}: looks {:?} at {}", id, side, at),
                _ => log!(debug, "robot {}: waits at {}: {:?}", id, at, reason),
            },
            _ => {}
        }
    }
}
