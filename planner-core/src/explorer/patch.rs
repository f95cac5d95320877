//! The cells around a cell, as a tile that lies across those of the map.

use crate::cell::Cell;
use crate::map::TileIndex;

/// Distance of a patch's cells from its middle.
const REACH: i16 = 2;

/// 5×5 cells: bit `8·y + x` is the cell `(x, y)` from the corner.
#[derive(Clone, Copy)]
pub(crate) struct Patch {
    corner: Cell,
}

/// A tile that a patch may lie on.
#[derive(Clone, Copy)]
pub(crate) struct Part {
    pub(crate) at: TileIndex,
    /// The patch's corner in cells of the tile, -8 to 7.
    x: i16,
    y: i16,
}

impl Part {
    /// The tile's cells as the patch's.
    pub(crate) fn to_patch(self, cells: u64) -> u64 {
        moved(cells, -self.x, -self.y)
    }

    /// The patch's cells as the tile's.
    pub(crate) fn to_tile(self, cells: u64) -> u64 {
        moved(cells, self.x, self.y)
    }
}

impl Patch {
    pub(crate) const fn around(cell: Cell) -> Self {
        Self {
            corner: Cell::new(cell.x.saturating_sub(REACH), cell.y.saturating_sub(REACH)),
        }
    }

    /// The four tiles that it may lie on, those that can exist.
    pub(crate) fn parts(self) -> impl Iterator<Item = Part> {
        let Cell { x, y } = self.corner;
        let tiles = [(0, 0), (1, 0), (0, 1), (1, 1)].into_iter();
        tiles.filter_map(move |(right, down)| {
            let at = TileIndex {
                x: u8::try_from((x >> 3) + right).ok()?,
                y: u8::try_from((y >> 3) + down).ok()?,
            };
            let (x, y) = ((x & 7) - 8 * right, (y & 7) - 8 * down);
            Some(Part { at, x, y })
        })
    }
}

/// The cells of a patch that are 8-connected to its middle. At most 25 rounds, as
/// each but the last adds a cell.
pub(crate) const fn connected(cells: u64) -> u64 {
    const SIDE: u32 = 2 * REACH as u32 + 1;
    const ALL: u64 = 0x1f_1f1f_1f1f;
    let cells = cells & ALL;
    let mut found = cells & 1 << (9 * REACH);
    let mut round = 0;
    while round < SIDE * SIDE {
        // What leaves a row lands in columns that a patch does not have.
        let wide = found | found << 1 | found >> 1;
        let grown = (wide | wide << 8 | wide >> 8) & cells;
        if grown == found {
            break;
        }
        found = grown;
        round += 1;
    }
    found
}

/// The cells of a tile moved by at most 8 each way, those that stay in it.
const fn moved(cells: u64, right: i16, down: i16) -> u64 {
    let columns = if right < 0 {
        0xff << -right & 0xff
    } else {
        0xff >> right
    };
    let staying = cells & (columns * 0x0101_0101_0101_0101);
    let places = right + 8 * down;
    if places < 0 {
        staying.unbounded_shr(places.unsigned_abs() as u32)
    } else {
        staying.unbounded_shl(places as u32)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;
    use std::vec::Vec;

    use proptest::prelude::*;

    use super::*;
    use crate::map::{bit_of, bits};

    proptest! {
        #[test]
        fn a_patch_gathers_the_cells_around_and_gives_them_back(
            x in 0i16..40, y in 0i16..40, seed: u64,
        ) {
            let layer = |at: TileIndex| seed.rotate_left(u32::from(at.x) * 7 + u32::from(at.y));
            let middle = Cell::new(x, y);
            let patch = Patch::around(middle);
            let mut gathered = 0;
            for part in patch.parts() {
                gathered |= part.to_patch(layer(part.at));
            }
            let mut given = HashSet::new();
            for part in patch.parts() {
                given.extend(bits(part.to_tile(gathered & 0x1f_1f1f_1f1f)).map(|bit| part.at.cell(bit)));
            }
            for (dx, dy) in (-2..=2).flat_map(|dx| (-2..=2).map(move |dy| (dx, dy))) {
                let cell = Cell::new(x + dx, y + dy);
                let there = TileIndex::of(cell).is_some_and(|(at, bit)| layer(at) & bit != 0);
                let bit = bit_of(Cell::new(dx + 2, dy + 2));
                prop_assert_eq!(gathered & bit != 0, there);
                prop_assert_eq!(given.remove(&cell), there);
            }
            prop_assert!(given.is_empty());
        }

        #[test]
        fn connected_cells_are_those_that_a_walk_reaches(cells: u64) {
            let cells = (cells | bit_of(Cell::new(2, 2))) & 0x1f_1f1f_1f1f;
            let mut found = HashSet::from([Cell::new(2, 2)]);
            for _ in 0..25 {
                let near = |bit: &u32| {
                    let cell = TileIndex::new(0, 0).cell(*bit);
                    found.iter().any(|other| other.chebyshev(cell) <= 1)
                };
                let more: Vec<u32> = bits(cells).filter(near).collect();
                found.extend(more.into_iter().map(|bit| TileIndex::new(0, 0).cell(bit)));
            }
            let found = found.into_iter().fold(0, |all, cell| all | bit_of(cell));
            prop_assert_eq!(connected(cells), found);
        }

        #[test]
        fn moving_is_what_it_is_cell_by_cell(cells: u64, right in -8i16..=8, down in -8i16..=8) {
            let tile = TileIndex::new(0, 0);
            let expected = bits(cells).fold(0, |all, bit| {
                let cell = tile.cell(bit);
                let to = Cell::new(cell.x + right, cell.y + down);
                let stays = (0..8).contains(&to.x) && (0..8).contains(&to.y);
                if stays { all | bit_of(to) } else { all }
            });
            prop_assert_eq!(moved(cells, right, down), expected);
        }
    }
}
