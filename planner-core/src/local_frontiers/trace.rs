//! The trace of the robot's own way.

use crate::cell::{Cell, Direction};
use crate::tile::{TileIndex, Tiles};

/// Grid 𝒢 [Gauville2019 §3.2]: 0 where the robot has not set out from, else a
/// rank that grows along its way. 128 bytes a tile.
#[derive(Clone, PartialEq, Eq)]
pub(super) struct Trace<const TW: usize, const TH: usize> {
    ranks: Tiles<[u16; 64], TW, TH>,
}

impl<const TW: usize, const TH: usize> Trace<TW, TH> {
    pub(super) const fn new() -> Self {
        Self {
            ranks: Tiles::all([0; 64]),
        }
    }

    /// Back to zero, in place.
    pub(super) fn clear(&mut self) {
        self.ranks.fill([0; 64]);
    }

    /// The rank of a cell; 0 outside.
    pub(super) fn rank(&self, cell: Cell) -> u16 {
        TileIndex::of(cell)
            .and_then(|(at, bit)| self.ranks.get(at)?.get(bit.trailing_zeros() as usize))
            .copied()
            .unwrap_or(0)
    }

    /// Gives a cell without rank one more than the highest of its neighbours.
    /// Ranks end at 65,535: a longer way than that repeats the last one.
    pub(super) fn mark(&mut self, cell: Cell) {
        if self.rank(cell) > 0 {
            return;
        }
        let highest = Direction::ALL
            .into_iter()
            .map(|direction| self.rank(cell.step(direction)))
            .max()
            .unwrap_or(0);
        if let Some((at, bit)) = TileIndex::of(cell)
            && let Some(tile) = self.ranks.get_mut(at)
            && let Some(rank) = tile.get_mut(bit.trailing_zeros() as usize)
        {
            *rank = highest.saturating_add(1);
        }
    }
}
