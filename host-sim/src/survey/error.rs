//! Surveys that cannot be flown, and why.

use planner_core::Extent;
use planner_core::ExtentError;
use planner_core::survey::SetupError;
use thiserror::Error;

/// A survey that cannot be flown, said so that the reader can mend it.
#[derive(Clone, Debug, PartialEq, Error)]
#[allow(missing_docs)] // each variant's message is its documentation
pub enum SurveyError {
    #[error("--{option} {found}: expected {expected}")]
    Setting {
        option: &'static str,
        found: String,
        expected: String,
    },
    #[error("--kill: there is no robot {robot}; robots are numbered 0 to {last}")]
    NoSuchRobot { robot: usize, last: usize },
    #[error(
        "{robots} robots do not fit: they start from column 2, row 2 on, two columns apart, and \
         the terrain has {extent} columns; {}", most_robots(*.most)
    )]
    NoRoom {
        robots: usize,
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
    #[error("there is no room for a robot: a robot and the six voxels beside it have to be free")]
    NoPose,
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

impl SurveyError {
    /// An option with a value that it cannot have.
    pub(super) fn setting(
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

/// A share that is one.
pub(super) fn check_share(option: &'static str, share: f64) -> Result<(), SurveyError> {
    match (0.0..=1.0).contains(&share) {
        true => Ok(()),
        false => Err(SurveyError::setting(option, share, "a share from 0 to 1")),
    }
}

/// A number of robots that have a number each.
pub(super) fn check_robots(robots: usize) -> Result<(), SurveyError> {
    match (1..=255).contains(&robots) {
        true => Ok(()),
        false => Err(SurveyError::setting("robots", robots, "1 to 255")),
    }
}
