//! What a survey owes, over random terrains, fleets and faults.

use std::collections::BTreeMap;

use host_sim::record::Deed;
use host_sim::record::heights::Trace;
use host_sim::record::voxels::VoxelTrace;
use host_sim::run::heights::run;
use host_sim::run::voxels;
use host_sim::scenario::heights::{Planner, Scenario};
use host_sim::scenario::voxels::{Planner as VoxelPlanner, Scenario as VoxelScenario};
use host_sim::scenario::{CellSpan, Event, Faults, MediumKind, Mission, Wind};
use host_sim::scene::octree::OcTree;
use host_sim::scene::{self, Scene};
use host_sim::summary::heights::Summary;
use host_sim::terrain::{Terrain, look};
use planner_core::surface::Height;
use planner_core::volume::{Content, Field};
use planner_core::{Cell, Direction, Extent, Point, Reason, Stop};
use proptest::prelude::*;

const ALL: [Planner; 8] = [
    Planner::CoordinatedSurvey,
    Planner::CoordinatedCubic,
    Planner::Fcao,
    Planner::ClosestFrontier,
    Planner::Greedy,
    Planner::GreedyUnique,
    Planner::GreedyInOrder,
    Planner::ClosestUntilReached,
];

const FIELDS: [Field; 5] = [
    Field::ALL_ROUND,
    Field::CAMERA,
    Field::DOWNWARD,
    Field::LIDAR,
    Field {
        up: 0,
        down: 700,
        side: Some(110),
        near: 3,
    },
];

const OWN: [Planner; 3] = [
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
                assert!(robot.is_home, "{case}");
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
            assert!(summary.robots.iter().all(|robot| robot.is_home), "{case}");
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

/// Runs OctoMap's own tools on a file that the fleet has written: they read it, count
/// as many nodes, and find as many occupied cubes.
fn check_with_octomap(tree: &OcTree, name: &str) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    tree.write(std::fs::File::create(&path).unwrap()).unwrap();
    let run = |tool: &str, arguments: &[&std::path::Path]| {
        let done = std::process::Command::new(tool).args(arguments).output();
        let done = done.unwrap_or_else(|error| {
            panic!("{tool}: {error}; install it: apt-get install octomap-tools, or cargo xtask test --only octomap")
        });
        assert!(done.status.success(), "{tool}: {done:?}");
    };
    run("bt2vrml", &[&path]);
    let vrml = std::fs::read_to_string(path.with_extension("bt.wrl")).unwrap();
    let occupied = tree.cubes().iter().filter(|cube| cube.occupied).count();
    assert_eq!(vrml.matches("Box {").count(), occupied);
    let other = path.with_extension("ot");
    run("convert_octree", &[&path, &other]);
    let read = std::fs::read(&other).unwrap();
    let size = format!("\nsize {}\n", tree.nodes());
    assert!(
        read.windows(size.len())
            .any(|bytes| bytes == size.as_bytes())
    );
}

#[test]
fn octomap_reads_any_tree() {
    let mut tree = OcTree::new(0.5);
    for i in 0..2000 {
        tree.insert([i % 23, i / 23 % 19, (i * i) % 11], i % 3 != 0);
    }
    check_with_octomap(&tree, "any.bt");
}

/// Two robots map a town of voxels to the last one that can be seen, and OctoMap reads
/// it.
#[test]
fn a_town_of_voxels_is_mapped_as_octomap_reads_it() {
    use MediumKind::{Ideal, Radio};
    for (seed, medium, loss) in [(1, Ideal, 0.0), (2, Ideal, 0.5), (2, Radio, 0.5)] {
        let mut scenario = VoxelScenario::new(2, seed);
        scenario.conditions.medium = medium;
        scenario.conditions.loss = loss;
        let trace = voxels::run(&Scene::town(seed, 28), &scenario).unwrap();
        assert!(trace.complete() && trace.all_stopped);
        assert_eq!(
            trace.digest(),
            voxels::run(&trace.scene, &scenario).unwrap().digest()
        );
        check_with_octomap(&trace.octree(u32::MAX), "town.bt");
    }
}

/// By radio robots come to nearly as good an exploration of a town of voxels, and never
/// send more than they may.
#[test]
fn frames_carry_voxels() {
    let ticks = |medium| {
        let ticks = (1..4).map(|seed| {
            let mut scenario = VoxelScenario::new(3, seed);
            scenario.conditions.medium = medium;
            let trace = voxels::run(&Scene::town(seed, 28), &scenario).unwrap();
            assert!(trace.complete() && trace.all_stopped);
            let sent = || trace.records.iter().map(|record| record.sent);
            for sent in sent() {
                assert!(sent.bytes <= u32::from(scenario.conditions.byte_budget));
                assert!(sent.bytes <= 55 * sent.frames);
            }
            assert_eq!(
                sent().any(|sent| sent.bytes > 0),
                medium == MediumKind::Radio
            );
            trace.ticks_to(1.0).unwrap()
        });
        ticks.sum::<u32>()
    };
    let (ideal, radio) = (ticks(MediumKind::Ideal), ticks(MediumKind::Radio));
    assert!(radio * 10 <= ideal * 12, "{radio} {ideal}");
}

/// What the planner is compared with sees all of a town as well, by the ideal medium and by
/// radio, and ends for reasons that hold.
#[test]
fn baselines_among_voxels_see_all_and_stop_truthfully() {
    for (planner, robots, medium) in [
        (VoxelPlanner::ClosestFrontier, 1, MediumKind::Ideal),
        (VoxelPlanner::ClosestFrontier, 2, MediumKind::Radio),
        (VoxelPlanner::Greedy, 3, MediumKind::Ideal),
        (VoxelPlanner::Greedy, 2, MediumKind::Radio),
    ] {
        let mut scenario = VoxelScenario::new(robots, 1);
        scenario.planner = planner;
        scenario.conditions.medium = medium;
        let trace = voxels::run(&Scene::town(2, 20), &scenario).unwrap();
        assert!(trace.complete(), "{planner:?} {robots} {medium:?}");
        assert!(trace.all_stopped);
        for stop in &trace.stops {
            let is_complete = stop.is_some_and(|stop| stop.reason().is_complete());
            assert!(is_complete, "{stop:?}");
        }
        let mut file = Vec::new();
        trace.write(&mut file).unwrap();
        let read = VoxelTrace::read(&file[..]).unwrap();
        assert_eq!(read.scenario, trace.scenario);
    }
}

/// Robots share out the search for the last voxels too: three take less than half as
/// long as one.
#[test]
fn voxels_are_shared_out() {
    let ticks = |robots| {
        let ticks = (1..4).map(|seed| {
            let mut scenario = VoxelScenario::new(robots, seed);
            scenario.conditions.medium = MediumKind::Radio;
            let trace = voxels::run(&Scene::town(seed, 28), &scenario).unwrap();
            trace.ticks_to(1.0).unwrap()
        });
        ticks.sum::<u32>()
    };
    let (alone, together) = (ticks(1), ticks(3));
    assert!(2 * together < alone, "{together} {alone}");
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

/// Everything that can be seen from just inside the edges of columns that border unseen
/// ones and can be flown to over seen ones, from low to high in steps, again and again
/// until nothing is new.
fn visible(terrain: &Terrain, scenario: &Scenario, start: Point) -> Vec<Cell> {
    let limits = scenario.limits;
    let mut seen: Vec<Cell> = look(terrain, start, limits.range)
        .iter()
        .map(|c| c.cell)
        .collect();
    loop {
        let before = seen.len();
        let mut reached = vec![start.cell()];
        let mut next = 0;
        while let Some(&cell) = reached.get(next) {
            next += 1;
            for beside in Direction::ALL.map(|direction| cell.step(direction)) {
                if seen.contains(&beside) && !reached.contains(&beside) {
                    reached.push(beside);
                }
            }
        }
        for cell in reached {
            for direction in Direction::ALL {
                let beyond = cell.step(direction);
                if !terrain.extent().contains(beyond) || seen.contains(&beyond) {
                    continue;
                }
                let (dx, dy) = direction.delta();
                let ground = terrain.height(cell).unwrap().cells();
                let mut z = ground + limits.min_altitude + 0.1;
                while z <= limits.ceiling {
                    let eye = Point::over(cell, z).offset(
                        0.45 * f32::from(dx),
                        0.45 * f32::from(dy),
                        0.0,
                    );
                    let new = look(terrain, eye, limits.range);
                    seen.extend(
                        new.iter()
                            .map(|c| c.cell)
                            .filter(|c| !seen.contains(c))
                            .collect::<Vec<_>>(),
                    );
                    z += limits.step;
                }
            }
        }
        if seen.len() == before {
            return seen;
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// Whatever share of the frames is lost, all of them too, and whatever the sensors show
    /// at once: everything that can be seen
    /// of a scene of voxels is seen, and every robot stops.
    #[test]
    fn losses_leave_no_voxel_unseen(
        slabs in prop::collection::vec(((0i16..14, 0i16..13, 0i16..8), (1i16..7, 1i16..7, 1i16..4)), 0..6),
        robots in 1usize..5,
        loss in prop_oneof![Just(0.0), Just(1.0), 0.0..1.0],
        byte_budget in prop::sample::select(&[0u16, 20, 55, 275][..]),
        seed in 0u64..1000,
        field in prop::sample::select(&FIELDS[..]),
    ) {
        let scene = Scene::from_fn("slabs", Extent::new(14, 13), 8, |v| {
            slabs.iter().any(|&((x, y, z), (wide, deep, high))| {
                (x..x + wide).contains(&v.x) && (y..y + deep).contains(&v.y) && (z..z + high).contains(&v.z)
            })
        });
        let mut scenario = VoxelScenario::new(robots, seed);
        scenario.range = 4;
        scenario.field = field;
        scenario.conditions.medium = MediumKind::Radio;
        scenario.conditions.byte_budget = byte_budget;
        scenario.conditions.loss = loss;
        // Without room for a robot there is no run.
        if let Ok(trace) = voxels::run(&scene, &scenario) {
            prop_assert!(trace.complete(), "{} of {}", trace.seen.last().unwrap(), trace.visible);
            prop_assert!(trace.all_stopped);
        }
    }

    /// In a scan with holes, too, what is seen is all that looks from every place that can
    /// be reached show, the free and the occupied.
    #[test]
    fn of_a_scan_all_is_seen_that_can_be(
        slabs in prop::collection::vec(((0i16..14, 0i16..13, 0i16..8), (1i16..7, 1i16..7, 1i16..4)), 0..6),
        robots in 1usize..4,
        wide in any::<bool>(),
    ) {
        let width = if wide { 70 } else { 14 };
        let scene = Scene::from_contents("scan", Extent::new(width, 13), 8, |v| {
            let slab = slabs.iter().position(|&((x, y, z), (wide, deep, high))| {
                (x..x + wide).contains(&v.x) && (y..y + deep).contains(&v.y) && (z..z + high).contains(&v.z)
            });
            match slab {
                Some(number) if number % 2 == 0 => Content::Unknown,
                Some(_) => Content::Occupied,
                None if v.x >= 14 => Content::Unknown,
                None => Content::Free,
            }
        });
        let mut scenario = VoxelScenario::new(robots, 1);
        scenario.range = 4;
        if let Ok(trace) = voxels::run(&scene, &scenario) {
            let start = trace.ways[0][0];
            let mut reached = vec![start];
            let mut expected = BTreeMap::new();
            let mut next = 0;
            while let Some(&at) = reached.get(next) {
                next += 1;
                expected.extend(scene::look(&scene, at, 4));
                for beside in at.beside() {
                    let stays_clear = beside.beside().iter().chain([&beside]).all(|&voxel| {
                        matches!(scene.content(voxel), None | Some(Content::Free))
                    });
                    if stays_clear && scene.content(beside).is_some() && !reached.contains(&beside) {
                        reached.push(beside);
                    }
                }
            }
            expected.retain(|voxel, _| scene.content(*voxel) != Some(Content::Unknown));
            let found: BTreeMap<_, _> = trace.found.iter().map(|&(_, voxel, occupied)| (voxel, occupied)).collect();
            prop_assert_eq!(found, expected);
            prop_assert!(trace.all_stopped && trace.complete());
            let mut file = Vec::new();
            trace.write(&mut file).unwrap();
            let read = VoxelTrace::read(&file[..]).unwrap();
            prop_assert_eq!(read.scene, trace.scene);
            prop_assert_eq!(read.found, trace.found);
        }
    }
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
        let visible = visible(&terrain, &scenario, trace.starts[0]);
        prop_assert!(*trace.seen.last().unwrap() as usize >= visible.len(),
            "{} of {}", trace.seen.last().unwrap(), visible.len());
        prop_assert_eq!(trace.safety, Default::default());
    }
}
