//! Errands and energy: the way to a cell or home, and when to turn back.
//!
//! # Energy
//! Let E be the steps that the energy lasts for, and D those of the shortest way home over
//! cells that can be entered. The robot makes a step that may lead away only if h + 2 ≤ E,
//! where h ≥ D: h grows by one with each step, for it can go back, and is D after a search.
//! So D ≤ E before and after each step. Where the rule forbids a step, it searches; if even
//! so D + 2 is more than E, it goes home, and each step of a shortest way takes one off
//! both. A wall that appears, or a cell that refuses, may be on the way that h counts: then
//! h is not known until a search has found it.
//!
//! # Why an errand ends
//! As in the proof of the whole: nothing is learnt and nothing is set aside but a bounded
//! number of times. Between, a search ends with a way, whose steps bring the robot nearer,
//! or without: then it waits for the end of a round, of which there is a last one, or stops.
//! Where an exchange of bodies takes it from where it had stopped, it goes back, a bounded
//! number of times too. A search for the way home is made at most once a step, and once whenever something is
//! learnt or set aside; in the ticks that it takes nothing else is decided.

use super::Explorer;
use super::aside::Verdict;
use super::body::body_cells;
use super::far::Outcome;
use crate::cell::Cell;
use crate::map::{CellSet, Learnt};
use crate::planner::{Errands, KeepOutError};
use crate::robot::{Action, Stop, Wait};
use crate::role::{End, Errand};
use crate::zeroed::Maybe;

/// What the robot can still spend, in steps.
#[derive(Clone, Copy, Debug)]
pub(super) struct Budget {
    /// Steps that the energy lasts for, if that was told.
    energy: Maybe<u32>,
    /// Steps of the way home at most; [`UNKNOWN`](Self::UNKNOWN) until it was searched for.
    way_home: u32,
    /// Until this tick it lets a robot pass that it exchanged bodies with.
    back_at: u32,
}

/// How often a robot that an exchange took from where it had stopped goes back, and how long
/// it waits before the first time; each time twice as long.
const MOST_RETURNS: u8 = 8;
const FIRST_PAUSE: u32 = 8;

impl Budget {
    const UNKNOWN: u32 = u32::MAX;

    pub(super) const fn new() -> Self {
        Self {
            energy: Maybe::Nothing,
            way_home: 0,
            back_at: 0,
        }
    }

    /// At home, with so much energy; 0: no limit.
    pub(super) const fn of(energy: u32) -> Self {
        let mut budget = Self::new();
        if energy > 0 {
            budget.energy = Maybe::Just(energy);
        }
        budget
    }

    pub(super) const fn is_limited(&self) -> bool {
        matches!(self.energy, Maybe::Just(_))
    }

    /// The way home may be another now.
    pub(super) fn doubt(&mut self) {
        self.way_home = Self::UNKNOWN;
    }

    pub(super) fn make_step(&mut self) {
        self.way_home = self.way_home.saturating_add(1);
        if let Maybe::Just(energy) = &mut self.energy {
            *energy = energy.saturating_sub(1);
        }
    }

    fn lasts_for(&self, steps: u32) -> bool {
        self.energy.get().is_none_or(|energy| steps <= energy)
    }

    /// Whether the robot can make a step to anywhere and still come home.
    fn allows_a_step(&self) -> bool {
        self.lasts_for(self.way_home.saturating_add(2))
    }
}

impl<const TW: usize, const TH: usize> Explorer<TW, TH> {
    /// What the robot does for its mission in this tick; `None`: it explores.
    #[inline]
    pub(super) fn mind_mission(&mut self) -> Option<Action> {
        if !self.has_errand() && !self.budget.is_limited() {
            return None;
        }
        self.mind_errand()
    }

    pub(super) const fn has_errand(&self) -> bool {
        matches!(self.role.errand, Maybe::Just(_))
    }

    #[inline(never)] // mostly there is none
    fn mind_errand(&mut self) -> Option<Action> {
        let now = self.around.now;
        self.others.forget(self.id, now, self.config.memory);
        if self.around.aside.tick(self.config.patience, now) {
            self.begin_round();
        }
        let here = self.around.position;
        if here == self.role.home {
            self.budget.way_home = 0;
        }
        let errand = self.role.errand.get();
        let goes_home = errand.is_some_and(|errand| !matches!(errand.end, End::Visit));
        if !goes_home && !self.budget.allows_a_step() {
            return Some(self.look_for_home());
        }
        let Some(errand) = errand else {
            if self.far.way_to().is_some() {
                self.far.cancel();
            }
            return None;
        };
        if here == errand.to {
            return Some(self.arrive(errand));
        }
        if now < self.budget.back_at {
            return Some(self.wait(Wait::Closed));
        }
        Some(self.walk(errand))
    }

    /// A step of the way, or what it takes to find one.
    fn walk(&mut self, errand: Errand) -> Action {
        if self.next_step().is_none() {
            if self.role.plan.is_some_and(|plan| !plan.path.is_empty()) {
                // In another body it was a way.
                self.role.lose_plan();
            }
            match self.search_way(errand.to) {
                // Rather than a way round that it cannot make, it tries again.
                Outcome::Found(way) if self.budget.lasts_for(way.length) || !self.may_open() => {
                    if self.role.plan.is_some() {
                        self.role.measure_rest(way.length);
                    }
                    self.take(way);
                }
                Outcome::Found(_) | Outcome::Lost => {
                    self.role.plan = None;
                    if let Some(why_not) = self.why_no_way(errand.to) {
                        self.role.errand = Maybe::Nothing;
                        return self.stop(why_not);
                    }
                }
                _ => {}
            }
        }
        self.act()
    }

    /// The errand stays: where others pass by exchanges of bodies, the robot goes back.
    fn arrive(&mut self, errand: Errand) -> Action {
        let frontiers = self.around.map.frontiers();
        let at = errand.to;
        self.stop(match errand.end {
            End::Visit => Stop::Arrived { frontiers, at },
            End::Home => Stop::Home { frontiers },
            End::Exploration(stop) => stop,
        })
    }

    /// The role that another body gave it has stopped where its errand led, and this body
    /// stands elsewhere: it lets the other one pass, and goes back, but not for ever.
    pub(super) fn go_back(&mut self) {
        let Some(errand) = self.role.errand.get() else {
            return;
        };
        if !self.role.has_stopped() || self.around.position == errand.to {
            return;
        }
        if self.role.returns >= MOST_RETURNS {
            let frontiers = self.around.map.frontiers();
            let at = errand.to;
            self.role.errand = Maybe::Nothing;
            self.role.stopped = Maybe::Just(Stop::Held { frontiers, at });
            return;
        }
        let pause = FIRST_PAUSE << self.role.returns;
        self.role.stopped = Maybe::Nothing;
        self.role.returns += 1;
        self.budget.back_at = self.around.now.saturating_add(pause);
    }

    /// Searches for the shortest way home, and turns back if nothing is left but that.
    fn look_for_home(&mut self) -> Action {
        let home = self.role.home;
        let is_over = if self.around.position == home {
            true
        } else {
            match self.search_way(home) {
                Outcome::Found(way) => {
                    self.budget.way_home = way.length;
                    !self.budget.allows_a_step() && !self.far_is_doubtful
                }
                Outcome::Lost => self.why_no_way(home).is_some(),
                _ => false,
            }
        };
        if is_over {
            // It searches once more, for cells that refused are tried anew.
            self.send(home, End::Home);
        }
        let reason = self.waiting.get().unwrap_or(Wait::Search);
        self.wait(reason)
    }

    /// Goes on looking for the shortest way to a cell.
    fn search_way(&mut self, to: Cell) -> Outcome {
        if self.far.way_to() != Some(to) {
            self.far_is_doubtful = false;
            self.far.start_way(to, &self.around);
        }
        self.search_far()
    }

    /// Whether there may be a shorter way than the one that was found, now or soon.
    fn may_open(&self) -> bool {
        self.far_is_doubtful || self.around.aside.has_refused()
    }

    /// No way was found: the reason to stop, if the robot is neither to search again nor to
    /// wait.
    fn why_no_way(&mut self, to: Cell) -> Option<Stop> {
        if self.far_is_doubtful {
            return None;
        }
        let frontiers = self.around.map.frontiers();
        let (patience, now) = (self.config.patience, self.around.now);
        match self.around.aside.verdict_on_ways(patience, now) {
            Verdict::Blocked(at) => Some(Stop::Blocked { frontiers, at }),
            Verdict::Held(at) => Some(Stop::Held { frontiers, at }),
            Verdict::Nothing | Verdict::Unseen(_) => Some(Stop::NoWay { frontiers, at: to }),
            Verdict::Wait => {
                self.waiting = Maybe::Just(Wait::Closed);
                None
            }
            Verdict::Again => {
                self.around.aside.next_round(patience, now);
                self.begin_round();
                None
            }
        }
    }

    /// From now on the robot goes there; what refused a step is tried anew.
    pub(super) fn send(&mut self, to: Cell, end: End) {
        self.go_on();
        self.role.errand = Maybe::Just(Errand { to, end });
        self.role.returns = 0;
        self.budget.back_at = 0;
    }

    /// Something was learnt. A robot that was done may have more to explore, and the way
    /// home may be another.
    pub(super) fn learn_on_errand(&mut self, learnt: Learnt) {
        if learnt.closed > 0 || self.around.aside.has_refused() {
            self.budget.doubt();
        }
        if let Maybe::Just(Errand {
            end: End::Exploration(_),
            ..
        }) = self.role.errand
            && !self.role.has_stopped()
        {
            self.role.errand = Maybe::Nothing;
            self.role.plan = None;
            self.far.cancel();
        }
    }

    /// The robot stands somewhere else than its steps led to.
    pub(super) fn lose_way_home(&mut self) {
        self.budget.doubt();
        if self.far.way_to().is_some() {
            self.far.cancel();
        }
    }
}

impl<const TW: usize, const TH: usize> Errands<TW, TH> for Explorer<TW, TH> {
    fn go_home(&mut self) -> bool {
        self.send(self.role.home, End::Home);
        true
    }

    fn go_to(&mut self, cell: Cell) -> bool {
        let is_inside = self.around.map.extent().contains(cell);
        if is_inside {
            self.send(cell, End::Visit);
        }
        is_inside
    }

    fn energy(&mut self, left: u32) -> bool {
        self.budget.energy = Maybe::Just(left);
        true
    }

    fn keep_out(&mut self, cells: Option<&'static CellSet<TW, TH>>) -> Result<(), KeepOutError> {
        if let Some(cells) = cells {
            let clearance = self.around.clearance;
            let reaches = |from| body_cells(clearance, from).any(|cell| cells.contains(cell));
            if reaches(self.around.position) {
                return Err(KeepOutError::Robot(self.around.position));
            }
            if reaches(self.role.home) {
                return Err(KeepOutError::Home(self.role.home));
            }
        }
        self.around.map.keep_out(cells);
        self.role.kept_out = cells.map_or(0, CellSet::digest);
        self.go_on();
        self.budget.doubt();
        Ok(())
    }
}

#[cfg(test)]
mod tests;
