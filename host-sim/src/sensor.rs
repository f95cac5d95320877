//! What a robot sees from a cell, remembered for every cell of the world.

use std::sync::{Arc, OnceLock};

use planner_core::map::{TILE, TileIndex};
use planner_core::{Cell, Sighting, sight};

use crate::world::World;

/// A disc sensor in a world: everything in line of sight within `range` cells.
///
/// The world does not change, so each cell is looked from at most once; robots,
/// runs and threads can share one sensor.
#[derive(Debug)]
pub struct Sensor {
    world: Arc<World>,
    range: u8,
    views: Vec<OnceLock<Box<View>>>,
}

/// What is seen from one cell.
#[derive(Debug)]
pub struct View {
    /// What the robot is told.
    pub sighting: Sighting,
    /// The cells seen free, as (tile, cells) with tiles numbered row by row.
    pub free: Box<[(usize, u64)]>,
}

impl Sensor {
    /// A sensor of `range` cells (1 to [`sight::MAX_RADIUS`]; larger values
    /// count as that).
    pub fn new(world: Arc<World>, range: u8) -> Self {
        let cells = world.extent().cells() as usize;
        Self {
            world,
            range,
            views: (0..cells).map(|_| OnceLock::new()).collect(),
        }
    }

    /// The world that is seen.
    pub fn world(&self) -> &Arc<World> {
        &self.world
    }

    /// Range in cells.
    pub fn range(&self) -> u8 {
        self.range
    }

    /// What is seen from `cell`.
    ///
    /// # Panics
    /// If the cell lies outside of the world.
    pub fn view(&self, cell: Cell) -> &View {
        let extent = self.world.extent();
        assert!(
            extent.contains(cell),
            "no robot can look from {cell}, outside of {extent}"
        );
        let index = cell.y as usize * usize::from(extent.width) + cell.x as usize;
        self.views[index].get_or_init(|| Box::new(self.look(cell)))
    }

    fn look(&self, cell: Cell) -> View {
        let sighting = sight::look(cell, self.range, |cell| !self.world.is_free(cell));
        let columns = tile_columns(&self.world);
        let mut free: Vec<(usize, u64)> = Vec::new();
        for (tile, bit) in sighting.free_cells().filter_map(TileIndex::of) {
            let number = usize::from(tile.y) * columns + usize::from(tile.x);
            match free.iter_mut().find(|(known, _)| *known == number) {
                Some((_, cells)) => *cells |= bit,
                None => free.push((number, bit)),
            }
        }
        View {
            sighting,
            free: free.into(),
        }
    }
}

/// Tiles in a row of the world.
pub(crate) fn tile_columns(world: &World) -> usize {
    usize::from(world.extent().width).div_ceil(TILE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use planner_core::Extent;

    #[test]
    fn a_view_is_what_the_core_sees_and_its_tiles_hold_the_same_cells() {
        let world = World::from_fn("pillars", Extent::new(19, 13), |cell| {
            cell.x % 4 == 1 && cell.y % 3 == 1
        })
        .unwrap();
        let world = Arc::new(world);
        let sensor = Sensor::new(world.clone(), 6);
        for cell in world.free_cells() {
            let view = sensor.view(cell);
            assert_eq!(
                view.sighting,
                sight::look(cell, 6, |cell| !world.is_free(cell))
            );
            let in_tiles: u32 = view.free.iter().map(|(_, cells)| cells.count_ones()).sum();
            assert_eq!(in_tiles as usize, view.sighting.free_cells().count());
            let columns = tile_columns(&world);
            for seen in view.sighting.free_cells() {
                let (tile, bit) = TileIndex::of(seen).unwrap();
                let number = usize::from(tile.y) * columns + usize::from(tile.x);
                assert!(
                    view.free
                        .iter()
                        .any(|&(known, cells)| known == number && cells & bit != 0)
                );
            }
        }
    }
}
