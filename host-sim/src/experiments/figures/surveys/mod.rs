//! The figures of the paper on the project's own runs [Renzaglia2019 fig. 3, 4, 6], the
//! tables behind them, and towns of voxels.

mod by_robots;
mod final_times;
mod over_time;
mod town;
mod towns;
mod work;

use rayon::prelude::*;

use super::Drawn;
use crate::draw::chart::{Point, Series, Style};
use crate::experiments::{Interval, mean};
use crate::record::heights::Trace;
use crate::run::heights::run;
use crate::scenario::MediumKind;
use crate::scenario::ScenarioError;
use crate::scenario::heights::{Planner, Scenario};
use crate::terrain::Terrain;

/// The methods that are compared, in the order of the legends.
const METHODS: [Planner; 8] = [
    Planner::CoordinatedSurvey,
    Planner::CoordinatedCubic,
    Planner::Fcao,
    Planner::Greedy,
    Planner::GreedyUnique,
    Planner::ClosestFrontier,
    Planner::GreedyInOrder,
    Planner::ClosestUntilReached,
];

/// Columns along a side of the terrains.
const SIDE: u16 = 100;
/// Robots where their number is not varied.
const ROBOTS: usize = 8;

/// Names of the figures.
pub const FIGURES: [&str; 6] = [
    "fcao3",
    "fcao4",
    "fcao6",
    "fcao-robots",
    "fcao-work",
    "towns",
];

/// Makes that one of the [`FIGURES`] over the Gaussian terrains 0 to `terrains` - 1;
/// `None` if there is no such figure.
///
/// # Errors
/// None with the set-up used here.
pub fn figure(id: &str, terrains: u64) -> Result<Option<Drawn>, ScenarioError> {
    let fleets = || -> Result<Vec<Fleet>, ScenarioError> {
        METHODS
            .iter()
            .map(|&planner| Fleet::new(Setup::new(planner, ROBOTS), terrains))
            .collect()
    };
    Ok(Some(match id {
        "fcao3" => over_time::over_time(&fleets()?),
        "fcao4" => final_times::final_times(&fleets()?),
        "fcao6" => town::town()?,
        "fcao-robots" => by_robots::by_robots(terrains)?,
        "fcao-work" => work::work(terrains.min(10))?,
        "towns" => towns::towns(terrains.min(4))?,
        _ => return Ok(None),
    }))
}

/// What a fleet is, and on what terrains it flies.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Setup {
    planner: Planner,
    robots: usize,
    side: u16,
    medium: MediumKind,
    loss: f64,
}

impl Setup {
    fn new(planner: Planner, robots: usize) -> Self {
        Self {
            planner,
            robots,
            side: SIDE,
            medium: MediumKind::Ideal,
            loss: 0.0,
        }
    }
}

/// What is kept of a run.
struct Run {
    /// Share of columns seen after each number of steps, in percent.
    seen: Vec<f64>,
    /// Mean work of the decisions of each step.
    work: Vec<f64>,
    max_work: u32,
    /// Steps to 95, 99 and 100 %; none if never.
    ticks: [Option<u32>; 3],
}

impl Run {
    fn new(trace: &Trace) -> Self {
        let all = f64::from(trace.extent.cells());
        let by_tick = trace.records.chunk_by(|a, b| a.tick == b.tick);
        Self {
            seen: trace
                .seen
                .iter()
                .map(|&seen| 100.0 * f64::from(seen) / all)
                .collect(),
            work: by_tick
                .map(|step| {
                    let sum: f64 = step.iter().map(|record| f64::from(record.work)).sum();
                    sum / step.len() as f64
                })
                .collect(),
            max_work: trace.records.iter().map(|r| r.work).max().unwrap_or(0),
            ticks: [0.95, 0.99, 1.0].map(|share| trace.ticks_to(share)),
        }
    }

    fn mean_work(&self) -> f64 {
        self.work.iter().sum::<f64>() / self.work.len().max(1) as f64
    }
}

/// The runs of one set-up, a terrain each.
struct Fleet {
    setup: Setup,
    runs: Vec<Run>,
}

impl Fleet {
    fn new(setup: Setup, terrains: u64) -> Result<Self, ScenarioError> {
        let one = |seed| -> Result<Run, ScenarioError> {
            let mut scenario = Scenario::new(setup.planner, setup.robots, seed);
            scenario.conditions.medium = setup.medium;
            scenario.conditions.loss = setup.loss;
            let trace = run(&Terrain::gaussian(seed, setup.side), &scenario)?;
            Ok(Run::new(&trace))
        };
        let runs = (0..terrains)
            .into_par_iter()
            .map(one)
            .collect::<Result<_, _>>()?;
        Ok(Self { setup, runs })
    }

    /// The mean over the terrains of what `value` gives; runs without it are left out.
    fn mean(&self, value: impl Fn(&Run) -> Option<f64>) -> Option<Interval> {
        mean((0u32..).zip(self.runs.iter().filter_map(value)))
    }

    fn ticks(&self, share: usize) -> Option<Interval> {
        self.mean(|run| run.ticks[share].map(f64::from))
    }

    /// The legend: the planner, and how many runs did not end.
    fn name(&self) -> String {
        let left = self
            .runs
            .iter()
            .filter(|run| run.ticks[2].is_none())
            .count();
        match left {
            0 => self.setup.planner.to_string(),
            _ => format!("{} ({left} runs not complete)", self.setup.planner),
        }
    }

    /// Points over the steps until the last run was complete; a run that has ended
    /// stays as it was, or is left out.
    fn curve(&self, values: impl Fn(&Run) -> &Vec<f64>, stays: bool) -> Vec<Point> {
        let end = self.runs.iter().filter_map(|run| run.ticks[2]).max();
        let at = |tick: usize| {
            let value = |run: &Run| {
                let values = values(run);
                let last = values.last().filter(|_| stays);
                values.get(tick).or(last).copied()
            };
            Some(self.mean(value)?.at(tick as f64))
        };
        (0..=end.unwrap_or(0) as usize).filter_map(at).collect()
    }

    fn series(&self, style: Style, points: Vec<Point>) -> Series {
        Series {
            name: self.name(),
            color: colour(self.setup.planner),
            style,
            points,
        }
    }
}

/// A planner has the same colour in all figures.
fn colour(planner: Planner) -> usize {
    METHODS
        .iter()
        .position(|&method| method == planner)
        .unwrap_or(0)
}

/// Cells of a table: mean times to 95, 99 and 100 %, half of the 95 % confidence interval of
/// the last, and its ratios to greedy and greedy-unique with all news exchanged at once.
fn times(fleet: &Fleet, fleets: &[Fleet]) -> String {
    let [most, nearly, all] =
        [0, 1, 2].map(|share| fleet.ticks(share).map_or(f64::NAN, |it| it.mean));
    let half = fleet.ticks(2).map_or(f64::NAN, |it| it.high - it.mean);
    let ratio = |planner| {
        let reference = Setup::new(planner, fleet.setup.robots);
        let reference = fleets.iter().find(|fleet| fleet.setup == reference);
        let reference = reference.and_then(|fleet| fleet.ticks(2));
        all / reference.map_or(f64::NAN, |it| it.mean)
    };
    let [greedy, unique] = [Planner::Greedy, Planner::GreedyUnique].map(ratio);
    format!("{most:.1} | {nearly:.1} | {all:.1} ± {half:.1} | {greedy:.2} | {unique:.2}")
}
