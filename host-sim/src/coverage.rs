//! How much of the world has been seen, and by how many.

use planner_core::Cell;
use planner_core::tile::TileIndex;

use crate::scenario::grid::Scenario;
use crate::sensor::{View, tile_columns};
use crate::world::{Reachable, World};

/// Counts the reachable cells that robots have seen with their own sensors.
pub(crate) struct Coverage {
    reachable: Vec<u64>,
    seen: Vec<u64>,
    /// Cells seen by more than one robot.
    shared: Vec<u64>,
    by_robot: Vec<Vec<u64>>,
    seen_cells: u32,
    shared_cells: u32,
}

impl Coverage {
    pub(crate) fn new(world: &World, reachable: &Reachable, robots: usize) -> Self {
        let columns = tile_columns(world);
        let rows = usize::from(world.extent().height).div_ceil(planner_core::tile::TILE);
        let none = vec![0; columns * rows];
        let mut mask = none.clone();
        for (tile, bit) in reachable.cells().filter_map(TileIndex::of) {
            mask[usize::from(tile.y) * columns + usize::from(tile.x)] |= bit;
        }
        Self {
            reachable: mask,
            seen: none.clone(),
            shared: none.clone(),
            by_robot: vec![none; robots],
            seen_cells: 0,
            shared_cells: 0,
        }
    }

    /// A run before its first tick: what its robots know was seen before.
    pub(crate) fn of(scenario: &Scenario, reachable: &Reachable) -> Self {
        let world = &scenario.world;
        let mut coverage = Self::new(world, reachable, scenario.starts.len());
        let columns = tile_columns(world);
        let bit = |cell: Cell| {
            let (tile, bit) = TileIndex::of(cell)?;
            Some((usize::from(tile.y) * columns + usize::from(tile.x), bit))
        };
        for (robot, known) in scenario.known().into_iter().enumerate() {
            let known: Vec<_> = known.into_iter().filter_map(bit).collect();
            coverage.see(robot, &known);
        }
        coverage
    }

    /// A robot looks around.
    pub(crate) fn look(&mut self, robot: usize, view: &View) {
        self.see(robot, &view.free);
    }

    fn see(&mut self, robot: usize, cells: &[(usize, u64)]) {
        let own = &mut self.by_robot[robot];
        for &(tile, free) in cells {
            let new = free & self.reachable[tile] & !own[tile];
            if new == 0 {
                continue;
            }
            own[tile] |= new;
            let again = new & self.seen[tile] & !self.shared[tile];
            self.shared_cells += again.count_ones();
            self.shared[tile] |= again;
            let first = new & !self.seen[tile];
            self.seen_cells += first.count_ones();
            self.seen[tile] |= first;
        }
    }

    /// Reachable cells seen by anybody.
    pub(crate) fn seen_cells(&self) -> u32 {
        self.seen_cells
    }

    /// Reachable cells seen by more than one robot.
    pub(crate) fn shared_cells(&self) -> u32 {
        self.shared_cells
    }
}
