//! Scenarios that cannot be run, and why.

use std::fmt;

use planner_core::sight::{MAX_LONG_RADIUS, MAX_RADIUS};
use planner_core::survey::SetupError;
use planner_core::{Cell, Extent, ExtentError};
use thiserror::Error;

use super::Preset;
use crate::limits::NoMetres;
use crate::planners::PlannerKind;
use crate::saves::SaveError;
use crate::sensor::ALL_AROUND;

/// A scenario that cannot be run, said so that the reader can mend it.
#[derive(Clone, Debug, PartialEq, Error)]
#[allow(missing_docs)] // each variant's message is its documentation
pub enum ScenarioError {
    #[error("--{option} {found}: expected {expected}")]
    Setting {
        option: &'static str,
        found: String,
        expected: String,
    },
    #[error("--{option}: there is no robot {robot}; robots are numbered 0 to {last}")]
    NoSuchRobot {
        option: &'static str,
        robot: u8,
        last: usize,
    },
    #[error("--{0} only works on frames: choose --medium radio, or leave it out")]
    NoFrames(&'static str),
    #[error("--{option} does not apply {world}; leave it out")]
    NotHere {
        option: &'static str,
        /// Where: `over a terrain of heights`.
        world: &'static str,
    },
    #[error(
        "planner {planner} never turns its sensor, and needs a field of view of {ALL_AROUND} \
         degrees, not {fov}; the explorer turns it"
    )]
    NeverTurns { planner: PlannerKind, fov: u16 },
    #[error(
        "--range {range}: planner {planner} takes in at most {MAX_RADIUS} cells around it; the \
         explorer takes in {MAX_LONG_RADIUS}"
    )]
    ShortSighted { planner: PlannerKind, range: u8 },
    #[error(
        "--preset {preset}: planner {planner} takes every sensor for truthful; the explorer does not"
    )]
    OnlyTruthful {
        planner: PlannerKind,
        preset: Preset,
    },
    #[error("--{option}: planner {planner} knows no way home; the explorer does")]
    NeverHome {
        option: &'static str,
        planner: PlannerKind,
    },
    #[error("--{option}: planner {planner} keeps out of nothing; the explorer does")]
    GoesAnywhere {
        option: &'static str,
        planner: PlannerKind,
    },
    #[error(
        "robot {robot} starts at {start}, in cells that robots are to keep out of, or touches \
         them there; start it elsewhere (--start X,Y)"
    )]
    StartKeptOut { robot: usize, start: Cell },
    #[error("{0}")]
    NoMetres(#[from] NoMetres),
    #[error("--{option}: planner {planner} cannot be saved; the explorer can")]
    NeverSaved {
        option: &'static str,
        planner: PlannerKind,
    },
    #[error("the save {0}")]
    Save(#[from] SaveError),
    #[error("robot {robot} starts at {start}, which is no free cell of the world")]
    Start { robot: usize, start: Cell },
    #[error("robots {first} and {second} both start at {start}, but no two may share a cell")]
    SharedStart {
        first: usize,
        second: usize,
        start: Cell,
    },
    #[error(
        "--clearance {clearance}: planner {planner} plans for robots that are no wider than a \
         cell; the explorer does not"
    )]
    NoBody { planner: PlannerKind, clearance: u8 },
    #[error(
        "robot {robot} has no room at its start {start} with --clearance {clearance}; start it \
         elsewhere (--start spread), or take a smaller clearance or smaller cells"
    )]
    NoRoomAtStart {
        robot: usize,
        start: Cell,
        clearance: u8,
    },
    #[error(
        "robots {first} and {second} touch where they start; bodies have to be {apart} cells \
         apart: start them elsewhere (--start spread)"
    )]
    TouchingStarts {
        first: usize,
        second: usize,
        apart: u8,
    },
    #[error(
        "--{0} is of bodies that move in metres: choose --motion diff-drive or omni, or leave it out"
    )]
    OnlyInMotion(&'static str),
    #[error(
        "--{0} counts cells and their steps, which bodies do not make with --motion; leave one of them out"
    )]
    NotInMotion(&'static str),
    #[error("--turn-rate: with --motion omni robots go to any side and never turn; leave it out")]
    NoTurning,
    #[error(
        "--cell: the map says that its cells are {metres} m wide; leave it out (--cell-size makes others)"
    )]
    CellOfMap { metres: f64 },
    #[error("--{option} {cell}: outside of the map of {extent} cells")]
    FaultOutside {
        option: &'static str,
        cell: Cell,
        extent: Extent,
    },
    #[error(
        "{robots} robots do not fit: they start from the north-west corner on, {apart} columns \
         apart, and the terrain has {extent} columns; {}", most_robots(*.most)
    )]
    NoRoom {
        robots: usize,
        /// Columns from one to the next.
        apart: u8,
        extent: Extent,
        /// How many do fit.
        most: usize,
    },
    #[error(
        "robot {robot} starts at height {height}, one cell over the least altitude and above the \
         ceiling of {ceiling}; expected --ceiling {needed} or more"
    )]
    StartTooHigh {
        robot: usize,
        height: f32,
        ceiling: f32,
        /// The least ceiling for all robots.
        needed: f32,
    },
    #[error(
        "{extent} columns and {levels} levels; expected 1 to {side} columns on a side and 1 to \
         {most} levels"
    )]
    Scene {
        extent: Extent,
        levels: u8,
        side: u16,
        most: u8,
    },
    #[error(
        "there is no room for a robot: {0} has to be free; take smaller voxels or a smaller --clearance"
    )]
    NoPose(BodyText),
    #[error(
        "--start {found}: {body} has to be known and free; the nearest such place is {nearest}"
    )]
    NoRoomAt {
        found: String,
        body: BodyText,
        nearest: String,
    },
    #[error(
        "nothing of the scene can be seen from where robots can fly; a survey needs an occupied \
         voxel in sight and in range"
    )]
    NothingToSee,
    #[error("{0}")]
    Setup(#[from] SetupError),
    #[error("{0}")]
    Extent(#[from] ExtentError),
}

/// The voxels that a robot of this clearance has to have free, in words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BodyText(pub u8);

impl fmt::Display for BodyText {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            0 => write!(f, "its voxel"),
            1 => write!(f, "its voxel with the six beside it"),
            clearance => write!(f, "each voxel within {clearance} of its own"),
        }
    }
}

impl ScenarioError {
    /// An option with a value that it cannot have.
    pub(crate) fn setting(
        option: &'static str,
        found: impl ToString,
        expected: impl Into<String>,
    ) -> Self {
        Self::Setting {
            option,
            found: found.to_string(),
            expected: expected.into(),
        }
    }
}

fn most_robots(most: usize) -> String {
    match most {
        0 => "expected 3×3 columns or more".into(),
        _ => format!("expected --robots {most} or fewer, or a larger terrain"),
    }
}
