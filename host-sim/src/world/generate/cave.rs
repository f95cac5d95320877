//! Caves grown by a cellular automaton.

use planner_core::{Cell, Extent};

use super::super::grid::Grid;
use crate::dice::Dice;

const ROUNDS: usize = 5;
/// Share of the cells, in per cent, that the largest cavern must have.
const LARGE_ENOUGH: usize = 40;

/// Random rock, smoothed: a cell becomes what most of the nine cells around it
/// (itself included) are. A cave in crumbs is drawn again with less rock, at
/// last with none.
pub(super) fn cave(extent: Extent, dice: &mut Dice) -> Grid {
    let mut rock = 45;
    loop {
        let mut grid = Grid::from_fn(extent, |_| dice.chance(rock));
        for _ in 0..ROUNDS {
            grid = Grid::from_fn(extent, |cell| is_mostly_rock(&grid, cell));
        }
        let largest = grid.largest_component().len();
        if rock == 0 || largest * 100 >= extent.cells() as usize * LARGE_ENOUGH {
            return grid;
        }
        rock -= 1;
    }
}

fn is_mostly_rock(grid: &Grid, cell: Cell) -> bool {
    let around = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (dx, dy)));
    let rock = around.filter(|(dx, dy)| !grid.is_free(Cell::new(cell.x + dx, cell.y + dy)));
    rock.count() >= 5
}
