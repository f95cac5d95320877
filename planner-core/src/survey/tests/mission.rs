//! Robots come home, and in time.

use super::*;

const BOTH: [fn(Mission) -> Robot; 2] = [coordinated_on, published_on];

/// A robot in the air, tick by tick.
struct Flight {
    robot: Robot,
    at: Point,
    ticks: u32,
    /// Robots that hover and are heard.
    others: Vec<Point>,
}

impl Flight {
    fn new(robot: Robot) -> Self {
        Self {
            robot,
            at: START,
            ticks: 0,
            others: Vec::new(),
        }
    }

    fn tick(&mut self, world: &World) -> Option<Stop> {
        self.robot
            .observe(self.at, &world.look(self.at, self.ticks));
        for (number, &position) in (1..).zip(&self.others) {
            let activity = Activity::Stopped;
            let status = Status {
                position,
                goal: None,
                activity,
            };
            self.robot.hear(RobotId(number), status);
        }
        self.ticks += 1;
        match self.robot.tick() {
            Action::Move(to) => {
                assert!(self.at.distance(to) <= LIMITS.step + 1e-3);
                let ground = |cell| world.height(cell);
                let least = crate::surface::clearance(self.at, to, ground).unwrap();
                let is_rise = (to.x, to.y) == (self.at.x, self.at.y) && to.z > self.at.z;
                assert!(least >= LIMITS.min_altitude - 1e-3 || is_rise, "{least}");
                assert!(to.z <= LIMITS.ceiling || to.z < self.at.z);
                let motion = match world.refuses(self.at, to) {
                    true => Motion::Blocked,
                    false => {
                        self.at = to;
                        Motion::Moved
                    }
                };
                self.robot.report(motion, self.at);
                None
            }
            Action::Wait => None,
            Action::Stop(stop) => Some(stop),
        }
    }

    fn run(&mut self, world: &World) -> Stop {
        for _ in 0..60_000 {
            if let Some(stop) = self.tick(world) {
                return stop;
            }
        }
        panic!("no stop at {:?} of {world:?}", self.at);
    }

    fn is_home(&self) -> bool {
        self.at.distance(START) <= 1e-3
    }
}

fn mission(come_home: bool, energy: u32) -> Mission {
    Mission { come_home, energy }
}

#[test]
fn a_robot_that_has_surveyed_comes_home() {
    for build in BOTH {
        let mut flight = Flight::new(build(mission(true, 0)));
        let world = World {
            towers: std::vec![(3, 3, 20), (5, 2, 36)],
            ..World::default()
        };
        assert_eq!(flight.run(&world), Stop::Complete);
        assert!(flight.is_home(), "{:?}", flight.at);
        assert!(flight.robot.status().has_stopped());
        // It stays that.
        assert_eq!(flight.tick(&world), Some(Stop::Complete));
        flight.robot.resume();
        assert_eq!(flight.run(&world), Stop::Complete);
    }
}

#[test]
fn a_robot_turns_back_while_its_energy_lasts_and_goes_on_with_more() {
    for build in BOTH {
        let mut flight = Flight::new(build(mission(false, 16)));
        let world = World::default();
        let Stop::Home { frontiers } = flight.run(&world) else {
            panic!("not home");
        };
        assert!(frontiers > 0 && flight.is_home());
        assert!((10..=16).contains(&flight.ticks), "{}", flight.ticks);
        assert!(matches!(flight.tick(&world), Some(Stop::Home { .. })));
        let ticks = flight.ticks;
        flight.robot.resume();
        assert!(matches!(flight.run(&world), Stop::Home { .. }));
        let more = flight.ticks - ticks;
        assert!((10..=16).contains(&more), "as much energy again: {more}");
        assert!(flight.is_home() && flight.robot.energy(1000));
        let stop = flight.tick(&world);
        assert!(matches!(stop, Some(Stop::Home { .. })), "not told to go on");
        flight.robot.resume();
        assert!(flight.robot.energy(1000));
        assert_eq!(flight.run(&world), Stop::Complete);
    }
}

#[test]
fn a_robot_goes_home_when_it_is_told() {
    for build in BOTH {
        let mut flight = Flight::new(build(Mission::NONE));
        let world = World::default();
        for _ in 0..8 {
            assert_eq!(flight.tick(&world), None);
        }
        assert!(!flight.is_home());
        assert!(flight.robot.go_home());
        assert!(flight.robot.status().has_stopped(), "it explores no more");
        assert!(matches!(flight.run(&world), Stop::Home { frontiers: 1.. }));
        assert!(flight.is_home());
        flight.robot.resume();
        assert_eq!(flight.run(&world), Stop::Complete);
        assert!(flight.robot.go_home());
        assert_eq!(flight.run(&world), Stop::Home { frontiers: 0 });
        assert!(flight.is_home());
    }
}

/// A wall of glass that appears behind it: it finds the door, or says what is in the way.
#[test]
fn what_is_in_the_way_home_is_flown_round_or_named() {
    for build in BOTH {
        for door in [Some(13), None] {
            let mut flight = Flight::new(build(mission(false, 0)));
            let mut world = World::default();
            while flight.at.x < 9.0 {
                assert_eq!(flight.tick(&world), None);
            }
            // All is known, as from others.
            for y in 0..SIDE {
                let columns: Vec<Column> = (0..SIDE)
                    .map(|x| Cell::new(x, y))
                    .map(|cell| Column {
                        cell,
                        height: Height(0),
                    })
                    .collect();
                flight.robot.observe(flight.at, &columns);
            }
            world.glass = (0..SIDE).map(|y| (6, y)).collect();
            if let Some(door) = door {
                world.glass.remove(&(6, door));
            }
            flight.robot.go_home();
            let stop = flight.run(&world);
            match door {
                Some(_) => {
                    assert!(matches!(stop, Stop::Home { .. }), "{stop}");
                    assert!(flight.is_home());
                }
                None => assert!(
                    matches!(stop, Stop::Blocked { at, .. } if at.x == 6),
                    "{stop}"
                ),
            }
        }
    }
}

#[test]
fn others_that_hover_on_the_way_are_passed_by() {
    for build in BOTH {
        let mut flight = Flight::new(build(mission(true, 0)));
        let world = World::default();
        flight.others = (0..5)
            .map(|i| Point::new(3.5 + f32::from(i as u8), 3.5 + f32::from(i as u8), 2.5))
            .collect();
        assert_eq!(flight.run(&world), Stop::Complete);
        assert!(flight.is_home(), "{:?}", flight.at);
        // One that hovers at home is named.
        flight.robot.resume();
        let mut flight = Flight::new(build(Mission::NONE));
        while flight.at.x < 9.0 {
            assert_eq!(flight.tick(&world), None);
        }
        flight.others = std::vec![START];
        flight.robot.go_home();
        let stop = flight.run(&world);
        assert!(matches!(stop, Stop::Held { .. }), "{stop}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Whatever the ground is, and whatever no look shows.
    #[test]
    fn every_robot_comes_home_in_time_from_the_air(
        towers in prop::collection::vec((0i16..7, 0i16..7, 0u8..40), 0..12),
        dark in places(8),
        energy in prop_oneof![2u32..40, 2u32..300],
        come_home in any::<bool>(),
        is_published in any::<bool>(),
    ) {
        let world = World { towers, dark, ..World::default() };
        let mut flight = Flight::new(BOTH[usize::from(is_published)](mission(come_home, energy)));
        let stop = flight.run(&world);
        let is_home = flight.is_home();
        match stop {
            Stop::Home { .. } => prop_assert!(is_home),
            _ if come_home => prop_assert!(is_home, "{stop} at {:?}", flight.at),
            _ => is_true(stop, &world, &flight.robot, false),
        }
        prop_assert!(flight.ticks <= energy + 1, "{} of {energy}", flight.ticks);
        // Hovering where it stopped, it turns back too.
        for _ in 0..energy {
            flight.tick(&world);
        }
        prop_assert!(flight.is_home());
    }
}
