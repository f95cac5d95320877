//! The ideal medium against one that joins whole maps.

use std::sync::Arc;

use planner_core::map::TileIndex;
use planner_core::radio::LinkConfig;
use planner_core::{Map, RobotId, Status, TileSet};
use proptest::prelude::*;

use super::air::Air;
use super::{AirFaults, Medium, MediumKind, Reach};
use crate::fleet::{Death, Faults, Fleet, Robot, Rules};
use crate::planners::{PlannerKind, Setup};
use crate::sensor::Sensor;
use crate::world::{Family, Starts, generate};

const SIDE: usize = 4;

/// Every receiver joins everything that every sender knew before the exchange.
struct WholeMaps {
    air: Air,
    sync: u32,
    all: TileSet<SIDE>,
}

impl Medium<SIDE, SIDE> for WholeMaps {
    fn exchange(&mut self, tick: u32, robots: &mut [Robot<SIDE, SIDE>]) {
        if self.sync == 0 || !tick.is_multiple_of(self.sync) {
            return;
        }
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
            let to = (robot.id, robot.position);
            for (id, status, map) in &told {
                if *id != robot.id && self.air.carries(tick, (*id, status.position), to) {
                    robot.planner.join(map, &self.all);
                    robot.planner.hear(*id, *status);
                }
            }
        }
    }
}

fn whole_maps(air: Air, sync: u32) -> Box<dyn Medium<SIDE, SIDE>> {
    let mut all = TileSet::new();
    for (y, x) in (0..SIDE as u8).flat_map(|y| (0..SIDE as u8).map(move |x| (y, x))) {
        all.insert(TileIndex::new(x, y));
    }
    Box::new(WholeMaps { air, sync, all })
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
        reach in prop::sample::select(vec![Reach::Everywhere, Reach::Cells(6), Reach::LineOfSight]),
    ) {
        let world = Arc::new(generate(Family::Cave, 30, 27, seed).unwrap());
        let starts = world.place(robots, &Starts::Random(seed), false).unwrap();
        let planner = if explorer { PlannerKind::Explorer } else { PlannerKind::Closest };
        let rules = Rules {
            solid: false,
            faults: Faults {
                deaths: vec![Death { robot: RobotId(0), tick: death }],
                ..Faults::default()
            },
        };
        let faults = AirFaults { reach, ..AirFaults::default() };
        let fleet = |medium| {
            let extent = world.extent();
            let build = Box::new(move |id, start| {
                planner.build(Setup { id, range: 4, extent, start, link: LinkConfig::new() }).unwrap()
            });
            let sensor = Arc::new(Sensor::new(world.clone(), 4));
            Fleet::<SIDE, SIDE>::new(sensor, medium, rules.clone(), build, &starts)
        };
        let mut fast =
            fleet(MediumKind::Ideal.build(sync, loss, faults.clone(), seed, world.clone()));
        let mut slow = fleet(whole_maps(Air::new(faults, loss, seed, world.clone()), sync));
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
