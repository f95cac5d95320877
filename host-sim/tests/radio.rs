//! Runs over the radio medium, and what their summaries say of it.

use std::sync::Arc;

use host_sim::experiments::ghosts::{Attack, one_robot, sensor, three_robots};
use host_sim::planners::PlannerKind;
use host_sim::record::grid::Trace;
use host_sim::run::{Options, RobotOutcome, run};
use host_sim::scenario::grid::Scenario;
use host_sim::scenario::{Event, Faults};
use host_sim::scenario::{Forger, Forgery, MediumKind, Reach};
use host_sim::summary::Summary;
use host_sim::world::{Family, Starts, generate};
use planner_core::RobotId;
use planner_core::radio::Key;

fn scenario(robots: usize) -> Scenario {
    let world = Arc::new(generate(Family::Rooms, 40, 40, 3).unwrap());
    let starts = world.place(robots, &Starts::Center, false).unwrap();
    let mut scenario = Scenario::new(world, starts, PlannerKind::Explorer);
    scenario.conditions.medium = MediumKind::Radio;
    scenario
}

fn summary(scenario: &Scenario) -> (Summary, Trace) {
    let options = Options {
        trace: true,
        ..Options::default()
    };
    let (outcome, trace) = run(scenario, options).unwrap();
    let trace = trace.unwrap();
    (Summary::new(scenario, &outcome, trace.digest()), trace)
}

#[test]
fn what_is_sent_stands_in_the_summary_and_in_the_trace() {
    let (summary, trace) = summary(&scenario(3));
    assert!(summary.head.complete && summary.maps_agree);
    for (robot, id) in summary.robots.iter().zip(0..) {
        let sent = trace.records.iter().filter(|record| record.robot == id);
        let bytes: u32 = sent.clone().map(|record| record.sent.bytes).sum();
        let frames: u32 = sent.map(|record| record.sent.frames).sum();
        assert_eq!((robot.frames_sent, robot.bytes_sent), (frames, bytes));
        assert_eq!(frames, summary.head.ticks, "one frame a tick");
        assert!((16 * frames..=52 * frames).contains(&bytes));
    }
}

#[test]
fn every_planner_explores_over_the_radio_and_hears_the_others() {
    for planner in [
        PlannerKind::Explorer,
        PlannerKind::Closest,
        PlannerKind::Greedy,
        PlannerKind::MinPos,
        PlannerKind::MinPosStrong,
    ] {
        let mut scenario = scenario(4);
        scenario.planner = planner;
        let (together, _) = summary(&scenario);
        assert!(together.head.complete, "{planner}");
        scenario.conditions.sync = 0;
        let (alone, _) = summary(&scenario);
        assert_eq!(alone.robots[0].frames_sent, 0);
        let steps = |summary: &Summary| -> u32 { summary.robots.iter().map(|of| of.steps).sum() };
        assert!(steps(&together) < steps(&alone) * 2 / 3, "{planner}");
    }
}

#[test]
fn the_budget_and_the_interval_limit_what_is_sent() {
    let mut scenario = scenario(2);
    scenario.conditions.byte_budget = 10;
    let (summary_of_10, _) = summary(&scenario);
    for robot in &summary_of_10.robots {
        assert!(robot.frames_sent > 0 && robot.bytes_sent <= 10 * summary_of_10.head.ticks);
    }
    scenario.conditions.byte_budget = 55;
    scenario.conditions.sync = 4;
    let (every_fourth, _) = summary(&scenario);
    let frames = every_fourth.head.ticks.div_ceil(4);
    assert!(
        every_fourth
            .robots
            .iter()
            .all(|robot| robot.frames_sent == frames)
    );
}

#[test]
fn the_summary_says_why_maps_differ() {
    let late = Event {
        robot: RobotId(1),
        tick: 59,
    };
    let why = |change: &dyn Fn(&mut Scenario)| {
        let mut scenario = scenario(3);
        // From one start, robots that hear nothing all walk the same way; and in
        // the end all know the whole world, whatever they were told.
        scenario.starts = scenario.world.free_cells().step_by(300).take(3).collect();
        scenario.conditions.max_ticks = 60;
        change(&mut scenario);
        let (summary, _) = summary(&scenario);
        assert!(!summary.maps_agree);
        assert!(summary.robots.iter().any(|robot| robot.cells_unheard > 0));
        summary.maps_differ_because.unwrap()
    };
    assert!(why(&|s| s.conditions.byte_budget = 0).contains("never spoke"));
    assert!(why(&|s| s.conditions.air.reach = Reach::Cells(1)).contains("reach"));
    assert!(why(&|s| s.conditions.loss = 1.0).contains("lost"));
    assert!(why(&|s| s.conditions.faults.arrivals = vec![late]).contains("ended before"));
}

#[test]
fn late_robots_and_restarted_ones_learn_by_radio_what_they_missed() {
    let mut scenario = scenario(3);
    scenario.conditions.faults = Faults {
        arrivals: vec![Event {
            robot: RobotId(2),
            tick: 120,
        }],
        restarts: vec![Event {
            robot: RobotId(0),
            tick: 150,
        }],
        ..Faults::default()
    };
    let (summary, trace) = summary(&scenario);
    let of = |id| {
        trace
            .records
            .iter()
            .filter(move |record| record.robot == id)
    };
    assert_eq!(of(2).next().unwrap().tick, 120);
    let known = |tick| of(0).find(|record| record.tick == tick).unwrap().known;
    assert!(
        known(149) > 500 && known(150) < 300,
        "{} {}",
        known(149),
        known(150)
    );
    assert!(known(190) > known(149), "told again by the others");
    assert!(summary.head.complete && summary.head.ticks > 150);
    for robot in &summary.robots {
        assert_eq!(robot.cells_missed, 0);
    }
}

/// Small worlds and everything that a forger does, with and without a key.
fn forged() -> impl Iterator<Item = Scenario> {
    let kinds = Forgery::HINTS.into_iter().chain([Forgery::Any]);
    kinds.zip(Family::ALL).flat_map(|(kind, family)| {
        let world = Arc::new(generate(family, 24, 24, 5).unwrap());
        let starts = world.place(3, &Starts::Random(5), false).unwrap();
        [None, Some(Key([9; 16]))].map(|key| {
            let mut scenario = Scenario::new(world.clone(), starts.clone(), PlannerKind::Explorer);
            scenario.conditions.medium = MediumKind::Radio;
            scenario.conditions.loss = 0.2;
            scenario.conditions.key = key;
            scenario.conditions.air.forger = Some(Forger { frames: 3, kind });
            scenario
        })
    })
}

fn digest(scenario: &Scenario) -> String {
    let options = Options {
        trace: true,
        ..Options::default()
    };
    run(scenario, options).unwrap().1.unwrap().digest()
}

#[test]
fn a_forger_without_the_key_changes_nothing() {
    for mut scenario in forged().filter(|scenario| scenario.conditions.key.is_some()) {
        let among_forgers = digest(&scenario);
        let forger = scenario.conditions.air.forger.take();
        assert_eq!(digest(&scenario), among_forgers, "{forger:?}");
    }
}

#[test]
fn without_a_key_every_robot_stops_and_hints_leave_nothing_out() {
    for scenario in forged().filter(|scenario| scenario.conditions.key.is_none()) {
        let outcome = run(&scenario, Options::default()).unwrap().0;
        let forger = scenario.conditions.air.forger.unwrap();
        assert!(outcome.violations.is_empty());
        assert!(
            outcome.robots.iter().all(|robot| robot.stop.is_some()),
            "{forger:?}"
        );
        if forger.kind != Forgery::Any {
            assert!(outcome.is_complete(), "{forger:?}");
            let missed = |robot: &RobotOutcome| robot.cells_missed;
            assert!(
                outcome.robots.iter().all(|robot| missed(robot) == 0),
                "{forger:?}"
            );
        }
    }
}

/// A smaller `cargo run --release -p host-sim --example ghosts`.
#[test]
fn what_hints_cost_is_bounded() {
    for attack in Attack::all() {
        let mut ratios = Vec::new();
        for family in Family::ALL {
            let world = Arc::new(generate(family, 40, 40, 3).unwrap());
            let sensor = sensor(&world);
            let alone = one_robot(&world, &sensor).unwrap().unwrap();
            let three = three_robots(&world, &sensor, Some(attack))
                .unwrap()
                .unwrap();
            let ratio = f64::from(three) / f64::from(alone);
            assert!(ratio <= 1.3, "{attack} in {family}: {ratio}");
            ratios.push(ratio);
        }
        let mean = ratios.iter().sum::<f64>() / ratios.len() as f64;
        assert!(mean <= 1.1, "{attack}: {mean}");
    }
}
