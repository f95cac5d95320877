//! The explorer in a small world of its own: the obviously correct simulator.

use std::vec;
use std::vec::Vec;

use proptest::prelude::*;

use super::*;
use crate::sight::look;

type Small = Explorer<3, 3>;

#[derive(Clone, Debug)]
struct Scene {
    extent: Extent,
    walls: Vec<bool>,
    start: Vec<Cell>,
    radius: u8,
    config: Config,
    /// Ticks between two exchanges of maps; 0: never.
    sync: u32,
    /// Steps refused, out of 256, for a while.
    refusals: u8,
    solid: bool,
    seed: u64,
}

impl Scene {
    fn is_blocked(&self, cell: Cell) -> bool {
        !self.extent.contains(cell)
            || self.walls[cell.y as usize * usize::from(self.extent.width) + cell.x as usize]
    }

    fn reachable(&self, from: Cell) -> Vec<Cell> {
        let mut found = vec![from];
        let mut next = 0;
        while let Some(&cell) = found.get(next) {
            for direction in Direction::ALL {
                let beside = cell.step(direction);
                if !self.is_blocked(beside) && !found.contains(&beside) {
                    found.push(beside);
                }
            }
            next += 1;
        }
        found
    }
}

/// No step is refused from this tick on: within the patience of the default
/// configuration, 4 + 8 + … + 256 ticks of pauses before the eighth refusal.
const CLEARED: u32 = 400;

struct Dice(u64);

impl Dice {
    fn roll(&mut self) -> u8 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 56) as u8
    }
}

fn scene() -> impl Strategy<Value = Scene> {
    (4u16..=20, 4u16..=20, 0.0..0.55f64, 1usize..=6, any::<u64>()).prop_flat_map(
        |(width, height, share, robots, seed)| {
            let cells = usize::from(width) * usize::from(height);
            (
                proptest::collection::vec(proptest::bool::weighted(share), cells),
                proptest::collection::vec(0..cells, robots),
                1u8..=8,
                prop_oneof![Just(1u32), Just(4), 64u32..2000],
                prop_oneof![Just(0u32), Just(1), 2u32..50],
                prop_oneof![Just(0u8), 0u8..100],
                any::<bool>(),
            )
                .prop_map(
                    move |(mut walls, starts, radius, slice, sync, refusals, solid)| {
                        for &start in &starts {
                            walls[start] = false;
                        }
                        let mut start: Vec<_> = starts
                            .iter()
                            .map(|&i| {
                                Cell::new(
                                    (i % usize::from(width)) as i16,
                                    (i / usize::from(width)) as i16,
                                )
                            })
                            .collect();
                        if solid {
                            start.sort();
                            start.dedup();
                        }
                        Scene {
                            extent: Extent::new(width, height),
                            walls,
                            start,
                            radius,
                            config: Config {
                                slice,
                                ..Config::new()
                            },
                            sync,
                            refusals,
                            solid,
                            seed,
                        }
                    },
                )
        },
    )
}

struct Ended {
    robots: Vec<Small>,
    stops: Vec<Option<Stop>>,
    ticks: u32,
}

/// Runs until every robot has stopped, or `limit` ticks.
fn run(scene: &Scene, limit: u32) -> Ended {
    let mut dice = Dice(scene.seed);
    let mut robots: Vec<Small> = scene
        .start
        .iter()
        .zip(0u8..)
        .map(|(&start, id)| Small::new(scene.config, RobotId(id), scene.extent, start).unwrap())
        .collect();
    let mut at = scene.start.clone();
    let mut stops = vec![None; robots.len()];
    let all = {
        let mut all = TileSet::new();
        for y in 0..3 {
            for x in 0..3 {
                all.insert(crate::map::TileIndex { x, y });
            }
        }
        all
    };
    let mut ticks = 0;
    while stops.iter().any(Option::is_none) && ticks < limit {
        for (robot, &cell) in robots.iter_mut().zip(&at) {
            robot.observe(&look(cell, scene.radius, |c| scene.is_blocked(c)));
        }
        if scene.sync > 0 && ticks % scene.sync == 0 {
            let told: Vec<_> = robots
                .iter()
                .map(|r| (r.map().clone(), r.status()))
                .collect();
            for (i, robot) in robots.iter_mut().enumerate() {
                for (j, (map, status)) in told.iter().enumerate() {
                    if i != j && dice.roll() > 40 {
                        robot.join(map, &all);
                        robot.hear(RobotId(j as u8), *status);
                    }
                }
            }
        }
        let mut acted = Vec::new();
        for i in 0..robots.len() {
            let rank = robots[i].role().unwrap().rank();
            if acted.contains(&rank) {
                continue;
            }
            match robots[i].tick() {
                Action::Move(step) => {
                    let next = at[i].step(step);
                    assert!(!scene.is_blocked(next), "a step into an obstacle at {next}");
                    assert!(robots[i].work() <= scene.config.work_bound());
                    let holder = at.iter().position(|&cell| cell == next);
                    match holder {
                        _ if ticks < CLEARED && dice.roll() < scene.refusals => {
                            robots[i].report(Motion::Blocked);
                        }
                        Some(j) if scene.solid => {
                            let (mine, theirs) =
                                (robots[i].role().unwrap(), robots[j].role().unwrap());
                            if acted.contains(&theirs.rank()) {
                                robots[i].report(Motion::Held);
                                continue;
                            }
                            match exchange(&mine, at[i], &theirs, at[j]) {
                                None => robots[i].report(Motion::Held),
                                Some((here, there)) => {
                                    let (a, b) = (robots[i].map().clone(), robots[j].map().clone());
                                    robots[i].join(&b, &all);
                                    robots[j].join(&a, &all);
                                    robots[i].adopt(here);
                                    robots[j].adopt(there);
                                    acted.extend([mine.rank(), theirs.rank()]);
                                }
                            }
                        }
                        _ => {
                            at[i] = next;
                            robots[i].report(Motion::Moved);
                        }
                    }
                }
                Action::Wait => {}
                Action::Stop(_) => {}
            }
        }
        for (robot, stop) in robots.iter().zip(&mut stops) {
            *stop = robot.role.stopped.get();
        }
        ticks += 1;
    }
    Ended {
        robots,
        stops,
        ticks,
    }
}

/// Every robot stops, says "complete", and knows everything that it can reach.
fn assert_complete(scene: &Scene) -> Result<(), TestCaseError> {
    let ended = run(scene, 60_000);
    for ((robot, stop), &start) in ended.robots.iter().zip(&ended.stops).zip(&scene.start) {
        let stop = stop.ok_or_else(|| {
            TestCaseError::fail(std::format!(
                "still running at {}\n{:?}\nthe plan {:?}",
                robot.around.position,
                robot.map(),
                robot.role
            ))
        })?;
        prop_assert!(stop.is_complete(), "{} {:?}", stop, robot.map());
        // Exchanges of roles join the maps: everybody knows what its body can reach.
        for cell in scene.reachable(start) {
            prop_assert!(
                robot.map().is_known(cell),
                "{} is not known to {:?}",
                cell,
                robot.id
            );
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: std::env::var("CASES").map_or(400, |c| c.parse().unwrap()), ..ProptestConfig::default() })]

    #[test]
    fn every_robot_stops_with_a_complete_map(scene in scene()) {
        assert_complete(&scene)?;
    }

    #[test]
    fn the_same_scene_runs_the_same(scene in scene()) {
        let (a, b) = (run(&scene, 300), run(&scene, 300));
        prop_assert_eq!(a.ticks, b.ticks);
        for (a, b) in a.robots.iter().zip(&b.robots) {
            prop_assert_eq!(a.status(), b.status());
            prop_assert!(a.map() == b.map());
        }
    }
}
