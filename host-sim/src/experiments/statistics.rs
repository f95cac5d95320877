//! Pairs of runs, and how sure one can be of what they say.

use std::collections::{BTreeMap, HashMap};

use distrs::StudentsT;

use super::row::{Key, Metric, Row};
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
    pub runs: usize,
    /// Those of them in which something reachable was left unseen.
    pub incomplete: usize,
    /// Those of them in which a robot claimed falsely.
    pub false_claims: usize,
    /// The planner's own ticks, over its complete runs.
    pub ticks: Option<Interval>,
    /// Pairs in which both were complete.
    pub pairs: usize,
    /// The planner's ticks over the reference's, over the pairs.
    pub ratio: Option<Interval>,
}

/// Runs under different conditions are never thrown together.
#[derive(Clone, Debug, PartialEq)]
pub struct Conditions {
    /// Sensor range in cells.
    pub range: u8,
    /// Ticks between two exchanges.
    pub sync: u32,
    /// Share of messages lost.
    pub loss: f64,
    /// What the explorer took its sensors for.
    pub preset: Preset,
    /// How the world misled robots; empty: not.
    pub trouble: String,
}

impl Conditions {
    fn of(row: &Row) -> Self {
        Self {
            range: row.range,
            sync: row.sync,
            loss: row.loss,
            preset: row.preset,
            trouble: row.trouble.clone(),
        }
    }
}

/// Compares every planner in `rows` with `reference`: by conditions and
/// planner, for each number of robots and all, for all families and each one.
pub fn compare(rows: &[Row], reference: PlannerKind, metric: Metric) -> Vec<Comparison> {
    let references: HashMap<Key, f64> = rows
        .iter()
        .filter(|row| row.planner == reference)
        .filter_map(|row| Some((row.key(), ticks(row, metric)?)))
        .collect();
    let reference_of = |row: &Row| references.get(&row.key().with_planner(reference)).copied();
    let families = in_order(rows, |row| Some(row.family.clone()));
    let mut robots = in_order(rows, |row| Some(row.robots));
    robots.sort_unstable();

    let mut comparisons = Vec::new();
    for conditions in in_order(rows, Conditions::of) {
        for planner in in_order(rows, |row| row.planner) {
            for &robots in robots.iter().chain([&None]) {
                for family in [&None].into_iter().chain(&families) {
                    let group = rows.iter().filter(|row| {
                        row.planner == planner
                            && Conditions::of(row) == conditions
                            && robots.is_none_or(|robots| row.robots == robots)
                            && family.as_ref().is_none_or(|family| row.family == *family)
                    });
                    let own = group
                        .clone()
                        .filter_map(|row| sample(row, ticks(row, metric)));
                    let ratios: Vec<(&str, f64)> = group
                        .clone()
                        .filter_map(|row| {
                            sample(row, Some(ticks(row, metric)? / reference_of(row)?))
                        })
                        .collect();
                    comparisons.push(Comparison {
                        planner,
                        conditions: conditions.clone(),
                        family: family.clone(),
                        robots,
                        runs: group.clone().count(),
                        incomplete: group.clone().filter(|row| !row.complete).count(),
                        false_claims: group.clone().filter(|row| row.false_claims > 0).count(),
                        ticks: geometric_mean(own),
                        pairs: ratios.len(),
                        ratio: geometric_mean(ratios),
                    });
                }
            }
        }
    }
    comparisons
}

/// Ticks by the metric; at least 1, for what is seen at once has no logarithm.
fn ticks(row: &Row, metric: Metric) -> Option<f64> {
    row.metric(metric).map(|ticks| f64::from(ticks.max(1)))
}

fn sample(row: &Row, value: Option<f64>) -> Option<(&str, f64)> {
    Some((row.world.as_str(), value?))
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
