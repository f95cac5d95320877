//! Robots among voxels that have a width, a home, energy, and wind about them.

use host_sim::record::voxels::VoxelTrace;
use host_sim::run::voxels::run;
use host_sim::scenario::voxels::{Planner, Scenario, clearance_for};
use host_sim::scenario::{MediumKind, Wind};
use host_sim::scene::Scene;
use planner_core::Reason;

fn scenario(robots: usize, seed: u64) -> Scenario {
    let mut scenario = Scenario::new(robots, seed);
    scenario.conditions.medium = MediumKind::Radio;
    scenario
}

/// A trace that was written and read is the same.
fn read_again(trace: &VoxelTrace) -> VoxelTrace {
    let mut file = Vec::new();
    trace.write(&mut file).unwrap();
    let read = VoxelTrace::read(&file[..]).unwrap();
    assert_eq!(read.scenario, trace.scenario);
    assert_eq!((&read.ways, &read.seen), (&trace.ways, &trace.seen));
    read
}

/// What bodies of that width can see is seen, and wide ones see less.
#[test]
fn robots_see_what_their_width_allows() {
    let scene = Scene::town(2, 24);
    let seen = [0, 1, 2].map(|clearance| {
        let mut scenario = scenario(2, 1);
        scenario.clearance = clearance;
        let trace = run(&scene, &scenario).unwrap();
        assert!(trace.complete() && trace.all_stopped, "{clearance}");
        assert_eq!(read_again(&trace).violations, 0);
        trace.visible
    });
    assert!(seen[0] >= seen[1] && seen[1] > seen[2], "{seen:?}");
    let clearances = [0.0, 0.5, 0.6, 0.71, 1.5, 2.5, 2.6].map(clearance_for);
    assert_eq!(
        clearances,
        [Some(0), Some(0), Some(1), Some(2), Some(2), Some(3), None]
    );
    let mut wide = scenario(1, 1);
    (wide.range, wide.clearance) = (3, 3);
    let refused = run(&scene, &wide).unwrap_err().to_string();
    assert!(refused.contains("--range 3: expected 4"), "{refused}");
}

/// With energy for part of the survey each robot is home in time; told to go on, it goes on.
#[test]
fn robots_come_home_with_their_energy() {
    for (seed, energy, robots) in [(1, 30, 1), (2, 90, 3), (3, 200, 2), (3, 61, 4)] {
        let mut scenario = scenario(robots, seed);
        scenario.conditions.mission.energy = energy;
        scenario.conditions.mission.come_home = true;
        let trace = run(&Scene::town(seed, 24), &scenario).unwrap();
        assert!(trace.all_stopped && trace.seen.len() as u32 <= energy + 1);
        for (way, stop) in trace.ways.iter().zip(&trace.stops) {
            assert_eq!(way.first(), way.last());
            let reason = stop.unwrap().reason();
            assert!(reason == Reason::Home || reason.is_complete(), "{reason:?}");
        }
        assert_eq!(trace.violations, 0);
    }
    let mut scenario = scenario(1, 1);
    scenario.conditions.mission.energy = 60;
    let once = run(&Scene::town(1, 24), &scenario).unwrap();
    scenario.conditions.faults.resumes = vec!["0@100".parse().unwrap()];
    let twice = run(&Scene::town(1, 24), &scenario).unwrap();
    assert_eq!(twice.stops[0].unwrap().reason(), Reason::Home);
    assert!(twice.seen.last() > once.seen.last());
    scenario.planner = Planner::Greedy;
    let refused = run(&Scene::town(1, 24), &scenario).unwrap_err().to_string();
    assert!(refused.contains("--energy"), "{refused}");
}

/// In wind everything is seen all the same, nothing is flown into, and the way home is found.
#[test]
fn wind_keeps_nobody_from_seeing_all() {
    let mut contacts = 0;
    for (seed, deviation) in [(1, 0.25), (2, 0.3), (3, 0.4)] {
        let mut scenario = scenario(2, seed);
        scenario.conditions.wind = Wind { deviation };
        scenario.conditions.mission.come_home = true;
        let trace = run(&Scene::town(seed, 24), &scenario).unwrap();
        assert!(
            trace.complete() && trace.all_stopped,
            "{seed}: {:?}",
            trace.stops
        );
        for (way, stop) in trace.ways.iter().zip(&trace.stops) {
            assert!(stop.unwrap().is_complete());
            assert_eq!(way.first(), way.last());
            assert!(way.iter().all(|at| !trace.scene.is_solid(*at)));
        }
        contacts += trace.contacts;
        assert_eq!(read_again(&trace).contacts, trace.contacts);
        assert_eq!(
            run(&trace.scene, &scenario).unwrap().digest(),
            trace.digest()
        );
        println!(
            "{seed}: {} ticks, {} contacts",
            trace.seen.len(),
            trace.contacts
        );
    }
    assert!(contacts > 0);
    let mut scenario = scenario(1, 1);
    scenario.conditions.wind = Wind { deviation: 1.5 };
    let refused = run(&Scene::town(1, 24), &scenario).unwrap_err().to_string();
    assert!(refused.contains("--wind 1.5: expected 0 to 1"), "{refused}");
}
