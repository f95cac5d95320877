//! Firmware in the loop: emulated chips decide what the host decides.
//!
//! These tests need QEMU and the image, which `cargo xtask test --only loop`
//! provides; it also holds what they print against `fixtures/budget.txt`.
#![cfg(unix)]

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use host_sim::chip::{ChipError, Machine, Swarm};
use host_sim::measured::{Call, Measured};
use host_sim::medium::MediumKind::{self, Ideal, Radio};
use host_sim::planners::PlannerKind::{self, Explorer, LocalFrontiers, LocalFrontiersSecondChance};
use host_sim::run::{self, Options, Scenario};
use host_sim::trace::Trace;
use host_sim::world::{Family, ReadOptions, Starts, World, generate, paper};
use planner_core::Extent;

const PLANNERS: [PlannerKind; 3] = [Explorer, LocalFrontiers, LocalFrontiersSecondChance];

fn scenario(
    world: &Arc<World>,
    planner: PlannerKind,
    robots: usize,
    medium: MediumKind,
    loss: f64,
    solid: bool,
) -> Scenario {
    let starts = world.place(robots, &Starts::Center, solid).unwrap();
    let mut scenario = Scenario::new(world.clone(), starts, planner);
    scenario.medium = medium;
    scenario.loss = loss;
    scenario.solid = solid;
    scenario.seed = 7;
    // Local frontiers can walk in circles for ever; that must be shown once, not for long.
    scenario.max_ticks = scenario.max_ticks.min(1500);
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
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let swarm = Swarm::new(machine, root.join(machine.image()));
    let options = Options {
        trace: true,
        ..Options::default()
    };
    let (_, trace) = run::run_on(&swarm, scenario, options).unwrap();
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

/// The largest of each figure, by the name of its limit in `fixtures/budget.txt`.
#[derive(Default)]
struct Largest(BTreeMap<String, u64>);

impl Largest {
    fn note(&mut self, name: String, value: u64) {
        let largest = self.0.entry(name).or_default();
        *largest = value.max(*largest);
    }

    fn take(&mut self, prefix: &str, planner: PlannerKind, measured: &Measured) {
        let planner = match planner {
            Explorer => "explorer",
            _ => "local_frontiers",
        };
        for call in [Call::Observe, Call::Tick, Call::Transmit, Call::Receive] {
            if let Some(tally) = measured.calls.get(&call) {
                self.note(
                    format!("{prefix}_{planner}_{call}_instructions"),
                    tally.largest,
                );
                let stack = tally.stack_bytes.into();
                self.note(format!("{prefix}_{planner}_stack_bytes"), stack);
            }
        }
        let bytes = [
            ("flash", measured.flash_bytes),
            ("static", measured.static_bytes),
        ];
        for (name, size) in bytes {
            self.note(format!("{prefix}_{name}_bytes"), size.into());
        }
    }

    /// Prints `name: value` lines, which `cargo xtask test` reads.
    fn print(&self) {
        println!();
        for (name, value) in &self.0 {
            println!("{name}: {value}");
        }
    }
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
            largest.take("loop", planner, &measured);
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
    for machine in [Machine::Mps2An385, Machine::Microbit] {
        for (planner, (family, seed)) in PLANNERS
            .into_iter()
            .flat_map(|it| worlds.map(|of| (it, of)))
        {
            let world = Arc::new(generate(family, 32, 32, seed).unwrap());
            compare(&scenario(&world, planner, 3, Radio, 0.3, false), machine);
        }
    }
}

/// The same rooms in the corner of grids of any size: what the robots meet is the
/// same, so whatever a call takes more comes from the size alone. They talk over
/// the ideal medium: by radio, what is told when depends on where the map ends.
#[test]
#[ignore = "needs QEMU and the image: cargo xtask test --only loop"]
fn a_tick_of_the_explorer_does_not_cost_more_on_a_larger_map() {
    let rooms = generate(Family::Rooms, 32, 32, 1).unwrap();
    let inside = Extent::new(32, 32);
    for robots in [1, 10] {
        let largest = [32, 64, 128].map(|side| {
            let name = format!("rooms in {side}×{side}");
            let blocked = |cell| !inside.contains(cell) || !rooms.is_free(cell);
            let world = World::from_fn(&name, Extent::new(side, side), blocked).unwrap();
            let starts = rooms.place(robots, &Starts::Center, false).unwrap();
            let mut scenario = scenario(&Arc::new(world), Explorer, 1, Ideal, 0.3, false);
            scenario.starts = starts;
            compare(&scenario, Machine::Netduinoplus2).calls[&Call::Tick].largest
        });
        let (least, most) = (largest.iter().min().unwrap(), largest.iter().max().unwrap());
        assert!(
            most * 100 <= least * 101,
            "{robots} robots: instructions of the largest tick by size: {largest:?}"
        );
    }
}

#[test]
#[ignore = "needs QEMU and the image: cargo xtask test --only loop"]
fn a_chip_that_cannot_go_on_ends_the_run_with_a_reason() {
    let scenario =
        |world: World, planner| scenario(&Arc::new(world), planner, 2, Radio, 0.0, false);
    let open = |side| World::from_fn("open", Extent::new(side, side), |_| false).unwrap();
    let error = on_chips(&scenario(open(129), Explorer), Machine::Netduinoplus2).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("does not fit a map compiled for 128×128"),
        "{error}"
    );
    let error = on_chips(
        &scenario(open(9), PlannerKind::Greedy),
        Machine::Netduinoplus2,
    )
    .unwrap_err();
    assert!(error.to_string().contains("no chip has"), "{error}");
    let swarm = Swarm::new(Machine::Netduinoplus2, "no/such/image".into());
    run::run_on(&swarm, &scenario(open(9), Explorer), Options::default()).unwrap();
    let error = swarm.finish().unwrap_err();
    assert!(
        error.to_string().contains("cargo xtask build-firmware"),
        "{error}"
    );
    // An image that speaks to people only.
    let other = Machine::Netduinoplus2.image().with_file_name("firmware");
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let swarm = Swarm::new(Machine::Netduinoplus2, root.join(other));
    run::run_on(&swarm, &scenario(open(9), Explorer), Options::default()).unwrap();
    let error = swarm.finish().unwrap_err();
    assert!(
        error.to_string().contains("do not understand each other"),
        "{error}"
    );
}
