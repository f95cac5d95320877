//! What a robot knows of a box of voxels: several surfaces in one column, as under
//! bridges and in rooms.
//!
//! Two bits a voxel, on 8×8 tiles of each level: known, occupied. Of the four levels
//! unknown, free, occupied and *free again* the higher wins, so knowledge only grows, and merging
//! is commutative, associative and idempotent. Free again is what was taken for occupied and is
//! not, for good: occupied without known. Outside of the box everything counts as known; nothing
//! is there, and nothing flies there.

mod body;
mod field;
mod layer;
mod look;
mod metres;
mod sight;
mod view;
mod zones;

pub use body::{MAX_CLEARANCE, body_voxels};
pub(crate) use body::{voxel_work, word_work};
pub use field::{Field, Heading};
pub(crate) use layer::Layer;
pub use look::{Ray, Vector, VoxelLook};
pub use metres::VoxelPose;
pub use sight::in_sight;
pub(crate) use view::{MAX_REACH, Row, View};
pub use zones::ZoneRays;

use core::fmt;

use crate::cell::{Cell, Extent, ExtentError};
use crate::tile::{MOST_TILES, TILE, TileIndex, every_tile, neighbours};

/// One cube of a box. The unit is the cube's side.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Voxel {
    /// East.
    pub x: i16,
    /// South.
    pub y: i16,
    /// Up; 0 is the lowest level.
    pub z: i16,
}

impl Voxel {
    /// The voxel at column `x`, row `y`, level `z`.
    pub const fn new(x: i16, y: i16, z: i16) -> Self {
        Self { x, y, z }
    }

    /// The six voxels that share a face with this one.
    pub const fn beside(self) -> [Self; 6] {
        let Self { x, y, z } = self;
        [
            Self::new(x.saturating_add(1), y, z),
            Self::new(x, y.saturating_add(1), z),
            Self::new(x.saturating_sub(1), y, z),
            Self::new(x, y.saturating_sub(1), z),
            Self::new(x, y, z.saturating_add(1)),
            Self::new(x, y, z.saturating_sub(1)),
        ]
    }

    /// Squared Euclidean distance.
    pub const fn distance_squared(self, other: Self) -> u32 {
        let dx = self.x.abs_diff(other.x) as u32;
        let dy = self.y.abs_diff(other.y) as u32;
        let dz = self.z.abs_diff(other.z) as u32;
        dx.saturating_mul(dx)
            .saturating_add(dy.saturating_mul(dy))
            .saturating_add(dz.saturating_mul(dz))
    }

    /// The tile of which level it lies in, and its bit there; `None` where no box is.
    pub(crate) fn place(self) -> Option<(TileIndex, u8, u64)> {
        let (tile, bit) = TileIndex::of(self.cell())?;
        Some((tile, u8::try_from(self.z).ok()?, bit))
    }

    /// The voxel of bit number `bit` (0 to 63) of a tile of a level.
    pub(crate) const fn of(tile: TileIndex, z: u8, bit: u32) -> Self {
        let Cell { x, y } = tile.cell(bit);
        Self::new(x, y, z as i16)
    }

    /// Its column.
    pub const fn cell(self) -> Cell {
        Cell::new(self.x, self.y)
    }
}

impl fmt::Display for Voxel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{},{},{}", self.x, self.y, self.z)
    }
}

/// What is known of a voxel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Content {
    /// Nothing.
    Unknown,
    /// Nothing is there.
    Free,
    /// Something is there.
    Occupied,
}

/// A tile of one level: the unit in which maps travel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VoxelPatch {
    /// Which tile.
    pub tile: TileIndex,
    /// Of which level.
    pub z: u8,
    /// Its voxels that are free or occupied.
    pub known: u64,
    /// Those of them that are occupied; and others, that are free again.
    pub occupied: u64,
}

impl VoxelPatch {
    /// Its voxels that are free again.
    pub const fn withdrawn(&self) -> u64 {
        self.occupied & !self.known
    }

    /// Whether it says nothing.
    pub const fn is_empty(&self) -> bool {
        self.known | self.occupied == 0
    }
}

/// A map of at most 8·`TW` × 8·`TH` × `L` voxels: 16 bytes for each tile of a level,
/// 6.4 KB for 40×40×16 voxels.
#[derive(Clone, Debug)]
pub struct Volume<const TW: usize, const TH: usize, const L: usize> {
    extent: Extent,
    levels: u8,
    known: Layer<TW, TH, L>,
    occupied: Layer<TW, TH, L>,
    known_voxels: u32,
    /// Number of voxels that are free again.
    withdrawn: u32,
}

impl<const TW: usize, const TH: usize, const L: usize> Volume<TW, TH, L> {
    /// A box of nothing; a `static` of it costs no flash.
    pub const fn vacant() -> Self {
        const {
            assert!(
                TW <= MOST_TILES && TH <= MOST_TILES && L <= u8::MAX as usize,
                "at most 64×64 tiles, 255 levels"
            )
        }
        Self {
            extent: Extent::new(0, 0),
            levels: 0,
            known: Layer::EMPTY,
            occupied: Layer::EMPTY,
            known_voxels: 0,
            withdrawn: 0,
        }
    }

    /// A box of `extent` columns and `levels` levels with nothing known.
    ///
    /// # Errors
    /// The box is empty or larger than the map.
    pub fn new(extent: Extent, levels: u8) -> Result<Self, ExtentError> {
        let mut volume = Self::vacant();
        volume.reset(extent, levels)?;
        Ok(volume)
    }

    /// Forgets all, in place, and is a box of this size from now on.
    ///
    /// # Errors
    /// As [`new`](Self::new); the map is then unchanged.
    pub fn reset(&mut self, extent: Extent, levels: u8) -> Result<(), ExtentError> {
        extent.fits(Extent::new((TW * TILE) as u16, (TH * TILE) as u16))?;
        if levels == 0 {
            return Err(ExtentError::Empty);
        }
        if usize::from(levels) > L {
            return Err(ExtentError::TooHigh {
                asked: levels,
                capacity: L as u8,
            });
        }
        self.extent = extent;
        self.levels = levels;
        self.known.reset();
        self.occupied.reset();
        self.known_voxels = 0;
        self.withdrawn = 0;
        Ok(())
    }

    /// Size on the ground plan.
    pub const fn extent(&self) -> Extent {
        self.extent
    }

    /// Number of levels.
    pub const fn levels(&self) -> u8 {
        self.levels
    }

    /// Number of known voxels.
    pub const fn known_voxels(&self) -> u32 {
        self.known_voxels
    }

    /// Number of voxels that are free again.
    pub const fn withdrawn(&self) -> u32 {
        self.withdrawn
    }

    /// A number that grows whenever a voxel becomes known or free again.
    pub(crate) const fn age(&self) -> u32 {
        self.known_voxels.saturating_add(self.withdrawn)
    }

    /// Number of frontiers: free voxels beside an unknown one. Cost: 14 words for each tile
    /// of a level.
    pub fn frontiers(&self) -> u32 {
        let (columns, rows) = self.extent.tiles();
        let levels = 0..self.levels;
        let tiles =
            levels.flat_map(|z| every_tile(columns.into(), rows.into()).map(move |tile| (tile, z)));
        tiles
            .map(|(tile, z)| self.frontier_voxels(tile, z).count_ones())
            .fold(0, u32::saturating_add)
    }

    /// Whether `voxel` lies in the box.
    pub const fn contains(&self, voxel: Voxel) -> bool {
        voxel.z >= 0 && voxel.z < self.levels as i16 && self.extent.contains(voxel.cell())
    }

    /// What is known of `voxel`; outside of the box it is free. Cost: two reads.
    pub fn content(&self, voxel: Voxel) -> Content {
        if !self.contains(voxel) {
            return Content::Free;
        }
        match (self.known.get(voxel), self.occupied.get(voxel)) {
            (false, false) => Content::Unknown,
            (true, true) => Content::Occupied,
            _ => Content::Free,
        }
    }

    /// Whether `voxel` is free again.
    pub fn is_withdrawn(&self, voxel: Voxel) -> bool {
        self.occupied.get(voxel) && !self.known.get(voxel)
    }

    /// Learns one voxel; says whether that was news. Voxels outside are ignored.
    pub fn learn(&mut self, voxel: Voxel, occupied: bool) -> bool {
        let Some((tile, z, bit)) = voxel.place().filter(|_| self.contains(voxel)) else {
            return false;
        };
        let is_known = self.known.word(tile, z) & bit != 0;
        let is_marked = self.occupied.word(tile, z) & bit != 0;
        if is_marked || is_known && !occupied {
            return false;
        }
        if !is_known {
            self.known.add(tile, z, bit);
            self.known_voxels = self.known_voxels.saturating_add(1);
        }
        if occupied {
            self.occupied.add(tile, z, bit);
        }
        true
    }

    /// Everything known of a tile of a level, as it travels.
    pub fn patch(&self, tile: TileIndex, z: u8) -> VoxelPatch {
        VoxelPatch {
            tile,
            z,
            known: self.known.word(tile, z),
            occupied: self.occupied.word(tile, z),
        }
    }

    /// What was taken for occupied is free again; says whether that was news. Voxels outside
    /// are ignored.
    pub fn withdraw(&mut self, voxel: Voxel) -> bool {
        let Some((tile, z, bit)) = voxel.place() else {
            return false;
        };
        self.merge(&VoxelPatch {
            tile,
            z,
            known: 0,
            occupied: bit,
        })
    }

    /// Joins `patch` into the map; says whether anything was new. Voxels outside are
    /// ignored. Cost: one tile of a level.
    pub fn merge(&mut self, patch: &VoxelPatch) -> bool {
        let VoxelPatch { tile, z, .. } = *patch;
        let inside = self.inside(tile, z);
        let (known, occupied) = (self.known.word(tile, z), self.occupied.word(tile, z));
        // Levels as numbers of two bits: `occupied`, and whether the two differ.
        let (ours, theirs) = (known ^ occupied, patch.known ^ patch.occupied);
        let higher = occupied | patch.occupied & inside;
        let lower = ours & (occupied | !patch.occupied) | theirs & (patch.occupied | !occupied);
        let now = [(lower ^ higher) & inside, higher];
        if now == [known, occupied] {
            return false;
        }
        let [now_known, now_occupied] = now;
        self.known.put(tile, z, now_known);
        self.occupied.put(tile, z, now_occupied);
        let new = (now_known | now_occupied) & !(known | occupied);
        let withdrawn = now_occupied & !now_known & !(occupied & !known);
        self.known_voxels = self.known_voxels.saturating_add(new.count_ones());
        self.withdrawn = self.withdrawn.saturating_add(withdrawn.count_ones());
        true
    }

    /// The voxel that the robot is in is free, whatever the map says of it: its own place
    /// is surer than any look.
    pub fn stand(&mut self, voxel: Voxel) {
        if self.content(voxel) == Content::Occupied {
            self.occupied.clear(voxel);
        }
    }

    /// The frontiers of a tile of a level. Cost: 14 words.
    fn frontier_voxels(&self, tile: TileIndex, z: u8) -> u64 {
        self.free(tile, z) & beside(tile, z, |tile, z| self.unknown(tile, z))
    }

    /// The unknown voxels of a tile of a level that are beside a free one. Cost: 14 words.
    pub(crate) fn unknown_beside_free(&self, tile: TileIndex, z: u8) -> u64 {
        let unknown = self.unknown(tile, z);
        if unknown == 0 {
            return 0;
        }
        // In line, for this is the innermost loop.
        let free = |tile, z| self.known.word(tile, z) ^ self.occupied.word(tile, z);
        unknown & beside(tile, z, free)
    }

    /// The free voxels of a tile of a level.
    pub(crate) fn free(&self, tile: TileIndex, z: u8) -> u64 {
        self.known.word(tile, z) ^ self.occupied.word(tile, z)
    }

    /// The voxels of a tile of a level that are not free.
    pub(crate) fn bad(&self, tile: TileIndex, z: u8) -> u64 {
        match self.free(tile, z) {
            u64::MAX => 0,
            free => self.inside(tile, z) & !free,
        }
    }

    /// The occupied voxels of a tile of a level.
    pub(crate) fn occupied(&self, tile: TileIndex, z: u8) -> u64 {
        match self.occupied.word(tile, z) {
            marked if self.withdrawn > 0 => marked & self.known.word(tile, z),
            occupied => occupied,
        }
    }

    /// The unknown voxels of a tile of a level.
    pub(crate) fn unknown(&self, tile: TileIndex, z: u8) -> u64 {
        let mut known = self.known.word(tile, z);
        if self.withdrawn > 0 {
            known |= self.occupied.word(tile, z);
        }
        match known {
            u64::MAX => 0,
            _ => self.inside(tile, z) & !known,
        }
    }

    /// The voxels of a tile of a level that lie in the box.
    #[inline(always)] // in the innermost loop
    pub(crate) fn inside(&self, tile: TileIndex, z: u8) -> u64 {
        let is_whole = |tile: u8, cells: u16| u16::from(tile) < cells / TILE as u16;
        if z >= self.levels {
            0
        } else if is_whole(tile.x, self.extent.width) && is_whole(tile.y, self.extent.height) {
            u64::MAX
        } else {
            tile.inside(self.extent)
        }
    }

    /// The tile and level behind these, and round again.
    pub fn after(&self, tile: TileIndex, z: u8) -> (TileIndex, u8) {
        match (tile.after(self.extent.tiles()), z.saturating_add(1)) {
            (first @ TileIndex { x: 0, y: 0 }, z) if z < self.levels => (first, z),
            (first @ TileIndex { x: 0, y: 0 }, _) => (first, 0),
            (next, _) => (next, z),
        }
    }
}

/// The voxels of a tile of a level that share a face with one of a layer. Asks for the
/// layer of seven tiles, also of some that no box has.
pub(crate) fn beside(tile: TileIndex, z: u8, layer: impl Fn(TileIndex, u8) -> u64) -> u64 {
    // There are at most 255 levels: below the lowest comes one that no box has.
    neighbours(tile, |tile| layer(tile, z))
        | layer(tile, z.wrapping_add(1))
        | layer(tile, z.wrapping_sub(1))
}

#[cfg(test)]
mod tests;
