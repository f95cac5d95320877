//! Which cells can be reached.

use planner_core::explorer::body_cells;
use planner_core::{Cell, Extent};

use super::World;
use super::grid::Grid;

/// The free cells that can be reached from some cells by 4-connected steps.
#[derive(Clone)]
pub struct Reachable {
    /// A grid in which only the members are free.
    members: Grid,
    count: u32,
    unreachable: u32,
}

impl Reachable {
    fn new(world: &World, cells: &[Cell]) -> Self {
        let mut members = Grid::filled(world.extent(), true);
        for &cell in cells {
            members.set_blocked(cell, false);
        }
        let count = cells.len() as u32;
        let unreachable = world.free_cells().count() as u32 - count;
        Self {
            members,
            count,
            unreachable,
        }
    }

    /// Whether `cell` can be reached; false for obstacles and outside.
    pub fn contains(&self, cell: Cell) -> bool {
        self.members.is_free(cell)
    }

    /// Number of cells that can be reached, those of the start included.
    pub fn count(&self) -> u32 {
        self.count
    }

    /// Number of free cells that cannot be reached.
    pub fn unreachable(&self) -> u32 {
        self.unreachable
    }

    /// The cells that can be reached, in reading order.
    pub fn cells(&self) -> impl Iterator<Item = Cell> + '_ {
        self.members.free_cells()
    }

    /// The grid in which these cells lie.
    pub fn extent(&self) -> Extent {
        self.members.extent()
    }
}

impl World {
    /// What can be reached from any of `from`, by one flood over the cells.
    /// Blocked cells and cells outside in `from` add nothing.
    pub fn reachable(&self, from: &[Cell]) -> Reachable {
        Reachable::new(self, &self.grid.wave(from))
    }

    /// Whether a body with its centre in `cell` touches no obstacle, see
    /// [`Config::clearance`](planner_core::explorer::Config::clearance).
    pub fn has_room(&self, cell: Cell, clearance: u8) -> bool {
        self.is_free(cell) && body_cells(clearance, cell).all(|cell| self.is_free(cell))
    }

    /// This world with more obstacles.
    pub(crate) fn without(&self, blocked: impl Fn(Cell) -> bool) -> Self {
        let is_blocked = |cell| !self.is_free(cell) || blocked(cell);
        Self {
            grid: Grid::from_fn(self.extent(), is_blocked),
            ..self.clone()
        }
    }

    /// The cells that bodies sweep that start from `from`. A start without room adds nothing.
    pub fn reachable_by(&self, from: &[Cell], clearance: u8) -> Reachable {
        if clearance == 0 {
            return self.reachable(from);
        }
        let centres = self.centres(clearance).wave(from);
        let mut swept = Grid::filled(self.extent(), true);
        for cell in centres.into_iter().flat_map(|at| body_cells(clearance, at)) {
            swept.set_blocked(cell, false);
        }
        let cells: Vec<Cell> = swept.free_cells().collect();
        Reachable::new(self, &cells)
    }

    /// The cells in which the centre of a body can be, as free.
    pub(super) fn centres(&self, clearance: u8) -> Grid {
        Grid::from_fn(self.extent(), |cell| !self.has_room(cell, clearance))
    }

    /// The largest 4-connected set of free cells; of equals the one that holds
    /// the first cell in reading order.
    pub fn largest_component(&self) -> Reachable {
        Reachable::new(self, &self.grid.largest_component())
    }

    /// The free cell nearest to `to` (Euclidean; ties in reading order).
    pub(super) fn nearest_free(&self, to: Cell) -> Cell {
        self.free_cells()
            .min_by_key(|cell| cell.distance_squared(to))
            .expect("a world has a free cell")
    }
}
