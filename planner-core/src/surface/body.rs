//! Configuration space: which columns the middle of a flying body can be over.
//!
//! The body of clearance c is a ball with a radius of c columns. Wherever over a column its
//! middle is, it reaches over those that are at most c away each way, and over each of these
//! from somewhere. A column is *clear* if they are all known, and *doubtful* if they all lie
//! on the map and are not; where some lie outside, nothing ever flies. With a clearance of 0
//! the clear columns are the known ones, and the clear ones beside doubtful ones the frontiers.
//! As long as any column is unknown and any is clear, some clear one is beside a doubtful one.

use super::Surface;
use crate::cell::{Cell, Direction, Extent};
use crate::tile::{TileIndex, neighbours};

/// The largest clearance of a body, in columns.
pub const MAX_CLEARANCE: u8 = 3;

/// The columns that a body reaches over with its middle over one, row by row.
pub fn body_columns(clearance: u8, middle: Cell) -> impl Iterator<Item = Cell> {
    let reach = i16::from(clearance.min(MAX_CLEARANCE));
    BodyColumns {
        middle,
        reach,
        dx: -reach,
        dy: -reach,
    }
}

/// The next column of a body.
struct BodyColumns {
    middle: Cell,
    reach: i16,
    dx: i16,
    dy: i16,
}

impl Iterator for BodyColumns {
    type Item = Cell;

    #[inline(never)] // small rather than fast: most robots have one column
    fn next(&mut self) -> Option<Cell> {
        if self.dy > self.reach {
            return None;
        }
        let Cell { x, y } = self.middle;
        let column = Cell::new(x.saturating_add(self.dx), y.saturating_add(self.dy));
        self.dx += 1;
        if self.dx > self.reach {
            self.dx = -self.reach;
            self.dy += 1;
        }
        Some(column)
    }
}

/// Whether a body with its middle over one column reaches over another.
pub fn reaches_over(clearance: u8, middle: Cell, column: Cell) -> bool {
    let reach = u16::from(clearance.min(MAX_CLEARANCE));
    middle.x.abs_diff(column.x) <= reach && middle.y.abs_diff(column.y) <= reach
}

impl<const TW: usize, const TH: usize> Surface<TW, TH> {
    /// Whether a column is clear. Cost: (2c + 1)² reads.
    #[inline(never)] // there are many calls
    pub fn is_clear(&self, cell: Cell, clearance: u8) -> bool {
        body_columns(clearance, cell).all(|cell| self.height(cell).is_some())
    }

    /// Whether a column is doubtful. Cost: (2c + 1)² reads.
    pub(crate) fn is_doubtful(&self, cell: Cell, clearance: u8) -> bool {
        is_inside(self.extent, cell, clearance) && !self.is_clear(cell, clearance)
    }

    /// Whether a column is clear and beside a doubtful one. Cost: see [`edges`](Self::edges).
    pub(crate) fn is_edge(&self, cell: Cell, clearance: u8) -> bool {
        TileIndex::of(cell).is_some_and(|(tile, bit)| self.edges(tile, clearance) & bit != 0)
    }

    /// The clear columns of a tile. Cost: a word; with a clearance nine.
    #[inline(never)] // there are many calls
    pub(crate) fn clear(&self, tile: TileIndex, clearance: u8) -> u64 {
        match clearance {
            0 => self.known(tile),
            _ => !about(tile, clearance, &|tile| !self.known(tile)),
        }
    }

    /// Those that are beside doubtful ones. Cost: five words at most; with a clearance 99.
    #[inline(never)] // there are many calls
    pub(crate) fn edges(&self, tile: TileIndex, clearance: u8) -> u64 {
        if clearance == 0 {
            return match self.frontiers_in(tile) {
                0 => 0,
                _ => self.frontier_cells(tile),
            };
        }
        match self.clear(tile, clearance) {
            0 => 0,
            clear => clear & neighbours(tile, |tile| self.doubtful(tile, clearance)),
        }
    }

    /// The doubtful columns of a tile. Cost: 18 words.
    #[inline(never)] // there are many calls
    fn doubtful(&self, tile: TileIndex, clearance: u8) -> u64 {
        let outside = about(tile, clearance, &|tile| !tile.inside(self.extent));
        !outside & !self.clear(tile, clearance)
    }
}

/// Whether a body over this column is all over the map.
fn is_inside(extent: Extent, cell: Cell, clearance: u8) -> bool {
    let reach = i16::from(clearance);
    let corner = |by| Cell::new(cell.x.saturating_add(by), cell.y.saturating_add(by));
    extent.contains(corner(-reach)) && extent.contains(corner(reach))
}

/// The columns of a tile from which a body reaches over some of a layer.
#[inline(never)] // small rather than fast: most robots have one column
fn about(tile: TileIndex, clearance: u8, layer: &dyn Fn(TileIndex) -> u64) -> u64 {
    let [mut north, mut own, mut south] = [
        tile.beside(Direction::North),
        tile,
        tile.beside(Direction::South),
    ]
    .map(|tile| along_rows(tile, clearance, layer));
    for _ in 0..clearance.min(MAX_CLEARANCE) {
        let entering = north >> 56 | south << 56;
        north |= north << 8 | own << 56;
        south |= south >> 8 | own >> 56;
        own |= own << 8 | own >> 8 | entering;
    }
    own
}

/// The same along rows alone.
#[inline(never)] // small rather than fast
fn along_rows(tile: TileIndex, clearance: u8, layer: &dyn Fn(TileIndex) -> u64) -> u64 {
    let own = layer(tile);
    let west = layer(tile.beside(Direction::West));
    let east = layer(tile.beside(Direction::East));
    (0..8).fold(0, |all, row| {
        let of = |word: u64| (word >> (8 * row)) as u32 & 0xff;
        let mut wide = of(west) | of(own) << 8 | of(east) << 16;
        for _ in 0..clearance.min(MAX_CLEARANCE) {
            wide |= wide << 1 | wide >> 1;
        }
        all | u64::from(wide >> 8 & 0xff) << (8 * row)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::{Column, Height};
    use proptest::prelude::*;

    proptest! {
        /// Against a look at every column under a body.
        #[test]
        fn words_say_what_columns_do(
            unknown in prop::collection::vec((0i16..30, 0i16..27), 0..40),
            (width, height) in (1u16..30, 1u16..27),
        ) {
            let extent = Extent::new(width, height);
            let mut surface = Surface::<4, 4>::new(extent).unwrap();
            let cells = || (-1..33i16).flat_map(|y| (-1..33i16).map(move |x| Cell::new(x, y)));
            for cell in cells().filter(|cell| !unknown.contains(&(cell.x, cell.y))) {
                surface.learn(Column { cell, height: Height(0) });
            }
            for clearance in 0..=MAX_CLEARANCE {
                let all = |cell, holds: &dyn Fn(Cell) -> bool| {
                    cells()
                        .chain([Cell::new(-9, -9)])
                        .filter(|&column| reaches_over(clearance, cell, column))
                        .all(holds)
                };
                let is_clear = |cell| all(cell, &|it| surface.height(it).is_some());
                let is_doubtful = |cell| all(cell, &|it| extent.contains(it)) && !is_clear(cell);
                let mut edges = 0;
                for cell in cells().filter(|cell| extent.contains(*cell)) {
                    prop_assert_eq!(surface.is_clear(cell, clearance), is_clear(cell));
                    prop_assert_eq!(surface.is_doubtful(cell, clearance), is_doubtful(cell));
                    let (tile, bit) = TileIndex::of(cell).unwrap();
                    prop_assert_eq!(surface.clear(tile, clearance) & bit != 0, is_clear(cell));
                    let beside = Direction::ALL.map(|direction| cell.step(direction));
                    let is_edge = is_clear(cell) && beside.into_iter().any(is_doubtful);
                    prop_assert_eq!(surface.is_edge(cell, clearance), is_edge);
                    edges += u32::from(is_edge);
                }
                // Nothing is left as long as there is something to look at it from.
                let has_clear = cells().any(|cell| extent.contains(cell) && is_clear(cell));
                let is_whole = surface.known_columns() == extent.cells();
                prop_assert!(!has_clear || is_whole == (edges == 0));
            }
        }
    }
}
