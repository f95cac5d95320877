//! The figures of the paper on the project's own runs [Renzaglia2019 fig. 3, 4, 6],
//! and the tables behind them.

use std::fmt::Write as _;

use planner_core::survey::SetupError;
use rayon::prelude::*;

use super::{Planner, Scenario, Terrain, Trace, octree, run, voxels};
use crate::draw::chart::{Axis, Chart, Panel, Point, Series, Style};
use crate::experiments::{Interval, mean};
use crate::medium::MediumKind;

/// The methods that are compared, in the order of the legends.
const METHODS: [Planner; 6] = [
    Planner::CoordinatedSurvey,
    Planner::CoordinatedCubic,
    Planner::Fcao,
    Planner::Greedy,
    Planner::GreedyUnique,
    Planner::ClosestFrontier,
];

/// Columns along a side of the terrains.
const SIDE: u16 = 100;
/// Robots where their number is not varied.
const ROBOTS: usize = 8;

/// Names of the figures.
pub const FIGURES: [&str; 5] = ["fcao3", "fcao4", "fcao6", "fcao-robots", "fcao-work"];

/// A figure with the table behind it.
#[derive(Clone, Debug)]
pub struct Figure {
    /// Short name: that of its files.
    pub id: &'static str,
    /// What is shown.
    pub title: String,
    /// Where it is from, and how it is to be read.
    pub caption: String,
    /// What is drawn.
    pub chart: Chart,
    /// The numbers, comma-separated.
    pub csv: String,
}

/// Makes that one of the [`FIGURES`] over the Gaussian terrains 0 to `terrains` - 1;
/// `None` if there is no such figure.
///
/// # Errors
/// None with the set-up used here.
pub fn figure(id: &str, terrains: u64) -> Result<Option<Figure>, SetupError> {
    let fleets = || -> Result<Vec<Fleet>, SetupError> {
        METHODS
            .iter()
            .map(|&planner| Fleet::new(Setup::new(planner, ROBOTS), terrains))
            .collect()
    };
    Ok(Some(match id {
        "fcao3" => over_time(&fleets()?),
        "fcao4" => final_times(&fleets()?),
        "fcao6" => town()?,
        "fcao-robots" => by_robots(terrains)?,
        "fcao-work" => work(terrains.min(10))?,
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
    fn new(setup: Setup, terrains: u64) -> Result<Self, SetupError> {
        let one = |seed| -> Result<Run, SetupError> {
            let scenario = Scenario {
                medium: setup.medium,
                loss: setup.loss,
                ..Scenario::new(setup.planner, setup.robots, seed)
            };
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
        interval(self.runs.iter().filter_map(value))
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
            Some(point(tick as f64, self.mean(value)?))
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

fn interval(values: impl Iterator<Item = f64>) -> Option<Interval> {
    let values: Vec<(String, f64)> = (0..)
        .zip(values)
        .map(|(i, v): (u32, f64)| (i.to_string(), v))
        .collect();
    mean(
        values
            .iter()
            .map(|(terrain, value)| (terrain.as_str(), *value)),
    )
}

fn point(x: f64, Interval { mean, low, high }: Interval) -> Point {
    Point {
        x,
        y: mean,
        low,
        high,
    }
}

/// A planner has the same colour in all figures.
fn colour(planner: Planner) -> usize {
    METHODS
        .iter()
        .position(|&method| method == planner)
        .unwrap_or(0)
}

fn over_time(fleets: &[Fleet]) -> Figure {
    let panel = |title: &str, y: &str, points: &dyn Fn(&Fleet) -> Vec<Point>| Panel {
        title: title.into(),
        x: Axis::Numbers("time (ticks)".into()),
        y: y.into(),
        series: fleets
            .iter()
            .map(|fleet| fleet.series(Style::Curve, points(fleet)))
            .collect(),
    };
    let seen = |fleet: &Fleet| fleet.curve(|run| &run.seen, true);
    let work = |fleet: &Fleet| fleet.curve(|run| &run.work, false);
    let mut csv = String::from("planner,tick,seen_percent,work_per_decision\n");
    for fleet in fleets {
        for (seen, work) in seen(fleet).iter().zip(work(fleet)) {
            let planner = fleet.setup.planner;
            let _ = writeln!(csv, "{planner},{},{:.3},{:.1}", seen.x, seen.y, work.y);
        }
    }
    let terrains = fleets[0].runs.len();
    Figure {
        id: "fcao3",
        title: "Surface seen over time, and the work of a decision".into(),
        caption: format!(
            "[Renzaglia2019, figure 3] over {terrains} Gaussian terrains of {SIDE}×{SIDE} columns \
             instead of one, {ROBOTS} robots, range 8, step 2. Work: cells, tiles, candidates and \
             samples looked at in one decision, a mean over the robots; greedy counts the \
             centre's once for each robot. Bands: 95 % confidence over terrains."
        ),
        chart: Chart {
            title: format!("Surface seen over time, {ROBOTS} robots"),
            panels: vec![
                panel("explored", "columns seen (%)", &seen),
                panel("work", "work of a decision", &work),
            ],
        },
        csv,
    }
}

fn final_times(fleets: &[Fleet]) -> Figure {
    let mut order: Vec<usize> = (0..fleets[0].runs.len()).collect();
    let reference = fleets
        .iter()
        .find(|fleet| fleet.setup.planner == Planner::Greedy);
    if let Some(greedy) = reference {
        order.sort_by_key(|&terrain| greedy.runs[terrain].ticks[2]);
    }
    let single = |fleet: &Fleet| {
        let time = |(place, &terrain): (usize, &usize)| {
            let value = f64::from(fleet.runs[terrain].ticks[2]?);
            Some(Point {
                x: place as f64,
                y: value,
                low: f64::NAN,
                high: f64::NAN,
            })
        };
        order.iter().enumerate().filter_map(time).collect()
    };
    let averages = |number: usize, fleet: &Fleet| {
        let mean = fleet
            .ticks(2)
            .map(|interval| point(number as f64, interval));
        mean.into_iter().collect()
    };
    let mut csv = String::from("planner,terrain,ticks_to_95,ticks_to_99,ticks_to_seen\n");
    for fleet in fleets {
        for (terrain, run) in fleet.runs.iter().enumerate() {
            let [a, b, c] = run
                .ticks
                .map(|t| t.map_or(String::new(), |t| t.to_string()));
            let _ = writeln!(csv, "{},{terrain},{a},{b},{c}", fleet.setup.planner);
        }
    }
    let names: Vec<String> = fleets
        .iter()
        .map(|fleet| fleet.setup.planner.to_string())
        .collect();
    let duration = "ticks until every column is seen";
    Figure {
        id: "fcao4",
        title: "Time to see everything, terrain by terrain".into(),
        caption: format!(
            "[Renzaglia2019, figure 4]: {} Gaussian terrains of {SIDE}×{SIDE} columns, {ROBOTS} \
             robots; left each terrain, in the order of greedy's times, right the means with 95 % \
             confidence over terrains.",
            fleets[0].runs.len()
        ),
        chart: Chart {
            title: format!("Time to see everything, {ROBOTS} robots"),
            panels: vec![
                Panel {
                    title: "each terrain".into(),
                    x: Axis::Numbers("terrains, by greedy's time".into()),
                    y: duration.into(),
                    series: fleets
                        .iter()
                        .map(|f| f.series(Style::Curve, single(f)))
                        .collect(),
                },
                Panel {
                    title: "means".into(),
                    x: Axis::Places("planner".into(), names.iter().map(|n| short(n)).collect()),
                    y: duration.into(),
                    series: fleets
                        .iter()
                        .enumerate()
                        .map(|(number, f)| f.series(Style::Dots, averages(number, f)))
                        .collect(),
                },
            ],
        },
        csv,
    }
}

/// A planner's name without what its colour says anyway.
fn short(name: &str) -> String {
    name.replace("coordinated-", "").replace("-frontier", "")
}

fn by_robots(terrains: u64) -> Result<Figure, SetupError> {
    let fleets = [1, 2, 4, 8, 16];
    let mut rows = Vec::new();
    for planner in METHODS {
        for robots in fleets {
            rows.push(Fleet::new(Setup::new(planner, robots), terrains)?);
        }
    }
    let losses = [0.0, 0.1, 0.3, 0.6];
    for planner in &METHODS[..3] {
        for loss in losses {
            let setup = Setup {
                medium: MediumKind::Radio,
                loss,
                ..Setup::new(*planner, ROBOTS)
            };
            rows.push(Fleet::new(setup, terrains)?);
        }
    }
    let greedy = |planner, robots| {
        let is = |fleet: &&Fleet| fleet.setup == Setup::new(planner, robots);
        rows.iter()
            .find(is)
            .and_then(|fleet| fleet.ticks(2))
            .map_or(f64::NAN, |i| i.mean)
    };
    let mut csv = String::from(
        "planner,robots,medium,loss,ticks_to_95,ticks_to_99,ticks_to_seen,half_interval,to_greedy,to_greedy_unique,mean_work,max_work\n",
    );
    for fleet in &rows {
        let Setup {
            planner,
            robots,
            medium,
            loss,
            ..
        } = fleet.setup;
        let [t95, t99, all] =
            [0, 1, 2].map(|share| fleet.ticks(share).map_or(f64::NAN, |i| i.mean));
        let half = fleet.ticks(2).map_or(f64::NAN, |i| i.high - i.mean);
        let work = fleet
            .mean(|run| Some(run.mean_work()))
            .map_or(f64::NAN, |i| i.mean);
        let max = fleet.runs.iter().map(|run| run.max_work).max().unwrap_or(0);
        let _ = writeln!(
            csv,
            "{planner},{robots},{medium},{loss},{t95:.1},{t99:.1},{all:.1},{half:.1},{:.3},{:.3},{work:.0},{max}",
            all / greedy(Planner::Greedy, robots),
            all / greedy(Planner::GreedyUnique, robots),
        );
    }
    let of = |planner: Planner, medium| {
        rows.iter()
            .filter(move |fleet| fleet.setup.planner == planner && fleet.setup.medium == medium)
    };
    let robots = |planner: Planner| {
        let ratio = |(place, fleet): (usize, &Fleet)| {
            let all = greedy(Planner::Greedy, fleet.setup.robots);
            let Interval { mean, low, high } = fleet.ticks(2)?;
            let share = |value| 100.0 * value / all;
            let scaled = Interval {
                mean: share(mean),
                low: share(low),
                high: share(high),
            };
            Some(point(place as f64, scaled))
        };
        of(planner, MediumKind::Ideal)
            .enumerate()
            .filter_map(ratio)
            .collect()
    };
    let lossy = |planner: Planner| {
        let ticks = |(place, fleet): (usize, &Fleet)| Some(point(place as f64, fleet.ticks(2)?));
        of(planner, MediumKind::Radio)
            .enumerate()
            .filter_map(ticks)
            .collect()
    };
    let series = |planner: Planner, points| Series {
        name: planner.to_string(),
        color: colour(planner),
        style: Style::Dots,
        points,
    };
    let places = |of: &[String]| of.to_vec();
    Ok(Figure {
        id: "fcao-robots",
        title: "Time to see everything by number of robots, and by loss".into(),
        caption: format!(
            "{terrains} Gaussian terrains of {SIDE}×{SIDE} columns. Left: the mean time as a share \
             of greedy's, all news exchanged at once. Right: {ROBOTS} robots that learn from one \
             another by frames of 55 bytes only, five a step, of which a share is lost. Error bars: \
             95 % confidence over terrains."
        ),
        chart: Chart {
            title: "Number of robots, and loss".into(),
            panels: vec![
                Panel {
                    title: "against greedy".into(),
                    x: Axis::Places("robots".into(), places(&fleets.map(|n| n.to_string()))),
                    y: "time of greedy's (%)".into(),
                    series: METHODS.iter().map(|&p| series(p, robots(p))).collect(),
                },
                Panel {
                    title: format!("{ROBOTS} robots by radio"),
                    x: Axis::Places(
                        "share of frames lost".into(),
                        places(&losses.map(|l| l.to_string())),
                    ),
                    y: "ticks until every column is seen".into(),
                    series: METHODS[..3].iter().map(|&p| series(p, lossy(p))).collect(),
                },
            ],
        },
        csv,
    })
}

fn work(terrains: u64) -> Result<Figure, SetupError> {
    let sides = [60u16, 100, 150, 200];
    let fleets = [1usize, 2, 4, 8, 16];
    let mut csv = String::from("planner,side,robots,mean_work,max_work\n");
    let mut curves: [Vec<Series>; 2] = Default::default();
    for planner in METHODS {
        let mut measure = |setups: Vec<Setup>| -> Result<Series, SetupError> {
            let mut points = Vec::new();
            for (place, setup) in setups.into_iter().enumerate() {
                let fleet = Fleet::new(setup, terrains)?;
                let mean = fleet.mean(|run| Some(run.mean_work()));
                let max = fleet.runs.iter().map(|run| run.max_work).max().unwrap_or(0);
                points.extend(mean.map(|interval| point(place as f64, interval)));
                let _ = writeln!(
                    csv,
                    "{planner},{},{},{:.0},{max}",
                    setup.side,
                    setup.robots,
                    mean.map_or(f64::NAN, |interval| interval.mean),
                );
            }
            Ok(Series {
                name: planner.to_string(),
                color: colour(planner),
                style: Style::Dots,
                points,
            })
        };
        let by_side = sides.map(|side| Setup {
            side,
            ..Setup::new(planner, ROBOTS)
        });
        curves[0].push(measure(by_side.to_vec())?);
        let by_robots = fleets.map(|robots| Setup::new(planner, robots));
        curves[1].push(measure(by_robots.to_vec())?);
    }
    let [by_side, by_robots] = curves;
    let panel = |title: &str, label: &str, places: Vec<String>, series| Panel {
        title: title.into(),
        x: Axis::Places(label.into(), places),
        y: "mean work of a decision".into(),
        series,
    };
    Ok(Figure {
        id: "fcao-work",
        title: "The work of a decision by size of the map and of the fleet".into(),
        caption: format!(
            "Counted work as in fcao3, means over {terrains} terrains with 95 % confidence. It \
             stays level for the planners of the core; that of the frontier methods grows with \
             the frontier, and the centre's also with the fleet."
        ),
        chart: Chart {
            title: "Work of a decision".into(),
            panels: vec![
                panel(
                    &format!("{ROBOTS} robots"),
                    "columns along a side",
                    sides.map(|side| side.to_string()).to_vec(),
                    by_side,
                ),
                panel(
                    &format!("{SIDE}×{SIDE} columns"),
                    "robots",
                    fleets.map(|robots| robots.to_string()).to_vec(),
                    by_robots,
                ),
            ],
        },
        csv,
    })
}

/// Nodes of the octree of what is mapped, every tenth step.
fn town() -> Result<Figure, SetupError> {
    const TOWN: u16 = 80;
    const VOXELS: u16 = 40;
    let mut csv = String::from("planner,tick,nodes\n");
    let mut curve = |name: String, color, end: u32, nodes: &dyn Fn(u32) -> usize| {
        let ticks = (0..end).step_by(10).chain([end]);
        let points = ticks.map(|tick| {
            let nodes = nodes(tick);
            let _ = writeln!(csv, "{name},{tick},{nodes}");
            Point {
                x: f64::from(tick),
                y: nodes as f64,
                low: f64::NAN,
                high: f64::NAN,
            }
        });
        Series {
            points: points.collect(),
            name,
            color,
            style: Style::Curve,
        }
    };
    let terrain = Terrain::urban(1, TOWN);
    let mut heights = Vec::new();
    for planner in [Planner::CoordinatedSurvey, Planner::Fcao] {
        let trace = run(&terrain, &Scenario::new(planner, 2, 1))?;
        let end = trace.ticks_to(1.0).unwrap_or(trace.seen.len() as u32);
        let nodes = |tick| octree(&trace, tick).nodes();
        heights.push(curve(planner.to_string(), colour(planner), end, &nodes));
    }
    let scenario = voxels::Scenario {
        robots: 2,
        range: 8,
        loss: 0.0,
        seed: 1,
        max_ticks: 20_000,
    };
    let trace = voxels::run(&voxels::Scene::town(1, VOXELS), &scenario)
        .expect("there is room for robots in a town");
    let end = trace.ticks_to(1.0).unwrap_or(trace.seen.len() as u32);
    let nodes = |tick| trace.octree(tick).nodes();
    let inside = curve("voxel-survey".into(), METHODS.len(), end, &nodes);
    let panel = |title: String, series| Panel {
        title,
        x: Axis::Numbers("time (ticks)".into()),
        y: "octree nodes".into(),
        series,
    };
    Ok(Figure {
        id: "fcao6",
        title: "OctoMap nodes mapped in town by 2 robots".into(),
        caption: format!(
            "[Renzaglia2019, figure 6]: nodes of the octree of what the fleet has mapped, inner \
             ones included, until everything is seen; one run each. Left a town of {TOWN}×{TOWN} \
             heights: streets, buildings, vehicles; step 2. Right a town of {VOXELS}×{VOXELS}×18 \
             voxels with rooms, doors and bridges, mapped by voxel-survey, which flies one voxel \
             a step; free voxels are mapped too."
        ),
        chart: Chart {
            title: "Octree of a town, 2 robots".into(),
            panels: vec![
                panel("heights".into(), heights),
                panel("voxels: voxel-survey".into(), vec![inside]),
            ],
        },
        csv,
    })
}
