//! A run in one row of a table.

use clap::ValueEnum;
use planner_core::Extent;
use serde::{Deserialize, Serialize};

use super::plan::{Place, Setup, Site};
use crate::planners::PlannerKind;
use crate::run::{Outcome, RobotOutcome};
use crate::scenario::{MediumKind, Preset};

/// A run and its metrics, in the column names of the tables.
///
/// Ticks are moves that anybody could have made, as in
/// [`Outcome::ticks_to_seen`]; `None` if it never came to that.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// See [`Site::family`].
    pub family: String,
    /// Name of the world.
    pub world: String,
    /// Columns of the world.
    pub width: u16,
    /// Rows of the world.
    pub height: u16,
    /// What decided.
    pub planner: PlannerKind,
    /// Number of robots.
    pub robots: u8,
    /// How they were placed.
    pub place: Place,
    /// Which placing, from 0.
    pub start: u32,
    /// What carried messages.
    pub medium: MediumKind,
    /// Ticks between two exchanges; 0: never.
    pub sync: u32,
    /// Share of messages lost, 0 to 1.
    pub loss: f64,
    /// Sensor range in cells.
    pub range: u8,
    /// How the world misled robots: the options that differ from none.
    pub trouble: String,
    /// The explorer's model of its sensors.
    pub preset: Preset,
    /// Seed of the plan.
    pub seed: u64,
    /// Whether every reachable cell was seen by somebody.
    pub complete: bool,
    /// Robots that said in the end that all that they can reach is known, while something
    /// was not.
    pub false_claims: u32,
    /// Share of the reachable cells that are obstacles on a robot's map, on average, 0 to 1.
    pub closed_share: f64,
    /// Obstacles that are free on a robot's map, on average.
    pub opened_cells: f64,
    /// Steps that ended at a person, a shut door, or an obstacle that a look may have hidden.
    pub bumps: u32,
    /// Ticks until 90 % of the reachable cells were seen.
    pub ticks_to_90: Option<u32>,
    /// Ticks until 99 % were seen.
    pub ticks_to_99: Option<u32>,
    /// Ticks until all were seen.
    pub ticks_to_seen: Option<u32>,
    /// Ticks until every robot had stopped.
    pub ticks_to_stopped: Option<u32>,
    /// Ticks that were run.
    pub ticks: u32,
    /// Cells that could be reached.
    pub reachable_cells: u32,
    /// Reachable cells that somebody saw.
    pub seen_cells: u32,
    /// Robots that had stopped at the end.
    pub stopped_robots: u32,
    /// Ticks of all robots until they stopped.
    pub robot_ticks: u64,
    /// Those of them in which the robot waited: it neither tried a step nor turned to look.
    pub waited_ticks: u64,
    /// Cells walked by a robot, on average.
    pub steps_mean: f64,
    /// Standard deviation of that among the robots.
    pub steps_sd: f64,
    /// Cells walked by the robot that walked most.
    pub steps_max: u32,
    /// Share of the seen cells that more than one robot saw itself.
    pub overlap: f64,
    /// Largest work of one planner in one tick, in its own unit.
    pub work_max: u32,
    /// Mean work of a planner in a tick.
    pub work_mean: f64,
    /// Bytes sent by all robots; the ideal medium counts none.
    pub bytes: u64,
    /// Sum of costs of an assignment, on average over assignments
    /// [Bautin2011, criterion 1]. Costs are steps; `None` if the planner does
    /// not assign.
    pub assignment_sum: Option<f64>,
    /// Largest cost of an assignment, on average [Bautin2011, criterion 2].
    pub assignment_max: Option<f64>,
}

/// What tells a run from the others in the same world.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Key {
    planner: PlannerKind,
    robots: u8,
    place: Place,
    start: u32,
    medium: MediumKind,
    sync: u32,
    loss: u64,
    range: u8,
    trouble: String,
    preset: Preset,
    seed: u64,
}

impl Key {
    /// The run of `setup`.
    pub fn new(setup: &Setup) -> Self {
        Self {
            planner: setup.planner,
            robots: setup.robots,
            place: setup.place,
            start: setup.start,
            medium: setup.medium,
            sync: setup.sync,
            loss: setup.loss.to_bits(),
            range: setup.range,
            trouble: setup.trouble.to_string(),
            preset: setup.preset,
            seed: setup.seed,
        }
    }

    /// The key of the run that is to be paired with this one.
    pub(super) fn with_planner(self, planner: PlannerKind) -> Self {
        Self { planner, ..self }
    }
}

/// What runs are compared by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
pub enum Metric {
    /// Ticks until 90 % of the reachable cells were seen.
    #[value(name = "90")]
    #[serde(rename = "90")]
    Seen90,
    /// Ticks until 99 % were seen.
    #[value(name = "99")]
    #[serde(rename = "99")]
    Seen99,
    /// Ticks until all were seen.
    #[value(name = "seen")]
    #[serde(rename = "seen")]
    #[default]
    Seen,
    /// Ticks until every robot had stopped.
    #[value(name = "stopped")]
    #[serde(rename = "stopped")]
    Stopped,
}

impl Metric {
    /// The name used on the command line and in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Seen90 => "90",
            Self::Seen99 => "99",
            Self::Seen => "seen",
            Self::Stopped => "stopped",
        }
    }

    /// What is counted, in words.
    pub fn title(self) -> &'static str {
        match self {
            Self::Seen90 => "ticks until 90 % is seen",
            Self::Seen99 => "ticks until 99 % is seen",
            Self::Seen => "ticks until all is seen",
            Self::Stopped => "ticks until all robots have stopped",
        }
    }
}

impl Row {
    /// The row of a run.
    pub fn new(site: &Site, setup: &Setup, outcome: &Outcome) -> Self {
        let Extent { width, height } = site.extent();
        let steps: Vec<f64> = outcome
            .robots
            .iter()
            .map(|robot| f64::from(robot.steps))
            .collect();
        let robots = steps.len() as f64;
        let steps_mean = steps.iter().sum::<f64>() / robots;
        let squares = steps.iter().map(|step| (step - steps_mean).powi(2));
        let work: u64 = outcome.robots.iter().map(|robot| robot.work).sum();
        let mean = |of: fn(&RobotOutcome) -> u32| {
            outcome
                .robots
                .iter()
                .map(|robot| f64::from(of(robot)))
                .sum::<f64>()
                / robots
        };
        let sum = |of: fn(&RobotOutcome) -> u32| -> u64 {
            let robots = outcome.robots.iter();
            robots.map(|robot| u64::from(of(robot))).sum()
        };
        let stopped = outcome.robots.iter().filter(|robot| robot.stop.is_some());
        Self {
            family: site.family(),
            world: site.name(),
            width,
            height,
            planner: setup.planner,
            robots: setup.robots,
            place: setup.place,
            start: setup.start,
            medium: setup.medium,
            sync: setup.sync,
            loss: setup.loss,
            range: setup.range,
            trouble: setup.trouble.to_string(),
            preset: setup.preset,
            seed: setup.seed,
            complete: outcome.is_complete(),
            false_claims: outcome.false_claims() as u32,
            closed_share: mean(|robot| robot.cells_closed)
                / f64::from(outcome.reachable_cells.max(1)),
            opened_cells: mean(|robot| robot.cells_opened),
            bumps: outcome.bumps,
            ticks_to_90: outcome.ticks_to_share(0.90),
            ticks_to_99: outcome.ticks_to_share(0.99),
            ticks_to_seen: outcome.ticks_to_seen,
            ticks_to_stopped: outcome.ticks_to_stopped,
            ticks: outcome.ticks,
            reachable_cells: outcome.reachable_cells,
            seen_cells: outcome.seen_cells,
            stopped_robots: stopped.count() as u32,
            robot_ticks: sum(|robot| robot.active_ticks),
            waited_ticks: sum(|robot| robot.waited_ticks),
            steps_mean,
            steps_sd: (squares.sum::<f64>() / robots).sqrt(),
            steps_max: outcome
                .robots
                .iter()
                .map(|robot| robot.steps)
                .max()
                .unwrap_or(0),
            overlap: outcome.overlap(),
            work_max: outcome.max_work_per_tick,
            work_mean: work as f64 / (robots * f64::from(outcome.ticks.max(1))),
            bytes: outcome
                .robots
                .iter()
                .map(|robot| u64::from(robot.sent.bytes))
                .sum(),
            assignment_sum: outcome.assignments.mean_sum(),
            assignment_max: outcome.assignments.mean_largest(),
        }
    }

    /// What tells this run from the others in its world.
    pub fn key(&self) -> Key {
        Key {
            planner: self.planner,
            robots: self.robots,
            place: self.place,
            start: self.start,
            medium: self.medium,
            sync: self.sync,
            loss: self.loss.to_bits(),
            range: self.range,
            trouble: self.trouble.clone(),
            preset: self.preset,
            seed: self.seed,
        }
    }

    /// A metric of a run that was complete.
    pub fn metric(&self, metric: Metric) -> Option<u32> {
        let ticks = match metric {
            Metric::Seen90 => self.ticks_to_90,
            Metric::Seen99 => self.ticks_to_99,
            Metric::Seen => self.ticks_to_seen,
            Metric::Stopped => self.ticks_to_stopped,
        };
        ticks.filter(|_| self.complete)
    }
}
