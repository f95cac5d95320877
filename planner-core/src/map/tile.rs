//! One 8×8 tile of the grid, a bit a cell, and sets of tiles.
//!
//! Bit `8·(y mod 8) + (x mod 8)` of a layer is the cell `(x, y)`.

use crate::cell::{Cell, Direction};

/// Side of a tile in cells.
pub const TILE: usize = 8;
const _: () = assert!(
    TILE == 8,
    "a layer of a tile is a u64 with a byte a row, and cells are divided by shifting"
);

/// Columns and rows of tiles that a map has at most: a set of them is a bit each.
pub(crate) const MOST_TILES: usize = u64::BITS as usize;

/// The western column of a tile.
pub(super) const WEST_COLUMN: u64 = 0x0101_0101_0101_0101;
/// The eastern column of a tile.
const EAST_COLUMN: u64 = WEST_COLUMN << 7;

/// What is known of 8×8 cells. A cell is unknown, free, visited or an obstacle, in
/// this order, and of two opinions the later in the order wins: merging is a
/// maximum, hence commutative, associative, idempotent, and it only ever adds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Tile {
    /// Cells seen by anybody.
    pub known: u64,
    /// Cells seen blocked by anybody.
    pub obstacle: u64,
    /// Cells that anybody has stood on and nobody has seen blocked.
    pub visited: u64,
}

impl Tile {
    /// Beyond the edge of the map: obstacles.
    pub const OUTSIDE: Self = Self {
        known: u64::MAX,
        obstacle: u64::MAX,
        visited: 0,
    };

    /// Nothing known yet.
    pub const UNKNOWN: Self = Self {
        known: 0,
        obstacle: 0,
        visited: 0,
    };

    /// Cells known and not blocked.
    pub const fn free(self) -> u64 {
        self.known & !self.obstacle
    }

    /// The later opinion of the two for every cell. What is visited or an
    /// obstacle counts as known, and an obstacle not as visited.
    #[must_use]
    pub const fn joined(self, other: Self) -> Self {
        let obstacle = self.obstacle | other.obstacle;
        let visited = (self.visited | other.visited) & !obstacle;
        Self {
            known: self.known | other.known | visited | obstacle,
            obstacle,
            visited,
        }
    }
}

/// Where a tile is: column and row in tiles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TileIndex {
    /// Column, in tiles.
    pub x: u8,
    /// Row, in tiles.
    pub y: u8,
}

impl TileIndex {
    /// The tile at column `x`, row `y`.
    pub const fn new(x: u8, y: u8) -> Self {
        Self { x, y }
    }

    /// The tile that holds `cell`, and the cell's bit in it. `None` for negative
    /// coordinates and those beyond the largest map.
    pub fn of(cell: Cell) -> Option<(Self, u64)> {
        let x = u8::try_from(cell.x >> 3).ok()?;
        let y = u8::try_from(cell.y >> 3).ok()?;
        Some((Self { x, y }, bit_of(cell)))
    }

    /// The neighbouring tile. Beyond an edge it is one that no map has.
    pub(crate) const fn beside(self, direction: Direction) -> Self {
        let Self { x, y } = self;
        match direction {
            Direction::East => Self::new(x.saturating_add(1), y),
            Direction::South => Self::new(x, y.saturating_add(1)),
            Direction::West => Self::new(x.wrapping_sub(1), y),
            Direction::North => Self::new(x, y.wrapping_sub(1)),
        }
    }

    /// The neighbouring tile, `None` past the western and northern edge.
    pub fn neighbour(self, direction: Direction) -> Option<Self> {
        let (dx, dy) = direction.delta();
        Some(Self {
            x: self.x.checked_add_signed(dx as i8)?,
            y: self.y.checked_add_signed(dy as i8)?,
        })
    }

    /// The cell of bit number `bit` (0 to 63) of this tile.
    pub const fn cell(self, bit: u32) -> Cell {
        Cell::new(
            self.x as i16 * TILE as i16 + (bit & 7) as i16,
            self.y as i16 * TILE as i16 + ((bit >> 3) & 7) as i16,
        )
    }
}

/// The bit of `cell` in its tile.
pub const fn bit_of(cell: Cell) -> u64 {
    1 << (((cell.y & 7) << 3) | (cell.x & 7))
}

/// The cells of `layer` moved one step, those that stay in the tile.
pub const fn shifted(layer: u64, direction: Direction) -> u64 {
    match direction {
        Direction::East => (layer & !EAST_COLUMN) << 1,
        Direction::South => layer << 8,
        Direction::West => (layer & !WEST_COLUMN) >> 1,
        Direction::North => layer >> 8,
    }
}

/// The cells of `layer` moved one step, those that enter the neighbouring tile,
/// as bits of that tile.
pub const fn carried(layer: u64, direction: Direction) -> u64 {
    match direction {
        Direction::East => (layer & EAST_COLUMN) >> 7,
        Direction::South => layer >> 56,
        Direction::West => (layer & WEST_COLUMN) << 7,
        Direction::North => layer << 56,
    }
}

/// A set of tiles of a map with at most 64 rows and columns. Inserting, removing
/// and finding the first tile touch one word of rows each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TileSet<const TH: usize> {
    rows: [u64; TH],
    /// The rows that hold a tile.
    occupied: u64,
}

impl<const TH: usize> Default for TileSet<TH> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const TH: usize> TileSet<TH> {
    /// No tile.
    pub const fn new() -> Self {
        const { assert!(TH <= MOST_TILES, "a map has 1 to 64 rows of tiles") }
        Self {
            rows: [0; TH],
            occupied: 0,
        }
    }

    /// Every tile that a map of this many rows can have.
    pub const fn full() -> Self {
        Self {
            rows: [u64::MAX; TH],
            occupied: u64::MAX >> (64 - TH),
        }
    }

    /// Removes every tile. Work: the rows that hold one.
    pub fn clear(&mut self) {
        for y in bits(self.occupied) {
            if let Some(row) = self.rows.get_mut(y as usize) {
                *row = 0;
            }
        }
        self.occupied = 0;
    }

    /// Adds a tile; one outside of the map is ignored.
    pub fn insert(&mut self, tile: TileIndex) {
        if let Some(row) = self.rows.get_mut(usize::from(tile.y)) {
            *row |= 1 << (tile.x & 63);
            self.occupied |= 1 << (tile.y & 63);
        }
    }

    /// Takes a tile out.
    pub fn remove(&mut self, tile: TileIndex) {
        if let Some(row) = self.rows.get_mut(usize::from(tile.y)) {
            *row &= !(1 << (tile.x & 63));
            if *row == 0 {
                self.occupied &= !(1 << (tile.y & 63));
            }
        }
    }

    /// Takes out the first tile in the order of [`iter`](Self::iter).
    pub fn pop_first(&mut self) -> Option<TileIndex> {
        let y = self.occupied.trailing_zeros();
        let row = self.rows.get_mut(y as usize)?;
        let x = row.trailing_zeros() as u8;
        *row &= row.wrapping_sub(1);
        if *row == 0 {
            self.occupied &= self.occupied.wrapping_sub(1);
        }
        Some(TileIndex { x, y: y as u8 })
    }

    /// Takes out the first tile behind `tile` in the order of
    /// [`iter`](Self::iter); where there is none, the first of all.
    pub fn pop_after(&mut self, tile: TileIndex) -> Option<TileIndex> {
        let beyond = |bit: u8| (u64::MAX << (bit & 63)) & !(1 << (bit & 63));
        let rest_of_row = self.row(tile.y) & beyond(tile.x);
        let next = if rest_of_row != 0 {
            TileIndex {
                x: rest_of_row.trailing_zeros() as u8,
                y: tile.y,
            }
        } else {
            let y = (self.occupied & beyond(tile.y)).trailing_zeros() as u8;
            match self.row(y) {
                0 => return self.pop_first(),
                row => TileIndex {
                    x: row.trailing_zeros() as u8,
                    y,
                },
            }
        };
        self.remove(next);
        Some(next)
    }

    /// Whether the tile is in the set.
    pub fn contains(&self, tile: TileIndex) -> bool {
        self.row(tile.y) >> (tile.x & 63) & 1 == 1
    }

    /// The tiles of row `y`, a bit a column.
    pub fn row(&self, y: u8) -> u64 {
        self.rows.get(usize::from(y)).copied().unwrap_or(0)
    }

    /// Whether no tile is in the set.
    pub const fn is_empty(&self) -> bool {
        self.occupied == 0
    }

    /// Adds the tiles of another set.
    pub fn extend(&mut self, other: &Self) {
        for y in bits(other.occupied) {
            if let (Some(row), Some(more)) =
                (self.rows.get_mut(y as usize), other.rows.get(y as usize))
            {
                *row |= more;
            }
        }
        self.occupied |= other.occupied;
    }

    /// The tiles, row by row from the north, each row from the west.
    pub fn iter(&self) -> impl Iterator<Item = TileIndex> + '_ {
        bits(self.occupied).flat_map(|y| {
            bits(self.row(y as u8)).map(move |x| TileIndex {
                x: x as u8,
                y: y as u8,
            })
        })
    }
}

/// The numbers of the set bits, lowest first. At most 64 steps.
pub fn bits(mut word: u64) -> impl Iterator<Item = u32> {
    core::iter::from_fn(move || {
        let bit = word.trailing_zeros();
        word &= word.wrapping_sub(1);
        (bit < 64).then_some(bit)
    })
}
