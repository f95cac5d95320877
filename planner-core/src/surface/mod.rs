//! What a robot knows of a surface with one height per column: a height field.
//!
//! One bit per column says whether it is known, one byte how high its ground is.
//! Knowledge only grows, and where two robots disagree about a height the higher
//! ground wins, so merging maps is commutative, associative and idempotent.
//!
//! A *frontier* is a known column with an unknown 4-neighbour inside the map
//! [Renzaglia2019 §3]. Their number is kept per tile as columns become known.

mod nearest;
mod segment;
mod tile;

pub(crate) use nearest::distance_to_tile;
pub use segment::{Columns, Crossing, clearance, in_sight};
pub use tile::{Bits, SIDE, Tile};

use core::fmt;

use crate::cell::{Cell, Extent};
use crate::map::MOST_TILES;
pub(crate) use tile::neighbours_of;

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
    pub tile: Tile,
    /// Which of its columns.
    pub cells: u64,
    /// Their heights by bit number; the other entries mean nothing.
    pub heights: [Height; 64],
    /// Whether these columns became known to the sender in this very step by its own
    /// eyes: the receiver then shares the reward for them [Renzaglia2019 eq. 1].
    pub fresh: bool,
}

/// The map does not fit into the number of tiles that its type has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TooLarge {
    /// What was asked for.
    pub extent: Extent,
    /// What there is room for.
    pub room: Extent,
}

impl fmt::Display for TooLarge {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "a map of {} cells does not fit into {}",
            self.extent, self.room
        )
    }
}

impl core::error::Error for TooLarge {}

/// A height map of at most 8·`TW` × 8·`TH` columns.
///
/// Takes 73 bytes a tile and 8 a row of tiles: 12.4 KB for 100×100 columns.
#[derive(Clone, Debug)]
pub struct Surface<const TW: usize, const TH: usize> {
    extent: Extent,
    known: [[u64; TW]; TH],
    heights: [[[Height; 64]; TW]; TH],
    tile_frontiers: [[u8; TW]; TH],
    /// Bit x of row y: tile (x, y) has frontiers.
    frontier_rows: [u64; TH],
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
            known: [[0; TW]; TH],
            heights: [[[Height(0); 64]; TW]; TH],
            tile_frontiers: [[0; TW]; TH],
            frontier_rows: [0; TH],
            frontiers: 0,
            known_columns: 0,
        }
    }

    /// A map of `extent` with nothing known.
    pub const fn new(extent: Extent) -> Result<Self, TooLarge> {
        let mut surface = Self::vacant();
        match surface.fit(extent) {
            Ok(()) => Ok(surface),
            Err(error) => Err(error),
        }
    }

    /// Forgets all, in place, and is a map of `extent` from now on; unchanged if
    /// that is too large.
    pub fn reset(&mut self, extent: Extent) -> Result<(), TooLarge> {
        self.fit(extent)?;
        self.known = [[0; TW]; TH];
        self.heights = [[[Height(0); 64]; TW]; TH];
        self.tile_frontiers = [[0; TW]; TH];
        self.frontier_rows = [0; TH];
        self.frontiers = 0;
        self.known_columns = 0;
        Ok(())
    }

    const fn fit(&mut self, extent: Extent) -> Result<(), TooLarge> {
        let room = Extent::new(TW as u16 * 8, TH as u16 * 8);
        if extent.width > room.width || extent.height > room.height {
            return Err(TooLarge { extent, room });
        }
        self.extent = extent;
        Ok(())
    }

    /// The map's size in columns.
    pub const fn extent(&self) -> Extent {
        self.extent
    }

    /// Height of the ground at `cell`, if known. Cost: one read.
    pub fn height(&self, cell: Cell) -> Option<Height> {
        let tile = Tile::of(cell)?;
        let bit = Tile::bit(cell);
        if self.known(tile) >> bit & 1 == 0 {
            return None;
        }
        self.heights_of(tile)?.get(bit as usize).copied()
    }

    /// Whether `cell` is inside the map and not known. Cost: one read.
    pub fn is_unknown(&self, cell: Cell) -> bool {
        self.extent.contains(cell) && self.height(cell).is_none()
    }

    /// Whether `cell` is a frontier. Cost: five reads.
    pub fn is_frontier(&self, cell: Cell) -> bool {
        Tile::of(cell).is_some_and(|tile| self.frontier_cells(tile) >> Tile::bit(cell) & 1 == 1)
    }

    /// Number of frontiers; 0 once anything is known means that everything is.
    pub const fn frontiers(&self) -> u32 {
        self.frontiers
    }

    /// Number of known columns.
    pub const fn known_columns(&self) -> u32 {
        self.known_columns
    }

    /// All tiles, row by row.
    pub fn tiles(&self) -> impl Iterator<Item = Tile> + use<TW, TH> {
        (0..TH as u8).flat_map(|y| (0..TW as u8).map(move |x| Tile { x, y }))
    }

    /// The tile behind `tile`, row by row and round again.
    pub const fn tile_after(&self, tile: Tile) -> Tile {
        if (tile.x as usize) + 1 < TW {
            Tile {
                x: tile.x + 1,
                y: tile.y,
            }
        } else if (tile.y as usize) + 1 < TH {
            Tile {
                x: 0,
                y: tile.y + 1,
            }
        } else {
            Tile { x: 0, y: 0 }
        }
    }

    /// The known columns of `tile`; none outside.
    pub fn known(&self, tile: Tile) -> u64 {
        self.known
            .get(usize::from(tile.y))
            .and_then(|row| row.get(usize::from(tile.x)))
            .copied()
            .unwrap_or(0)
    }

    /// The unknown columns of `tile` that lie inside the map.
    pub fn unknown(&self, tile: Tile) -> u64 {
        tile.inside(self.extent.width, self.extent.height) & !self.known(tile)
    }

    /// Number of frontiers in `tile`. Cost: one read.
    pub fn frontiers_in(&self, tile: Tile) -> u8 {
        self.tile_frontiers
            .get(usize::from(tile.y))
            .and_then(|row| row.get(usize::from(tile.x)))
            .copied()
            .unwrap_or(0)
    }

    /// The frontiers of `tile`. Cost: five reads.
    pub fn frontier_cells(&self, tile: Tile) -> u64 {
        let at = |x: Option<u8>, y: Option<u8>| match (x, y) {
            (Some(x), Some(y)) => self.unknown(Tile { x, y }),
            _ => 0,
        };
        let around = [
            at(Some(tile.x), tile.y.checked_sub(1)),
            at(tile.x.checked_add(1), Some(tile.y)),
            at(Some(tile.x), tile.y.checked_add(1)),
            at(tile.x.checked_sub(1), Some(tile.y)),
        ];
        self.known(tile) & neighbours_of(self.unknown(tile), around)
    }

    /// Everything known of `tile`, as it travels.
    pub fn patch(&self, tile: Tile, cells: u64) -> Patch {
        Patch {
            tile,
            cells: cells & self.known(tile),
            heights: self.heights_of(tile).copied().unwrap_or([Height(0); 64]),
            fresh: false,
        }
    }

    /// Learns one column; says whether it was unknown. Columns outside are ignored.
    pub fn learn(&mut self, column: Column) -> bool {
        let Some(tile) = Tile::of(column.cell).filter(|_| self.extent.contains(column.cell)) else {
            return false;
        };
        let bit = Tile::bit(column.cell);
        let before = self.known(tile);
        self.raise(tile, bit, column.height);
        self.add(tile, 1 << bit);
        before >> bit & 1 == 0
    }

    /// Joins `patch` into the map; gives the columns that were unknown. Columns
    /// outside are ignored.
    ///
    /// Cost: 64 columns, and five tiles if anything is new.
    pub fn merge(&mut self, patch: &Patch) -> u64 {
        let cells = patch.cells & patch.tile.inside(self.extent.width, self.extent.height);
        let new = cells & !self.known(patch.tile);
        for bit in Bits(cells) {
            if let Some(&height) = patch.heights.get(bit as usize) {
                self.raise(patch.tile, bit, height);
            }
        }
        self.add(patch.tile, new);
        new
    }

    fn heights_of(&self, tile: Tile) -> Option<&[Height; 64]> {
        self.heights
            .get(usize::from(tile.y))?
            .get(usize::from(tile.x))
    }

    /// The higher ground wins; an unknown column has height 0.
    fn raise(&mut self, tile: Tile, bit: u32, height: Height) {
        if let Some(known) = self
            .heights
            .get_mut(usize::from(tile.y))
            .and_then(|row| row.get_mut(usize::from(tile.x)))
            .and_then(|heights| heights.get_mut(bit as usize))
        {
            *known = (*known).max(height);
        }
    }

    fn add(&mut self, tile: Tile, cells: u64) {
        let Some(known) = self
            .known
            .get_mut(usize::from(tile.y))
            .and_then(|row| row.get_mut(usize::from(tile.x)))
        else {
            return;
        };
        let new = cells & !*known;
        if new == 0 {
            return;
        }
        *known |= new;
        self.known_columns += new.count_ones();
        self.recount(tile);
        for (dx, dy) in [(0, -1), (1, 0), (0, 1), (-1, 0)] {
            if let (Some(x), Some(y)) =
                (tile.x.checked_add_signed(dx), tile.y.checked_add_signed(dy))
            {
                self.recount(Tile { x, y });
            }
        }
    }

    fn recount(&mut self, tile: Tile) {
        let now = self.frontier_cells(tile).count_ones() as u8;
        if let Some(count) = self
            .tile_frontiers
            .get_mut(usize::from(tile.y))
            .and_then(|row| row.get_mut(usize::from(tile.x)))
        {
            self.frontiers = self.frontiers.saturating_sub(u32::from(*count)) + u32::from(now);
            *count = now;
        }
        if let Some(row) = self.frontier_rows.get_mut(usize::from(tile.y)) {
            let bit = 1u64.checked_shl(u32::from(tile.x)).unwrap_or(0);
            *row = if now > 0 { *row | bit } else { *row & !bit };
        }
    }
}

#[cfg(test)]
mod tests;
