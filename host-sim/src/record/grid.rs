//! The record of a run in integers: what golden tests compare, what firmware
//! must reproduce, and what every picture is drawn from.
//!
//! As a file it is as [`record`] says; the header holds the whole
//! scenario with the world's rows (`#` obstacle, `.` free), the columns are the fields of
//! a [`Record`]. Nothing else is needed to run the scenario again or to redraw it. What no
//! run leaves (a place outside the world, a robot that is not there, a step that does not
//! follow from the last) is refused on reading, with its line.

mod check;
mod file;

use planner_core::{Cell, Direction, Reason};

use crate::record::{self, Format, Kind, Nothing, action_of, reason_of};
use crate::robot::{Deed, Robot, Step};
use crate::scenario::grid::Scenario;

/// A scenario and all that its robots did.
#[derive(Clone, Debug)]
pub struct Trace {
    /// What was run.
    pub scenario: Scenario,
    /// One record for each living robot and tick, by tick, then by robot.
    pub records: Vec<Record>,
}

/// What one robot did in one tick: `at` is where it stood, looked and decided.
pub type Record = record::Record<Grid>;

/// Records of robots in a grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grid;

impl Kind for Grid {
    const FORMAT: Format = Format {
        name: "host-sim trace",
        version: 2,
        oldest: 2,
    };
    type Place = Cell;
    type Deed = Deed<Reason>;
    type Goal = Cell;
    type Gain = Nothing;
}

const BLOCKED: u8 = 4;
const HELD: u8 = 8;
const EXCHANGED: u8 = 12;
const WAITED: u8 = 16;
const YIELDED: u8 = 17;
const LOOKED: u8 = 18;
/// A look to the north.
const LAST_LOOK: u8 = LOOKED + 3;
const DRIVING: u8 = 22;
const LAST_ACT: u8 = DRIVING;

/// What is written down of why a robot had stopped.
impl From<Deed> for Deed<Reason> {
    fn from(deed: Deed) -> Self {
        match deed {
            Deed::Moved(to) => Self::Moved(to),
            Deed::Blocked(to) => Self::Blocked(to),
            Deed::Held(to) => Self::Held(to),
            Deed::Exchanged(to) => Self::Exchanged(to),
            Deed::Yielded => Self::Yielded,
            Deed::Waited => Self::Waited,
            Deed::Driving => Self::Driving,
            Deed::Looked(to) => Self::Looked(to),
            Deed::Stopped(stop) => Self::Stopped(stop.reason()),
        }
    }
}

/// The action in files and digests: 0 to 3 moved east, south, west, north; 4 to 7 tried to,
/// and was blocked; 8 to 11 and was held by a robot that goes first; 12 to 15 and exchanged
/// roles with the robot there; 16 waited; 17 gave its role away before it had acted; 18 to
/// 21 turned its sensor to the east, south, west, north; 22 drove within its cell; from 32 on had stopped, 32 and
/// [`Reason::code`].
impl From<Deed<Reason>> for u8 {
    fn from(deed: Deed<Reason>) -> Self {
        match deed {
            Deed::Moved(to) => to as u8,
            Deed::Blocked(to) => BLOCKED + to as u8,
            Deed::Held(to) => HELD + to as u8,
            Deed::Exchanged(to) => EXCHANGED + to as u8,
            Deed::Waited => WAITED,
            Deed::Driving => DRIVING,
            Deed::Yielded => YIELDED,
            Deed::Looked(to) => LOOKED + to as u8,
            Deed::Stopped(reason) => action_of(reason),
        }
    }
}

impl TryFrom<u8> for Deed<Reason> {
    type Error = String;

    fn try_from(action: u8) -> Result<Self, String> {
        let to = |first| Direction::from_index(action - first);
        Ok(match action {
            0..BLOCKED => Self::Moved(to(0)),
            BLOCKED..HELD => Self::Blocked(to(BLOCKED)),
            HELD..EXCHANGED => Self::Held(to(HELD)),
            EXCHANGED..WAITED => Self::Exchanged(to(EXCHANGED)),
            WAITED => Self::Waited,
            YIELDED => Self::Yielded,
            LOOKED..=LAST_LOOK => Self::Looked(to(LOOKED)),
            DRIVING => Self::Driving,
            _ => Self::Stopped(reason_of(action, LAST_ACT)?),
        })
    }
}

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
            deed: step.deed.into(),
            goal: robot.planner.status().goal,
            gain: Nothing {},
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
            | Deed::Driving
            | Deed::Looked(_)
            | Deed::Stopped(_) => self.at,
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
        record::digest(&self.records)
    }

    /// Number of ticks that were run.
    pub fn ticks(&self) -> u32 {
        self.records.last().map_or(0, |record| record.tick + 1)
    }
}

#[cfg(test)]
mod tests;
