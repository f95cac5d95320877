//! Obstacles thrown onto an open floor.

use planner_core::{Cell, Extent};

use super::super::grid::Grid;
use crate::dice::Dice;

/// Each cell is an obstacle in `density` per cent of cases.
pub(super) fn obstacles(extent: Extent, density: u16, dice: &mut Dice) -> Grid {
    let mut grid = Grid::from_fn(extent, |_| dice.chance(density));
    if grid.free_cells().next().is_none() {
        grid.set_blocked(Cell::new(0, 0), false);
    }
    grid
}

/// Boxes with sides of 1 to `largest` cells that keep one free cell around
/// them, also diagonally, so that the floor stays in one piece. They are
/// thrown until `density` per cent of the cells are covered or, the floor
/// being full, as many throws as there are cells have been made.
pub(super) fn blocks(extent: Extent, density: u16, largest: u16, dice: &mut Dice) -> Grid {
    let mut grid = Grid::filled(extent, false);
    let wanted = extent.cells() * u32::from(density) / 100;
    let mut covered = 0;
    for _ in 0..extent.cells() {
        if covered >= wanted {
            break;
        }
        let (width, height) = (dice.between(1, largest), dice.between(1, largest));
        let left = dice.below(extent.width.into()) as i16;
        let top = dice.below(extent.height.into()) as i16;
        if has_room(&grid, left, top, width, height) {
            fill(&mut grid, left, top, width, height);
            covered += u32::from(width * height);
        }
    }
    grid
}

/// Whether a box and the ring around it lie on free cells of the grid.
fn has_room(grid: &Grid, left: i16, top: i16, width: u16, height: u16) -> bool {
    let (right, bottom) = (left + width as i16, top + height as i16);
    (top - 1..=bottom).all(|y| (left - 1..=right).all(|x| grid.is_free(Cell::new(x, y))))
}

/// Blocks the cells of a box that lies on the grid.
pub(super) fn fill(grid: &mut Grid, left: i16, top: i16, width: u16, height: u16) {
    for y in top..top + height as i16 {
        for x in left..left + width as i16 {
            grid.set_blocked(Cell::new(x, y), true);
        }
    }
}
