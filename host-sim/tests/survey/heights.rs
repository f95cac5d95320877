//! Over heights.

use std::collections::HashSet;

use host_sim::record::Deed;
use host_sim::record::heights::Trace;
use host_sim::run::heights::run;
use host_sim::scenario::heights::{Planner, Scenario};
use host_sim::scenario::{CellSpan, Event, Faults, MediumKind, Mission, Wind};
use host_sim::summary::heights::Summary;
use host_sim::terrain::Terrain;
use planner_core::surface::Height;
use planner_core::{Cell, Extent, Reason, Stop};
use proptest::prelude::*;

use crate::check_with_octomap;
use crate::visible::visible;

pub(crate) const ALL: [Planner; 8] = [
    Planner::CoordinatedSurvey,
    Planner::CoordinatedCubic,
    Planner::Fcao,
    Planner::ClosestFrontier,
    Planner::Greedy,
    Planner::GreedyUnique,
    Planner::GreedyInOrder,
    Planner::ClosestUntilReached,
];

pub(crate) const OWN: [Planner; 3] = [
    Planner::CoordinatedSurvey,
    Planner::CoordinatedCubic,
    Planner::Fcao,
];

/// The robots' rewards add up to the number of explored columns, and nothing unsafe
/// happens on the way [Renzaglia2019 eq. 2].
#[test]
fn rewards_add_up_and_flights_are_safe() {
    for (seed, planner) in (0..).zip(ALL) {
        for robots in [1, 3, 8] {
            let terrain = Terrain::gaussian(seed, 48);
            let trace = run(&terrain, &Scenario::new(planner, robots, seed)).unwrap();
            let rewards: f64 = trace.records.iter().map(|r| f64::from(r.gain)).sum();
            assert!(
                (rewards - 48.0 * 48.0).abs() < 0.1,
                "{planner:?}: {rewards}"
            );
            assert_eq!(trace.safety, Default::default(), "{planner:?}");
            assert!(trace.complete());
        }
    }
}

/// Alone and in fleets, with all planners: robots come home over every terrain, in time, and
/// nothing unsafe happens on the way.
#[test]
fn robots_come_home_in_time() {
    for (seed, planner) in (0..).zip(ALL) {
        for (robots, energy) in [(1, 0), (1, 60), (1, 150), (4, 0), (4, 70), (9, 40)] {
            let terrain = match seed % 2 {
                0 => Terrain::gaussian(seed, 40),
                _ => Terrain::urban(seed, 40),
            };
            let mut scenario = Scenario::new(planner, robots, seed);
            scenario.conditions.mission = Mission {
                come_home: true,
                energy,
            };
            let trace = run(&terrain, &scenario).unwrap();
            assert_eq!(trace.safety, Default::default(), "{planner:?}");
            assert!(trace.all_stopped && (energy > 0 || trace.complete()));
            let summary = Summary::new(&trace);
            for (number, robot) in summary.robots.iter().enumerate() {
                let case = format!("{planner:?} {robots} {energy}: robot {number} {robot:?}");
                assert!(robot.flown.is_home, "{case}");
                let refused = robot.blocked_steps > 0;
                let ticks = trace
                    .of(number)
                    .filter(|record| !matches!(record.deed, Deed::Stopped(_)));
                assert!(
                    energy == 0 || robots > 1 || refused || ticks.count() <= energy as usize,
                    "{case}"
                );
            }
        }
    }
}

/// What goes wrong with columns, sensors and poses: all that can be seen is seen, and who
/// cannot says why.
#[test]
fn columns_and_senses_fail() {
    let terrain = Terrain::from_fn(Extent::new(24, 24), |_| Height(4));
    let all = terrain.extent().cells();
    let fly = |planner, change: &dyn Fn(&mut Faults)| {
        let mut scenario = Scenario::new(planner, 1, 5);
        change(&mut scenario.conditions.faults);
        let trace = run(&terrain, &scenario).unwrap();
        assert_eq!(trace.safety, Default::default());
        let stop = trace.stops[0].expect("it stops");
        let mut file = Vec::new();
        trace.write(&mut file).unwrap();
        let read = Trace::read(file.as_slice()).unwrap();
        assert_eq!((&read.seen, &read.found), (&trace.seen, &trace.found));
        (stop, trace)
    };
    let span = |text: &str| -> CellSpan { text.parse().unwrap() };
    for planner in ALL {
        let (stop, trace) = fly(planner, &|faults| faults.blind = vec![span("9,9")]);
        let is_named = matches!(stop, Stop::Unseen { at, .. } if at == Cell::new(9, 9));
        assert!(is_named, "{planner}: {stop}");
        assert_eq!(trace.seen.last(), Some(&(all - 1)));

        let wall = |ticks: &str| {
            let wall = (0..24).map(|y| span(&format!("12,{y}{ticks}")));
            wall.collect::<Vec<_>>()
        };
        let (stop, trace) = fly(planner, &|faults| faults.closures = wall(""));
        let is_named = matches!(stop, Stop::Blocked { at, .. } if at.x == 12);
        assert!(is_named, "{planner}: {stop}");
        assert!(trace.seen.last() < Some(&all));
        assert!(trace.records.iter().all(|record| record.at.x < 12.0));
        let (stop, _) = fly(planner, &|faults| faults.closures = wall("@0-60"));
        assert_eq!(stop, Stop::Complete, "{planner}");

        let (stop, trace) = fly(planner, &|faults| {
            faults.sensor_failures = vec!["0@6".parse().unwrap()];
        });
        assert!(matches!(stop, Stop::Unseen { .. }), "{planner}: {stop}");
        assert_eq!(trace.seen.last(), trace.seen.get(6));

        let (stop, trace) = fly(planner, &|faults| {
            faults.lost_poses = vec!["0@6-30".parse().unwrap()];
        });
        assert_eq!(stop, Stop::Complete, "{planner}");
        let lost = trace
            .records
            .iter()
            .filter(|record| (6..30).contains(&record.tick));
        assert!(lost.into_iter().all(|record| record.deed == Deed::Hovered));
    }
}

/// In the wind surveys become complete, robots come home, and what they order is safe.
#[test]
fn wind_keeps_robots_from_nothing() {
    for (seed, planner) in (0..).zip(ALL) {
        for (robots, deviation) in [(1, 0.2), (4, 0.2)] {
            let terrain = match seed % 2 {
                0 => Terrain::gaussian(seed, 32),
                _ => Terrain::urban(seed, 32),
            };
            let mut scenario = Scenario::new(planner, robots, seed);
            scenario.conditions.wind = Wind { deviation };
            scenario.conditions.mission.come_home = true;
            let trace = run(&terrain, &scenario).unwrap();
            let case = format!("{planner} {robots} {deviation}: {:?}", trace.stops);
            assert_eq!(trace.safety, Default::default(), "{case}");
            assert!(trace.complete() && trace.all_stopped, "{case}");
            let summary = Summary::new(&trace);
            assert!(
                summary.robots.iter().all(|robot| robot.flown.is_home),
                "{case}"
            );
            assert_eq!(trace.digest(), run(&terrain, &scenario).unwrap().digest());
        }
    }
}

/// A least altitude costs what less is seen from it, and no flights that rising ground
/// forbids: as much of the range as it leaves is used.
#[test]
fn least_altitudes_forbid_no_flights() {
    let terrains: Vec<_> = (0..4)
        .map(|seed| Terrain::gaussian(910_001 + seed, 60))
        .collect();
    for planner in ALL {
        for range in [6.0, 8.0, 12.0] {
            let ticks = |min_altitude: f32| {
                let ticks = (0..).zip(&terrains).map(|(seed, terrain)| {
                    let mut scenario = Scenario::new(planner, 4, seed);
                    scenario.limits.range = range;
                    scenario.limits.min_altitude = min_altitude;
                    run(terrain, &scenario).unwrap().ticks_to(1.0).unwrap()
                });
                f64::from(ticks.sum::<u32>())
            };
            let unhindered = ticks(0.0);
            for altitude in [2.0, 3.0, 4.0, 6.0].into_iter().filter(|it| *it < range) {
                let factor = ticks(altitude) / unhindered;
                // Radius of what is seen of flat ground from there.
                let radius = |z: f32| f64::from((range * range - z * z).sqrt());
                let fair = radius(0.0) / radius(altitude);
                assert!(
                    factor < 1.3 * fair * fair,
                    "{planner}, range {range}, altitude {altitude}: {factor:.2}"
                );
            }
        }
    }
}

/// What a survey has patience for are flights, not steps: at a quarter of the step it flies
/// about as far.
#[test]
fn short_steps_fly_no_farther() {
    for planner in [Planner::CoordinatedSurvey, Planner::CoordinatedCubic] {
        let flown = |step: f32| {
            let ticks = (0..6).map(|seed| {
                let mut scenario = Scenario::new(planner, 8, seed);
                scenario.limits.step = step;
                let terrain = Terrain::gaussian(seed, 100);
                run(&terrain, &scenario).unwrap().ticks_to(1.0).unwrap()
            });
            f64::from(ticks.sum::<u32>()) * f64::from(step)
        };
        let factor = flown(0.5) / flown(2.0);
        assert!(factor < 1.15, "{planner}: {factor:.2}");
    }
}

/// By radio alone robots come to nearly as good an exploration, and never send more than
/// they may.
#[test]
fn frames_carry_what_robots_need() {
    for planner in OWN {
        let ticks = |medium| {
            let ticks = (0..6).map(|seed| {
                let mut scenario = Scenario::new(planner, 6, seed);
                scenario.conditions.medium = medium;
                let trace = run(&Terrain::gaussian(seed, 60), &scenario).unwrap();
                for record in &trace.records {
                    assert!(record.sent.bytes <= u32::from(scenario.conditions.byte_budget));
                    assert!(record.sent.bytes <= 55 * record.sent.frames);
                }
                trace.ticks_to(1.0).unwrap()
            });
            ticks.sum::<u32>()
        };
        let (ideal, radio) = (ticks(MediumKind::Ideal), ticks(MediumKind::Radio));
        assert!(radio * 10 <= ideal * 12, "{planner}: {radio} {ideal}");
    }
}

/// Whatever is lost, killed or slept through: every robot that lives ends complete,
/// and nothing unsafe happens.
#[test]
fn faults_slow_a_survey_but_do_not_stop_it() {
    for (seed, planner) in (0..).zip(OWN) {
        for (loss, skip, killed) in [
            (0.3, 0.0, 0),
            (0.9, 0.0, 0),
            (1.0, 0.0, 0),
            (0.0, 0.3, 0),
            (0.0, 0.6, 0),
            (0.1, 0.1, 3),
        ] {
            let terrain = Terrain::gaussian(seed, 40);
            let mut scenario = Scenario::new(planner, 4, seed);
            scenario.conditions.medium = MediumKind::Radio;
            (scenario.conditions.loss, scenario.skip) = (loss, skip);
            scenario.conditions.faults.deaths = (0..killed)
                .map(|robot| Event::from((robot, 5 + 7 * u32::from(robot))))
                .collect();
            let trace = run(&terrain, &scenario).unwrap();
            assert!(
                trace.complete(),
                "{planner:?} loss {loss} skip {skip} killed {killed}"
            );
            for robot in killed..4 {
                let last = trace.of(robot.into()).last().unwrap();
                assert_eq!(last.deed, Deed::Stopped(Reason::Complete));
            }
            assert_eq!(trace.safety, Default::default());
        }
    }
}

#[test]
fn the_same_seed_is_the_same_run() {
    let terrain = Terrain::gaussian(7, 40);
    for planner in ALL {
        let mut scenario = Scenario::new(planner, 4, 7);
        scenario.conditions.medium = MediumKind::Radio;
        (scenario.conditions.loss, scenario.skip) = (0.2, 0.1);
        let digest = |scenario: &Scenario| run(&terrain, scenario).unwrap().digest();
        let first = digest(&scenario);
        assert_eq!(first, digest(&scenario));
        scenario.conditions.seed = 8;
        assert_ne!(first, digest(&scenario));
    }
}

/// In towns, and where ground is higher than the ceiling, every planner ends, and says
/// truly whether everything was seen.
#[test]
fn every_survey_of_a_town_ends() {
    let tower = Cell::new(20, 14);
    let pierced = Terrain::from_fn(Extent::new(36, 36), |cell| {
        let is_tower = (cell.x - tower.x).abs() < 2 && (cell.y - tower.y).abs() < 2;
        Height(if is_tower { 200 } else { 0 })
    });
    for planner in ALL {
        for (seed, terrain) in [
            (1, &Terrain::urban(1, 40)),
            (2, &Terrain::urban(2, 40)),
            (3, &pierced),
        ] {
            let trace = run(terrain, &Scenario::new(planner, 3, seed)).unwrap();
            assert!(trace.all_stopped, "{planner} on {}", terrain.name());
            assert_eq!(
                trace.complete(),
                terrain.name() != pierced.name(),
                "{planner}"
            );
            for stop in trace.stops.iter().flatten() {
                let at = match stop {
                    Stop::Complete => {
                        assert!(trace.complete(), "{planner}");
                        continue;
                    }
                    Stop::Unseen { at, .. } | Stop::Held { at, .. } => at,
                    stop => panic!("{planner}: {stop:?}"),
                };
                let away = at.distance_squared(tower);
                assert!(!trace.complete() && away <= 18, "{planner}: {stop:?}");
            }
        }
    }
}

/// Two robots map a town of heights, and OctoMap's own tool reads what they mapped.
#[test]
fn a_town_is_mapped_as_octomap_reads_it() {
    let terrain = Terrain::urban(1, 60);
    for planner in OWN {
        let trace = run(&terrain, &Scenario::new(planner, 2, 1)).unwrap();
        assert!(trace.complete(), "{planner:?}");
        assert_eq!(trace.safety, Default::default());
        let tree = trace.octree(u32::MAX);
        check_with_octomap(&tree, "heights.bt");
    }
}

/// The work of a decision does not grow with the map or the fleet.
#[test]
fn work_is_bounded() {
    for planner in OWN {
        let work = |side: u16, robots: usize| {
            let terrain = Terrain::gaussian(3, side);
            let trace = run(&terrain, &Scenario::new(planner, robots, 3)).unwrap();
            let work = || trace.records.iter().map(|r| r.work);
            let mean = work().map(u64::from).sum::<u64>() / work().count() as u64;
            (mean, work().max().unwrap())
        };
        // Alone a robot makes most use of the costliest rule.
        let small = work(60, 1);
        for (mean, max) in [work(200, 1), work(200, 8), work(60, 16)] {
            // Which rules a robot uses most differs from map to map.
            assert!(mean <= 2 * small.0, "{planner}: {mean} {small:?}");
            assert!(2 * max <= 3 * small.1 + 200, "{planner}: {max} {small:?}");
        }
    }
}

/// One robot's whole state for 100×100 columns, heights included.
#[test]
fn a_robot_fits_into_24_kib() {
    use planner_core::{coordinated_survey::CoordinatedSurvey, fcao::Fcao};
    assert!(size_of::<Fcao<13, 13>>() <= 24 * 1024);
    assert!(size_of::<CoordinatedSurvey<13, 13>>() <= 24 * 1024);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// On small terrains of blocks and cliffs, everything that can be seen from beside
    /// what is known is seen.
    #[test]
    fn all_that_can_be_seen_is_seen(
        heights in prop::collection::vec(prop_oneof![3 => Just(0u8), 1 => 0u8..32], 25),
        planner in prop::sample::select(&OWN[..]),
        seed in 0u64..1000,
    ) {
        let terrain = Terrain::from_fn(Extent::new(15, 15), |cell| {
            Height(heights[(cell.y / 3 * 5 + cell.x / 3) as usize])
        });
        let mut scenario = Scenario::new(planner, 2, seed);
        scenario.limits.ceiling = 20.0;
        let trace = run(&terrain, &scenario).unwrap();
        let visible = visible(&terrain, &scenario, trace.starts[0], HashSet::new());
        prop_assert!(*trace.seen.last().unwrap() as usize >= visible.len(),
            "{} of {}", trace.seen.last().unwrap(), visible.len());
        prop_assert_eq!(trace.safety, Default::default());
    }
}
