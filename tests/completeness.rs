//! The explorer in random worlds of every family: every living robot stops, says
//! "complete", and knows every cell that can be reached.

use std::sync::Arc;

use host_sim::planners::PlannerKind;
use host_sim::run::{Options, run};
use host_sim::scenario::grid::{Scenario, default_max_ticks};
use host_sim::scenario::{CellSpan, Conditions, Event, Faults, RobotSpan};
use host_sim::world::{Family, Starts, generate};
use planner_core::explorer::Config;
use planner_core::{Cell, RobotId};
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
    let deaths = case.deaths.iter().map(|&(robot, tick)| Event {
        robot: RobotId(robot % robots as u8),
        tick,
    });
    let closures = case.closures.iter().map(|(cell, from, length)| CellSpan {
        cell: *cell.get(&cells),
        from: *from,
        until: (from + length).min(CLEARED),
    });
    let max_ticks =
        default_max_ticks(&world.reachable(&starts), PlannerKind::Explorer) + 4 * CLEARED;
    Some(Scenario {
        range: case.range,
        solid: case.solid,
        conditions: Conditions {
            sync: case.sync,
            loss: case.loss,
            faults: Faults {
                deaths: deaths.collect(),
                closures: closures.collect(),
                ..Faults::default()
            },
            ..Conditions::new(case.seed, max_ticks)
        },
        ..Scenario::new(Arc::new(world), starts, PlannerKind::Explorer)
    })
}

/// Robots that lose their poses, and for how many ticks.
fn lost_poses() -> impl Strategy<Value = Vec<RobotSpan>> {
    let spell = (0u8..10, 0u32..300, 1u32..=50);
    prop::collection::vec(spell, 0..4).prop_map(|spells| {
        let spells = spells.into_iter();
        spells
            .map(|(robot, from, ticks)| RobotSpan {
                robot: RobotId(robot),
                from,
                until: from + ticks,
            })
            .collect()
    })
}

proptest! {
    #[test]
    fn robots_that_look_one_way_or_lose_their_poses_stop_with_all_that_they_can_reach(
        case in case(),
        fov in prop::sample::select(&[360u16, 180, 90, 62][..]),
        lost_poses in lost_poses(),
    ) {
        let Some(mut scenario) = scenario(&case) else {
            return Err(TestCaseError::reject("no such world"));
        };
        scenario.fov = fov;
        scenario.conditions.faults.lost_poses = lost_poses;
        let robots = scenario.starts.len();
        scenario.conditions.faults.lost_poses.retain(|of| usize::from(of.robot.0) < robots);
        // Four looks from every cell.
        scenario.conditions.max_ticks *= 5;
        let (outcome, _) = run(&scenario, Options::default()).unwrap();
        prop_assert!(outcome.violations.is_empty(), "{:?}", outcome.violations);
        for (index, robot) in outcome.robots.iter().enumerate().filter(|(_, robot)| robot.alive) {
            let stop = robot.stop;
            prop_assert!(stop.is_some_and(|stop| stop.is_complete()), "robot {index}: {stop:?}");
            prop_assert_eq!(robot.cells_missed, 0, "robot {}", index);
        }
    }

    /// Nothing that can be seen is left for a wall that no look shows, and nobody calls
    /// for ever for a look that shows nothing.
    #[test]
    fn robots_stop_beside_what_no_look_shows(
        case in case(),
        fov in prop::sample::select(&[360u16, 62][..]),
        glass in prop::collection::vec(any::<prop::sample::Index>(), 0..4),
        silent in prop::option::of((0u8..10, 0u32..300)),
    ) {
        let Some(mut scenario) = scenario(&case) else {
            return Err(TestCaseError::reject("no such world"));
        };
        let extent = scenario.world.extent();
        let (width, height) = (extent.width as i16, extent.height as i16);
        let cells = (0..height).flat_map(|y| (0..width).map(move |x| Cell::new(x, y)));
        let walls: Vec<Cell> = cells.filter(|&cell| !scenario.world.is_free(cell)).collect();
        prop_assume!(!walls.is_empty());
        let blind = glass.iter().map(|of| CellSpan {
            cell: *of.get(&walls),
            from: 0,
            until: u32::MAX,
        });
        scenario.conditions.faults.blind = blind.collect();
        let robots = scenario.starts.len() as u8;
        let silent = silent.map(|(robot, tick)| Event {
            robot: RobotId(robot % robots),
            tick,
        });
        scenario.conditions.faults.sensor_failures = silent.into_iter().collect();
        scenario.fov = fov;
        // A robot that sees nothing stands in the way for good.
        scenario.solid = false;
        scenario.conditions.max_ticks *= 5;
        let (outcome, _) = run(&scenario, Options::default()).unwrap();
        for (index, robot) in outcome.robots.iter().enumerate().filter(|(_, robot)| robot.alive) {
            prop_assert!(robot.stop.is_some(), "robot {index} goes on for ever");
            let is_silent = silent.is_some_and(|of| usize::from(of.robot.0) == index);
            if !is_silent {
                prop_assert_eq!(robot.cells_missed, 0, "robot {}: {:?}", index, robot.stop);
            }
        }
    }

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
