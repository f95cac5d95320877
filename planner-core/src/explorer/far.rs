//! The far decision: who goes to which frontier beyond the window, and the way.
//!
//! The *sweep* is greedy matching, shortest pair first, computed from last heard
//! positions: everybody's waves run at once, and whoever meets a frontier that is
//! not taken is served. Robots heard on one cell are a group with one wave: they are
//! served in turn, by id. When every frontier is spoken for, the pass ends at once.
//!
//! Where this robot is served, its wave has left the way: it is turned around, from the
//! frontier back. Where the wave met others, that way may go round them, and the robot may
//! have walked on meanwhile: then a *route* is searched for, by a wave from the frontier
//! that ends where it meets the robot.

use heapless::Vec;

use super::body::WINDOW_WORK;
use super::near::Candidate;
use super::others::Others;
use super::patch::connected;
use super::surroundings::{Layer, Surroundings};
use super::wave::{Event, LABELS, Labels, STEP_WORK, Wave};
use crate::cell::{Cell, Direction};
use crate::robot::RobotId;
use crate::role::{self, Path};
use crate::tile::TileIndex;

/// How often all frontiers are given away anew if there are more robots than
/// frontiers, before the robot looks for itself alone.
const PASSES: u8 = 3;

/// Work of checking whether a goal that a wave met still is one.
const GOAL_WORK: u32 = 1000;

/// Work of speaking for a frontier.
const PATCH_WORK: u32 = 4000;

/// Work of starting a round, or of turning a step of the way around.
const TURN_WORK: u32 = 60;

/// Work of following a step of a way.
const WAY_STEP_WORK: u32 = 60;

/// Work of following a way: its first 256 steps.
pub(crate) const WAY_WORK: u32 = WAY_STEP_WORK * (role::CAPACITY as u32 + 1);

/// Work after which it is looked whether a route has reached the robot.
const ROUTE_WORK: u32 = 2000;

/// What the last step of a slice costs at most.
pub(crate) const LAST_WORK: u32 = STEP_WORK + GOAL_WORK + PATCH_WORK;

/// What the far decision has come to.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Outcome {
    /// Not there yet.
    Searching,
    /// A frontier, and the way to it from where the robot stands.
    Found(Candidate),
    /// No frontier can be reached.
    NothingLeft,
    /// The frontier that a way was looked for cannot be reached (any more).
    Lost,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    Idle,
    /// In rounds of waves from everybody who has no frontier yet; in pass
    /// [`PASSES`], from this robot alone.
    Sweep {
        pass: u8,
        /// Groups whose waves have begun in this round.
        seeded: u8,
        /// Whether anybody was served in this round.
        has_served: bool,
    },
    /// The way to the goal is turned around, so far from there to `cell`.
    Turn {
        goal: Cell,
        cell: Cell,
        /// Where the way to `cell` comes from.
        back: Direction,
        steps: u32,
    },
    Route {
        goal: Cell,
        is_seeded: bool,
    },
    /// The shortest way from the robot to a cell, by an exact wave from there.
    Way {
        to: Cell,
        is_seeded: bool,
    },
}

/// Robots that were heard on one cell; the index is the label of their wave.
#[derive(Clone, Copy, Debug)]
struct Group {
    cell: Cell,
    /// Robots that have no frontier yet.
    left: u8,
}

/// The far decision in slices.
pub(crate) struct FarSearch<const TW: usize, const TH: usize> {
    wave: Wave<TW, TH>,
    stage: Stage,
    /// Where everybody was when the sweep began.
    groups: Vec<Group, LABELS>,
    /// The label of this robot's group, and of a route.
    own_label: u8,
    /// Robots of its group that are served before it.
    before_own: u8,
    /// Labels of groups that are served.
    served: u16,
}

impl<const TW: usize, const TH: usize> FarSearch<TW, TH> {
    pub(crate) const fn new() -> Self {
        Self {
            wave: Wave::new(),
            stage: Stage::Idle,
            groups: Vec::new(),
            own_label: 0,
            before_own: 0,
            served: 0,
        }
    }

    pub(crate) fn is_idle(&self) -> bool {
        self.stage == Stage::Idle
    }

    /// The cells of a tile that the search under way has reached.
    pub(crate) fn searched(&self, at: TileIndex) -> u64 {
        if self.is_idle() {
            0
        } else {
            self.wave.reached(at)
        }
    }

    /// Drops the search.
    pub(crate) fn cancel(&mut self) {
        self.stage = Stage::Idle;
    }

    /// Starts a sweep from where everybody was heard last.
    pub(crate) fn start_sweep(
        &mut self,
        id: RobotId,
        others: &Others,
        around: &Surroundings<TW, TH>,
    ) {
        self.groups.clear();
        self.served = 0;
        self.before_own = 0;
        let here = around.position;
        let mut own = Some(here);
        let others = others.exploring().map(|other| (other.id, other.position));
        for (other, position) in others {
            if !around.map.is_free(position) {
                continue;
            }
            if other > id
                && let Some(here) = own.take()
            {
                self.own_label = self.join_group(here);
            }
            self.before_own += u8::from(own == Some(position));
            self.join_group(position);
        }
        if let Some(here) = own {
            self.own_label = self.join_group(here);
        }
        let robots: u32 = self.groups.iter().map(|group| u32::from(group.left)).sum();
        self.start_round(if robots > 1 { 0 } else { PASSES }, false, around);
    }

    /// One robot more on this cell; the label of its group.
    fn join_group(&mut self, cell: Cell) -> u8 {
        let group = self.groups.iter_mut().zip(0u8..);
        if let Some((group, label)) = group.into_iter().find(|(group, _)| group.cell == cell) {
            group.left += 1;
            return label;
        }
        let label = self.groups.len() as u8;
        // There is room: groups are no more than robots.
        let _ = self.groups.push(Group { cell, left: 1 });
        label
    }

    fn start_round(&mut self, pass: u8, keeps_taken: bool, around: &Surroundings<TW, TH>) {
        if pass >= PASSES
            && let Some(own) = self.groups.get_mut(usize::from(self.own_label))
        {
            self.before_own = 0;
            own.cell = around.position;
        }
        self.wave.begin(around.map.extent(), keeps_taken);
        self.stage = Stage::Sweep {
            pass,
            seeded: 0,
            has_served: false,
        };
    }

    /// Starts looking for the way to a frontier that is already chosen.
    pub(crate) fn start_route(&mut self, goal: Cell, around: &Surroundings<TW, TH>) {
        self.wave.begin(around.map.extent(), false);
        self.served = 0;
        self.stage = Stage::Route {
            goal,
            is_seeded: false,
        };
    }

    /// Starts looking for the shortest way to a cell, whatever is there.
    pub(crate) fn start_way(&mut self, to: Cell, around: &Surroundings<TW, TH>) {
        self.wave.begin_exact(around.map.extent());
        self.served = 0;
        self.stage = Stage::Way {
            to,
            is_seeded: false,
        };
    }

    /// The cell that the shortest way is being looked for to.
    pub(crate) fn way_to(&self) -> Option<Cell> {
        match self.stage {
            Stage::Way { to, .. } => Some(to),
            _ => None,
        }
    }

    /// Goes on with the search for at most `slice` of work, [`LAST_WORK`], and
    /// [`WAY_WORK`] where it ends.
    pub(crate) fn advance(
        &mut self,
        around: &Surroundings<TW, TH>,
        slice: u32,
        work: &mut u32,
    ) -> Outcome {
        let until = work.saturating_add(slice);
        if let Stage::Route { goal, .. } | Stage::Turn { goal, .. } = self.stage
            && !around.is_goal(goal)
        {
            self.stage = Stage::Idle;
            return Outcome::Lost;
        }
        if let Stage::Way { to, .. } = self.stage
            && !around.is_open(to)
        {
            self.stage = Stage::Idle;
            return Outcome::Lost;
        }
        while *work < until {
            let outcome = match self.stage {
                Stage::Idle => break,
                Stage::Turn { .. } => self.turn(around, work),
                _ if !self.wave.clear(work) => Outcome::Searching,
                Stage::Sweep { .. } => self.sweep(around, until, work),
                Stage::Route { .. } => self.route(around, until, work),
                Stage::Way { .. } => self.measure(around, until, work),
            };
            if !matches!(outcome, Outcome::Searching) {
                self.stage = Stage::Idle;
                return outcome;
            }
        }
        Outcome::Searching
    }

    const fn labels(&self) -> Labels {
        Labels {
            own: self.own_label,
            given_up: self.served,
        }
    }

    /// A group's wave begins, or all go on.
    fn sweep(&mut self, around: &Surroundings<TW, TH>, until: u32, work: &mut u32) -> Outcome {
        let labels = self.labels();
        let Stage::Sweep {
            pass,
            seeded,
            has_served,
        } = &mut self.stage
        else {
            return Outcome::Searching;
        };
        let (pass, has_served) = (*pass, *has_served);
        let event = if let Some(group) = self.groups.get(usize::from(*seeded)) {
            let label = *seeded;
            *seeded += 1;
            if group.left == 0 || pass >= PASSES && label != self.own_label {
                return Outcome::Searching;
            }
            self.wave.seed(group.cell, label, labels, around, work)
        } else {
            self.wave.run(labels, around, until, work)
        };
        match event {
            Event::Nothing => {}
            Event::Goal { label, cell } => self.serve(label, cell, pass, around, work),
            Event::End if pass >= PASSES => return Outcome::NothingLeft,
            // Somebody made room for the others.
            Event::End if has_served => self.start_round(pass, true, around),
            Event::End => self.start_round(pass + 1, false, around),
        }
        Outcome::Searching
    }

    /// The wave of a group has reached a goal: the next of the group is served. It takes
    /// this frontier cell and those connected to it nearby: it will see what lies behind
    /// them.
    fn serve(
        &mut self,
        label: u8,
        goal: Cell,
        pass: u8,
        around: &Surroundings<TW, TH>,
        work: &mut u32,
    ) {
        *work += GOAL_WORK;
        let is_own = label == self.own_label;
        let is_goal = if is_own {
            around.is_goal(goal)
        } else {
            around.is_frontier(goal)
        };
        // Something was learnt since the wave read the map.
        if !is_goal {
            return;
        }
        if is_own && self.before_own == 0 {
            return self.start_turn(goal, around);
        }
        self.before_own -= u8::from(is_own);
        if let Some(group) = self.groups.get_mut(usize::from(label)) {
            group.left = group.left.saturating_sub(1);
            self.served |= u16::from(group.left == 0) << (label & 15);
        }
        *work += PATCH_WORK;
        if around.clearance > 0 {
            *work += WINDOW_WORK;
        }
        for (at, cells) in connected(goal, |window| around.window(window, Layer::Frontier)) {
            self.wave.take(at, cells);
        }
        // With every frontier spoken for, nobody else is served in this pass.
        if around.are_all_taken(self.wave.taken()) {
            self.start_round(pass + 1, false, around);
        } else if let Stage::Sweep { has_served, .. } = &mut self.stage {
            *has_served = true;
        }
    }

    /// The way of the wave is the robot's shortest if it still stands where that began, and
    /// if no other wave was in the way or it goes straight.
    fn start_turn(&mut self, goal: Cell, around: &Surroundings<TW, TH>) {
        let here = around.position;
        let start = self.groups.get(usize::from(self.own_label));
        let is_there = start.is_some_and(|start| start.cell == here);
        let straight = u32::from(here.x.abs_diff(goal.x)) + u32::from(here.y.abs_diff(goal.y));
        if !is_there || self.wave.has_met() && self.wave.layer() > straight {
            return self.start_route(goal, around);
        }
        match self.wave.direction_at(goal, self.own_label) {
            Some(back) => {
                self.stage = Stage::Turn {
                    goal,
                    cell: goal,
                    back,
                    steps: 0,
                };
            }
            _ => self.start_route(goal, around),
        }
    }

    /// Turns one step of the way around, or follows it if all are.
    fn turn(&mut self, around: &Surroundings<TW, TH>, work: &mut u32) -> Outcome {
        let Stage::Turn {
            goal,
            cell,
            back,
            steps,
        } = &mut self.stage
        else {
            return Outcome::Searching;
        };
        let start = self.groups.get(usize::from(self.own_label));
        if start.is_some_and(|start| start.cell != *cell) {
            *work += TURN_WORK;
            *cell = cell.step(*back);
            let Some(next) = self.wave.direction_at(*cell, self.own_label) else {
                // Never: all of the way is of its own wave.
                return Outcome::Lost;
            };
            self.wave.turn(*cell, back.opposite());
            *back = next;
            *steps += 1;
            return Outcome::Searching;
        }
        let (goal, steps) = (*goal, *steps);
        let is_there = start.is_some_and(|start| start.cell == around.position);
        let way = if is_there {
            self.way(goal, around.position, steps, work)
        } else {
            None
        };
        match way {
            Some(way) => Outcome::Found(way),
            None => {
                self.start_route(goal, around);
                Outcome::Searching
            }
        }
    }

    /// The wave of a route begins, or goes on.
    fn route(&mut self, around: &Surroundings<TW, TH>, until: u32, work: &mut u32) -> Outcome {
        let labels = self.labels();
        let Stage::Route { goal, is_seeded } = &mut self.stage else {
            return Outcome::Searching;
        };
        let goal = *goal;
        if !*is_seeded {
            *is_seeded = true;
            self.wave.seed(goal, labels.own, labels, around, work);
            return Outcome::Searching;
        }
        let until = until.min(work.saturating_add(ROUTE_WORK));
        let event = self.wave.run(labels, around, until, work);
        // The robot may have walked into the wave, or the wave reached the robot.
        match self.way(goal, around.position, self.wave.layer(), work) {
            Some(way) => Outcome::Found(way),
            None if event == Event::End => Outcome::Lost,
            None => Outcome::Searching,
        }
    }

    /// The exact wave begins, or goes on until it meets the robot.
    fn measure(&mut self, around: &Surroundings<TW, TH>, until: u32, work: &mut u32) -> Outcome {
        let labels = self.labels();
        let Stage::Way { to, is_seeded } = &mut self.stage else {
            return Outcome::Searching;
        };
        let (to, own) = (*to, around.position);
        if !*is_seeded {
            *is_seeded = true;
            self.wave.seed(to, 0, labels, around, work);
            return Outcome::Searching;
        }
        match self.wave.run(labels, around, until, work) {
            Event::Nothing => Outcome::Searching,
            Event::End => Outcome::Lost,
            Event::Goal { .. } => match self.way(to, own, self.wave.layer(), work) {
                Some(way) => Outcome::Found(way),
                None => Outcome::Lost,
            },
        }
    }

    /// The way from the robot to the goal, if its wave leads there: as many steps as a
    /// path holds, and the length of all, exact if it fits a path, else `most`.
    fn way(&self, goal: Cell, own: Cell, most: u32, work: &mut u32) -> Option<Candidate> {
        self.wave.direction_at(own, self.own_label)?;
        let mut path = Path::new();
        let mut cell = own;
        while cell != goal {
            match self.wave.direction_at(cell, self.own_label) {
                Some(step) if path.push_back(step) => cell = cell.step(step),
                _ => break,
            }
        }
        *work += WAY_STEP_WORK * (path.len() + 1);
        let length = if cell == goal {
            path.len()
        } else {
            most.max(path.len())
        };
        Some(Candidate { goal, length, path })
    }
}

#[cfg(test)]
mod tests;
