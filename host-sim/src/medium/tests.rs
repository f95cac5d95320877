//! The ideal medium against one that joins whole maps; the air.

use std::sync::Arc;

use planner_core::explorer::SensorModel;
use planner_core::radio::LinkConfig;
use planner_core::tile::TileIndex;
use planner_core::{Cell, Extent, Map, RobotId, Status, TileSet};
use proptest::prelude::*;

use super::air::Air;
use super::{Fate, Medium, build};
use crate::fleet::{Fleet, Rules};
use crate::planners::{PlannerKind, Setup};
use crate::robot::Robot;
use crate::scenario::{
    AirFaults, Conditions, Event, Faults, MediumKind, Mission, Partition, Reach,
};
use crate::sensor::Sensor;
use crate::world::{Family, Starts, World, generate};

const SIDE: usize = 4;

/// Every receiver joins everything that every sender knew before the exchange.
struct WholeMaps {
    air: Air<World>,
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

fn whole_maps(air: Air<World>, sync: u32) -> Box<dyn Medium<SIDE, SIDE>> {
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
            faults: Faults {
                deaths: vec![Event { robot: RobotId(0), tick: death }],
                ..Faults::default()
            },
            ..Rules::default()
        };
        let fleet = |medium| {
            let extent = world.extent();
            let planners = Box::new(move |id, start| {
                planner.build(Setup { id, extent, start, link: LinkConfig::new(), sensor: SensorModel::truthful(), clearance: 0, mission: Mission::default() }).unwrap()
            });
            let sensor = Arc::new(Sensor::new(world.clone(), 4));
            Fleet::<SIDE, SIDE>::new(sensor, medium, rules.clone(), planners, &starts)
        };
        let mut conditions = Conditions { sync, loss, ..Conditions::new(seed, 120) };
        conditions.air.reach = reach;
        let mut fast = fleet(build(&conditions, world.clone()));
        let mut slow = fleet(whole_maps(Air::new(&conditions, world.clone()), sync));
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

fn conditions(air: AirFaults, loss: f64) -> Conditions {
    Conditions {
        air,
        loss,
        ..Conditions::new(7, 50)
    }
}

fn air(faults: AirFaults, loss: f64) -> Air<World> {
    let row = |cell: Cell| cell.x == 5;
    let world = World::from_fn("wall", Extent::new(20, 3), row).unwrap();
    Air::new(&conditions(faults, loss), Arc::new(world))
}

#[test]
fn the_air_carries_within_its_reach_and_across_no_partition() {
    let robot = |id, x| (RobotId(id), Cell::new(x, 1));
    let mut near = air(
        AirFaults {
            reach: Reach::Cells(3),
            partitions: vec![Partition {
                from: 10,
                until: 20,
                border: 2,
            }],
            ..AirFaults::default()
        },
        0.0,
    );
    assert!(near.carries(0, robot(0, 3), robot(1, 6)));
    assert!(!near.carries(0, robot(0, 3), robot(1, 7)));
    for tick in [9, 20] {
        assert!(near.carries(tick, robot(1, 3), robot(2, 3)));
    }
    for tick in [10, 19] {
        assert!(!near.carries(tick, robot(1, 3), robot(2, 3)));
        assert!(near.carries(tick, robot(0, 3), robot(1, 3)));
    }
    let faults = AirFaults {
        reach: Reach::LineOfSight,
        ..AirFaults::default()
    };
    let mut sight = air(faults, 0.0);
    assert!(sight.carries(0, robot(0, 0), robot(1, 4)));
    assert!(!sight.carries(0, robot(0, 0), robot(1, 6)));
}

#[test]
fn the_shares_of_the_air_are_kept() {
    let faults = AirFaults {
        duplication: 0.25,
        corruption: 0.5,
        delay: 4,
        ..AirFaults::default()
    };
    let mut air = air(faults, 0.75);
    let robot = |id| (RobotId(id), Cell::new(1, 1));
    let carried = (0..4000)
        .filter(|_| air.carries(0, robot(0), robot(1)))
        .count();
    assert!((900..1100).contains(&carried), "{carried}");
    let frame = [0x5a; 52];
    let mut copies: Vec<(u32, Vec<u8>)> = Vec::new();
    for _ in 0..4000 {
        for _ in 0..air.copies() {
            let late = air.delay();
            let bytes = air.corrupted(&frame).unwrap_or_else(|| frame.to_vec());
            copies.push((late, bytes));
        }
    }
    assert!((4900..5100).contains(&copies.len()), "{}", copies.len());
    let late = |ticks| copies.iter().filter(|(late, _)| *late == ticks).count();
    assert!((0..=4).all(|ticks| (900..1100).contains(&late(ticks))));
    assert_eq!(late(5), 0);
    let wrong = copies
        .iter()
        .filter(|(_, bytes)| bytes[..] != frame)
        .count();
    // Wrong bits can meet and undo each other, rarely.
    assert!((2300..2600).contains(&wrong), "{wrong}");
}

/// How many messages ended in each way: heard, lost, out of reach; and how often one
/// was seen under way.
fn fates(kind: MediumKind, faults: AirFaults, loss: f64) -> [usize; 4] {
    let world = Arc::new(generate(Family::Rooms, 30, 30, 1).unwrap());
    let starts = world.place(2, &Starts::Random(1), false).unwrap();
    let extent = world.extent();
    let planners = Box::new(move |id, start| {
        let link = LinkConfig::new();
        let setup = Setup {
            id,
            extent,
            start,
            link,
            sensor: SensorModel::truthful(),
            clearance: 0,
            mission: Mission::default(),
        };
        PlannerKind::Explorer.build(setup).unwrap()
    });
    let sensor = Arc::new(Sensor::new(world.clone(), 4));
    let conditions = Conditions {
        medium: kind,
        ..conditions(faults, loss)
    };
    let medium = build(&conditions, world);
    let mut fleet = Fleet::<SIDE, SIDE>::new(sensor, medium, Rules::default(), planners, &starts);
    fleet.listen();
    let mut sums = [0; 4];
    for _ in 0..50 {
        fleet.tick();
        for message in fleet.messages() {
            sums[match message.fate {
                Fate::Heard => 0,
                Fate::Lost => 1,
                Fate::OutOfReach => 2,
                Fate::UnderWay => 3,
            }] += 1;
        }
    }
    sums
}

#[test]
fn every_message_tells_what_became_of_it() {
    for kind in [MediumKind::Ideal, MediumKind::Radio] {
        let [heard, lost, unreached, under_way] = fates(kind, AirFaults::default(), 0.0);
        assert!(heard > 50 && [lost, unreached, under_way] == [0; 3]);
        let [heard, lost, ..] = fates(kind, AirFaults::default(), 1.0);
        assert!(heard == 0 && lost > 50);
        let apart = AirFaults {
            partitions: vec![Partition {
                from: 0,
                until: 50,
                border: 1,
            }],
            ..AirFaults::default()
        };
        let [heard, lost, unreached, _] = fates(kind, apart, 1.0);
        assert!(heard == 0 && lost == 0 && unreached > 50);
    }
    let late = AirFaults {
        delay: 3,
        ..AirFaults::default()
    };
    let [heard, lost, unreached, under_way] = fates(MediumKind::Radio, late, 0.0);
    assert!(heard > 50 && under_way > 50 && lost == 0 && unreached == 0);
}
