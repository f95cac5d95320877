//! One layer of 8×8 cells in a word, and where such words stand in a map.

use crate::cell::Cell;

/// Cells along one side of a tile.
pub const SIDE: usize = 8;
const _: () = assert!(
    SIDE == 8,
    "a layer of a tile is a u64 with a byte a row, and cells are divided by shifting"
);

const WEST_EDGE: u64 = 0x0101_0101_0101_0101;
const EAST_EDGE: u64 = WEST_EDGE << 7;

/// A tile's column and row in the map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Tile {
    /// Column of tiles.
    pub x: u8,
    /// Row of tiles.
    pub y: u8,
}

impl Tile {
    /// The tile with `cell` in it; `None` beyond the north or west border.
    pub fn of(cell: Cell) -> Option<Self> {
        Some(Self {
            x: u8::try_from(cell.x >> 3).ok()?,
            y: u8::try_from(cell.y >> 3).ok()?,
        })
    }

    /// The cell of bit `bit`, 0 to 63.
    pub const fn cell(self, bit: u32) -> Cell {
        Cell::new(
            ((self.x as i16) << 3) + (bit & 7) as i16,
            ((self.y as i16) << 3) + ((bit >> 3) & 7) as i16,
        )
    }

    /// The bit of `cell` in its tile.
    pub const fn bit(cell: Cell) -> u32 {
        ((cell.y & 7) << 3 | (cell.x & 7)) as u32
    }

    /// The tile's cells that lie within a map of `width`×`height` cells.
    pub fn inside(self, width: u16, height: u16) -> u64 {
        let columns = width.saturating_sub(u16::from(self.x) * 8).min(8);
        let rows = height.saturating_sub(u16::from(self.y) * 8).min(8);
        let row = (1u64 << columns) - 1;
        let whole = row * WEST_EDGE;
        if rows == 8 {
            whole
        } else {
            whole & ((1u64 << (rows * 8)) - 1)
        }
    }
}

/// The cells that have a set 4-neighbour, given a layer's word and the words north,
/// east, south and west of it.
pub(crate) const fn neighbours_of(here: u64, [north, east, south, west]: [u64; 4]) -> u64 {
    let from_north = (here << 8) | (north >> 56);
    let from_south = (here >> 8) | (south << 56);
    let from_west = ((here << 1) & !WEST_EDGE) | ((west & EAST_EDGE) >> 7);
    let from_east = ((here >> 1) & !EAST_EDGE) | ((east & WEST_EDGE) << 7);
    from_north | from_south | from_west | from_east
}

/// The set bits of a word, ascending.
#[derive(Clone, Debug)]
pub struct Bits(pub u64);

impl Iterator for Bits {
    type Item = u32;

    fn next(&mut self) -> Option<u32> {
        if self.0 == 0 {
            return None;
        }
        let bit = self.0.trailing_zeros();
        self.0 &= self.0 - 1;
        Some(bit)
    }
}
