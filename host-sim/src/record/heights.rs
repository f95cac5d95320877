//! What a run leaves behind.
//!
//! As a file it is as [`record`] says; the header holds the scenario, the
//! terrain's heights in quarters of a cell and why each robot had stopped at the end, the
//! columns are the fields of a [`Record`]. Version 1 had the reasons 33 and 39 the other
//! way round.

mod mapped;
mod read;

use std::io;

use planner_core::surface::{Column, Columns, body_columns, reaches_over};
use planner_core::survey::Limits;
use planner_core::{Cell, Extent, Point, Stop};
use serde::{Deserialize, Serialize};

use crate::record::{self, Deed, Format, Kind};
use crate::scenario::Conditions;
use crate::scenario::heights::{Planner, Scenario};
use crate::terrain::{Scale, Terrain};

/// One decision of one robot: `at` is where it was after it, `goal` the frontier that it
/// announced.
pub type Record = record::Record<Heights>;

/// Records of robots over heights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Heights;

impl Kind for Heights {
    const FORMAT: Format = Format {
        name: "host-sim survey trace",
        version: 2,
        oldest: 1,
    };
    type Place = Point;
    type Deed = Deed;
    type Goal = Cell;
    type Gain = f32;
}

/// Rounding that a planner's f32 arithmetic may be off by.
const TOLERANCE: f32 = 1e-3;

/// Steps at which something happened that never should.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct Safety {
    /// Flights below the least altitude or above the ceiling.
    pub altitude_violations: u32,
    /// Flights in which the body went through the ground or out of the box.
    pub obstacle_violations: u32,
    /// Pairs of robots too near to each other.
    pub separation_violations: u32,
    /// Flights longer than a step.
    pub step_violations: u32,
}

impl Safety {
    pub(crate) fn check_flight(
        &mut self,
        terrain: &Terrain,
        limits: &Limits,
        from: Point,
        to: Point,
    ) {
        // Whom the wind has pushed too low may rise, and too high, sink; and what it has pushed
        // beside something low may fly from there, if it does not sink.
        let is_rise = (to.x, to.y) == (from.x, from.y) && to.z > from.z;
        let was_under = |cell| to.z >= from.z && reaches_over(limits.clearance, from.cell(), cell);
        let radius = f32::from(limits.clearance);
        let (mut is_low, mut touches) = (false, false);
        for crossing in Columns::new(from, to) {
            let low = crossing.entered.min(crossing.left);
            for cell in body_columns(limits.clearance, crossing.cell) {
                let over = terrain.height(cell).map(|ground| low - ground.cells());
                let may_be_low = is_rise || cell != crossing.cell && was_under(cell);
                let least = limits.min_altitude - TOLERANCE;
                is_low |= !may_be_low && over.is_some_and(|over| over < least);
                touches |= over.is_none_or(|over| over < radius - TOLERANCE.min(radius));
            }
        }
        let is_high = to.z > limits.ceiling.max(from.z) + TOLERANCE;
        self.altitude_violations += u32::from(is_high || is_low);
        self.obstacle_violations += u32::from(touches);
        self.step_violations += u32::from(from.distance(to) > limits.step + TOLERANCE);
    }

    /// Given where the living robots are.
    pub(crate) fn check_separation(&mut self, limits: &Limits, alive: &[Point]) {
        for (i, a) in alive.iter().enumerate() {
            for b in &alive[i + 1..] {
                let near = a.distance(*b) < limits.separation - TOLERANCE;
                self.separation_violations += u32::from(near);
            }
        }
    }

    /// The same in wind, where robots are where nobody sent them: how many are on the ground or
    /// too near to another.
    pub(crate) fn contacts(terrain: &Terrain, limits: &Limits, alive: &[Point]) -> u32 {
        let is_near = |a: &Point| {
            let others = alive.iter().filter(|b| !std::ptr::eq(a, *b));
            others.fold(f32::INFINITY, |least, b| least.min(a.distance(*b))) < limits.separation
        };
        let is_down = |at: &Point| {
            let ground = terrain.under(at.cell(), limits.clearance);
            let radius = f32::from(limits.clearance);
            ground.is_some_and(|ground| at.z <= ground.cells() + radius)
        };
        alive.iter().filter(|at| is_down(at) || is_near(at)).count() as u32
    }

    /// All of them.
    pub fn violations(&self) -> u32 {
        self.altitude_violations
            + self.obstacle_violations
            + self.separation_violations
            + self.step_violations
    }
}

/// A whole run.
#[derive(Clone, Debug)]
pub struct Trace {
    /// What was run.
    pub scenario: Scenario,
    /// Where.
    pub terrain: Terrain,
    /// Size of the terrain.
    pub extent: Extent,
    /// Number of robots at the start.
    pub robots: usize,
    /// Where they started.
    pub starts: Vec<Point>,
    /// Every decision, in order.
    pub records: Vec<Record>,
    /// Columns that anybody had seen after each number of steps, from 0.
    pub seen: Vec<u32>,
    /// The columns in the order in which they were seen, each with the step.
    pub found: Vec<(u32, Column)>,
    /// Whether the run ended because every living robot had stopped.
    pub all_stopped: bool,
    /// Why each robot had stopped when it last decided, if it had.
    pub stops: Vec<Option<Stop>>,
    /// What should never happen. A trace does not say where a robot flew that the wind pushed:
    /// then none is counted when it is read.
    pub safety: Safety,
    /// Steps of robots that the wind ended on the ground or too near to another.
    pub contacts: u32,
    /// Host time of each decision; not part of the digest, and empty in the browser.
    pub decision_nanoseconds: Vec<u64>,
}

impl Trace {
    pub(crate) fn new(terrain: &Terrain, scenario: &Scenario, starts: Vec<Point>) -> Self {
        Self {
            scenario: scenario.clone(),
            terrain: terrain.clone(),
            extent: terrain.extent(),
            robots: starts.len(),
            stops: vec![None; starts.len()],
            starts,
            records: Vec::new(),
            seen: Vec::new(),
            found: Vec::new(),
            all_stopped: false,
            safety: Safety::default(),
            contacts: 0,
            decision_nanoseconds: Vec::new(),
        }
    }

    /// Steps until `share` of all columns had been seen.
    pub fn ticks_to(&self, share: f64) -> Option<u32> {
        let wanted = (share * f64::from(self.extent.cells())).ceil() as u32;
        self.seen
            .iter()
            .position(|&seen| seen >= wanted)
            .map(|step| step as u32)
    }

    /// Whether all columns had been seen at the end.
    pub fn complete(&self) -> bool {
        self.ticks_to(1.0).is_some()
    }

    /// The columns that anybody had seen after `steps` steps.
    pub fn mapped(&self, steps: u32) -> impl Iterator<Item = Column> + '_ {
        self.found
            .iter()
            .take_while(move |(step, _)| *step <= steps)
            .map(|(_, column)| *column)
    }

    /// Steps until the last living robot had stopped, if all have.
    pub fn ticks_to_stopped(&self) -> Option<u32> {
        self.all_stopped.then(|| self.seen.len() as u32 - 1)
    }

    /// What `robot` did, step by step.
    pub fn of(&self, robot: usize) -> impl Iterator<Item = &Record> + Clone {
        self.records
            .iter()
            .filter(move |record| usize::from(record.robot) == robot)
    }

    /// Where `robot` was, from the start until after `steps` steps.
    pub fn way(&self, robot: usize, steps: u32) -> Vec<Point> {
        let start = self.starts.get(robot).copied();
        let flown = self.of(robot).take_while(|record| record.tick < steps);
        start
            .into_iter()
            .chain(flown.map(|record| record.at))
            .collect()
    }

    /// Writes the trace in the format that this module documents.
    ///
    /// # Errors
    /// Those of `to`.
    pub fn write(&self, to: impl io::Write) -> io::Result<()> {
        record::write(to, &Header::of(self), &self.records)
    }

    /// 16 hex digits that differ if any record does.
    pub fn digest(&self) -> String {
        record::digest(&self.records)
    }
}

#[derive(Serialize, Deserialize)]
struct Header {
    planner: Planner,
    #[serde(flatten)]
    limits: Limits,
    skip: f64,
    #[serde(flatten)]
    conditions: Conditions,
    starts: Vec<[f32; 3]>,
    /// Of each robot at the end; older traces have none.
    #[serde(default)]
    stops: Vec<Option<Stop>>,
    world: Ground,
}

#[derive(Serialize, Deserialize)]
struct Ground {
    name: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    scale: Option<Scale>,
    /// In quarters of a cell, row by row.
    heights: Vec<Vec<u8>>,
}

impl Header {
    fn of(trace: &Trace) -> Self {
        let scenario = &trace.scenario;
        Self {
            planner: scenario.planner,
            limits: scenario.limits,
            skip: scenario.skip,
            conditions: scenario.conditions.clone(),
            starts: trace.starts.iter().map(|p| [p.x, p.y, p.z]).collect(),
            stops: trace.stops.clone(),
            world: Ground::of(&trace.terrain),
        }
    }
}

impl Ground {
    fn of(terrain: &Terrain) -> Self {
        let Extent { width, height } = terrain.extent();
        let row = |y| {
            let row = (0..width as i16).map(|x| Cell::new(x, y));
            row.map(|cell| terrain.height(cell).unwrap_or_default().0)
                .collect()
        };
        Self {
            name: terrain.name().into(),
            scale: terrain.scale(),
            heights: (0..height as i16).map(row).collect(),
        }
    }
}
