//! What every run keeps to, whatever the planner.

mod turning;

use std::sync::Arc;

use clap::ValueEnum;
use host_sim::draw;
use host_sim::planners::PlannerKind;
use host_sim::record::grid::Trace;
use host_sim::robot::{Deed, Touches};
use host_sim::run::{self, Options, Outcome, run_compiled};
use host_sim::scenario::ScenarioError;
use host_sim::scenario::grid::Scenario;
use host_sim::scenario::{CellSpan, Event, Faults, RobotSpan};
use host_sim::sensor::Sensor;
use host_sim::world::{Family, Starts, World, generate};
use planner_core::{Cell, Extent, Reason, RobotId, Stop};

fn scenario(planner: PlannerKind, family: Family, seed: u64) -> Scenario {
    let world = Arc::new(generate(family, 31, 24, seed).unwrap());
    let starts = world.place(4, &Starts::Random(seed), false).unwrap();
    let mut scenario = Scenario::new(world, starts, planner);
    scenario.conditions.seed = seed;
    scenario.conditions.loss = 0.25;
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
    scenario.conditions.seed += 1;
    let (_, other) = run(&scenario);
    assert_ne!(one.digest(), other.digest());
}

#[test]
fn the_searching_planners_see_everything_in_every_family() {
    use PlannerKind::{Closest, Explorer, Greedy, MinPos, MinPosStrong, Utility};
    for planner in [Explorer, Closest, Greedy, MinPos, MinPosStrong, Utility] {
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
    scenario.conditions.faults.deaths = vec![Event { robot, tick: 20 }];
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
    scenario.conditions.faults = Faults {
        closures: vec![CellSpan {
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
    scenario.conditions.loss = 0.5;
    let sensor = Arc::new(Sensor::new(scenario.world.clone(), scenario.range));
    let mut fleet = run::fleet::<4, 4>(&scenario, sensor);
    let mut exchanges = 0;
    while !fleet.has_stopped() {
        fleet.tick();
        assert!(fleet.ticks() < scenario.conditions.max_ticks, "a deadlock");
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
fn a_robot_without_a_pose_learns_nothing_and_goes_on_afterwards() {
    for &planner in PlannerKind::value_variants() {
        // It has its tests in tests/completeness.rs.
        if planner == PlannerKind::Explorer {
            continue;
        }
        let mut scenario = scenario(planner, Family::Rooms, 4);
        scenario.conditions.sync = 0;
        scenario.conditions.faults.lost_poses = (0..4)
            .map(|robot| RobotSpan {
                robot: RobotId(robot),
                from: 3,
                until: 20,
            })
            .collect();
        let mut running = run::open(&scenario, None).unwrap();
        let mut known = Vec::new();
        for tick in 0..22 {
            let before: Vec<_> = (0..4).map(|id| running.robot(id).known_cells).collect();
            running.tick();
            let moved = |id| matches!(running.robot(id).step.unwrap().deed, Deed::Moved(_));
            if (3..20).contains(&tick) {
                assert!(!(0..4).any(moved), "{planner} in tick {tick}");
                let now: Vec<_> = (0..4).map(|id| running.robot(id).known_cells).collect();
                assert_eq!(now, before, "{planner} in tick {tick}");
            } else {
                known.push((0..4).any(moved));
            }
        }
        assert!(known[3..].iter().any(|&moved| moved), "{planner}");
    }
}

#[test]
fn what_no_look_shows_counts_as_unseen() {
    let world = World::from_fn("corridor", planner_core::Extent::new(12, 3), |cell| {
        cell.y != 1 || cell.x == 0 || cell.x == 11
    });
    let start = Cell::new(2, 1);
    let mut scenario = Scenario::new(Arc::new(world.unwrap()), vec![start], PlannerKind::Explorer);
    scenario.conditions.max_ticks = 300;
    let mut outcome = |faults: Faults| {
        scenario.conditions.faults = faults;
        run(&scenario).0
    };
    let glass = |cell| Faults {
        blind: vec![CellSpan {
            cell,
            from: 0,
            until: u32::MAX,
        }],
        ..Faults::default()
    };
    // Of a wall's cell nobody knows; all free cells are seen.
    let wall = outcome(glass(Cell::new(5, 0)));
    assert_eq!((wall.seen_cells, wall.ticks_to_seen.is_some()), (10, true));
    let silent = outcome(Faults {
        sensor_failures: vec![Event {
            robot: RobotId(0),
            tick: 0,
        }],
        ..Faults::default()
    });
    assert_eq!(silent.ticks_to_seen, None);
    assert_eq!(silent.robots[0].cells_missed, 9);
}

#[test]
fn a_run_goes_on_when_a_robot_is_told_to_and_ends_anew() {
    let mut scenario = scenario(PlannerKind::Closest, Family::Rooms, 9);
    let (before, trace) = run(&scenario);
    let end = before.ticks;
    scenario.conditions.faults.resumes = vec![Event {
        robot: RobotId(1),
        tick: end + 5,
    }];
    let (outcome, again) = run(&scenario);
    assert!(again.records.starts_with(&trace.records));
    assert_eq!(outcome.ticks, end + 6);
    assert!(outcome.robots.iter().all(|robot| robot.stop.is_some()));
}

#[test]
fn a_scenario_out_of_range_is_an_error() {
    let good = scenario(PlannerKind::Closest, Family::Open, 1);
    let check = |change: &dyn Fn(&mut Scenario)| {
        let mut scenario = good.clone();
        change(&mut scenario);
        run::run(&scenario, Options::default()).unwrap_err()
    };
    let says = |change: &dyn Fn(&mut Scenario), words: &str| {
        let error = check(change).to_string();
        assert!(error.starts_with(words), "{error}");
    };
    says(&|s| s.range = 32, "--range 32: expected 1 to 31");
    says(&|s| s.conditions.loss = 1.5, "--loss 1.5: expected a share");
    says(&|s| s.starts.clear(), "--robots 0: expected 1 to 255");
    says(&|s| s.fov = 361, "--fov 361: expected 1 to 360");
    // What only frames have, by name.
    says(
        &|s| s.conditions.air.delay = 1,
        "--delay only works on frames",
    );
    let nobody = Event::from((4, 9));
    let kill = |s: &mut Scenario| s.conditions.faults.deaths.push(nobody);
    says(&kill, "--kill: there is no robot 4");
    let error = check(&|s| s.fov = 180);
    assert_eq!(
        error,
        ScenarioError::NeverTurns {
            planner: PlannerKind::Closest,
            fov: 180
        }
    );
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

/// Bodies touch nothing, sweep everything, and where one gives up it names another.
#[test]
fn bodies_of_every_size_explore_halls_and_caves() {
    for (clearance, family, robots) in [
        (1, Family::Rooms, 1),
        (1, Family::Cave, 3),
        (2, Family::Rooms, 1),
        (2, Family::Rooms, 3),
        (2, Family::Cave, 1),
        (3, Family::IsolatedBlocks, 2),
    ] {
        let small = generate(family, 31, 24, 7).unwrap();
        // Each cell becomes so many that doors are wide enough.
        let zoom = 2 * i16::from(clearance) + 1;
        let extent = Extent::new(31 * zoom as u16, 24 * zoom as u16);
        let is_blocked = |cell: Cell| !small.is_free(Cell::new(cell.x / zoom, cell.y / zoom));
        let world = Arc::new(World::from_fn("wide", extent, is_blocked).unwrap());
        let starts = world.place_bodies(robots, &Starts::Spread(1), clearance);
        let mut scenario = Scenario::new(world, starts.unwrap(), PlannerKind::Explorer);
        scenario.clearance = clearance;
        let (outcome, _) = run(&scenario);
        let what = format!("{clearance} in {family}, {robots}");
        assert_eq!(outcome.touches, Touches::default(), "{what}");
        // Bodies in one another's way may leave something, and say so.
        assert!(outcome.is_complete() || robots > 1, "{what}");
        assert!(outcome.ticks_to_stopped.is_some(), "{what}");
        for robot in &outcome.robots {
            let stop = robot.stop.expect("all have stopped");
            let is_held = matches!(stop, Stop::Held { .. }) && robots > 1;
            assert!(stop.is_complete() || is_held, "{what}: {stop}");
            assert!(!robot.claims_falsely(), "{what}: {stop}");
        }
    }
}

#[test]
fn bodies_start_where_they_have_room() {
    let world = Arc::new(generate(Family::Rooms, 31, 24, 7).unwrap());
    let first = world.free_cells().next().unwrap();
    let mut scenario = Scenario::new(world.clone(), vec![first], PlannerKind::Explorer);
    scenario.clearance = 1;
    assert!(matches!(
        scenario.check(),
        Err(ScenarioError::NoRoomAtStart { robot: 0, .. })
    ));
    let together = world.place_bodies(2, &Starts::Center, 1).unwrap();
    scenario.starts = together.clone();
    assert!(scenario.check().is_ok());
    scenario.starts = vec![together[0]; 2];
    assert!(matches!(
        scenario.check(),
        Err(ScenarioError::TouchingStarts {
            first: 0,
            second: 1,
            apart: 3
        })
    ));
    scenario.starts = together;
    scenario.range = 2;
    assert!(
        scenario
            .check()
            .unwrap_err()
            .to_string()
            .contains("--range")
    );
    scenario.planner = PlannerKind::Closest;
    assert!(matches!(
        scenario.check(),
        Err(ScenarioError::NoBody { .. })
    ));
    assert!(world.place_bodies(1, &Starts::At(vec![first]), 1).is_err());
    assert!(world.place_bodies(90, &Starts::Center, 1).is_err());
}

#[test]
fn robots_that_have_explored_come_home_and_nobody_else_can() {
    for solid in [false, true] {
        let mut scenario = scenario(PlannerKind::Explorer, Family::Rooms, 5);
        scenario.solid = solid;
        scenario.conditions.mission.come_home = true;
        scenario.starts.dedup();
        let (outcome, _) = run(&scenario);
        assert!(outcome.is_complete());
        let mut robots = outcome.robots.iter();
        assert!(robots.all(|robot| robot.is_home), "{:?}", outcome.robots);
    }
    for &planner in PlannerKind::value_variants() {
        let mut scenario = scenario(planner, Family::Rooms, 5);
        scenario.conditions.mission.come_home = true;
        let refused = ScenarioError::NeverHome {
            option: "come-home",
            planner,
        };
        let expected = match planner {
            PlannerKind::Explorer => Ok(()),
            _ => Err(refused),
        };
        assert_eq!(scenario.check(), expected);
    }
}

#[test]
fn robots_come_home_with_their_energy_and_go_on_with_more() {
    let mut scenario = scenario(PlannerKind::Explorer, Family::Cave, 7);
    scenario.conditions.mission.energy = 20;
    scenario.conditions.mission.come_home = true;
    let (outcome, trace) = run(&scenario);
    assert!(!outcome.is_complete());
    for robot in &outcome.robots {
        assert!(robot.is_home && robot.steps <= 20, "{robot:?}");
        let stop = robot.stop.map(|stop| stop.reason());
        assert_eq!(stop, Some(Reason::Home));
    }
    let last = trace.records.last().expect("there are records").tick;
    let go_on = |id| Event {
        robot: RobotId(id),
        tick: last,
    };
    scenario.conditions.faults.resumes = (0..4).map(go_on).collect();
    let (later, _) = run(&scenario);
    let more = later.robots.iter().zip(&outcome.robots);
    for (later, before) in more {
        assert!(later.is_home && later.steps <= before.steps + 20);
    }
    assert!(later.seen_cells > outcome.seen_cells);
}

#[test]
fn a_sensor_that_reaches_farther_shows_more_and_all_is_seen() {
    for planner in [PlannerKind::Explorer, PlannerKind::Utility] {
        let at_once = [15, 31].map(|range| {
            let world = Arc::new(generate(Family::Open, 96, 96, 5).unwrap());
            let starts = world.place(1, &Starts::Random(5), false).unwrap();
            let mut scenario = Scenario::new(world, starts, planner);
            scenario.range = range;
            let (outcome, trace) = run(&scenario);
            assert!(outcome.is_complete(), "{planner}");
            let mut shown = draw::Replay::new(&trace);
            while shown.tick() {}
            assert_eq!(shown.seen_cells(), outcome.seen_cells);
            outcome.coverage[0]
        });
        assert!(at_once[0] < at_once[1], "{planner}: {at_once:?}");
    }
}

#[test]
fn a_long_range_is_refused_where_it_would_not_count() {
    let refused = |change: &dyn Fn(&mut Scenario)| {
        let mut scenario = scenario(PlannerKind::Explorer, Family::Cave, 3);
        scenario.range = 16;
        change(&mut scenario);
        scenario.check().unwrap_err().to_string()
    };
    let far = refused(&|scenario| scenario.range = 32);
    assert_eq!(far, "--range 32: expected 1 to 31 cells");
    let errs = refused(&|scenario| scenario.conditions.trouble.false_walls = 0.1);
    assert_eq!(
        errs,
        "--range 16: expected 1 to 15 cells where looks or poses err"
    );
    let near = refused(&|scenario| scenario.planner = PlannerKind::Bmilrv);
    assert!(near.contains("takes in at most 15 cells"), "{near}");
}
