//! Robots that are to come home.

use super::*;

/// A robot, where it is, and what its energy lasts for.
struct Flight<'a, const TW: usize, const TH: usize, const L: usize> {
    robot: VoxelSurvey<TW, TH, L>,
    at: Voxel,
    left: u32,
    look: &'a dyn Fn(Voxel) -> Vec<(Voxel, bool)>,
}

impl<const TW: usize, const TH: usize, const L: usize> Flight<'_, TW, TH, L> {
    /// Flies until the robot stops; nobody flies without energy.
    fn fly(&mut self, mut step: impl FnMut(Voxel)) -> Stop<Voxel> {
        for _ in 0..50_000 {
            self.robot.observe(self.at, &(self.look)(self.at));
            let to = match self.robot.tick() {
                Action::Stop(stop) => return stop,
                Action::Move(to) => to,
                Action::Wait => self.at,
            };
            assert!(self.left > 0, "out of energy at {}", self.at);
            self.left -= 1;
            self.at = to;
            step(to);
        }
        panic!("no stop");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    /// With any energy: every robot is home before it is used up, or has surveyed all; and
    /// with more energy it goes on to the end.
    #[test]
    fn every_robot_comes_home_in_time(
        (scattered, slabs) in walls(),
        clearance in 0u8..=2,
        energy in prop_oneof![1u32..60, 1u32..600],
        come_home in any::<bool>(),
        told in prop::option::weighted(0.2, 0usize..100),
    ) {
        let mut walls = scene(&scattered, &slabs);
        for voxel in body_voxels(clearance, START) {
            walls.remove(&voxel);
        }
        let config = Config { clearance, come_home, energy, ..CONFIG };
        let robot = Robot::new(config, RobotId(0), EXTENT, LEVELS).unwrap();
        let look = |at| look(&walls, at);
        let mut flight = Flight { robot, at: START, left: energy, look: &look };
        let mut stop = flight.fly(|to| assert!(is_clear(&walls, clearance, to)));
        for rounds in 0.. {
            prop_assert!(rounds < 2, "{stop}");
            let is_home = flight.at == START;
            prop_assert!(is_home || !come_home && stop.is_complete(), "{stop} at {}", flight.at);
            prop_assert_eq!(stop.left(), flight.robot.volume().frontiers());
            if stop.is_complete() {
                break;
            }
            let is_home = matches!(stop, Stop::Home { .. });
            prop_assert!(is_home, "{}", stop);
            prop_assert_eq!(flight.robot.tick(), Action::Stop(stop));
            flight.left = 40_000;
            flight.robot.resume();
            flight.robot.energy(flight.left);
            stop = flight.fly(|_| ());
        }
        for voxel in visible(&walls, START, clearance) {
            prop_assert!(flight.robot.volume().content(voxel) != Content::Unknown, "{voxel}");
        }
        // One that is told so comes home from wherever it is.
        if let Some(steps) = told {
            let config = Config { clearance, ..CONFIG };
            let robot = Robot::new(config, RobotId(0), EXTENT, LEVELS).unwrap();
            let mut flight = Flight { robot, at: START, left: u32::MAX, look: &look };
            for _ in 0..steps {
                flight.robot.observe(flight.at, &look(flight.at));
                if let Action::Move(to) = flight.robot.tick() {
                    flight.at = to;
                }
            }
            flight.robot.go_home();
            let stop = flight.fly(|_| ());
            let is_home = matches!(stop, Stop::Home { .. });
            prop_assert!(is_home, "{}", stop);
            prop_assert_eq!(flight.at, START);
        }
    }
}

/// A corridor that winds through a level, so long that searches take several ticks: they are
/// in the reserve, and little of the energy is not used.
#[test]
fn searches_are_in_the_reserve() {
    let is_open = |at: Voxel| {
        let is_inside = (0..40).contains(&at.x) && (0..40).contains(&at.y) && at.z == 0;
        let gap = if at.x % 4 == 1 { 39 } else { 0 };
        is_inside && (at.x % 2 == 0 || at.y == gap)
    };
    let look = |eye: Voxel| -> Vec<(Voxel, bool)> {
        let near = body_voxels(3, eye)
            .filter(|at| EXTENT_OF_CORRIDOR.contains(at.cell()) && (0..16).contains(&at.z));
        let seen = near.filter(|&at| in_sight(eye, at, is_open));
        seen.map(|at| (at, !is_open(at))).collect()
    };
    for energy in [2, 40, 150, 400, 700, 1_000, 5_000] {
        let config = Config {
            range: 3,
            clearance: 0,
            energy,
            ..Config::new()
        };
        let mut robot = std::boxed::Box::new(VoxelSurvey::<5, 5, 16>::vacant());
        robot
            .reset(config, RobotId(0), EXTENT_OF_CORRIDOR, 16)
            .unwrap();
        let start = Voxel::new(0, 0, 0);
        let (at, left) = (start, energy);
        let mut flight = Flight {
            robot: *robot,
            at,
            left,
            look: &look,
        };
        let mut steps = 0;
        let stop = flight.fly(|_| steps += 1);
        if energy < 1_500 {
            assert!(matches!(stop, Stop::Home { .. }), "{stop}");
            assert_eq!(flight.at, start);
            // What is left is less than what searches and doubts may take.
            assert!(
                flight.left <= 8 + energy / 6,
                "{} of {energy} left",
                flight.left
            );
        } else {
            assert!(stop.is_complete(), "{stop}");
        }
        std::eprintln!("{energy}: {steps} ticks, {} left", flight.left);
    }
}

const EXTENT_OF_CORRIDOR: Extent = Extent::new(40, 40);

/// What stands on the way home is flown round; without a way the robot says so.
#[test]
fn without_a_way_home_the_robot_says_so() {
    let mut walls: BTreeSet<Voxel> = all().filter(|voxel| voxel.z == 0).collect();
    for is_shut in [false, true] {
        let mut robot = Robot::new(CONFIG, RobotId(0), EXTENT, LEVELS).unwrap();
        let mut at = START;
        for _ in 0..200 {
            robot.observe(at, &look(&walls, at));
            match robot.tick() {
                Action::Move(to) => at = to,
                Action::Wait => {}
                Action::Stop(_) => break,
            }
        }
        assert!(at != START);
        // A wall about home, or about all but one side of it.
        let about =
            body_voxels(2, START).filter(|voxel| !body_voxels(1, START).any(|it| it == *voxel));
        walls.extend(about.filter(|voxel| is_shut || voxel.x <= START.x));
        for voxel in &walls {
            robot.volume.learn(*voxel, true);
        }
        robot.go_home();
        assert!(robot.status().has_stopped());
        for steps in 0.. {
            assert!(steps < 500);
            robot.observe(at, &[(at, false)]);
            match robot.tick() {
                Action::Move(to) => at = to,
                Action::Wait => {}
                Action::Stop(stop) => {
                    let frontiers = robot.volume().frontiers();
                    let expected = match is_shut {
                        false => Stop::Home { frontiers },
                        true => Stop::NoWay {
                            frontiers,
                            at: START,
                        },
                    };
                    assert_eq!(stop, expected);
                    break;
                }
            }
        }
    }
}
