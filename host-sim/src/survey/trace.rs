//! What a run leaves behind.
//!
//! A trace file is text. Line 1 is a JSON object, the *header*: the scenario with the
//! terrain's heights in quarters of a cell, why each robot had stopped at the end, the
//! number of records and their digest.
//! Line 2 names the columns; every further line is one record, [`COLUMNS`]. Numbers
//! with a decimal point are the shortest that read back as the same `f32`.
//!
//! The digest is the first 16 hex digits of the SHA-256 of all records, each as 42
//! bytes, little-endian: tick `u32`, robot `u8`, x, y, z `f32`, action `u8`, goal x, y
//! `i16`, gain `f32`, known `u32`, work `u32`, frames `u32`, bytes `u32`.

mod read;

use std::{fmt, io};

use planner_core::surface::Column;
use planner_core::{Cell, Extent, Point, Stop};
use serde_json::json;
use sha2::{Digest, Sha256};

use super::scenario::Scenario;
use super::terrain::Terrain;
use crate::fleet::Sent;
use crate::trace::{Kind, hex_digits};

const KIND: Kind = Kind {
    format: "host-sim survey trace",
    version: 1,
    columns: &COLUMNS,
};

/// The columns of a record.
const COLUMNS: [&str; 13] = [
    "tick", "robot", "x", "y", "z", "action", "goal_x", "goal_y", "gain", "known", "work",
    "frames", "bytes",
];

/// What a robot did in a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Deed {
    /// It flew.
    Flew,
    /// The flight controller refused its flight, for another robot's sake.
    Refused,
    /// It stayed.
    Hovered,
    /// It has stopped.
    Stopped(Stop),
}

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
    /// 32 on had stopped: 32 and [`Stop::code`], but 33 for [`Stop::Unseen`], as in the
    /// first traces, and 39 for [`Stop::Enclosed`].
    pub deed: Deed,
    /// The frontier that it announces; in the file and the digest -1, -1 for none.
    pub target: Option<Cell>,
    /// What the robot's last step added to its reward [Renzaglia2019 eq. 1].
    pub gain: f32,
    /// Columns on its map.
    pub known: u32,
    /// Work of the decision, as the planner counts it.
    pub work: u32,
    /// What it sent by radio in this step.
    pub sent: Sent,
}

impl Record {
    fn action(&self) -> u8 {
        match self.deed {
            Deed::Flew => 0,
            Deed::Refused => 1,
            Deed::Hovered => 2,
            Deed::Stopped(Stop::Unseen { .. }) => 33,
            Deed::Stopped(Stop::Enclosed { .. }) => 39,
            Deed::Stopped(stop) => 32 + stop.code(),
        }
    }

    fn goal(&self) -> Cell {
        self.target.unwrap_or(Cell::new(-1, -1))
    }
}

impl fmt::Display for Record {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { at, sent, .. } = self;
        let goal = self.goal();
        write!(
            f,
            "{},{},{},{},{},{},{},{},{},{},{},{},{}",
            self.tick,
            self.robot,
            at.x,
            at.y,
            at.z,
            self.action(),
            goal.x,
            goal.y,
            self.gain,
            self.known,
            self.work,
            sent.frames,
            sent.bytes
        )
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
    /// What should never happen.
    pub safety: Safety,
    /// Host time of each decision; not part of the digest, and empty in the browser.
    pub decision_nanoseconds: Vec<u64>,
}

impl Trace {
    pub(super) fn new(terrain: &Terrain, scenario: &Scenario, starts: Vec<Point>) -> Self {
        Self {
            scenario: scenario.clone(),
            terrain: terrain.clone(),
            extent: terrain.extent(),
            robots: starts.len(),
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

    /// Why `robot` had stopped at the end, if it had.
    pub fn stop(&self, robot: usize) -> Option<Stop> {
        match self.of(robot).last()?.deed {
            Deed::Stopped(stop) => Some(stop),
            _ => None,
        }
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
    pub fn write(&self, mut to: impl io::Write) -> io::Result<()> {
        let Scenario { limits, kills, .. } = &self.scenario;
        let kills: Vec<_> = kills.iter().map(|kill| (kill.robot, kill.step)).collect();
        let stops: Vec<_> = (0..self.robots).map(|robot| self.stop(robot)).collect();
        let starts: Vec<_> = self.starts.iter().map(|p| [p.x, p.y, p.z]).collect();
        let heights: Vec<Vec<u8>> = (0..self.extent.height as i16)
            .map(|y| {
                let row = (0..self.extent.width as i16).map(|x| Cell::new(x, y));
                row.map(|cell| self.terrain.height(cell).unwrap_or_default().0)
                    .collect()
            })
            .collect();
        let header = json!({
            "format": KIND.format,
            "version": KIND.version,
            "digest": self.digest(),
            "records": self.records.len(),
            "planner": self.scenario.planner,
            "range": limits.range,
            "step": limits.step,
            "min_altitude": limits.min_altitude,
            "ceiling": limits.ceiling,
            "separation": limits.separation,
            "medium": self.scenario.medium,
            "byte_budget": self.scenario.byte_budget,
            "loss": self.scenario.loss,
            "skip": self.scenario.skip,
            "seed": self.scenario.seed,
            "max_ticks": self.scenario.max_ticks,
            "starts": starts,
            "deaths": kills,
            "stops": stops,
            "world": { "name": self.terrain.name(), "heights": heights },
        });
        writeln!(to, "{header}\n{}", COLUMNS.join(","))?;
        for record in &self.records {
            writeln!(to, "{record}")?;
        }
        Ok(())
    }

    /// Writes `tick,seen_cells,seen_share` line by line; the share is of all columns, 0
    /// to 1.
    ///
    /// # Errors
    /// Those of `to`.
    pub fn write_coverage(&self, mut to: impl io::Write) -> io::Result<()> {
        writeln!(to, "tick,seen_cells,seen_share")?;
        let all = f64::from(self.extent.cells());
        for (tick, &seen) in self.seen.iter().enumerate() {
            writeln!(to, "{tick},{seen},{:.6}", f64::from(seen) / all)?;
        }
        Ok(())
    }

    /// 16 hex digits that differ if any record does.
    pub fn digest(&self) -> String {
        digest(&self.records)
    }
}

fn digest(records: &[Record]) -> String {
    let mut sha = Sha256::new();
    for record in records {
        sha.update(record.tick.to_le_bytes());
        sha.update([record.robot]);
        for coordinate in [record.at.x, record.at.y, record.at.z] {
            sha.update(coordinate.to_le_bytes());
        }
        sha.update([record.action()]);
        sha.update(record.goal().x.to_le_bytes());
        sha.update(record.goal().y.to_le_bytes());
        sha.update(record.gain.to_le_bytes());
        for number in [
            record.known,
            record.work,
            record.sent.frames,
            record.sent.bytes,
        ] {
            sha.update(number.to_le_bytes());
        }
    }
    hex_digits(sha)
}
