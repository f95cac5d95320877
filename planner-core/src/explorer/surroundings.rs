//! What the searches read: the map and where the robot stands on it.

use super::closed::ClosedCells;
use crate::cell::Cell;
use crate::map::{Map, TileIndex};

/// The robot's knowledge of the place, apart from the other robots.
pub(crate) struct Surroundings<const TW: usize, const TH: usize> {
    pub(crate) map: Map<TW, TH>,
    pub(crate) closed: ClosedCells,
    pub(crate) position: Cell,
    /// Ticks so far.
    pub(crate) now: u32,
}

impl<const TW: usize, const TH: usize> Surroundings<TW, TH> {
    /// Free cells of a tile, as far as anybody knows: for the others' waves.
    pub(crate) fn free(&self, at: TileIndex) -> u64 {
        self.map.free(at)
    }

    /// Free cells of a tile that did not refuse this robot: for its own waves.
    pub(crate) fn open(&self, at: TileIndex) -> u64 {
        self.free(at) & !self.closed.mask(at, self.now)
    }

    /// The cells that are closed now.
    pub(crate) fn closed_now(&self) -> impl Iterator<Item = Cell> + '_ {
        self.closed.iter(self.now)
    }

    pub(crate) fn is_closed(&self, cell: Cell) -> bool {
        self.closed.is_closed(cell, self.now)
    }
}
