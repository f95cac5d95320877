//! A robot of a grid, and what became of its decisions.

use planner_core::{AnyPlanner, Cell, Direction, RobotId, Stop};
use serde::{Deserialize, Serialize};

/// A robot: a planner and the body that it moves.
pub struct Robot<const TW: usize, const TH: usize> {
    /// Its number, which is also its index in the fleet.
    pub id: RobotId,
    /// What decides.
    pub planner: Box<dyn AnyPlanner<TW, TH>>,
    /// Where the body is.
    pub position: Cell,
    /// Whether it still sees, decides, speaks and hears. The body of a dead
    /// robot stays where it is.
    pub alive: bool,
    /// What it did in the last tick; `None` before the first and after death.
    pub step: Option<Step>,
    /// What it has sent in this tick.
    pub sent: Sent,
    /// Whether its body is in the world.
    pub(crate) is_there: bool,
    /// Whether it has exchanged its role in this tick.
    pub(crate) has_exchanged: bool,
}

impl<const TW: usize, const TH: usize> Robot<TW, TH> {
    /// Whether its body is in the world: false before it arrives.
    pub fn is_there(&self) -> bool {
        self.is_there
    }
}

impl Sent {
    /// One more frame.
    pub(crate) fn count(&mut self, bytes: usize) {
        self.frames += 1;
        self.bytes += bytes as u32;
    }
}

/// What one robot did in one tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Step {
    /// Where it stood and looked.
    pub at: Cell,
    /// What came of it.
    pub deed: Deed,
    /// Work of its planner.
    pub work: u32,
    /// What it sent.
    pub sent: Sent,
}

/// What a robot sent by radio.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Sent {
    /// Number of frames.
    pub frames: u32,
    /// Their bytes.
    pub bytes: u32,
}

/// Steps in which bodies would have touched: none was made. Anything but none is a bug of a
/// planner that knew better. Of bodies that [move in metres](crate::scenario::Motion): how
/// often one ran into something.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Touches {
    /// With an obstacle, a person or a shut door.
    pub walls: u32,
    /// With another robot.
    pub bodies: u32,
}

/// How far a body went that moves in metres.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Driven {
    /// The length of its way.
    pub millimetres: u32,
    /// Thousandths of full turns that it made, to either side.
    pub milliturns: u32,
    /// What it ran into.
    pub touches: Touches,
}

/// What a decision came to; `S` says why a robot had stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Deed<S = Stop> {
    /// Went to the neighbouring cell.
    Moved(Direction),
    /// Something stood in the way.
    Blocked(Direction),
    /// A robot that goes first stood in the way.
    Held(Direction),
    /// The roles passed through each other: the robot in the way goes on in its
    /// place, and the body stays.
    Exchanged(Direction),
    /// Took over the role of a robot that wanted its cell, before it had acted
    /// itself.
    Yielded,
    /// Stood still.
    Waited,
    /// Was on its way within its cell.
    Driving,
    /// Turned its sensor there.
    Looked(Direction),
    /// Had stopped.
    Stopped(S),
}

impl<S> Deed<S> {
    /// Which way the robot turned by this; `None`: it did not.
    pub fn turns_to(&self) -> Option<Direction> {
        match self {
            Self::Moved(to)
            | Self::Blocked(to)
            | Self::Held(to)
            | Self::Exchanged(to)
            | Self::Looked(to) => Some(*to),
            Self::Yielded | Self::Waited | Self::Driving | Self::Stopped(_) => None,
        }
    }
}

/// A planner sent its robot into an obstacle: a bug of the planner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Violation {
    /// When.
    pub tick: u32,
    /// Which robot.
    pub robot: RobotId,
    /// Into which cell.
    pub into: Cell,
}
