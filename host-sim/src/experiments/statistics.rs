//! Pairs of runs, and how sure one can be of what they say.

use std::collections::BTreeMap;
use std::hash::{Hash, Hasher};

use distrs::StudentsT;
use serde::{Deserialize, Serialize};

use super::plan::Setup;
use super::row::{Metric, Row};
use super::totals::Totals;
use crate::draw::chart::Point;
use crate::planners::PlannerKind;
use crate::scenario::Preset;

/// A mean and its 95 % confidence interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The mean.
    pub mean: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end; infinite if there is too little to tell.
    pub high: f64,
}

impl Interval {
    /// The interval in a chart, above `x`.
    pub fn at(self, x: f64) -> Point {
        let Self { mean, low, high } = self;
        Point {
            x,
            y: mean,
            low,
            high,
        }
    }
}

/// The mean of samples, each with what it stems from; `None` of none.
///
/// Samples of one origin (runs in one world) resemble each other: the interval
/// takes origins, not samples, for independent, unless all are of one origin.
/// It is that of Student's t, with the variance of a mean over clusters
/// [Cochran1977 §9A].
pub fn mean<O: Copy + Ord>(samples: impl IntoIterator<Item = (O, f64)>) -> Option<Interval> {
    let samples: Vec<(O, f64)> = samples.into_iter().collect();
    let count = samples.len() as f64;
    let mean = samples.iter().map(|(_, value)| value).sum::<f64>() / count;
    let mut origins = BTreeMap::new();
    for (origin, value) in &samples {
        *origins.entry(*origin).or_insert(0.0) += value - mean;
    }
    let deviations: Vec<f64> = match origins.len() {
        0 => return None,
        1 => samples.iter().map(|(_, value)| value - mean).collect(),
        _ => origins.into_values().collect(),
    };
    let clusters = deviations.len() as f64;
    let half = if deviations.len() > 1 {
        let squares: f64 = deviations.iter().map(|deviation| deviation.powi(2)).sum();
        let error = (squares * clusters / (clusters - 1.0)).sqrt() / count;
        StudentsT::ppf(0.975, clusters - 1.0) * error
    } else {
        f64::INFINITY
    };
    Some(Interval {
        mean,
        low: mean - half,
        high: mean + half,
    })
}

/// The geometric mean of positive samples: the [`mean`] of their logarithms.
pub fn geometric_mean<O: Copy + Ord>(
    samples: impl IntoIterator<Item = (O, f64)>,
) -> Option<Interval> {
    let logarithms = samples
        .into_iter()
        .map(|(origin, sample)| (origin, sample.ln()));
    mean(logarithms).map(|Interval { mean, low, high }| Interval {
        mean: mean.exp(),
        low: low.exp(),
        high: high.exp(),
    })
}

/// What a planner needs, relative to a reference, in some runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Who is compared.
    pub planner: PlannerKind,
    /// What all these runs have in common.
    pub conditions: Conditions,
    /// The family of worlds; `None`: all.
    pub family: Option<String>,
    /// The number of robots; `None`: all.
    pub robots: Option<u8>,
    /// Runs of the planner.
    pub runs: u64,
    /// Those of them in which something reachable was left unseen.
    pub incomplete: u64,
    /// Those of them in which a robot claimed falsely.
    pub false_claims: u64,
    /// Share of the ticks of all robots until they stopped in which the robot waited.
    pub waiting: Option<f64>,
    /// The planner's own ticks, over its complete runs.
    pub ticks: Option<Interval>,
    /// Pairs in which both were complete.
    pub pairs: u64,
    /// The planner's ticks over the reference's, over the pairs.
    pub ratio: Option<Interval>,
}

/// Runs under different conditions are never thrown together.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Conditions {
    /// Sensor range in cells.
    pub range: u8,
    /// Ticks between two exchanges.
    pub sync: u32,
    /// Share of messages lost.
    pub loss: f64,
    /// The explorer's model of its sensors.
    pub preset: Preset,
    /// How the world misled robots; empty: not.
    pub trouble: String,
}

/// A share is a number.
impl Eq for Conditions {}

impl Hash for Conditions {
    fn hash<H: Hasher>(&self, state: &mut H) {
        let Self {
            range,
            sync,
            loss,
            preset,
            trouble,
        } = self;
        (range, sync, loss.to_bits(), preset, trouble).hash(state);
    }
}

impl Conditions {
    pub(super) fn of_setup(setup: &Setup) -> Self {
        Self {
            range: setup.range,
            sync: setup.sync,
            loss: setup.loss,
            preset: setup.preset,
            trouble: setup.trouble.to_string(),
        }
    }

    pub(super) fn of(row: &Row) -> Self {
        Self {
            range: row.range,
            sync: row.sync,
            loss: row.loss,
            preset: row.preset,
            trouble: row.trouble.clone(),
        }
    }
}

/// What tables have a line or a column for, in their order.
#[derive(Clone, Debug, PartialEq)]
pub struct Axes {
    pub(super) conditions: Vec<Conditions>,
    pub(super) planners: Vec<PlannerKind>,
    pub(super) families: Vec<String>,
    /// In ascending order.
    pub(super) robots: Vec<u8>,
}

impl Axes {
    /// What there is among the rows.
    pub fn of_rows(rows: &[Row]) -> Self {
        Self {
            conditions: in_order(rows, Conditions::of),
            planners: in_order(rows, |row| row.planner),
            families: in_order(rows, |row| row.family.clone()),
            robots: in_order(rows, |row| row.robots),
        }
        .sorted()
    }

    pub(super) fn sorted(mut self) -> Self {
        self.robots.sort_unstable();
        self
    }
}

/// Compares every planner in `rows` with `reference`: by conditions and
/// planner, for each number of robots and all, for all families and each one.
pub fn compare(rows: &[Row], reference: PlannerKind, metric: Metric) -> Vec<Comparison> {
    let mut worlds: BTreeMap<&str, Vec<Row>> = BTreeMap::new();
    for row in rows {
        worlds.entry(&row.world).or_default().push(row.clone());
    }
    let mut totals = Totals::default();
    for rows in worlds.values() {
        totals.add_world(rows, reference, metric);
    }
    totals.comparisons(&Axes::of_rows(rows))
}

/// The different values, in the order in which they first come.
pub(super) fn in_order<R, T: PartialEq>(rows: &[R], value: impl Fn(&R) -> T) -> Vec<T> {
    let mut values = Vec::new();
    for value in rows.iter().map(value) {
        if !values.contains(&value) {
            values.push(value);
        }
    }
    values
}
