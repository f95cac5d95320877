//! What happens to robots and cells from outside, and when; and how it is written.

use std::fmt;
use std::str::FromStr;

use planner_core::{Cell, RobotId};
use thiserror::Error;

/// What goes wrong with robots and cells, and who is told to go on.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Faults {
    /// Robots that die.
    pub deaths: Vec<Death>,
    /// Robots that come late.
    pub arrivals: Vec<Arrival>,
    /// Robots that lose their memory.
    pub restarts: Vec<Restart>,
    /// Robots that are told to go on after a stop.
    pub resumes: Vec<Resume>,
    /// Cells that nobody can enter for a while, and that no sensor shows.
    pub closures: Vec<Closure>,
    /// Cells that no sensor shows anything of.
    pub blind: Vec<Blind>,
    /// Sensors that fall silent.
    pub sensor_failures: Vec<SensorFailure>,
    /// Robots that do not know where they are for a while.
    pub lost_poses: Vec<LostPose>,
}

/// A robot dies before it acts in a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Death {
    /// Which one.
    pub robot: RobotId,
    /// The first tick in which it does nothing.
    pub tick: u32,
}

/// A robot is not in the world before a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Arrival {
    /// Which one.
    pub robot: RobotId,
    /// The first tick in which it stands on its start.
    pub tick: u32,
}

/// A robot starts anew where it stands, with an empty map, also if it was dead.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Restart {
    /// Which one.
    pub robot: RobotId,
    /// The first tick after its memory was lost.
    pub tick: u32,
}

/// A robot is told to go on with the map at hand, whether it has stopped or not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Resume {
    /// Which one.
    pub robot: RobotId,
    /// The tick in which it goes on.
    pub tick: u32,
}

/// A robot's sensor shows nothing any more but the cell that the robot stands on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SensorFailure {
    /// Which robot's.
    pub robot: RobotId,
    /// The first tick in which it shows nothing.
    pub tick: u32,
}

/// A free cell that cannot be entered in the ticks `from..until`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Closure {
    /// Which cell.
    pub cell: Cell,
    /// First tick.
    pub from: u32,
    /// First tick in which it is open again.
    pub until: u32,
}

/// A cell that no sensor shows in the ticks `from..until`, as glass or matt black: what
/// is behind it is seen as if it were shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Blind {
    /// Which cell.
    pub cell: Cell,
    /// First tick.
    pub from: u32,
    /// First tick in which it is shown again.
    pub until: u32,
}

/// A robot's pose lies off the grid in the ticks `from..until`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LostPose {
    /// Which robot's.
    pub robot: RobotId,
    /// First tick.
    pub from: u32,
    /// First tick with a good pose again.
    pub until: u32,
}

impl Closure {
    pub(super) fn holds(&self, cell: Cell, tick: u32) -> bool {
        self.cell == cell && (self.from..self.until).contains(&tick)
    }
}

impl Blind {
    pub(crate) fn holds(&self, cell: Cell, tick: u32) -> bool {
        self.cell == cell && (self.from..self.until).contains(&tick)
    }
}

impl LostPose {
    pub(crate) fn holds(&self, robot: usize, tick: u32) -> bool {
        usize::from(self.robot.0) == robot && (self.from..self.until).contains(&tick)
    }
}

/// A text that is not of the form that is expected.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("expected {0}")]
pub struct FaultText(&'static str);

/// `ROBOT@TICK`, to read and to write.
macro_rules! robot_at_tick {
    ($($kind:ident)*) => {$(
        impl FromStr for $kind {
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

        impl fmt::Display for $kind {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "{}@{}", self.robot.0, self.tick)
            }
        }
    )*};
}

robot_at_tick!(Death Arrival Restart Resume SensorFailure);

/// `X,Y` for all ticks or `X,Y@FROM-UNTIL`, to read and to write.
macro_rules! cell_in_ticks {
    ($($kind:ident)*) => {$(
        impl FromStr for $kind {
            type Err = FaultText;

            fn from_str(text: &str) -> Result<Self, Self::Err> {
                let read = || {
                    let (cell, (from, until)) = match text.split_once('@') {
                        None => (text, (0, u32::MAX)),
                        Some((cell, spell)) => (cell, ticks(spell)?),
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

        impl fmt::Display for $kind {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                match (self.from, self.until) {
                    (0, u32::MAX) => write!(f, "{}", self.cell),
                    (from, until) => write!(f, "{}@{from}-{until}", self.cell),
                }
            }
        }
    )*};
}

cell_in_ticks!(Closure Blind);

impl FromStr for LostPose {
    type Err = FaultText;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let read = || {
            let (robot, spell) = text.split_once('@')?;
            let (from, until) = ticks(spell)?;
            let robot = RobotId(robot.parse().ok()?);
            Some(Self { robot, from, until })
        };
        read().ok_or(FaultText(
            "ROBOT@FROM-UNTIL, for example 1@20-50: robot 1 in ticks 20 to 49",
        ))
    }
}

impl fmt::Display for LostPose {
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
            assert_eq!(text.parse::<Closure>().unwrap().to_string(), text);
            assert_eq!(text.parse::<Blind>().unwrap().to_string(), text);
        }
        assert_eq!("2@100".parse::<Resume>().unwrap().to_string(), "2@100");
        assert_eq!("2@1-9".parse::<LostPose>().unwrap().to_string(), "2@1-9");
        for text in ["", "3", "3,4@", "3,4@9", "3,4@9-9", "3,x", "3,4@9-2"] {
            let error = text.parse::<Closure>().unwrap_err().to_string();
            assert!(error.contains("X,Y@FROM-UNTIL"), "{text}: {error}");
        }
        for text in ["", "1@5", "1@5-5", "256@5-9"] {
            let error = text.parse::<LostPose>().unwrap_err().to_string();
            assert!(error.contains("ROBOT@FROM-UNTIL"), "{text}: {error}");
        }
        let error = "2".parse::<SensorFailure>().unwrap_err().to_string();
        assert!(error.contains("ROBOT@TICK"), "{error}");
    }
}
