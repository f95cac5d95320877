//! What a run is a pure function of.

use planner_core::survey::Limits;

use crate::medium::MediumKind;

/// Ten frames of 55 bytes in a step: with 30 % of them lost, eight robots take hardly longer.
pub const DEFAULT_BYTE_BUDGET: u16 = 550;

/// How the robots decide.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum, serde::Serialize, serde::Deserialize,
)]
#[serde(rename_all = "kebab-case")]
pub enum Planner {
    /// Pockets, a local choice on the map, coordinated frontiers: the best.
    CoordinatedSurvey,
    /// The same, its local choice by CAO's cubic.
    CoordinatedCubic,
    /// FCAO as published.
    Fcao,
    /// Every robot to the closest frontier.
    ClosestFrontier,
    /// A centre assigns groups of frontiers to robots, nearest pair first; robots left
    /// over start a second round.
    Greedy,
    /// The same without the second round, as published: no frontier has two robots.
    GreedyUnique,
}

impl std::fmt::Display for Planner {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let value = clap::ValueEnum::to_possible_value(self).expect("no value is skipped");
        f.write_str(value.get_name())
    }
}

/// A robot that dies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kill {
    /// Which.
    pub robot: usize,
    /// Before which step.
    pub step: u32,
}

impl std::str::FromStr for Kill {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parse = || {
            let (robot, step) = text.split_once('@')?;
            Some(Self {
                robot: robot.parse().ok()?,
                step: step.parse().ok()?,
            })
        };
        parse().ok_or_else(|| format!("expected ROBOT@STEP, for example 3@40, not {text:?}"))
    }
}

/// Everything about a run but the terrain.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// How the robots decide.
    pub planner: Planner,
    /// Number of robots, at most 255.
    pub robots: usize,
    /// The fleet's physics.
    pub limits: Limits,
    /// Seed of planners and faults.
    pub seed: u64,
    /// What carries what robots tell each other.
    pub medium: MediumKind,
    /// Bytes that a robot may send by radio in a step on average.
    pub byte_budget: u16,
    /// Share of the messages that are lost, each on its own.
    pub loss: f64,
    /// Share of a robot's steps that it sleeps through.
    pub skip: f64,
    /// Robots that die.
    pub kills: Vec<Kill>,
    /// Steps after which the run is given up.
    pub max_ticks: u32,
}

impl Scenario {
    /// The set-up of the comparisons: range 8, step 2, no faults, and robots that tell
    /// each other all news at once as in the paper.
    pub fn new(planner: Planner, robots: usize, seed: u64) -> Self {
        let limits = Limits {
            range: 8.0,
            step: 2.0,
            min_altitude: 2.0,
            ceiling: 40.0,
            separation: 1.0,
        };
        Self {
            planner,
            robots,
            limits,
            seed,
            medium: MediumKind::Ideal,
            byte_budget: DEFAULT_BYTE_BUDGET,
            loss: 0.0,
            skip: 0.0,
            kills: Vec::new(),
            max_ticks: 20_000,
        }
    }
}
