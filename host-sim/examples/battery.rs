//! What turning back in time is worth: one explorer with energy for a share of the steps of
//! a full exploration, against one that turns back when half is used, in named worlds of
//! the generators.
//!
//! `cargo run --release -p host-sim --example battery [-- --worlds 100 --side 48]`

use std::sync::Arc;

use clap::Parser;
use host_sim::planners::PlannerKind;
use host_sim::run;
use host_sim::scenario::grid::Scenario;
use host_sim::sensor::Sensor;
use host_sim::world::{Family, Starts, World, generate};
use indicatif::ProgressBar;
use rayon::prelude::*;

#[derive(Parser)]
struct Arguments {
    /// Number of worlds, of all families in turn.
    #[arg(long, default_value_t = 100)]
    worlds: usize,
    /// Side of the worlds in cells, up to 64.
    #[arg(long, default_value_t = 48)]
    side: u16,
    /// Energy, in percent of the steps of a full exploration.
    #[arg(long, default_value_t = 30)]
    percent: u32,
}

/// When the robot turns back.
#[derive(Clone, Copy)]
enum Rule {
    /// Never: it has energy enough.
    Never,
    /// As the planner has it.
    InTime(u32),
    /// As it is told, after so many steps.
    After(u32),
}

/// What an exploration came to.
struct Run {
    steps: u32,
    /// Cells seen, and whether the robot stands where it started.
    cells: u32,
    is_home: bool,
}

fn explore(world: &Arc<World>, sensor: &Arc<Sensor>, rule: Rule) -> Run {
    let starts = world.place(1, &Starts::Center, false);
    let starts = starts.expect("there are free cells");
    let mut scenario = Scenario::new(world.clone(), starts, PlannerKind::Explorer);
    if let Rule::InTime(energy) = rule {
        scenario.conditions.mission.energy = energy;
    }
    scenario.check().expect("the scenario can be run");
    let mut fleet = run::fleet::<8, 8>(&scenario, sensor.clone());
    let (mut steps, mut at) = (0, scenario.starts[0]);
    let mut is_told = false;
    while !fleet.has_stopped() && fleet.ticks() < scenario.conditions.max_ticks {
        fleet.tick();
        let robot = &fleet.robots()[0];
        steps += u32::from(robot.position != at);
        at = robot.position;
        if matches!(rule, Rule::After(most) if steps >= most && !is_told) {
            is_told = fleet.go_home(0);
        }
    }
    Run {
        steps,
        cells: fleet.robots()[0].planner.map().known_cells(),
        is_home: at == scenario.starts[0],
    }
}

fn main() {
    let arguments = Arguments::parse();
    let worlds: Vec<(Family, u64)> = (1..)
        .flat_map(|seed| Family::ALL.map(|family| (family, seed)))
        .take(arguments.worlds)
        .collect();
    let bar = ProgressBar::new(worlds.len() as u64);
    let rows: Vec<(Family, [f64; 3])> = worlds
        .par_iter()
        .map(|&(family, seed)| {
            let side = arguments.side;
            let world = Arc::new(generate(family, side, side, seed).expect("the size is in range"));
            let sensor = Arc::new(Sensor::new(world.clone(), 5));
            let all = explore(&world, &sensor, Rule::Never);
            let energy = all.steps * arguments.percent / 100;
            let in_time = explore(&world, &sensor, Rule::InTime(energy.max(1)));
            assert!(in_time.is_home, "{family}-{seed}: not at home");
            assert!(
                in_time.steps <= energy.max(1),
                "{family}-{seed}: caught out"
            );
            let at_half = explore(&world, &sensor, Rule::After(energy / 2));
            bar.inc(1);
            let share = |run: &Run| f64::from(run.cells) / f64::from(all.cells);
            let (in_time, at_half) = (share(&in_time), share(&at_half));
            (family, [in_time, at_half, in_time / at_half])
        })
        .collect();
    bar.finish_and_clear();
    println!(
        "energy for {} % of the steps of a full exploration: {} worlds of {side}×{side} cells",
        arguments.percent,
        worlds.len(),
        side = arguments.side
    );
    println!("| family   | cells, in time | at half | ratio |");
    println!("|---|---|---|---|");
    let mean = |rows: &[[f64; 3]], column: usize| {
        rows.iter().map(|row| row[column]).sum::<f64>() / rows.len() as f64
    };
    let line = |name: &str, rows: &[[f64; 3]]| {
        println!(
            "| {name:<8} | {:>12.0} % | {:>5.0} % | {:.2}  |",
            100.0 * mean(rows, 0),
            100.0 * mean(rows, 1),
            mean(rows, 2)
        );
    };
    for family in Family::ALL {
        let of_family = rows.iter().filter(|(of, _)| *of == family);
        let of_family: Vec<[f64; 3]> = of_family.map(|(_, row)| *row).collect();
        if !of_family.is_empty() {
            line(&family.to_string(), &of_family);
        }
    }
    let all: Vec<[f64; 3]> = rows.iter().map(|(_, row)| *row).collect();
    line("all", &all);
    let least = all.iter().map(|row| row[2]).fold(f64::INFINITY, f64::min);
    println!("least ratio {least:.2}; no robot was caught out");
}
