//! Ticks against work a tick: what the explorer gains by a larger
//! [`Config::slice`](planner_core::explorer::Config::slice), and loses by a smaller one.
//!
//! `cargo run --release -p host-sim --example slice_table [-- --worlds 12 --slices 80000,…]`

use std::error::Error;
use std::sync::Arc;

use bridge::PlannerConfig;
use clap::Parser;
use host_sim::experiments;
use host_sim::planners::{PlannerKind, Setup, on_host};
use host_sim::run::{Host, Options, Site, run_on};
use host_sim::scenario::grid::Scenario;
use host_sim::sensor::Sensor;
use host_sim::world::{Family, Starts, generate};
use planner_core::AnyPlanner;
use planner_core::explorer::Config;
use rayon::prelude::*;

const RANGE: u8 = 5;
const SIDE: u16 = 64;

#[derive(Parser)]
struct Arguments {
    /// Worlds of each family.
    #[arg(long, default_value_t = 12)]
    worlds: u64,
    /// Numbers of robots; all start on one cell.
    #[arg(long, value_delimiter = ',', default_value = "3,8,20")]
    robots: Vec<usize>,
    /// Work a tick, in instructions of a Cortex-M4F.
    #[arg(
        long,
        value_delimiter = ',',
        default_value = "40000,80000,120000,160000,232000,480000,960000"
    )]
    slices: Vec<u32>,
}

/// Explorers that may work so much in a tick.
#[derive(Clone)]
struct Sliced(u32);

impl Site for Sliced {}

impl Host for Sliced {
    fn planner<const TW: usize, const TH: usize>(
        &self,
        kind: PlannerKind,
        setup: Setup,
    ) -> Box<dyn AnyPlanner<TW, TH>> {
        let planner = match kind.on_chip(setup) {
            Some(PlannerConfig::Explorer(config)) => {
                let slice = self.0;
                on_host(PlannerConfig::Explorer(Config { slice, ..config }), setup)
            }
            _ => kind.build(setup),
        };
        planner.expect("the compiled size holds the world")
    }
}

/// Ticks until all is seen, and whether it was.
fn ticks(slice: u32, sensor: &Arc<Sensor>, robots: usize, seed: u64) -> (f64, bool) {
    let world = sensor.world();
    let starts = world.place(robots, &Starts::Random(seed), false);
    let starts = starts.expect("cells may be shared");
    let starts = vec![starts[0]; robots];
    let mut scenario = Scenario::new(world.clone(), starts, PlannerKind::Explorer);
    scenario.range = RANGE;
    scenario.conditions.seed = seed;
    let options = Options {
        sensor: Some(sensor.clone()),
        ..Options::default()
    };
    let (outcome, _) = run_on(&Sliced(slice), &scenario, options).expect("it is in range");
    let seen = outcome.ticks_to_seen;
    (f64::from(seen.unwrap_or(outcome.ticks)), seen.is_some())
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::parse();
    let mut sites = Vec::new();
    for family in Family::ALL {
        for seed in 1..=arguments.worlds {
            let world = generate(family, SIDE, SIDE, seed)?;
            sites.push((Arc::new(Sensor::new(Arc::new(world), RANGE)), seed));
        }
    }
    let runs: Vec<_> = sites
        .iter()
        .enumerate()
        .flat_map(|(site, (sensor, seed))| {
            let robots = arguments.robots.iter();
            robots.map(move |robots| (site, sensor, *robots, *seed))
        })
        .collect();
    let all = |slice: u32| -> Vec<(f64, bool)> {
        let runs = runs.par_iter();
        runs.map(|&(_, sensor, robots, seed)| ticks(slice, sensor, robots, seed))
            .collect()
    };
    let shipped = all(Config::new().slice);
    println!("| slice | ticks | work bound | incomplete |\n|---:|---:|---:|---:|");
    for &slice in &arguments.slices {
        let found = all(slice);
        let pairs = found.iter().zip(&shipped).zip(&runs);
        let ratios = pairs.map(|((found, shipped), run)| (run.0, (found.0 / shipped.0).ln()));
        let mean = experiments::mean(ratios).ok_or("no runs")?;
        let config = Config {
            slice,
            ..Config::new()
        };
        println!(
            "| {slice} | {:.3} ±{:.3} | {} | {} |",
            mean.mean.exp(),
            (mean.high - mean.mean).exp() - 1.0,
            config.work_bound(),
            found.iter().filter(|(_, is_seen)| !is_seen).count(),
        );
    }
    Ok(())
}
