//! What robots say and what is so: cells that a map lacks or has wrong.

use planner_core::{Cell, Direction, Extent, Map};

use crate::robot::Robot;
use crate::world::{Reachable, World};

/// What is wrong with a map in the end.
#[derive(Clone, Copy, Default)]
pub(super) struct Wrong {
    /// As `RobotOutcome::cells_missed`.
    pub(super) missed: u32,
    /// As `RobotOutcome::cells_unnamed`.
    pub(super) unnamed: u32,
    /// As `RobotOutcome::cells_closed`.
    pub(super) closed: u32,
    /// As `RobotOutcome::cells_opened`.
    pub(super) opened: u32,
}

/// What is wrong with the map of a robot that can reach `own` cells of a world of which
/// robots can reach `all`.
pub(super) fn wrong<const TW: usize, const TH: usize>(
    world: &World,
    all: &Reachable,
    robot: &Robot<TW, TH>,
    own: impl FnOnce() -> Reachable,
) -> Wrong {
    let map = robot.planner.map();
    let opened = cells(world.extent()).filter(|&cell| !world.is_free(cell) && map.is_free(cell));
    let opened = opened.count() as u32;
    if all.cells().all(|cell| map.is_free(cell)) {
        return Wrong {
            opened,
            ..Wrong::default()
        };
    }
    let own = own();
    let count = |is_so: &dyn Fn(Cell) -> bool| own.cells().filter(|&cell| is_so(cell)).count();
    let is_missed = |cell| !map.is_known(cell);
    let missed = count(&is_missed) as u32;
    let unnamed = match map.shut().places() {
        _ if missed == 0 => 0,
        [] => missed,
        places => {
            let named = behind(map, &own, robot.position, places);
            count(&|cell| is_missed(cell) && !named[index(own.extent(), cell)]) as u32
        }
    };
    Wrong {
        missed,
        unnamed,
        closed: count(&|cell| map.is_obstacle(cell)) as u32,
        opened,
    }
}

/// The cells that a robot at `at` could get to by `places` if they were open, and cannot by
/// its map: those beyond the cells that it can get to, row by row.
fn behind<const TW: usize, const TH: usize>(
    map: &Map<TW, TH>,
    own: &Reachable,
    at: Cell,
    places: &[Cell],
) -> Vec<bool> {
    let inside = flood(own.extent(), &[at], |cell| map.is_free(cell));
    let is_beyond = |cell| own.contains(cell) && !inside[index(own.extent(), cell)];
    flood(own.extent(), places, is_beyond)
}

/// The cells that can be reached from some by steps over those for which `is_open` holds,
/// row by row.
fn flood(extent: Extent, from: &[Cell], is_open: impl Fn(Cell) -> bool) -> Vec<bool> {
    let mut reached = vec![false; extent.cells() as usize];
    let mut wave = from.to_vec();
    while let Some(cell) = wave.pop() {
        if extent.contains(cell) && is_open(cell) && !reached[index(extent, cell)] {
            reached[index(extent, cell)] = true;
            wave.extend(Direction::ALL.map(|way| cell.step(way)));
        }
    }
    reached
}

fn index(extent: Extent, cell: Cell) -> usize {
    cell.y as usize * usize::from(extent.width) + cell.x as usize
}

fn cells(extent: Extent) -> impl Iterator<Item = Cell> {
    let row = move |y| (0..extent.width as i16).map(move |x| Cell::new(x, y));
    (0..extent.height as i16).flat_map(row)
}
