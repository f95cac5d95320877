//! What false looks, slipping poses, people and doors do to the explorer: false claims,
//! runs that did not end, ticks against the same worlds without any of it, and cells left
//! unseen, for each preset of the sensor's model.
//!
//! `cargo run --release -p host-sim --example senses_table [-- --worlds 50 MAP…]`

use std::error::Error;
use std::fmt;
use std::path::PathBuf;
use std::sync::Arc;

use clap::Parser;
use host_sim::planners::PlannerKind;
use host_sim::run::{Options, Outcome, run};
use host_sim::scenario::grid::Scenario;
use host_sim::scenario::{ErrorKind, MediumKind, Preset, Trouble};
use host_sim::sensor::Sensor;
use host_sim::world::{Family, ReadOptions, Starts, World, generate};
use rayon::prelude::*;

const RANGE: u8 = 5;

#[derive(Parser)]
struct Arguments {
    /// Worlds of rooms, and as many caves.
    #[arg(long, default_value_t = 10)]
    worlds: u64,
    /// Starts in each world.
    #[arg(long, default_value_t = 2)]
    starts: u64,
    /// Side of these worlds in cells.
    #[arg(long, default_value_t = 48)]
    side: u16,
    /// Numbers of robots.
    #[arg(long, value_delimiter = ',', default_value = "1,3")]
    robots: Vec<usize>,
    /// Presets of the sensor's model.
    #[arg(long, value_delimiter = ',', default_value = "truthful,lidar,rangers")]
    presets: Vec<Preset>,
    /// Only conditions whose names hold this.
    #[arg(long, default_value = "")]
    only: String,
    /// Maps to run in besides.
    maps: Vec<PathBuf>,
}

/// A line of the table.
struct Condition {
    name: String,
    trouble: Trouble,
    medium: MediumKind,
    loss: f64,
}

fn conditions() -> Vec<Condition> {
    let none = Trouble::default();
    let walls = |false_walls, error_kind| Trouble {
        false_walls,
        error_kind,
        ..none
    };
    let both = |share| Trouble {
        false_walls: share,
        false_frees: share,
        ..none
    };
    let mut troubles = vec![none];
    for kind in [ErrorKind::Transient, ErrorKind::Viewpoint] {
        troubles.extend([0.001, 0.01, 0.05].map(|share| walls(share, kind)));
    }
    troubles.extend([0.01, 0.05].map(|share| walls(share, ErrorKind::Far)));
    troubles.extend([0.01, 0.05].map(both));
    troubles.extend([0.01, 0.05, 0.2].map(|misplaced| Trouble { misplaced, ..none }));
    troubles.extend([200, 50].map(|drift| Trouble { drift, ..none }));
    troubles.extend([2, 8].map(|people| Trouble { people, ..none }));
    troubles.push(Trouble { doors: 6, ..none });
    troubles.push(Trouble {
        see_robots: true,
        ..none
    });
    let name = |trouble: &Trouble| match trouble.is_none() {
        true => "none".to_owned(),
        false => trouble.to_string(),
    };
    let ideal = troubles.into_iter().map(|trouble| Condition {
        name: name(&trouble),
        trouble,
        medium: MediumKind::Ideal,
        loss: 0.0,
    });
    let mut conditions: Vec<Condition> = ideal.collect();
    conditions.push(Condition {
        name: format!("{}, half of the frames lost", both(0.01)),
        trouble: both(0.01),
        medium: MediumKind::Radio,
        loss: 0.5,
    });
    conditions
}

/// A place to begin in.
struct Site {
    sensor: Arc<Sensor>,
    starts: Starts,
    seed: u64,
}

/// Sums over runs of one cell of the table.
#[derive(Clone, Copy, Default)]
struct Sum {
    runs: u32,
    /// Runs with a false claim.
    false_claims: u32,
    /// Runs that did not end in time.
    endless: u32,
    /// Logarithms of the ratios of ticks.
    ticks: f64,
    /// Shares of the reachable cells that nobody saw.
    unseen: f64,
}

impl Sum {
    fn and(self, other: Self) -> Self {
        Self {
            runs: self.runs + other.runs,
            false_claims: self.false_claims + other.false_claims,
            endless: self.endless + other.endless,
            ticks: self.ticks + other.ticks,
            unseen: self.unseen + other.unseen,
        }
    }

    fn of(outcome: &Outcome, calm: &Outcome) -> Self {
        let ticks = |outcome: &Outcome| f64::from(outcome.ticks.max(1)).ln();
        Self {
            runs: 1,
            false_claims: u32::from(outcome.false_claims() > 0),
            endless: u32::from(outcome.ticks_to_stopped.is_none()),
            ticks: ticks(outcome) - ticks(calm),
            unseen: 1.0 - f64::from(outcome.seen_cells) / f64::from(outcome.reachable_cells),
        }
    }
}

impl fmt::Display for Sum {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let runs = f64::from(self.runs.max(1));
        let share = 100.0 * f64::from(self.false_claims) / runs;
        let endless = match self.endless {
            0 => String::new(),
            endless => format!(" ({endless})"),
        };
        let ticks = (self.ticks / runs).exp();
        write!(f, "{share:.1} %{endless} ×{ticks:.2}")?;
        match 100.0 * self.unseen / runs {
            unseen if unseen < 0.05 => Ok(()),
            unseen => write!(f, " −{unseen:.1} %"),
        }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::parse();
    let sites = sites(&arguments)?;
    println!(
        "False claims in {} runs, ×ticks, −cells that nobody saw; in brackets runs that did not end.\n",
        sites.len()
    );
    let presets = &arguments.presets;
    let names: Vec<String> = presets.iter().map(Preset::to_string).collect();
    println!("| condition | robots | {} |", names.join(" | "));
    println!("|---|---:|{}", "---|".repeat(names.len()));
    for condition in conditions() {
        if !condition.name.contains(&arguments.only) {
            continue;
        }
        for &robots in &arguments.robots {
            let cells = presets.iter().map(|&preset| {
                let runs = sites.par_iter();
                let sums = runs.map(|site| measure(site, &condition, preset, robots));
                sums.reduce(Sum::default, Sum::and).to_string()
            });
            let cells = cells.collect::<Vec<_>>().join(" | ");
            println!("| {} | {robots} | {cells} |", condition.name);
        }
    }
    Ok(())
}

fn sites(arguments: &Arguments) -> Result<Vec<Site>, Box<dyn Error>> {
    let mut worlds = Vec::new();
    for seed in 0..arguments.worlds {
        for family in [Family::Rooms, Family::Cave] {
            worlds.push(generate(family, arguments.side, arguments.side, seed)?);
        }
    }
    for path in &arguments.maps {
        worlds.push(World::read(path, &ReadOptions::default())?);
    }
    let mut sites = Vec::new();
    for world in worlds {
        let sensor = Arc::new(Sensor::new(Arc::new(world), RANGE));
        sites.extend((0..arguments.starts).map(|seed| Site {
            sensor: sensor.clone(),
            starts: Starts::Random(seed),
            seed,
        }));
    }
    Ok(sites)
}

/// A run under the condition, against a truthful one without trouble. A lidar looks three
/// times a step.
fn measure(site: &Site, condition: &Condition, preset: Preset, robots: usize) -> Sum {
    let world = site.sensor.world();
    let starts = world.place(robots, &site.starts, false);
    let starts = starts.expect("cells may be shared");
    let run = |condition: Option<&Condition>| {
        let mut scenario = Scenario::new(world.clone(), starts.clone(), PlannerKind::Explorer);
        scenario.range = RANGE;
        scenario.conditions.seed = site.seed;
        if let Some(condition) = condition {
            scenario.conditions.preset = preset;
            scenario.conditions.trouble = condition.trouble;
            if preset == Preset::Lidar {
                scenario.conditions.trouble.looks = 3;
            }
            scenario.conditions.medium = condition.medium;
            scenario.conditions.loss = condition.loss;
        }
        let options = Options {
            sensor: Some(site.sensor.clone()),
            ..Options::default()
        };
        run(&scenario, options).expect("the scenario is in range").0
    };
    Sum::of(&run(Some(condition)), &run(None))
}
