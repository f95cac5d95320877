//! Looks that are missing, or show nothing of the box.

use super::*;

fn robot(clearance: u8, sensor: Sensor) -> Robot {
    let config = Config {
        clearance,
        sensor,
        ..CONFIG
    };
    Robot::new(config, RobotId(0), EXTENT, LEVELS).unwrap()
}

const SENSORS: [Sensor; 2] = [Sensor::Truthful, Sensor::Errs];

/// The stop of a robot that stays and looks, and the ticks until then.
fn stare(robot: &mut Robot, look: &[(Voxel, bool)]) -> (Stop<Voxel>, u32) {
    for ticks in 0..1_000 {
        robot.observe(START, look);
        if let Action::Stop(stop) = robot.tick() {
            return (stop, ticks);
        }
    }
    panic!("no stop");
}

/// Looks off the box, as from another origin, and looks without free voxels are not the end of a
/// survey: the stop names a voxel beside the robot. Good looks then end it.
#[test]
fn looks_that_show_nothing_complete_nothing() {
    let off = [(Voxel::new(900, 5, 4), false), (Voxel::new(5, 5, -1), true)];
    let hit = [(Voxel::new(9, 5, 4), true)];
    for (look, silence) in [(&off[..], 99), (&hit[..], 0)] {
        for sensor in SENSORS {
            for clearance in 0..=MAX_CLEARANCE {
                let mut robot = robot(clearance, sensor);
                let (stop, ticks) = stare(&mut robot, look);
                let Stop::Unseen { at, frontiers: 1 } = stop else {
                    panic!("{stop}");
                };
                assert_eq!(at.distance_squared(START), 1, "{at}");
                assert!((silence..silence + 32).contains(&ticks), "{ticks}");
                let stop =
                    World::default().fly(&mut robot, &mut START.clone(), &Vec::new(), 0, 20_000);
                assert!(stop.0.is_complete(), "{}", stop.0);
            }
        }
    }
}

/// Before the first look from within the box a robot waits, for as long as there is none.
#[test]
fn a_robot_without_a_look_waits() {
    for (pose, wait) in [
        (None, Wait::Sight),
        (Some(Voxel::new(-1, 5, 4)), Wait::Pose),
    ] {
        let mut robot = robot(1, Sensor::Truthful);
        for _ in 0..1_000 {
            if let Some(pose) = pose {
                robot.observe(pose, &[]);
            }
            assert_eq!(robot.tick(), Action::Wait);
            assert_eq!(robot.waiting(), Some(wait));
        }
        // None of that counts as a look of a sensor that failed.
        robot.observe(START, &[]);
        assert_eq!(robot.tick(), Action::Wait);
        assert_eq!(robot.waiting(), Some(Wait::Sight));
        assert_eq!(robot.volume().content(START), Content::Free);
    }
}

#[test]
fn a_box_without_levels_is_refused() {
    let robot = Robot::new(CONFIG, RobotId(0), EXTENT, 0);
    assert_eq!(robot.unwrap_err(), ExtentError::Empty);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Whatever looks show, no survey is complete while anything beside the robot is unknown.
    #[test]
    fn no_survey_is_complete_beside_the_unknown(
        look in prop::collection::vec(((3i16..14, 3i16..8, 2i16..8), any::<bool>()), 0..40),
        clearance in 0u8..=2,
        sensor in prop::sample::select(SENSORS.to_vec()),
    ) {
        let look: Vec<_> = look.into_iter().map(|((x, y, z), it)| (Voxel::new(x, y, z), it)).collect();
        let mut robot = robot(clearance, sensor);
        for _ in 0..300 {
            robot.observe(START, &look);
            if let Action::Stop(stop) = robot.tick() {
                let is_known = |at: Voxel| robot.volume().content(at) != Content::Unknown;
                prop_assert!(!stop.is_complete() || START.beside().into_iter().all(is_known), "{stop}");
                return Ok(());
            }
        }
    }
}

/// A pose in what is known to be occupied is none of a wrong place: the map gives in, and the robot
/// goes on.
#[test]
fn where_the_robot_is_nothing_else_is() {
    let other = Voxel::new(8, 5, 4);
    let open: Vec<(Voxel, bool)> = all().map(|at| (at, at == other)).collect();
    for sensor in SENSORS {
        let mut robot = robot(0, sensor);
        robot.observe(START, &open);
        assert_eq!(robot.volume().content(other), Content::Occupied);
        robot.observe(other, &open);
        assert_eq!(robot.volume().content(other), Content::Free);
        assert!(robot.tick() != Action::Wait || robot.waiting() != Some(Wait::Pose));
    }
}
