//! The ideal medium against one that joins whole maps.

use std::sync::Arc;

use planner_core::map::TileIndex;
use planner_core::{Map, RobotId, Status, TileSet};
use proptest::prelude::*;

use super::ideal::Loss;
use super::{Ideal, Medium};
use crate::fleet::{Death, Faults, Fleet, Robot, Rules};
use crate::planners::PlannerKind;
use crate::sensor::Sensor;
use crate::world::{Family, Starts, generate};

const SIDE: usize = 4;

/// Every receiver joins everything that every sender knew before the exchange.
struct WholeMaps {
    loss: Loss,
    all: TileSet<SIDE>,
}

impl Medium<SIDE, SIDE> for WholeMaps {
    fn exchange(&mut self, robots: &mut [Robot<SIDE, SIDE>]) {
        let told: Vec<(RobotId, Status, Map<SIDE, SIDE>)> = robots
            .iter()
            .filter(|robot| robot.alive)
            .map(|robot| {
                (
                    robot.id,
                    robot.planner.status(),
                    robot.planner.map().clone(),
                )
            })
            .collect();
        for robot in robots.iter_mut().filter(|robot| robot.alive) {
            for (id, status, map) in &told {
                if *id != robot.id && !self.loss.strikes() {
                    robot.planner.join(map, &self.all);
                    robot.planner.hear(*id, *status);
                }
            }
        }
    }
}

fn whole_maps(loss: f64, seed: u64) -> Box<dyn Medium<SIDE, SIDE>> {
    let mut all = TileSet::new();
    for (y, x) in (0..SIDE as u8).flat_map(|y| (0..SIDE as u8).map(move |x| (y, x))) {
        all.insert(TileIndex::new(x, y));
    }
    let loss = Loss::new(loss, seed);
    Box::new(WholeMaps { loss, all })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn joining_what_may_be_lacking_is_joining_whole_maps(
        seed in any::<u64>(),
        robots in 1usize..6,
        sync in 0u32..5,
        loss in prop::sample::select(vec![0.0, 0.3, 0.9, 1.0]),
        death in 0u32..60,
        explorer in any::<bool>(),
    ) {
        let world = Arc::new(generate(Family::Cave, 30, 27, seed).unwrap());
        let starts = world.place(robots, &Starts::Random(seed), false).unwrap();
        let planner = if explorer { PlannerKind::Explorer } else { PlannerKind::Closest };
        let rules = Rules {
            sync,
            solid: false,
            faults: Faults {
                deaths: vec![Death { robot: RobotId(0), tick: death }],
                closures: Vec::new(),
            },
        };
        let fleet = |medium| {
            let planners = starts.iter().zip(0..).map(|(&start, id)| {
                let planner = planner.build(RobotId(id), 4, world.extent(), start).unwrap();
                (planner, start)
            });
            let sensor = Arc::new(Sensor::new(world.clone(), 4));
            Fleet::<SIDE, SIDE>::new(sensor, medium, rules.clone(), planners)
        };
        let mut fast = fleet(Box::new(Ideal::new(loss, seed)));
        let mut slow = fleet(whole_maps(loss, seed));
        for tick in 0..120 {
            fast.tick();
            slow.tick();
            for (fast, slow) in fast.robots().iter().zip(slow.robots()) {
                prop_assert_eq!(fast.step, slow.step, "robot {:?} in tick {}", fast.id, tick);
                for tile in (0..16).map(|at| TileIndex::new(at % 4, at / 4)) {
                    prop_assert_eq!(fast.planner.map().tile(tile), slow.planner.map().tile(tile));
                }
            }
        }
    }
}
