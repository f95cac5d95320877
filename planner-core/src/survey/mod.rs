//! What every planner of a flying robot over a surface shares: its verbs, what it
//! knows, how it flies, and the way out when nothing is gained any more.
//!
//! One step of a robot is [`observe`](Surveyor::observe); then, with every robot in
//! radio range, [`hear`](Surveyor::hear) and [`merge`](Surveyor::merge) what the
//! others sense; then [`tick`](Surveyor::tick), which says where to fly, and
//! [`report`](Surveyor::report). No call does I/O, allocates or panics.

mod flight;
mod knowledge;
mod news;
mod peers;
mod rescue;

pub use knowledge::{Knowledge, SetupError};
pub use news::MAX_RANGE;
pub use peers::{MAX_PEERS, PEER_MEMORY, Peer};
pub use rescue::PATIENCE;

pub(crate) use rescue::Rescue;

use core::fmt;

use crate::cell::Cell;
use crate::point::Point;
use crate::surface::{Column, Patch};

/// The physics of a fleet: what its sensors reach and which poses are allowed, the
/// constraints C(P) ≤ 0 [Renzaglia2019 §3]. All lengths in cells.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Limits {
    /// Sensor range R, above 0 and at most [`MAX_RANGE`].
    pub range: f32,
    /// Longest flight in one step, α, above 0.
    pub step: f32,
    /// Least height over ground, everywhere on the way. At least 0.
    pub min_altitude: f32,
    /// Greatest z.
    pub ceiling: f32,
    /// Least distance from other robots. At least 0.
    pub separation: f32,
}

impl Limits {
    /// All zero: nothing can be flown with them.
    pub(crate) const NONE: Self = Self {
        range: 0.0,
        step: 0.0,
        min_altitude: 0.0,
        ceiling: 0.0,
        separation: 0.0,
    };
}

/// What the robot shall do now.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Action {
    /// Fly straight to this point, at most one step away.
    Fly(Point),
    /// Stay for this step.
    Hover,
    /// Done, for this reason. A robot that then hears of more goes on.
    Stop(Stop),
}

/// Why a robot stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Stop {
    /// Every column of the map is known.
    Complete,
    /// There is unknown surface left, and flying close by every frontier of it
    /// showed none of it.
    Unseen {
        /// Frontiers left.
        frontiers: u32,
    },
}

impl fmt::Display for Stop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Complete => write!(f, "complete"),
            Self::Unseen { frontiers } => {
                write!(
                    f,
                    "gave up: {frontiers} frontiers show nothing new from anywhere near"
                )
            }
        }
    }
}

/// How the last [`Action::Fly`] went.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Motion {
    /// The robot is where it was sent.
    Moved,
    /// Something was in the way; the robot is where it was.
    Blocked,
}

/// What a robot says about itself: hints, never needed for completeness.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Status {
    /// Where it is.
    pub position: Point,
    /// The frontier that it is on its way to.
    pub target: Option<Cell>,
    /// Whether it has stopped.
    pub stopped: bool,
}

/// A planner of one robot over a surface of `TW`×`TH` tiles.
pub trait Surveyor<const TW: usize, const TH: usize> {
    /// What the robot knows.
    fn knowledge(&self) -> &Knowledge<TW, TH>;

    /// The same, to be told more.
    fn knowledge_mut(&mut self) -> &mut Knowledge<TW, TH>;

    /// Decides. Call it once per step.
    fn tick(&mut self) -> Action;

    /// What the robot tells the others about itself.
    fn status(&self) -> Status;

    /// Cells, tiles, candidates and samples looked at by the last
    /// [`tick`](Self::tick): what its time is proportional to.
    fn work(&self) -> u32;

    /// Begins a step: where the robot is, and the columns that it sees from there.
    fn observe(&mut self, at: Point, columns: &[Column]) {
        self.knowledge_mut().observe(at, columns);
    }

    /// Takes in what robot `id` told about itself.
    fn hear(&mut self, id: u8, status: Status) {
        self.knowledge_mut().hear(id, status);
    }

    /// Takes in a piece of another robot's map.
    fn merge(&mut self, patch: &Patch) {
        self.knowledge_mut().merge(patch);
    }

    /// Says how the last [`Action::Fly`] went.
    fn report(&mut self, motion: Motion) {
        self.knowledge_mut().report(motion);
    }
}
