//! Fleets that keep out of cells.

use std::sync::Arc;

use host_sim::planners::PlannerKind;
use host_sim::run::{self, Options};
use host_sim::scenario::ScenarioError;
use host_sim::scenario::grid::Scenario;
use host_sim::world::World;
use planner_core::{Cell, Extent};

/// A hall of 30×12 cells, and robots in its west.
fn hall(keep_out: &str) -> Scenario {
    let world = World::from_fn("hall", Extent::new(30, 12), |_| false).unwrap();
    let starts = vec![Cell::new(2, 2), Cell::new(2, 6)];
    let mut scenario = Scenario::new(Arc::new(world), starts, PlannerKind::Explorer);
    scenario.conditions.set("keep-out", keep_out).unwrap();
    scenario
}

#[test]
fn robots_enter_nothing_that_they_keep_out_of_and_see_the_rest() {
    for clearance in [0, 1] {
        let mut scenario = hall("10,0:14,7");
        scenario.clearance = clearance;
        let options = Options {
            trace: true,
            ..Options::default()
        };
        let (outcome, trace) = run::run(&scenario, options).unwrap();
        assert!(outcome.is_complete() && outcome.false_claims() == 0);
        assert_eq!(outcome.reachable_cells, 30 * 12 - 5 * 8);
        for record in trace.unwrap().records {
            let reach = i16::from(clearance);
            let Cell { x, y } = record.after();
            assert!(
                !(10 - reach..=14 + reach).contains(&x) || y > 7 + reach,
                "{x},{y}"
            );
        }
    }
}

#[test]
fn robots_stay_within_the_areas_that_are_theirs() {
    let mut scenario = hall("0,11");
    scenario.conditions.set("only", "0,0:9,9").unwrap();
    scenario.conditions.set("only", "9,9:20,9:9,4").unwrap();
    let (outcome, _) = run::run(&scenario, Options::default()).unwrap();
    assert!(outcome.is_complete());
    assert!(outcome.reachable_cells > 100 && outcome.reachable_cells < 160);
    let settings = scenario.conditions.settings(&hall("0,11").conditions);
    assert!(
        settings.contains(&("only", "9,9:20,9:9,4".into())),
        "{settings:?}"
    );
}

#[test]
fn what_cannot_be_kept_out_of_is_refused() {
    let start = hall("0,0:2,2").check().unwrap_err();
    assert!(
        matches!(start, ScenarioError::StartKeptOut { robot: 0, .. }),
        "{start}"
    );
    let outside = hall("0,0:30,2").check().unwrap_err();
    assert!(outside.to_string().contains("--keep-out 30,2"), "{outside}");
    let mut greedy = hall("5,5");
    greedy.planner = PlannerKind::Greedy;
    let refused = greedy.check().unwrap_err();
    assert!(
        refused.to_string().contains("the explorer does"),
        "{refused}"
    );
}
