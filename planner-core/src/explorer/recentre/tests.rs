//! Grids that move over places larger than they are.

use std::vec::Vec;

use proptest::prelude::*;

use super::*;
use crate::cell::{Extent, ExtentError};
use crate::explorer::Config;
use crate::map::{Level, Map};
use crate::planner::{Contact, Errands, Planner};
use crate::robot::{Action, Motion, RobotId, Stop};
use crate::sight::look;
use crate::tile::TileSet;

type Small = Explorer<3, 3>;

fn robot(extent: Extent, start: Cell) -> Result<Small, ExtentError> {
    Small::new(Config::new(), RobotId(3), extent, start)
}

/// Every cell of a map with its level, unknown ones left out.
fn levels(map: &Map<3, 3>) -> Vec<(Cell, Level)> {
    let Extent { width, height } = map.extent();
    let cells = (0..height as i16).flat_map(|y| (0..width as i16).map(move |x| Cell::new(x, y)));
    let levels = cells.map(|cell| (cell, map.level(cell)));
    levels
        .filter(|(_, level)| *level != Level::Unknown)
        .collect()
}

proptest! {
    #[test]
    fn what_stays_is_the_same_and_what_falls_off_is_told(
        (width, height) in (1u16..=24, 1u16..=24),
        start in (0i16..24, 0i16..24),
        (columns, rows) in (-4i8..=4, -4i8..=4),
        layers in prop::collection::vec(any::<[u64; 3]>(), 9),
    ) {
        let extent = Extent::new(width, height);
        let start = Cell::new(start.0 % width as i16, start.1 % height as i16);
        let mut robot = robot(extent, start).unwrap();
        let mut told = Map::<3, 3>::new(extent).unwrap();
        for (planes, index) in layers.into_iter().zip(0u8..) {
            told.join_tile(TileIndex::new(index % 3, index / 3), Tile::from_planes(planes));
        }
        robot.join(&told, &TileSet::full());
        let before = levels(robot.map());
        let origin = robot.config.link.origin_mm;
        let mut fallen = Vec::new();
        let result = robot.recentre(columns, rows, |at, tile| {
            let cells = (0..64).map(|bit| (at.cell(bit), tile.level(bit)));
            fallen.extend(cells.filter(|(_, level)| *level != Level::Unknown));
        });
        let (dx, dy) = (8 * i16::from(columns), 8 * i16::from(rows));
        let moved = |cell: Cell| Cell::new(cell.x - dx, cell.y - dy);
        if !extent.contains(moved(start)) {
            prop_assert_eq!(result, Err(MoveError::Robot(start)));
            prop_assert_eq!(levels(robot.map()), before);
            prop_assert!(fallen.is_empty());
            return Ok(());
        }
        prop_assert_eq!(result, Ok(()));
        prop_assert_eq!(robot.status().position, moved(start));
        let stays = |of: &&(Cell, Level)| extent.contains(moved(of.0));
        let mut stayed: Vec<_> = before.iter().filter(stays).map(|of| (moved(of.0), of.1)).collect();
        let mut fell: Vec<_> = before.iter().filter(|of| !stays(of)).copied().collect();
        let by_cell = |of: &(Cell, Level)| (of.0.y, of.0.x);
        stayed.sort_by_key(by_cell);
        fell.sort_by_key(by_cell);
        fallen.sort_by_key(by_cell);
        prop_assert_eq!(levels(robot.map()), stayed);
        prop_assert_eq!(fallen, fell);
        // What is counted is what a map counts that was told the same.
        let mut fresh = Map::<3, 3>::new(extent).unwrap();
        fresh.join(robot.map());
        let counts = |map: &Map<3, 3>| (map.frontiers(), map.unknown_cells(), map.free_edge_cells());
        prop_assert_eq!(counts(robot.map()), counts(&fresh));
        let east = origin.0 + i32::from(dx) * i32::from(robot.config.link.cell_mm);
        let north = origin.1 - i32::from(dy) * i32::from(robot.config.link.cell_mm);
        prop_assert_eq!(robot.config.link.origin_mm, (east, north));
    }
}

/// A corridor of 90 cells and a map of 24: the robot moves on whenever it stops at its edge,
/// and has seen all of it in the end.
#[test]
fn a_place_larger_than_the_map_is_seen_piece_by_piece() {
    let is_wall = |cell: Cell| cell.y < 9 || cell.y > 11 || cell.x < 0 || cell.x >= 90;
    let (mut corner, mut here) = (0, Cell::new(2, 10));
    let mut robot = robot(Extent::new(24, 24), here).unwrap();
    let (mut seen, mut moves) = (Vec::new(), 0);
    for _ in 0..5_000 {
        robot.observe(&look(here, 5, |cell| {
            is_wall(Cell::new(cell.x + corner, cell.y))
        }));
        match robot.tick() {
            Action::Move(step) => {
                here = here.step(step);
                robot.report(Motion::Moved);
            }
            Action::Wait => {}
            Action::Stop(stop) => {
                let frees = |corner: i16| {
                    move |(cell, level): (Cell, Level)| {
                        let is_free = matches!(level, Level::Free | Level::Visited);
                        is_free.then_some(Cell::new(cell.x + corner, cell.y))
                    }
                };
                assert!(matches!(stop, Stop::AtEdge { .. }), "{stop}");
                if !(9..=11).any(|y| robot.map().is_free(Cell::new(23, y))) {
                    seen.extend(levels(robot.map()).into_iter().filter_map(frees(corner)));
                    break;
                }
                robot.settle();
                let fell = |at: TileIndex, tile: Tile| {
                    let cells = (0..64).map(|bit| (at.cell(bit), tile.level(bit)));
                    seen.extend(cells.filter_map(frees(corner)));
                };
                robot.recentre(2, 0, fell).unwrap();
                (corner, moves) = (corner + 16, moves + 1);
                here = Cell::new(here.x - 16, here.y);
                assert_eq!(robot.status().position, here);
            }
        }
    }
    seen.sort_unstable_by_key(|cell| (cell.x, cell.y));
    seen.dedup();
    assert_eq!(seen.len(), 90 * 3, "{moves} moves, {:?}", robot.map());
}

#[test]
fn a_grid_does_not_move_from_under_a_robot_or_its_home_nor_for_ever() {
    let start = Cell::new(4, 4);
    let mut robot = robot(Extent::new(24, 24), start).unwrap();
    let try_to = |robot: &mut Small, columns| robot.recentre(columns, 0, |_, _| panic!("fell"));
    assert_eq!(try_to(&mut robot, 1), Err(MoveError::Robot(start)));
    let away = Cell::new(12, 4);
    robot.observe(&look(away, 2, |_| false));
    assert_eq!(try_to(&mut robot, 1), Err(MoveError::Home(start)));
    robot
        .keep_out(Some(crate::explorer::tests::scene::kept(&[Cell::new(
            20, 20,
        )])))
        .unwrap();
    robot.settle();
    assert_eq!(try_to(&mut robot, 1), Err(MoveError::KeptOut));
    robot.keep_out(None).unwrap();
    for number in 0..MOST_MOVES {
        let columns = if number % 2 == 0 { -1 } else { 1 };
        assert_eq!(robot.recentre(columns, 0, |_, _| {}), Ok(()));
    }
    assert_eq!(try_to(&mut robot, -1), Err(MoveError::TooOften));
}
