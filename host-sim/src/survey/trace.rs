//! What a run leaves behind.
//!
//! As a file it is as [`record`](crate::record) says; the header holds the scenario, the
//! terrain's heights in quarters of a cell and why each robot had stopped at the end, the
//! columns are the fields of a [`Record`]. Version 1 had the reasons 33 and 39 the other
//! way round.

mod read;

use std::io;

use planner_core::surface::Column;
use planner_core::survey::Limits;
use planner_core::{Cell, Extent, Point, Stop};
use serde::{Deserialize, Serialize};

use crate::record::{self, Deed, Format};
use crate::robot::Sent;
use crate::scenario::Conditions;
use crate::scenario::heights::{Planner, Scenario};
use crate::terrain::Terrain;

const FORMAT: Format = Format {
    name: "host-sim survey trace",
    version: 2,
    oldest: 1,
};

/// One decision of one robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Record {
    /// In which step, from 0.
    pub tick: u32,
    /// Whose.
    pub robot: u8,
    /// Where the robot is after it.
    pub at: Point,
    /// What became of it; in the file and the digest 0 flew, 1 refused, 2 hovered, from
    /// 32 on had stopped: 32 and [`Stop::code`].
    pub deed: Deed,
    /// The frontier that it announces; in the file and the digest -1, -1 for none.
    pub goal: Option<Cell>,
    /// What the robot's last step added to its reward [Renzaglia2019 eq. 1].
    pub gain: f32,
    /// Columns on its map.
    pub known: u32,
    /// Work of the decision, as the planner counts it.
    pub work: u32,
    /// What it sent by radio in this step.
    pub sent: Sent,
}

record::row!(
    /// A record in the file.
    Row {
        tick: u32,
        robot: u8,
        x: f32,
        y: f32,
        z: f32,
        action: u8,
        goal_x: i16,
        goal_y: i16,
        gain: f32,
        known: u32,
        work: u32,
        frames: u32,
        bytes: u32,
    }
);

const NOWHERE: Cell = Cell::new(-1, -1);

impl Record {
    fn row(&self) -> Row {
        let goal = self.goal.unwrap_or(NOWHERE);
        Row {
            tick: self.tick,
            robot: self.robot,
            x: self.at.x,
            y: self.at.y,
            z: self.at.z,
            action: self.deed.action(),
            goal_x: goal.x,
            goal_y: goal.y,
            gain: self.gain,
            known: self.known,
            work: self.work,
            frames: self.sent.frames,
            bytes: self.sent.bytes,
        }
    }
}

/// Steps at which something happened that never should.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct Safety {
    /// Flights below the least altitude or above the ceiling.
    pub altitude_violations: u32,
    /// Flights through the ground or out of the box.
    pub obstacle_violations: u32,
    /// Pairs of robots too near to each other.
    pub separation_violations: u32,
    /// Flights longer than a step.
    pub step_violations: u32,
}

impl Safety {
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
    /// What should never happen.
    pub safety: Safety,
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
    pub fn of(&self, robot: usize) -> impl Iterator<Item = &Record> {
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
        let rows = self.records.iter().map(Record::row);
        record::write(to, FORMAT, &Header::of(self), rows)
    }

    /// 16 hex digits that differ if any record does.
    pub fn digest(&self) -> String {
        record::digest(self.records.iter().map(Record::row))
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
    world: Heights,
}

#[derive(Serialize, Deserialize)]
struct Heights {
    name: String,
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
            world: Heights::of(&trace.terrain),
        }
    }
}

impl Heights {
    fn of(terrain: &Terrain) -> Self {
        let Extent { width, height } = terrain.extent();
        let row = |y| {
            let row = (0..width as i16).map(|x| Cell::new(x, y));
            row.map(|cell| terrain.height(cell).unwrap_or_default().0)
                .collect()
        };
        Self {
            name: terrain.name().into(),
            heights: (0..height as i16).map(row).collect(),
        }
    }
}
