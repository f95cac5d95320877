//! A sensor that errs.

use super::*;
use crate::rng::Rng;

/// Shares of the looks at a voxel that show a wall that is none, and none where one is.
#[derive(Clone, Copy, Debug)]
struct Noise {
    false_walls: f32,
    false_frees: f32,
}

/// What a sensor at `eye` shows that takes walls for none and none for walls: it sees no farther
/// than it believes to.
fn erring_look(
    walls: &BTreeSet<Voxel>,
    eye: Voxel,
    noise: Noise,
    dice: &mut Rng,
) -> Vec<(Voxel, bool)> {
    let mut taken = walls.clone();
    for voxel in all().filter(|&voxel| voxel != eye) {
        let is_wall = walls.contains(&voxel);
        let share = if is_wall {
            noise.false_frees
        } else {
            noise.false_walls
        };
        if (dice.next_u32() as f32) < share * u32::MAX as f32 {
            match is_wall {
                true => taken.remove(&voxel),
                false => taken.insert(voxel),
            };
        }
    }
    look(&taken, eye)
}

/// What such a sensor shows that sees as far as there is something to see.
fn told(walls: &BTreeSet<Voxel>, eye: Voxel, noise: Noise, dice: &mut Rng) -> Vec<(Voxel, bool)> {
    let mut view = look(walls, eye);
    for (voxel, occupied) in &mut view {
        let share = match *occupied {
            true => noise.false_frees,
            false => noise.false_walls,
        };
        *occupied ^= *voxel != eye && (dice.next_u32() as f32) < share * u32::MAX as f32;
    }
    view
}

/// What a sensor shows of walls from a place.
type Sense = fn(&BTreeSet<Voxel>, Voxel, Noise, &mut Rng) -> Vec<(Voxel, bool)>;

/// What became of a flight.
struct End {
    stop: Stop<Voxel>,
    robot: Robot,
    touches: u32,
}

fn fly(walls: &BTreeSet<Voxel>, sensor: Sensor, noise: Noise, seed: u64) -> Option<End> {
    fly_with(erring_look, walls, sensor, noise, seed, 20_000)
}

fn fly_with(
    sense: Sense,
    walls: &BTreeSet<Voxel>,
    sensor: Sensor,
    noise: Noise,
    seed: u64,
    most: u32,
) -> Option<End> {
    let config = Config { sensor, ..CONFIG };
    let mut robot = Robot::new(config, RobotId(0), EXTENT, LEVELS).unwrap();
    let mut dice = Rng::new(seed, 0);
    let (mut at, mut touches) = (START, 0);
    for _ in 0..most {
        robot.observe(at, &sense(walls, at, noise, &mut dice));
        let action = robot.tick();
        assert!(robot.work() <= MOST_WORK, "{}", robot.work());
        match action {
            Action::Move(to) => {
                assert_eq!(at.distance_squared(to), 1);
                if is_clear(walls, CONFIG.clearance, to) {
                    at = to;
                } else {
                    touches += 1;
                }
            }
            Action::Wait => {}
            Action::Stop(stop) => {
                return Some(End {
                    stop,
                    robot,
                    touches,
                });
            }
        }
    }
    None
}

/// Single voxels and slabs, drawn by `seed`.
fn drawn(seed: u64) -> BTreeSet<Voxel> {
    let mut dice = Rng::new(seed, 1);
    let mut below = |n: u32| (dice.next_u32() % n) as i16;
    let scattered = (0..below(40)).map(|_| (below(11), below(10), below(7)));
    let scattered: Scattered = scattered.collect();
    let slabs = (0..below(5)).map(|_| {
        let corner = (below(11), below(10), below(7));
        (corner, (1 + below(6), 1 + below(6), 1 + below(3)))
    });
    let slabs: Slabs = slabs.collect();
    scene(&scattered, &slabs)
}

/// Of so many scenes, those in which the robot says that nothing is left, and those of them in
/// which it has left something out.
fn claims(sensor: Sensor, noise: Noise, scenes: u64) -> (u32, u32) {
    let (mut claims, mut wrong) = (0, 0);
    for seed in 0..scenes {
        let walls = drawn(seed);
        let end = fly(&walls, sensor, noise, seed).expect("it ends");
        if noise.false_frees == 0.0 {
            assert_eq!(end.touches, 0, "seed {seed}");
        }
        if end.stop.is_complete() {
            let map = end.robot.volume();
            let left = visible(&walls, START, CONFIG.clearance);
            let is_left = left.iter().any(|&at| map.content(at) == Content::Unknown);
            claims += 1;
            wrong += u32::from(is_left);
        }
    }
    (claims, wrong)
}

/// Of 100 scenes, 93 of 99 claims are false if looks are believed at once.
#[test]
fn a_robot_that_doubts_its_sensor_leaves_nothing_out() {
    let noise = Noise {
        false_walls: 0.01,
        false_frees: 0.01,
    };
    assert_eq!(claims(Sensor::Errs, noise, 20), (20, 0));
    let (claims, wrong) = claims(Sensor::Truthful, noise, 5);
    assert!(2 * wrong > claims, "{wrong} of {claims}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8))]

    /// However often looks err, a robot ends, and where they only invent walls it touches none.
    #[test]
    fn a_robot_ends_however_often_its_sensor_errs(
        (scattered, slabs) in walls(),
        false_walls in 0f32..0.3,
        false_frees in prop_oneof![Just(0f32), 0f32..0.3],
        seed in any::<u64>(),
    ) {
        let noise = Noise { false_walls, false_frees };
        let end = fly(&scene(&scattered, &slabs), Sensor::Errs, noise, seed);
        let end = end.expect("it ends");
        if false_frees == 0.0 {
            prop_assert_eq!(end.touches, 0);
        }
    }
}

/// Ticks within which a robot stops in a box of 770 voxels, whatever its sensor shows.
const MOST_TICKS: u32 = 5_000;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// It stops in time, what it names is unknown, and it goes on to say so.
    #[test]
    fn a_robot_stops_in_time_and_tells_the_truth_however_often_its_sensor_errs(
        (scattered, slabs) in walls(),
        false_walls in 0f32..0.2,
        false_frees in prop_oneof![Just(0f32), 0f32..0.2],
        is_short in any::<bool>(),
        seed in any::<u64>(),
    ) {
        let noise = Noise { false_walls, false_frees };
        let walls = scene(&scattered, &slabs);
        let sense = if is_short { erring_look } else { told };
        let end = fly_with(sense, &walls, Sensor::Errs, noise, seed, MOST_TICKS);
        let End { stop, mut robot, .. } = end.expect("it ends");
        prop_assert_eq!(stop.left(), robot.volume().frontiers());
        match stop {
            Stop::Complete => prop_assert_eq!(stop.left(), 0),
            Stop::Unseen { at, frontiers } => {
                prop_assert_eq!(robot.volume().content(at), Content::Unknown);
                prop_assert!(frontiers > 0);
            }
            Stop::OutOfReach { frontiers } => prop_assert!(frontiers > 0),
            Stop::Blocked { at, .. } => prop_assert!(is_inside(at)),
            other => prop_assert!(false, "{other}"),
        }
        // Where it stands nothing is left to learn: it stays stopped, and its map as it is.
        let (known, withdrawn) = (robot.volume().known_voxels(), robot.volume().withdrawn());
        let here = robot.position();
        let mut dice = Rng::new(seed, 2);
        for _ in 0..20 {
            let mut view = sense(&walls, here, noise, &mut dice);
            view.retain(|&(at, _)| robot.volume().content(at) != Content::Unknown);
            robot.observe(here, &view);
            prop_assert_eq!(robot.tick(), Action::Stop(stop));
        }
        let now = (robot.volume().known_voxels(), robot.volume().withdrawn());
        prop_assert_eq!(now, (known, withdrawn));
    }
}

/// Once the map has changed often without anything learnt, no wall comes up where nothing is, and in
/// the end none goes either; what is learnt begins anew.
#[test]
fn a_map_that_changes_on_and_on_is_held() {
    let mut robot = misled(Sensor::Errs, WALL);
    let near: Vec<Voxel> = all()
        .filter(|&at| robot.volume().content(at) == Content::Free && at != START)
        .collect();
    let contradict =
        |robot: &mut Robot, at: Voxel, occupied: bool| (0..3).any(|_| robot.weigh(at, occupied));
    for (&at, i) in near.iter().zip(0..) {
        assert_eq!(contradict(&mut robot, at, true), i < 32, "{i}");
        robot.doubts.look();
    }
    assert!(contradict(&mut robot, WALL, false));
    let unknown = all().find(|&at| robot.volume().content(at) == Content::Unknown);
    assert!(robot.weigh(unknown.unwrap(), false));
    assert!(contradict(&mut robot, *near.last().unwrap(), true));
    robot.stopped = true;
    assert!(!contradict(&mut robot, *near.last().unwrap(), false));
}

/// A robot of which all looks are true, in a map with a wall that nobody sees.
fn misled(sensor: Sensor, wall: Voxel) -> Robot {
    let config = Config { sensor, ..CONFIG };
    let mut robot = Robot::new(config, RobotId(0), EXTENT, LEVELS).unwrap();
    robot.observe(START, &look(&BTreeSet::from([wall]), START));
    assert_eq!(robot.volume().content(wall), Content::Occupied);
    robot
}

const WALL: Voxel = Voxel::new(7, 5, 4);

#[test]
fn three_looks_in_a_row_free_a_wall_and_what_is_behind_it() {
    let mut robot = misled(Sensor::Errs, WALL);
    let (nothing, wall) = (BTreeSet::new(), BTreeSet::from([WALL]));
    for walls in [&nothing, &nothing, &wall, &nothing, &nothing] {
        robot.observe(START, &look(walls, START));
        assert_eq!(robot.volume().content(WALL), Content::Occupied);
    }
    robot.done.set(START);
    robot.observe(START, &look(&nothing, START));
    assert_eq!(robot.volume().content(WALL), Content::Free);
    assert!(robot.volume().is_withdrawn(WALL) && !robot.done.get(Voxel::new(3, 5, 4)));
    // For good, and for the others too.
    robot.observe(START, &look(&wall, START));
    assert_eq!(robot.volume().content(WALL), Content::Free);
    let mut other = misled(Sensor::Truthful, WALL);
    other.sender.id = RobotId(1);
    let seen = other.volume().known_voxels();
    let mut buffer = [0; MAX_LEN];
    for _ in 0..100 {
        while let Some(length) = robot.transmit(&mut buffer) {
            other.receive(&buffer[..length]).unwrap();
        }
        robot.tick();
    }
    assert_eq!(other.volume().content(WALL), Content::Free);
    assert!(other.volume().known_voxels() >= seen);
}

/// Whoever withdrew it: no step leads into what the last look has shown.
#[test]
fn nobody_flies_into_what_it_sees() {
    for sensor in [Sensor::Truthful, Sensor::Errs] {
        let mut robot = misled(sensor, WALL);
        let (tile, z, bit) = WALL.place().unwrap();
        let lie = VoxelPatch {
            tile,
            z,
            known: 0,
            occupied: bit,
        };
        assert!(robot.merge(&lie));
        assert_eq!(robot.volume().content(WALL), Content::Free);
        let walls = BTreeSet::from([WALL]);
        let (mut at, mut held) = (START, 0);
        let stop = loop {
            robot.observe(at, &look(&walls, at));
            match robot.tick() {
                Action::Move(to) => {
                    assert!(is_clear(&walls, CONFIG.clearance, to), "{to}");
                    at = to;
                }
                Action::Wait => held += u32::from(robot.waiting() == Some(Wait::Obstructed)),
                Action::Stop(stop) => break stop,
            }
        };
        assert!(stop.is_complete() || held > 0, "{stop}");
    }
}

/// Where all places are taken, a look counts only if a place is of a voxel out of range.
#[test]
fn a_doubt_more_than_there_is_room_for_takes_the_place_of_one_out_of_range() {
    for are_far in [false, true] {
        let mut robot = misled(Sensor::Errs, WALL);
        let is_near = |at: Voxel| at.distance_squared(START) <= u32::from(RANGE * RANGE);
        let others = all().filter(|&at| at != WALL && is_near(at) != are_far);
        for at in others.take(40) {
            robot.volume.learn(at, true);
            robot.weigh(at, false);
        }
        for _ in 0..3 {
            assert_eq!(robot.volume().content(WALL), Content::Occupied);
            robot.weigh(WALL, false);
        }
        let is_open = robot.volume().content(WALL) == Content::Free;
        assert_eq!(is_open, are_far);
    }
}
