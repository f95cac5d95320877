//! One bit a voxel.

use super::Voxel;
use crate::surface::Tile;

/// One bit for each voxel of a box.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Layer<const TW: usize, const TH: usize, const L: usize>([[[u64; TW]; TH]; L]);

impl<const TW: usize, const TH: usize, const L: usize> Layer<TW, TH, L> {
    pub(crate) const EMPTY: Self = Self([[[0; TW]; TH]; L]);

    /// Clears all bits, in place.
    pub(crate) fn reset(&mut self) {
        self.0 = [[[0; TW]; TH]; L];
    }

    /// The bits of a tile of a level; none outside.
    pub(crate) fn word(&self, tile: Tile, z: u8) -> u64 {
        self.0
            .get(usize::from(z))
            .and_then(|level| level.get(usize::from(tile.y)))
            .and_then(|row| row.get(usize::from(tile.x)))
            .copied()
            .unwrap_or(0)
    }

    /// Sets `bits` of a tile of a level; outside nothing happens.
    pub(crate) fn add(&mut self, tile: Tile, z: u8, bits: u64) {
        if let Some(word) = self
            .0
            .get_mut(usize::from(z))
            .and_then(|level| level.get_mut(usize::from(tile.y)))
            .and_then(|row| row.get_mut(usize::from(tile.x)))
        {
            *word |= bits;
        }
    }

    /// Clears the bit of `voxel`.
    pub(crate) fn clear(&mut self, voxel: Voxel) {
        if let (Some(tile), Ok(z)) = (Tile::of(voxel.cell()), u8::try_from(voxel.z))
            && let Some(word) = self
                .0
                .get_mut(usize::from(z))
                .and_then(|level| level.get_mut(usize::from(tile.y)))
                .and_then(|row| row.get_mut(usize::from(tile.x)))
        {
            *word &= !(1 << Tile::bit(voxel.cell()));
        }
    }

    pub(crate) fn get(&self, voxel: Voxel) -> bool {
        let Some(tile) = Tile::of(voxel.cell()) else {
            return false;
        };
        u8::try_from(voxel.z).is_ok_and(|z| self.word(tile, z) >> Tile::bit(voxel.cell()) & 1 == 1)
    }

    pub(crate) fn set(&mut self, voxel: Voxel) {
        if let (Some(tile), Ok(z)) = (Tile::of(voxel.cell()), u8::try_from(voxel.z)) {
            self.add(tile, z, 1 << Tile::bit(voxel.cell()));
        }
    }
}
