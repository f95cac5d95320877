//! Sets of cells: what a robot keeps out of.

use crate::cell::Cell;
use crate::tile::{TILE, TileIndex, Tiles};

/// Cells of a map of `TW`×`TH` tiles, a bit each: 8 bytes a tile.
///
/// Empty it is all zero, so a `static` of it costs no flash. Made of words
/// ([`from_words`](Self::from_words)), a `const` of it lies in flash and costs no RAM.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub struct CellSet<const TW: usize, const TH: usize>(Tiles<u64, TW, TH>);

impl<const TW: usize, const TH: usize> Default for CellSet<TW, TH> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const TW: usize, const TH: usize> CellSet<TW, TH> {
    /// No cell.
    pub const fn new() -> Self {
        Self(Tiles::all(0))
    }

    /// Rows of tiles, as [`word`](Self::word) gives them.
    pub const fn from_words(words: [[u64; TW]; TH]) -> Self {
        Self(Tiles::of(words))
    }

    /// The cells of a tile: bit `8·(y mod 8) + (x mod 8)` is the cell `(x, y)`. None outside
    /// of the map.
    #[inline(never)] // small rather than fast: most robots keep out of nothing
    pub fn word(&self, at: TileIndex) -> u64 {
        self.0.word(at)
    }

    /// A number that sets of different cells hardly share; 0 for none.
    pub(crate) fn digest(&self) -> u16 {
        // FNV-1a, half a word at a time, begun with 0.
        let mix = |hash: u32, word: u32| (hash ^ word).wrapping_mul(0x0100_0193);
        let halves = { self.0.values() }.flat_map(|word| [*word as u32, (word >> 32) as u32]);
        let hash = halves.fold(0, mix);
        (hash ^ hash >> 16) as u16
    }

    /// Whether the cell is one of them.
    pub fn contains(&self, cell: Cell) -> bool {
        self.0.contains(cell)
    }

    /// Adds a cell; outside of the map nothing happens.
    pub fn insert(&mut self, cell: Cell) {
        self.0.insert(cell);
    }

    /// Adds the rectangle between two opposite corners, both of them in it, as far as it
    /// lies on the map. Work: a few instructions a cell.
    pub fn insert_rectangle(&mut self, corner: Cell, opposite: Cell) {
        let side = |a: i16, b: i16, tiles: usize| {
            a.min(b).max(0)..=a.max(b).min((tiles * TILE) as i16 - 1)
        };
        for y in side(corner.y, opposite.y, TH) {
            for x in side(corner.x, opposite.x, TW) {
                self.insert(Cell::new(x, y));
            }
        }
    }

    /// Takes out every cell that it has, and adds every other one: to keep out of all but
    /// some cells.
    pub fn invert(&mut self) {
        for word in self.0.values_mut() {
            *word = !*word;
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use std::vec::Vec;

    use super::*;

    type Small = CellSet<3, 2>;

    fn cells_of(set: &Small) -> Vec<Cell> {
        let cells = (-3..20).flat_map(|y| (-3..28).map(move |x| Cell::new(x, y)));
        cells.filter(|cell| set.contains(*cell)).collect()
    }

    proptest! {
        #[test]
        fn a_rectangle_is_the_cells_between_its_corners(
            [ax, bx] in [-9i16..40, -9..40], [ay, by] in [-9i16..40, -9..40],
        ) {
            let mut set = Small::new();
            set.insert_rectangle(Cell::new(ax, ay), Cell::new(bx, by));
            let is_between = |cell: &Cell| {
                (ax.min(bx)..=ax.max(bx)).contains(&cell.x)
                    && (ay.min(by)..=ay.max(by)).contains(&cell.y)
            };
            let all = (0..16).flat_map(|y| (0..24).map(move |x| Cell::new(x, y)));
            let (inside, outside): (Vec<_>, Vec<_>) = all.partition(is_between);
            prop_assert_eq!(cells_of(&set), inside);
            set.invert();
            prop_assert_eq!(cells_of(&set), outside);
        }
    }

    #[test]
    fn a_word_is_a_tile() {
        let mut set = Small::new();
        set.insert(Cell::new(9, 10));
        assert_eq!(set.word(TileIndex::new(1, 1)), 1 << (8 * 2 + 1));
        assert_eq!(set, Small::from_words([[0; 3], [0, 1 << 17, 0]]));
        assert_eq!(set.word(TileIndex::new(3, 0)), 0);
        assert!(set.digest() != 0 && Small::new().digest() == 0);
        let before = set.digest();
        set.insert(Cell::new(0, 0));
        assert_ne!(set.digest(), before);
    }
}
