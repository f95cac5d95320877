//! Among voxels.

use std::collections::BTreeMap;

use host_sim::record::voxels::VoxelTrace;
use host_sim::run::voxels::run;
use host_sim::scenario::voxels::{Planner, Scenario};
use host_sim::scenario::{MediumKind, Preset};
use host_sim::scene::{self, Scene};
use planner_core::Extent;
use planner_core::volume::{Content, Field};
use proptest::prelude::*;

use crate::check_with_octomap;

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

/// Two robots map a town of voxels to the last one that can be seen, and OctoMap reads
/// it.
#[test]
fn a_town_of_voxels_is_mapped_as_octomap_reads_it() {
    use MediumKind::{Ideal, Radio};
    for (seed, medium, loss) in [(1, Ideal, 0.0), (2, Ideal, 0.5), (2, Radio, 0.5)] {
        let mut scenario = Scenario::new(2, seed);
        scenario.conditions.medium = medium;
        scenario.conditions.loss = loss;
        let trace = run(&Scene::town(seed, 28), &scenario).unwrap();
        assert!(trace.complete() && trace.all_stopped);
        assert_eq!(
            trace.digest(),
            run(&trace.scene, &scenario).unwrap().digest()
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
            let mut scenario = Scenario::new(3, seed);
            scenario.conditions.medium = medium;
            let trace = run(&Scene::town(seed, 28), &scenario).unwrap();
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
        (Planner::ClosestFrontier, 1, MediumKind::Ideal),
        (Planner::ClosestFrontier, 2, MediumKind::Radio),
        (Planner::Greedy, 3, MediumKind::Ideal),
        (Planner::Greedy, 2, MediumKind::Radio),
    ] {
        let mut scenario = Scenario::new(robots, 1);
        scenario.planner = planner;
        scenario.conditions.medium = medium;
        let trace = run(&Scene::town(2, 20), &scenario).unwrap();
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

/// What the planner is compared with believes what it sees: looks that err are refused by name.
#[test]
fn baselines_among_voxels_refuse_looks_that_err() {
    type Err = fn(&mut Scenario);
    let errs: [(&str, Err); 3] = [
        ("false-walls", |scenario| {
            scenario.conditions.trouble.false_walls = 0.01;
        }),
        ("false-frees", |scenario| {
            scenario.conditions.trouble.false_frees = 0.01;
        }),
        ("preset", |scenario| {
            scenario.conditions.preset = Preset::Rangers;
        }),
    ];
    for planner in [Planner::ClosestFrontier, Planner::Greedy] {
        for (option, err) in errs {
            let mut scenario = Scenario::new(2, 1);
            err(&mut scenario);
            scenario.check(&Scene::town(2, 20)).unwrap();
            scenario.planner = planner;
            let error = run(&Scene::town(2, 20), &scenario).unwrap_err().to_string();
            let names_it = error.contains(option) && error.contains("believes every look");
            assert!(names_it, "{error}");
        }
    }
}

/// Robots share out the search for the last voxels too: three take less than half as
/// long as one.
#[test]
fn voxels_are_shared_out() {
    let ticks = |robots| {
        let ticks = (1..4).map(|seed| {
            let mut scenario = Scenario::new(robots, seed);
            scenario.conditions.medium = MediumKind::Radio;
            let trace = run(&Scene::town(seed, 28), &scenario).unwrap();
            trace.ticks_to(1.0).unwrap()
        });
        ticks.sum::<u32>()
    };
    let (alone, together) = (ticks(1), ticks(3));
    assert!(2 * together < alone, "{together} {alone}");
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
        let mut scenario = Scenario::new(robots, seed);
        scenario.range = 4;
        scenario.field = field;
        scenario.conditions.medium = MediumKind::Radio;
        scenario.conditions.byte_budget = byte_budget;
        scenario.conditions.loss = loss;
        // Without room for a robot there is no run.
        if let Ok(trace) = run(&scene, &scenario) {
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
        let mut scenario = Scenario::new(robots, 1);
        scenario.range = 4;
        if let Ok(trace) = run(&scene, &scenario) {
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
