//! Sensors that do not show all round.

use super::*;

const NARROW: Field = Field {
    up: 60,
    down: 148,
    side: Some(110),
    near: 2,
};

const FIELDS: [Field; 4] = [Field::CAMERA, NARROW, Field::DOWNWARD, Field::LIDAR];

fn robot(field: Field, clearance: u8) -> Robot {
    let config = Config {
        field,
        clearance,
        ..CONFIG
    };
    Robot::new(config, RobotId(0), EXTENT, LEVELS).unwrap()
}

/// Those of a view that a sensor shows.
fn shown(field: Field, eye: Voxel, heading: Heading, view: &[(Voxel, bool)]) -> Vec<(Voxel, bool)> {
    let is_shown = |it: &&(Voxel, bool)| field.shows(eye, heading, it.0);
    view.iter().filter(is_shown).copied().collect()
}

/// Every voxel that is seen from any place that can be reached in any heading, by brute
/// force.
fn visible_in(field: Field, walls: &BTreeSet<Voxel>, clearance: u8) -> BTreeSet<Voxel> {
    let views = reached(walls, START, clearance)
        .into_iter()
        .flat_map(|eye| {
            let view = look(walls, eye);
            Heading::all().flat_map(move |heading| shown(field, eye, heading, &view))
        });
    views.map(|(voxel, _)| voxel).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Whatever the field of view and however slowly the sensor turns: everything that can
    /// be seen from anywhere that can be reached is seen, and nothing is touched.
    #[test]
    fn all_that_a_sensor_can_show_is_seen(
        (scattered, slabs) in walls(),
        field in prop::sample::select(FIELDS.to_vec()),
        turn in 1u8..5,
        clearance in 0u8..=2,
    ) {
        let mut walls = scene(&scattered, &slabs);
        for voxel in body_voxels(clearance, START) {
            walls.remove(&voxel);
        }
        let field = field.for_body(clearance);
        let mut robot = robot(field, clearance);
        let mut at = START;
        let mut heading = Heading::new(3);
        for steps in 0.. {
            prop_assert!(steps < 20_000);
            robot.observe_towards(at, heading, shown(field, at, heading, &look(&walls, at)));
            let action = robot.tick();
            prop_assert!(robot.work() <= MOST_WORK + VIEW, "{}", robot.work());
            heading = heading.turned(robot.heading(), turn);
            match action {
                Action::Move(to) => {
                    prop_assert_eq!(at.distance_squared(to), 1);
                    prop_assert!(is_clear(&walls, clearance, to));
                    at = to;
                }
                Action::Wait => {}
                Action::Stop(stop) => {
                    prop_assert!(stop.is_complete(), "{stop}");
                    break;
                }
            }
        }
        for voxel in visible_in(field, &walls, clearance) {
            prop_assert!(robot.volume().content(voxel) != Content::Unknown, "{voxel:?}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    /// A sensor that does not turn is named by what it does not show, in the end.
    #[test]
    fn a_sensor_that_is_stuck_is_a_reason_to_stop(
        (scattered, slabs) in walls(),
        field in prop::sample::select(std::vec![Field::CAMERA, NARROW]),
        eighths in 0u8..8,
    ) {
        let walls = scene(&scattered, &slabs);
        let mut robot = robot(field, 1);
        let mut at = START;
        let heading = Heading::new(eighths);
        for steps in 0.. {
            prop_assert!(steps < 100_000);
            robot.observe_towards(at, heading, shown(field, at, heading, &look(&walls, at)));
            match robot.tick() {
                Action::Move(to) => at = to,
                Action::Wait => {}
                Action::Stop(Stop::Unseen { at, .. }) => {
                    prop_assert_eq!(robot.volume().content(at), Content::Unknown);
                    break;
                }
                Action::Stop(stop) => {
                    prop_assert!(stop.is_complete(), "{stop}");
                    for voxel in visible_in(field, &walls, 1) {
                        prop_assert!(robot.volume().content(voxel) != Content::Unknown, "{voxel:?}");
                    }
                    break;
                }
            }
        }
    }
}

/// Where a camera shows no more whatever way it is turned, it does not turn: from one place
/// at most once for each heading, and in an empty box far less.
#[test]
fn a_camera_turns_only_to_see_more() {
    let walls: BTreeSet<Voxel> = all().filter(|voxel| voxel.z == 0).collect();
    let mut robot = robot(Field::CAMERA, 1);
    let (mut at, mut heading) = (START, Heading::EAST);
    let (mut turns, mut steps) = (0, 0);
    loop {
        let view = shown(Field::CAMERA, at, heading, &look(&walls, at));
        robot.observe_towards(at, heading, &view);
        let action = robot.tick();
        steps += 1;
        let is_turned = heading != robot.heading();
        heading = robot.heading();
        match action {
            Action::Move(to) => at = to,
            Action::Wait => {
                assert!(is_turned || robot.waiting().is_some(), "{at}");
                turns += u32::from(is_turned);
            }
            Action::Stop(stop) => {
                assert_eq!(stop, Stop::Complete);
                break;
            }
        }
        assert!(steps < 2_000);
    }
    std::eprintln!("{steps} steps, {turns} of them turns");
    assert!(turns * 3 < steps, "{turns} of {steps}");
}
