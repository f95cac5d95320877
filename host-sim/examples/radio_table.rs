//! What frames cost: the explorer with one frame of at most 55 bytes a robot and
//! tick against the ideal medium, on generated worlds and on given maps.
//!
//! `cargo run --release -p host-sim --example radio_table [-- --seeds 5 MAP…]`

use std::path::PathBuf;
use std::sync::Arc;

use clap::Parser;
use host_sim::planners::PlannerKind;
use host_sim::run::{Options, Outcome, run};
use host_sim::scenario::MediumKind;
use host_sim::scenario::grid::Scenario;
use host_sim::sensor::Sensor;
use host_sim::world::{Family, ReadOptions, Starts, World, generate};

const RANGE: u8 = 5;

#[derive(Parser)]
struct Arguments {
    /// Worlds of each family.
    #[arg(long, default_value_t = 5)]
    seeds: u64,
    /// Starts on each given map.
    #[arg(long, default_value_t = 3)]
    map_starts: u64,
    /// Side of the generated worlds in cells.
    #[arg(long, default_value_t = 48)]
    side: u16,
    /// Numbers of robots.
    #[arg(long, value_delimiter = ',', default_value = "1,3,10")]
    robots: Vec<usize>,
    /// Share of frames lost in the last columns.
    #[arg(long, default_value_t = 0.6)]
    loss: f64,
    /// Maps to run besides the generated worlds.
    maps: Vec<PathBuf>,
}

/// Sums over runs of one row.
#[derive(Clone, Copy, Default)]
struct Row {
    runs: u32,
    /// Logarithms of the ratios of ticks: frames to ideal, and both with loss.
    frames: f64,
    lossy: f64,
    /// Bytes a robot and tick, in the lossless runs.
    bytes: f64,
    bytes_total: f64,
    /// Lossless runs in which all maps agreed in the end.
    agreed: u32,
}

impl Row {
    fn add(&mut self, other: &Self) {
        self.runs += other.runs;
        self.frames += other.frames;
        self.lossy += other.lossy;
        self.bytes += other.bytes;
        self.bytes_total += other.bytes_total;
        self.agreed += other.agreed;
    }

    fn print(&self, name: &str, robots: usize) {
        let runs = f64::from(self.runs);
        let percent = |sum: f64| 100.0 * ((sum / runs).exp() - 1.0);
        println!(
            "| {name:<24} | {robots:>2} | {:>4} | {:>+6.1} % | {:>+6.1} % | {:>5.1} | {:>8.0} | {:>4} |",
            self.runs,
            percent(self.frames),
            percent(self.lossy),
            self.bytes / runs,
            self.bytes_total / runs,
            self.agreed,
        );
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments = Arguments::parse();
    println!(
        "| world                    |  m | runs | no loss  | {:>2.0} % loss | B/rob/tick | B/robot | agreed |",
        100.0 * arguments.loss
    );
    println!("|---|---|---|---|---|---|---|---|");
    for &robots in &arguments.robots {
        let mut all = Row::default();
        for family in Family::ALL {
            let mut row = Row::default();
            for seed in 0..arguments.seeds {
                let world = Arc::new(generate(family, arguments.side, arguments.side, seed)?);
                row.add(&compare(&world, robots, seed, arguments.loss)?);
            }
            row.print(&family.to_string(), robots);
            all.add(&row);
        }
        all.print("all families", robots);
        let mut all = Row::default();
        for path in &arguments.maps {
            let world = Arc::new(World::read(path, &ReadOptions::default())?);
            let mut row = Row::default();
            for seed in 0..arguments.map_starts {
                row.add(&compare(&world, robots, seed, arguments.loss)?);
            }
            row.print(world.name(), robots);
            all.add(&row);
        }
        if all.runs > 0 {
            all.print("all maps", robots);
        }
    }
    Ok(())
}

/// One world and one start.
fn compare(
    world: &Arc<World>,
    robots: usize,
    seed: u64,
    loss: f64,
) -> Result<Row, Box<dyn std::error::Error>> {
    let starts = match seed % 2 {
        0 => Starts::Center,
        _ => Starts::Random(seed),
    };
    let starts = world.place(robots, &starts, false)?;
    let sensor = Arc::new(Sensor::new(world.clone(), RANGE));
    let ticks = |medium, loss| -> Result<Outcome, Box<dyn std::error::Error>> {
        let mut scenario = Scenario::new(world.clone(), starts.clone(), PlannerKind::Explorer);
        scenario.range = RANGE;
        scenario.conditions.seed = seed;
        scenario.conditions.medium = medium;
        scenario.conditions.loss = loss;
        let options = Options {
            sensor: Some(sensor.clone()),
            ..Options::default()
        };
        Ok(run(&scenario, options)?.0)
    };
    let ideal = ticks(MediumKind::Ideal, 0.0)?;
    let frames = ticks(MediumKind::Radio, 0.0)?;
    let lossy = ticks(MediumKind::Radio, loss)?;
    let seen = |outcome: &Outcome| {
        f64::from(
            outcome
                .ticks_to_seen
                .expect("the explorer is complete")
                .max(1),
        )
        .ln()
    };
    let sent: u32 = frames.robots.iter().map(|robot| robot.sent.bytes).sum();
    let each = f64::from(sent) / robots as f64;
    Ok(Row {
        runs: 1,
        frames: seen(&frames) - seen(&ideal),
        lossy: seen(&lossy) - seen(&ideal),
        bytes: each / f64::from(frames.ticks),
        bytes_total: each,
        agreed: u32::from(frames.maps_agree()),
    })
}
