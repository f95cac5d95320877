//! The far decision: who goes to which frontier beyond the window, and the way.
//!
//! The *sweep* is greedy matching, shortest pair first, computed from last heard
//! positions: everybody's waves run at once, and whoever meets a frontier that is
//! not taken is served. Then the *route* runs back from the own frontier until it
//! meets the robot, wherever that has got to in the meantime.

use heapless::Vec;

use super::others::Others;
use super::patch::connected;
use super::surroundings::Surroundings;
use super::wave::{LABELS, Wave};
use super::window::Candidate;
use crate::cell::Cell;
use crate::robot::RobotId;
use crate::role::Path;
use crate::tile::TileIndex;

/// How often all frontiers are given away anew if there are more robots than
/// frontiers, before the robot looks for itself alone.
const PASSES: u8 = 3;

/// What the front of a label in a tile costs, in the unit of work: about as much as a
/// row of the window.
const FRONT_WORK: u32 = 4;

/// What each tile beside it costs that the front moves into.
const BESIDE_WORK: u32 = 3;

/// What speaking for a frontier costs in the same unit.
const PATCH_WORK: u32 = 56;

/// What following a way back costs at most: its first 256 steps.
pub(crate) const WAY_WORK: u32 = 128;

/// What the last tile of a slice costs at most, with fronts of every label.
pub(crate) const LAST_TILE_WORK: u32 = LABELS as u32 * (FRONT_WORK + 4 * BESIDE_WORK);

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
        served_before: u16,
    },
    Route {
        goal: Cell,
    },
}

/// The far decision in slices.
pub(crate) struct FarSearch<const TW: usize, const TH: usize> {
    wave: Wave<TW, TH>,
    stage: Stage,
    /// Where everybody was when the sweep began, by id; the index is the label.
    seeds: Vec<(RobotId, Cell), LABELS>,
    own_label: u8,
    /// Labels that have got a frontier.
    served: u16,
}

impl<const TW: usize, const TH: usize> FarSearch<TW, TH> {
    pub(crate) const fn new() -> Self {
        Self {
            wave: Wave::new(),
            stage: Stage::Idle,
            seeds: Vec::new(),
            own_label: 0,
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
        self.seeds.clear();
        self.own_label = 0;
        let others = others
            .exploring()
            .map(|other| (other.id, other.position))
            .filter(|&(_, position)| around.map.is_free(position));
        let mut own = Some((id, around.position));
        for (other, position) in others {
            if other > id
                && let Some(seed) = own.take()
            {
                let _ = self.seeds.push(seed);
            }
            if own.is_some() {
                self.own_label += 1;
            }
            let _ = self.seeds.push((other, position));
        }
        if let Some(seed) = own {
            let _ = self.seeds.push(seed);
        }
        self.served = 0;
        self.wave.forget_taken();
        let pass = if self.seeds.len() > 1 { 0 } else { PASSES };
        self.start_round(pass, around.position);
    }

    fn start_round(&mut self, pass: u8, own: Cell) {
        self.wave.clear();
        if pass < PASSES {
            for (&(_, cell), label) in self.seeds.iter().zip(0u8..) {
                if self.served >> label & 1 == 0 {
                    self.wave.seed(cell, label);
                }
            }
        } else {
            self.wave.seed(own, self.own_label);
        }
        self.stage = Stage::Sweep {
            pass,
            served_before: self.served,
        };
    }

    /// All waves of a round have ended and this robot has no frontier.
    fn next_round(&mut self, pass: u8, served_before: u16, own: Cell) -> Outcome {
        if pass >= PASSES {
            self.stage = Stage::Idle;
            return Outcome::NothingLeft;
        }
        if self.served != served_before {
            // Somebody made room for the others.
            self.start_round(pass, own);
        } else {
            self.wave.forget_taken();
            self.start_round(pass + 1, own);
        }
        Outcome::Searching
    }

    /// Starts looking for the way to a frontier that is already chosen.
    pub(crate) fn start_route(&mut self, goal: Cell) {
        self.wave.clear();
        self.wave.seed_route(goal);
        self.stage = Stage::Route { goal };
    }

    /// Goes on with the search for at most `slice` of work, [`LAST_TILE_WORK`], and
    /// [`WAY_WORK`] where it ends.
    pub(crate) fn advance(
        &mut self,
        around: &Surroundings<TW, TH>,
        slice: u32,
        work: &mut u32,
    ) -> Outcome {
        let end = work.saturating_add(slice);
        if let Stage::Route { goal } = self.stage
            && !around.is_goal(goal)
        {
            self.stage = Stage::Idle;
            return Outcome::Lost;
        }
        while *work < end {
            let outcome = match self.stage {
                Stage::Idle => return Outcome::Searching,
                Stage::Sweep {
                    pass,
                    served_before,
                } => self.sweep_tile(pass, served_before, around, work),
                Stage::Route { goal } => self.route_tile(goal, around, work),
            };
            if !matches!(outcome, Outcome::Searching) {
                return outcome;
            }
        }
        Outcome::Searching
    }

    /// One tile of a sweep's layer.
    fn sweep_tile(
        &mut self,
        pass: u8,
        served_before: u16,
        around: &Surroundings<TW, TH>,
        work: &mut u32,
    ) -> Outcome {
        let Some((at, mut front)) = self.wave.next_front() else {
            *work += FRONT_WORK;
            return self.next_round(pass, served_before, around.position);
        };
        *work += FRONT_WORK * u32::from(front == 0);
        let frontier = around.frontier(at);
        while front != 0 {
            *work += FRONT_WORK;
            let (label, cells, rest) = self.wave.first_label(at, front);
            front = rest;
            if self.served >> label & 1 == 1 {
                continue;
            }
            let mine = label == self.own_label;
            let mut hits = cells & frontier;
            if hits != 0 {
                hits &= !self.wave.taken(at);
            }
            if mine && hits != 0 {
                hits &= !around.aside.cells(at);
            }
            if hits == 0 {
                let served = self.served;
                *work += BESIDE_WORK
                    * self.wave.spread(at, cells, label, served, |tile| {
                        if mine {
                            around.open(tile)
                        } else {
                            around.free(tile)
                        }
                    });
                continue;
            }
            let goal = at.cell(hits.trailing_zeros());
            if mine {
                self.start_route(goal);
                return Outcome::Searching;
            }
            self.served |= 1 << label;
            self.speak_for(goal, around, work);
        }
        Outcome::Searching
    }

    /// A served robot takes its frontier cell and those connected to it nearby:
    /// it will see what lies behind them.
    fn speak_for(&mut self, goal: Cell, around: &Surroundings<TW, TH>, work: &mut u32) {
        *work += PATCH_WORK;
        for (at, cells) in connected(goal, |at| around.frontier(at)) {
            self.wave.take(at, cells);
        }
    }

    /// One tile of a route's layer.
    fn route_tile(&mut self, goal: Cell, around: &Surroundings<TW, TH>, work: &mut u32) -> Outcome {
        *work += FRONT_WORK;
        // The robot may have walked into the wave, or the wave reached the robot.
        if self.wave.is_reached(around.position) {
            self.stage = Stage::Idle;
            return Outcome::Found(self.way(goal, around.position, work));
        }
        let Some((at, front)) = self.wave.next_front() else {
            self.stage = Stage::Idle;
            return Outcome::Lost;
        };
        *work += BESIDE_WORK * self.wave.spread_route(at, front, |tile| around.open(tile));
        Outcome::Searching
    }

    /// The way from the robot to the goal: as many steps as a path holds, and the
    /// length of all, exact if it fits a path, else not less than it is.
    fn way(&self, goal: Cell, own: Cell, work: &mut u32) -> Candidate {
        *work += WAY_WORK;
        let mut path = Path::new();
        let mut cell = own;
        while cell != goal {
            match self.wave.direction_at(cell) {
                Some(step) if path.push_back(step) => cell = cell.step(step),
                _ => break,
            }
        }
        let length = if cell == goal {
            path.len()
        } else {
            (self.wave.layer() + 1).max(path.len())
        };
        Candidate { goal, length, path }
    }
}
