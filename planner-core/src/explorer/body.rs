//! Configuration space: where the centre of a body can be.
//!
//! The body is the disc of the cells with dx² + dy² ≤ (r + ½)² around its centre. A cell is
//! *clear* if its whole disc is known to be free, *shut* if a wall lies in its disc, and
//! *doubtful* otherwise. So configuration space has the three states that the map has, and
//! each changes as the map does: what is open, what is a frontier (clear beside doubtful),
//! and the proof of the explorer hold there word for word. With a clearance of 0 it is the
//! map itself.

use crate::cell::{Cell, Direction};
use crate::map::{Map, Tile};
use crate::sight::Sighting;
use crate::tile::{TILE, TileIndex};

/// The largest [`Config::clearance`](super::Config::clearance).
pub const MAX_CLEARANCE: u8 = 3;

/// Work of the layers of a tile and of a window, in instructions; with a clearance.
pub(super) const TILE_WORK: u32 = 4000;
pub(super) const WINDOW_WORK: u32 = 20_000;
/// Work of what a tick asks of single cells; with a clearance.
pub(super) const CELLS_WORK: u32 = 12_000;

/// How far the disc reaches east and west in its rows, from the middle one on.
const REACH: [[u8; 4]; MAX_CLEARANCE as usize + 1] =
    [[0, 0, 0, 0], [1, 1, 0, 0], [2, 2, 1, 0], [3, 3, 2, 1]];

/// Cells to each side of the middle of a disc, row by row: row, and reach in it.
fn rows_of(clearance: u8) -> impl Iterator<Item = (i16, i16)> {
    let last = i16::from(clearance);
    (-last..=last).map(move |dy| (dy, reach_in(clearance, dy)))
}

/// The cells that a body with its centre in a cell lies in, see
/// [`Config::clearance`](super::Config::clearance), row by row.
pub fn body_cells(clearance: u8, centre: Cell) -> impl Iterator<Item = Cell> {
    let last = i16::from(clearance.min(MAX_CLEARANCE));
    BodyCells {
        clearance,
        centre,
        dx: -reach_in(clearance, -last),
        dy: -last,
    }
}

/// How far the disc reaches in a row.
fn reach_in(clearance: u8, dy: i16) -> i16 {
    let reach = REACH.get(usize::from(clearance));
    let reach = reach.and_then(|reach| reach.get(usize::from(dy.unsigned_abs())));
    i16::from(reach.copied().unwrap_or(0))
}

/// How far a body reaches in a row that is somewhere within a step.
pub(super) fn swept_reach(clearance: u8, dy: i16) -> i16 {
    let (near, last) = (dy.abs(), i16::from(clearance));
    let beside = reach_in(clearance, near - 1);
    match near <= last {
        true => (reach_in(clearance, near) + 1).max(beside),
        false => beside,
    }
}

/// The next cell of a disc.
struct BodyCells {
    clearance: u8,
    centre: Cell,
    dx: i16,
    dy: i16,
}

impl Iterator for BodyCells {
    type Item = Cell;

    #[inline(never)] // small rather than fast: most robots have one cell
    fn next(&mut self) -> Option<Cell> {
        if self.dy > i16::from(self.clearance) {
            return None;
        }
        let cell = moved(self.centre, self.dx, self.dy);
        self.dx += 1;
        if self.dx > reach_in(self.clearance, self.dy) {
            self.dy += 1;
            self.dx = -reach_in(self.clearance, self.dy);
        }
        Some(cell)
    }
}

const fn moved(cell: Cell, dx: i16, dy: i16) -> Cell {
    Cell::new(cell.x.saturating_add(dx), cell.y.saturating_add(dy))
}

/// So many steps in one direction.
pub(super) fn far_beside(from: Cell, side: Direction, steps: u8) -> Cell {
    let (dx, dy) = side.delta();
    moved(from, dx * i16::from(steps), dy * i16::from(steps))
}

/// Whether the centre of a body can be in a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fit {
    Clear,
    Shut,
    Doubtful,
}

/// The state of one cell. Work: a row of the disc at a time.
pub(super) fn fit<const TW: usize, const TH: usize>(
    map: &Map<TW, TH>,
    clearance: u8,
    cell: Cell,
) -> Fit {
    let mut is_clear = true;
    for (dy, reach) in rows_of(clearance) {
        let (free, walls) = row_from(map, moved(cell, -reach, dy));
        let cells = (1 << (2 * reach + 1)) - 1;
        if walls & cells != 0 {
            return Fit::Shut;
        }
        is_clear &= free & cells == cells;
    }
    match is_clear {
        true => Fit::Clear,
        false => Fit::Doubtful,
    }
}

/// Free cells and walls eastward from a cell, nine at least.
fn row_from<const TW: usize, const TH: usize>(map: &Map<TW, TH>, first: Cell) -> (u32, u32) {
    let shift = (first.x & 7) as u32;
    let row = (first.y & 7) as u32 * TILE as u32;
    let byte = |layer: u64| (layer >> row) as u32 & 0xff;
    let west = tile_at(map, first.x >> 3, first.y >> 3);
    let east = tile_at(map, (first.x >> 3) + 1, first.y >> 3);
    let both = |layer: fn(Tile) -> u64| (byte(layer(west)) | byte(layer(east)) << 8) >> shift;
    (both(Tile::free), both(Tile::obstacle))
}

/// A tile by column and row, walls outside.
fn tile_at<const TW: usize, const TH: usize>(map: &Map<TW, TH>, x: i16, y: i16) -> Tile {
    match (u8::try_from(x), u8::try_from(y)) {
        (Ok(x), Ok(y)) => map.tile(TileIndex { x, y }),
        _ => Tile::OUTSIDE,
    }
}

/// The clear cells and the frontier of a tile.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Layers {
    pub(super) clear: u64,
    pub(super) frontier: u64,
}

/// Rows of a strip: those of a row of tiles, and four above and below.
const ROWS: usize = 2 * TILE;
/// Rows of its tiles, and one above and below.
const INNER: usize = TILE + 2;

/// The layers of a tile.
pub(super) fn tile<const TW: usize, const TH: usize>(
    map: &Map<TW, TH>,
    clearance: u8,
    at: TileIndex,
) -> Layers {
    if map.free(at) == 0 {
        return Layers::default();
    }
    let [layers, ..] = strip(map, clearance, (at.x.into(), at.y.into()));
    layers
}

/// Tiles of a strip.
const LENGTH: usize = 4;

/// The layers of four tiles side by side, from the one in this column and row on.
#[inline(never)] // a frame of half a kilobyte
pub(super) fn strip<const TW: usize, const TH: usize>(
    map: &Map<TW, TH>,
    clearance: u8,
    (x, y): (i16, i16),
) -> [Layers; LENGTH] {
    // Bit 8 of a row is the first column of the first tile.
    let (mut free, mut walls) = ([0u64; ROWS], [0u64; ROWS]);
    for (dx, column) in (-1..=LENGTH as i16).zip((0u32..).step_by(TILE)) {
        for (dy, skipped) in [(-1, 4), (0, 0), (1, 0)] {
            let tile = tile_at(map, x + dx, y + dy);
            // The rows above begin in the middle of their tiles.
            let first = match dy {
                -1 => 0,
                0 => 4,
                _ => 12,
            };
            let rows = free.iter_mut().zip(&mut walls).skip(first);
            let bytes = tile.free().to_le_bytes().into_iter();
            let bytes = bytes.zip(tile.obstacle().to_le_bytes()).skip(skipped);
            for ((free, walls), (f, w)) in rows.zip(bytes) {
                *free |= u64::from(f) << column;
                *walls |= u64::from(w) << column;
            }
        }
    }
    for row in &mut free {
        *row = !*row;
    }
    let taken = dilated(&free, clearance);
    let mut doubtful = dilated(&walls, clearance);
    for (doubtful, taken) in doubtful.iter_mut().zip(&taken) {
        *doubtful = taken & !*doubtful;
    }
    let mut layers = [Layers::default(); LENGTH];
    let beside = doubtful.windows(3).zip(taken.iter().skip(1)).zip(0u32..);
    for ((rows, taken), y) in beside {
        let [above, row, below] = rows else { continue };
        let clear = !taken;
        let frontier = clear & (above | below | row << 1 | row >> 1);
        for (layers, column) in layers.iter_mut().zip((TILE as u32..).step_by(TILE)) {
            let word = |row: u64| (row >> column & 0xff) << (8 * y);
            layers.clear |= word(clear);
            layers.frontier |= word(frontier);
        }
    }
    layers
}

/// What the disc touches from anywhere in some rows: the inner rows.
fn dilated(rows: &[u64; ROWS], clearance: u8) -> [u64; INNER] {
    let mut grown = [0; INNER];
    for (row, y) in rows.iter().zip(0i16..) {
        let mut wide = [*row; MAX_CLEARANCE as usize + 1];
        let mut last = *row;
        for wide in wide.iter_mut().skip(1) {
            last |= last << 1 | last >> 1;
            *wide = last;
        }
        for (dy, reach) in rows_of(clearance) {
            let inner = usize::try_from(y + dy - 3).ok();
            if let Some(grown) = inner.and_then(|inner| grown.get_mut(inner))
                && let Some(wide) = wide.get(reach as usize)
            {
                *grown |= wide;
            }
        }
    }
    grown
}

/// Whether a look saw anything that the body would touch in a cell.
pub(super) fn saw_blocked(sighting: &Sighting, clearance: u8, cell: Cell) -> bool {
    body_cells(clearance, cell).any(|cell| sighting.is_blocked(cell))
}

/// Whether two bodies with their centres in these cells touch: they are less than
/// 2·clearance + 1 cells apart.
pub const fn bodies_touch(clearance: u8, a: Cell, b: Cell) -> bool {
    let apart = 2 * clearance as u32 + 1;
    a.distance_squared(b) < apart * apart
}

#[cfg(test)]
mod tests;
