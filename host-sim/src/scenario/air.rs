//! What carries messages, and what goes wrong on their way.

use std::fmt;
use std::str::FromStr;

use clap::ValueEnum;
use serde::{Deserialize, Serialize};

/// Names a medium, on the command line and in traces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MediumKind {
    /// Whole maps at once, as in the papers.
    #[default]
    Ideal,
    /// Frames of at most 55 bytes.
    Radio,
}

/// The name used on the command line, for example `radio`.
impl fmt::Display for MediumKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let value = self.to_possible_value().expect("no medium is hidden");
        f.write_str(value.get_name())
    }
}

/// What goes wrong in the air besides plain loss. None of it by default.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct AirFaults {
    /// Who can hear whom.
    pub reach: Reach,
    /// Times when the fleet is cut in two.
    pub partitions: Vec<Partition>,
    /// Share of received frames that come twice, 0 to 1. Only frames.
    pub duplication: f64,
    /// Each copy of a frame comes this many ticks late at most; what comes late is
    /// overtaken by what does not. Only frames.
    pub delay: u32,
    /// Share of received frames with wrong bits or cut short, 0 to 1. Only frames.
    pub corruption: f64,
    /// Somebody who writes frames of his own. Only frames.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub forger: Option<Forger>,
}

/// Who can hear whom.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Reach {
    /// Everybody, everybody.
    #[default]
    Everywhere,
    /// Robots that are at most this many cells apart, as the crow flies.
    Cells(u16),
    /// Robots with no obstacle between them.
    LineOfSight,
}

/// `all`, `sight` or a number of cells.
impl FromStr for Reach {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        match text {
            "all" => Ok(Self::Everywhere),
            "sight" => Ok(Self::LineOfSight),
            _ => text
                .parse()
                .map(Self::Cells)
                .map_err(|_| "expected all, sight or a number of cells, for example 12"),
        }
    }
}

impl fmt::Display for Reach {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Everywhere => f.write_str("all"),
            Self::LineOfSight => f.write_str("sight"),
            Self::Cells(cells) => write!(f, "{cells}"),
        }
    }
}

/// In the ticks `from..until` the robots below `border` and the others do not
/// hear each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Partition {
    /// First tick.
    pub from: u32,
    /// First tick in which they hear each other again.
    pub until: u32,
    /// Lowest id of the second part.
    pub border: u8,
}

/// `FROM-UNTIL:N`.
impl FromStr for Partition {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let read = || {
            let (ticks, border) = text.split_once(':')?;
            let (from, until) = ticks.split_once('-')?;
            Some(Self {
                from: from.parse().ok()?,
                until: until.parse().ok()?,
                border: border.parse().ok()?,
            })
        };
        read()
            .filter(|partition| partition.from < partition.until && partition.border > 0)
            .ok_or("expected FROM-UNTIL:N, for example 50-200:2: in ticks 50 to 199 robots 0 and 1 are cut off from the others")
    }
}

impl fmt::Display for Partition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}-{}:{}", self.from, self.until, self.border)
    }
}

/// What a forger does, and how much of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Forger {
    /// Frames that each robot hears in a tick, 1 to 1000. [`Crowd`](Forgery::Crowd) and
    /// [`Stolen`](Forgery::Stolen) have numbers of their own.
    pub frames: u16,
    /// What they say.
    pub kind: Forgery,
}

/// What forged frames say. All but `any` and `tiles` lie about robots only, never about
/// cells.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Forgery {
    /// Anything: drawn robots with drawn tiles.
    #[default]
    Any,
    /// Robots that are not there, drawn anew in every tick.
    Hints,
    /// Robots on the cell of the robot that hears of them.
    OwnCell,
    /// Robots on the free cells around it.
    Around,
    /// Robots where it goes.
    Goal,
    /// A robot where it goes, for three ticks, and far away for three.
    Jump,
    /// In every two-hundredth tick each robot is said to have stopped, by a frame with a
    /// number far ahead of its own.
    Stolen,
    /// Robots of all ids, on the cell of the first robot.
    Crowd,
}

impl Forgery {
    /// Those that lie about robots only.
    pub const HINTS: [Self; 7] = [
        Self::Hints,
        Self::OwnCell,
        Self::Around,
        Self::Goal,
        Self::Jump,
        Self::Stolen,
        Self::Crowd,
    ];
}

/// The name used on the command line, for example `own-cell`.
impl fmt::Display for Forgery {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let value = self.to_possible_value().expect("no kind is hidden");
        f.write_str(value.get_name())
    }
}

/// `N` or `N:KIND`.
impl FromStr for Forger {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (frames, kind) = text.split_once(':').unwrap_or((text, "any"));
        let frames = frames.parse().ok().filter(|n| (1..=1000).contains(n));
        let kind = Forgery::from_str(kind, false).ok();
        match (frames, kind) {
            (Some(frames), Some(kind)) => Ok(Self { frames, kind }),
            _ => {
                let kinds: Vec<String> = Forgery::value_variants()
                    .iter()
                    .map(Forgery::to_string)
                    .collect();
                Err(format!(
                    "expected N or N:KIND with N from 1 to 1000, for example 2:goal; kinds are {}",
                    kinds.join(", ")
                ))
            }
        }
    }
}

/// `N:KIND`.
impl fmt::Display for Forger {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.frames, self.kind)
    }
}
