//! A world that misleads: looks that err, poses that slip, people, doors; and its options.

use std::fmt;

use clap::{Args, ValueEnum};
use planner_core::explorer::SensorModel;
use serde::{Deserialize, Serialize};

use super::{ScenarioError, check_share, parse_share};

/// The most looks in a tick.
const MOST_LOOKS: u8 = 16;

/// What a world does to robots that trust their looks. None of it by default. Everything
/// follows from the seed, the tick, the robot and the cell: a run that is followed by its
/// trace shows the same again.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Trouble {
    /// Probability that a look shows a free cell as blocked, for each cell in view, 0 to 1.
    pub false_walls: f64,
    /// Probability that a look shows a blocked cell as free, for each cell in view, 0 to 1.
    pub false_frees: f64,
    /// When looks err about the same cell again.
    pub error_kind: ErrorKind,
    /// Probability that a look is laid one cell off, the robot's own place with it, 0 to 1.
    pub misplaced: f64,
    /// Ticks after which the pose of each robot slips by one more cell, and stays off; 0:
    /// never.
    pub drift: u32,
    /// People who walk about at random, a step a tick at most. They are seen as blocked, hide what is behind them, and
    /// nobody can enter their cells.
    pub people: u16,
    /// Doors that open and close in turn, in passages one cell wide; fewer where the
    /// world has fewer passages. A shut door is seen as blocked.
    pub doors: u16,
    /// Whether robots see each other as blocked cells.
    pub see_robots: bool,
    /// Looks in a tick, 1 to 16: a sensor that is faster than the robot.
    pub looks: u8,
}

impl Default for Trouble {
    fn default() -> Self {
        Self {
            false_walls: 0.0,
            false_frees: 0.0,
            error_kind: ErrorKind::Transient,
            misplaced: 0.0,
            drift: 0,
            people: 0,
            doors: 0,
            see_robots: false,
            looks: 1,
        }
    }
}

/// Which looks err about a cell together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ErrorKind {
    /// None: each look errs for itself.
    #[default]
    Transient,
    /// All from the same cell: who looks from there again sees the same error.
    Viewpoint,
    /// None; only cells farther away than half of the sensor's range are mistaken.
    Far,
}

/// The name used on the command line, for example `viewpoint`.
impl fmt::Display for ErrorKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let value = self.to_possible_value().expect("no kind is hidden");
        f.write_str(value.get_name())
    }
}

/// What a robot takes its sensor for: names a [`SensorModel`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Preset {
    /// Always right.
    #[default]
    Truthful,
    /// Errors that come and go, three looks or more a step.
    Lidar,
    /// Errors that depend on the place, one look a step.
    Rangers,
}

impl Preset {
    /// The model of this name.
    pub fn model(self) -> SensorModel {
        match self {
            Self::Truthful => SensorModel::truthful(),
            Self::Lidar => SensorModel::lidar(),
            Self::Rangers => SensorModel::rangers(),
        }
    }
}

/// The name used on the command line, for example `rangers`.
impl fmt::Display for Preset {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let value = self.to_possible_value().expect("no preset is hidden");
        f.write_str(value.get_name())
    }
}

impl Trouble {
    /// Whether the world does not mislead, and robots look once a tick.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }

    /// Whether looks may be wrong, or laid where they do not belong.
    pub(super) fn has_errors(&self) -> bool {
        self.can_open_walls() || self.false_walls > 0.0
    }

    /// Whether a look may take what is free for occupied, or the other way round.
    pub(crate) fn mistakes_places(&self) -> bool {
        self.false_walls > 0.0 || self.false_frees > 0.0
    }

    /// Whether a look may tell a robot that it can go where it cannot.
    pub(crate) fn can_open_walls(&self) -> bool {
        self.false_frees > 0.0 || self.misplaced > 0.0 || self.drift > 0
    }

    pub(super) fn check(&self) -> Result<(), ScenarioError> {
        check_share("false-walls", self.false_walls)?;
        check_share("false-frees", self.false_frees)?;
        check_share("misplaced", self.misplaced)?;
        match (1..=MOST_LOOKS).contains(&self.looks) {
            true => Ok(()),
            false => {
                let expected = format!("1 to {MOST_LOOKS} looks in a tick");
                Err(ScenarioError::setting("looks", self.looks, expected))
            }
        }
    }

    /// What differs from `usual`, as names and values of options.
    pub fn settings(&self, usual: &Self) -> Vec<(&'static str, String)> {
        let Self {
            false_walls,
            false_frees,
            error_kind,
            misplaced,
            drift,
            people,
            doors,
            see_robots,
            looks,
        } = self;
        let all: [(_, bool, &dyn ToString); 9] = [
            (
                "false-walls",
                *false_walls != usual.false_walls,
                false_walls,
            ),
            (
                "false-frees",
                *false_frees != usual.false_frees,
                false_frees,
            ),
            ("error-kind", *error_kind != usual.error_kind, error_kind),
            ("misplaced", *misplaced != usual.misplaced, misplaced),
            ("drift", *drift != usual.drift, drift),
            ("people", *people != usual.people, people),
            ("doors", *doors != usual.doors, doors),
            ("see-robots", *see_robots != usual.see_robots, &""),
            ("looks", *looks != usual.looks, looks),
        ];
        let differ = all.into_iter().filter(|(_, differs, _)| *differs);
        differ
            .map(|(name, _, value)| (name, value.to_string()))
            .collect()
    }
}

/// What differs from no trouble, as options without their dashes: `false-walls 0.01,
/// people 2`. Empty without trouble.
impl fmt::Display for Trouble {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let settings = self.settings(&Self::default());
        let word = |(name, value): &(&str, String)| match value.as_str() {
            "" => (*name).to_owned(),
            value => format!("{name} {value}"),
        };
        let words: Vec<String> = settings.iter().map(word).collect();
        f.write_str(&words.join(", "))
    }
}

/// The options that set [`Trouble`]. What is not given stays as it is.
#[derive(Args, Clone, Default)]
#[command(next_help_heading = "Errors of sensors, people and doors")]
pub struct TroubleArgs {
    /// Probability that a look shows a free cell as blocked, for each cell in view, 0 to 1.
    #[arg(long, value_name = "P", value_parser = parse_share)]
    false_walls: Option<f64>,
    /// Probability that a look shows a blocked cell as free, for each cell in view, 0 to 1.
    #[arg(long, value_name = "P", value_parser = parse_share)]
    false_frees: Option<f64>,
    /// Which looks err together: transient (none), viewpoint (all from the same cell), or
    /// far (none, and only about cells beyond half of the range). Default: transient.
    #[arg(long, value_name = "NAME")]
    error_kind: Option<ErrorKind>,
    /// Probability that a look is laid one cell off, the robot's place with it, 0 to 1.
    #[arg(long, value_name = "P", value_parser = parse_share)]
    misplaced: Option<f64>,
    /// The pose of each robot slips by one more cell each TICKS ticks, and stays off.
    #[arg(long, value_name = "TICKS")]
    drift: Option<u32>,
    /// People who walk about: seen as blocked, and in the way.
    #[arg(long, value_name = "N")]
    people: Option<u16>,
    /// Passages one cell wide that open and close in turn.
    #[arg(long, value_name = "N")]
    doors: Option<u16>,
    /// Robots see each other as blocked cells.
    #[arg(long)]
    see_robots: bool,
    /// Looks in a tick, 1 to 16, each with errors of its own. Default: 1.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=i64::from(MOST_LOOKS)))]
    looks: Option<u8>,
}

impl TroubleArgs {
    /// `trouble` with what is given.
    pub fn over(self, trouble: Trouble) -> Trouble {
        Trouble {
            false_walls: self.false_walls.unwrap_or(trouble.false_walls),
            false_frees: self.false_frees.unwrap_or(trouble.false_frees),
            error_kind: self.error_kind.unwrap_or(trouble.error_kind),
            misplaced: self.misplaced.unwrap_or(trouble.misplaced),
            drift: self.drift.unwrap_or(trouble.drift),
            people: self.people.unwrap_or(trouble.people),
            doors: self.doors.unwrap_or(trouble.doors),
            see_robots: self.see_robots || trouble.see_robots,
            looks: self.looks.unwrap_or(trouble.looks),
        }
    }
}
