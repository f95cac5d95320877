//! What straight ways are worth, and how long explorations take: robots that move in metres
//! beside the same in unit steps, the explorer and MinPos driven alike.
//!
//! `cargo run --release -p host-sim --example motion [-- MAPS… --pixels-per-cell 16]`

use std::path::PathBuf;
use std::sync::Arc;

use clap::Parser;
use host_sim::planners::PlannerKind::{self, Explorer, MinPos};
use host_sim::run::{Options, run};
use host_sim::scenario::grid::Scenario;
use host_sim::scenario::{Drive, Motion};
use host_sim::sensor::Sensor;
use host_sim::world::{Family, ReadOptions, Scale, Starts, World, generate};
use indicatif::ProgressBar;
use rayon::prelude::*;

#[derive(Parser)]
struct Arguments {
    /// Maps. Default: a generated world of each family.
    maps: Vec<PathBuf>,
    /// Images: so many pixels square are one cell.
    #[arg(long, default_value_t = 1)]
    pixels_per_cell: u32,
    /// Starts on each map, all robots together.
    #[arg(long, default_value_t = 3)]
    starts: u64,
    /// Numbers of robots.
    #[arg(long, value_delimiter = ',', default_value = "1,3,10")]
    robots: Vec<usize>,
    /// Side of a cell in metres.
    #[arg(long, default_value_t = 0.5)]
    cell: f64,
    /// Radius of the robots in metres: that of a TurtleBot3 Burger.
    #[arg(long, default_value_t = 0.11)]
    radius: f64,
}

/// What a run came to: metres of all robots, those by the cells that they entered, and
/// seconds (of unit steps, ticks) until all was seen, if it ever was and all robots ended.
struct Run {
    metres: f64,
    by_cells: f64,
    seconds: Option<f64>,
    touches: u32,
}

fn explore(
    arguments: &Arguments,
    sensor: &Arc<Sensor>,
    (start, robots): (u64, usize),
    planner: PlannerKind,
    drive: Option<Drive>,
) -> Run {
    let world = sensor.world();
    let starts = match start {
        0 => world.default_starts(),
        seed => Starts::Random(seed),
    };
    let starts = world.place(robots, &starts, true);
    let starts = starts.unwrap_or_else(|error| panic!("{error}"));
    let mut scenario = Scenario::new(world.clone(), starts, planner);
    scenario.solid = true;
    scenario.move_in_metres(drive.map(|drive| Motion {
        radius: arguments.radius,
        ..Motion::new(drive, arguments.cell, 0)
    }));
    let options = Options {
        sensor: Some(sensor.clone()),
        ..Options::default()
    };
    let (outcome, _) = run(&scenario, options).unwrap_or_else(|error| panic!("{error}"));
    let tick = scenario.motion.map_or(1.0, |motion| motion.tick());
    let seen = outcome.ticks_to_stopped.and(outcome.ticks_to_seen);
    let robots = || outcome.robots.iter();
    let steps: u32 = robots().map(|robot| robot.steps).sum();
    let driven = robots().map(|robot| robot.driven);
    let by_cells = f64::from(steps) * arguments.cell;
    Run {
        metres: match scenario.motion {
            None => by_cells,
            Some(_) => { driven.clone() }
                .map(|of| f64::from(of.millimetres) / 1e3)
                .sum(),
        },
        by_cells,
        seconds: seen.map(|ticks| f64::from(ticks) * tick),
        touches: driven.map(|of| of.touches.walls + of.touches.bodies).sum(),
    }
}

/// Geometric mean.
fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| {
        (sum + value.ln(), count + 1.0)
    });
    f64::exp(sum / count)
}

fn main() {
    let arguments = Arguments::parse();
    let options = ReadOptions {
        scale: match arguments.pixels_per_cell {
            1 => Scale::Pixel,
            pixels => Scale::Pixels(pixels),
        },
        ..ReadOptions::default()
    };
    let read = |map| World::read(map, &options).unwrap_or_else(|error| panic!("{error}"));
    let made = |family| generate(family, 48, 48, 1).expect("the size is in range");
    let worlds: Vec<World> = match arguments.maps[..] {
        [] => Family::ALL.into_iter().map(made).collect(),
        ref maps => maps.iter().map(read).collect(),
    };
    let sensors: Vec<Arc<Sensor>> = worlds
        .into_iter()
        .map(|world| Arc::new(Sensor::new(Arc::new(world), 5)))
        .collect();
    let places = sensors.len() as u64 * arguments.starts;
    let rows = 2 * arguments.robots.len() as u64;
    let bar = ProgressBar::new(places * rows);
    println!(
        "| robots | drive | way | straight | explorer, s | MinPos, s | ratio | left, touched |"
    );
    println!("|---:|---|---:|---:|---:|---:|---:|---:|");
    for &robots in &arguments.robots {
        for drive in [Drive::DiffDrive, Drive::Omni] {
            let places: Vec<(&Arc<Sensor>, u64)> = { sensors.iter() }
                .flat_map(|sensor| (0..arguments.starts).map(move |start| (sensor, start)))
                .collect();
            let runs: Vec<[Run; 3]> = places
                .par_iter()
                .map(|&(sensor, start)| {
                    let run = |planner, drive| {
                        explore(&arguments, sensor, (start, robots), planner, drive)
                    };
                    bar.inc(1);
                    [
                        run(Explorer, None),
                        run(Explorer, Some(drive)),
                        run(MinPos, Some(drive)),
                    ]
                })
                .collect();
            // In seconds those pairs count of which both have seen everything.
            let whole = || {
                let pairs = runs
                    .iter()
                    .map(|[_, ours, theirs]| (ours.seconds, theirs.seconds));
                pairs.filter_map(|(ours, theirs)| ours.zip(theirs))
            };
            let left = runs.len() - whole().count();
            let touches = runs.iter().flatten().map(|run| run.touches);
            println!(
                "| {robots} | {drive} | {:.3} | {:.3} | {:.0} | {:.0} | {:.3} | {left}, {} |",
                mean(
                    runs.iter()
                        .map(|[steps, ours, _]| ours.metres / steps.metres)
                ),
                mean(runs.iter().map(|[_, ours, _]| ours.metres / ours.by_cells)),
                mean(whole().map(|(ours, _)| ours)),
                mean(whole().map(|(_, theirs)| theirs)),
                mean(whole().map(|(ours, theirs)| ours / theirs)),
                touches.sum::<u32>(),
            );
        }
    }
    bar.finish_and_clear();
}
