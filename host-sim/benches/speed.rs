//! Robot-ticks per second on one core: 10 robots on 64×64 cells, an exchange in
//! every tick, no trace.
//!
//! `cargo bench -p host-sim --bench speed`, and behind it ` -- explorer` for one planner.

use std::sync::Arc;
use std::time::{Duration, Instant};

use host_sim::planners::PlannerKind;
use host_sim::run::{Options, run};
use host_sim::scenario::grid::Scenario;
use host_sim::sensor::Sensor;
use host_sim::world::{Family, Starts, generate};

const TIME: Duration = Duration::from_secs(1);

fn main() {
    // Cargo adds an option of its own.
    let wanted = std::env::args().skip(1).find(|name| !name.starts_with('-'));
    for planner in [
        PlannerKind::Explorer,
        PlannerKind::Closest,
        PlannerKind::MinPos,
    ] {
        let name = planner.to_string();
        if wanted.as_ref().is_some_and(|wanted| *wanted != name) {
            continue;
        }
        for family in [Family::Cave, Family::PerfectMaze, Family::Open] {
            let speed = robot_ticks_per_second(planner, family);
            println!("{planner:>10}, {family:>12}: {speed:>8.0} thousand robot-ticks per second");
        }
    }
}

fn robot_ticks_per_second(planner: PlannerKind, family: Family) -> f64 {
    let world = Arc::new(generate(family, 64, 64, 1).expect("a world of 64×64 cells"));
    let sensor = Arc::new(Sensor::new(world.clone(), 5));
    let began = Instant::now();
    let mut robot_ticks = 0;
    for seed in 0.. {
        let starts = world.place(10, &Starts::Random(seed), false);
        let starts = starts.expect("robots may share a cell");
        let mut scenario = Scenario::new(world.clone(), starts, planner);
        scenario.conditions.seed = seed;
        let options = Options {
            sensor: Some(sensor.clone()),
            ..Options::default()
        };
        let (outcome, _) = run(&scenario, options).expect("the scenario is in range");
        robot_ticks += u64::from(outcome.ticks) * 10;
        if began.elapsed() > TIME {
            break;
        }
    }
    robot_ticks as f64 / began.elapsed().as_secs_f64() / 1000.0
}
