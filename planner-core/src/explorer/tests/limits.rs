//! Robots that keep out of cells, in small worlds.

use std::vec;
use std::vec::Vec;

use proptest::prelude::*;

use super::scene::*;
use super::*;
use crate::planner::{Errands, KeepOutError};
use crate::tile::bits;

/// Robots that keep out of rectangles and of single cells, all of the same or each of its
/// own, from the start or from some tick on.
fn limited(is_troubled: bool) -> impl Strategy<Value = Scene> {
    let cells = || {
        let rectangle = (0i16..20, 0i16..20, 0i16..8, 0i16..8);
        prop::collection::vec(rectangle, 0..4).prop_map(|rectangles| {
            let of = |(x, y, width, height)| {
                let row = move |y| (x..=x + width).map(move |x| Cell::new(x, y));
                (y..=y + height).flat_map(row)
            };
            rectangles.into_iter().flat_map(of).collect::<Vec<_>>()
        })
    };
    let from = prop_oneof![Just(0u32), 0u32..200];
    let each = prop::collection::vec(cells(), 6);
    (scene(is_troubled), each, any::<bool>(), from).prop_map(|(mut scene, each, are_same, from)| {
        let robots = scene.start.len();
        scene.kept_out = match are_same {
            true => vec![each[0].clone(); robots],
            false => each.into_iter().take(robots).collect(),
        };
        scene.kept_from = from;
        scene
    })
}

/// Nothing is told that is not so, and nothing of what a robot keeps out of.
fn assert_maps_are_true(scene: &Scene, ended: &Ended) -> Result<(), TestCaseError> {
    for robot in &ended.robots {
        let map = robot.map();
        for at in every_tile(3, 3) {
            let told = map.tile_inside(at);
            prop_assert_eq!(told.known() & map.kept_out(at), 0);
            for cell in bits(told.known()).map(|bit| at.cell(bit)) {
                let is_true = map.is_free(cell) != scene.is_blocked(cell);
                prop_assert!(is_true, "{} in {:?}", cell, map);
            }
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: soak().cases.div_ceil(4), ..soak() })]

    #[test]
    fn every_robot_knows_all_that_it_can_reach_without(scene in limited(false)) {
        let ended = assert_truthful(&scene)?;
        assert_maps_are_true(&scene, &ended)?;
    }

    #[test]
    fn every_robot_in_trouble_that_keeps_out_tells_the_truth(scene in limited(true)) {
        assert_truthful(&scene)?;
    }
}

/// A hall of 20×5 cells in which the middle is forbidden, all of it or but for a gap.
struct Hall {
    robot: Small,
    at: Cell,
    forbidden: Vec<Cell>,
}

const EXTENT: Extent = Extent::new(20, 5);
const START: Cell = Cell::new(2, 2);

impl Hall {
    fn new(has_gap: bool) -> Self {
        let rows = if has_gap { 0..4 } else { 0..5 };
        let row = |y| (9..12).map(move |x| Cell::new(x, y));
        let mut hall = Self {
            robot: Small::new(Config::new(), RobotId(0), EXTENT, START).unwrap(),
            at: START,
            forbidden: rows.flat_map(row).collect(),
        };
        hall.forbid().unwrap();
        hall
    }

    fn forbid(&mut self) -> Result<(), KeepOutError> {
        self.robot.keep_out(Some(kept(&self.forbidden)))
    }

    fn tick(&mut self) -> Action {
        let is_wall = |cell| !EXTENT.contains(cell);
        self.robot.observe(&crate::sight::look(self.at, 3, is_wall));
        let action = self.robot.tick();
        if let Action::Move(step) = action {
            self.at = self.at.step(step);
            self.robot.report(Motion::Moved);
        }
        action
    }

    fn run(&mut self) -> Stop {
        for _ in 0..2000 {
            if let Action::Stop(stop) = self.tick() {
                return stop;
            }
        }
        panic!("still running at {}", self.at);
    }
}

#[test]
fn what_is_seen_behind_is_out_of_reach_until_the_ban_is_lifted() {
    let mut hall = Hall::new(false);
    assert!(hall.run().is_complete());
    assert!(hall.at.x < 9);
    assert!(hall.robot.map().is_obstacle(Cell::new(9, 2)));
    let told = hall.robot.map().tile_inside(TileIndex::new(1, 0));
    assert_eq!(told.known() & 0b1110, 0, "nothing is told");
    hall.robot.keep_out(None).unwrap();
    assert!(matches!(hall.run(), Stop::AtEdge { .. }));
    assert_eq!(hall.robot.map().unknown_cells(), 0);
}

#[test]
fn frontiers_and_the_edge_leave_forbidden_cells_out() {
    let mut hall = Hall::new(false);
    hall.run();
    let map = hall.robot.map();
    assert_eq!(map.frontiers(), 0);
    // Two long sides of nine cells and the short one, without the six forbidden ones.
    assert_eq!(map.free_edge_cells(), 9 + 9 + 3);
}

#[test]
fn a_way_leads_around() {
    let mut hall = Hall::new(true);
    assert!(matches!(hall.run(), Stop::AtEdge { .. }));
    assert!(hall.robot.go_to(Cell::new(18, 0)));
    assert!(matches!(hall.run(), Stop::Arrived { .. }));
    let inside = Cell::new(10, 0);
    hall.robot.go_to(inside);
    let frontiers = hall.robot.map().frontiers();
    let no_way = Stop::NoWay {
        frontiers,
        at: inside,
    };
    assert_eq!(hall.run(), no_way);
}

#[test]
fn a_robot_that_was_carried_into_them_waits() {
    let mut hall = Hall::new(true);
    assert!(hall.run().is_complete());
    hall.robot.go_home();
    hall.at = Cell::new(10, 1);
    assert_eq!(hall.tick(), Action::Wait);
    assert_eq!(hall.robot.waiting(), Some(Wait::Pose));
    hall.at = Cell::new(13, 3);
    assert!(matches!(hall.run(), Stop::Home { .. }));
    assert_eq!(hall.at, START);
}

#[test]
fn neither_the_robot_nor_its_home_may_lie_in_them() {
    let mut hall = Hall::new(true);
    hall.run();
    hall.forbidden = vec![START];
    assert_eq!(hall.forbid(), Err(KeepOutError::Home(START)));
    hall.forbidden = vec![hall.at, START];
    assert_eq!(hall.forbid(), Err(KeepOutError::Robot(hall.at)));
    assert!(hall.robot.map().keeps_out(Cell::new(10, 0)), "as before");
    assert!(hall.robot.role.has_stopped(), "nothing has changed");
}
