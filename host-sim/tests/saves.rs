//! Fleets that are saved, and go on.

use std::sync::Arc;

use host_sim::draw::Coverage;
use host_sim::planners::PlannerKind;
use host_sim::record::grid::Trace;
use host_sim::run::{self, Options, Outcome, Stepping};
use host_sim::scenario::grid::Scenario;
use host_sim::scenario::{Save, SaveError, ScenarioError};
use host_sim::world::{Family, Starts, World, generate};

fn scenario(seed: u64, robots: usize) -> Scenario {
    let world = Arc::new(generate(Family::Rooms, 40, 40, seed).unwrap());
    let starts = world.place(robots, &Starts::Center, false).unwrap();
    Scenario::new(world, starts, PlannerKind::Explorer)
}

/// What came of a run, its trace, and what its planners then know.
fn run(scenario: &Scenario) -> (Outcome, Trace, Save) {
    let mut save = None;
    let mut ended = |run: &dyn Stepping| save = run.save();
    let options = Options {
        trace: true,
        ended: Some(&mut ended),
        ..Options::default()
    };
    let (outcome, trace) = run::run(scenario, options).unwrap();
    (outcome, trace.unwrap(), save.unwrap())
}

/// The scenario from a save on.
fn from_save(scenario: &Scenario, save: &Save) -> Scenario {
    let mut scenario = scenario.clone();
    scenario.starts = save.positions();
    scenario.restored = Some(Arc::new(save.clone()));
    scenario
}

#[test]
fn a_fleet_that_is_restored_in_the_middle_explores_what_is_left() {
    for seed in 0..12 {
        let mut first = scenario(seed, 1 + seed as usize % 3);
        first.conditions.mission.come_home = true;
        let (whole, ..) = run(&first);
        first.conditions.max_ticks = whole.ticks / 2;
        let (half, _, save) = run(&first);
        assert!(!half.is_complete());
        let save = Save::parse(save.to_text().as_bytes()).unwrap();
        let mut second = from_save(&first, &save);
        second.conditions.max_ticks = 10 * whole.ticks;
        let (rest, trace, _) = run(&second);
        assert!(
            rest.is_complete() && rest.false_claims() == 0,
            "seed {seed}"
        );
        assert!(rest.coverage[0] >= half.seen_cells);
        assert!(rest.robots.iter().all(|robot| robot.is_home), "seed {seed}");
        assert_eq!(Coverage::from(&trace).seen, rest.coverage);
        // The trace holds the save: it alone runs again.
        let mut file = Vec::new();
        trace.write(&mut file).unwrap();
        let again = Trace::read(&file[..]).unwrap();
        assert_eq!(run(&again.scenario).1.digest(), trace.digest());
    }
}

#[test]
fn a_save_that_does_not_fit_is_refused_whole() {
    let mut first = scenario(1, 2);
    first.conditions.max_ticks = 30;
    let (_, _, save) = run(&first);
    let refused = |scenario: &Scenario| match scenario.check() {
        Err(ScenarioError::Save(problem)) => problem,
        other => panic!("{other:?}"),
    };
    let mut alone = from_save(&first, &save);
    alone.starts.truncate(1);
    let (saved, robots) = (2, 1);
    assert_eq!(refused(&alone), SaveError::Robots { saved, robots });

    let is_wall = |cell| !first.world.is_free(cell) && cell.x > 0;
    let other = World::from_fn("other", first.world.extent(), is_wall).unwrap();
    let mut elsewhere = from_save(&first, &save);
    elsewhere.world = Arc::new(other);
    assert_eq!(refused(&elsewhere), SaveError::World);

    let mut greedy = from_save(&first, &save);
    greedy.planner = PlannerKind::Greedy;
    let error = greedy.check().unwrap_err().to_string();
    assert!(error.contains("greedy cannot be saved"), "{error}");
}

#[test]
fn a_damaged_save_is_no_save() {
    let mut first = scenario(2, 1);
    first.conditions.max_ticks = 9;
    let text = run(&first).2.to_text();
    for place in (1..text.len()).step_by(97) {
        let mut damaged = text.clone().into_bytes();
        damaged[place] ^= 1;
        assert!(Save::parse(&damaged).is_err(), "byte {place}");
        assert!(
            Save::parse(&text.as_bytes()[..place]).is_err(),
            "{place} bytes"
        );
    }
    assert_eq!(Save::parse(b"P5 1 1 255"), Err(SaveError::NoSave));
}
