//! Worlds that mislead robots, in whole runs.

use std::sync::Arc;

use clap::ValueEnum;
use host_sim::draw::Coverage;
use host_sim::planners::PlannerKind;
use host_sim::record::grid::Trace;
use host_sim::run::{self, Options, Outcome, RobotOutcome};
use host_sim::scenario::grid::Scenario;
use host_sim::scenario::{ErrorKind, MediumKind, Preset, Trouble};
use host_sim::world::{Family, Starts, World, generate};
use planner_core::{Cell, Extent};
use proptest::prelude::*;

fn scenario(trouble: Trouble) -> Scenario {
    let world = Arc::new(generate(Family::Rooms, 31, 24, 7).unwrap());
    // Where there are three, each is soon out of the others' sight.
    let robots = if trouble.see_robots { 6 } else { 3 };
    let starts = world.place(robots, &Starts::Random(7), false).unwrap();
    let mut scenario = Scenario::new(world, starts, PlannerKind::Explorer);
    scenario.conditions.trouble = trouble;
    scenario
}

fn run(scenario: &Scenario) -> (Outcome, Trace) {
    let options = Options {
        trace: true,
        ..Options::default()
    };
    let (outcome, trace) = run::run(scenario, options).unwrap();
    (outcome, trace.unwrap())
}

#[test]
fn what_robots_get_wrong_is_counted() {
    let (calm, _) = run(&scenario(Trouble::default()));
    assert_eq!((calm.false_claims(), calm.bumps), (0, 0));
    for robot in &calm.robots {
        assert_eq!((robot.cells_closed, robot.cells_opened), (0, 0));
    }
    // Of those who take every look at its word.
    let mut trusting = scenario(Trouble {
        false_walls: 0.2,
        ..Trouble::default()
    });
    trusting.planner = PlannerKind::MinPos;
    let (walled, _) = run(&trusting);
    assert!(walled.violations.is_empty(), "{:?}", walled.violations);
    let is_wrong = |robot: &RobotOutcome| robot.cells_missed > 0 && robot.cells_closed > 0;
    assert!(walled.robots.iter().all(is_wrong), "{:?}", walled.robots);
    assert_eq!(walled.bumps, 0, "no wall was hidden");
    let (opened, _) = run(&scenario(Trouble {
        false_frees: 0.9,
        ..Trouble::default()
    }));
    assert!(opened.bumps > 0 && opened.violations.is_empty());
    let robots = &opened.robots;
    assert!(robots.iter().any(|robot| robot.cells_opened > 0));
}

#[test]
fn a_claim_that_names_the_shut_place_is_no_false_one() {
    let map = "\
################
#......#.......#
#1.............#
#......#.......#
################
";
    let rows: Vec<&[u8]> = map.lines().map(str::as_bytes).collect();
    let blocked = |cell: Cell| rows[cell.y as usize][cell.x as usize] == b'#';
    let world = World::from_fn("rooms", Extent::new(16, 5), blocked).unwrap();
    let world = Arc::new(world);
    let claim = |shut: &str| {
        let starts = vec![Cell::new(1, 2)];
        let mut scenario = Scenario::new(world.clone(), starts, PlannerKind::Explorer);
        scenario.range = 8;
        scenario.conditions.faults.shut = vec![shut.parse().unwrap()];
        let robot = run(&scenario).0.robots[0].clone();
        assert!(
            robot.stop.unwrap().is_complete() && robot.cells_missed > 0,
            "{shut}"
        );
        robot
    };
    // Shut from the second look on, and never seen open.
    let (seen, never) = (claim("7,2@1-4294967295"), claim("7,2"));
    assert_eq!(seen.cells_unnamed, 0);
    assert!(!seen.claims_falsely());
    assert_eq!(never.cells_unnamed, never.cells_missed);
    assert!(never.claims_falsely());
}

#[test]
fn who_expects_errors_is_not_misled_by_a_few() {
    let mut scenario = scenario(Trouble {
        false_walls: 0.01,
        false_frees: 0.01,
        misplaced: 0.01,
        ..Trouble::default()
    });
    scenario.planner = PlannerKind::MinPos;
    assert!(run(&scenario).0.false_claims() > 0);
    scenario.planner = PlannerKind::Explorer;
    scenario.conditions.preset = Preset::Rangers;
    let (outcome, _) = run(&scenario);
    assert_eq!(outcome.false_claims(), 0);
    assert!(outcome.ticks_to_stopped.is_some());
    scenario.planner = PlannerKind::MinPos;
    let error = scenario.check().unwrap_err().to_string();
    assert!(error.starts_with("--preset rangers"), "{error}");
}

/// Each kind alone, and all at once.
fn troubles() -> Vec<Trouble> {
    let none = Trouble::default();
    let errs = Trouble {
        false_walls: 0.05,
        false_frees: 0.05,
        ..none
    };
    let error_kind = ErrorKind::Viewpoint;
    vec![
        errs,
        Trouble { error_kind, ..errs },
        Trouble {
            misplaced: 0.1,
            ..none
        },
        Trouble { drift: 50, ..none },
        Trouble { people: 4, ..none },
        Trouble { doors: 4, ..none },
        Trouble {
            see_robots: true,
            ..none
        },
        Trouble {
            error_kind: ErrorKind::Far,
            misplaced: 0.05,
            drift: 100,
            people: 3,
            doors: 3,
            see_robots: true,
            looks: 3,
            ..errs
        },
    ]
}

#[test]
fn a_world_misleads_in_the_same_way_again_and_in_its_trace() {
    for trouble in troubles() {
        let scenario = scenario(trouble);
        let mut calm = scenario.clone();
        calm.conditions.trouble = Trouble::default();
        let (_, calm) = run(&calm);
        let (outcome, trace) = run(&scenario);
        assert!(trace.records != calm.records, "{trouble}");
        let (again, trace_again) = run(&scenario);
        assert_eq!(again, outcome, "{trouble}");
        assert_eq!(trace_again.records, trace.records, "{trouble}");

        let mut file = Vec::new();
        trace.write(&mut file).unwrap();
        let read = Trace::read(&file[..]).unwrap();
        assert_eq!(read.scenario.conditions, scenario.conditions);
        assert_eq!(Coverage::from(&read).seen, outcome.coverage, "{trouble}");
    }
}

/// Up to 40 % of all that is seen is wrong; people, doors and other robots are in the way.
/// Poses are right: what the proof asks for.
fn trouble() -> impl Strategy<Value = Trouble> {
    let share = || prop_oneof![Just(0.0), 0.0..0.4f64];
    (
        (
            share(),
            share(),
            prop::sample::select(ErrorKind::value_variants()),
        ),
        (0u16..4, 0u16..4, any::<bool>(), 1u8..4),
    )
        .prop_map(
            |((false_walls, false_frees, error_kind), (people, doors, see_robots, looks))| {
                Trouble {
                    false_walls,
                    false_frees,
                    error_kind,
                    people,
                    doors,
                    see_robots,
                    looks,
                    ..Trouble::default()
                }
            },
        )
}

/// A small world that misleads.
fn misled() -> impl Strategy<Value = Scenario> {
    (
        (0..Family::ALL.len(), 8u16..24, 8u16..24, any::<u64>()),
        (1usize..=4, 1u8..=8, any::<bool>()),
        (any::<bool>(), prop_oneof![Just(0.0), 0.0..0.9f64]),
        (trouble(), prop::sample::select(Preset::value_variants())),
    )
        .prop_filter_map(
            "no such world",
            |(
                (family, width, height, seed),
                (robots, range, solid),
                (radio, loss),
                (trouble, preset),
            )| {
                let world = generate(Family::ALL[family], width, height, seed).ok()?;
                let starts = world.place(robots, &Starts::Random(seed), solid).ok()?;
                let mut scenario = Scenario::new(Arc::new(world), starts, PlannerKind::Explorer);
                scenario.range = range;
                scenario.solid = solid;
                let conditions = &mut scenario.conditions;
                conditions.seed = seed;
                conditions.loss = loss;
                conditions.trouble = trouble;
                conditions.preset = preset;
                conditions.max_ticks *= 50;
                if radio {
                    conditions.medium = MediumKind::Radio;
                }
                Some(scenario)
            },
        )
}

/// As many small worlds as `PROPTEST_CASES` says, or these.
fn soak() -> ProptestConfig {
    let asked = std::env::var("PROPTEST_CASES");
    ProptestConfig {
        cases: asked
            .ok()
            .and_then(|cases| cases.parse().ok())
            .unwrap_or(40),
        ..ProptestConfig::default()
    }
}

proptest! {
    #![proptest_config(soak())]

    #[test]
    fn every_misled_robot_stops(scenario in misled()) {
        let (outcome, _) = run::run(&scenario, Options::default()).unwrap();
        prop_assert!(outcome.violations.is_empty(), "{:?}", outcome.violations);
        for (index, robot) in outcome.robots.iter().enumerate() {
            prop_assert!(robot.stop.is_some(), "robot {index} goes on for ever");
        }
    }
}
