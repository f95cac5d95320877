mod counterexamples;
mod parts;
mod properties;
mod world;

use std::vec::Vec;

use super::*;
use world::{Fleet, World};

const SECOND_CHANCE: Config = Config {
    second_chance: true,
    d_max: 2,
    drop_resolved: true,
    keep_expired: true,
    approach_hidden: true,
    silence: 1000,
    link: crate::radio::LinkConfig::new(),
    ..Config::VACANT
};

fn easy() -> World {
    World::new(&[
        "###############",
        "#1....#.......#",
        "#.###.#.#####.#",
        "#.#...#.....#.#",
        "#.#.#######.#.#",
        "#.............#",
        "###############",
    ])
}

#[test]
fn an_easy_world_is_explored() {
    let world = easy();
    for config in [Config::default(), SECOND_CHANCE] {
        for count in 1..=3 {
            let mut fleet = Fleet::new(&world, 3, config, count);
            let stops = fleet.run(500).unwrap();
            assert!(fleet.unseen().is_empty());
            // Who is home early does not know how much is left.
            let early =
                |stop: &Stop| matches!(stop, Stop::BackAtStart { frontiers } if *frontiers > 0);
            assert!(stops.contains(&Stop::Complete));
            assert!(
                stops
                    .iter()
                    .all(|stop| *stop == Stop::Complete || early(stop))
            );
            for robot in fleet.robots {
                assert_eq!(robot.position, world.start);
            }
        }
    }
}

#[test]
fn the_same_input_gives_the_same_decisions() {
    let world = easy();
    let run = || {
        let mut fleet = Fleet::new(&world, 2, SECOND_CHANCE, 3);
        let actions: Vec<_> = (0..200).map(|_| fleet.tick()).collect();
        (actions, fleet.robots)
    };
    assert!(run() == run());
}

/// One robot explores the long corridor, the other one the short one.
fn two_corridors() -> World {
    World::new(&["################", "#..1...........#", "################"])
}

#[test]
fn second_chance_makes_a_robot_leave_its_start_again() {
    let world = two_corridors();
    let mut plain = Fleet::new(&world, 1, Config::default(), 2);
    let mut again = Fleet::new(&world, 1, SECOND_CHANCE, 2);
    let mut stopped_early = false;
    let mut left_again = false;
    for _ in 0..100 {
        let actions = plain.tick();
        let stopped = actions
            .iter()
            .filter(|action| matches!(action, Action::Stop(_)));
        stopped_early |= stopped.count() == 1 && !plain.unseen().is_empty();

        let before = again.robots.clone();
        let actions = again.tick();
        for ((robot, before), action) in again.robots.iter().zip(&before).zip(actions) {
            left_again |= before.position == world.start
                && before.status().activity == Activity::Exploring
                && robot.status().activity == Activity::SecondChance
                && matches!(action, Action::Move(_));
        }
    }
    assert!(
        stopped_early,
        "without second chance one robot leaves the work to the other"
    );
    assert!(left_again);
    let stops = again.run(1).unwrap();
    assert!(stops.iter().all(|stop| *stop == Stop::Complete));
    assert!(again.unseen().is_empty());
}

#[test]
fn a_second_chance_does_not_outlive_silence() {
    let world = two_corridors();
    let config = Config {
        silence: 50,
        ..SECOND_CHANCE
    };
    let mut fleet = Fleet::new(&world, 1, config, 2);
    let robot = |fleet: &Fleet, activity| {
        let found = fleet
            .robots
            .iter()
            .position(|robot| robot.status().activity == activity);
        found.unwrap()
    };
    while fleet
        .robots
        .iter()
        .all(|robot| robot.status().activity == Activity::Exploring)
    {
        fleet.tick();
    }
    let dead = robot(&fleet, Activity::Exploring);
    // It did not finish its corridor, and from now on it is silent. The frontier is
    // out of view from where its trace ends, so the other one does not find it.
    fleet.robots.remove(dead);
    let stops = fleet.run(300).unwrap();
    assert_eq!(stops, [Stop::BackAtStart { frontiers: 1 }]);
    assert!(!fleet.unseen().is_empty());
}

#[test]
fn a_cell_that_stays_blocked_ends_in_a_truthful_stop() {
    let world = World::new(&["########", "#.1....#", "########"]);
    let mut fleet = Fleet::new(&world, 1, Config::default(), 1);
    fleet.barred.push(Cell::new(3, 1));
    let stops = fleet.run(2000).unwrap();
    let at = Cell::new(3, 1);
    assert_eq!(stops, [Stop::Blocked { frontiers: 1, at }]);

    // From here it has made room, and has lost the frontier from view.
    let mut fleet = Fleet::new(&world, 1, Config::default(), 1);
    fleet.barred.push(Cell::new(5, 1));
    let stops = fleet.run(2000).unwrap();
    assert_eq!(stops, [Stop::BackAtStart { frontiers: 1 }]);
}

#[test]
fn a_cell_that_is_blocked_for_a_while_is_tried_again() {
    let world = World::new(&["########", "#1.....#", "########"]);
    let mut fleet = Fleet::new(&world, 1, Config::default(), 1);
    fleet.barred.push(Cell::new(4, 1));
    assert_eq!(fleet.run(20), None);
    fleet.barred.clear();
    assert_eq!(fleet.run(200), Some(std::vec![Stop::Complete]));
    assert!(fleet.unseen().is_empty());
}

#[test]
fn a_vacant_planner_waits_and_a_reset_one_is_new() {
    let mut robot = world::Robot::vacant();
    assert_eq!(robot.tick(), Action::Wait);
    assert_eq!(
        robot.observe(&Sighting::new(Cell::new(1, 1))),
        Learnt::default()
    );

    let world = easy();
    let mut fleet = Fleet::new(&world, 3, SECOND_CHANCE, 2);
    fleet.run(500).unwrap();
    let mut used = fleet.robots.remove(0);
    let new = world.robot(Config::default(), 4);
    let asked = Extent::new(900, 2);
    let capacity = world::Robot::new(Config::default(), RobotId(0), asked, world.start);
    assert!(matches!(capacity, Err(ExtentError::TooLarge { .. })));
    used.reset(
        Config::default(),
        RobotId(4),
        new.map().extent(),
        world.start,
    )
    .unwrap();
    assert!(used == new);
    // Before it has looked it does not know whether anything is left.
    assert_eq!(used.tick(), Action::Wait);
}

#[test]
fn memory_is_as_documented() {
    let size = size_of::<LocalFrontiers<8, 8>>();
    assert!((64 * 153..64 * 153 + 1024).contains(&size), "{size}");
    let size = size_of::<LocalFrontiers<16, 16>>();
    assert!((256 * 153..256 * 153 + 1024).contains(&size), "{size}");
}
