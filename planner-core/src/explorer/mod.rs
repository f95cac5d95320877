//! The complete explorer: bounded work per tick, no matter how large the map is
//! and how many robots there are.
//!
//! Near decisions (`near`) choose among the frontiers around the robot; where
//! it has none of its own there, a search over the whole map (`far`) runs in
//! the background, with what the near decision leaves of the tick's slice, while the
//! robot keeps walking. What makes it complete is the *commitment* rule: since the robot
//! last learnt anything, it may change to a longer plan only a fixed number of times.
//!
//! # Premise
//! - Looks may say anything of any cell but the robot's own, and change their mind; so may
//!   messages, hints and the other robots. Cells may refuse a step, for a while or for
//!   ever, and no look need show that.
//! - The robot is where its poses say, or they lie off the grid, for a while.
//! - The robot can stand on any cell that is free and does not refuse.
//!
//! That every robot stops asks for no more. That it then tells the truth asks for looks
//! that are right often enough: see below.
//!
//! # Why every robot stops
//! Levels of cells only rise ([`Level`](crate::map::Level), 0 to 7). Let Φ be the sum of
//! `7 - level` over all cells: at most 7N for N cells, and it never grows. Whatever is
//! learnt, seen or heard, lowers it. So there are at most 7N *spells*, stretches in which
//! nothing is learnt, and it is to be shown that in each the robot stops or learns after a
//! bounded number of ticks. Take, in lexicographic order:
//!
//! 1. rounds left (`aside`), twice the patience at most. A round ends by time or when
//!    nothing else is left, and its number falls only when something is learnt;
//! 2. cells not set aside in this round: each refusal and each look that was in vain
//!    lowers it, and only the next round raises it;
//! 3. changes left: the tokens, and one more for a plan that was made before the spell
//!    began or a cell was set aside, whose length may be wrong by now;
//! 4. steps left of the plan; without a plan, looks left where the robot stands.
//!
//! Every tick lowers this, or a search or a wait goes on that ends by itself:
//! - *Stopped, off the grid, or nothing seen yet*: nothing is decided.
//! - *No frontier on the map*: it stops, or waits 8 ticks at most since it last learnt
//!   something, where a look contradicts a wall; or it goes and looks at what it was told
//!   to be shut (`stopping`), once after it was told so, which lowered Φ.
//! - *Hints do not count any more* (`purse`): the far search begins again, once until new
//!   cells fill the purse.
//! - *The plan is dropped*: its goal was reached; or its goal or its next cell was set
//!   aside, which lowered 2. (Were either known otherwise now, something was learnt.)
//! - *Without a plan on a frontier cell* (`look`): a look is made; after the last one the
//!   cell is set aside. Where a cell beside it is doubtful, that is not before the margin
//!   has fallen to one vote (`evidence`): 8 barren ticks for each vote more than one. The
//!   next look that says anything of the doubtful cell then decides it.
//! - *The near decision is due and finds a frontier of the robot's own* (`decide_near`).
//!   It becomes the plan: if it is longer, a token is gone; if not, a step follows. Or it
//!   is refused: then the way at hand goes on, with a step; or the way at hand is used
//!   up, and nothing cancels the search for its rest.
//! - *It finds none of its own*: the plan at hand, another's frontier or none is kept, and
//!   the far search goes on, or begins where none is under way.
//! - *The far search* does a quarter of a slice at least in every tick without a new
//!   plan, and has a number of slices that the map bounds: each of its rounds forgets every
//!   cell, then reaches each at most once for each label (what the queue had no room for is
//!   found by looking at all cells again, and only after at least one more was reached);
//!   each round but the last of a pass serves a robot, and there are a few passes. Then a
//!   wave of the robot's own runs, then each step of a way is turned around once, or a
//!   route is searched for, which reaches each cell once. Its end is one of these:
//!   - *A way was found*: as with the near decision. The rest of the way at hand is
//!     always taken: only for a plan of before the spell, or before a cell was set aside,
//!     can it be longer than what was left.
//!   - *A way was lost*: something was learnt or set aside since it was begun; a plan
//!     without a way is dropped.
//!   - *Nothing is left* (`conclude`): if the map or what is set aside has changed since
//!     it began, it begins again. Otherwise the robot stops, waits for the end of the
//!     round, or begins the next one.
//! - *A step is vetoed* (`ahead`): the last look saw something there. It waits 8 ticks at
//!   most; what then is still seen counts as a refusal, which lowers 2, or the step is tried.
//! - *A pose that no report told* (`way`) leads on along the way, which lowers 4; or back to
//!   it, by two steps at most, or the plan is dropped: whoever moves the robot so for ever
//!   lets it go on for ever.
//! - *A step* lowers 4 ([`Motion::Moved`]) or 2 ([`Motion::Blocked`]); if it was held
//!   ([`Motion::Held`]), the robot counts up to [`Config::holds`] until it made a step, and
//!   takes the last one for a refusal.
//!
//! Paths that are shorter than the way (256 steps, [`Config::way`]) change nothing: their
//! rest is a search that ends. Hints only choose which frontier comes first, and which
//! near ones are another's: each case above holds whatever they are.
//!
//! Let D be the longest way on the map, F the ticks of a far search, N the cells, p the
//! patience: a spell has at most 2p·N·(tokens + 2)·(D + F + 4·looks + holds) ticks, and
//! 4·(p + 1)·2ᵖ of waiting; D counts a step as 9 ticks where it is vetoed, and looks count
//! the barren ones.
//!
//! # A body
//! With a [`Config::clearance`] all of this is said of configuration space (`body`): a wall
//! is a cell from which the body would touch one, free is where it has room, and a cell is
//! doubtful where that is not known. These states change only when something is learnt, and
//! a look from an open cell, with nothing in its disc, decides those beside it: so frontiers,
//! ways and rounds are as above. Two things are less: how many frontiers are left is not
//! known before a wave has looked for them, and roles are not exchanged. A body that is in
//! the way of a step holds it up (3), and then counts as a refusal of all cells from which
//! it would be touched (2). "Complete" then means that the map holds every cell that the
//! body can sweep from where it is; of what it cannot enter, as much as was seen on the way
//! ([`Inspect::narrow_cells`]).
//! A robot on an errand, or with little energy, decides by `mission`, which says why that
//! ends too: an errand is begun by the user or when the robot is done, once for each thing
//! learnt.
//!
//! # Cells that it keeps out of
//! The map has walls there, as beyond its edge, whatever looks and others say: all of this
//! holds as in a place with walls there.
//!
//! # Why its reason is true
//! The robot's last wave covered every cell that free cells connect with it. If nothing was
//! set aside, it met no frontier, so these cells are closed off by cells that were decided
//! to be walls: everything that can be reached is known, if they are. With a truthful
//! sensor they are. With votes that are wrong with probability `p` and independent, each is
//! a wall wrongly with the probability that [`SensorModel`] states for its margin; with
//! fewer wrong looks a cell than the margin, none is. What a robot was told it takes as
//! decided, until it sees the contrary from near. A wall that was free before (a door that
//! is shut) is named beside the stop ([`Map::shut`]): "complete" is *as seen*. For the
//! reason "complete" alone each neighbour of a cell that the robot stands on must be shown
//! by one of the looks that it makes there, after it was asked to turn to it
//! ([`Wait::Look`]).
//!
//! In the last round every cell that was closed refused a
//! step in this very round, and no time reopens it: whatever can be reached past them was
//! reached, however many there are.
//!
//! Where robots may not share a cell, roles walk and bodies stay ([`exchange`](crate::role::exchange)): the
//! lowest role that is active is never pushed back and never waits, so it stops; then the
//! next one is the lowest. Where looks show nothing or cells refuse, bodies have set aside
//! different cells, and a role may find its plan worthless in the next one. After four
//! plans lost so, bodies are obstacles to it until a round ends or it learns something,
//! and each robot stops as shown above, with a reason that names the one in its way.
//!
//! [`Motion::Moved`]: crate::Motion::Moved
//! [`Motion::Blocked`]: crate::Motion::Blocked
//! [`Motion::Held`]: crate::Motion::Held
//! [`Inspect::narrow_cells`]: crate::planner::Inspect::narrow_cells

mod ahead;
mod aside;
mod body;
mod clearance;
mod config;
mod decide;
mod evidence;
mod far;
mod interface;
mod lean;
mod logs;
mod looking;
mod mission;
mod near;
mod others;
mod patch;
mod purse;
mod queue;
mod recentre;
mod saving;
mod stopping;
mod surroundings;
mod wave;
mod way;
mod window;

pub use body::{MAX_CLEARANCE, bodies_touch, body_cells};
pub use config::Config;
pub use evidence::{SensorModel, Votes};
pub use others::MAX_OTHERS;
pub use recentre::{MOST_MOVES, MoveError};

use ahead::Ahead;
use aside::Aside;
use decide::Near;
use evidence::Evidence;
use far::{FarSearch, Outcome};
use mission::Budget;
use near::NearSearch;
use others::Others;
use surroundings::Surroundings;

use heapless::Vec;

use crate::cell::{Cell, Direction, Extent, ExtentError};
use crate::map::{Learnt, Map};
use crate::radio::Link;
use crate::robot::{Action, RobotId, Stop, Wait};
use crate::role::Role;
use crate::zeroed::Maybe;

/// Work of a tick that decides nothing.
const TICK_WORK: u32 = 1500;

/// So many cells that are told to be walls at once and were free are no error of a look.
const MANY_SHUT: u32 = 4;

/// The complete planner with bounded work.
pub struct Explorer<const TW: usize, const TH: usize> {
    config: Config,
    id: RobotId,
    around: Surroundings<TW, TH>,
    evidence: Evidence,
    role: Role,
    others: Others,
    link: Link<TH>,
    near: NearSearch,
    far: FarSearch<TW, TH>,
    budget: Budget,
    /// The goal chosen last.
    last_goal: Option<Cell>,
    /// No new far search before this tick while there is a plan.
    far_again: u32,
    /// No new visits of shut places before this tick.
    patrol_again: u32,
    /// Whether the map has changed, or what is set aside, since the far search began.
    far_is_doubtful: bool,
    /// Whether the last tick asked for the first step of the plan.
    stepping: bool,
    /// Whether the last pose lay off the grid, or where the robot keeps out.
    is_astray: bool,
    /// Looks from where the body stands that were asked for, whatever its role.
    looks: u8,
    /// Steps that were held since the last one that was made.
    holds: u8,
    ahead: Ahead,
    /// Ticks waited before a stop since something was learnt.
    doubts: u8,
    /// Whether others have told of many cells as walls that were free, since it went and
    /// looked itself.
    was_told_shut: bool,
    /// Moves of the grid since the last stop.
    moves: u8,
    waiting: Maybe<Wait>,
    work: u32,
}

impl<const TW: usize, const TH: usize> Explorer<TW, TH> {
    /// An explorer without a map; a `static` of it costs no flash. Call
    /// [`reset`](Self::reset) before use: until then it only waits.
    pub const fn vacant() -> Self {
        Self {
            config: Config::vacant(),
            id: RobotId(0),
            around: Surroundings {
                map: Map::vacant(),
                aside: Aside::new(),
                visits: Vec::new(),
                position: Cell::new(0, 0),
                now: 0,
                clearance: 0,
            },
            evidence: Evidence::new(),
            role: Role::new(RobotId(0), Cell::new(0, 0)),
            others: Others::new(),
            link: Link::vacant(),
            near: NearSearch::new(),
            far: FarSearch::new(),
            budget: Budget::new(),
            last_goal: None,
            far_again: 0,
            patrol_again: 0,
            far_is_doubtful: false,
            stepping: false,
            is_astray: false,
            looks: 0,
            holds: 0,
            ahead: Ahead::new(),
            doubts: 0,
            was_told_shut: false,
            moves: 0,
            waiting: Maybe::Nothing,
            work: 0,
        }
    }

    /// An explorer on a grid of `extent`, standing on `start`.
    ///
    /// # Errors
    /// The grid does not fit the map, or the start lies outside of the grid.
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
    /// As [`new`](Self::new); the explorer is then unchanged.
    pub fn reset(
        &mut self,
        config: Config,
        id: RobotId,
        extent: Extent,
        start: Cell,
    ) -> Result<(), ExtentError> {
        self.around.map.reset_with(extent, start)?;
        self.start(config, id, start);
        Ok(())
    }

    /// Starts with the map at hand.
    fn start(&mut self, config: Config, id: RobotId, start: Cell) {
        self.around.aside.reset();
        self.around.visits.clear();
        self.around.position = start;
        self.around.now = 0;
        self.around.clearance = config.clearance.min(MAX_CLEARANCE);
        self.evidence.reset();
        self.config = config;
        self.id = id;
        self.role = Role::new(id, start);
        self.others = Others::new();
        self.link.reset(config.link, id, self.around.map.extent());
        self.far.cancel();
        self.budget = Budget::of(config.energy);
        self.last_goal = None;
        self.far_again = 0;
        self.patrol_again = 0;
        self.far_is_doubtful = false;
        self.stepping = false;
        self.is_astray = false;
        self.looks = 0;
        self.holds = 0;
        self.ahead = Ahead::new();
        self.doubts = 0;
        self.was_told_shut = false;
        self.moves = 0;
        self.waiting = Maybe::Nothing;
        self.work = 0;
        let extent = self.around.map.extent();
        log!(
            info,
            "robot {}: starts at {} of {} cells",
            id.0,
            start,
            extent
        );
    }

    fn learn(&mut self, learnt: Learnt) {
        if learnt.anything() {
            self.role.changes = 0;
            self.role.lost = 0;
            self.looks = 0;
            self.far_is_doubtful = true;
            if learnt.cells > 0 {
                self.around.aside.renew();
            }
            self.evidence.renew();
            self.doubts = 0;
            if learnt.opened > 0 {
                self.around.keep_visits();
            }
            self.learn_on_errand(learnt);
        }
    }

    /// As [`learn`](Self::learn), of what others told. Where they call the robot's own
    /// place an obstacle, its place wins.
    fn learn_from_others(&mut self, mut learnt: Learnt) -> Learnt {
        let position = self.around.position;
        if self.around.map.extent().contains(position) && self.around.map.is_obstacle(position) {
            learnt += self.around.map.stand(position);
        }
        self.learn(learnt);
        if learnt.closed > 0 {
            self.evidence.dispute();
            self.was_told_shut |= learnt.closed >= MANY_SHUT;
        }
        learnt
    }

    /// Whether there is a plan that is worth following.
    fn has_plan(&self) -> bool {
        let Some(plan) = &self.role.plan else {
            return false;
        };
        plan.remaining > 0
            && plan.goal != self.around.position
            && self.around.is_goal(plan.goal)
            && self.around.is_open(plan.goal)
            && (plan.path.is_empty() || self.next_step().is_some())
    }

    /// Drops the plan. If it led to no frontier that is worth a look, it was made in
    /// another body, which had set other cells aside (or something was learnt since).
    fn lose_plan(&mut self) {
        let here = self.around.position;
        let goal = self.role.goal();
        if goal.is_some_and(|goal| goal != here || !self.around.is_goal(here)) {
            self.role.lose_plan();
        }
        self.role.plan = None;
    }

    /// A step was refused: the plan leads nowhere, and others may be as good now.
    fn refuse(&mut self, cell: Cell, by_robot: bool) {
        self.around.aside.refuse(cell, by_robot, self.around.now);
        self.far_is_doubtful = true;
        self.role.plan = None;
        self.role.changes = 0;
        self.holds = 0;
        self.far.cancel();
        self.budget.doubt();
    }

    fn wait(&mut self, reason: Wait) -> Action {
        self.waiting = Maybe::Just(reason);
        Action::Wait
    }

    /// Makes the next step of the plan, or waits.
    fn act(&mut self) -> Action {
        match self.next_step() {
            Some(step) if self.keeps_apart(step) || self.vetoes(step) => {
                self.wait(Wait::Obstructed)
            }
            Some(step) => {
                self.stepping = true;
                Action::Move(step)
            }
            None => {
                let reason = self.waiting.get().unwrap_or(Wait::Search);
                self.wait(reason)
            }
        }
    }

    /// The tick itself.
    fn decide(&mut self) -> Action {
        self.around.now = self.around.now.saturating_add(1);
        self.link.tick();
        self.evidence.tick();
        self.work = TICK_WORK;
        if self.around.clearance > 0 {
            self.work += body::CELLS_WORK;
        }
        self.stepping = false;
        self.waiting = Maybe::Nothing;
        self.role.has_arrived = false;
        if let Some(stop) = self.role.stopped.get() {
            return Action::Stop(stop);
        }
        if self.is_astray {
            return self.wait(Wait::Pose);
        }
        if !self.around.map.is_known(self.around.position) {
            // Nothing seen yet is not the same as nothing left.
            return self.wait(Wait::Sight);
        }
        if let Some(action) = self.mind_mission() {
            return action;
        }
        if self.around.is_done() {
            let edge = self.around.map.free_edge_cells();
            return self.finish(Stop::nothing_left(edge));
        }
        self.others
            .forget(self.id, self.around.now, self.config.memory);
        if self.others.pay(&self.around.map) {
            // It was made of hints.
            self.far.cancel();
        }
        let now = self.around.now;
        if self.around.aside.tick(self.config.patience, now) {
            self.begin_round();
        }
        if !self.has_plan() {
            self.lose_plan();
        }
        // Where one vote decides, nothing hangs on it.
        let may_fall = self.config.sensor.barren_looks() > 0;
        if may_fall && self.around.is_goal(self.around.position) {
            self.evidence.rest();
        }
        if let Some(direction) = self.look() {
            return self.wait(Wait::Look(direction));
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
                    self.far_again = now.saturating_add(self.config.far_pause);
                    if near == Near::Theirs {
                        self.role.plan = None;
                    }
                    self.adopt_plan(candidate);
                }
                Outcome::NothingLeft => {
                    if let Some(stop) = self.conclude() {
                        return self.finish(stop);
                    }
                }
                Outcome::Lost => {
                    // A plan whose rest cannot be found is none.
                    let plan = self.role.plan.as_ref();
                    if plan.is_some_and(|plan| plan.path.is_empty()) {
                        self.lose_plan();
                    }
                }
            }
        }
        self.act()
    }

    /// The next step of the plan, if it can be made.
    fn next_step(&self) -> Option<Direction> {
        let step = self.role.plan.as_ref()?.path.first()?;
        let next = self.around.position.step(step);
        self.around.is_open(next).then_some(step)
    }
}

#[cfg(test)]
mod tests;
