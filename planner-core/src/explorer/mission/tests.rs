//! Errands and energy in small worlds.

use std::boxed::Box;

use proptest::prelude::*;

use super::*;
use crate::cell::Extent;
use crate::explorer::Config;
use crate::explorer::tests::scene::{self, Ghost, Scene, Trouble, run};
use crate::explorer::tests::soak;
use crate::planner::{Inspect, Planner};
use crate::robot::{Motion, RobotId};
use crate::sight::{Sighting, look};

type Small = Explorer<3, 3>;

/// A robot in a corridor of 20 cells, in the third one.
struct Corridor {
    robot: Box<Small>,
    at: Cell,
    shut: Option<Cell>,
    steps: u32,
}

impl Corridor {
    fn new(config: Config) -> Self {
        let at = Cell::new(3, 1);
        let robot = Small::new(config, RobotId(0), Extent::new(22, 3), at);
        Self {
            robot: Box::new(robot.unwrap()),
            at,
            shut: None,
            steps: 0,
        }
    }

    fn tick(&mut self) -> Action {
        let is_blocked = |cell: Cell| cell.y != 1 || !(1..=20).contains(&cell.x);
        self.robot.observe(&look(self.at, 3, is_blocked));
        let action = self.robot.tick();
        assert!(self.robot.work() <= self.robot.config.work_bound());
        if let Action::Move(step) = action {
            let next = self.at.step(step);
            if self.shut == Some(next) {
                self.robot.report(Motion::Blocked);
            } else {
                self.at = next;
                self.steps += 1;
                self.robot.report(Motion::Moved);
            }
        }
        action
    }

    fn run(&mut self) -> Stop {
        for _ in 0..20_000 {
            if let Action::Stop(stop) = self.tick() {
                return stop;
            }
        }
        panic!("still running at {}", self.at);
    }
}

const HOME: Cell = Cell::new(3, 1);

#[test]
fn a_robot_that_has_explored_comes_home() {
    let config = Config {
        come_home: true,
        ..Config::new()
    };
    let mut corridor = Corridor::new(config);
    assert_eq!((corridor.run(), corridor.at), (Stop::Complete, HOME));
    corridor.robot.resume();
    assert_eq!((corridor.run(), corridor.at), (Stop::Complete, HOME));
}

#[test]
fn a_robot_goes_where_it_is_told_and_goes_on_from_there() {
    let mut corridor = Corridor::new(Config::new());
    for _ in 0..12 {
        corridor.tick();
    }
    let (before, to) = (corridor.at, Cell::new(1, 1));
    assert!(before != HOME);
    assert!(!corridor.robot.go_to(Cell::new(22, 1)), "outside");
    assert!(
        corridor.robot.status().goal.is_some(),
        "nothing has changed"
    );
    assert!(corridor.robot.go_to(to));
    assert!(corridor.robot.status().has_stopped(), "it explores no more");
    let stop = corridor.run();
    let frontiers = corridor.robot.map().frontiers();
    assert!(frontiers > 0);
    assert_eq!(stop, Stop::Arrived { frontiers, at: to });
    assert!(corridor.robot.go_home());
    assert_eq!(
        (corridor.run(), corridor.at),
        (Stop::Home { frontiers }, HOME)
    );
    let unknown = Cell::new(20, 1);
    assert!(corridor.robot.go_to(unknown));
    assert_eq!(
        corridor.run(),
        Stop::NoWay {
            frontiers,
            at: unknown
        }
    );
    corridor.robot.resume();
    assert_eq!(corridor.run(), Stop::Complete);
}

#[test]
fn a_way_home_that_stays_blocked_is_tried_until_patience_ends() {
    let mut corridor = Corridor::new(Config::new());
    assert_eq!(corridor.run(), Stop::Complete);
    let door = Cell::new(16, 1);
    corridor.robot.go_to(Cell::new(19, 1));
    assert!(matches!(corridor.run(), Stop::Arrived { .. }));
    corridor.shut = Some(door);
    let before = corridor.robot.around.now;
    assert!(corridor.at.x > door.x && corridor.robot.go_home());
    let blocked = Stop::Blocked {
        frontiers: 0,
        at: door,
    };
    assert_eq!(corridor.run(), blocked);
    assert!(
        corridor.robot.around.now - before > 256,
        "it waited and tried again"
    );
    corridor.shut = None;
    assert!(corridor.robot.go_home());
    assert_eq!(corridor.run(), Stop::Home { frontiers: 0 });
}

#[test]
fn a_robot_turns_back_while_its_energy_lasts_and_goes_on_with_more() {
    let mut corridor = Corridor::new(Config::new());
    assert!(corridor.robot.energy(20));
    assert!(matches!(corridor.run(), Stop::Home { frontiers: 1.. }));
    assert_eq!((corridor.at, corridor.steps), (HOME, 20), "it used all");
    corridor.robot.resume();
    assert!(matches!(corridor.run(), Stop::Home { .. }), "none is left");
    assert_eq!(corridor.steps, 20);
    corridor.robot.energy(100);
    corridor.robot.resume();
    assert_eq!(corridor.run(), Stop::Complete);
}

#[test]
fn energy_counts_for_a_visit_too() {
    let mut corridor = Corridor::new(Config::new());
    assert_eq!(corridor.run(), Stop::Complete);
    corridor.robot.energy(30);
    assert!(corridor.robot.go_to(Cell::new(1, 1)));
    assert!(matches!(corridor.run(), Stop::Arrived { .. }));
    let steps = corridor.steps;
    corridor.robot.energy(12);
    assert!(corridor.robot.go_to(Cell::new(20, 1)));
    assert_eq!(corridor.run(), Stop::Home { frontiers: 0 });
    assert_eq!((corridor.at, corridor.steps - steps), (HOME, 12));
}

#[test]
fn a_robot_that_was_carried_measures_its_way_home_anew() {
    let mut corridor = Corridor::new(Config::new());
    assert_eq!(corridor.run(), Stop::Complete);
    corridor.robot.energy(17);
    corridor.at = Cell::new(20, 1);
    corridor.robot.observe(&Sighting::new(corridor.at));
    corridor.robot.go_to(Cell::new(19, 1));
    corridor.steps = 0;
    assert_eq!(corridor.run(), Stop::Home { frontiers: 0 });
    assert_eq!((corridor.at, corridor.steps), (HOME, 17));
}

#[test]
fn a_mission_is_small() {
    let mission = size_of::<Budget>() + size_of::<Cell>() + size_of::<Maybe<Errand>>();
    assert!(mission <= 64, "{mission} bytes");
}

fn coming_home(is_troubled: bool) -> impl Strategy<Value = Scene> {
    scene::scene(is_troubled).prop_map(|mut scene| {
        scene.config.come_home = true;
        scene
    })
}

/// With a few steps or many.
fn limited(is_troubled: bool) -> impl Strategy<Value = Scene> {
    let energy = (prop_oneof![0u32..60, 0u32..1000], 1u32..100);
    (scene::scene(is_troubled), energy, any::<bool>()).prop_map(|(mut scene, energy, comes)| {
        scene.config.come_home = comes;
        scene.energy = Some(energy);
        scene
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: soak().cases.div_ceil(5), ..soak() })]

    #[test]
    fn every_robot_that_is_done_comes_home(scene in coming_home(false)) {
        let ended = run(&scene, 100_000);
        for (robot, stop) in ended.robots.iter().zip(&ended.stops) {
            let stop = stop.ok_or_else(|| TestCaseError::fail("still running"))?;
            let is_home = robot.around.position == robot.role.home;
            prop_assert!(stop.is_complete(), "{}", stop);
            prop_assert!(is_home, "at {}: {}", robot.around.position, stop);
        }
    }

    #[test]
    fn every_robot_in_trouble_comes_home_or_says_why_not(scene in coming_home(true)) {
        let ended = run(&scene, 200_000);
        for (robot, stop) in ended.robots.iter().zip(&ended.stops) {
            let stop = stop.ok_or_else(|| TestCaseError::fail(std::format!(
                "still running at {}, {:?} {:?}",
                robot.around.position, robot.waiting(), robot.role
            )))?;
            let is_home = robot.around.position == robot.role.home;
            let says_why = matches!(
                stop,
                Stop::NoWay { .. } | Stop::Blocked { .. } | Stop::Held { .. }
            );
            prop_assert!(is_home || says_why, "at {}: {}", robot.around.position, stop);
        }
    }

    /// Cells that refuse for good, robots in the way: it stops, and while it walks its
    /// energy lasts for the way that it knows.
    #[test]
    fn every_robot_in_trouble_stops_with_its_energy(scene in limited(true)) {
        let ended = run(&scene, 200_000);
        for (robot, stop) in ended.robots.iter().zip(&ended.stops) {
            prop_assert!(stop.is_some(), "still running at {}", robot.around.position);
        }
    }
}

proptest! {
    #![proptest_config(soak())]

    /// That no robot is caught out is asserted in each tick.
    #[test]
    fn every_robot_comes_home_in_time(mut scene in limited(false)) {
        // Bodies that do not exchange roles can be in each other's way for good.
        scene.solid &= scene.start.len() == 1;
        let ended = run(&scene, 100_000);
        for (robot, stop) in ended.robots.iter().zip(&ended.stops) {
            let stop = stop.ok_or_else(|| TestCaseError::fail(std::format!(
                "still running at {}, {:?} {:?}",
                robot.around.position, robot.waiting(), robot.role
            )))?;
            let is_home = robot.around.position == robot.role.home;
            prop_assert!(stop.is_complete() || matches!(stop, Stop::Home { .. }), "{}", stop);
            let must_be_home = scene.config.come_home || !stop.is_complete();
            prop_assert!(is_home || !must_be_home, "at {}: {}", robot.around.position, stop);
        }
    }
}

/// A stopped robot stands on the way round a cell that refuses, and does not know of it:
/// by exchanges of bodies the role went to and fro.
#[test]
fn a_role_whose_way_is_longer_in_one_body_than_in_the_other_comes_home() {
    let rows = "\
        ..............#....\
        ......####.........\
        ..#..#....#........\
        ...................\
        ......#............\
        .....#..#...#.#....\
        ...................\
        ....##...#...#.....\
        .#.................\
        ...................\
        ##.................";
    let scene = Scene {
        extent: Extent::new(19, 11),
        walls: rows.bytes().map(|cell| cell == b'#').collect(),
        start: [(7, 3), (7, 6), (8, 0)]
            .map(|(x, y)| Cell::new(x, y))
            .into(),
        radius: 1,
        config: Config {
            slice: 6000,
            way: 8,
            come_home: true,
            ..Config::new()
        },
        sync: 0,
        refusals: 0,
        solid: true,
        trouble: Trouble {
            ghosts: [Ghost {
                id: 0,
                aim: 0,
                period: 1,
                silence: u32::MAX,
            }]
            .into(),
            refusing: [(Cell::new(9, 0), true)].into(),
            view: 180,
            astray: [(1, 161, 35)].into(),
            ..Trouble::default()
        },
        seed: 3675672467904345921,
        energy: None,
        kept_out: [].into(),
        kept_from: 0,
    };
    let ended = run(&scene, 10_000);
    let role = |id| ended.robots.iter().find(|robot| robot.role.rank == id);
    let walker = role(RobotId(2)).unwrap();
    assert_eq!(walker.around.position, walker.role.home);
    assert!(ended.stops.iter().all(Option::is_some));
}
