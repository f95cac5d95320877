//! What drives the bodies of a fleet, each by what its planner wants and its map shows.

use std::collections::BTreeSet;

use parry2d_f64::math::Vec2;
use planner_core::explorer::body_cells;
use planner_core::{Cell, Direction};

use super::body::{Limits, Pose, State, Velocity};
use super::collide::{Cells, Hit};
use super::control::{Course, LONGEST, swings};
use crate::dice::Lot;
use crate::robot::{Driven, Touches};
use crate::scenario::Motion;

/// How much wider than its body a driver takes the way to a place to be, in cells: more than
/// it strays from it.
const MARGIN: f64 = 0.015;
/// The same for what it does next.
const LEAST_MARGIN: f64 = 0.003;
/// Nearer than this to a place, in metres, is there.
const THERE: f64 = 1e-3;
/// Ticks that a body waits where it is before it goes to the middle of its cell, out of the
/// others' way: where it has nowhere to go, and where another one is in its way.
const MOST_WAITS: u32 = 20;
const MOST_HOLDS: u32 = 5;

/// A step that takes so many times as long as from rest to rest is none.
const MOST_STEPS: f64 = 4.0;

/// Kinds of chance that have nothing to do with each other.
enum Of {
    Slip = 32,
    Odometry,
}

/// Where a planner wants its body to go.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Aim {
    /// To the next cell of its way, and if it says so straight on to a farther one.
    Go { next: Cell, waypoint: Option<Cell> },
    /// Nowhere.
    Stay,
}

/// What came of steering.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Steered {
    /// Where it was to go.
    Going,
    /// Nowhere, since another body is in the way, for so many ticks.
    Held(u32),
    /// It stays, or cannot go there from where it is.
    Elsewhere,
}

/// The drivers of all bodies.
#[derive(Debug)]
pub(crate) struct Drivers {
    motion: Motion,
    limits: Limits,
    cells: Cells,
    clearance: u8,
    /// Whether bodies are in each other's way.
    are_solid: bool,
    lot: Lot,
    /// Moments in a tick, and seconds in a moment.
    moments: (usize, f64),
    drivers: Vec<Driver>,
}

/// One body and its driver.
#[derive(Debug)]
struct Driver {
    /// Where the body is, and where its odometry takes it to be.
    pose: Pose,
    believed: Pose,
    velocity: Velocity,
    course: Course,
    /// Where it comes by in the next tick and while it then brakes.
    claim: Vec<Vec2>,
    /// The cells of both poses, which follow them by a step a tick.
    cell: Cell,
    believed_cell: Cell,
    /// Ticks without going anywhere.
    waits: u32,
    /// Whether it is on its way to the middle of its cell, and goes nowhere else before.
    retreats: bool,
    /// Ticks since it last entered a cell while it was to go.
    tries: u32,
    /// Where it was told to go, from which cell; none if that has to be decided anew.
    order: Option<(Direction, Cell)>,
    /// By what its odometry errs, as factors.
    measures: [f64; 2],
    touching: Option<Hit>,
    metres: f64,
    radians: f64,
    touches: Touches,
}

impl Drivers {
    /// Bodies in the middle of their starts, turned to the east.
    pub(crate) fn new(
        motion: Motion,
        clearance: u8,
        are_solid: bool,
        seed: u64,
        starts: &[Cell],
    ) -> Self {
        let cells = Cells { side: motion.cell };
        let lot = Lot::new(seed);
        let moments = (motion.tick() / LONGEST).ceil().max(1.0);
        let driver = |(&cell, number): (&Cell, u64)| {
            let pose = Pose {
                at: cells.middle(cell),
                yaw: 0.0,
            };
            let lot = lot.of(Of::Odometry as u64).of(number);
            let error = |axis| motion.odometry_error * (2.0 * lot.of(axis).unit() - 1.0);
            Driver {
                pose,
                believed: pose,
                velocity: Velocity::NONE,
                course: Course::Halt,
                claim: vec![pose.at],
                cell,
                believed_cell: cell,
                waits: 0,
                retreats: false,
                tries: 0,
                order: None,
                measures: [1.0 + error(0), 1.0 + error(1)],
                touching: None,
                metres: 0.0,
                radians: 0.0,
                touches: Touches::default(),
            }
        };
        Self {
            limits: Limits::of(&motion),
            cells,
            clearance,
            are_solid,
            lot: lot.of(Of::Slip as u64),
            moments: (moments as usize, motion.tick() / moments),
            drivers: starts.iter().zip(0..).map(driver).collect(),
            motion,
        }
    }

    /// The cell that a body is in.
    pub(crate) fn cell(&self, robot: usize) -> Cell {
        self.drivers[robot].cell
    }

    /// The cell that it takes itself to be in.
    pub(crate) fn believed_cell(&self, robot: usize) -> Cell {
        self.drivers[robot].believed_cell
    }

    /// How far it has gone.
    pub(crate) fn driven(&self, robot: usize) -> Driven {
        let driver = &self.drivers[robot];
        Driven {
            millimetres: (driver.metres * 1e3).round() as u32,
            milliturns: (driver.radians / std::f64::consts::TAU * 1e3).round() as u32,
            touches: driver.touches,
        }
    }

    /// The step that a body is making since its planner last decided.
    pub(crate) fn order(&self, robot: usize) -> Option<Direction> {
        let driver = &self.drivers[robot];
        let (step, from) = driver.order?;
        (from == driver.believed_cell).then_some(step)
    }

    /// Its odometry is right again.
    pub(crate) fn realign(&mut self, robot: usize) {
        let driver = &mut self.drivers[robot];
        driver.believed = driver.pose;
        driver.believed_cell = driver.cell;
    }

    /// Whether it tries to enter a cell for longer than any step takes. Asked once, it
    /// tries anew.
    pub(crate) fn gives_up(&mut self, robot: usize) -> bool {
        let seconds = 1.0 + MOST_STEPS * self.motion.step();
        let driver = &mut self.drivers[robot];
        let is_over = f64::from(driver.tries) * self.motion.tick() > seconds;
        if is_over {
            driver.tries = 0;
            driver.order = None;
        }
        is_over
    }

    /// Decides where a body goes in the next tick: to the waypoint, as far on the way there
    /// as can be seen, to the next cell, or to the middle of its own, to begin anew from
    /// there. `is_free` is what its map shows.
    pub(crate) fn steer(
        &mut self,
        robot: usize,
        aim: Aim,
        is_free: impl Fn(Cell) -> bool,
    ) -> Steered {
        let driver = &self.drivers[robot];
        let (waits, here) = (driver.waits, driver.believed_cell);
        let (targets, tries) = match aim {
            Aim::Go { .. } if driver.retreats => (Vec::new(), driver.tries + 1),
            Aim::Go { next, waypoint } => {
                let mut targets = self.along(here, waypoint.unwrap_or(next));
                targets.push(self.cells.middle(next));
                (targets, driver.tries + 1)
            }
            Aim::Stay => (Vec::new(), 0),
        };
        let mut is_held = false;
        let mut courses = { targets.into_iter() }
            .filter_map(|target| self.course_to(robot, target, &is_free, &mut is_held));
        let mut course = courses.next();
        drop(courses);
        let goes_on = course.is_some();
        let is_due = match aim {
            Aim::Go { .. } => !is_held || waits >= MOST_HOLDS,
            Aim::Stay => waits >= MOST_WAITS,
        };
        let mut retreats = false;
        if !goes_on && is_due {
            let middle = self.cells.middle(here);
            course = self.course_to(robot, middle, &is_free, &mut is_held);
            retreats = course.is_some();
        }
        let chosen = course.or_else(|| self.halt(robot, Course::Halt));
        let driver = &mut self.drivers[robot];
        if let Some((course, claim)) = chosen {
            driver.course = course;
            driver.claim = claim;
        }
        driver.tries = tries;
        driver.retreats = retreats;
        driver.waits = if goes_on || retreats { 0 } else { waits + 1 };
        driver.order = None;
        match (aim, goes_on) {
            (Aim::Go { next, .. }, true) => {
                driver.order = here.direction_to(next).map(|step| (step, here));
                Steered::Going
            }
            _ if is_held && driver.velocity == Velocity::NONE => {
                // Another one's turn is no try of its own.
                driver.tries = tries.saturating_sub(1);
                Steered::Held(driver.waits)
            }
            _ => Steered::Elsewhere,
        }
    }

    /// A body stops where it is.
    pub(crate) fn stop(&mut self, robot: usize) {
        if let Some((course, claim)) = self.halt(robot, Course::Halt) {
            self.drivers[robot].course = course;
            self.drivers[robot].claim = claim;
        }
    }

    /// Places on the line from the middle of a cell to that of another, a cell apart, the
    /// farthest first.
    fn along(&self, from: Cell, to: Cell) -> Vec<Vec2> {
        let (from, to) = (self.cells.middle(from), self.cells.middle(to));
        let steps = ((to - from).length() / self.motion.cell).ceil().max(1.0) as u32;
        let place = |step| from + (to - from) * (f64::from(step) / f64::from(steps));
        (1..=steps).rev().map(place).collect()
    }

    /// Braking, and then `course`, which goes nowhere.
    fn halt(&self, robot: usize, course: Course) -> Option<(Course, Vec<Vec2>)> {
        let driver = &self.drivers[robot];
        let braking = Course::Halt.preview(driver.believes(), &self.limits, self.moments)?;
        Some((course, driver.really(braking)))
    }

    /// How to go straight to a place, with what that claims: it may have to stop and turn
    /// before. `None`: it is there, its map does not show the way free, or another body is in
    /// the way, and then it `is_held`.
    fn course_to(
        &self,
        robot: usize,
        target: Vec2,
        is_free: impl Fn(Cell) -> bool,
        is_held: &mut bool,
    ) -> Option<(Course, Vec<Vec2>)> {
        let driver = &self.drivers[robot];
        let at = driver.believed.at;
        let reach = |margin| self.reach() + margin * self.motion.cell;
        let is_open = |cell| self.is_open(cell, &is_free);
        let is_there = (target - at).length() < THERE;
        if is_there || !self.cells.are_clear((at, target), reach(MARGIN), is_open) {
            return None;
        }
        let course = Course::To(target);
        let places = course.preview(driver.believes(), &self.limits, self.moments);
        let is_clear =
            |&to: &Vec2| to == at || { self.cells }.are_apart(at, to, reach(LEAST_MARGIN), is_open);
        // Where it swings into its direction, the rest of the way has to be clear from there.
        let swing = swings(target, driver.believes(), &self.limits, self.moments.1);
        let leads_there = |swing: &Vec<Vec2>| {
            let end = *swing.last().unwrap_or(&at);
            swing.iter().all(is_clear)
                && (end == at || self.cells.are_clear((end, target), reach(MARGIN), is_open))
        };
        let is_fit = swing.is_some_and(|swing| leads_there(&swing));
        let Some(places) = places.filter(|places| is_fit && places.iter().all(is_clear)) else {
            return self.halt(robot, Course::Face(target));
        };
        let places = driver.really(places);
        if self.meets_another(robot, &places) {
            *is_held = true;
            return None;
        }
        Some((course, places))
    }

    /// From how near cells that are not open are kept away from the centre. With a clearance,
    /// open cells are those with room for the body, wherever in them its centre is.
    fn reach(&self) -> f64 {
        match self.clearance {
            0 => self.motion.radius,
            _ => 0.0,
        }
    }

    fn is_open(&self, cell: Cell, is_free: impl Fn(Cell) -> bool) -> bool {
        match self.clearance {
            0 => is_free(cell),
            clearance => body_cells(clearance, cell).all(is_free),
        }
    }

    /// Whether a body on its way by these places would come too near to where another one
    /// may be, and nearer than it is; or, where cells hold one body, into the cell of another.
    fn meets_another(&self, robot: usize, places: &[Vec2]) -> bool {
        if !self.are_solid {
            return false;
        }
        let own = &self.drivers[robot];
        let least = 2.0 * self.motion.radius + 2.0 * LEAST_MARGIN * self.motion.cell;
        let length = |places: &[Vec2]| -> f64 {
            let steps = places.windows(2);
            steps.map(|pair| (pair[1] - pair[0]).length()).sum()
        };
        let reach = length(places) + 2.0 * self.motion.cell + least;
        let entered: BTreeSet<(i16, i16)> = places
            .iter()
            .map(|&place| self.cells.of(place))
            .filter(|cell| *cell != own.cell)
            .map(|cell| (cell.x, cell.y))
            .collect();
        let others = self.drivers.iter().enumerate();
        others
            .filter(|(index, other)| {
                let apart = (other.pose.at - own.pose.at).length();
                *index != robot && apart < reach + length(&other.claim)
            })
            .any(|(_, other)| {
                let holds = |cell: Cell| entered.contains(&(cell.x, cell.y));
                let mut held = other.claim.iter().map(|&place| self.cells.of(place));
                if self.clearance == 0 && (holds(other.cell) || held.any(holds)) {
                    return true;
                }
                other.claim.iter().any(|&theirs| {
                    let least = least.min((own.pose.at - theirs).length()) - 1e-9;
                    places.iter().any(|&ours| (ours - theirs).length() < least)
                })
            })
    }

    /// All bodies go on for a tick, in a world.
    pub(crate) fn drive(&mut self, tick: u32, is_free: impl Fn(Cell) -> bool) {
        let (moments, dt) = self.moments;
        let lot = self.lot.of(tick.into());
        let grips: Vec<[f64; 2]> = (0..self.drivers.len() as u64)
            .map(|robot| [0, 1].map(|axis| 1.0 - self.motion.slip * lot.of(robot).of(axis).unit()))
            .collect();
        for _ in 0..moments {
            for (robot, grip) in grips.iter().enumerate() {
                self.drive_one(robot, *grip, dt, &is_free);
            }
        }
        for driver in &mut self.drivers {
            let cells = self.cells;
            driver.cell = follow(driver.cell, cells.of(driver.pose.at), &is_free);
            let before = driver.believed_cell;
            // Which way round a corner it believes to go shows nowhere.
            driver.believed_cell = follow(before, cells.of(driver.believed.at), &is_free);
            if driver.believed_cell != before {
                driver.tries = 0;
            }
        }
    }

    fn drive_one(&mut self, robot: usize, grip: [f64; 2], dt: f64, is_free: impl Fn(Cell) -> bool) {
        let limits = &self.limits;
        let driver = &self.drivers[robot];
        let mut believes = driver.believes();
        let wished = driver.course.wish(&believes, limits, dt);
        believes.accelerate(wished, limits, dt);
        let velocity = believes.velocity;
        let real = limits.scaled(velocity, grip);
        let (at, by) = (driver.pose.at, driver.pose.shift(real, dt));
        let others = self.drivers.iter().enumerate();
        let others = others.filter(|(index, _)| *index != robot && self.are_solid);
        let others = others.map(|(_, other)| other.pose.at);
        let (share, hit) = self
            .cells
            .advance((at, by), self.motion.radius, is_free, others);
        let measured = limits.scaled(velocity, driver.measures);
        let driver = &mut self.drivers[robot];
        driver.pose = Pose {
            at: at + by * share,
            ..driver.pose.moved(real, dt)
        };
        // Wheels that are held turn no more.
        driver.believed = Pose {
            at: driver.believed.at + driver.believed.shift(measured, dt) * share,
            ..driver.believed.moved(measured, dt)
        };
        driver.velocity = velocity;
        driver.metres += by.length() * share;
        driver.radians += (real.turn * dt).abs();
        if hit.is_some() {
            driver.velocity.along = Vec2::ZERO;
        }
        match hit {
            Some(Hit::Wall) if driver.touching != hit => driver.touches.walls += 1,
            Some(Hit::Body) if driver.touching != hit => driver.touches.bodies += 1,
            _ => {}
        }
        if hit.is_some() || by != Vec2::ZERO {
            driver.touching = hit;
        }
    }
}

impl Driver {
    fn believes(&self) -> State {
        State {
            pose: self.believed,
            velocity: self.velocity,
        }
    }

    /// Places that it believes to come by, as they are.
    fn really(&self, mut places: Vec<Vec2>) -> Vec<Vec2> {
        let off = self.pose.at - self.believed.at;
        places.iter_mut().for_each(|place| *place += off);
        places
    }
}

/// The cell one step nearer to another one, through a free one if there is a choice.
fn follow(cell: Cell, to: Cell, is_free: impl Fn(Cell) -> bool) -> Cell {
    let across = match to.x.cmp(&cell.x) {
        std::cmp::Ordering::Less => Some(Direction::West),
        std::cmp::Ordering::Equal => None,
        std::cmp::Ordering::Greater => Some(Direction::East),
    };
    let down = match to.y.cmp(&cell.y) {
        std::cmp::Ordering::Less => Some(Direction::North),
        std::cmp::Ordering::Equal => None,
        std::cmp::Ordering::Greater => Some(Direction::South),
    };
    let steps = [across, down].into_iter().flatten();
    let mut cells = steps.map(|step| cell.step(step));
    let first_free = cells.clone().find(|&cell| is_free(cell));
    first_free.or(cells.next_back()).unwrap_or(cell)
}
