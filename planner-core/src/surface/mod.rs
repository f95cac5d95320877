//! What a robot knows of a surface with one height per column: a height field.
//!
//! One bit per column says whether it is known, one byte how high its ground is.
//! Knowledge only grows, and where two robots disagree about a height the higher
//! ground wins, so merging maps is commutative, associative and idempotent.
//!
//! A *frontier* is a known column with an unknown 4-neighbour inside the map
//! [Renzaglia2019 §3]. Their number is kept per tile as columns become known.

mod body;
mod nearest;
mod segment;

pub use body::{MAX_CLEARANCE, body_columns, reaches_over};
pub(crate) use nearest::distance_to_tile;
pub use segment::{Columns, Crossing, clearance, in_sight};

use crate::cell::{Cell, Direction, Extent, ExtentError};
use crate::tile::{
    MOST_TILES, TILE, TileIndex, TileSet, Tiles, bits, carried, every_tile, neighbours,
};

/// Height of the ground, in quarters of a cell: from 0 to 63.75 cells. Whole cells
/// would be too coarse: each stair of a gentle slope would hide the ground below it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Height(pub u8);

impl Height {
    /// Steps of height in one cell.
    pub const PER_CELL: u8 = 4;

    /// In cells.
    pub const fn cells(self) -> f32 {
        self.0 as f32 * (1.0 / Self::PER_CELL as f32)
    }

    /// The nearest height to `cells`; 0 and 63.75 beyond the ends.
    pub const fn from_cells(cells: f32) -> Self {
        Self((cells * Self::PER_CELL as f32 + 0.5) as u8)
    }
}

/// One column as a sensor gives it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Column {
    /// Where.
    pub cell: Cell,
    /// Height of the ground.
    pub height: Height,
}

/// Known columns of one tile: the unit in which maps travel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Patch {
    /// Which tile.
    pub tile: TileIndex,
    /// Which of its columns.
    pub cells: u64,
    /// Their heights by bit number; the other entries mean nothing.
    pub heights: [Height; 64],
    /// Whether these columns became known to the sender in this very step by its own
    /// eyes: the receiver then shares the reward for them [Renzaglia2019 eq. 1].
    pub fresh: bool,
}

/// A height map of at most 8·`TW` × 8·`TH` columns.
///
/// Takes 73 bytes a tile and 8 a row of tiles: 12.4 KB for 100×100 columns.
#[derive(Clone, Debug)]
pub struct Surface<const TW: usize, const TH: usize> {
    extent: Extent,
    known: Tiles<u64, TW, TH>,
    heights: Tiles<[Height; 64], TW, TH>,
    frontier_counts: Tiles<u8, TW, TH>,
    /// The tiles that have frontiers.
    frontier_tiles: TileSet<TH>,
    frontiers: u32,
    known_columns: u32,
}

impl<const TW: usize, const TH: usize> Surface<TW, TH> {
    /// A map of nothing; a `static` of it costs no flash.
    pub const fn vacant() -> Self {
        const {
            assert!(
                TW <= MOST_TILES && TH <= MOST_TILES,
                "a map has at most 64×64 tiles"
            )
        }
        Self {
            extent: Extent::new(0, 0),
            known: Tiles::all(0),
            heights: Tiles::all([Height(0); 64]),
            frontier_counts: Tiles::all(0),
            frontier_tiles: TileSet::new(),
            frontiers: 0,
            known_columns: 0,
        }
    }

    /// The largest map that fits.
    pub const CAPACITY: Extent = Extent::new((TW * TILE) as u16, (TH * TILE) as u16);

    /// A map of `extent` with nothing known.
    ///
    /// # Errors
    /// The extent is empty or larger than [`CAPACITY`](Self::CAPACITY).
    pub fn new(extent: Extent) -> Result<Self, ExtentError> {
        let mut surface = Self::vacant();
        surface.reset(extent)?;
        Ok(surface)
    }

    /// Forgets all, in place, and is a map of `extent` from now on.
    ///
    /// # Errors
    /// As [`new`](Self::new); the map is then unchanged.
    pub fn reset(&mut self, extent: Extent) -> Result<(), ExtentError> {
        extent.fits(Self::CAPACITY)?;
        self.extent = extent;
        self.known.fill(0);
        self.heights.fill([Height(0); 64]);
        self.frontier_counts.fill(0);
        self.frontier_tiles.clear();
        self.frontiers = 0;
        self.known_columns = 0;
        Ok(())
    }

    /// The map's size in columns.
    pub const fn extent(&self) -> Extent {
        self.extent
    }

    /// Height of the ground at `cell`, if known. Cost: one read.
    pub fn height(&self, cell: Cell) -> Option<Height> {
        let (tile, bit) = TileIndex::of(cell)?;
        if self.known(tile) & bit == 0 {
            return None;
        }
        let heights = self.heights.get(tile)?;
        heights.get(bit.trailing_zeros() as usize).copied()
    }

    /// Whether `cell` is inside the map and not known. Cost: one read.
    pub fn is_unknown(&self, cell: Cell) -> bool {
        self.extent.contains(cell) && self.height(cell).is_none()
    }

    /// Whether `cell` is a frontier. Cost: five reads.
    pub fn is_frontier(&self, cell: Cell) -> bool {
        TileIndex::of(cell).is_some_and(|(tile, bit)| self.frontier_cells(tile) & bit != 0)
    }

    /// Number of frontiers; 0 once anything is known means that everything is.
    pub const fn frontiers(&self) -> u32 {
        self.frontiers
    }

    /// Number of known columns.
    pub const fn known_columns(&self) -> u32 {
        self.known_columns
    }

    /// All tiles that the map has room for, row by row.
    pub fn tiles(&self) -> impl Iterator<Item = TileIndex> + use<TW, TH> {
        every_tile(TW, TH)
    }

    /// The tile behind `tile`, row by row and round again.
    pub const fn tile_after(&self, tile: TileIndex) -> TileIndex {
        tile.after((TW as u8, TH as u8))
    }

    /// The known columns of `tile`; none outside.
    pub fn known(&self, tile: TileIndex) -> u64 {
        self.known.word(tile)
    }

    /// The unknown columns of `tile` that lie inside the map.
    pub fn unknown(&self, tile: TileIndex) -> u64 {
        tile.inside(self.extent) & !self.known(tile)
    }

    /// Number of frontiers in `tile`. Cost: one read.
    pub fn frontiers_in(&self, tile: TileIndex) -> u8 {
        self.frontier_counts.get(tile).copied().unwrap_or(0)
    }

    /// The frontiers of `tile`. Cost: five reads.
    pub fn frontier_cells(&self, tile: TileIndex) -> u64 {
        self.known(tile) & neighbours(tile, |tile| self.unknown(tile))
    }

    /// Everything known of `tile`, as it travels.
    pub fn patch(&self, tile: TileIndex, cells: u64) -> Patch {
        Patch {
            tile,
            cells: cells & self.known(tile),
            heights: self.heights.get(tile).copied().unwrap_or([Height(0); 64]),
            fresh: false,
        }
    }

    /// Learns one column; says whether it was unknown. Columns outside are ignored.
    pub fn learn(&mut self, column: Column) -> bool {
        let Some((tile, bit)) = TileIndex::of(column.cell) else {
            return false;
        };
        if !self.extent.contains(column.cell) {
            return false;
        }
        self.raise(tile, bit.trailing_zeros(), column.height);
        self.add(tile, bit)
    }

    /// Joins `patch` into the map; gives the columns that were unknown. Columns
    /// outside are ignored.
    ///
    /// Cost: 64 columns, and if anything is new, its tile and those that it touches.
    pub fn merge(&mut self, patch: &Patch) -> u64 {
        let cells = patch.cells & patch.tile.inside(self.extent);
        let new = cells & !self.known(patch.tile);
        for bit in bits(cells) {
            if let Some(&height) = patch.heights.get(bit as usize) {
                self.raise(patch.tile, bit, height);
            }
        }
        self.add(patch.tile, new);
        new
    }

    /// The higher ground wins; an unknown column has height 0.
    fn raise(&mut self, tile: TileIndex, bit: u32, height: Height) {
        if let Some(known) = self
            .heights
            .get_mut(tile)
            .and_then(|heights| heights.get_mut(bit as usize))
        {
            *known = (*known).max(height);
        }
    }

    /// Says whether any of them is new.
    fn add(&mut self, tile: TileIndex, cells: u64) -> bool {
        let new = cells & !self.known(tile);
        if new == 0 {
            return false;
        }
        self.known.add(tile, new);
        self.known_columns += new.count_ones();
        self.recount(tile);
        for direction in Direction::ALL {
            if carried(new, direction) != 0 {
                self.recount(tile.beside(direction));
            }
        }
        true
    }

    fn recount(&mut self, tile: TileIndex) {
        let now = self.frontier_cells(tile).count_ones() as u8;
        if let Some(count) = self.frontier_counts.get_mut(tile) {
            self.frontiers = self.frontiers.saturating_sub(u32::from(*count)) + u32::from(now);
            *count = now;
            if now > 0 {
                self.frontier_tiles.insert(tile);
            } else {
                self.frontier_tiles.remove(tile);
            }
        }
    }
}

#[cfg(test)]
mod tests;
