use std::collections::BTreeSet;
use std::vec::Vec;

use proptest::prelude::*;

use super::*;
use crate::radio::{FrameError, MAX_LEN, VoxelFrame};
use crate::robot::{Activity, Status};
use crate::volume::{Content, VoxelPatch, body_voxels, in_sight};

mod errs;
mod fields;
mod looks;
mod mission;
mod scenes;
mod wind;

use scenes::*;

/// What a liar, or a broken radio, sends.
#[derive(Clone, Debug)]
enum Hostile {
    Bytes(Vec<u8>),
    Forged {
        status: Status<Voxel>,
        patches: Vec<(u8, u8, u8, u64, u64)>,
        sequence: u16,
    },
    /// An own frame of before, under another name.
    Replayed(usize),
    /// The same with a bit the other way, or cut short.
    Corrupted(usize, usize),
    Cut(usize, usize),
}

fn hostile() -> impl Strategy<Value = Hostile> {
    let voxel = || (0i16..11, 0i16..10, 0i16..7).prop_map(|(x, y, z)| Voxel::new(x, y, z));
    let status = (voxel(), prop::option::of(voxel()), any::<bool>()).prop_map(
        |(position, goal, stopped)| Status {
            position,
            goal,
            activity: Activity::stopped_if(stopped),
        },
    );
    let patch = (
        0u8..2,
        0u8..2,
        0u8..7,
        any::<u64>(),
        prop_oneof![Just(0), any::<u64>()],
    );
    prop_oneof![
        prop::collection::vec(any::<u8>(), 0..60).prop_map(Hostile::Bytes),
        (status, prop::collection::vec(patch, 0..3), any::<u16>()).prop_map(
            |(status, patches, sequence)| Hostile::Forged {
                status,
                patches,
                sequence
            }
        ),
        any::<usize>().prop_map(Hostile::Replayed),
        (any::<usize>(), any::<usize>()).prop_map(|(n, bit)| Hostile::Corrupted(n, bit)),
        (any::<usize>(), 0usize..55).prop_map(|(n, length)| Hostile::Cut(n, length)),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    /// Among liars a robot touches nothing, stops, and is not changed by what it refuses.
    #[test]
    fn a_robot_among_liars_is_safe_and_stops(
        (scattered, slabs) in walls(),
        script in prop::collection::vec(prop::collection::vec(hostile(), 0..4), 1..60),
    ) {
        let walls = scene(&scattered, &slabs);
        let mut robot = Robot::new(CONFIG, RobotId(0), EXTENT, LEVELS).unwrap();
        let mut speaker = Robot::new(CONFIG, RobotId(1), EXTENT, LEVELS).unwrap();
        let mut air: Vec<Vec<u8>> = Vec::new();
        let mut at = START;
        for step in 0.. {
            prop_assert!(step < 20_000);
            let view = look(&walls, at);
            robot.observe(at, &view);
            speaker.observe(at, &view);
            speaker.tick();
            let mut buffer = [0xa5; MAX_LEN];
            while let Some(length) = speaker.transmit(&mut buffer) {
                air.push(buffer[..length].to_vec());
            }
            for lie in script.get(step % script.len()).unwrap() {
                let bytes = match lie {
                    Hostile::Bytes(bytes) => bytes.clone(),
                    Hostile::Forged { status, patches, sequence } => {
                        let mut frame = VoxelFrame {
                            grid: robot.sender.grid,
                            sender: RobotId(9),
                            sequence: *sequence,
                            status: *status,
                            patches: heapless::Vec::new(),
                        };
                        for &(x, y, z, known, occupied) in patches {
                            let tile = TileIndex { x, y };
                            let inside = tile.inside(EXTENT);
                            let (known, occupied) = (known & inside, occupied & inside);
                            let patch = VoxelPatch { tile, z, known, occupied };
                            if !patch.is_empty() {
                                frame.add(patch);
                            }
                        }
                        let length = frame.encode(None, &mut buffer);
                        buffer[..length].to_vec()
                    }
                    Hostile::Replayed(n) => air[n % air.len()].clone(),
                    Hostile::Corrupted(n, bit) => {
                        let mut bytes = air[n % air.len()].clone();
                        let bit = bit % (8 * bytes.len());
                        bytes[bit / 8] ^= 1 << (bit % 8);
                        bytes
                    }
                    Hostile::Cut(n, length) => {
                        let bytes = &air[n % air.len()];
                        bytes[..*length.min(&(bytes.len() - 1))].to_vec()
                    }
                };
                let mut before = robot.clone();
                let heard = robot.receive(&bytes);
                // What was refused is counted.
                before.sender.hearsay = robot.sender.hearsay;
                if matches!(lie, Hostile::Corrupted(..) | Hostile::Cut(..)) {
                    prop_assert!(heard.is_err());
                }
                if heard.is_err() {
                    prop_assert_eq!(std::format!("{:?}", before), std::format!("{:?}", robot));
                }
            }
            match robot.tick() {
                Action::Move(to) => {
                    prop_assert_eq!(at.distance_squared(to), 1);
                    prop_assert!(is_inside(to) && !walls.contains(&to));
                    prop_assert!(to.beside().iter().all(|beside| !walls.contains(beside)));
                    at = to;
                }
                Action::Wait => {}
                Action::Stop(_) => break,
            }
        }
    }

    /// Whatever is lost on the way, maps come to be the same: each piece is told again
    /// and again.
    #[test]
    fn maps_become_the_same(
        (scattered, slabs) in walls(),
        lost in 0u64..240,
        bytes_per_tick in 1u16..300,
        seed in any::<u64>(),
    ) {
        let walls = scene(&scattered, &slabs);
        let link = LinkConfig { bytes_per_tick, ..LinkConfig::new() };
        let config = Config { link, ..CONFIG };
        let mut robots = [0, 1].map(|id| Robot::new(config, RobotId(id), EXTENT, LEVELS).unwrap());
        robots[0].observe(START, &look(&walls, START));
        let mut buffer = [0; MAX_LEN];
        // By chance: what is lost in turn could be what is told in turn, for ever.
        let mut dice = crate::rng::Rng::new(seed, 0);
        let mut is_lost = || u64::from(dice.next_u32() >> 24) < lost;
        let mut bytes = 0;
        let wanted = robots[0].volume().known_voxels();
        for step in 1.. {
            prop_assert!(step < 200_000);
            while let Some(length) = robots[0].transmit(&mut buffer) {
                bytes += length;
                if !is_lost() {
                    robots[1].receive(&buffer[..length]).unwrap();
                }
            }
            prop_assert!(bytes <= step * usize::from(bytes_per_tick).max(1));
            if robots[1].volume().known_voxels() == wanted {
                break;
            }
            robots[0].tick();
        }
    }
}

/// What one robot knows of another: its own frames it does not take, and a frame that is
/// late or replayed does not bring back where the other was.
#[test]
fn late_frames_are_old_news() {
    let mut robots = [0, 1].map(|id| Robot::new(CONFIG, RobotId(id), EXTENT, LEVELS).unwrap());
    let frames: Vec<Vec<u8>> = (3..6)
        .map(|x| {
            let mut buffer = [0; MAX_LEN];
            robots[0].observe(Voxel::new(x, 5, 4), &[]);
            robots[0].tick();
            let length = robots[0].transmit(&mut buffer).unwrap();
            buffer[..length].to_vec()
        })
        .collect();
    for bytes in [&frames[0], &frames[2], &frames[1], &frames[0]] {
        robots[1].receive(bytes).unwrap();
    }
    assert_eq!(robots[0].receive(&frames[0]), Err(FrameError::Own));
    // Another robot of the same id.
    let mut buffer = [0; MAX_LEN];
    robots[0].tick();
    let length = robots[0].transmit(&mut buffer).unwrap();
    let mut twin = Robot::new(CONFIG, RobotId(0), EXTENT, LEVELS).unwrap();
    let refused = twin.receive(&buffer[..length]);
    assert_eq!(refused, Err(FrameError::SameId(RobotId(0))));
    assert_eq!(twin.hearsay().same_id, 1);
    let heard: Vec<Voxel> = robots[1]
        .peers
        .iter()
        .map(|peer| peer.status.position)
        .collect();
    assert_eq!(heard, [Voxel::new(5, 5, 4)]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    /// Everything that can be seen from anywhere that can be reached is seen, and the
    /// robot never touches anything.
    #[test]
    fn all_that_can_be_seen_is_seen(
        (scattered, slabs) in walls(),
        clearance in 0u8..=2,
    ) {
        let mut walls = scene(&scattered, &slabs);
        for voxel in body_voxels(clearance, START) {
            walls.remove(&voxel);
        }
        let config = Config { clearance, ..CONFIG };
        let mut robot = Robot::new(config, RobotId(0), EXTENT, LEVELS).unwrap();
        let mut at = START;
        let mut steps = 0;
        loop {
            robot.observe(at, &look(&walls, at));
            let action = robot.tick();
            prop_assert!(robot.work() <= MOST_WORK, "{}", robot.work());
            match action {
                Action::Move(to) => {
                    prop_assert_eq!(at.distance_squared(to), 1);
                    prop_assert!(is_clear(&walls, clearance, to));
                    at = to;
                }
                Action::Wait => {}
                Action::Stop(stop) => {
                    prop_assert!(stop.is_complete(), "{stop}");
                    prop_assert_eq!(stop.left(), robot.volume().frontiers());
                    break;
                }
            }
            steps += 1;
            prop_assert!(steps < 20_000);
        }
        for voxel in visible(&walls, START, clearance) {
            prop_assert!(robot.volume().content(voxel) != crate::volume::Content::Unknown, "{voxel:?}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    /// Glass, dark voxels, a sensor that fails, and others who say what they like, for
    /// ever: the robot stops, the reason is true, and all else was seen before.
    #[test]
    fn every_survey_ends_in_a_true_reason(
        (scattered, slabs) in walls(),
        glass in prop_oneof![places(12), places(200)],
        dark in places(6),
        silent_from in prop::option::weighted(0.1, 0u32..200),
        script in script(),
        loud in prop_oneof![0u32..400, Just(u32::MAX)],
    ) {
        let walls = scene(&scattered, &slabs);
        let dark: BTreeSet<_> = dark.into_iter().filter(|voxel| !START.beside().contains(voxel)).collect();
        let world = World { walls, glass, dark, silent_from };
        let mut robot = Robot::new(CONFIG, RobotId(0), EXTENT, LEVELS).unwrap();
        let mut at = START;
        let (stop, _) = world.fly(&mut robot, &mut at, &script, loud, 200_000);
        world.is_true(stop, &robot);
        if world.silent_from.is_none() {
            for voxel in world.visible() {
                prop_assert!(robot.volume().content(voxel) != Content::Unknown, "{voxel} {stop}");
            }
        }
    }

    /// Bad poses, however many: no decision, nothing learnt; and then it goes on.
    #[test]
    fn nothing_is_decided_from_a_bad_pose(
        begin in 0u32..60,
        length in 1u32..200,
        bad in prop::sample::select(std::vec![
            Voxel::new(-1, 5, 4), Voxel::new(11, 5, 4), Voxel::new(5, 5, 7),
            Voxel::new(i16::MAX, i16::MIN, 0),
        ]),
    ) {
        let world = World {
            walls: all().filter(|voxel| voxel.z == 0).collect(),
            ..World::default()
        };
        let mut robot = Robot::new(CONFIG, RobotId(0), EXTENT, LEVELS).unwrap();
        let mut at = START;
        for step in 0.. {
            prop_assert!(step < 5_000);
            if (begin..begin + length).contains(&step) && step > 0 {
                let known = robot.volume().known_voxels();
                robot.observe(bad, &world.look(Voxel::new(9, 9, 5), step));
                prop_assert_eq!(robot.tick(), Action::Wait);
                prop_assert_eq!(robot.waiting(), Some(Wait::Pose));
                prop_assert_eq!(robot.volume().known_voxels(), known);
                continue;
            }
            robot.observe(at, &world.look(at, step));
            match robot.tick() {
                Action::Move(to) => at = to,
                Action::Wait => {}
                Action::Stop(stop) => {
                    prop_assert!(stop.is_complete(), "{stop}");
                    break;
                }
            }
        }
    }
}

/// A pane of glass across the box: everything on this side is seen, then it is named; a
/// gap in it is found; and when it is gone, the robot goes on.
#[test]
fn glass_is_named_and_gaps_are_found() {
    let pane = || all().filter(|voxel| voxel.x == 6);
    // Sight ends there too, so that there is something to fly for.
    let curtain: BTreeSet<Voxel> = all()
        .filter(|voxel| voxel.x == 9 && !(4..7).contains(&voxel.y))
        .collect();
    for gap in [None, Some(Voxel::new(6, 1, 1))] {
        let mut world = World {
            walls: curtain.clone(),
            glass: pane().filter(|&voxel| Some(voxel) != gap).collect(),
            ..World::default()
        };
        let mut robot = Robot::new(CONFIG, RobotId(0), EXTENT, LEVELS).unwrap();
        let mut at = START;
        let (stop, steps) = world.fly(&mut robot, &mut at, &Vec::new(), 0, 20_000);
        std::eprintln!("{stop} after {steps} steps");
        for voxel in world.visible() {
            assert!(robot.volume().content(voxel) != Content::Unknown, "{voxel}");
        }
        if gap.is_none() {
            assert!(
                matches!(stop, Stop::Blocked { at, .. } if at.x == 6),
                "{stop}"
            );
            world.glass.clear();
            robot.resume();
            let (stop, _) = world.fly(&mut robot, &mut at, &Vec::new(), 0, 20_000);
            assert!(stop.is_complete(), "{stop}");
            for voxel in world.visible() {
                assert!(robot.volume().content(voxel) != Content::Unknown, "{voxel}");
            }
        } else {
            assert!(stop.is_complete(), "{stop}");
        }
    }
}

/// A voxel that no look shows is named, and one that shows at last is seen after all.
#[test]
fn a_dark_voxel_is_named() {
    let dark = Voxel::new(2, 7, 2);
    let mut world = World {
        dark: [dark].into(),
        ..World::default()
    };
    let mut robot = Robot::new(CONFIG, RobotId(0), EXTENT, LEVELS).unwrap();
    let mut at = START;
    let (stop, _) = world.fly(&mut robot, &mut at, &Vec::new(), 0, 20_000);
    let frontiers = 6;
    assert_eq!(
        stop,
        Stop::Unseen {
            frontiers,
            at: dark
        }
    );
    world.dark.clear();
    robot.resume();
    let (stop, _) = world.fly(&mut robot, &mut at, &Vec::new(), 0, 20_000);
    assert_eq!(stop, Stop::Complete);
}

/// A sensor that fails ends the survey soon, and one that comes back goes on.
#[test]
fn a_silent_sensor_is_a_reason_to_stop() {
    for from in [0, 7] {
        let mut world = World {
            silent_from: Some(from),
            ..World::default()
        };
        let mut robot = Robot::new(CONFIG, RobotId(0), EXTENT, LEVELS).unwrap();
        let mut at = START;
        let (stop, steps) = world.fly(&mut robot, &mut at, &Vec::new(), 0, 20_000);
        assert!(
            matches!(stop, Stop::Unseen { .. }) && steps < 120,
            "{stop} {steps}"
        );
        world.is_true(stop, &robot);
        world.silent_from = None;
        let (stop, _) = world.fly(&mut robot, &mut at, &Vec::new(), 0, 20_000);
        assert_eq!(stop, Stop::Complete);
    }
}

/// A robot that was reset decides as a new one; one that cannot be is as it was.
#[test]
fn a_reset_robot_is_a_new_one() {
    let world = World::default();
    let mut robot = Robot::new(CONFIG, RobotId(3), EXTENT, LEVELS).unwrap();
    world.fly(&mut robot, &mut START.clone(), &Vec::new(), 0, 20_000);
    let before = std::format!("{robot:?}");
    let (asked, capacity) = (Extent::new(17, 3), Extent::new(16, 16));
    assert_eq!(
        robot.reset(CONFIG, RobotId(1), asked, LEVELS),
        Err(ExtentError::TooLarge { asked, capacity })
    );
    assert_eq!(std::format!("{robot:?}"), before);
    robot.reset(CONFIG, RobotId(0), EXTENT, LEVELS).unwrap();
    let new = Robot::new(CONFIG, RobotId(0), EXTENT, LEVELS).unwrap();
    // Why it stopped last is remembered, and means nothing.
    robot.reason = new.reason;
    assert_eq!(std::format!("{robot:?}"), std::format!("{new:?}"));
}

/// Also where numbers of tiles and levels end.
#[test]
fn what_is_within_range_is_told_once() {
    for (range, x, y, z) in [
        (4u8, 0u8, 0u8, 0u8),
        (12, 3, 1, 9),
        (8, 2, 2, 250),
        (12, 62, 63, 254),
    ] {
        let tiles = range.div_ceil(8);
        let mut expected = Vec::new();
        for level in z.saturating_sub(range)..=z.saturating_add(range).min(254) {
            for row in y.saturating_sub(tiles)..=y + tiles {
                let columns = x.saturating_sub(tiles)..=x + tiles;
                expected.extend(columns.map(|column| (TileIndex::new(column, row), level)));
            }
        }
        let found = gain::within(range, TileIndex::new(x, y), z);
        assert_eq!(found.collect::<Vec<_>>(), expected);
    }
}

/// Whole state for 40×40×16 voxels.
#[test]
fn a_robot_fits_into_24_kib() {
    assert!(size_of::<VoxelSurvey<5, 5, 16>>() <= 24 * 1024);
}
