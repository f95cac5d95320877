//! The figures of the paper on the project's own runs [Renzaglia2019 fig. 3, 4, 6],
//! and the tables behind them.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use planner_core::survey::SetupError;
use rayon::prelude::*;

use super::draw::{Curve, curves};
use super::{Planner, Scenario, Terrain, Trace, octree, run};

/// The methods that are compared, with their names in the figures.
const METHODS: [(Planner, &str); 5] = [
    (Planner::ClosestFrontier, "closest frontier"),
    (Planner::Greedy, "centralised greedy"),
    (Planner::Fcao, "FCAO"),
    (Planner::CoordinatedCubic, "coordinated, cubic"),
    (Planner::CoordinatedSurvey, "coordinated"),
];

/// Columns along a side of the terrains.
const SIDE: u16 = 100;

/// Runs every method over `terrains` Gaussian terrains and one town, and writes
/// `survey-coverage.svg`, `survey-work.svg`, `survey-times.svg` and
/// `survey-urban-nodes.svg` into `folder`. Gives the tables as text.
pub fn figures(folder: &Path, terrains: u64) -> Result<String, String> {
    fs::create_dir_all(folder).map_err(|error| error.to_string())?;
    let save = |name: &str, title: &str, all: &[Curve]| {
        fs::write(folder.join(name), curves(title, all)?).map_err(|error| error.to_string())
    };
    let fleets = METHODS
        .map(|(planner, name)| Ok((name, fleet(planner, 8, 0.0, terrains)?)))
        .into_iter()
        .collect::<Result<Vec<_>, SetupError>>()
        .map_err(|error| error.to_string())?;
    let per_method = |values: &dyn Fn(&[Trace]) -> Vec<f64>| -> Vec<Curve> {
        let curve = |(name, traces): &(&str, Vec<Trace>)| Curve {
            name: (*name).into(),
            values: values(traces),
        };
        fleets.iter().map(curve).collect()
    };
    let first = |traces: &[Trace]| coverage(&traces[0]);
    save(
        "survey-coverage.svg",
        "surface seen, %, 8 robots, terrain 0",
        &per_method(&first),
    )?;
    let work = |traces: &[Trace]| work_by_step(&traces[0]);
    save(
        "survey-work.svg",
        "work of a decision, 8 robots, terrain 0",
        &per_method(&work),
    )?;
    let times = |traces: &[Trace]| {
        traces
            .iter()
            .map(|trace| f64::from(trace.steps_to(1.0).unwrap_or(0)))
            .collect()
    };
    save(
        "survey-times.svg",
        "steps to 100 % by number of the terrain",
        &per_method(&times),
    )?;
    let nodes = urban_nodes().map_err(|error| error.to_string())?;
    save(
        "survey-urban-nodes.svg",
        "OctoMap nodes mapped in town by 2 robots",
        &nodes,
    )?;
    tables(terrains).map_err(|error| error.to_string())
}

/// A run of `planner` on each of the terrains 0, 1, …
fn fleet(
    planner: Planner,
    robots: usize,
    loss: f64,
    terrains: u64,
) -> Result<Vec<Trace>, SetupError> {
    (0..terrains)
        .into_par_iter()
        .map(|seed| {
            let scenario = Scenario {
                loss,
                ..Scenario::new(planner, robots, seed)
            };
            run(&Terrain::gaussian(seed, SIDE), &scenario)
        })
        .collect()
}

fn coverage(trace: &Trace) -> Vec<f64> {
    let all = f64::from(trace.extent.cells());
    trace
        .seen
        .iter()
        .map(|seen| 100.0 * f64::from(*seen) / all)
        .collect()
}

/// Mean work of the decisions of each step.
fn work_by_step(trace: &Trace) -> Vec<f64> {
    trace
        .records
        .chunk_by(|a, b| a.step == b.step)
        .map(|step| {
            step.iter()
                .map(|record| f64::from(record.work))
                .sum::<f64>()
                / step.len() as f64
        })
        .collect()
}

/// Nodes of the octree of what is mapped, every tenth step.
fn urban_nodes() -> Result<Vec<Curve>, SetupError> {
    let terrain = Terrain::urban(1, 80);
    [METHODS[2], METHODS[4]]
        .map(|(planner, name)| {
            let trace = run(&terrain, &Scenario::new(planner, 2, 1))?;
            let mut nodes = 0.0;
            let values = (0..trace.seen.len() as u32).map(|step| {
                if step % 10 == 0 {
                    nodes = octree(&trace, step).nodes() as f64;
                }
                nodes
            });
            Ok(Curve {
                name: name.into(),
                values: values.collect(),
            })
        })
        .into_iter()
        .collect()
}

fn tables(terrains: u64) -> Result<String, SetupError> {
    let mut text = format!(
        "{terrains} Gaussian terrains of {SIDE}×{SIDE} columns; steps, mean ± standard deviation\n\
         method               robots  loss    95 %    99 %   100 %       ±  to greedy  work: mean     max\n"
    );
    let mut rows = Vec::new();
    for robots in [1, 2, 4, 8, 16] {
        rows.extend(METHODS.map(|(planner, name)| (planner, name, robots, 0.0)));
    }
    for loss in [0.1, 0.3, 0.6] {
        rows.push((Planner::CoordinatedSurvey, "coordinated", 8, loss));
        rows.push((Planner::CoordinatedCubic, "coordinated, cubic", 8, loss));
    }
    let mut greedy = std::collections::BTreeMap::new();
    for (planner, name, robots, loss) in rows {
        if let std::collections::btree_map::Entry::Vacant(entry) = greedy.entry(robots) {
            let traces = fleet(Planner::Greedy, robots, 0.0, terrains)?;
            entry.insert(statistics(&traces, 1.0).0);
        }
        let traces = fleet(planner, robots, loss, terrains)?;
        let (all, deviation) = statistics(&traces, 1.0);
        let work = || {
            traces
                .iter()
                .flat_map(|trace| &trace.records)
                .map(|record| record.work)
        };
        let mean = work().map(f64::from).sum::<f64>() / work().count() as f64;
        let _ = writeln!(
            text,
            "{name:20} {robots:6} {loss:5.2} {:7.1} {:7.1} {all:7.1} {deviation:7.1} {:10.3} {mean:11.0} {:7}",
            statistics(&traces, 0.95).0,
            statistics(&traces, 0.99).0,
            all / greedy[&robots],
            work().max().unwrap_or(0),
        );
    }
    Ok(text)
}

/// Mean and standard deviation of the steps to `share`; NaN if a run never got there.
fn statistics(traces: &[Trace], share: f64) -> (f64, f64) {
    let steps = || {
        traces
            .iter()
            .map(|trace| trace.steps_to(share).map_or(f64::NAN, f64::from))
    };
    let number = traces.len() as f64;
    let mean = steps().sum::<f64>() / number;
    let variance = steps().map(|step| (step - mean).powi(2)).sum::<f64>() / number;
    (mean, variance.sqrt())
}
