//! The way out for a robot that has gained nothing for a long time: it flies to the
//! edge of one frontier after the other, looks over it from low to high, and stops
//! when all of them are done.
//!
//! The rules of the planners are heuristics; this one is what makes a survey
//! complete. Just above the least altitude and just before the unknown column even a
//! deep drop shows; from there the robot climbs to the ceiling, and a tower's top
//! shows.
//!
//! For a body with a clearance all of this is so in configuration space (`surface/body.rs`):
//! for *known* read *clear*, for *unknown* beside that *doubtful*. What is hidden from all edges
//! there is left, and named.
//!
//! # What refuses
//! A flight that is refused, by glass or by a robot that nobody heard of, is first taken
//! for a passing robot's sake, and the planner steps aside. From the third refusal on the
//! recovery is *careful*: it crosses one border between columns at a time, so that it learns
//! which column refuses. That column is *closed*, at all heights, and ways lead round
//! it. A column that a robot heard of keeps from being entered is closed too, after a
//! while. When no way to a frontier is left because of closed columns, all that cannot
//! be reached with it are given up together. When nothing else is left, the closed
//! columns are opened and everything is tried again, [`ROUNDS`] times and after longer
//! and longer rests; then the stop says what was in the way, and where.
//!
//! # Why a survey ends
//! Let N be the columns of the map, F ≤ N frontiers, and a *spell* the steps in which
//! no column becomes known and nobody says [`resume`](super::Surveyor::resume). There
//! are at most N + 1 of these between two calls of it. Claim: in a spell with good poses
//! the robot stops. Nothing that other robots say of themselves has part in it: it only
//! forbids flights, and each of the cases counts those.
//! 1. *Planners.* A step without a new column has no gain, and a step with gain ends
//!    the spell. So after [`Limits::patience`](super::Limits::patience) steps every further one is the recovery's, but for
//!    those of case 2 and [`BUMPS`] steps aside.
//! 2. *A sensor that shows nothing where it must*: the robot hovers, and stops after a
//!    hundred such looks in a row. Any other look that shows something known brings it
//!    back to case 3; looks that may show nothing are steps of case 3.
//! 3. *The recovery.* A round is a search, a goal, its edges, the next goal. Each
//!    search looks at every tile once, so it ends; a goal that was looked over or
//!    given up is not chosen again in the round, nor, if it was looked over, in later spells:
//!    the ground did not change. Only when nothing else is left all that was looked over before
//!    the spell is looked over again, once. So there are at most 2 F targets of 4
//!    edges. One edge takes the wave of its way, which ends as it reaches each column
//!    once; flights, each of which lowers `patience`; and climbs, each of which lowers
//!    it as well. `patience` is set when an edge, a climb, or a leg begins. A *leg* is
//!    the flight to the next column of the way; an edge has at most N of them by count,
//!    whatever moves the robot. A refusal closes a column, at most N in a round, or
//!    ends the flight to the edge or the climb. Waiting for robots in the way, in all
//!    rounds but the first, lowers `waits`, which is set once a round. There are at most [`ROUNDS`] rests.
//! 4. *No goal is left*, and nothing was given up for what was in the way, or all
//!    rounds are over: it stops, and as long as the spell lasts every tick is that stop.
//!
//! Steps without a good pose are outside of all counts: nothing is decided in them.

mod home;
mod way;

use super::Knowledge;
use crate::cell::{Cell, Direction};
use crate::point::Point;
use crate::robot::{Action, Stop, Wait};
use crate::surface::Columns;
use crate::tile::{TileIndex, Tiles, bits};
use crate::zeroed::Maybe;
use way::Way;

/// Height over the least altitude at which it flies.
const MARGIN: f32 = 0.1;

/// Tiles looked at in a step for a frontier to fly to.
const SLICE: usize = 64;

/// How often everything is tried again before what was in the way is taken to stay.
const ROUNDS: u8 = 3;

/// Steps of rest before the first of these; each time twice as many.
const REST: u8 = 16;

/// Refused flights after which the planner steps aside, before the recovery is careful.
const BUMPS: u8 = 2;

/// Steps in a round that the robot waits for robots in its way.
const WAITS: u8 = 32;

/// Steps that it has when one has left.
const TIME: u16 = 8;

/// Which frontiers have been looked over, and the one that is: the
/// part of a planner that decides after [`Limits::patience`](super::Limits::patience) steps
/// without gain.
#[derive(Clone, Debug)]
pub struct Recovery<const TW: usize, const TH: usize> {
    tried: Tiles<u64, TW, TH>,
    /// Columns that refused a flight in this round.
    closed: Tiles<u64, TW, TH>,
    /// What refused a flight last in this spell, and whether it is a robot that was heard of.
    obstacle: Maybe<(Cell, bool)>,
    /// Frontiers that were not looked over in this round after all, and whether something was in
    /// the way to any.
    barred: Tiles<u64, TW, TH>,
    is_barred: bool,
    /// Whether some were looked over before the map last grew.
    is_old: bool,
    /// Whether borders of columns are crossed one by one.
    careful: bool,
    bumps: u8,
    round: u8,
    rest: u8,
    waits: u8,
    /// The robot that was in the way to the edge last, and whether one was.
    hindrance: Point,
    is_hindered: bool,
    /// The column that the leg leads to, and how many more legs there may be.
    leg: Cell,
    legs: u32,
    known_columns: u32,
    goal: Option<Cell>,
    /// The search for the next goal: the tile that comes next, how many are left,
    /// and the nearest frontier found so far.
    cursor: TileIndex,
    left: usize,
    nearest: Option<(f32, Cell)>,
    way: Way<TW, TH>,
    /// Which of the goal's four edges is looked over.
    edge: u8,
    /// Whether the robot is there and climbs.
    climbing: bool,
    /// Steps left to get there.
    patience: u16,
    /// Whether it is used for the way home, and whether a way round is looked for.
    is_homeward: bool,
    is_round: bool,
    /// Flights round others on the way home, and ticks in which the robot waited for them.
    detours: u8,
}

impl<const TW: usize, const TH: usize> Recovery<TW, TH> {
    /// All zero, until [`reset`](Self::reset).
    pub const fn vacant() -> Self {
        Self {
            tried: Tiles::all(0),
            closed: Tiles::all(0),
            obstacle: Maybe::Nothing,
            barred: Tiles::all(0),
            is_barred: false,
            is_old: false,
            careful: false,
            bumps: 0,
            round: 0,
            rest: 0,
            waits: 0,
            hindrance: Point::new(0.0, 0.0, 0.0),
            is_hindered: false,
            leg: Cell::new(0, 0),
            legs: 0,
            known_columns: 0,
            goal: None,
            cursor: TileIndex { x: 0, y: 0 },
            left: 0,
            nearest: None,
            way: Way::vacant(),
            edge: 0,
            climbing: false,
            patience: 0,
            is_homeward: false,
            is_round: false,
            detours: 0,
        }
    }

    /// Starts anew, in place.
    pub fn reset(&mut self) {
        self.forget();
        self.begin_spell();
        self.careful = false;
        self.leg = Cell::new(0, 0);
        self.legs = 0;
        self.known_columns = 0;
        self.goal = None;
        self.cursor = TileIndex { x: 0, y: 0 };
        self.way.begin(None);
        self.edge = 0;
        self.climbing = false;
        self.patience = 0;
        self.is_homeward = false;
        self.is_round = false;
    }

    /// Nothing counts as tried.
    fn forget(&mut self) {
        self.tried.fill(0);
        self.is_old = false;
    }

    /// What was looked over shows nothing else now: it counts as tried, until nothing else is left.
    fn begin_spell(&mut self) {
        self.obstacle = Maybe::Nothing;
        self.bumps = 0;
        self.round = 0;
        self.rest = 0;
        self.begin_round();
    }

    /// What was given up for what was in the way does not count as tried, and nothing
    /// as closed.
    fn begin_round(&mut self) {
        let barred = self.barred.values_mut();
        for (tried, barred) in self.tried.values_mut().zip(barred) {
            *tried &= !core::mem::take(barred);
        }
        self.is_barred = false;
        self.closed.fill(0);
        // At first it does something else rather than wait.
        self.waits = if self.round > 0 { WAITS } else { 0 };
        self.begin_search();
    }

    /// Whether the planner is to step aside after a refused flight; it does so a few
    /// times.
    pub(crate) fn steps_aside(&mut self) -> bool {
        self.bumps = self.bumps.saturating_add(1);
        self.bumps <= BUMPS
    }

    /// One step of the recovery.
    ///
    /// Cost: 64 tiles while a goal is searched for, 1024 while the way to it is; every
    /// tile where a way turns out to be barred, or a round begins; and at most 32
    /// flights looked at.
    pub fn tick(&mut self, knowledge: &mut Knowledge<TW, TH>) -> Action<Point> {
        let refused = knowledge.take_refused();
        let known_columns = knowledge.surface().known_columns();
        let is_resumed = knowledge.take_resumed();
        let was_homeward = core::mem::take(&mut self.is_homeward);
        if self.known_columns != known_columns || is_resumed || was_homeward {
            self.known_columns = known_columns;
            self.is_old = true;
            if is_resumed || was_homeward {
                self.forget();
            }
            self.begin_spell();
            if self.careful || was_homeward {
                // Ways led round what was closed.
                self.goal = None;
                self.careful = false;
            }
        }
        if self.rest > 0 {
            self.rest = self.rest.saturating_sub(1);
            return knowledge.wait(Wait::Closed);
        }
        let clearance = knowledge.limits().clearance;
        let is_edge = |goal| knowledge.surface().is_edge(goal, clearance);
        if !self.goal.is_some_and(is_edge) {
            self.goal = None;
            self.search(knowledge);
            if self.left > 0 {
                return knowledge.wait(Wait::Search);
            }
            self.goal = self.nearest.map(|(_, cell)| cell);
            self.begin_search();
            self.begin(knowledge, 0);
            self.way.begin(self.goal);
        } else if let Some((from, to)) = refused {
            self.take_refusal(knowledge, from, to);
        }
        knowledge.set_goal(self.goal);
        let Some(goal) = self.goal else {
            return self.end_round(knowledge);
        };
        if self.closed.contains(goal) {
            self.give_up(goal);
            return knowledge.wait(Wait::Search);
        }
        let Some((edge, place)) = edge_of(knowledge, goal, self.edge) else {
            self.tried.insert(goal);
            self.goal = None;
            return knowledge.wait(Wait::Search);
        };
        self.edge = edge;
        if !self.climbing
            && let Some(action) = self.approach(knowledge, goal, place)
        {
            return action;
        }
        let up = knowledge.climb();
        if up.z > knowledge.position().z && self.patience > 0 && knowledge.is_open(up) {
            let Some(robot) = knowledge.robot_in_the_way(up) else {
                self.patience = self.patience.saturating_sub(1);
                return Action::Move(up);
            };
            if self.waits_for(robot) {
                return knowledge.wait(Wait::Closed);
            }
            self.bar(goal);
        }
        self.begin(knowledge, edge.saturating_add(1));
        knowledge.wait(Wait::Search)
    }

    /// A step to the edge at `place` of the goal's column; `None` once the robot is
    /// there, or has been on its way for too long.
    fn approach(
        &mut self,
        knowledge: &mut Knowledge<TW, TH>,
        goal: Cell,
        place: Point,
    ) -> Option<Action<Point>> {
        let here = knowledge.position().cell();
        knowledge.count_work(29);
        let is_straight = if self.careful {
            here == goal
        } else {
            is_known_between(knowledge, place)
        };
        let next = if is_straight {
            place
        } else {
            match self.way.next(knowledge, &self.closed) {
                way::Next::Column(cell) => Point::over(cell, 0.0),
                way::Next::Searching => return Some(knowledge.wait(Wait::Search)),
                way::Next::None if self.way.is_cut() => {
                    self.give_up_all();
                    return Some(knowledge.wait(Wait::Search));
                }
                way::Next::None => place,
            }
        };
        if self.careful {
            self.begin_leg(knowledge, here, next.cell());
        }
        self.patience = self.patience.saturating_sub(1);
        let cruise = knowledge.limits().min_altitude + MARGIN;
        if let Some(robot) = robot_in_the_way(knowledge, next, place, cruise) {
            self.hindrance = robot;
            self.is_hindered = true;
        }
        let step = if self.careful {
            self.careful_step(knowledge, next, cruise)
        } else {
            knowledge.step_towards(next, cruise).map(Action::Move)
        };
        if step.is_some() && self.patience > 0 {
            return step;
        }
        if step.is_some() {
            // Too late; when more is known there may be another way.
            self.barred.insert(goal);
        }
        // Not there: a robot that is in the way may be why.
        if self.is_hindered {
            if self.waits_for(self.hindrance) {
                self.patience = self.patience.max(TIME);
                return Some(knowledge.wait(Wait::Closed));
            }
            self.bar(goal);
            if self.round > 0 {
                self.give_up(goal);
                return Some(knowledge.wait(Wait::Closed));
            }
        }
        self.begin_climb(knowledge);
        None
    }

    /// A step straight to `next`, which lies in this column or a neighbouring one: or
    /// up, where the ground is steep. Where neither is allowed, its column is closed.
    fn careful_step(
        &mut self,
        knowledge: &mut Knowledge<TW, TH>,
        next: Point,
        cruise: f32,
    ) -> Option<Action<Point>> {
        let here = knowledge.position();
        let to = knowledge.step_to(next, cruise);
        let up = knowledge.climb();
        let is_there = to.distance_squared(here) <= 1e-6;
        if is_there {
            return None;
        }
        if knowledge.may_fly(to) {
            return Some(Action::Move(to));
        }
        if !knowledge.is_open(to) && up.z > here.z && knowledge.may_fly(up) {
            return Some(Action::Move(up));
        }
        if next.cell() == here.cell() {
            return None;
        }
        if let Some(robot) = knowledge.robot_in_the_way(to)
            && self.waits_for(robot)
        {
            return Some(knowledge.wait(Wait::Closed));
        }
        self.close(next.cell(), here.cell());
        Some(knowledge.wait(Wait::Search))
    }

    /// The robot has come to the next column of its way: it has time for another.
    fn begin_leg(&mut self, knowledge: &Knowledge<TW, TH>, here: Cell, next: Cell) {
        if here == self.leg && self.legs > 0 {
            self.legs = self.legs.saturating_sub(1);
            self.patience = leg_steps(knowledge);
        }
        self.leg = next;
    }

    /// A flight was refused.
    fn take_refusal(&mut self, knowledge: &Knowledge<TW, TH>, from: Point, to: Point) {
        let mut crossed = Columns::new(from, to).skip(1);
        let here = knowledge.position().cell();
        match (crossed.next(), crossed.next()) {
            (Some(only), None) => {
                self.obstacle = Maybe::Just((only.cell, false));
                self.close(only.cell, here);
            }
            // Of several any may be the one: they are tried one by one.
            (Some(_), Some(_)) => {}
            (None, _) => {
                self.obstacle = Maybe::Just((here, false));
                if let Some(goal) = self.goal {
                    self.bar(goal);
                }
                if self.climbing {
                    self.begin(knowledge, self.edge.saturating_add(1));
                } else {
                    self.begin_climb(knowledge);
                }
            }
        }
        if !self.careful {
            self.careful = true;
            self.legs = knowledge.surface().known_columns();
            self.patience = self.patience.max(leg_steps(knowledge));
            self.leg = here;
            self.way.begin(self.goal);
        }
    }

    /// From now on no way leads over `column`; the robot's own stays open.
    fn close(&mut self, column: Cell, here: Cell) {
        if column != here {
            self.closed.insert(column);
        }
        self.way.begin(self.goal);
    }

    /// Something keeps the robot from looking over `frontier`.
    fn bar(&mut self, frontier: Cell) {
        self.is_barred = true;
        self.barred.insert(frontier);
    }

    /// The same, and it is not tried any further in this round.
    fn give_up(&mut self, goal: Cell) {
        self.bar(goal);
        self.tried.insert(goal);
        self.goal = None;
    }

    /// No way leads to the goal, nor to anything that is connected with it.
    fn give_up_all(&mut self) {
        let words = self.tried.values_mut().zip(self.barred.values_mut());
        for ((tried, barred), reached) in words.zip(self.way.reached()) {
            *barred |= reached & !*tried;
            *tried |= reached;
        }
        self.goal = None;
        self.is_barred = true;
    }

    /// Whether the robot waits for another one that is in its way.
    fn waits_for(&mut self, robot: Point) -> bool {
        let waits = self.waits > 0;
        self.waits = self.waits.saturating_sub(1);
        if !waits {
            self.obstacle = Maybe::Just((robot.cell(), true));
        }
        waits
    }

    /// Nothing is left to try: it is tried again, or the robot stops.
    fn end_round(&mut self, knowledge: &mut Knowledge<TW, TH>) -> Action<Point> {
        let frontiers = knowledge.surface().frontiers();
        if self.is_barred && self.round < ROUNDS {
            self.rest = REST << self.round;
            self.round = self.round.saturating_add(1);
            self.begin_round();
            return knowledge.wait(Wait::Closed);
        }
        if self.is_old {
            self.forget();
            self.begin_search();
            return knowledge.wait(Wait::Search);
        }
        // Where nothing refused, columns were closed that cannot be flown to over known ground.
        let obstacle = self.obstacle.get().filter(|_| self.is_barred);
        knowledge.stop(match obstacle {
            None => Stop::Unseen {
                frontiers,
                at: knowledge.unseen_place(),
            },
            Some((at, false)) => Stop::Blocked { frontiers, at },
            Some((at, true)) => Stop::Held { frontiers, at },
        })
    }

    fn begin_search(&mut self) {
        self.left = TW * TH;
        self.nearest = None;
    }

    /// Looks at the next few tiles for the nearest frontier that was not tried.
    fn search(&mut self, knowledge: &mut Knowledge<TW, TH>) {
        let here = knowledge.position();
        let clearance = knowledge.limits().clearance;
        for _ in 0..SLICE.min(self.left) {
            let tile = self.cursor;
            self.cursor = knowledge.surface().tile_after(tile);
            self.left -= 1;
            knowledge.count_work(1);
            let edges = knowledge.surface().edges(tile, clearance);
            let open = edges & !self.tried.word(tile);
            knowledge.count_work(open.count_ones());
            for bit in bits(open) {
                let cell = tile.cell(bit);
                let distance = here.plan_distance(Point::over(cell, 0.0));
                if self.nearest.is_none_or(|(least, _)| distance < least) {
                    self.nearest = Some((distance, cell));
                }
            }
        }
    }

    /// Sets out for the goal's edge number `edge`.
    fn begin(&mut self, knowledge: &Knowledge<TW, TH>, edge: u8) {
        self.edge = edge;
        self.climbing = false;
        self.is_hindered = false;
        self.leg = knowledge.position().cell();
        self.legs = knowledge.surface().known_columns();
        self.patience = self.goal.map_or(0, |cell| {
            let way = knowledge.position().plan_distance(Point::over(cell, 0.0));
            ((8.0 * way / knowledge.limits().step) as u16).saturating_add(30)
        });
        if self.careful {
            self.patience = self.patience.max(leg_steps(knowledge));
        }
    }

    /// Sets out to the ceiling: twice the steps of a straight climb, and a few.
    fn begin_climb(&mut self, knowledge: &Knowledge<TW, TH>) {
        self.climbing = true;
        let rise = knowledge.limits().ceiling - knowledge.position().z;
        self.patience = ((2.0 * rise / knowledge.limits().step) as u16).saturating_add(8);
    }
}

/// The robot that keeps this one from flying straight to `next`, or up, or that stands
/// where it is going.
fn robot_in_the_way<const TW: usize, const TH: usize>(
    knowledge: &Knowledge<TW, TH>,
    next: Point,
    place: Point,
    cruise: f32,
) -> Option<Point> {
    let there = || {
        let separation = knowledge.limits().separation;
        let mut robots = knowledge.peers().map(|peer| peer.status.position);
        robots.find(|robot| robot.plan_distance(place) < separation)
    };
    [knowledge.step_to(next, cruise), knowledge.climb()]
        .into_iter()
        .filter(|&to| knowledge.is_open(to))
        .find_map(|to| knowledge.robot_in_the_way(to))
        .or_else(there)
}

/// Steps for the way to a neighbouring column, and up along a cliff to the ceiling.
fn leg_steps<const TW: usize, const TH: usize>(knowledge: &Knowledge<TW, TH>) -> u16 {
    let limits = knowledge.limits();
    ((2.0 * (limits.ceiling + 4.0) / limits.step) as u16).saturating_add(30)
}

/// Whether all ground under the body on the straight way to `place` is known.
///
/// Cost: for each column crossed those of a body.
fn is_known_between<const TW: usize, const TH: usize>(
    knowledge: &Knowledge<TW, TH>,
    place: Point,
) -> bool {
    let clearance = knowledge.limits().clearance;
    Columns::new(knowledge.position(), place)
        .all(|crossing| knowledge.surface().is_clear(crossing.cell, clearance))
}

/// The first edge of `frontier`, from number `first` on, that borders an unknown column, for
/// a body a doubtful one, and the place just inside it.
fn edge_of<const TW: usize, const TH: usize>(
    knowledge: &Knowledge<TW, TH>,
    frontier: Cell,
    first: u8,
) -> Option<(u8, Point)> {
    let clearance = knowledge.limits().clearance;
    let is_beyond = |cell| knowledge.surface().is_doubtful(cell, clearance);
    (0u8..)
        .zip(Direction::ALL)
        .skip(usize::from(first))
        .find(|&(_, direction)| is_beyond(frontier.step(direction)))
        .map(|(number, direction)| {
            let (dx, dy) = direction.delta();
            let centre = Point::over(frontier, 0.0);
            (
                number,
                centre.offset(0.45 * f32::from(dx), 0.45 * f32::from(dy), 0.0),
            )
        })
}
