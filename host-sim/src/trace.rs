//! The record of a run in integers: what golden tests compare, what firmware
//! must reproduce, and what every picture is drawn from.
//!
//! A trace file is text. Line 1 is a JSON object, the *header*: the whole
//! scenario with the world's rows (`#` obstacle, `.` free), the number of
//! records and their digest. Line 2 names the columns; every further line is
//! one record, [`COLUMNS`] as comma-separated integers. Nothing else is needed
//! to run the scenario again or to redraw it. What no run leaves (a place outside the
//! world, a robot that is not there, a step that does not follow from the last) is
//! refused on reading, with its line.
//!
//! The digest is the first 16 hex digits of the SHA-256 of all records, each as
//! 30 bytes, little-endian: tick `u32`, robot `u8`, x `i16`, y `i16`, action
//! `u8`, goal x `i16`, goal y `i16`, known `u32`, work `u32`, frames `u32`,
//! bytes `u32`.

mod check;
mod file;

use planner_core::{Cell, Direction};
use sha2::{Digest, Sha256};

pub use file::{Kind, TraceError};

use crate::fleet::{Deed, Robot, Sent, Step};
use crate::run::Scenario;

/// The columns of a record.
pub const COLUMNS: [&str; 11] = [
    "tick", "robot", "x", "y", "action", "goal_x", "goal_y", "known", "work", "frames", "bytes",
];

/// A scenario and all that its robots did.
#[derive(Clone, Debug)]
pub struct Trace {
    /// What was run.
    pub scenario: Scenario,
    /// One record for each living robot and tick, by tick, then by robot.
    pub records: Vec<Record>,
}

/// What one robot did in one tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Record {
    /// Tick, from 0.
    pub tick: u32,
    /// Id of the robot.
    pub robot: u8,
    /// Where it stood, looked and decided.
    pub at: Cell,
    /// 0 to 3: moved east, south, west, north; 4 to 7: tried to, and was
    /// blocked; 8 to 11: and was held by a robot that goes first; 12 to 15: and
    /// exchanged roles with the robot there. 16: waited; 17: gave its role away
    /// before it had acted; 18 to 21: turned its sensor to the east, south, west,
    /// north. From 32 on: had stopped, 32 and
    /// [`Stop::code`](planner_core::Stop::code).
    pub action: u8,
    /// Where it was going; in the file and the digest -1, -1 for nowhere.
    pub goal: Option<Cell>,
    /// Cells on its map, obstacles included.
    pub known: u32,
    /// Work of its planner in this tick.
    pub work: u32,
    /// What it sent by radio in this tick.
    pub sent: Sent,
}

const WAITED: u8 = 16;
const YIELDED: u8 = 17;
const LOOKED: u8 = 18;
const STOPPED: u8 = 32;
const NOWHERE: Cell = Cell::new(-1, -1);

impl Record {
    /// What `robot` did in `tick`.
    pub fn new<const TW: usize, const TH: usize>(
        tick: u32,
        robot: &Robot<TW, TH>,
        step: Step,
    ) -> Self {
        let action = match step.deed {
            Deed::Moved(direction) => direction as u8,
            Deed::Blocked(direction) => 4 + direction as u8,
            Deed::Held(direction) => 8 + direction as u8,
            Deed::Exchanged(direction) => 12 + direction as u8,
            Deed::Waited => WAITED,
            Deed::Yielded => YIELDED,
            Deed::Looked(direction) => LOOKED + direction as u8,
            Deed::Stopped(stop) => STOPPED + stop.code(),
        };
        Self {
            tick,
            robot: robot.id.0,
            at: step.at,
            action,
            goal: robot.planner.status().goal,
            known: robot.planner.map().known_cells(),
            work: step.work,
            sent: step.sent,
        }
    }

    /// Where the robot was after the tick.
    pub fn after(&self) -> Cell {
        match self.action {
            0..4 => self.at.step(Direction::from_index(self.action)),
            _ => self.at,
        }
    }

    /// Which way the robot turned by what it did; `None`: it did not.
    pub fn turns_to(&self) -> Option<Direction> {
        const TURNED: u8 = LOOKED + 4;
        match self.action {
            0..WAITED => Some(Direction::from_index(self.action)),
            LOOKED..TURNED => Some(Direction::from_index(self.action - LOOKED)),
            _ => None,
        }
    }

    /// Where the robot turned its sensor instead of going anywhere.
    pub fn looked(&self) -> Option<Direction> {
        self.turns_to().filter(|_| self.action >= LOOKED)
    }

    /// Whether the robot had stopped.
    pub fn has_stopped(&self) -> bool {
        self.action >= STOPPED
    }

    fn bytes(&self) -> [u8; 30] {
        let goal = self.goal.unwrap_or(NOWHERE);
        let mut bytes = [0; 30];
        bytes[0..4].copy_from_slice(&self.tick.to_le_bytes());
        bytes[4] = self.robot;
        bytes[5..7].copy_from_slice(&self.at.x.to_le_bytes());
        bytes[7..9].copy_from_slice(&self.at.y.to_le_bytes());
        bytes[9] = self.action;
        bytes[10..12].copy_from_slice(&goal.x.to_le_bytes());
        bytes[12..14].copy_from_slice(&goal.y.to_le_bytes());
        bytes[14..18].copy_from_slice(&self.known.to_le_bytes());
        bytes[18..22].copy_from_slice(&self.work.to_le_bytes());
        bytes[22..26].copy_from_slice(&self.sent.frames.to_le_bytes());
        bytes[26..30].copy_from_slice(&self.sent.bytes.to_le_bytes());
        bytes
    }
}

impl Trace {
    pub(crate) fn new(scenario: &Scenario, records: Vec<Record>) -> Self {
        Self {
            scenario: scenario.clone(),
            records,
        }
    }

    /// 16 hex digits that differ if any record does.
    pub fn digest(&self) -> String {
        digest(&self.records)
    }

    /// Number of ticks that were run.
    pub fn ticks(&self) -> u32 {
        self.records.last().map_or(0, |record| record.tick + 1)
    }
}

fn digest(records: &[Record]) -> String {
    let mut sha = Sha256::new();
    for record in records {
        sha.update(record.bytes());
    }
    hex_digits(sha)
}

/// The first 16 hex digits: how the digest of a trace of any kind is written.
pub(crate) fn hex_digits(sha: Sha256) -> String {
    let digest = sha.finalize();
    let first = digest.iter().take(8);
    first.map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests;
