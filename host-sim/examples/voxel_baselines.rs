//! How long a survey among voxels takes beside the closest frontier and a greedy centre, in
//! towns, with all news shared at once; as a table for docs/survey-figures.md:
//!
//! `cargo run --release -p host-sim --example voxel_baselines -- --towns 20`

use std::error::Error;
use std::path::PathBuf;

use clap::Parser;
use host_sim::experiments::{Interval, mean};
use host_sim::run::voxels::run;
use host_sim::scenario::voxels::{Planner, Scenario};
use host_sim::scene::{Scene, SceneOptions};
use rayon::prelude::*;

const PLANNERS: [(&str, Planner); 3] = [
    ("voxel-survey", Planner::VoxelSurvey),
    ("closest-frontier", Planner::ClosestFrontier),
    ("greedy", Planner::Greedy),
];

#[derive(Parser)]
struct Arguments {
    /// Towns.
    #[arg(long, default_value_t = 20)]
    towns: u64,
    /// Seed of the first town; the others follow.
    #[arg(long, default_value_t = 100)]
    first: u64,
    /// Columns along a side.
    #[arg(long, default_value_t = 40)]
    side: u16,
    /// Sizes of the fleet.
    #[arg(long, value_delimiter = ',', default_value = "1,2,4")]
    robots: Vec<usize>,
    /// A file with a scene, in place of towns.
    #[arg(long)]
    scene: Option<PathBuf>,
    /// Side of a voxel of that scene in metres.
    #[arg(long)]
    voxel_size: Option<f64>,
}

impl Arguments {
    fn scenes(&self) -> Result<Vec<Scene>, Box<dyn Error>> {
        let towns = self.first..self.first + self.towns;
        match &self.scene {
            None => Ok(towns.map(|seed| Scene::town(seed, self.side)).collect()),
            Some(path) => {
                let options = SceneOptions {
                    voxel_size: self.voxel_size,
                    ..SceneOptions::default()
                };
                Ok(vec![Scene::read(path, &options)?])
            }
        }
    }
}

/// What a run came to.
struct Ran {
    /// Steps until 95 % and all was seen, and until every robot had stopped; 0 if never.
    ticks: [f64; 3],
    complete: bool,
}

fn fly(scene: &Scene, planner: Planner, robots: usize) -> Ran {
    let mut scenario = Scenario::new(robots, 0);
    scenario.planner = planner;
    let trace = run(scene, &scenario).expect("the scenario can be flown");
    let last = trace.seen.len() as u32 - 1;
    let ticks = [
        trace.ticks_to(0.95),
        trace.ticks_to(1.0),
        trace.all_stopped.then_some(last),
    ];
    Ran {
        ticks: ticks.map(|ticks| ticks.map_or(0.0, f64::from)),
        complete: trace.complete(),
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::parse();
    let scenes = arguments.scenes()?;
    println!("| robots | planner | 95 % | 100 % | all stopped | to greedy | complete |");
    println!("|---|---|---:|---:|---:|---:|---:|");
    for &robots in &arguments.robots {
        let of = |planner| -> Vec<Ran> {
            let runs = scenes.par_iter();
            runs.map(|scene| fly(scene, planner, robots)).collect()
        };
        let runs = PLANNERS.map(|(name, planner)| (name, of(planner)));
        let greedy = &runs[2].1;
        for (name, runs) in &runs {
            let samples = |of: &dyn Fn(usize) -> f64| -> Option<Interval> {
                mean((0..runs.len()).map(|number| (number, of(number))))
            };
            let cell = |interval: Option<Interval>, digits: usize| match interval {
                None => "never".to_owned(),
                Some(Interval { mean, high, .. }) if high.is_finite() => {
                    format!("{mean:.digits$} ± {:.digits$}", high - mean)
                }
                Some(Interval { mean, .. }) => format!("{mean:.digits$}"),
            };
            let steps = [0, 1, 2].map(|what| cell(samples(&|it| runs[it].ticks[what]), 0));
            let to_greedy = samples(&|it| runs[it].ticks[1] / greedy[it].ticks[1]);
            let complete = runs.iter().filter(|run| run.complete).count();
            println!(
                "| {robots} | {name} | {} | {} | {complete} of {} |",
                steps.join(" | "),
                cell(to_greedy, 2),
                runs.len()
            );
        }
    }
    Ok(())
}
