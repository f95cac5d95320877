//! Every fault of the air and of robots, in every kind of world: what can be explored is
//! explored, nothing unsafe happens, and every robot that lives stops and knows all.

use std::sync::Arc;

use host_sim::planners::PlannerKind;
use host_sim::record::Deed;
use host_sim::run;
use host_sim::scenario::MediumKind::{self, Ideal, Radio};
use host_sim::scenario::{Conditions, Event, grid, heights, voxels};
use host_sim::scene::Scene;
use host_sim::terrain::Terrain;
use host_sim::world::{Family, Starts, generate};
use planner_core::Extent;
use planner_core::radio::Key;
use planner_core::volume::Voxel;
use proptest::prelude::*;

/// Robots of every run.
const ROBOTS: u8 = 3;

/// What a run in any world came to.
#[derive(Debug, Default)]
struct Ending {
    /// Whether all that there is was seen, without a violation.
    is_complete: bool,
    /// Whether every robot that lives has stopped with all that it can reach.
    has_stopped: bool,
    /// What each robot that lives knows, in places.
    known: Vec<u32>,
}

/// A kind of world: what a run in one of them, drawn by a seed, comes to.
type World = fn(u64, &dyn Fn(&mut Conditions)) -> Ending;

const WORLDS: [(&str, World); 3] = [
    ("cells", of_cells),
    ("heights", of_heights),
    ("voxels", of_voxels),
];

fn of_cells(seed: u64, set: &dyn Fn(&mut Conditions)) -> Ending {
    let world = Arc::new(generate(Family::Rooms, 20, 20, seed).unwrap());
    let starts = world.place(ROBOTS.into(), &Starts::Center, false).unwrap();
    let mut scenario = grid::Scenario::new(world, starts, PlannerKind::Explorer);
    set(&mut scenario.conditions);
    let (outcome, _) = run::run(&scenario, run::Options::default()).unwrap();
    let alive = || outcome.robots.iter().filter(|robot| robot.alive);
    Ending {
        is_complete: outcome.is_complete(),
        has_stopped: alive().all(|robot| {
            robot.stop.is_some_and(|stop| stop.is_complete()) && robot.cells_missed == 0
        }),
        known: alive().map(|robot| robot.cells_known).collect(),
    }
}

fn of_heights(seed: u64, set: &dyn Fn(&mut Conditions)) -> Ending {
    let planner = heights::Planner::CoordinatedSurvey;
    let mut scenario = heights::Scenario::new(planner, ROBOTS.into(), seed);
    set(&mut scenario.conditions);
    let trace = run::heights::run(&Terrain::gaussian(seed, 24), &scenario).unwrap();
    let last = trace.records.last().unwrap().tick;
    let ends: Vec<_> = trace.records.iter().filter(|it| it.tick == last).collect();
    Ending {
        is_complete: trace.complete() && trace.safety.violations() == 0,
        has_stopped: trace.all_stopped && ends.iter().all(|it| matches!(it.deed, Deed::Stopped(_))),
        known: ends.iter().map(|it| it.known).collect(),
    }
}

fn of_voxels(seed: u64, set: &dyn Fn(&mut Conditions)) -> Ending {
    let mut scenario = voxels::Scenario::new(ROBOTS.into(), seed);
    set(&mut scenario.conditions);
    let trace = run::voxels::run(&blocks(seed), &scenario).unwrap();
    let last = trace.records.last().unwrap().tick;
    let ends: Vec<_> = trace.records.iter().filter(|it| it.tick == last).collect();
    Ending {
        is_complete: trace.complete(),
        has_stopped: trace.all_stopped && ends.iter().all(|it| matches!(it.deed, Deed::Stopped(_))),
        known: ends.iter().map(|it| it.known).collect(),
    }
}

/// Blocks on the ground, some of them left out.
fn blocks(seed: u64) -> Scene {
    Scene::from_fn("blocks", Extent::new(11, 11), 7, |Voxel { x, y, z }| {
        let block = (x / 4 + 3 * (y / 4)) as u64 + seed;
        z == 0 || z < 4 && x % 4 > 1 && y % 4 > 1 && !block.is_multiple_of(3)
    })
}

/// A fault, the medium in which it happens, and whether messages are lost by it.
struct Fault {
    name: &'static str,
    medium: MediumKind,
    is_lossy: bool,
    set: fn(&mut Conditions, tick: u32),
}

const fn fault(
    name: &'static str,
    medium: MediumKind,
    is_lossy: bool,
    set: fn(&mut Conditions, u32),
) -> Fault {
    Fault {
        name,
        medium,
        is_lossy,
        set,
    }
}

fn event(robot: u8, tick: u32) -> Event {
    Event::from((robot, tick))
}

const FAULTS: [Fault; 22] = [
    fault("none", Ideal, false, |_, _| {}),
    fault("none", Radio, false, |_, _| {}),
    fault("loss", Ideal, true, |it, _| it.loss = 0.5),
    fault("loss", Radio, true, |it, _| it.loss = 0.5),
    fault("silence", Radio, true, |it, _| it.sync = 0),
    fault("sync", Radio, false, |it, _| it.sync = 5),
    fault("reach", Ideal, true, |it, _| {
        it.set("radio-range", "4").unwrap()
    }),
    fault("reach", Radio, true, |it, _| {
        it.set("radio-range", "4").unwrap()
    }),
    fault("sight", Ideal, true, |it, _| {
        it.set("radio-range", "sight").unwrap()
    }),
    fault("sight", Radio, true, |it, _| {
        it.set("radio-range", "sight").unwrap()
    }),
    fault("partition", Ideal, true, |it, _| {
        it.set("partition", "5-60:1").unwrap()
    }),
    fault("partition", Radio, true, |it, _| {
        it.set("partition", "5-60:1").unwrap()
    }),
    fault("duplication", Radio, false, |it, _| {
        it.air.duplication = 0.5
    }),
    fault("delay", Radio, false, |it, _| it.air.delay = 9),
    fault("corruption", Radio, true, |it, _| it.air.corruption = 0.5),
    fault("forging", Radio, false, |it, _| {
        it.set("forge", "3:any").unwrap();
        it.key = Some(Key([7; 16]));
    }),
    fault("death", Ideal, true, |it, tick| {
        it.faults.deaths.push(event(1, tick))
    }),
    fault("death", Radio, true, |it, tick| {
        it.faults.deaths.push(event(1, tick))
    }),
    fault("lateness", Radio, true, |it, tick| {
        it.faults.arrivals.push(event(1, tick))
    }),
    fault("restart", Ideal, true, |it, tick| {
        it.faults.restarts.push(event(1, tick))
    }),
    fault("restart after death", Radio, true, |it, tick| {
        it.faults.deaths.push(event(1, tick / 2));
        it.faults.restarts.push(event(1, tick));
    }),
    fault("going on", Radio, false, |it, tick| {
        it.faults.resumes.push(event(1, 10 * tick))
    }),
];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2))]

    #[test]
    fn no_fault_keeps_a_fleet_from_all_that_there_is(seed in 0u64..1000, tick in 2u32..40) {
        for (world, run) in WORLDS {
            for fault in &FAULTS {
                let ending = run(seed, &|conditions| {
                    conditions.medium = fault.medium;
                    conditions.seed = seed;
                    (fault.set)(conditions, tick);
                });
                let title = format!("{} by {} among {world}: {ending:?}", fault.name, fault.medium);
                prop_assert!(ending.is_complete && ending.has_stopped, "{}", title);
                let first = ending.known[0];
                let agree = ending.known.iter().all(|&known| known == first);
                prop_assert!(fault.is_lossy || agree, "{}", title);
            }
        }
    }
}
