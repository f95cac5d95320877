//! What a robot is called, does and says: the plain data that planners of all kinds
//! exchange with their robot and with each other.

use core::fmt;

use crate::cell::{Cell, Direction};

/// Names a robot. Lower ids win ties.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RobotId(pub u8);

/// What the robot shall do now. Every [`Planner::tick`](crate::Planner::tick) returns one.
/// `S` is a step: a direction on a grid, a point over a surface, a voxel; `P` a place, as
/// in [`Stop`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Action<S = Direction, P = Cell> {
    /// Make this step; then [`Planner::report`](crate::Planner::report) how it went. On a
    /// grid it leads to the neighbouring cell, in the air straight to a place at most one
    /// step away.
    Move(S),
    /// Stay for this tick. [`Planner::waiting`](crate::Planner::waiting) says why, and
    /// where to look.
    Wait,
    /// Done, for this reason. Every later tick returns the same, until
    /// [`Planner::resume`](crate::Planner::resume).
    Stop(Stop<P>),
}

/// Why a robot stopped. "Done" and "gave up" never look alike. `P` is a place of the
/// world: a cell of a grid or of a surface, a voxel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Stop<P = Cell> {
    /// Everything that can be reached from here is known.
    Complete,
    /// Everything that can be reached from here is known; the map has `frontiers` more
    /// frontiers that no way leads to, and part of it was heard from others.
    Enclosed {
        /// Frontiers that no way leads to.
        frontiers: u32,
    },
    /// Gave up: the only ways to what is left stayed blocked.
    Blocked {
        /// Frontiers left.
        frontiers: u32,
        /// A place that could not be entered.
        at: P,
    },
    /// Gave up: back at the start with no frontier in view [Gauville2019 §3.2
    /// step 2b]. The published algorithm takes this for completeness; it is not.
    BackAtStart {
        /// Frontiers left on the robot's map.
        frontiers: u32,
    },
    /// Gave up: no frontier in view and no neighbour to follow a trace to
    /// [Gauville2019 §3.2 step 2c, §6.1].
    NoTrace {
        /// Frontiers left on the robot's map.
        frontiers: u32,
    },
    /// Everything that can be reached within the map is known, and the map's edge cuts
    /// the world off: the robot may be able to go on beyond it.
    AtEdge {
        /// Free cells on the edge of the map.
        cells: u32,
    },
    /// Everything that can be reached from here is known; `frontiers` more frontiers
    /// were seen past corners or through windows, and no way leads to them.
    OutOfReach {
        /// Frontiers that no way leads to.
        frontiers: u32,
    },
    /// Gave up: looks from beside what is left showed nothing of it.
    Unseen {
        /// Frontiers left.
        frontiers: u32,
        /// A place that no look showed.
        at: P,
    },
    /// Gave up: on the only ways to what is left other robots stood and did not move.
    Held {
        /// Frontiers left.
        frontiers: u32,
        /// A place where one stood.
        at: P,
    },
    /// Back where it started, as it was told or for its energy.
    Home {
        /// Frontiers left on its map.
        frontiers: u32,
    },
    /// At the place that it was sent to.
    Arrived {
        /// Frontiers left on its map.
        frontiers: u32,
        /// That place.
        at: P,
    },
    /// Gave up: over places that are known to be free no way leads to where it was to go.
    NoWay {
        /// Frontiers left on its map.
        frontiers: u32,
        /// Where it was to go.
        at: P,
    },
}

impl<P> Stop<P> {
    /// The reason where no frontier is left on a map that ends at so many free cells.
    pub const fn nothing_left(edge_cells: u32) -> Self {
        match edge_cells {
            0 => Self::Complete,
            cells => Self::AtEdge { cells },
        }
    }

    /// The reason without the numbers and places that it names.
    pub const fn reason(&self) -> Reason {
        match self {
            Self::Complete => Reason::Complete,
            Self::Enclosed { .. } => Reason::Enclosed,
            Self::Blocked { .. } => Reason::Blocked,
            Self::BackAtStart { .. } => Reason::BackAtStart,
            Self::NoTrace { .. } => Reason::NoTrace,
            Self::AtEdge { .. } => Reason::AtEdge,
            Self::OutOfReach { .. } => Reason::OutOfReach,
            Self::Unseen { .. } => Reason::Unseen,
            Self::Held { .. } => Reason::Held,
            Self::Home { .. } => Reason::Home,
            Self::Arrived { .. } => Reason::Arrived,
            Self::NoWay { .. } => Reason::NoWay,
        }
    }

    /// As [`Reason::is_complete`].
    pub const fn is_complete(&self) -> bool {
        self.reason().is_complete()
    }

    /// Frontiers left, or on the map's edge.
    pub const fn left(&self) -> u32 {
        match self {
            Self::Complete => 0,
            Self::AtEdge { cells } => *cells,
            Self::Enclosed { frontiers }
            | Self::Blocked { frontiers, .. }
            | Self::BackAtStart { frontiers }
            | Self::NoTrace { frontiers }
            | Self::OutOfReach { frontiers }
            | Self::Unseen { frontiers, .. }
            | Self::Held { frontiers, .. }
            | Self::Home { frontiers }
            | Self::Arrived { frontiers, .. }
            | Self::NoWay { frontiers, .. } => *frontiers,
        }
    }

    /// The place that the reason names.
    pub const fn place(&self) -> Option<&P> {
        match self {
            Self::Blocked { at, .. }
            | Self::Unseen { at, .. }
            | Self::Held { at, .. }
            | Self::Arrived { at, .. }
            | Self::NoWay { at, .. } => Some(at),
            Self::Complete
            | Self::Enclosed { .. }
            | Self::BackAtStart { .. }
            | Self::NoTrace { .. }
            | Self::AtEdge { .. }
            | Self::OutOfReach { .. }
            | Self::Home { .. } => None,
        }
    }
}

impl<P: fmt::Display> fmt::Display for Stop<P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Complete => write!(f, "complete"),
            Self::Enclosed { frontiers } => write!(
                f,
                "complete; no way leads to {frontiers} frontiers, and part of the map was heard"
            ),
            Self::Blocked { frontiers, at } => write!(
                f,
                "gave up: the way stayed blocked at {at}, {frontiers} frontiers left"
            ),
            Self::BackAtStart { frontiers } => write!(
                f,
                "back at the start with no frontier in view, {frontiers} frontiers on the map"
            ),
            Self::NoTrace { frontiers } => write!(
                f,
                "no frontier in view and no trace to follow, {frontiers} frontiers on the map"
            ),
            Self::AtEdge { cells } => write!(
                f,
                "complete within the map, which ends at {cells} free cells: the world may go on"
            ),
            Self::OutOfReach { frontiers } => {
                write!(
                    f,
                    "complete; no way leads to {frontiers} frontiers in sight"
                )
            }
            Self::Unseen { frontiers, at } => write!(
                f,
                "gave up: no look shows what is at {at}, {frontiers} frontiers left"
            ),
            Self::Held { frontiers, at } => write!(
                f,
                "gave up: a robot stayed in the way at {at}, {frontiers} frontiers left"
            ),
            Self::Home { frontiers } => write!(f, "home, {frontiers} frontiers left"),
            Self::Arrived { frontiers, at } => {
                write!(f, "arrived at {at}, {frontiers} frontiers left")
            }
            Self::NoWay { frontiers, at } => write!(
                f,
                "gave up: no known way leads to {at}, {frontiers} frontiers left"
            ),
        }
    }
}

/// Declares [`Reason`]: each with its number, its name, and whether it is complete.
macro_rules! reasons {
    ($($reason:ident = $code:literal, $name:literal, $is_complete:literal;)*) => {
        /// A [`Stop`] without the numbers and places that it names.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[cfg_attr(feature = "defmt", derive(defmt::Format))]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        #[repr(u8)]
        pub enum Reason {
            $(
                #[doc = concat!("[`Stop::", stringify!($reason), "`]")]
                $reason = $code,
            )*
        }

        impl Reason {
            /// All of them, by their numbers.
            pub const ALL: [Self; [$($code),*].len()] = [$(Self::$reason),*];

            /// The name in summaries, as one word.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$reason => $name,)*
                }
            }

            /// Whether everything that the robot could reach within its map is known to it.
            pub const fn is_complete(self) -> bool {
                match self {
                    $(Self::$reason => $is_complete,)*
                }
            }
        }
    };
}

reasons! {
    Complete = 0, "complete", true;
    Enclosed = 1, "enclosed", true;
    Blocked = 2, "blocked", false;
    BackAtStart = 3, "back-at-start", false;
    NoTrace = 4, "no-trace", false;
    AtEdge = 5, "at-edge", true;
    OutOfReach = 6, "out-of-reach", true;
    Unseen = 7, "unseen", false;
    Held = 8, "held", false;
    Home = 9, "home", false;
    Arrived = 10, "arrived", false;
    NoWay = 11, "no-way", false;
}

impl Reason {
    /// The reason's number in traces and, plus one, in C. Numbers do not change; new
    /// reasons get new ones.
    pub const fn code(self) -> u8 {
        self as u8
    }

    /// The reason with this number.
    pub fn from_code(code: u8) -> Option<Self> {
        Self::ALL.get(usize::from(code)).copied()
    }
}

/// Why a robot waits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Wait {
    /// It has seen nothing yet.
    Sight,
    /// Its pose lies off the grid, or on a cell that it
    /// [keeps out of](crate::Errands::keep_out): nothing is decided until one lies elsewhere.
    Pose,
    /// It searches the map.
    Search,
    /// What is left lies behind cells that refused a step. They are tried again later.
    Closed,
    /// The last look saw the next cell of its way blocked, which the map calls free: it
    /// looks again, a few times, and takes what stays for a refusal. (Where its sensor errs
    /// by places and the place before showed the cell free, it tries the step.)
    Obstructed,
    /// Nothing seems to be left, but its last look showed a wall of its map free, near by:
    /// it looks again, a few times, before it says so.
    Doubt,
    /// Nothing is left. It will look again at places that were free and are walls now.
    Patrol,
    /// It asks for a look in this direction: turn the sensor there, then observe. A
    /// robot that sees all around need not turn.
    Look(Direction),
}

/// How the step of the last [`Action::Move`] went.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Motion {
    /// The robot is where it was sent.
    Moved,
    /// Something stood in the way; the robot is where it was.
    Blocked,
    /// Another robot stands there and goes first; the robot is where it was, and
    /// its plan holds.
    Held,
}

/// What a robot says about itself, and remembers of the others: hints, never
/// needed for completeness. `P` is where a robot can be, `G` what it can be going to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Status<P = Cell, G = P> {
    /// Where it is.
    pub position: P,
    /// Where it is going.
    pub goal: Option<G>,
    /// What it has come to.
    pub activity: Activity,
}

impl<P, G> Status<P, G> {
    /// Whether the robot has stopped for good.
    pub const fn has_stopped(&self) -> bool {
        matches!(self.activity, Activity::Stopped)
    }
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
    /// Stopped for good, or on its way to where it will stop: it explores no more.
    Stopped,
}

impl Activity {
    /// That of a robot that knows no second chance.
    pub const fn stopped_if(has_stopped: bool) -> Self {
        if has_stopped {
            Self::Stopped
        } else {
            Self::Exploring
        }
    }
}
