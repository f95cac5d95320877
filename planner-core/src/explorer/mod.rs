//! The complete explorer: bounded work per tick, no matter how large the map is
//! and how many robots there are.
//!
//! Near decisions (`window`) choose among the frontiers around the robot; where
//! it has none of its own there, a search over the whole map (`far`) runs in
//! the background, with what the near decision leaves of the tick's slice, while the
//! robot keeps walking. What makes it
//! complete is the *commitment* rule: since the robot last learnt anything, it
//! may change to a longer plan only a fixed number of times.
//!
//! Let U be the number of cells unknown to the robot; it never grows. While a
//! frontier can be reached, U falls in bounded time: take (changes left, steps
//! left) in lexicographic order; a step lowers the second, a change to a longer
//! plan the first, a search ends after a number of slices bounded by the map, and
//! at the end of a plan the robot stands on a frontier cell and sees its unknown
//! neighbour. If no frontier can be reached, the cells known around the robot are
//! closed off by obstacles: it has seen everything that it can reach. Messages
//! were not used: each robot alone is complete, and any message, late, twice, out
//! of order or lost, only makes U fall sooner.

mod closed;
mod far;
mod lean;
mod maybe;
mod others;
mod patch;
mod path;
mod purse;
mod role;
mod surroundings;
mod wave;
mod window;

pub use others::MAX_OTHERS;
pub use role::{Role, exchange};

use closed::ClosedCells;
use far::{FarSearch, Outcome};
use maybe::Maybe;
use others::Others;
use role::Plan;
use surroundings::Surroundings;
use window::{Aim, Candidate, NearSearch};

use crate::cell::{Cell, Direction, Extent};
use crate::map::{ExtentError, Learnt, Map, TileIndex, TileSet};
use crate::planner::Planner;
use crate::radio::{FrameError, Heard, Hearsay, Link, LinkConfig, MAX_LEN};
use crate::robot::{Action, Activity, Motion, RobotId, Status, Stop};
use crate::sight::Sighting;

/// How an explorer decides. One configuration serves a whole fleet; none of it
/// depends on the map's size or the number of robots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Config {
    /// Work a tick. The near decision takes of it what it needs, the far search gets
    /// the rest, and a quarter at least. 4096 instead of 2304 saves about 1 % of the
    /// ticks of an exploration, and its longest ticks take nearly twice the time.
    pub slice: u32,
    /// Steps after which the robot decides again.
    pub d_max: u8,
    /// Changes to a longer plan between two things learnt.
    pub tokens: u8,
    /// By how many steps a frontier near the goal chosen last is preferred.
    pub hysteresis: u8,
    /// Ticks that a far goal is kept before another is searched for.
    pub far_pause: u32,
    /// Ticks after which a robot that was not heard of is forgotten.
    pub memory: u32,
    /// Refusals after which a cell is not waited for any more, if nothing else is left.
    pub patience: u8,
    /// How the radio is used.
    pub link: LinkConfig,
}

impl Config {
    /// The configuration that is shipped.
    pub const fn new() -> Self {
        Self {
            slice: 2304,
            d_max: 2,
            tokens: 2,
            hysteresis: 3,
            far_pause: 8,
            memory: 256,
            patience: 8,
            link: LinkConfig::new(),
        }
    }

    /// No [`Planner::tick`] counts more work than this. The unit is a row of the near
    /// decision's window; whatever else is counted is weighed so that a unit takes about
    /// as long on a chip, near 105 instructions of a Cortex-M4.
    pub const fn work_bound(&self) -> u32 {
        let with_least = NearSearch::LARGEST_WORK + self.least_far() + far::WAY_WORK;
        let most = if self.slice > with_least {
            self.slice
        } else {
            with_least
        };
        most.saturating_add(far::LAST_TILE_WORK)
    }

    /// What the far search gets of a tick in any case.
    const fn least_far(&self) -> u32 {
        self.slice / 4 + 1
    }
}

impl Default for Config {
    fn default() -> Self {
        Self::new()
    }
}

/// What the near decision has come to.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Near {
    /// This robot goes to a frontier that it is nearest to.
    Mine,
    /// It had no plan, and goes to one that others are nearer to.
    Theirs,
    /// It goes on with what it had.
    Nothing,
}

/// The complete planner with bounded work.
pub struct Explorer<const TW: usize, const TH: usize> {
    config: Config,
    id: RobotId,
    around: Surroundings<TW, TH>,
    role: Role,
    others: Others,
    link: Link<TH>,
    near: NearSearch,
    far: FarSearch<TW, TH>,
    /// The goal chosen last.
    last_goal: Option<Cell>,
    /// No new far search before this tick while there is a plan.
    far_again: u32,
    /// Whether the map has changed, or a cell was closed, since the far search began.
    far_is_doubtful: bool,
    /// Whether the last tick asked for the first step of the plan.
    stepping: bool,
    work: u32,
}

impl<const TW: usize, const TH: usize> Explorer<TW, TH> {
    /// An explorer without a map; a `static` of it costs no flash. Call
    /// [`reset`](Self::reset) before use: until then it only waits.
    pub const fn vacant() -> Self {
        Self {
            config: Config {
                slice: 0,
                d_max: 0,
                tokens: 0,
                hysteresis: 0,
                far_pause: 0,
                memory: 0,
                patience: 0,
                link: LinkConfig::vacant(),
            },
            id: RobotId(0),
            around: Surroundings {
                map: Map::vacant(),
                closed: ClosedCells::new(),
                position: Cell::new(0, 0),
                now: 0,
            },
            role: Role::new(RobotId(0)),
            others: Others::new(),
            link: Link::vacant(),
            near: NearSearch::new(),
            far: FarSearch::new(),
            last_goal: None,
            far_again: 0,
            far_is_doubtful: false,
            stepping: false,
            work: 0,
        }
    }

    /// An explorer on a grid of `extent`, standing on `start`.
    ///
    /// # Errors
    /// The grid does not fit the map.
    pub fn new(
        config: Config,
        id: RobotId,
        extent: Extent,
        start: Cell,
    ) -> Result<Self, ExtentError> {
        let mut explorer = Self::vacant();
        explorer.reset(config, id, extent, start)?;
        Ok(explorer)
    }

    /// Starts anew, in place.
    ///
    /// # Errors
    /// The grid does not fit the map; the explorer is then unchanged.
    pub fn reset(
        &mut self,
        config: Config,
        id: RobotId,
        extent: Extent,
        start: Cell,
    ) -> Result<(), ExtentError> {
        self.around.map.reset_with(extent, start)?;
        self.around.closed = ClosedCells::new();
        self.around.position = start;
        self.around.now = 0;
        self.config = config;
        self.id = id;
        self.role = Role::new(id);
        self.others = Others::new();
        self.link.reset(config.link, id, extent);
        self.far.cancel();
        self.last_goal = None;
        self.far_again = 0;
        self.far_is_doubtful = false;
        self.stepping = false;
        self.work = 0;
        Ok(())
    }

    fn learn(&mut self, learnt: Learnt) -> Learnt {
        if learnt.anything() {
            self.role.used = 0;
            self.far_is_doubtful = true;
            self.around.closed.renew();
        }
        learnt
    }

    /// Goes on with the far search, with what the near decision has left of the slice.
    fn search_far(&mut self) -> Outcome {
        if self.far.is_idle() {
            return Outcome::Searching;
        }
        if self.around.closed_now().next().is_some() {
            self.far_is_doubtful = true;
        }
        let left = self.config.slice.saturating_sub(self.work + far::WAY_WORK);
        let left = left.max(self.config.least_far());
        self.far.advance(&self.around, left, &mut self.work)
    }

    fn start_sweep(&mut self) {
        self.far_is_doubtful = false;
        self.far.start_sweep(self.id, &self.others, &self.around);
    }

    /// The plan, if it is still worth following.
    fn valid_plan(&self) -> Option<&Plan> {
        self.role.plan.as_ref().filter(|plan| {
            plan.remaining > 0
                && self.around.map.is_frontier(plan.goal)
                && !self.around.is_closed(plan.goal)
        })
    }

    /// Decides among the frontiers nearby, and which far search is to run if none of
    /// them is this robot's own. A robot without a plan then gets the best one of others.
    fn decide_near(&mut self) -> Near {
        let (now, id) = (self.around.now, self.id);
        self.role.since = 0;
        let knows_all = self.others.are_all_fresh(now);
        let aim = Aim {
            goal: self.last_goal,
            hysteresis: self.config.hysteresis,
            lean: (!knows_all).then_some(id),
        };
        let bonus = self.near.load(&self.around, &mut self.work);
        if let Some(bonus) = &bonus {
            let others = self.others.exploring();
            let others = others.flat_map(|other| {
                let is_lower = other.id < id;
                other.whereabouts().map(move |cell| (cell, is_lower))
            });
            let mine = self
                .near
                .best(&self.around, &aim, bonus, others, &mut self.work);
            if let Some(candidate) = mine {
                self.far.cancel();
                self.adopt_plan(candidate);
                return Near::Mine;
            }
        }
        let plan = self.role.plan.as_ref();
        if self.far.is_idle() {
            match plan.map(|plan| (plan.goal, plan.path.is_empty())) {
                Some((goal, true)) => {
                    self.far_is_doubtful = false;
                    self.far.start_route(goal);
                }
                Some(_) if now < self.far_again => {}
                _ => self.start_sweep(),
            }
        }
        if let Some(bonus) = &bonus
            && self.role.plan.is_none()
        {
            let others = core::iter::empty();
            let theirs = self
                .near
                .best(&self.around, &aim, bonus, others, &mut self.work);
            if let Some(candidate) = theirs {
                self.adopt_plan(candidate);
                return Near::Theirs;
            }
        }
        Near::Nothing
    }

    /// The commitment rule: a longer plan than the one at hand costs a token.
    fn adopt_plan(&mut self, candidate: Candidate) {
        self.role.since = 0;
        if candidate.path.is_empty() {
            return;
        }
        if let Some(plan) = &self.role.plan
            && candidate.length > plan.remaining
        {
            if self.role.used >= self.config.tokens {
                return;
            }
            self.role.used += 1;
        }
        self.last_goal = Some(candidate.goal);
        self.role.plan = Some(Plan {
            goal: candidate.goal,
            remaining: candidate.length,
            path: candidate.path,
        });
    }

    /// The far search met no frontier.
    fn conclude(&mut self) -> Option<Stop> {
        let frontiers = self.around.map.frontiers();
        if !self.far_is_doubtful {
            return Some(Stop::Enclosed { frontiers });
        }
        let hopeless = self
            .around
            .closed
            .hopeless(self.config.patience, self.around.now);
        hopeless.map(|at| Stop::Blocked { frontiers, at })
    }

    fn stop(&mut self, stop: Stop) -> Action {
        self.role.plan = None;
        self.role.stopped = Maybe::Just(stop);
        self.far.cancel();
        Action::Stop(stop)
    }

    /// The next step of the plan, if it can be made.
    fn next_step(&self) -> Option<Direction> {
        let step = self.role.plan.as_ref()?.path.first()?;
        let next = self.around.position.step(step);
        (self.around.map.is_free(next) && !self.around.is_closed(next)).then_some(step)
    }
}

impl<const TW: usize, const TH: usize> Planner<TW, TH> for Explorer<TW, TH> {
    fn observe(&mut self, sighting: &Sighting) -> Learnt {
        if sighting.centre() != self.around.position {
            // Carried elsewhere: the way starts somewhere else now.
            self.around.position = sighting.centre();
            self.role.plan = None;
        }
        let learnt = self.around.map.observe(sighting);
        self.others.purse.saw(learnt.cells);
        self.link.look(sighting);
        self.around.map.visit(self.around.position);
        self.link.announce(&mut self.around.map);
        self.learn(learnt)
    }

    fn tick(&mut self) -> Action {
        self.around.now = self.around.now.saturating_add(1);
        self.link.tick();
        self.work = 0;
        self.stepping = false;
        if let Some(stop) = self.role.stopped.get() {
            return Action::Stop(stop);
        }
        if self.around.map.frontiers() == 0 {
            // Nothing seen yet is not the same as nothing left.
            if self.around.map.is_known(self.around.position) {
                return self.stop(Stop::nothing_left(self.around.map.free_edge_cells()));
            }
            return Action::Wait;
        }
        self.others.forget(self.around.now, self.config.memory);
        if self.others.pay(&self.around.map) {
            // It was made of hints.
            self.far.cancel();
        }
        let plan = self.valid_plan();
        if plan.is_none_or(|plan| !plan.path.is_empty() && self.next_step().is_none()) {
            self.role.plan = None;
        }
        let due = self.role.since >= self.config.d_max || self.next_step().is_none();
        let near = if due {
            self.decide_near()
        } else {
            Near::Nothing
        };
        if near != Near::Mine {
            match self.search_far() {
                Outcome::Searching => {}
                Outcome::Found(candidate) => {
                    self.far_again = self.around.now.saturating_add(self.config.far_pause);
                    if near == Near::Theirs {
                        self.role.plan = None;
                    }
                    self.adopt_plan(candidate);
                }
                Outcome::NothingLeft => {
                    if let Some(stop) = self.conclude() {
                        return self.stop(stop);
                    }
                }
                Outcome::Lost => {
                    // A plan whose rest cannot be found is none.
                    let plan = self.role.plan.as_ref();
                    if plan.is_some_and(|plan| plan.path.is_empty()) {
                        self.role.plan = None;
                    }
                }
            }
        }
        match self.next_step() {
            Some(step) => {
                self.stepping = true;
                Action::Move(step)
            }
            None => Action::Wait,
        }
    }

    fn resume(&mut self) {
        self.role.stopped = Maybe::Nothing;
        self.role.used = 0;
        self.around.closed = ClosedCells::new();
        self.far.cancel();
    }

    fn report(&mut self, motion: Motion) {
        let plan = self.role.plan.filter(|_| self.stepping);
        self.stepping = false;
        let Some(step) = plan.and_then(|plan| plan.path.first()) else {
            return;
        };
        let next = self.around.position.step(step);
        match motion {
            Motion::Moved => {
                self.around.position = next;
                self.around.closed.entered(next);
                self.role.make_step();
            }
            Motion::Blocked => {
                self.around.closed.refuse(next, self.around.now);
                self.role.plan = None;
                self.role.used = 0;
                self.far.cancel();
            }
            Motion::Held => {}
        }
    }

    fn map(&self) -> &Map<TW, TH> {
        &self.around.map
    }

    fn status(&self) -> Status {
        Status {
            position: self.around.position,
            goal: self.role.plan.map(|plan| plan.goal),
            activity: if self.role.has_stopped() {
                Activity::Stopped
            } else {
                Activity::Exploring
            },
        }
    }

    fn transmit(&mut self, buffer: &mut [u8; MAX_LEN]) -> Option<usize> {
        let status = self.status();
        self.link.transmit(&self.around.map, status, buffer)
    }

    fn receive(&mut self, bytes: &[u8]) -> Result<Heard, FrameError> {
        let heard = self.link.receive(bytes, &mut self.around.map)?;
        self.learn(heard.learnt);
        if let Some(status) = heard.status {
            self.hear(heard.from, status);
        }
        Ok(heard)
    }

    fn hearsay(&self) -> Hearsay {
        self.link.hearsay()
    }

    fn take_changed(&mut self) -> TileSet<TH> {
        self.link.take_changed(&mut self.around.map)
    }

    fn join(&mut self, other: &Map<TW, TH>, tiles: &TileSet<TH>) -> Learnt {
        let learnt = self.around.map.join_tiles(other, tiles);
        self.link.joined(learnt);
        self.learn(learnt)
    }

    fn hear(&mut self, id: RobotId, status: Status) {
        if id != self.id {
            self.others
                .hear(id, status, self.around.position, self.around.now);
        }
    }

    fn work(&self) -> u32 {
        self.work
    }

    fn role(&self) -> Option<Role> {
        Some(self.role)
    }

    fn searched(&self, at: TileIndex) -> u64 {
        self.far.searched(at)
    }

    fn adopt(&mut self, role: Role) {
        self.role = role;
        self.stepping = false;
        self.far.cancel();
    }
}

#[cfg(test)]
mod tests;
