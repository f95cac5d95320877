//! Robots on the ground.

use std::path::Path;
use std::sync::Arc;

use host_sim::chip::{ChipError, Machine, Swarm};
use host_sim::measured::{Call, Measured};
use host_sim::planners::PlannerKind::{self, Explorer, LocalFrontiers, LocalFrontiersSecondChance};
use host_sim::record::grid::Trace;
use host_sim::run::{self, Options};
use host_sim::scenario::MediumKind::{self, Ideal, Radio};
use host_sim::scenario::grid::Scenario;
use host_sim::world::{Family, ReadOptions, Starts, World, generate, paper};

use crate::{Largest, image};

const PLANNERS: [PlannerKind; 3] = [Explorer, LocalFrontiers, LocalFrontiersSecondChance];

/// A run with a seed of its own.
pub(crate) fn scenario(
    world: &Arc<World>,
    planner: PlannerKind,
    robots: usize,
    medium: MediumKind,
    loss: f64,
    solid: bool,
) -> Scenario {
    let starts = world.place(robots, &Starts::Center, solid).unwrap();
    let mut scenario = Scenario::new(world.clone(), starts, planner);
    scenario.conditions.medium = medium;
    scenario.conditions.loss = loss;
    scenario.solid = solid;
    scenario.conditions.seed = 7;
    // Local frontiers can walk in circles for ever; that must be shown once, not for long.
    scenario.conditions.max_ticks = scenario.conditions.max_ticks.min(1500);
    scenario
}

fn on_host(scenario: &Scenario) -> Trace {
    let options = Options {
        trace: true,
        ..Options::default()
    };
    run::run(scenario, options).unwrap().1.unwrap()
}

fn on_chips(scenario: &Scenario, machine: Machine) -> Result<(Trace, Measured), ChipError> {
    let swarm = Swarm::new(machine, image(machine, "robot"));
    let options = Options {
        trace: true,
        ..Options::default()
    };
    let (_, trace) = swarm.explore(scenario, options).unwrap();
    Ok((trace.unwrap(), swarm.finish()?))
}

/// Runs the scenario here and on chips, wants both to do the same, and returns
/// what it took.
fn compare(scenario: &Scenario, machine: Machine) -> Measured {
    let (there, measured) = on_chips(scenario, machine).unwrap_or_else(|error| panic!("{error}"));
    let here = on_host(scenario);
    let title = format!(
        "{} with {} robots on {}",
        scenario.planner,
        scenario.starts.len(),
        scenario.world.name()
    );
    for (here, there) in here.records.iter().zip(&there.records) {
        assert_eq!(here, there, "{title}");
    }
    assert_eq!(here.records.len(), there.records.len(), "{title}");
    assert_eq!(here.digest(), there.digest(), "{title}");
    let tick = measured.calls[&Call::Tick];
    println!(
        "{machine:<14} {:<29} {:<26} {:>2} robots {:>5} ticks {}  mean {:>7} largest {:>7}",
        scenario.planner.to_string(),
        scenario.world.name(),
        scenario.starts.len(),
        here.ticks(),
        here.digest(),
        tick.mean,
        tick.largest
    );
    measured
}

fn ward() -> World {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fixtures/maps/ward.txt");
    World::read(&path, &ReadOptions::default()).unwrap()
}

#[test]
#[ignore = "needs QEMU and the image: cargo xtask test --only loop"]
fn every_planner_decides_on_the_chip_as_on_the_host() {
    let made = |family, width, height, seed| generate(family, width, height, seed).unwrap();
    let worlds = [
        (ward(), 3, Radio, 0.0, false),
        (ward(), 10, Radio, 0.6, false),
        (ward(), 5, Radio, 0.3, true),
        (ward(), 4, Ideal, 0.3, true),
        (paper::labyrinth1(2), 3, Ideal, 0.6, false),
        (paper::labyrinth2(3), 3, Radio, 0.3, false),
        (paper::circle(), 2, Radio, 0.0, true),
        (paper::blocks(), 4, Radio, 0.9, false),
        (made(Family::Rooms, 32, 32, 1), 1, Radio, 0.0, false),
        (made(Family::Rooms, 32, 32, 1), 10, Radio, 0.3, true),
        (made(Family::Cave, 31, 24, 2), 4, Radio, 0.3, false),
        (made(Family::Cave, 40, 17, 3), 2, Ideal, 0.0, false),
        (made(Family::PerfectMaze, 24, 24, 4), 3, Radio, 0.5, true),
        (made(Family::BraidedMaze, 33, 9, 5), 2, Radio, 1.0, false),
        (
            made(Family::RandomObstacles, 26, 26, 6),
            3,
            Radio,
            0.3,
            false,
        ),
        (made(Family::IsolatedBlocks, 9, 40, 7), 5, Radio, 0.2, true),
        (made(Family::Rooms, 64, 64, 8), 4, Radio, 0.3, false),
        (made(Family::Cave, 90, 128, 9), 10, Radio, 0.3, false),
    ];
    let mut largest = Largest::default();
    let mut explorations = 0;
    for (world, robots, medium, loss, solid) in worlds {
        let world = Arc::new(world);
        for planner in PLANNERS {
            let scenario = scenario(&world, planner, robots, medium, loss, solid);
            let measured = compare(&scenario, Machine::Netduinoplus2);
            let name = match planner {
                Explorer => "explorer",
                _ => "local_frontiers",
            };
            let calls = [Call::Observe, Call::Tick, Call::Transmit, Call::Receive];
            largest.take(name, &calls, &measured);
            explorations += 1;
        }
    }
    largest.print();
    println!("explorations: {explorations}");
    assert!(explorations >= 50);
}

#[test]
#[ignore = "needs QEMU and the image: cargo xtask test --only loop"]
fn chips_without_a_floating_point_unit_decide_the_same() {
    let worlds = [(Family::Rooms, 1), (Family::Cave, 2)];
    let mut explorations = 0;
    for machine in [Machine::Mps2An385, Machine::Microbit] {
        for (planner, (family, seed)) in PLANNERS
            .into_iter()
            .flat_map(|it| worlds.map(|of| (it, of)))
        {
            let world = Arc::new(generate(family, 32, 32, seed).unwrap());
            compare(&scenario(&world, planner, 3, Radio, 0.3, false), machine);
            explorations += 1;
        }
    }
    println!("explorations: {explorations}");
}
