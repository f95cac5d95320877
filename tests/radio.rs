//! Completeness over frames: whatever the air and fate do, every living robot
//! stops with everything that it can reach on its own map; and a robot among
//! liars stops as well.

#[path = "../fuzz/src/hostile.rs"]
mod hostile;

use std::sync::Arc;

use host_sim::planners::PlannerKind;
use host_sim::run::{Options, Outcome, run};
use host_sim::scenario::grid::Scenario;
use host_sim::scenario::{AirFaults, Event, Faults, MediumKind, Partition, Reach};
use host_sim::world::{Family, Starts, generate};
use proptest::prelude::*;

fn family() -> impl Strategy<Value = Family> {
    proptest::sample::select(&Family::ALL[..])
}

fn reach() -> impl Strategy<Value = Reach> {
    prop_oneof![
        Just(Reach::Everywhere),
        Just(Reach::LineOfSight),
        (0u16..20).prop_map(Reach::Cells),
    ]
}

fn air() -> impl Strategy<Value = AirFaults> {
    let partition = (0u32..100, 0u32..200, 0u8..6).prop_map(|(from, ticks, border)| Partition {
        from,
        until: from + ticks,
        border,
    });
    (
        reach(),
        proptest::collection::vec(partition, 0..2),
        0.0..0.5f64,
        0u32..20,
        0.0..0.5f64,
    )
        .prop_map(
            |(reach, partitions, duplication, delay, corruption)| AirFaults {
                reach,
                partitions,
                duplication,
                delay,
                corruption,
                forger: None,
            },
        )
}

/// What happens to some robots, each at most one thing of a kind.
fn faults(robots: u8) -> impl Strategy<Value = Faults> {
    let fate = move || {
        let event = (0..robots, 0u32..150).prop_map(Event::from);
        proptest::collection::vec(event, 0..3)
    };
    (fate(), fate(), fate()).prop_map(|(deaths, arrivals, restarts)| Faults {
        deaths,
        arrivals,
        restarts,
        ..Faults::default()
    })
}

fn scenario() -> impl Strategy<Value = Scenario> {
    (
        (family(), 5u16..=28, 5u16..=28, any::<u64>()),
        (1u8..=6).prop_flat_map(|robots| (Just(robots), faults(robots))),
        1u8..=8,
        (air(), 0.0..0.95f64),
        proptest::sample::select(vec![0u16, 3, 20, 55, 110]),
        proptest::sample::select(vec![0u32, 1, 2, 7]),
    )
        .prop_map(
            |(
                (family, width, height, seed),
                (robots, faults),
                range,
                (air, loss),
                budget,
                sync,
            )| {
                let world = Arc::new(generate(family, width, height, seed).unwrap());
                let starts = world
                    .place(robots.into(), &Starts::Random(seed), false)
                    .unwrap();
                let mut scenario = Scenario::new(world, starts, PlannerKind::Explorer);
                scenario.conditions.medium = MediumKind::Radio;
                scenario.range = range;
                scenario.conditions.seed = seed;
                scenario.conditions.air = air;
                scenario.conditions.loss = loss;
                scenario.conditions.faults = faults;
                scenario.conditions.byte_budget = budget;
                scenario.conditions.sync = sync;
                scenario
            },
        )
}

fn outcome(scenario: &Scenario) -> Outcome {
    run(scenario, Options::default()).unwrap().0
}

proptest! {
    #[test]
    fn every_living_robot_stops_with_all_that_it_can_reach(scenario in scenario()) {
        let outcome = outcome(&scenario);
        prop_assert!(outcome.violations.is_empty());
        for (robot, id) in outcome.robots.iter().zip(0..) {
            if robot.alive {
                let stop = robot.stop;
                prop_assert!(stop.is_some_and(|stop| stop.is_complete()), "{id}: {stop:?}");
                prop_assert_eq!(robot.cells_missed, 0, "robot {}", id);
            }
        }
    }

    #[test]
    fn the_same_scenario_runs_the_same(scenario in scenario()) {
        prop_assert_eq!(outcome(&scenario), outcome(&scenario));
    }

    /// The script of the fuzz target, by chance.
    #[test]
    fn a_robot_among_liars_stops(script in proptest::collection::vec(any::<u8>(), 0..600)) {
        hostile::explore(&script);
    }
}

#[test]
fn without_loss_all_maps_agree_in_the_end() {
    for family in Family::ALL {
        for robots in [2, 3, 6] {
            let world = Arc::new(generate(family, 40, 40, robots).unwrap());
            let starts = world
                .place(robots as usize, &Starts::Center, false)
                .unwrap();
            let mut scenario = Scenario::new(world, starts, PlannerKind::Explorer);
            scenario.conditions.medium = MediumKind::Radio;
            let outcome = outcome(&scenario);
            assert!(outcome.maps_agree(), "{family}, {robots} robots");
            for robot in &outcome.robots {
                assert_eq!(robot.sent.frames, outcome.ticks);
                assert!(robot.sent.bytes <= 55 * outcome.ticks);
            }
        }
    }
}
