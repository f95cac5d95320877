//! A survey ends, and says the truth, whatever refuses, hides or talks.

mod mission;

use std::collections::BTreeSet;
use std::vec::Vec;

use proptest::prelude::*;

use super::*;
use crate::cell::{Direction, Extent};
use crate::coordinated_survey::{self, Choice, CoordinatedSurvey};
use crate::fcao::{self, Fcao};
use crate::radio::LinkConfig;
use crate::robot::{Activity, Stop};
use crate::surface::{Height, Surface, in_sight};

const SIDE: i16 = 14;
const EXTENT: Extent = Extent::new(SIDE as u16, SIDE as u16);
const LIMITS: Limits = Limits {
    range: 4.0,
    step: 1.5,
    min_altitude: 1.5,
    ceiling: 12.0,
    separation: 1.0,
    clearance: 0,
};
const START: Point = Point::new(1.5, 1.5, 3.0);

type Robot = std::boxed::Box<dyn Surveyor<2, 2>>;

fn coordinated() -> Robot {
    coordinated_on(Mission::NONE)
}

fn coordinated_on(mission: Mission) -> Robot {
    let config = coordinated_survey::Config {
        limits: LIMITS,
        link: LinkConfig::new(),
        seed: 3,
        choice: Choice::Map,
        mission,
    };
    std::boxed::Box::new(CoordinatedSurvey::<2, 2>::new(config, RobotId(0), EXTENT).unwrap())
}

fn published() -> Robot {
    published_on(Mission::NONE)
}

fn published_on(mission: Mission) -> Robot {
    let config = fcao::Config {
        mission,
        ..fcao::Config::new(LIMITS, 3)
    };
    std::boxed::Box::new(Fcao::<2, 2>::new(config, RobotId(0), EXTENT).unwrap())
}

#[test]
fn patience_is_a_distance_within_bounds() {
    let patience = |range, step| {
        Limits {
            range,
            step,
            ..LIMITS
        }
        .patience()
    };
    assert_eq!(patience(8.0, 2.0), 50);
    assert_eq!(patience(8.0, 0.5), 200);
    assert_eq!(patience(12.0, 1.0), 150);
    assert_eq!(patience(8.0, 1000.0), 4);
    assert_eq!(patience(12.0, 1e-9), 30_000);
}

#[test]
fn a_margin_leaves_most_of_the_range() {
    let cruise = |range, min_altitude| {
        Limits {
            range,
            min_altitude,
            ..LIMITS
        }
        .cruise(0.36)
    };
    assert_eq!(cruise(8.0, 2.0), 2.88);
    assert_eq!(cruise(8.0, 4.0), 4.75);
    assert_eq!(cruise(6.0, 4.0), 4.5);
    assert_eq!(cruise(6.0, 9.0), 9.0);
}

/// A surface, and what is wrong with it.
#[derive(Clone, Debug, Default)]
struct World {
    /// Columns that are not at height 0.
    towers: Vec<(i16, i16, u8)>,
    /// Columns that no flight enters.
    glass: BTreeSet<(i16, i16)>,
    /// Columns that no look shows.
    dark: BTreeSet<(i16, i16)>,
    /// From this step on no look shows anything.
    silent_from: Option<u32>,
}

impl World {
    fn height(&self, cell: Cell) -> Option<Height> {
        let tower = self
            .towers
            .iter()
            .rev()
            .find(|&&(x, y, _)| (cell.x / 2, cell.y / 2) == (x, y) && (x, y) != (0, 0));
        EXTENT
            .contains(cell)
            .then(|| Height(tower.map_or(0, |&(_, _, height)| height)))
    }

    fn is_in(set: &BTreeSet<(i16, i16)>, cell: Cell) -> bool {
        set.contains(&(cell.x, cell.y)) && cell != START.cell()
    }

    fn look(&self, eye: Point, step: u32) -> Vec<Column> {
        if self.silent_from.is_some_and(|from| step >= from) {
            return Vec::new();
        }
        let cells = (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| Cell::new(x, y)));
        cells
            .filter(|&cell| !Self::is_in(&self.dark, cell))
            .filter_map(|cell| {
                let height = self.height(cell)?;
                let ground = Point::over(cell, height.cells());
                (eye.distance(ground) <= LIMITS.range
                    && in_sight(eye, ground, |cell| self.height(cell)))
                .then_some(Column { cell, height })
            })
            .collect()
    }

    /// Whether something refuses this flight.
    fn refuses(&self, from: Point, to: Point) -> bool {
        crate::surface::Columns::new(from, to)
            .skip(1)
            .any(|crossing| Self::is_in(&self.glass, crossing.cell))
    }

    /// Columns beside those that can be flown to over known ones, unknown although
    /// nothing hides them.
    fn forgotten(&self, surface: &Surface<2, 2>) -> Vec<Cell> {
        let mut reached = Vec::from([START.cell()]);
        let mut forgotten = Vec::new();
        let mut next = 0;
        while let Some(&at) = reached.get(next) {
            next += 1;
            for beside in Direction::ALL.map(|direction| at.step(direction)) {
                if surface.is_unknown(beside) {
                    if !Self::is_in(&self.dark, beside) {
                        forgotten.push(beside);
                    }
                } else if EXTENT.contains(beside)
                    && !Self::is_in(&self.glass, beside)
                    && !reached.contains(&beside)
                {
                    reached.push(beside);
                }
            }
        }
        forgotten
    }
}

/// What others say in the steps of the script, round and round, before they fall silent.
type Script = Vec<Vec<(u8, Status<Point, Cell>)>>;

/// The stop, and the step in which it came.
fn fly(robot: &mut Robot, world: &World, script: &Script, loud: u32, most: u32) -> (Stop, u32) {
    let mut at = START;
    for step in 0..most {
        robot.observe(at, &world.look(at, step));
        if step < loud && !script.is_empty() {
            for &(id, status) in &script[step as usize % script.len()] {
                robot.hear(RobotId(id), status);
            }
        }
        match robot.tick() {
            Action::Move(to) => {
                assert!(at.distance(to) <= LIMITS.step + 1e-3);
                if world.refuses(at, to) {
                    robot.report(Motion::Blocked, at);
                } else {
                    at = to;
                    robot.report(Motion::Moved, at);
                }
            }
            Action::Wait => {}
            Action::Stop(stop) => {
                // It stays that.
                for _ in 0..3 {
                    robot.observe(at, &world.look(at, step));
                    assert_eq!(robot.tick(), Action::Stop(stop));
                }
                return (stop, step);
            }
        }
    }
    panic!(
        "no stop: {:?} {:?}",
        world,
        robot.knowledge().surface().frontiers()
    );
}

fn is_true(stop: Stop, world: &World, robot: &Robot, has_peers: bool) {
    let surface = robot.knowledge().surface();
    match stop {
        Stop::Complete => assert_eq!(surface.known_columns(), EXTENT.cells()),
        Stop::Unseen { frontiers, at } => {
            assert_eq!(frontiers, surface.frontiers());
            assert!(surface.is_unknown(at), "{at}");
        }
        Stop::Blocked { frontiers, at } => {
            assert_eq!(frontiers, surface.frontiers());
            assert!(frontiers > 0 && World::is_in(&world.glass, at), "{at}");
        }
        Stop::Held { .. } => assert!(has_peers),
        other => panic!("{other}"),
    }
}

fn places(most: usize) -> impl Strategy<Value = BTreeSet<(i16, i16)>> {
    prop::collection::btree_set((0..SIDE, 0..SIDE), 0..most)
}

fn status() -> impl Strategy<Value = Status<Point, Cell>> {
    let near = (0.0f32..14.0, 0.0f32..14.0, 0.0f32..8.0);
    let wild = prop::sample::select(std::vec![0.0f32, -1e9, 1e30, f32::NAN, f32::MAX, 7.0, 1.5]);
    let wild = (wild.clone(), wild.clone(), wild);
    let point = prop_oneof![9 => near, 1 => wild].prop_map(|(x, y, z)| Point::new(x, y, z));
    let cell = (-3i16..20, -3i16..20).prop_map(|(x, y)| Cell::new(x, y));
    (point, prop::option::of(cell), any::<bool>()).prop_map(|(position, goal, stopped)| Status {
        position,
        goal,
        activity: Activity::stopped_if(stopped),
    })
}

fn script() -> impl Strategy<Value = Script> {
    prop::collection::vec(prop::collection::vec((1u8..20, status()), 0..16), 0..8)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Glass, dark columns, towers, a sensor that fails, and others who say what they
    /// like: the robot stops, and the reason is true.
    #[test]
    fn every_survey_ends_in_a_true_reason(
        towers in prop::collection::vec((0i16..7, 0i16..7, 0u8..40), 0..6),
        glass in places(40),
        dark in places(8),
        silent_from in prop::option::weighted(0.2, 0u32..200),
        script in script(),
        loud in 0u32..400,
        is_published in any::<bool>(),
    ) {
        let world = World { towers, glass, dark, silent_from };
        let mut robot = if is_published { published() } else { coordinated() };
        let (stop, _) = fly(&mut robot, &world, &script, loud, 60_000);
        is_true(stop, &world, &robot, !script.is_empty());
    }

    /// On flat ground what refuses keeps the robot only from what lies beyond it.
    #[test]
    fn all_that_nothing_hides_is_seen_first(
        glass in places(60),
        dark in places(4),
        is_published in any::<bool>(),
    ) {
        let world = World { glass, dark, ..World::default() };
        let mut robot = if is_published { published() } else { coordinated() };
        let (stop, _) = fly(&mut robot, &world, &Vec::new(), 0, 60_000);
        is_true(stop, &world, &robot, false);
        let forgotten = world.forgotten(robot.knowledge().surface());
        prop_assert!(forgotten.is_empty(), "{stop}: {forgotten:?}");
    }

    /// What others say while they talk keeps a robot from nothing, once they are silent.
    #[test]
    fn talk_keeps_nothing_from_being_seen(
        script in script(),
        loud in 0u32..60,
        is_published in any::<bool>(),
    ) {
        let mut robot = if is_published { published() } else { coordinated() };
        let (stop, _) = fly(&mut robot, &World::default(), &script, loud, 20_000);
        prop_assert_eq!(stop, Stop::Complete);
    }

    /// Bad poses, however many: no decision, nothing learnt; and then it goes on.
    #[test]
    fn nothing_is_decided_from_a_bad_pose(
        begin in 0u32..60,
        length in 1u32..200,
        bad in prop::sample::select(std::vec![
            Point::new(f32::NAN, 3.0, 3.0),
            Point::new(3.0, f32::INFINITY, 3.0),
            Point::new(-0.5, 3.0, 3.0),
            Point::new(3.0, 14.5, 3.0),
            Point::new(1e30, 3.0, 3.0),
            Point::new(1.5, 1.5, -1.0),
        ]),
        is_published in any::<bool>(),
    ) {
        let world = World::default();
        let mut robot = if is_published { published() } else { coordinated() };
        let mut at = START;
        for step in 0.. {
            prop_assert!(step < 5_000);
            if (begin..begin + length).contains(&step) {
                let known = robot.knowledge().surface().known_columns();
                robot.observe(bad, &world.look(Point::new(12.0, 12.0, 3.0), step));
                prop_assert_eq!(robot.tick(), Action::Wait);
                prop_assert_eq!(robot.waiting(), Some(Wait::Pose));
                prop_assert_eq!(robot.knowledge().surface().known_columns(), known);
                continue;
            }
            robot.observe(at, &world.look(at, step));
            match robot.tick() {
                Action::Move(to) => {
                    at = to;
                    robot.report(Motion::Moved, at);
                }
                Action::Wait => {}
                Action::Stop(stop) => {
                    prop_assert_eq!(stop, Stop::Complete);
                    break;
                }
            }
        }
    }
}

/// Behind a wall of glass across the map lies a half that cannot be reached; a door in it
/// is found.
#[test]
fn a_wall_of_glass_is_named_and_its_door_found() {
    for (door, opens) in [(None, false), (Some(12), false), (None, true)] {
        for mut robot in [coordinated(), published()] {
            let mut world = World {
                glass: (0..SIDE).map(|y| (8, y)).collect(),
                ..World::default()
            };
            if let Some(door) = door {
                world.glass.remove(&(8, door));
            }
            let (mut stop, step) = fly(&mut robot, &world, &Vec::new(), 0, 30_000);
            std::eprintln!("{stop} after {step} steps");
            if opens {
                assert!(matches!(stop, Stop::Blocked { .. }));
                world.glass.clear();
                robot.resume();
                stop = resume(&mut robot, &world);
            }
            match door {
                None if !opens => assert!(matches!(stop, Stop::Blocked { at, .. } if at.x == 8)),
                _ => assert_eq!(stop, Stop::Complete),
            }
        }
    }
}

/// Goes on from a place that the robot has stopped at.
fn resume(robot: &mut Robot, world: &World) -> Stop {
    let mut at = robot.knowledge().position();
    for step in 0..20_000 {
        robot.observe(at, &world.look(at, step));
        match robot.tick() {
            Action::Move(to) => {
                at = to;
                robot.report(Motion::Moved, at);
            }
            Action::Wait => {}
            Action::Stop(stop) => return stop,
        }
    }
    panic!("no stop");
}

/// A sensor that fails ends the survey soon, by name; one that comes back goes on.
#[test]
fn a_silent_sensor_is_a_reason_to_stop() {
    for from in [0, 7] {
        for mut robot in [coordinated(), published()] {
            let mut world = World {
                silent_from: Some(from),
                ..World::default()
            };
            let (stop, step) = fly(&mut robot, &world, &Vec::new(), 0, 400);
            assert!(matches!(stop, Stop::Unseen { .. }), "{stop}");
            assert!(step < from + 250, "{step}");
            is_true(stop, &world, &robot, false);
            world.silent_from = None;
            assert_eq!(resume(&mut robot, &world), Stop::Complete);
        }
    }
}

/// Looks at columns off the map, as from another origin, end a survey as those of a sensor that
/// fails; before the first look the robot waits.
#[test]
fn looks_that_show_nothing_complete_nothing() {
    for mut robot in [coordinated(), published()] {
        for _ in 0..1_000 {
            assert_eq!(robot.tick(), Action::Wait);
            assert_eq!(robot.waiting(), Some(Wait::Sight));
        }
        let height = Height(0);
        let cell = Cell::new(SIDE, 3);
        let mut ticks = 0;
        let stop = loop {
            robot.observe(START, &[Column { cell, height }]);
            match robot.tick() {
                Action::Stop(stop) => break stop,
                action => assert_eq!(action, Action::Wait),
            }
            ticks += 1;
            assert!(ticks < 200);
        };
        assert!(matches!(stop, Stop::Unseen { .. }), "{stop}");
        assert_eq!(resume(&mut robot, &World::default()), Stop::Complete);
    }
}

/// A robot that starts on the ground rises, one above the ceiling sinks.
#[test]
fn too_low_rises_and_too_high_sinks() {
    for z in [0.0, 30.0] {
        for mut robot in [coordinated(), published()] {
            let mut at = Point::new(6.5, 6.5, z);
            let ground: Vec<Column> = World::default().look(Point::new(6.5, 6.5, 3.0), 0);
            for step in 0..2_000 {
                // From too high nothing is in range; the ground is known from before.
                let seen = World::default().look(at, step);
                robot.observe(at, if step == 0 { &ground } else { &seen });
                match robot.tick() {
                    Action::Move(to) => {
                        assert!(at.distance(to) <= LIMITS.step + 1e-3);
                        at = to;
                        robot.report(Motion::Moved, at);
                    }
                    Action::Wait => {}
                    Action::Stop(stop) => {
                        assert_eq!(stop, Stop::Complete);
                        break;
                    }
                }
                assert!(step < 1_999, "{z}");
            }
        }
    }
}

/// A robot that stays in the only gap is named; when it has left, it is no reason any more.
#[test]
fn a_robot_in_the_only_gap_is_named() {
    for mut robot in [coordinated(), published()] {
        // Over the ridge there is no room below the ceiling, but in its saddle.
        let height = |y| if y == 3 { 34 } else { 44 };
        let world = World {
            towers: (0..7).map(|y| (3, y, height(y))).collect(),
            ..World::default()
        };
        // The others fill it.
        let script: Script = Vec::from([(0..12u8)
            .map(|number| {
                let by = |every: u8, of: u8| f32::from(number / every % of);
                let (x, y, z) = (6.2 + 0.8 * by(1, 3), 6.5 + by(3, 2), 10.5 + by(6, 2));
                let status = Status {
                    position: Point::new(x, y, z),
                    goal: None,
                    activity: Activity::Stopped,
                };
                (1 + number, status)
            })
            .collect()]);
        let (stop, step) = fly(&mut robot, &world, &script, u32::MAX, 30_000);
        std::eprintln!("{stop} after {step} steps");
        assert!(matches!(stop, Stop::Held { .. }), "{stop}");
        robot.resume();
        let stop = resume(&mut robot, &world);
        // As a robot that never heard of others.
        let (alone, _) = fly(&mut coordinated(), &world, &Vec::new(), u32::MAX, 30_000);
        assert_eq!((stop.reason(), stop.left()), (alone.reason(), alone.left()));
    }
}
