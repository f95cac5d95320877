//! Completeness over frames: whatever the air and fate do, every living robot
//! stops with everything that it can reach on its own map; and a robot among
//! liars stops as well.

#[path = "../fuzz/src/hostile.rs"]
mod hostile;

use std::sync::Arc;

use host_sim::fleet::{Arrival, Death, Faults, Restart};
use host_sim::medium::{AirFaults, MediumKind, Partition, Reach};
use host_sim::planners::PlannerKind;
use host_sim::run::{Options, Outcome, Scenario, run};
use host_sim::world::{Family, Starts, generate};
use planner_core::RobotId;
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
fn faults() -> impl Strategy<Value = Faults> {
    let fate = || proptest::collection::vec((0u8..6, 0u32..150), 0..3);
    (fate(), fate(), fate()).prop_map(|(deaths, arrivals, restarts)| {
        let robot = |id| RobotId(id);
        Faults {
            deaths: deaths
                .into_iter()
                .map(|(id, tick)| Death {
                    robot: robot(id),
                    tick,
                })
                .collect(),
            arrivals: arrivals
                .into_iter()
                .map(|(id, tick)| Arrival {
                    robot: robot(id),
                    tick,
                })
                .collect(),
            restarts: restarts
                .into_iter()
                .map(|(id, tick)| Restart {
                    robot: robot(id),
                    tick,
                })
                .collect(),
            ..Faults::default()
        }
    })
}

fn scenario() -> impl Strategy<Value = Scenario> {
    (
        (family(), 5u16..=28, 5u16..=28, any::<u64>()),
        1usize..=6,
        1u8..=8,
        (air(), 0.0..0.95f64),
        faults(),
        proptest::sample::select(vec![0u16, 3, 20, 55, 110]),
        proptest::sample::select(vec![0u32, 1, 2, 7]),
    )
        .prop_map(
            |((family, width, height, seed), robots, range, (air, loss), faults, budget, sync)| {
                let world = Arc::new(generate(family, width, height, seed).unwrap());
                let starts = world.place(robots, &Starts::Random(seed), false).unwrap();
                let mut scenario = Scenario::new(world, starts, PlannerKind::Explorer);
                scenario.medium = MediumKind::Radio;
                scenario.range = range;
                scenario.seed = seed;
                scenario.air = air;
                scenario.loss = loss;
                scenario.faults = faults;
                scenario.byte_budget = budget;
                scenario.sync = sync;
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
            scenario.medium = MediumKind::Radio;
            let outcome = outcome(&scenario);
            assert!(outcome.maps_agree(), "{family}, {robots} robots");
            for robot in &outcome.robots {
                assert_eq!(robot.sent.frames, outcome.ticks);
                assert!(robot.sent.bytes <= 55 * outcome.ticks);
            }
        }
    }
}
