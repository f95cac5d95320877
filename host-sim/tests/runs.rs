//! What every run keeps to, whatever the planner.

use std::sync::Arc;

use clap::ValueEnum;
use host_sim::fleet::{Closure, Death, Deed, Faults};
use host_sim::planners::PlannerKind;
use host_sim::run::{self, Options, Outcome, Scenario, ScenarioError, run_compiled};
use host_sim::sensor::Sensor;
use host_sim::trace::Trace;
use host_sim::world::{Family, Starts, World, generate};
use planner_core::{Cell, RobotId};

fn scenario(planner: PlannerKind, family: Family, seed: u64) -> Scenario {
    let world = Arc::new(generate(family, 31, 24, seed).unwrap());
    let starts = world.place(4, &Starts::Random(seed), false).unwrap();
    let mut scenario = Scenario::new(world, starts, planner);
    scenario.seed = seed;
    scenario.loss = 0.25;
    scenario
}

fn traced<'a>() -> Options<'a> {
    Options {
        trace: true,
        ..Options::default()
    }
}

fn run(scenario: &Scenario) -> (Outcome, Trace) {
    let (outcome, trace) = run::run(scenario, traced()).unwrap();
    (outcome, trace.unwrap())
}

#[test]
fn the_same_scenario_gives_the_same_trace_with_any_sensor_and_any_size() {
    for &planner in PlannerKind::value_variants() {
        let scenario = scenario(planner, Family::Cave, 3);
        let (outcome, trace) = run(&scenario);
        let sensor = Arc::new(Sensor::new(scenario.world.clone(), scenario.range));
        for _ in 0..2 {
            let options = Options {
                sensor: Some(sensor.clone()),
                ..traced()
            };
            let (again, trace_again) = run::run(&scenario, options).unwrap();
            assert_eq!(again, outcome, "{planner}");
            assert_eq!(trace_again.unwrap().records, trace.records, "{planner}");
        }
        let (large, large_trace) = run_compiled::<32, 32>(&scenario, traced());
        assert_eq!(large_trace.unwrap().records, trace.records, "{planner}");
        assert_eq!(large, outcome, "{planner}");
    }
}

#[test]
fn another_seed_gives_another_trace() {
    let mut scenario = scenario(PlannerKind::Closest, Family::Rooms, 5);
    let (_, one) = run(&scenario);
    scenario.seed += 1;
    let (_, other) = run(&scenario);
    assert_ne!(one.digest(), other.digest());
}

#[test]
fn the_searching_planners_see_everything_in_every_family() {
    use PlannerKind::{Closest, Explorer, Greedy, MinPos, MinPosStrong};
    for planner in [Explorer, Closest, Greedy, MinPos, MinPosStrong] {
        for family in Family::ALL {
            let scenario = scenario(planner, family, 11);
            let (outcome, _) = run(&scenario);
            assert!(outcome.is_complete(), "{planner} in {family}");
            assert!(outcome.ticks_to_stopped.is_some(), "{planner} in {family}");
            assert_eq!(outcome.seen_cells, outcome.reachable_cells);
            for robot in &outcome.robots {
                assert_eq!(robot.cells_missed, 0, "{planner} in {family}");
                assert!(robot.stop.unwrap().is_complete(), "{planner} in {family}");
            }
        }
    }
}

#[test]
fn coverage_never_falls_and_ends_with_what_was_seen() {
    let (outcome, _) = run(&scenario(PlannerKind::Explorer, Family::Open, 2));
    assert!(outcome.coverage.is_sorted());
    assert_eq!(outcome.coverage.len() as u32, outcome.ticks);
    assert_eq!(outcome.coverage.last(), Some(&outcome.seen_cells));
    let seen = outcome.ticks_to_seen.unwrap() as usize;
    assert_eq!(outcome.coverage[seen], outcome.reachable_cells);
    assert!(outcome.coverage[seen - 1] < outcome.reachable_cells);
    assert!((0.0..=1.0).contains(&outcome.overlap()));
}

#[test]
fn a_dead_robot_leaves_no_more_records_and_the_others_finish() {
    let mut scenario = scenario(PlannerKind::Explorer, Family::Rooms, 4);
    let robot = RobotId(2);
    scenario.faults.deaths = vec![Death { robot, tick: 20 }];
    let (outcome, trace) = run(&scenario);
    let last = trace.records.iter().rev().find(|record| record.robot == 2);
    assert_eq!(last.unwrap().tick, 19);
    assert!(!outcome.robots[2].alive);
    assert!(outcome.is_complete());
    assert!(outcome.ticks_to_stopped.is_some());
}

#[test]
fn a_closed_cell_blocks_until_it_opens() {
    let cell = Cell::new(4, 1);
    let world = World::from_fn("corridor", planner_core::Extent::new(20, 3), |cell| {
        cell.y != 1 || cell.x == 0 || cell.x == 19
    });
    let start = Cell::new(2, 1);
    let mut scenario = Scenario::new(Arc::new(world.unwrap()), vec![start], PlannerKind::Explorer);
    scenario.range = 2;
    scenario.faults = Faults {
        closures: vec![Closure {
            cell,
            from: 0,
            until: 30,
        }],
        ..Faults::default()
    };
    let (outcome, trace) = run(&scenario);
    assert!(outcome.robots[0].blocked_steps > 0);
    let entered = trace.records.iter().find(|record| record.after() == cell);
    assert!(entered.unwrap().tick >= 30);
    assert!(outcome.is_complete());
    assert!(outcome.violations.is_empty());
}

#[test]
fn solid_robots_never_share_a_cell_and_finish_in_a_maze() {
    let world = Arc::new(generate(Family::PerfectMaze, 21, 21, 8).unwrap());
    let starts = world.place(8, &Starts::Corner, true).unwrap();
    let mut scenario = Scenario::new(world, starts, PlannerKind::Explorer);
    scenario.solid = true;
    scenario.loss = 0.5;
    let sensor = Arc::new(Sensor::new(scenario.world.clone(), scenario.range));
    let mut fleet = run::fleet::<4, 4>(&scenario, sensor);
    let mut exchanges = 0;
    while !fleet.has_stopped() {
        fleet.tick();
        assert!(fleet.ticks() < scenario.max_ticks, "a deadlock");
        let mut at: Vec<Cell> = fleet.robots().iter().map(|robot| robot.position).collect();
        at.sort_unstable();
        assert!(at.windows(2).all(|pair| pair[0] != pair[1]));
        exchanges += fleet
            .robots()
            .iter()
            .filter(|robot| matches!(robot.step.unwrap().deed, Deed::Exchanged(_)))
            .count();
    }
    assert!(exchanges > 0);
    assert!(fleet.violations().is_empty());
}

#[test]
fn a_scenario_out_of_range_is_an_error() {
    let good = scenario(PlannerKind::Closest, Family::Open, 1);
    let check = |change: &dyn Fn(&mut Scenario)| {
        let mut scenario = good.clone();
        change(&mut scenario);
        run::run(&scenario, Options::default()).unwrap_err()
    };
    assert_eq!(check(&|s| s.range = 16), ScenarioError::Range(16));
    assert_eq!(
        check(&|s| s.loss = 1.5),
        ScenarioError::Share {
            name: "loss",
            share: 1.5
        }
    );
    assert_eq!(check(&|s| s.starts.clear()), ScenarioError::Robots(0));
    let outside = Cell::new(-1, 0);
    let error = check(&|s| s.starts[1] = outside);
    assert_eq!(
        error,
        ScenarioError::Start {
            robot: 1,
            start: outside
        }
    );
    let error = check(&|s| s.solid = true);
    assert!(matches!(
        error,
        ScenarioError::SharedStart {
            first: 0,
            second: 1,
            ..
        }
    ));
}
