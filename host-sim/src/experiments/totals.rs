//! Running statistics whose sums are whole numbers: in whatever order worlds come in, and
//! however many shares they are added up in, the result is the same bit for bit.

use std::collections::HashMap;

use distrs::StudentsT;
use serde::{Deserialize, Serialize};

use super::row::{Key, Metric, Row};
use super::statistics::{Axes, Comparison, Conditions, Interval};
use crate::planners::PlannerKind;

/// Logarithms are counted in units of 2^-28. With at most 2^16 runs of a group in a world
/// and 2^24 worlds no sum leaves its 127 bits.
const UNIT: f64 = (1u64 << 28) as f64;

/// What the runs of worlds that have ended come to.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(from = "Vec<(Group, Sums)>", into = "Vec<(Group, Sums)>")]
pub struct Totals {
    groups: HashMap<Group, Sums>,
}

/// Which runs are added up.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
struct Group {
    conditions: Conditions,
    planner: PlannerKind,
    family: String,
    /// `None`: all.
    robots: Option<u8>,
}

/// What the runs of a group come to.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Sums {
    runs: u64,
    incomplete: u64,
    false_claims: u64,
    robot_ticks: u64,
    waited_ticks: u64,
    ticks: Logarithms,
    ratio: Logarithms,
}

/// Logarithms of samples that come in clusters, a world each. With x a sample, and n the
/// number and s the sum of samples in a cluster, over clusters with any:
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
struct Logarithms {
    /// Number of clusters.
    clusters: u64,
    /// Σ n
    count: u64,
    /// Σ s
    #[serde(with = "digits")]
    sum: i128,
    /// Σ x²
    #[serde(with = "digits")]
    squares: i128,
    /// Σ s²
    #[serde(with = "digits")]
    cluster_squares: i128,
    /// Σ n s
    #[serde(with = "digits")]
    cluster_products: i128,
    /// Σ n²
    #[serde(with = "digits")]
    cluster_counts: i128,
}

/// The runs of a group in one world.
#[derive(Default)]
struct InWorld {
    sums: Sums,
    ticks: Vec<i128>,
    ratios: Vec<i128>,
}

impl Totals {
    /// Adds all runs in one world; ratios are to `reference`.
    pub fn add_world(&mut self, rows: &[Row], reference: PlannerKind, metric: Metric) {
        let references: HashMap<Key, i128> = rows
            .iter()
            .filter(|row| row.planner == reference)
            .filter_map(|row| Some((row.key(), logarithm(row, metric)?)))
            .collect();
        let mut groups: HashMap<Group, InWorld> = HashMap::new();
        for row in rows {
            let ticks = logarithm(row, metric);
            let pair = references.get(&row.key().with_planner(reference));
            let ratio = ticks.zip(pair).map(|(ticks, reference)| ticks - reference);
            for robots in [Some(row.robots), None] {
                let group = Group {
                    conditions: Conditions::of(row),
                    planner: row.planner,
                    family: row.family.clone(),
                    robots,
                };
                let InWorld {
                    sums,
                    ticks: all_ticks,
                    ratios,
                } = groups.entry(group).or_default();
                sums.runs += 1;
                sums.incomplete += u64::from(!row.complete);
                sums.false_claims += u64::from(row.false_claims > 0);
                sums.robot_ticks += row.robot_ticks;
                sums.waited_ticks += row.waited_ticks;
                all_ticks.extend(ticks);
                ratios.extend(ratio);
            }
        }
        for (group, mut world) in groups {
            world.sums.ticks.add_cluster(&world.ticks);
            world.sums.ratio.add_cluster(&world.ratios);
            self.groups.entry(group).or_default().add(&world.sums);
        }
    }

    /// Adds what other worlds came to.
    pub fn add(&mut self, other: &Self) {
        for (group, sums) in &other.groups {
            self.groups.entry(group.clone()).or_default().add(sums);
        }
    }

    /// Every planner by itself and relative to the reference, in the order of the axes.
    pub fn comparisons(&self, axes: &Axes) -> Vec<Comparison> {
        let mut comparisons = Vec::new();
        for conditions in &axes.conditions {
            for &planner in &axes.planners {
                for robots in axes.robots.iter().copied().map(Some).chain([None]) {
                    let of = |family: &String| {
                        self.groups.get(&Group {
                            conditions: conditions.clone(),
                            planner,
                            family: family.clone(),
                            robots,
                        })
                    };
                    let mut all = Sums::default();
                    for sums in axes.families.iter().filter_map(of) {
                        all.add(sums);
                    }
                    let each = axes.families.iter().map(|family| {
                        let sums = of(family).cloned().unwrap_or_default();
                        (Some(family.clone()), sums)
                    });
                    for (family, sums) in [(None, all)].into_iter().chain(each) {
                        comparisons.push(Comparison {
                            planner,
                            conditions: conditions.clone(),
                            family,
                            robots,
                            runs: sums.runs,
                            incomplete: sums.incomplete,
                            false_claims: sums.false_claims,
                            waiting: sums.waiting(),
                            ticks: sums.ticks.interval(),
                            pairs: sums.ratio.count,
                            ratio: sums.ratio.interval(),
                        });
                    }
                }
            }
        }
        comparisons
    }
}

impl Sums {
    fn add(&mut self, other: &Self) {
        self.runs += other.runs;
        self.incomplete += other.incomplete;
        self.false_claims += other.false_claims;
        self.robot_ticks += other.robot_ticks;
        self.waited_ticks += other.waited_ticks;
        self.ticks.add(&other.ticks);
        self.ratio.add(&other.ratio);
    }

    fn waiting(&self) -> Option<f64> {
        (self.robot_ticks > 0).then(|| self.waited_ticks as f64 / self.robot_ticks as f64)
    }
}

impl Logarithms {
    fn add_cluster(&mut self, samples: &[i128]) {
        if samples.is_empty() {
            return;
        }
        let count = samples.len() as i128;
        let sum: i128 = samples.iter().sum();
        self.clusters += 1;
        self.count += samples.len() as u64;
        self.sum += sum;
        self.squares += samples.iter().map(|sample| sample * sample).sum::<i128>();
        self.cluster_squares += sum * sum;
        self.cluster_products += count * sum;
        self.cluster_counts += count * count;
    }

    fn add(&mut self, other: &Self) {
        self.clusters += other.clusters;
        self.count += other.count;
        self.sum += other.sum;
        self.squares += other.squares;
        self.cluster_squares += other.cluster_squares;
        self.cluster_products += other.cluster_products;
        self.cluster_counts += other.cluster_counts;
    }

    /// What [`geometric_mean`](super::geometric_mean) makes of the samples.
    fn interval(&self) -> Option<Interval> {
        let count = i128::from(self.count);
        if count == 0 {
            return None;
        }
        // Deviations from a whole number near the mean, exactly; what is left to the mean
        // itself is less than a unit.
        let near = self.sum.div_euclid(count);
        let rest = (self.sum - near * count) as f64 / count as f64;
        let sum_of_squares = |squares: i128, products: i128, counts: i128| {
            let about = squares - 2 * near * products + near * near * counts;
            let products = products - near * counts;
            about as f64 - 2.0 * rest * products as f64 + rest * rest * counts as f64
        };
        let (of, squares) = match self.clusters {
            1 => (count, sum_of_squares(self.squares, self.sum, count)),
            clusters => (
                clusters.into(),
                sum_of_squares(
                    self.cluster_squares,
                    self.cluster_products,
                    self.cluster_counts,
                ),
            ),
        };
        let of = of as f64;
        let half = match of > 1.0 {
            true => {
                let error = (squares.max(0.0) * of / (of - 1.0)).sqrt() / count as f64;
                StudentsT::ppf(0.975, of - 1.0) * error / UNIT
            }
            false => f64::INFINITY,
        };
        let mean = (near as f64 + rest) / UNIT;
        Some(Interval {
            mean: mean.exp(),
            low: (mean - half).exp(),
            high: (mean + half).exp(),
        })
    }
}

/// That of the ticks of a complete run, in units; of one tick at least, for what is seen at
/// once has no logarithm.
fn logarithm(row: &Row, metric: Metric) -> Option<i128> {
    let ticks = f64::from(row.metric(metric)?.max(1));
    Some((ticks.ln() * UNIT).round() as i128)
}

impl From<Vec<(Group, Sums)>> for Totals {
    fn from(groups: Vec<(Group, Sums)>) -> Self {
        Self {
            groups: groups.into_iter().collect(),
        }
    }
}

impl From<Totals> for Vec<(Group, Sums)> {
    fn from(totals: Totals) -> Self {
        totals.groups.into_iter().collect()
    }
}

/// Whole numbers as text: JSON's own hold 64 bits.
mod digits {
    use serde::{Deserialize, Deserializer, Serializer, de::Error};

    pub(super) fn serialize<S: Serializer>(number: &i128, to: S) -> Result<S::Ok, S::Error> {
        to.collect_str(number)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<i128, D::Error> {
        String::deserialize(from)?.parse().map_err(D::Error::custom)
    }
}
