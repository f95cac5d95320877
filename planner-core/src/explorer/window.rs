//! The 4×4 tiles around a cell, as rows of 32 cells.

use crate::cell::Cell;
use crate::tile::{TILE, TileIndex};

/// Side of the window in cells and in tiles.
pub(crate) const SIDE: usize = 32;
const TILES: u8 = 4;
const _: () = assert!(SIDE == u32::BITS as usize, "a row of the window is a u32");
const _: () = assert!(
    SIDE == TILES as usize * TILE,
    "the window is made of whole tiles"
);

/// One layer of the window: bit `x` of row `y` is the cell `(x, y)` from its corner.
pub(crate) type Rows = [u32; SIDE];

/// The 4×4 tiles around a cell, such that the cell is at least 12 cells from the edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Window {
    /// Corner, in tiles; may lie outside of the map.
    x: i16,
    y: i16,
}

impl Window {
    /// Tiles that it is made of.
    pub(crate) const TILES: usize = (TILES as usize) * (TILES as usize);

    pub(crate) const fn new() -> Self {
        Self { x: 0, y: 0 }
    }

    /// Whether it holds the tile in this column and row of tiles.
    pub(crate) fn holds(self, (x, y): (i16, i16)) -> bool {
        let side = 0..i32::from(TILES);
        side.contains(&(i32::from(x) - i32::from(self.x)))
            && side.contains(&(i32::from(y) - i32::from(self.y)))
    }

    /// A number below [`Self::TILES`], another one for each tile of a window, and the same
    /// in all windows.
    pub(crate) const fn slot((x, y): (i16, i16)) -> usize {
        const SIDE: i16 = TILES as i16;
        (x.rem_euclid(SIDE) + SIDE * y.rem_euclid(SIDE)) as usize
    }

    /// Its tiles, also those that no map has, each with its slot.
    pub(crate) fn slots(self) -> impl Iterator<Item = ((i16, i16), usize)> {
        (0..i16::from(TILES)).flat_map(move |dy| {
            (0..i16::from(TILES)).map(move |dx| {
                let at = (self.x + dx, self.y + dy);
                (at, Self::slot(at))
            })
        })
    }

    pub(crate) const fn around(cell: Cell) -> Self {
        Self {
            x: (cell.x.saturating_add(4) >> 3) - 2,
            y: (cell.y.saturating_add(4) >> 3) - 2,
        }
    }

    /// Row and bit number of a cell, if it lies in the window.
    pub(crate) fn place(self, cell: Cell) -> Option<(usize, u32)> {
        let column = u32::try_from(i32::from(cell.x) - 8 * i32::from(self.x)).ok()?;
        let row = usize::try_from(i32::from(cell.y) - 8 * i32::from(self.y)).ok()?;
        (column < SIDE as u32 && row < SIDE).then_some((row, column))
    }

    pub(crate) const fn cell(self, row: usize, column: u32) -> Cell {
        Cell::new(self.x * 8 + column as i16, self.y * 8 + row as i16)
    }

    /// The tiles of the window that can exist, each with the row and the bit
    /// number of its corner.
    pub(crate) fn tiles(self) -> impl Iterator<Item = (TileIndex, usize, u32)> {
        (0..TILES).flat_map(move |dy| {
            (0..TILES).filter_map(move |dx| {
                let at = TileIndex {
                    x: u8::try_from(self.x + i16::from(dx)).ok()?,
                    y: u8::try_from(self.y + i16::from(dy)).ok()?,
                };
                Some((at, usize::from(dy) * 8, u32::from(dx) * 8))
            })
        })
    }

    /// Gathers one layer of the tiles into rows. Work: 128 bytes.
    pub(crate) fn load(self, layer: impl Fn(TileIndex) -> u64) -> Rows {
        let mut rows = [0; SIDE];
        let (rows_of_tiles, _) = rows.as_chunks_mut::<TILE>();
        for (rows, dy) in rows_of_tiles.iter_mut().zip(0i16..) {
            let Ok(y) = u8::try_from(self.y + dy) else {
                continue;
            };
            for dx in 0..i16::from(TILES) {
                let Ok(x) = u8::try_from(self.x + dx) else {
                    continue;
                };
                let cells = layer(TileIndex { x, y });
                if cells == 0 {
                    continue;
                }
                for (row, byte) in rows.iter_mut().zip(cells.to_le_bytes()) {
                    *row |= u32::from(byte) << (8 * dx);
                }
            }
        }
        rows
    }

    /// Its rows of tiles: column and row of the first tile, and those of the four that can
    /// exist.
    pub(crate) fn rows_of_tiles(
        self,
    ) -> impl Iterator<Item = ((i16, i16), [Option<TileIndex>; 4])> {
        (0..i16::from(TILES)).map(move |dy| {
            let y = self.y + dy;
            let tiles = [0, 1, 2, 3].map(|dx| {
                Some(TileIndex {
                    x: u8::try_from(self.x + dx).ok()?,
                    y: u8::try_from(y).ok()?,
                })
            });
            ((self.x, y), tiles)
        })
    }

    /// Puts cells of a tile of the window into rows.
    pub(crate) fn put(self, rows: &mut Rows, at: TileIndex, cells: u64) {
        let (dx, dy) = (i16::from(at.x) - self.x, i16::from(at.y) - self.y);
        let rows = rows.iter_mut().skip(usize::from(dy.unsigned_abs()) * TILE);
        for (row, byte) in rows.zip(cells.to_le_bytes()) {
            *row |= u32::from(byte) << (8 * u32::from(dx.unsigned_abs())).min(24);
        }
    }

    /// Gives rows back to the tiles, those that have any. Work: 128 bytes.
    pub(crate) fn split(self, rows: Rows) -> impl Iterator<Item = (TileIndex, u64)> {
        self.tiles().filter_map(move |(at, row, column)| {
            let mut bytes = [0; 8];
            for (byte, row) in bytes.iter_mut().zip(rows.iter().skip(row)) {
                *byte = (row >> column) as u8;
            }
            let cells = u64::from_le_bytes(bytes);
            (cells != 0).then_some((at, cells))
        })
    }
}
