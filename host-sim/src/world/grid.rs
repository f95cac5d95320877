//! The canvas of a world: which cells are blocked, and how free cells hang
//! together.

use planner_core::{Cell, Direction, Extent};

use super::error::Problem;

/// The largest grid for which planners are compiled, in cells.
pub const LARGEST: Extent = Extent::new(512, 512);

/// Blocked cells of an extent, row by row. Cells outside are blocked.
#[derive(Clone, PartialEq, Eq)]
pub(super) struct Grid {
    extent: Extent,
    blocked: Vec<bool>,
}

impl Grid {
    /// A grid with all cells blocked, or all free.
    pub(super) fn filled(extent: Extent, blocked: bool) -> Self {
        let blocked = vec![blocked; extent.cells() as usize];
        Self { extent, blocked }
    }

    /// A grid with the cells blocked for which `blocked` says so.
    pub(super) fn from_fn(extent: Extent, mut blocked: impl FnMut(Cell) -> bool) -> Self {
        let blocked = cells(extent).map(&mut blocked).collect();
        Self { extent, blocked }
    }

    pub(super) fn extent(&self) -> Extent {
        self.extent
    }

    pub(super) fn is_free(&self, cell: Cell) -> bool {
        self.extent.contains(cell) && !self.blocked[index(self.extent, cell)]
    }

    /// Blocks or frees `cell`, which must lie on the grid.
    pub(super) fn set_blocked(&mut self, cell: Cell, blocked: bool) {
        self.blocked[index(self.extent, cell)] = blocked;
    }

    pub(super) fn free_cells(&self) -> impl Iterator<Item = Cell> + '_ {
        cells(self.extent).filter(|&cell| self.is_free(cell))
    }

    /// The free cells among the four neighbours of `cell`.
    pub(super) fn free_neighbours(&self, cell: Cell) -> impl Iterator<Item = Cell> + '_ {
        Direction::ALL
            .into_iter()
            .map(move |direction| cell.step(direction))
            .filter(|&neighbour| self.is_free(neighbour))
    }

    /// Free cells in the order in which a wave from `from` reaches them.
    pub(super) fn wave(&self, from: &[Cell]) -> Vec<Cell> {
        let mut seen = Self::filled(self.extent, false);
        let mut order = Vec::new();
        let mut push = |cell: Cell, order: &mut Vec<Cell>| {
            if self.is_free(cell) && seen.is_free(cell) {
                seen.set_blocked(cell, true);
                order.push(cell);
            }
        };
        for &cell in from {
            push(cell, &mut order);
        }
        let mut next = 0;
        while let Some(&cell) = order.get(next) {
            next += 1;
            for neighbour in self.free_neighbours(cell) {
                push(neighbour, &mut order);
            }
        }
        order
    }

    /// The largest 4-connected set of free cells; of equals the one that holds
    /// the first cell in reading order. Empty if no cell is free.
    pub(super) fn largest_component(&self) -> Vec<Cell> {
        let mut rest = self.clone();
        let mut largest = Vec::new();
        for cell in self.free_cells() {
            if !rest.is_free(cell) {
                continue;
            }
            let component = self.wave(&[cell]);
            for &member in &component {
                rest.set_blocked(member, true);
            }
            if component.len() > largest.len() {
                largest = component;
            }
        }
        largest
    }

    /// This grid with every free cell outside the largest component filled.
    pub(super) fn only_largest_component(&self) -> Self {
        let mut grid = Self::filled(self.extent, true);
        for cell in self.largest_component() {
            grid.set_blocked(cell, false);
        }
        grid
    }
}

/// Every cell of an extent in reading order.
pub(crate) fn cells(extent: Extent) -> impl Iterator<Item = Cell> {
    (0..extent.height as i16)
        .flat_map(move |y| (0..extent.width as i16).map(move |x| Cell { x, y }))
}

/// Where a cell of the extent stands in reading order.
pub(crate) fn index(extent: Extent, cell: Cell) -> usize {
    cell.y as usize * extent.width as usize + cell.x as usize
}

/// The extent of `width` × `height` cells, if planners are compiled for it.
pub(super) fn checked_extent(
    width: usize,
    height: usize,
    advice: impl FnOnce() -> String,
) -> Result<Extent, Problem> {
    if width > LARGEST.width.into() || height > LARGEST.height.into() {
        return Err(Problem::TooLarge {
            width,
            height,
            advice: advice(),
        });
    }
    Ok(Extent::new(width as u16, height as u16))
}
