//! The trace of the robot's own way.

use crate::cell::{Cell, Direction};
use crate::map::TileIndex;

/// Grid 𝒢 [Gauville2019 §3.2]: 0 where the robot has not set out from, else a
/// rank that grows along its way. 128 bytes a tile.
#[derive(Clone, PartialEq, Eq)]
pub(super) struct Trace<const TW: usize, const TH: usize> {
    ranks: [[[u16; 64]; TW]; TH],
}

impl<const TW: usize, const TH: usize> Trace<TW, TH> {
    pub(super) const fn new() -> Self {
        Self {
            ranks: [[[0; 64]; TW]; TH],
        }
    }

    /// Back to zero, in place.
    pub(super) fn clear(&mut self) {
        for tile in self.ranks.iter_mut().flatten() {
            tile.fill(0);
        }
    }

    /// The rank of a cell; 0 outside.
    pub(super) fn rank(&self, cell: Cell) -> u16 {
        TileIndex::of(cell)
            .and_then(|(at, bit)| {
                let tile = self.ranks.get(usize::from(at.y))?.get(usize::from(at.x))?;
                tile.get(bit.trailing_zeros() as usize)
            })
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
            && let Some(row) = self.ranks.get_mut(usize::from(at.y))
            && let Some(tile) = row.get_mut(usize::from(at.x))
            && let Some(rank) = tile.get_mut(bit.trailing_zeros() as usize)
        {
            *rank = highest.saturating_add(1);
        }
    }
}
