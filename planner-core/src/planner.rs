//! The verbs that every planner has, and the plain data that they exchange.

use core::fmt;

use crate::cell::{Cell, Direction};
use crate::explorer::Role;
use crate::map::{Learnt, Map, TileIndex, TileSet};
use crate::radio::{FrameError, Heard, MAX_LEN};
use crate::sight::Sighting;

/// Names a robot. Lower ids win ties.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RobotId(pub u8);

/// What the robot shall do now. Every [`Planner::tick`] returns one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Action {
    /// Go to the neighbouring cell; then [`Planner::report`] how it went.
    Move(Direction),
    /// Stand still for this tick: a search is under way, or the way is closed for a while.
    Wait,
    /// Done, for this reason. Final: every later tick returns the same.
    Stop(Stop),
}

/// Why a robot stopped. "Done" and "gave up" never look alike.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Stop {
    /// Every cell that can be reached from here is known.
    Complete,
    /// Every cell that can be reached from here is known; the map has
    /// `frontiers` more frontier cells, heard from others, behind known walls.
    Enclosed {
        /// Frontier cells that no way leads to.
        frontiers: u32,
    },
    /// Gave up: the only ways to what is left stayed blocked.
    Blocked {
        /// Frontier cells left.
        frontiers: u32,
        /// A cell that could not be entered.
        at: Cell,
    },
    /// Gave up: back at the start with no frontier in view [Gauville2019 §3.2
    /// step 2b]. The published algorithm takes this for completeness; it is not.
    BackAtStart {
        /// Frontier cells left on the robot's map.
        frontiers: u32,
    },
    /// Gave up: no frontier in view and no neighbour to follow a trace to
    /// [Gauville2019 §3.2 step 2c, §6.1].
    NoTrace {
        /// Frontier cells left on the robot's map.
        frontiers: u32,
    },
}

impl Stop {
    /// Whether everything that the robot could reach is known to it.
    pub const fn is_complete(self) -> bool {
        matches!(self, Self::Complete | Self::Enclosed { .. })
    }
}

impl fmt::Display for Stop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Complete => write!(f, "complete"),
            Self::Enclosed { frontiers } => write!(
                f,
                "complete; {frontiers} frontier cells heard of lie behind walls"
            ),
            Self::Blocked { frontiers, at } => write!(
                f,
                "gave up: the way stayed blocked at {at}, {frontiers} frontier cells left"
            ),
            Self::BackAtStart { frontiers } => write!(
                f,
                "back at the start with no frontier in view, {frontiers} frontier cells on the map"
            ),
            Self::NoTrace { frontiers } => write!(
                f,
                "no frontier in view and no trace to follow, {frontiers} frontier cells on the map"
            ),
        }
    }
}

/// How the step of the last [`Action::Move`] went.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Motion {
    /// The robot is on the cell that it was sent to.
    Moved,
    /// Something stood in the way; the robot is where it was.
    Blocked,
    /// Another robot stands there and goes first; the robot is where it was, and
    /// its plan holds.
    Held,
}

/// What a robot says about itself, and remembers of the others: hints, never
/// needed for completeness.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Status {
    /// Where it is.
    pub position: Cell,
    /// Where it is going.
    pub goal: Option<Cell>,
    /// What it has come to.
    pub activity: Activity,
}

/// The part of a robot's state that others decide by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Activity {
    /// Exploring.
    Exploring,
    /// Following others' traces [Gauville2019 §6.1].
    SecondChance,
    /// Stopped for good.
    Stopped,
}

/// A planner of one robot on a map of at most `TW`×`TH` tiles.
///
/// One tick of a robot is: [`observe`](Self::observe), any number of exchanges
/// with other robots, [`tick`](Self::tick), and after a move
/// [`report`](Self::report). No call does I/O, allocates or panics, and each does
/// a bounded amount of work.
pub trait Planner<const TW: usize, const TH: usize> {
    /// Takes in what the robot sees from where it stands.
    fn observe(&mut self, sighting: &Sighting) -> Learnt;

    /// Decides. Call it once per tick.
    fn tick(&mut self) -> Action;

    /// Says how the step of the last [`Action::Move`] went.
    fn report(&mut self, motion: Motion);

    /// Writes the next frame for the others and returns its length, or `None` if
    /// there is nothing to send or the budget of bytes is used up. May be called
    /// until it returns `None`.
    fn transmit(&mut self, buffer: &mut [u8; MAX_LEN]) -> Option<usize>;

    /// Takes in a frame of another robot, at any time.
    ///
    /// # Errors
    /// The frame says nothing to this robot; nothing has changed then.
    fn receive(&mut self, bytes: &[u8]) -> Result<Heard, FrameError>;

    /// What the robot knows.
    fn map(&self) -> &Map<TW, TH>;

    /// What the robot would tell the others about itself.
    fn status(&self) -> Status;

    /// The tiles of the map that changed since the last call. For media that
    /// carry whole maps; what is taken here is not transmitted first any more.
    fn take_changed(&mut self) -> TileSet<TH>;

    /// Joins the given tiles of another robot's map into the own one.
    fn join(&mut self, other: &Map<TW, TH>, tiles: &TileSet<TH>) -> Learnt;

    /// Takes in what robot `id` told about itself.
    fn hear(&mut self, id: RobotId, status: Status);

    /// Work of the last [`tick`](Self::tick), counted in tile operations and
    /// rows of the decision window.
    fn work(&self) -> u32;

    /// Steps to the goal that the last [`tick`](Self::tick) assigned. `None`: it
    /// assigned none, or this planner does not tell.
    fn assignment(&self) -> Option<u32> {
        None
    }

    /// What the robot is about to do, for an [`exchange`](crate::explorer::exchange)
    /// with a robot in its way. `None`: this planner does not exchange roles.
    fn role(&self) -> Option<Role> {
        None
    }

    /// The cells of a tile that the search over the whole map has reached, for
    /// displays; none if no search is under way, or this planner does not tell.
    fn searched(&self, at: TileIndex) -> u64 {
        let _ = at;
        0
    }

    /// Takes over another robot's role.
    fn adopt(&mut self, role: Role) {
        let _ = role;
    }
}
