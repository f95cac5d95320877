//! What the explorer goes for: near by, far away, or nothing more.

use super::Explorer;
use super::aside::Verdict;
use super::far::{self, Outcome};
use super::near::{Aim, Candidate};
use crate::robot::{Stop, Wait};
use crate::zeroed::Maybe;

/// What the near decision has come to.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Near {
    /// This robot goes to a frontier that it is nearest to.
    Mine,
    /// It had no plan, and goes to one that others are nearer to.
    Theirs,
    /// It goes on with what it had.
    Nothing,
}

impl<const TW: usize, const TH: usize> Explorer<TW, TH> {
    /// Goes on with the far search, with what the near decision has left of the slice.
    pub(super) fn search_far(&mut self) -> Outcome {
        if self.far.is_idle() {
            return Outcome::Searching;
        }
        let left = self.config.slice.saturating_sub(self.work + far::WAY_WORK);
        let left = left.max(self.config.least_far());
        self.far.advance(&self.around, left, &mut self.work)
    }

    fn start_sweep(&mut self) {
        self.far_is_doubtful = false;
        self.far.start_sweep(self.id, &self.others, &self.around);
    }

    /// Decides among the frontiers nearby, and which far search is to run if none of
    /// them is this robot's own. A robot without a plan then gets the best one of others.
    #[inline(never)] // its frame is gone before the far search
    pub(super) fn decide_near(&mut self) -> Near {
        let (now, id) = (self.around.now, self.id);
        self.role.since = 0;
        let knows_all = self.others.are_all_fresh(now);
        let aim = Aim {
            goal: self.last_goal,
            hysteresis: self.config.hysteresis,
            lean: (!knows_all).then_some(id),
        };
        let wants_any = self.role.plan.is_none();
        let (near, work) = (&mut self.near, &mut self.work);
        let bonus = near.load(&self.around, work);
        let best = bonus.as_ref().map(|bonus| {
            let others = self.others.exploring();
            let others = others.flat_map(|other| {
                let is_lower = other.id < id;
                other.whereabouts().map(move |cell| (cell, is_lower))
            });
            let own = self.around.position;
            near.best(own, &aim, bonus, others, wants_any, work)
        });
        if let Some(best) = &best {
            let mine = near.mine(best, work);
            match mine {
                Some(candidate) if self.adopt_plan(candidate) => {
                    self.far.cancel();
                    return Near::Mine;
                }
                // Refused, and the way at hand goes on.
                Some(_) if self.next_step().is_some() => {
                    self.far.cancel();
                    return Near::Mine;
                }
                _ => {}
            }
        }
        let plan = self.role.plan.as_ref();
        if self.far.is_idle() {
            match plan.map(|plan| (plan.goal, plan.path.is_empty())) {
                Some((goal, true)) => {
                    self.far_is_doubtful = false;
                    self.far.start_route(goal, &self.around);
                }
                Some(_) if now < self.far_again => {}
                _ => self.start_sweep(),
            }
        }
        if let Some(best) = &best
            && self.role.plan.is_none()
            && let Some(candidate) = self.near.any(best, &mut self.work)
        {
            self.adopt_plan(candidate);
            return Near::Theirs;
        }
        Near::Nothing
    }

    /// The commitment rule: a longer plan than the one at hand costs a token, unless it
    /// is the rest of the way at hand. Says whether the candidate is the plan now.
    pub(super) fn adopt_plan(&mut self, candidate: Candidate) -> bool {
        self.role.since = 0;
        if candidate.path.is_empty() {
            return false;
        }
        if let Some(plan) = &self.role.plan
            && candidate.length > plan.remaining
        {
            let is_rest = plan.path.is_empty() && candidate.goal == plan.goal;
            if is_rest {
                self.role.measure_rest(candidate.length);
            } else if self.role.changes >= self.config.tokens {
                return false;
            } else {
                self.role.changes += 1;
            }
        }
        self.last_goal = Some(candidate.goal);
        self.take(candidate);
        true
    }

    /// The far search met no frontier that is worth a look.
    pub(super) fn conclude(&mut self) -> Option<Stop> {
        if self.far_is_doubtful {
            return None;
        }
        if !self.around.visits.is_empty() {
            // No way leads to them.
            self.around.visits.clear();
            self.far_is_doubtful = true;
            return None;
        }
        let frontiers = self.around.map.frontiers();
        if frontiers == 0 {
            return Some(Stop::nothing_left(self.around.map.free_edge_cells()));
        }
        let now = self.around.now;
        // Of the map's frontiers nobody knows how many are the body's.
        let most = match self.around.clearance {
            0 => frontiers,
            _ => u32::MAX,
        };
        match self.around.aside.verdict(self.config.patience, most, now) {
            Verdict::Nothing if self.link.hearsay().cells > 0 => Some(Stop::Enclosed { frontiers }),
            Verdict::Nothing => Some(Stop::OutOfReach { frontiers }),
            Verdict::Blocked(at) => Some(Stop::Blocked { frontiers, at }),
            Verdict::Held(at) => Some(Stop::Held { frontiers, at }),
            Verdict::Unseen(at) => Some(Stop::Unseen { frontiers, at }),
            Verdict::Wait => {
                self.waiting = Maybe::Just(Wait::Closed);
                None
            }
            Verdict::Again => {
                self.around.aside.next_round(self.config.patience, now);
                self.begin_round();
                None
            }
        }
    }

    /// A round begins: what was set aside is tried again, in whatever body.
    pub(super) fn begin_round(&mut self) {
        self.far_is_doubtful = true;
        self.role.lost = 0;
    }
}
