//! One bit a voxel.

use super::Voxel;
use crate::tile::{TileIndex, Tiles};

/// One bit for each voxel of a box.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Layer<const TW: usize, const TH: usize, const L: usize>([Tiles<u64, TW, TH>; L]);

impl<const TW: usize, const TH: usize, const L: usize> Layer<TW, TH, L> {
    pub(crate) const EMPTY: Self = Self([Tiles::all(0); L]);

    /// Clears all bits, in place.
    pub(crate) fn reset(&mut self) {
        for level in &mut self.0 {
            level.fill(0);
        }
    }

    /// The bits of a tile of a level; none outside.
    pub(crate) fn word(&self, tile: TileIndex, z: u8) -> u64 {
        self.0
            .get(usize::from(z))
            .map_or(0, |level| level.word(tile))
    }

    /// Sets `bits` of a tile of a level; outside nothing happens.
    pub(crate) fn add(&mut self, tile: TileIndex, z: u8, bits: u64) {
        if let Some(level) = self.0.get_mut(usize::from(z)) {
            level.add(tile, bits);
        }
    }

    /// Makes `bits` those of a tile of a level; outside nothing happens.
    pub(crate) fn put(&mut self, tile: TileIndex, z: u8, bits: u64) {
        if let Some(level) = self.0.get_mut(usize::from(z))
            && let Some(word) = level.get_mut(tile)
        {
            *word = bits;
        }
    }

    /// Clears the bit of `voxel`.
    pub(crate) fn clear(&mut self, voxel: Voxel) {
        if let Some((tile, z, bit)) = voxel.place()
            && let Some(level) = self.0.get_mut(usize::from(z))
            && let Some(word) = level.get_mut(tile)
        {
            *word &= !bit;
        }
    }

    pub(crate) fn get(&self, voxel: Voxel) -> bool {
        voxel
            .place()
            .is_some_and(|(tile, z, bit)| self.word(tile, z) & bit != 0)
    }

    pub(crate) fn set(&mut self, voxel: Voxel) {
        if let Some((tile, z, bit)) = voxel.place() {
            self.add(tile, z, bit);
        }
    }
}
