//! The record of a run in integers: what golden tests compare, what firmware
//! must reproduce, and what every picture is drawn from.
//!
//! As a file it is as [`record`](crate::record) says; the header holds the whole
//! scenario with the world's rows (`#` obstacle, `.` free), the columns are the fields of
//! a [`Record`]. Nothing else is needed to run the scenario again or to redraw it. What no
//! run leaves (a place outside the world, a robot that is not there, a step that does not
//! follow from the last) is refused on reading, with its line.

mod check;
mod file;

use planner_core::{Cell, Direction, Reason};

use crate::record;
use crate::robot::{Deed, Robot, Sent, Step};
use crate::scenario::grid::Scenario;

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
    /// What came of its decision. In the file and the digest 0 to 3: moved east, south,
    /// west, north; 4 to 7: tried to, and was blocked; 8 to 11: and was held by a robot
    /// that goes first; 12 to 15: and exchanged roles with the robot there. 16: waited; 17:
    /// gave its role away before it had acted; 18 to 21: turned its sensor to the east,
    /// south, west, north. From 32 on: had stopped, 32 and
    /// [`Stop::code`](planner_core::Stop::code).
    pub deed: Deed<Reason>,
    /// Where it was going; in the file and the digest -1, -1 for nowhere.
    pub goal: Option<Cell>,
    /// Cells on its map, obstacles included.
    pub known: u32,
    /// Work of its planner in this tick.
    pub work: u32,
    /// What it sent by radio in this tick.
    pub sent: Sent,
}

record::row!(
    /// A record in the file.
    Row {
        tick: u32,
        robot: u8,
        x: i16,
        y: i16,
        action: u8,
        goal_x: i16,
        goal_y: i16,
        known: u32,
        work: u32,
        frames: u32,
        bytes: u32,
    }
);

const BLOCKED: u8 = 4;
const HELD: u8 = 8;
const EXCHANGED: u8 = 12;
const WAITED: u8 = 16;
const YIELDED: u8 = 17;
const LOOKED: u8 = 18;
const NOWHERE: Cell = Cell::new(-1, -1);

impl Deed<Reason> {
    fn action(self) -> u8 {
        match self {
            Self::Moved(to) => to as u8,
            Self::Blocked(to) => BLOCKED + to as u8,
            Self::Held(to) => HELD + to as u8,
            Self::Exchanged(to) => EXCHANGED + to as u8,
            Self::Waited => WAITED,
            Self::Yielded => YIELDED,
            Self::Looked(to) => LOOKED + to as u8,
            Self::Stopped(reason) => record::action_of(reason),
        }
    }

    fn of_action(action: u8) -> Option<Self> {
        let to = |first| Direction::from_index(action - first);
        Some(match action {
            0..BLOCKED => Self::Moved(to(0)),
            BLOCKED..HELD => Self::Blocked(to(BLOCKED)),
            HELD..EXCHANGED => Self::Held(to(HELD)),
            EXCHANGED..WAITED => Self::Exchanged(to(EXCHANGED)),
            WAITED => Self::Waited,
            YIELDED => Self::Yielded,
            LOOKED..=LAST_ACT => Self::Looked(to(LOOKED)),
            _ => Self::Stopped(record::reason_of(action)?),
        })
    }
}

/// The last action of a robot that has not stopped: a look to the north.
const LAST_ACT: u8 = LOOKED + 3;

impl Record {
    /// What `robot` did in `tick`.
    pub fn new<const TW: usize, const TH: usize>(
        tick: u32,
        robot: &Robot<TW, TH>,
        step: Step,
    ) -> Self {
        Self {
            tick,
            robot: robot.id.0,
            at: step.at,
            deed: step.deed.in_short(),
            goal: robot.planner.status().goal,
            known: robot.planner.map().known_cells(),
            work: step.work,
            sent: step.sent,
        }
    }

    /// Where the robot was after the tick.
    pub fn after(&self) -> Cell {
        match self.deed {
            Deed::Moved(to) => self.at.step(to),
            Deed::Blocked(_)
            | Deed::Held(_)
            | Deed::Exchanged(_)
            | Deed::Yielded
            | Deed::Waited
            | Deed::Looked(_)
            | Deed::Stopped(_) => self.at,
        }
    }

    fn row(&self) -> Row {
        let goal = self.goal.unwrap_or(NOWHERE);
        Row {
            tick: self.tick,
            robot: self.robot,
            x: self.at.x,
            y: self.at.y,
            action: self.deed.action(),
            goal_x: goal.x,
            goal_y: goal.y,
            known: self.known,
            work: self.work,
            frames: self.sent.frames,
            bytes: self.sent.bytes,
        }
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
        record::digest(self.records.iter().map(Record::row))
    }

    /// Number of ticks that were run.
    pub fn ticks(&self) -> u32 {
        self.records.last().map_or(0, |record| record.tick + 1)
    }
}

#[cfg(test)]
mod tests;
