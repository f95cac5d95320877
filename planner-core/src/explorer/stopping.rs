//! When the robot stops, and what it looks at again before it does.

use super::Explorer;
use super::ahead::MOST_WAITS;
use crate::robot::{Action, Stop, Wait};
use crate::role::End;
use crate::zeroed::Maybe;

impl<const TW: usize, const TH: usize> Explorer<TW, TH> {
    /// Nothing is left: the robot stops. Before that it looks again at a wall that it sees
    /// free, and goes to what others told to be shut; on patrol it goes to all shut places
    /// again and again.
    pub(super) fn finish(&mut self, stop: Stop) -> Action {
        if stop.is_complete() && self.evidence.is_disputed() && self.doubts < MOST_WAITS {
            self.doubts += 1;
            return self.wait(Wait::Doubt);
        }
        self.role.plan = None;
        self.far.cancel();
        let now = self.around.now;
        let is_patrol = self.config.patrol > 0
            && stop.is_complete()
            && !self.around.map.shut().places().is_empty();
        let was_told = stop.is_complete() && core::mem::take(&mut self.was_told_shut);
        if was_told || is_patrol && now >= self.patrol_again {
            self.patrol_again = now.saturating_add(u32::from(self.config.patrol));
            if self.around.visit_shut_places() {
                return self.wait(Wait::Search);
            }
        }
        if is_patrol {
            return self.wait(Wait::Patrol);
        }
        if self.config.come_home {
            self.send(self.role.home, End::Exploration(stop));
            return self.wait(Wait::Search);
        }
        self.stop(stop)
    }

    pub(super) fn stop(&mut self, stop: Stop) -> Action {
        self.role.plan = None;
        self.far.cancel();
        self.role.stopped = Maybe::Just(stop);
        Action::Stop(stop)
    }

    /// Not stopped any more; everything is tried anew.
    pub(super) fn go_on(&mut self) {
        if self.role.has_stopped() {
            self.role.errand = Maybe::Nothing;
        }
        self.role.stopped = Maybe::Nothing;
        self.role.plan = None;
        self.role.changes = 0;
        self.role.lost = 0;
        self.around.aside.reset();
        self.looks = 0;
        self.holds = 0;
        self.far.cancel();
    }
}
