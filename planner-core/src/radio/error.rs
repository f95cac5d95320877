//! Why a frame is not taken.

use core::fmt;

use super::check::GridId;
use crate::robot::RobotId;

/// The format that this code writes, and the only one that it reads.
pub(super) const VERSION: u8 = 2;

/// A field of a frame that holds what it cannot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Field {
    /// The state byte.
    State,
    /// The position lies outside of the grid.
    Position,
    /// The goal lies outside of the grid, or is there and should not be.
    Goal,
    /// A tile lies outside of the grid, or knows of cells that do.
    Tile,
}

/// Why a frame was not taken. Nothing has changed then.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum FrameError {
    /// No frame has this length: cut short, or followed by something else.
    Length(usize),
    /// Written in another version of the format.
    Version(u8),
    /// A kind of frame that this planner does not read.
    Kind(u8),
    /// The check bytes do not match: corrupted, or not signed with the key.
    Check,
    /// The sender's map is of another place, resolution or size.
    OtherGrid(GridId),
    /// The robot's own frame, one of its last: an echo.
    Own,
    /// Another robot's frame under this robot's own id: each must have its own.
    SameId(RobotId),
    /// A field holds what it cannot.
    Field(Field),
}

impl fmt::Display for FrameError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Length(bytes) => write!(f, "no frame is {bytes} bytes long"),
            Self::Version(version) => write!(
                f,
                "the frame is of version {version}, this planner reads version {VERSION}"
            ),
            Self::Kind(kind) => write!(f, "this planner does not read frames of kind {kind}"),
            Self::Check => write!(f, "the frame's check bytes do not match"),
            Self::OtherGrid(grid) => write!(
                f,
                "the frame is about grid {:04x}: check origin, resolution and size on both robots",
                grid.0
            ),
            Self::Own => write!(f, "the frame is the robot's own"),
            Self::SameId(RobotId(id)) => write!(
                f,
                "another robot has the id {id} too: give each robot of the fleet its own id"
            ),
            Self::Field(field) => write!(f, "the frame's {field:?} field is out of range"),
        }
    }
}

impl core::error::Error for FrameError {}
