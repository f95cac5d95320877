//! What happens to robots, cells and senses from outside, and when; and how it is written.

use std::fmt;
use std::str::FromStr;

use planner_core::{Cell, Extent, RobotId};
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::ScenarioError;

/// What goes wrong with robots, cells and senses, and who is told to go on.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Faults {
    /// Robots that die: the first tick in which each does nothing.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub deaths: Vec<Event>,
    /// Robots that come late: the first tick in which each is on its start.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub arrivals: Vec<Event>,
    /// Robots that start anew where they are, with an empty map, also if they were dead:
    /// the first tick after each lost its memory.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub restarts: Vec<Event>,
    /// Robots that are told to go on with the map at hand, whether they have stopped or
    /// not.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub resumes: Vec<Event>,
    /// Free cells that nobody can enter for a while, and that no sensor shows to be so.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub closures: Vec<CellSpan>,
    /// Cells that are blocked for a while, and seen so: somebody stands there, or a door is
    /// shut.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub shut: Vec<CellSpan>,
    /// Cells that no sensor shows for a while, as glass or matt black: what is behind one
    /// is seen as if it were shown.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub blind: Vec<CellSpan>,
    /// Robots whose sensor shows nothing from a tick on but the cell that they stand on.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub sensor_failures: Vec<Event>,
    /// Robots whose pose lies off the grid for a while.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub lost_poses: Vec<RobotSpan>,
}

impl Faults {
    /// Every robot that is named, with the option that names it.
    pub(super) fn robots(&self) -> impl Iterator<Item = (&'static str, RobotId)> + '_ {
        let events = [
            ("kill", &self.deaths),
            ("late", &self.arrivals),
            ("restart", &self.restarts),
            ("resume", &self.resumes),
            ("sensor-fails", &self.sensor_failures),
        ];
        let events = events.into_iter();
        let lost = self.lost_poses.iter().map(|of| ("pose-lost", of.robot));
        events
            .flat_map(|(option, events)| events.iter().map(move |of| (option, of.robot)))
            .chain(lost)
    }

    /// # Errors
    /// A cell that is named lies outside of a map of `extent`.
    pub(super) fn check_cells(&self, extent: Extent) -> Result<(), ScenarioError> {
        let spans = [
            ("close", &self.closures),
            ("shut", &self.shut),
            ("blind", &self.blind),
        ];
        for (option, spans) in spans {
            if let Some(span) = spans.iter().find(|of| !extent.contains(of.cell)) {
                return Err(ScenarioError::FaultOutside {
                    option,
                    cell: span.cell,
                    extent,
                });
            }
        }
        Ok(())
    }

    /// Whether nobody can enter `cell` in `tick`.
    pub(crate) fn is_closed(&self, cell: Cell, tick: u32) -> bool {
        self.closures.iter().any(|of| of.holds(cell, tick))
    }

    /// Whether no sensor shows `cell` in `tick`.
    pub(crate) fn is_blind(&self, cell: Cell, tick: u32) -> bool {
        self.blind.iter().any(|of| of.holds(cell, tick))
    }

    /// Whether the sensor of `robot` shows nothing in `tick`.
    pub(crate) fn has_failed(&self, robot: usize, tick: u32) -> bool {
        let has = |of: &Event| usize::from(of.robot.0) == robot && of.tick <= tick;
        self.sensor_failures.iter().any(has)
    }

    /// Whether `robot` does not know where it is in `tick`.
    pub(crate) fn is_lost(&self, robot: usize, tick: u32) -> bool {
        self.lost_poses.iter().any(|of| of.holds(robot, tick))
    }

    /// Whether one of `events` befalls `robot` in `tick`.
    pub(crate) fn befalls(events: &[Event], robot: RobotId, tick: u32) -> bool {
        events.contains(&Event { robot, tick })
    }

    /// Whether `robot` lives in `tick`. Of what befalls it in one tick, death comes first.
    pub fn is_alive(&self, robot: RobotId, tick: u32) -> bool {
        let of = |events: &[Event], until: u32| -> Option<u32> {
            let befallen = events
                .iter()
                .filter(|of| of.robot == robot && of.tick <= until);
            befallen.map(|of| of.tick).max()
        };
        let is_there = |tick| self.has_come(robot, tick);
        let death = of(&self.deaths, tick);
        let restart = of(&self.restarts, tick).filter(|&restart| is_there(restart));
        let life = of(&self.arrivals, tick).max(restart);
        match (life, death) {
            (Some(life), Some(death)) => life >= death,
            (Some(_), None) => true,
            (None, Some(_)) => false,
            (None, None) => is_there(tick),
        }
    }

    /// Whether `robot` is there in `tick`, dead or alive.
    pub(crate) fn has_come(&self, robot: RobotId, tick: u32) -> bool {
        let has_arrived = |of: &Event| of.robot == robot && of.tick <= tick;
        !self.comes_late(robot) || self.arrivals.iter().any(has_arrived)
    }

    /// Whether `robot` is not there from the beginning.
    pub(crate) fn comes_late(&self, robot: RobotId) -> bool {
        self.arrivals.iter().any(|of| of.robot == robot)
    }

    /// Whether, from `tick` on, somebody is still to come, to come back or to go on.
    pub(crate) fn still_to_come(&self, tick: u32) -> bool {
        let orders = [&self.arrivals, &self.restarts, &self.resumes];
        orders.into_iter().flatten().any(|of| of.tick >= tick)
    }
}

/// Something befalls a robot in a tick, before it acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "(u8, u32)", into = "(u8, u32)")]
pub struct Event {
    /// Which robot.
    pub robot: RobotId,
    /// In which tick.
    pub tick: u32,
}

/// Something is wrong with a cell in the ticks `from..until`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "(i16, i16, u32, u32)", into = "(i16, i16, u32, u32)")]
pub struct CellSpan {
    /// Which cell.
    pub cell: Cell,
    /// First tick.
    pub from: u32,
    /// First tick in which it is over.
    pub until: u32,
}

/// Something is wrong with a robot in the ticks `from..until`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "(u8, u32, u32)", into = "(u8, u32, u32)")]
pub struct RobotSpan {
    /// Which robot.
    pub robot: RobotId,
    /// First tick.
    pub from: u32,
    /// First tick in which it is over.
    pub until: u32,
}

impl CellSpan {
    pub(crate) fn holds(&self, cell: Cell, tick: u32) -> bool {
        self.cell == cell && (self.from..self.until).contains(&tick)
    }
}

impl RobotSpan {
    pub(crate) fn holds(&self, robot: usize, tick: u32) -> bool {
        usize::from(self.robot.0) == robot && (self.from..self.until).contains(&tick)
    }
}

impl From<(u8, u32)> for Event {
    fn from((robot, tick): (u8, u32)) -> Self {
        let robot = RobotId(robot);
        Self { robot, tick }
    }
}

impl From<Event> for (u8, u32) {
    fn from(of: Event) -> Self {
        (of.robot.0, of.tick)
    }
}

impl From<(i16, i16, u32, u32)> for CellSpan {
    fn from((x, y, from, until): (i16, i16, u32, u32)) -> Self {
        let cell = Cell::new(x, y);
        Self { cell, from, until }
    }
}

impl From<CellSpan> for (i16, i16, u32, u32) {
    fn from(of: CellSpan) -> Self {
        (of.cell.x, of.cell.y, of.from, of.until)
    }
}

impl From<(u8, u32, u32)> for RobotSpan {
    fn from((robot, from, until): (u8, u32, u32)) -> Self {
        let robot = RobotId(robot);
        Self { robot, from, until }
    }
}

impl From<RobotSpan> for (u8, u32, u32) {
    fn from(of: RobotSpan) -> Self {
        (of.robot.0, of.from, of.until)
    }
}

/// A text that is not of the form that is expected.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("expected {0}")]
pub struct FaultText(&'static str);

/// `ROBOT@TICK`.
impl FromStr for Event {
    type Err = FaultText;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let read = || {
            let (robot, tick) = text.split_once('@')?;
            Some(Self {
                robot: RobotId(robot.parse().ok()?),
                tick: tick.parse().ok()?,
            })
        };
        read().ok_or(FaultText(
            "ROBOT@TICK, for example 2@100: robot 2 in tick 100",
        ))
    }
}

impl fmt::Display for Event {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}@{}", self.robot.0, self.tick)
    }
}

/// `X,Y` for all ticks or `X,Y@FROM-UNTIL`.
impl FromStr for CellSpan {
    type Err = FaultText;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let read = || {
            let (cell, (from, until)) = match text.split_once('@') {
                None => (text, (0, u32::MAX)),
                Some((cell, span)) => (cell, ticks(span)?),
            };
            let (x, y) = cell.split_once(',')?;
            let cell = Cell::new(x.trim().parse().ok()?, y.trim().parse().ok()?);
            Some(Self { cell, from, until })
        };
        read().ok_or(FaultText(
            "X,Y or X,Y@FROM-UNTIL, for example 3,4@10-50: cell 3,4 in ticks 10 to 49",
        ))
    }
}

impl fmt::Display for CellSpan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.from, self.until) {
            (0, u32::MAX) => write!(f, "{}", self.cell),
            (from, until) => write!(f, "{}@{from}-{until}", self.cell),
        }
    }
}

/// `ROBOT@FROM-UNTIL`.
impl FromStr for RobotSpan {
    type Err = FaultText;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let read = || {
            let (robot, span) = text.split_once('@')?;
            let (from, until) = ticks(span)?;
            let robot = RobotId(robot.parse().ok()?);
            Some(Self { robot, from, until })
        };
        read().ok_or(FaultText(
            "ROBOT@FROM-UNTIL, for example 1@20-50: robot 1 in ticks 20 to 49",
        ))
    }
}

impl fmt::Display for RobotSpan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}@{}-{}", self.robot.0, self.from, self.until)
    }
}

/// `FROM-UNTIL`, at least one tick.
fn ticks(text: &str) -> Option<(u32, u32)> {
    let (from, until) = text.split_once('-')?;
    let (from, until) = (from.parse().ok()?, until.parse().ok()?);
    (from < until).then_some((from, until))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_and_what_is_not_understood_says_what_is_expected() {
        for text in ["3,4", "3,4@0-50", "-1,0@10-4294967295"] {
            assert_eq!(text.parse::<CellSpan>().unwrap().to_string(), text);
        }
        assert_eq!("2@100".parse::<Event>().unwrap().to_string(), "2@100");
        assert_eq!("2@1-9".parse::<RobotSpan>().unwrap().to_string(), "2@1-9");
        for text in ["", "3", "3,4@", "3,4@9", "3,4@9-9", "3,x", "3,4@9-2"] {
            let error = text.parse::<CellSpan>().unwrap_err().to_string();
            assert!(error.contains("X,Y@FROM-UNTIL"), "{text}: {error}");
        }
        for text in ["", "1@5", "1@5-5", "256@5-9"] {
            let error = text.parse::<RobotSpan>().unwrap_err().to_string();
            assert!(error.contains("ROBOT@FROM-UNTIL"), "{text}: {error}");
        }
        let error = "2".parse::<Event>().unwrap_err().to_string();
        assert!(error.contains("ROBOT@TICK"), "{error}");
    }
}
