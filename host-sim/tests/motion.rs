//! Explorations by bodies that move in metres and seconds.

use std::sync::Arc;

use assert_cmd::Command;
use host_sim::planners::PlannerKind;
use host_sim::record::grid::Trace;
use host_sim::robot::Touches;
use host_sim::run::{self, Options, Outcome};
use host_sim::scenario::grid::Scenario;
use host_sim::scenario::{Drive, Motion, ScenarioError};
use host_sim::world::{Family, Starts, World, generate};
use planner_core::{Cell, Extent, Stop};
use proptest::prelude::*;
use serde_json::Value;

fn explore(scenario: &Scenario) -> (Outcome, Trace) {
    let options = Options {
        trace: true,
        ..Options::default()
    };
    let (outcome, trace) = run::run(scenario, options).unwrap();
    (outcome, trace.unwrap())
}

fn scenario(world: World, robots: usize, drive: Drive, clearance: u8) -> Scenario {
    let world = Arc::new(world);
    let starts = match clearance {
        0 => world.place(robots, &Starts::Random(1), true),
        _ => world.place_bodies(robots, &Starts::Spread(1), clearance),
    };
    let mut scenario = Scenario::new(world, starts.unwrap(), PlannerKind::Explorer);
    scenario.solid = true;
    scenario.clearance = clearance;
    scenario.move_in_metres(Some(Motion::new(drive, 0.5, clearance)));
    scenario
}

fn touches(outcome: &Outcome) -> Touches {
    let each = outcome.robots.iter().map(|robot| robot.driven.touches);
    each.fold(Touches::default(), |sum, of| Touches {
        walls: sum.walls + of.walls,
        bodies: sum.bodies + of.bodies,
    })
}

fn drive() -> impl Strategy<Value = Drive> {
    prop_oneof![Just(Drive::DiffDrive), Just(Drive::Omni)]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    /// Whatever the place and the body: all is seen, nothing is touched, and the trace can be
    /// read and run again.
    #[test]
    fn bodies_explore_everything_and_touch_nothing(
        family in 0..Family::ALL.len(), seed in any::<u64>(), robots in 1usize..4,
        drive in drive(), width in 0.1..0.48f64, speed in 0.1..1.0f64,
        acceleration in 0.2..3.0f64, tick_ms in 40u16..250, range in 2u8..7,
    ) {
        let world = generate(Family::ALL[family], 22, 17, seed).unwrap();
        let mut scenario = scenario(world, robots, drive, 0);
        scenario.range = range;
        scenario.conditions.seed = seed;
        scenario.move_in_metres(Some(Motion {
            radius: width * 0.5,
            speed,
            acceleration,
            tick_ms,
            ..Motion::new(drive, 0.5, 0)
        }));
        let (outcome, trace) = explore(&scenario);
        prop_assert_eq!(touches(&outcome), Touches::default());
        prop_assert!(outcome.is_complete(), "{} of {} cells seen: {:?}", outcome.seen_cells, outcome.reachable_cells, { outcome.robots.iter() }.map(|robot| robot.stop).collect::<Vec<_>>());
        prop_assert!(outcome.ticks_to_stopped.is_some());
        for robot in &outcome.robots {
            prop_assert!(robot.stop.is_some_and(|stop| stop.is_complete()), "{:?}", robot.stop);
            prop_assert!(!robot.claims_falsely());
            let cells = f64::from(robot.steps) * 500.0;
            // A straight way through corners is shorter than by √2 at most.
            let metres = f64::from(robot.driven.millimetres);
            prop_assert!(metres >= cells / 1.5 - 1000.0, "{metres} mm, {cells} by cells");
        }
        let mut file = Vec::new();
        trace.write(&mut file).unwrap();
        let read = Trace::read(&file[..]).unwrap();
        prop_assert_eq!(&read.records, &trace.records);
        prop_assert_eq!(read.scenario.motion, scenario.motion);
        let (again, _) = explore(&read.scenario);
        prop_assert_eq!(again, outcome);
    }
}

/// Bodies wider than a cell, in places made so many times as large.
#[test]
fn wide_bodies_touch_nothing() {
    for (clearance, family, robots, drive) in [
        (1, Family::Rooms, 1, Drive::DiffDrive),
        (1, Family::Cave, 3, Drive::Omni),
        (2, Family::Rooms, 2, Drive::DiffDrive),
        (3, Family::IsolatedBlocks, 2, Drive::Omni),
    ] {
        let small = generate(family, 16, 12, 7).unwrap();
        let zoom = 2 * i16::from(clearance) + 1;
        let extent = Extent::new(16 * zoom as u16, 12 * zoom as u16);
        let is_blocked = |cell: Cell| !small.is_free(Cell::new(cell.x / zoom, cell.y / zoom));
        let world = World::from_fn("wide", extent, is_blocked).unwrap();
        let scenario = scenario(world, robots, drive, clearance);
        let (outcome, _) = explore(&scenario);
        let what = format!("{clearance} in {family}, {robots}");
        assert_eq!(touches(&outcome), Touches::default(), "{what}");
        assert!(outcome.ticks_to_stopped.is_some(), "{what}");
        assert!(outcome.ticks_to_seen.is_some() || robots > 1, "{what}");
        for robot in &outcome.robots {
            let stop = robot.stop.expect("all have stopped");
            let is_held = matches!(stop, Stop::Held { .. }) && robots > 1;
            assert!(stop.is_complete() || is_held, "{what}: {stop}");
        }
    }
}

#[test]
fn straight_ways_are_shorter_than_ways_by_cells() {
    let world = generate(Family::Open, 40, 40, 3).unwrap();
    let scenario = scenario(world, 1, Drive::DiffDrive, 0);
    let (outcome, _) = explore(&scenario);
    let robot = &outcome.robots[0];
    let by_cells = f64::from(robot.steps) * 0.5;
    let metres = f64::from(robot.driven.millimetres) / 1e3;
    assert!(
        metres < 0.94 * by_cells,
        "{metres} m, {by_cells} m by cells"
    );
    assert!(robot.driven.milliturns > 0);
    let seconds = f64::from(outcome.ticks) * 0.1;
    assert!(seconds > metres / 0.22, "{seconds} s for {metres} m");
}

/// Slip and drift lead bodies into walls. They say so, and nothing breaks.
#[test]
fn bodies_that_drift_touch_walls_and_are_counted() {
    let world = generate(Family::Rooms, 30, 30, 5).unwrap();
    let mut scenario = scenario(world, 2, Drive::Omni, 0);
    let motion = scenario.motion.unwrap();
    scenario.move_in_metres(Some(Motion {
        slip: 0.1,
        odometry_error: 0.05,
        ..motion
    }));
    scenario.conditions.max_ticks = 6000;
    let (outcome, trace) = explore(&scenario);
    assert!(touches(&outcome).walls > 0);
    assert_eq!(explore(&scenario).1.digest(), trace.digest());
    scenario.conditions.seed += 1;
    assert_ne!(explore(&scenario).1.digest(), trace.digest());
}

#[test]
fn what_does_not_go_together_is_refused() {
    let world = generate(Family::Rooms, 20, 20, 5).unwrap();
    let good = scenario(world, 1, Drive::DiffDrive, 0);
    assert_eq!(good.check(), Ok(()));
    let refused = |change: &dyn Fn(&mut Scenario, &mut Motion)| {
        let mut bad = good.clone();
        let mut motion = good.motion.unwrap();
        change(&mut bad, &mut motion);
        bad.motion = Some(motion);
        match bad.check() {
            Err(ScenarioError::Setting { option, .. }) => option,
            Err(ScenarioError::NotInMotion(option)) => option,
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(refused(&|_, motion| motion.radius = 0.25), "radius");
    assert_eq!(refused(&|_, motion| motion.radius = f64::NAN), "radius");
    assert_eq!(refused(&|_, motion| motion.speed = 0.0), "speed");
    assert_eq!(refused(&|_, motion| motion.tick_ms = 5), "tick-ms");
    // Half a cell is passed in a quarter of a second.
    let fast = |_: &mut Scenario, motion: &mut Motion| {
        motion.speed = 1.0;
        motion.tick_ms = 251;
    };
    assert_eq!(refused(&fast), "tick-ms");
    assert_eq!(refused(&|_, motion| motion.slip = 1.5), "slip");
    assert_eq!(refused(&|of, _| of.fov = 90), "fov");
    assert_eq!(refused(&|of, _| of.conditions.mission.energy = 9), "energy");
    assert_eq!(refused(&|of, _| of.conditions.trouble.people = 1), "people");
}

/// Exit status, what was printed, and what was said of errors.
fn host_sim(options: &[&str]) -> (Option<i32>, String, String) {
    let folder = tempfile::tempdir().unwrap();
    let rooms = "########\n#1.#...#\n#..#...#\n#......#\n########\n";
    std::fs::write(folder.path().join("rooms.txt"), rooms).unwrap();
    let mut command = Command::cargo_bin("host-sim").unwrap();
    command.current_dir(folder.path());
    let output = command.args(["explore", "rooms.txt", "--robots=2"]);
    let output = output.args(options).output().unwrap();
    let [out, err] = [output.stdout, output.stderr].map(|text| String::from_utf8(text).unwrap());
    (output.status.code(), out, err)
}

#[test]
fn the_command_tells_metres_turns_seconds_and_touches() {
    let (status, words, _) = host_sim(&["--motion=diff-drive"]);
    assert_eq!(status, Some(0));
    for word in [
        "diff-drive at 0.22 m/s",
        " s, every robot done",
        " m, ",
        "full turns",
        "touched",
    ] {
        assert!(words.contains(word), "{word}: {words}");
    }
    let (_, json, _) = host_sim(&["--motion=omni", "--speed=0.3", "--cell=0.4", "--json"]);
    let summary: Value = serde_json::from_str(&json).unwrap();
    let motion = &summary["motion"];
    assert_eq!(
        (&motion["drive"], &motion["speed"]),
        (&"omni".into(), &0.3.into())
    );
    assert_eq!(
        (&motion["cell"], &motion["radius"]),
        (&0.4.into(), &0.16000000000000003.into())
    );
    assert!(motion["seconds_to_seen"].as_f64() > Some(3.0));
    assert!(motion["metres"].as_f64() > Some(1.0) && motion["turns"] == 0.0);
    assert_eq!(
        motion["touches"],
        serde_json::json!({ "walls": 0, "bodies": 0 })
    );
    assert!(summary["robots"][0]["metres"].is_f64());
    let (_, json, _) = host_sim(&["--json"]);
    let summary: Value = serde_json::from_str(&json).unwrap();
    assert!(summary.get("motion").is_none() && summary["robots"][0].get("metres").is_none());
}

#[test]
fn the_command_says_what_to_do_instead() {
    for (options, words) in [
        (&["--speed=0.3"][..], &["--speed", "choose --motion"][..]),
        (
            &["--motion=omni", "--turn-rate=1"],
            &["--turn-rate", "leave it out"],
        ),
        (&["--motion=omni", "--people=1"], &["--people", "leave one"]),
        (
            &["--motion=omni", "--radius=0.3"],
            &["--radius 0.3", "0.240 metres", "larger"],
        ),
        (
            &["--motion=omni", "--speed=-1"],
            &["--speed", "more than 0"],
        ),
        (
            &["--motion=diff-drive", "--tick-ms=2000"],
            &["--tick-ms", "10 to 1000"],
        ),
    ] {
        let (status, _, error) = host_sim(options);
        assert_eq!(status, Some(2), "{options:?}");
        for word in words {
            assert!(error.contains(word), "{options:?}: {error}");
        }
    }
}
