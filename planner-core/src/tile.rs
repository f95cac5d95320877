//! What maps of all kinds are made of: tiles of 8×8 cells, a word a layer.
//!
//! Bit `8·(y mod 8) + (x mod 8)` of a layer is the cell `(x, y)`.

use crate::cell::{Cell, Direction, Extent};

/// Side of a tile in cells.
pub const TILE: usize = 8;
const _: () = assert!(
    TILE == 8,
    "a layer of a tile is a u64 with a byte a row, and cells are divided by shifting"
);

/// Columns and rows of tiles that a map has at most: a set of them is a bit each.
pub(crate) const MOST_TILES: usize = u64::BITS as usize;

/// The western column of a tile.
const WEST_COLUMN: u64 = 0x0101_0101_0101_0101;
/// The eastern column of a tile.
const EAST_COLUMN: u64 = WEST_COLUMN << 7;

/// Where a tile is: column and row in tiles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
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

    /// The tile behind this one in a map of so many columns and rows of tiles, row by
    /// row and round again.
    pub(crate) const fn after(self, (columns, rows): (u8, u8)) -> Self {
        if self.x.saturating_add(1) < columns {
            Self::new(self.x + 1, self.y)
        } else if self.y.saturating_add(1) < rows {
            Self::new(0, self.y + 1)
        } else {
            Self::new(0, 0)
        }
    }

    /// Its cells that lie within the extent.
    pub(crate) const fn inside(self, extent: Extent) -> u64 {
        let columns = (extent.width as usize).saturating_sub(self.x as usize * TILE);
        let rows = (extent.height as usize).saturating_sub(self.y as usize * TILE);
        if columns >= TILE && rows >= TILE {
            return u64::MAX;
        }
        let row: u64 = if columns >= TILE {
            0xff
        } else {
            (1 << columns) - 1
        };
        let all_rows = row * WEST_COLUMN;
        if rows >= TILE {
            all_rows
        } else {
            all_rows & ((1 << (rows * TILE)) - 1)
        }
    }

    /// The cells at most so many cells from `centre` each way.
    pub(crate) fn near(self, centre: Cell, range: u8) -> u64 {
        let side = |from: u8, centre: i16| {
            let from = i32::from(centre) - i32::from(range) - 8 * i32::from(from);
            let to = from + 2 * i32::from(range);
            let above = |bit: i32| 0xffu32.checked_shl(bit.clamp(0, 8) as u32).unwrap_or(0);
            (above(from) & !above(to + 1) & 0xff) as u8
        };
        let (columns, rows) = (side(self.x, centre.x), side(self.y, centre.y));
        (0..8).fold(0, |cells, row| {
            let row_cells = if rows >> row & 1 == 1 { columns } else { 0 };
            cells | u64::from(row_cells) << (8 * row)
        })
    }

    /// Its cells that lie on the edge of the extent.
    pub(crate) fn edge(self, extent: Extent) -> u64 {
        let (x, y) = (usize::from(self.x), usize::from(self.y));
        let last = |cells: u16| usize::from(cells).saturating_sub(1);
        let mut edge = 0;
        if x == 0 {
            edge |= WEST_COLUMN;
        }
        if y == 0 {
            edge |= 0xff;
        }
        if x == last(extent.width) / TILE {
            edge |= WEST_COLUMN << (last(extent.width) % TILE);
        }
        if y == last(extent.height) / TILE {
            edge |= 0xff << (last(extent.height) % TILE * TILE);
        }
        edge & self.inside(extent)
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

/// All tiles of a map of so many columns and rows of tiles, row by row.
pub(crate) fn every_tile(columns: usize, rows: usize) -> impl Iterator<Item = TileIndex> + use<> {
    let (columns, rows) = (columns as u8, rows as u8);
    (0..rows).flat_map(move |y| (0..columns).map(move |x| TileIndex { x, y }))
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

/// The cells of a tile that are at most `reach`, 0 to 7, east or west of one of a layer, whose
/// words of the tile to the west, of it and of that to the east are given.
pub(crate) fn along([west, own, east]: [u64; 3], reach: u32) -> u64 {
    (1..=reach.min(7)).fold(own, |all, by| {
        // The columns that stay in the tile when they are moved east, and west.
        let (eastward, westward) = (0xff >> by, 0xff << by & 0xff);
        let (eastward, westward) = (eastward * WEST_COLUMN, westward * WEST_COLUMN);
        let from_west = (own & eastward) << by | (west & !eastward) >> (8 - by);
        let from_east = (own & westward) >> by | (east & !westward) << (8 - by);
        all | from_west | from_east
    })
}

/// The cells of a tile that are `by` rows, 0 to 7, north or south of one of a layer, whose
/// words of the tile to the north, of it and of that to the south are given.
pub(crate) fn across([north, own, south]: [u64; 3], by: u32) -> u64 {
    let rows = TILE as u32 * by.min(7);
    let carried =
        |word: u64, shift: fn(u64, u32) -> Option<u64>| shift(word, u64::BITS - rows).unwrap_or(0);
    let entering = carried(north, u64::checked_shr) | carried(south, u64::checked_shl);
    own << rows | own >> rows | entering
}

/// The cells of tile `at` that have a 4-neighbour in a layer. Asks for the layer of five
/// tiles, also of some that no map has.
pub(crate) fn neighbours(at: TileIndex, layer: impl Fn(TileIndex) -> u64) -> u64 {
    let here = layer(at);
    let entering =
        |direction: Direction| carried(layer(at.beside(direction.opposite())), direction);
    shifted(here, Direction::East)
        | shifted(here, Direction::South)
        | shifted(here, Direction::West)
        | shifted(here, Direction::North)
        | entering(Direction::East)
        | entering(Direction::South)
        | entering(Direction::West)
        | entering(Direction::North)
}

/// A value for each tile of a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub(crate) struct Tiles<T, const TW: usize, const TH: usize>([[T; TW]; TH]);

impl<T: Copy, const TW: usize, const TH: usize> Tiles<T, TW, TH> {
    /// The same for all.
    pub(crate) const fn all(value: T) -> Self {
        Self([[value; TW]; TH])
    }

    /// Row by row.
    pub(crate) const fn of(values: [[T; TW]; TH]) -> Self {
        Self(values)
    }

    /// The same for all again, in place.
    pub(crate) fn fill(&mut self, value: T) {
        self.0.as_flattened_mut().fill(value);
    }

    /// That of one tile; `None` outside of the map.
    #[inline]
    pub(crate) fn get(&self, at: TileIndex) -> Option<&T> {
        self.0.get(usize::from(at.y))?.get(usize::from(at.x))
    }

    /// The same, to be changed.
    #[inline]
    pub(crate) fn get_mut(&mut self, at: TileIndex) -> Option<&mut T> {
        self.0
            .get_mut(usize::from(at.y))?
            .get_mut(usize::from(at.x))
    }

    /// All of them, row by row.
    pub(crate) fn values(&self) -> impl Iterator<Item = &T> {
        self.0.as_flattened().iter()
    }

    /// The same, to be changed.
    pub(crate) fn values_mut(&mut self) -> impl Iterator<Item = &mut T> {
        self.0.as_flattened_mut().iter_mut()
    }
}

/// A bit a cell of a map.
impl<const TW: usize, const TH: usize> Tiles<u64, TW, TH> {
    /// The bits of a tile; none outside.
    #[inline]
    pub(crate) fn word(&self, at: TileIndex) -> u64 {
        self.get(at).copied().unwrap_or(0)
    }

    /// Sets bits of a tile; outside nothing happens.
    pub(crate) fn add(&mut self, at: TileIndex, bits: u64) {
        if let Some(word) = self.get_mut(at) {
            *word |= bits;
        }
    }

    /// Whether the cell's bit is set.
    pub(crate) fn contains(&self, cell: Cell) -> bool {
        TileIndex::of(cell).is_some_and(|(at, bit)| self.word(at) & bit != 0)
    }

    /// Sets the cell's bit; outside nothing happens.
    pub(crate) fn insert(&mut self, cell: Cell) {
        if let Some((at, bit)) = TileIndex::of(cell) {
            self.add(at, bit);
        }
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

    /// Takes out the first tile [`after`](Self::after) `tile`.
    pub fn pop_after(&mut self, tile: TileIndex) -> Option<TileIndex> {
        let next = self.after(tile)?;
        self.remove(next);
        Some(next)
    }

    /// The first tile behind `tile` in the order of [`iter`](Self::iter); where there is
    /// none, the first of all.
    pub fn after(&self, tile: TileIndex) -> Option<TileIndex> {
        let beyond = |bit: u8| (u64::MAX << (bit & 63)) & !(1 << (bit & 63));
        let first = |y: u8, row: u64| TileIndex::new(row.trailing_zeros() as u8, y);
        let rest_of_row = self.row(tile.y) & beyond(tile.x);
        if rest_of_row != 0 {
            return Some(first(tile.y, rest_of_row));
        }
        let behind = self.occupied & beyond(tile.y);
        let rows = if behind != 0 { behind } else { self.occupied };
        let y = rows.trailing_zeros() as u8;
        (rows != 0).then(|| first(y, self.row(y)))
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

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use proptest::prelude::*;

    use super::*;

    fn tile_index() -> impl Strategy<Value = TileIndex> {
        (0u8..5, 0u8..4).prop_map(|(x, y)| TileIndex { x, y })
    }

    proptest! {
        #[test]
        fn a_tile_set_is_a_set(operations in proptest::collection::vec((0u8..3, tile_index()), 0..60)) {
            let mut set = TileSet::<3>::new();
            let mut oracle = std::collections::BTreeSet::new();
            for (operation, tile) in operations {
                let key = (tile.y, tile.x);
                match operation {
                    0 => {
                        set.insert(tile);
                        if tile.y < 3 {
                            oracle.insert(key);
                        }
                    }
                    1 => {
                        set.remove(tile);
                        oracle.remove(&key);
                    }
                    _ => prop_assert_eq!(set.pop_first().map(|t| (t.y, t.x)), oracle.pop_first()),
                }
                prop_assert_eq!(set.contains(tile), oracle.contains(&key));
                prop_assert_eq!(set.is_empty(), oracle.is_empty());
                let behind = oracle.range((tile.y, tile.x + 1)..).next();
                let after = behind.or(oracle.first()).copied();
                prop_assert_eq!(set.after(tile).map(|t| (t.y, t.x)), after);
                let listed: Vec<_> = set.iter().map(|t| (t.y, t.x)).collect();
                prop_assert_eq!(&listed, &oracle.iter().copied().collect::<Vec<_>>());
                let mut union = TileSet::<3>::new();
                union.extend(&set);
                prop_assert_eq!(union, set);
            }
        }
    }

    #[test]
    fn moved_layers_follow_the_cells() {
        let at = TileIndex::new(2, 1);
        for bit in 0..64 {
            for direction in Direction::ALL {
                let target = at.cell(bit).step(direction);
                let (tile, target_bit) = TileIndex::of(target).unwrap();
                let (stays, leaves) = (shifted(1 << bit, direction), carried(1 << bit, direction));
                if tile == at {
                    assert_eq!((stays, leaves), (target_bit, 0));
                } else {
                    assert_eq!((stays, leaves), (0, target_bit));
                    assert_eq!(at.neighbour(direction), Some(tile));
                }
            }
        }
    }

    /// Against each cell by itself.
    #[test]
    fn cells_inside_and_on_the_edge_are_those_of_the_extent() {
        let extent = Extent::new(19, 13);
        for at in every_tile(4, 3) {
            for (cell, bit) in (0..64).map(|bit| (at.cell(bit), 1 << bit)) {
                let is_inside = extent.contains(cell);
                let beyond = |direction| !extent.contains(cell.step(direction));
                let is_edge = is_inside && Direction::ALL.into_iter().any(beyond);
                assert_eq!(at.inside(extent) & bit != 0, is_inside);
                assert_eq!(at.edge(extent) & bit != 0, is_edge);
            }
        }
    }
}
