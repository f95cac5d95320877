//! The explorer in random worlds of every family: every living robot stops, says
//! "complete", and knows every cell that can be reached.

use std::sync::Arc;

use host_sim::fleet::{Closure, Death, Faults};
use host_sim::planners::PlannerKind;
use host_sim::run::{Options, Scenario, default_max_ticks, run};
use host_sim::world::{Family, Starts, generate};
use planner_core::RobotId;
use planner_core::explorer::Config;
use proptest::prelude::*;

/// No step is refused from this tick on, within the patience of the explorer.
const CLEARED: u32 = 400;

#[derive(Clone, Debug)]
struct Case {
    family: usize,
    size: (u16, u16),
    seed: u64,
    robots: usize,
    range: u8,
    sync: u32,
    loss: f64,
    solid: bool,
    deaths: Vec<(u8, u32)>,
    closures: Vec<(prop::sample::Index, u32, u32)>,
}

fn case() -> impl Strategy<Value = Case> {
    let death = (0u8..10, 0u32..300);
    let closure = (any::<prop::sample::Index>(), 0..CLEARED, 1..CLEARED);
    (
        (0..Family::ALL.len(), (8u16..28, 8u16..28), any::<u64>()),
        (1usize..=10, 1u8..=8, any::<bool>()),
        (prop_oneof![Just(0u32), Just(1), 2u32..60], 0.0..0.95f64),
        prop::collection::vec(death, 0..3),
        prop::collection::vec(closure, 0..6),
    )
        .prop_map(
            |((family, size, seed), (robots, range, solid), (sync, loss), deaths, closures)| Case {
                family,
                size,
                seed,
                robots,
                range,
                sync,
                loss,
                solid,
                // A dead body in the only corridor stays there: where cells are
                // solid nobody dies here.
                deaths: if solid { Vec::new() } else { deaths },
                closures,
            },
        )
}

fn scenario(case: &Case) -> Option<Scenario> {
    let world = generate(
        Family::ALL[case.family],
        case.size.0,
        case.size.1,
        case.seed,
    )
    .ok()?;
    let cells: Vec<_> = world.largest_component().cells().collect();
    let robots = if case.solid {
        case.robots.min(cells.len() / 4).max(1)
    } else {
        case.robots
    };
    let starts = world
        .place(robots, &Starts::Random(case.seed), case.solid)
        .ok()?;
    let deaths = case.deaths.iter().map(|&(robot, tick)| Death {
        robot: RobotId(robot % robots as u8),
        tick,
    });
    let closures = case.closures.iter().map(|(cell, from, length)| Closure {
        cell: *cell.get(&cells),
        from: *from,
        until: (from + length).min(CLEARED),
    });
    let max_ticks =
        default_max_ticks(&world.reachable(&starts), PlannerKind::Explorer) + 4 * CLEARED;
    Some(Scenario {
        range: case.range,
        sync: case.sync,
        loss: case.loss,
        seed: case.seed,
        solid: case.solid,
        max_ticks,
        faults: Faults {
            deaths: deaths.collect(),
            closures: closures.collect(),
            ..Faults::default()
        },
        ..Scenario::new(Arc::new(world), starts, PlannerKind::Explorer)
    })
}

proptest! {
    #[test]
    fn every_living_robot_stops_with_all_that_it_can_reach(case in case()) {
        let Some(scenario) = scenario(&case) else {
            return Err(TestCaseError::reject("no such world"));
        };
        let (outcome, _) = run(&scenario, Options::default()).unwrap();
        prop_assert!(outcome.violations.is_empty(), "{:?}", outcome.violations);
        prop_assert!(outcome.max_work_per_tick <= Config::new().work_bound());
        for (index, robot) in outcome.robots.iter().enumerate().filter(|(_, robot)| robot.alive) {
            let stop = robot.stop;
            prop_assert!(stop.is_some_and(|stop| stop.is_complete()), "robot {index}: {stop:?}");
            prop_assert_eq!(robot.cells_missed, 0, "robot {}", index);
        }
    }
}
