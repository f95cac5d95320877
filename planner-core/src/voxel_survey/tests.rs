use std::collections::BTreeSet;
use std::vec::Vec;

use proptest::prelude::*;

use super::*;
use crate::volume::in_sight;

const EXTENT: Extent = Extent::new(11, 10);
const LEVELS: u8 = 7;
const RANGE: u8 = 4;

const CONFIG: Config = Config {
    range: RANGE,
    link: LinkConfig::new(),
};

type Robot = VoxelSurvey<2, 2, 7>;

fn all() -> impl Iterator<Item = Voxel> {
    (0..LEVELS as i16)
        .flat_map(|z| (0..10).flat_map(move |y| (0..11).map(move |x| Voxel::new(x, y, z))))
}

fn is_inside(voxel: Voxel) -> bool {
    EXTENT.contains(voxel.cell()) && (0..LEVELS as i16).contains(&voxel.z)
}

/// What a sensor at `eye` shows.
fn look(walls: &BTreeSet<Voxel>, eye: Voxel) -> Vec<(Voxel, bool)> {
    let range = u32::from(RANGE * RANGE);
    all()
        .filter(|&voxel| eye.distance_squared(voxel) <= range)
        .filter(|&voxel| in_sight(eye, voxel, |at| !walls.contains(&at)))
        .map(|voxel| (voxel, walls.contains(&voxel)))
        .collect()
}

/// Every voxel that is seen from any place that can be reached, by brute force.
fn visible(walls: &BTreeSet<Voxel>, start: Voxel) -> BTreeSet<Voxel> {
    let is_pose = |voxel: Voxel| {
        is_inside(voxel)
            && !walls.contains(&voxel)
            && voxel.beside().iter().all(|beside| !walls.contains(beside))
    };
    let mut reached = Vec::from([start]);
    let mut next = 0;
    while let Some(&at) = reached.get(next) {
        next += 1;
        for beside in at.beside() {
            if is_pose(beside) && !reached.contains(&beside) {
                reached.push(beside);
            }
        }
    }
    reached
        .iter()
        .flat_map(|&eye| look(walls, eye))
        .map(|(voxel, _)| voxel)
        .collect()
}

const START: Voxel = Voxel::new(5, 5, 4);

/// The slice, and the views that were begun within it: each at most two tiles by two of
/// seven levels, and a ray for each of 257 voxels within the range.
const MOST_WORK: u32 = 3 * 512 + SLICE + 24 * (28 + 257 * gain::RAY);

type Scattered = BTreeSet<(i16, i16, i16)>;
type Slabs = Vec<((i16, i16, i16), (i16, i16, i16))>;

fn walls() -> impl Strategy<Value = (Scattered, Slabs)> {
    (
        prop::collection::btree_set((0i16..11, 0i16..10, 0i16..7), 0..40),
        prop::collection::vec(
            ((0i16..11, 0i16..10, 0i16..7), (1i16..7, 1i16..7, 1i16..4)),
            0..5,
        ),
    )
}

/// Single voxels and slabs, with room for a robot at the start.
fn scene(scattered: &Scattered, slabs: &Slabs) -> BTreeSet<Voxel> {
    let mut walls: BTreeSet<Voxel> = scattered
        .iter()
        .map(|&(x, y, z)| Voxel::new(x, y, z))
        .collect();
    for &((x, y, z), (wide, deep, high)) in slabs {
        walls.extend(all().filter(|v| {
            (x..x + wide).contains(&v.x)
                && (y..y + deep).contains(&v.y)
                && (z..z + high).contains(&v.z)
        }));
    }
    walls.remove(&START);
    for beside in START.beside() {
        walls.remove(&beside);
    }
    walls
}

/// What a liar, or a broken radio, sends.
#[derive(Clone, Debug)]
enum Hostile {
    Bytes(Vec<u8>),
    Forged {
        status: Status,
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
            stopped,
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
        let mut robot = Robot::new(EXTENT, LEVELS, CONFIG, 0).unwrap();
        let mut speaker = Robot::new(EXTENT, LEVELS, CONFIG, 1).unwrap();
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
                            let tile = Tile { x, y };
                            let known = known & tile.inside(EXTENT.width, EXTENT.height);
                            if known != 0 {
                                frame.add(VoxelPatch { tile, z, known, occupied: occupied & known });
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
                let before = robot.clone();
                let heard = robot.receive(&bytes);
                if matches!(lie, Hostile::Corrupted(..) | Hostile::Cut(..)) {
                    prop_assert!(heard.is_err());
                }
                if heard.is_err() {
                    prop_assert_eq!(std::format!("{:?}", before), std::format!("{:?}", robot));
                }
            }
            match robot.tick() {
                Action::Fly(to) => {
                    prop_assert_eq!(at.distance_squared(to), 1);
                    prop_assert!(is_inside(to) && !walls.contains(&to));
                    prop_assert!(to.beside().iter().all(|beside| !walls.contains(beside)));
                    at = to;
                }
                Action::Hover => {}
                Action::Stop => break,
            }
        }
    }

    /// Whatever is lost on the way, maps come to be the same: each piece is told again
    /// and again.
    #[test]
    fn maps_become_the_same(
        (scattered, slabs) in walls(),
        lost in prop::collection::vec(any::<bool>(), 1..40),
        bytes_per_tick in 1u16..300,
    ) {
        prop_assume!(lost.contains(&false));
        let walls = scene(&scattered, &slabs);
        let link = LinkConfig { bytes_per_tick, ..LinkConfig::new() };
        let config = Config { link, ..CONFIG };
        let mut robots = [0, 1].map(|id| Robot::new(EXTENT, LEVELS, config, id).unwrap());
        robots[0].observe(START, &look(&walls, START));
        let mut buffer = [0; MAX_LEN];
        let mut losses = lost.iter().cycle();
        let mut bytes = 0;
        let wanted = robots[0].volume().known_voxels();
        for step in 1.. {
            prop_assert!(step < 200_000);
            while let Some(length) = robots[0].transmit(&mut buffer) {
                bytes += length;
                if !losses.next().unwrap() {
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
    let mut robots = [0, 1].map(|id| Robot::new(EXTENT, LEVELS, CONFIG, id).unwrap());
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
    let mut twin = Robot::new(EXTENT, LEVELS, CONFIG, 0).unwrap();
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
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Everything that can be seen from anywhere that can be reached is seen, and the
    /// robot never touches anything.
    #[test]
    fn all_that_can_be_seen_is_seen(
        (scattered, slabs) in walls(),
    ) {
        let walls = scene(&scattered, &slabs);
        let mut robot = Robot::new(EXTENT, LEVELS, CONFIG, 0).unwrap();
        let mut at = START;
        let mut steps = 0;
        loop {
            robot.observe(at, &look(&walls, at));
            let action = robot.tick();
            prop_assert!(robot.work() <= MOST_WORK, "{}", robot.work());
            match action {
                Action::Fly(to) => {
                    prop_assert_eq!(at.distance_squared(to), 1);
                    prop_assert!(is_inside(to) && !walls.contains(&to));
                    prop_assert!(to.beside().iter().all(|beside| !walls.contains(beside)));
                    at = to;
                }
                Action::Hover => {}
                Action::Stop => break,
            }
            steps += 1;
            prop_assert!(steps < 20_000);
        }
        for voxel in visible(&walls, START) {
            prop_assert!(robot.volume().content(voxel) != crate::volume::Content::Unknown, "{voxel:?}");
        }
    }
}

/// Whole state for 40×40×16 voxels.
#[test]
fn a_robot_fits_into_24_kib() {
    assert!(size_of::<VoxelSurvey<5, 5, 16>>() <= 24 * 1024);
}
