//! From the runs of a figure to its chart.

use std::collections::BTreeMap;
use std::sync::Mutex;

use super::list::{Figure, Layout};
use crate::draw::chart::{Axis, Chart, Panel, Point, Series, Style};
use crate::experiments::statistics::{geometric_mean, mean};
use crate::experiments::{ExecuteError, Metric, Order, Row, Shard, execute};
use crate::planners::PlannerKind;

/// Points of a coverage curve.
const CURVE: usize = 150;

/// A figure with the outcome of its runs.
#[derive(Clone, Debug)]
pub struct Measured {
    /// What was asked.
    pub figure: Figure,
    /// One row a run, in the order of the plan.
    pub rows: Vec<Row>,
    /// Cells seen in each run, tick by tick; only for coverage curves.
    coverage: Vec<Vec<u32>>,
}

/// Does the runs of a figure; `done` is called after each one.
///
/// # Errors
/// Those of [`execute`].
pub fn measure(figure: Figure, done: &(dyn Fn() + Sync)) -> Result<Measured, ExecuteError> {
    let order = Order::of(&figure.plan);
    let runs = Mutex::new(BTreeMap::new());
    execute(&figure.plan, Shard::ALL, &|_, _| false, &|row, outcome| {
        let coverage = match figure.layout {
            Layout::Coverage => outcome.coverage,
            _ => Vec::new(),
        };
        let mut runs = runs.lock().expect("nobody panics while adding a run");
        runs.insert(order.place(&row), (row, coverage));
        done();
        Ok(())
    })?;
    let runs = runs.into_inner().expect("all threads have ended");
    let (rows, coverage) = runs.into_values().unzip();
    Ok(Measured {
        figure,
        rows,
        coverage,
    })
}

impl Measured {
    /// The chart.
    pub fn chart(&self) -> Chart {
        let plan = &self.figure.plan;
        let maps: Vec<String> = plan.sites.iter().map(|site| site.name()).collect();
        let panel =
            |map: &String, x, y: &str, style, points: &dyn Fn(PlannerKind) -> Vec<Point>| Panel {
                title: map.clone(),
                x,
                y: y.into(),
                series: self.series(style, points),
            };
        let duration = "ticks until every cell is seen";
        let panels = match self.figure.layout {
            Layout::Maps => {
                let x = Axis::Places("map".into(), maps.clone());
                let points = |planner| self.points(planner, &maps, |row, map| row.world == *map);
                vec![panel(&String::new(), x, duration, Style::Bars, &points)]
            }
            Layout::Robots => maps
                .iter()
                .map(|map| {
                    let x = places("robots", &plan.robots);
                    let points = |planner| {
                        self.points(planner, &plan.robots, |row, robots| {
                            row.world == *map && row.robots == *robots
                        })
                    };
                    panel(map, x, duration, Style::Dots, &points)
                })
                .collect(),
            Layout::Syncs => maps
                .iter()
                .map(|map| {
                    let x = places("ticks between exchanges of maps", &plan.syncs);
                    let points = |planner| {
                        self.points(planner, &plan.syncs, |row, sync| {
                            row.world == *map && row.sync == *sync
                        })
                    };
                    panel(map, x, duration, Style::Dots, &points)
                })
                .collect(),
            Layout::Coverage => maps
                .iter()
                .map(|map| {
                    let x = Axis::Numbers("time (ticks)".into());
                    let end = self.longest(map);
                    let points = |planner| self.curve(planner, map, end);
                    panel(map, x, "reachable cells seen (%)", Style::Curve, &points)
                })
                .collect(),
        };
        Chart {
            title: self.figure.title.clone(),
            panels,
        }
    }

    fn series(&self, style: Style, points: &dyn Fn(PlannerKind) -> Vec<Point>) -> Vec<Series> {
        let planners = self.figure.plan.planners.iter();
        let series = planners.map(|&planner| Series {
            name: self.legend(planner),
            color: color(planner),
            style,
            points: points(planner),
        });
        series.collect()
    }

    /// The planner's name, and the share of its runs that were not complete.
    fn legend(&self, planner: PlannerKind) -> String {
        let runs = self.rows.iter().filter(|row| row.planner == planner);
        let left = runs.clone().filter(|row| !row.complete).count();
        match left {
            0 => planner.to_string(),
            _ => {
                let share = 100.0 * left as f64 / runs.count() as f64;
                format!("{planner} ({share:.0} % of runs not complete)")
            }
        }
    }

    /// The mean duration for each of `places`, over the runs that belong there.
    fn points<T>(
        &self,
        planner: PlannerKind,
        places: &[T],
        belongs: impl Fn(&Row, &T) -> bool,
    ) -> Vec<Point> {
        let point = |(number, place): (usize, &T)| {
            let rows = self.rows.iter().filter(|row| row.planner == planner);
            let samples = rows.filter(|row| belongs(row, place)).filter_map(|row| {
                Some((row.world.as_str(), row.metric(Metric::Seen)?.max(1).into()))
            });
            geometric_mean(samples).map(|interval| interval.at(number as f64))
        };
        places.iter().enumerate().filter_map(point).collect()
    }

    /// The mean share of cells seen, tick by tick until `end`.
    fn curve(&self, planner: PlannerKind, map: &str, end: usize) -> Vec<Point> {
        let runs: Vec<(&Row, &Vec<u32>)> = self
            .rows
            .iter()
            .zip(&self.coverage)
            .filter(|(row, _)| row.planner == planner && row.world == map)
            .collect();
        let point = |step: usize| {
            let tick = step * end / CURVE;
            let share = |&(row, seen): &(&Row, &Vec<u32>)| {
                let seen = seen.get(tick).or(seen.last()).copied().unwrap_or(0);
                (
                    map,
                    100.0 * f64::from(seen) / f64::from(row.reachable_cells),
                )
            };
            mean(runs.iter().map(share)).map(|interval| interval.at(tick as f64))
        };
        (0..=CURVE).filter_map(point).collect()
    }

    /// The tick by which every run in a map has seen what it ever saw.
    fn longest(&self, map: &str) -> usize {
        let runs = self.rows.iter().zip(&self.coverage);
        let ends = runs
            .filter(|(row, _)| row.world == map)
            .map(|(row, seen)| seen.partition_point(|&cells| cells < row.seen_cells));
        ends.max().unwrap_or(0)
    }
}

fn places<T: ToString>(label: &str, places: &[T]) -> Axis {
    Axis::Places(label.into(), places.iter().map(T::to_string).collect())
}

/// A planner has the same colour in all figures.
fn color(planner: PlannerKind) -> usize {
    match planner {
        PlannerKind::Explorer => 0,
        PlannerKind::MinPos => 1,
        PlannerKind::LocalFrontiers => 2,
        PlannerKind::LocalFrontiersSecondChance => 3,
        PlannerKind::Greedy => 4,
        PlannerKind::Closest => 5,
        PlannerKind::Bmilrv | PlannerKind::MinPosStrong | PlannerKind::Utility => 6,
    }
}
