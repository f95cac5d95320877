//! What the searches read: the map and where the robot stands on it.

use super::aside::Aside;
use crate::cell::{Cell, Direction};
use crate::map::Map;
use crate::tile::TileIndex;

/// The robot's knowledge of the place, apart from the other robots.
pub(crate) struct Surroundings<const TW: usize, const TH: usize> {
    pub(crate) map: Map<TW, TH>,
    pub(crate) aside: Aside<TW, TH>,
    pub(crate) position: Cell,
    /// Ticks so far.
    pub(crate) now: u32,
}

impl<const TW: usize, const TH: usize> Surroundings<TW, TH> {
    /// Free cells of a tile, as far as anybody knows: for the others' waves.
    pub(crate) fn free(&self, at: TileIndex) -> u64 {
        self.map.free(at)
    }

    /// Free cells of a tile that did not refuse this robot, and the one that it stands on:
    /// for its own waves.
    pub(crate) fn open(&self, at: TileIndex) -> u64 {
        let free = self.free(at);
        let closed = self.aside.closed(at, &self.map);
        if closed == 0 {
            return free;
        }
        let own = match TileIndex::of(self.position) {
            Some((tile, bit)) if tile == at => bit,
            _ => 0,
        };
        free & !(closed & !own)
    }

    /// The frontier cells of a tile that are worth a look of this robot.
    pub(crate) fn goals(&self, at: TileIndex) -> u64 {
        self.map.frontier(at) & !self.aside.cells(at)
    }

    /// Whether the robot can be sent over this cell.
    pub(crate) fn is_open(&self, cell: Cell) -> bool {
        TileIndex::of(cell).is_some_and(|(at, bit)| self.open(at) & bit != 0)
    }

    /// Whether a look from this cell is worth it.
    pub(crate) fn is_goal(&self, cell: Cell) -> bool {
        TileIndex::of(cell).is_some_and(|(at, bit)| self.goals(at) & bit != 0)
    }

    /// The directions to the unknown neighbours of a cell.
    pub(crate) fn unknown_sides(&self, cell: Cell) -> impl Iterator<Item = Direction> + '_ {
        let is_unknown = move |side: &Direction| !self.map.is_known(cell.step(*side));
        Direction::ALL.into_iter().filter(is_unknown)
    }
}
