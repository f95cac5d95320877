//! Worlds in which the published algorithm leaves cells unseen, or never ends.
//! Each with one robot, an ideal sensor and no fault.

use super::*;

/// The text to the letter: no goal outlives its moves, and none is followed out
/// of view.
fn literal() -> Config {
    Config {
        keep_expired: false,
        approach_hidden: false,
        ..Config::default()
    }
}

/// It stops at its start, says that frontiers are left, and has not seen `missed`.
fn assert_incomplete(rows: &[&str], radius: u8, config: Config, missed: &[(i16, i16)]) {
    let world = World::new(rows);
    let mut fleet = Fleet::new(&world, radius, config, 1);
    let stops = fleet.run(1000).unwrap();
    let robot = &fleet.robots[0];
    let frontiers = robot.map().frontiers();
    assert!(frontiers > 0);
    assert_eq!(stops, [Stop::BackAtStart { frontiers }]);
    assert_eq!(robot.position, world.start);
    let unseen: Vec<_> = fleet.unseen().iter().map(|cell| (cell.x, cell.y)).collect();
    assert_eq!(unseen, missed);
}

/// Its whole state comes back after `period` ticks: it walks in circles for ever.
fn assert_livelock(rows: &[&str], radius: u8, config: Config, period: u32) -> usize {
    let world = World::new(rows);
    let mut fleet = Fleet::new(&world, radius, config, 1);
    let found = fleet.period(1000).unwrap();
    assert_eq!(found, period);
    fleet.unseen().len()
}

/// A of the design, upside down: from (2,2) the lowest rank is the start, past
/// (3,1), from where the last frontier (5,1) was in view. It takes a certain order
/// of ties: first to (2,1), by (3,1), then west rather than east. That is the
/// order of robot 4; robot 0 explores this world.
#[test]
fn a_lowest_rank_is_a_shortcut_in_the_order_of_robot_4() {
    let world = World::new(&["########", "#.....?#", "#..1####", "########"]);
    for config in [Config::default(), literal()] {
        let mut fleet = Fleet::new(&world, 2, config, 1);
        assert_eq!(fleet.run(100), Some(std::vec![Stop::Complete]));
        assert!(fleet.unseen().is_empty());

        fleet.robots = std::vec![world.robot(config, 4)];
        let stops = fleet.run(100);
        assert_eq!(stops, Some(std::vec![Stop::BackAtStart { frontiers: 1 }]));
        assert_eq!(fleet.unseen(), [Cell::new(6, 1)]);
    }
}

/// The same trap for robot 0. The way start, (5,2), (6,2), (6,3) is a loop: from its tip the lowest rank is
/// the start, past (5,2), from where the frontier (4,2) was in view.
#[test]
fn lowest_rank_jumps_over_the_cell_that_saw_the_frontier() {
    let rows = [
        "#########",
        "###?##.##",
        "#.#....##",
        "#####1..#",
        "#########",
    ];
    assert_incomplete(&rows, 2, Config::default(), &[(3, 1)]);
    assert_incomplete(&rows, 2, literal(), &[(3, 1)]);
}

/// B: at (4,2) the goal (1,1) expires out of view and the robot turns back to (3,2),
/// two steps short of the cell from where the frontier is in view.
#[test]
fn b_an_expired_goal_is_abandoned() {
    let rows = [
        "#########",
        "#.......#",
        "#?#....##",
        "#?#1##.##",
        "#########",
    ];
    let forgetful = Config {
        keep_expired: false,
        ..Config::default()
    };
    let missed = [(1, 2), (1, 3)];
    assert_incomplete(&rows, 5, forgetful, &missed);
    assert_incomplete(&rows, 5, literal(), &missed);
    // The charitable reading gets there.
    let world = World::new(&rows);
    let mut fleet = Fleet::new(&world, 5, Config::default(), 1);
    assert_eq!(fleet.run(100), Some(std::vec![Stop::Complete]));
}

/// With the charitable reading: the step to (5,3) resolves the goal up the shaft
/// from beside its foot and opens a view to (1,3); the robot goes there, and its way
/// back ends at the start, one cell short of (5,3).
#[test]
fn a_tip_beyond_the_start_is_abandoned() {
    let rows = ["#######", "####?.#", "#####.#", "#...1.#", "#######"];
    assert_incomplete(&rows, 5, Config::default(), &[(4, 1)]);
}

/// D: from the start the frontier (4,2) is in view, from the next cell it is not.
#[test]
fn d_a_goal_goes_out_of_view_for_ever() {
    let rows = ["########", "####..?#", "#....###", "#1.#####", "########"];
    let unseen = assert_livelock(&rows, 5, literal(), 2);
    assert_eq!(unseen, 1);
    // Here it is enough to approach what was in view.
    let world = World::new(&rows);
    let mut fleet = Fleet::new(&world, 5, Config::default(), 1);
    assert_eq!(fleet.run(100), Some(std::vec![Stop::Complete]));
}

/// With the charitable reading: two frontiers, (1,2) and (7,3), each of which is
/// the farther one when the robot chooses, and out of view when it is near.
#[test]
fn two_frontiers_in_turn_for_ever() {
    let rows = [
        "#########",
        "#######?#",
        "#....##?#",
        "###.1...#",
        "#########",
    ];
    let unseen = assert_livelock(&rows, 5, Config::default(), 4);
    assert_eq!(unseen, 2);
}

/// With frontiers by eight neighbours the corner of a closed room is a frontier
/// for ever: what lies behind its two walls is never seen.
#[test]
fn eight_neighbours_never_leave_a_corner() {
    let eight = Config {
        neighbourhood: Neighbourhood::Eight,
        ..Config::default()
    };
    let unseen = assert_livelock(&["#####", "#...#", "#.1.#", "#...#", "#####"], 5, eight, 4);
    assert_eq!(unseen, 0);
}
