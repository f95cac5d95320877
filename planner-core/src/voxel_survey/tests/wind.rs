//! Robots that are pushed.

use super::*;
use crate::rng::Rng;

/// Where a push leads from `at`: a voxel to any side, and not into a wall.
fn pushed(walls: &BTreeSet<Voxel>, at: Voxel, dice: &mut Rng) -> Voxel {
    let mut step = || (dice.next_u32() >> 16) as i16 % 3 - 1;
    let to = Voxel::new(at.x + step(), at.y + step(), at.z + step());
    let is_open = |at: Voxel| is_inside(at) && !walls.contains(&at);
    match is_open(to) && in_sight(at, to, is_open) {
        true => to,
        false => at,
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// In wind, in up to two steps of five: the survey ends, and what can be seen from all that
    /// can be reached from where it ends is seen, or it ends where its body has no room and says
    /// so. A robot that comes home does so, if a way leads there.
    #[test]
    fn all_that_can_be_seen_is_seen_in_wind(
        (scattered, slabs) in walls(),
        clearance in 0u8..=2,
        come_home in any::<bool>(),
        gusts in 1u32..40,
        seed in any::<u64>(),
    ) {
        let mut walls = scene(&scattered, &slabs);
        for voxel in body_voxels(clearance, START) {
            walls.remove(&voxel);
        }
        let config = Config { clearance, come_home, ..CONFIG };
        let mut robot = Robot::new(config, RobotId(0), EXTENT, LEVELS).unwrap();
        let mut dice = Rng::new(seed, 0);
        let mut at = START;
        for steps in 0.. {
            prop_assert!(steps < 20_000);
            robot.observe(at, &look(&walls, at));
            match robot.tick() {
                Action::Move(to) => {
                    prop_assert_eq!(at.distance_squared(to), 1);
                    prop_assert!(!walls.contains(&to));
                    at = to;
                }
                Action::Wait => {}
                Action::Stop(stop) => {
                    let is_cut_off = !reached(&walls, at, clearance).contains(&START);
                    match stop {
                        Stop::NoWay { .. } => prop_assert!(come_home && is_cut_off, "{stop}"),
                        Stop::Blocked { .. } => prop_assert!(!is_clear(&walls, clearance, at)),
                        _ => {
                            prop_assert!(stop.is_complete(), "{stop} at {at}");
                            prop_assert!(!come_home || at == START);
                        }
                    }
                    break;
                }
            }
            if dice.next_u32() % 100 < gusts {
                at = pushed(&walls, at, &mut dice);
            }
        }
        for voxel in visible(&walls, at, clearance) {
            prop_assert!(robot.volume().content(voxel) != Content::Unknown, "{voxel}");
        }
    }

    /// In a storm that takes it anywhere in every step, the robot gives up in the end.
    #[test]
    fn a_storm_ends_a_survey(seed in any::<u64>()) {
        let walls: BTreeSet<Voxel> = all().filter(|voxel| voxel.z == 0 || voxel.x == 7).collect();
        // What is behind the wall makes a frontier that is never reached.
        let mut robot = Robot::new(CONFIG, RobotId(0), EXTENT, LEVELS).unwrap();
        let mut dice = Rng::new(seed, 0);
        let mut at = START;
        for steps in 0.. {
            prop_assert!(steps < 60_000);
            robot.observe(at, &look(&walls, at));
            if let Action::Stop(_) = robot.tick() {
                break;
            }
            at = pushed(&walls, at, &mut dice);
        }
    }
}

/// The floor, but for a shaft in it that is one voxel wide; and the shaft from its mouth down.
fn shaft() -> (BTreeSet<Voxel>, [Voxel; 3]) {
    let shaft = [2, 1, 0].map(|z| Voxel::new(START.x, START.y, z));
    let walls = all().filter(|voxel| voxel.z < 3 && !shaft.contains(voxel));
    (walls.collect(), shaft)
}

/// A push closes nothing, and a robot off all poses flies back over what is free.
#[test]
fn a_pushed_robot_flies_back() {
    let (walls, shaft) = shaft();
    let mut robot = Robot::new(CONFIG, RobotId(0), EXTENT, LEVELS).unwrap();
    robot.observe(START, &look(&walls, START));
    robot.tick();
    let mut at = shaft[2];
    for up in [1, 2, 3, 4] {
        robot.observe(at, &look(&walls, at));
        let expected = Voxel::new(START.x, START.y, up);
        assert_eq!(robot.tick(), Action::Move(expected));
        at = expected;
    }
    assert!(!robot.is_closed);
}

/// What has ended where the robot was may go on where a push takes it; the way home that was
/// asked for stays.
#[test]
fn a_push_on_the_way_home_reopens_a_survey_that_has_ended() {
    for is_told in [false, true] {
        let config = Config {
            come_home: true,
            ..CONFIG
        };
        let mut robot = Robot::new(config, RobotId(0), EXTENT, LEVELS).unwrap();
        let walls = BTreeSet::new();
        for x in [START.x, START.x + 2] {
            let at = Voxel::new(x, START.y, START.z);
            robot.observe(at, &look(&walls, at));
            robot.tick();
        }
        match is_told {
            true => robot.go_home(),
            false => {
                robot.end(Stop::OutOfReach { frontiers: 1 });
            }
        }
        assert!(robot.mission.has_errand());
        let at = Voxel::new(START.x + 4, START.y, START.z);
        robot.observe(at, &look(&walls, at));
        assert_eq!(robot.mission.has_errand(), is_told);
    }
}

/// Pushed on and on where no pose is, a robot gives up too.
#[test]
fn a_robot_that_is_kept_off_all_poses_gives_up() {
    let (walls, shaft) = shaft();
    let mut robot = Robot::new(CONFIG, RobotId(0), EXTENT, LEVELS).unwrap();
    robot.observe(START, &look(&walls, START));
    robot.tick();
    let places = [shaft[2], shaft[0]].into_iter().cycle();
    let stop = places.take(5_000).find_map(|at| {
        robot.observe(at, &look(&walls, at));
        match robot.tick() {
            Action::Stop(stop) => Some(stop),
            _ => None,
        }
    });
    assert!(matches!(stop, Some(Stop::Blocked { .. })), "{stop:?}");
}
