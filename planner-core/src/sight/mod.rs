//! What one look shows: cells seen free and cells seen blocked around the robot.
//!
//! A sighting comes from a range scan ([`RangeScan`]) on a robot, or from
//! [`look`] where the world is at hand (simulator, tests).

mod beam;
mod line;
mod metres;
mod scan;
mod walk;

pub use beam::{Beam, Bearing, RangeSensor};
pub use line::{line_of_sight, look};
pub use scan::{Pose, RangeScan, ScanError};

use crate::cell::Cell;
use crate::tile::{TILE, TileIndex};

/// The largest perception radius in cells.
pub const MAX_RADIUS: u8 = 15;

/// Rows (and columns) of a sighting.
const SPAN: usize = 2 * MAX_RADIUS as usize + 1;
const _: () = assert!(
    SPAN <= u32::BITS as usize,
    "a row of a sighting is a u32: MAX_RADIUS is at most 15"
);

const WHOLE_ROW: u32 = (1 << SPAN) - 1;

/// Cells seen from `centre`, within [`MAX_RADIUS`] in both axes.
///
/// Bit `x - centre.x + 15` of row `y - centre.y + 15` is the cell `(x, y)`. No
/// cell is both free and blocked: blocked wins. A cell that was seen blocked more than
/// once, by two beams of a scan for example, is *firm*. 376 bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Sighting {
    centre: Cell,
    free: [u32; SPAN],
    blocked: [u32; SPAN],
    firm: [u32; SPAN],
}

impl Sighting {
    /// Nothing seen yet but the cell that the robot stands on, which is free.
    pub const fn new(centre: Cell) -> Self {
        let mut free = [0; SPAN];
        free[MAX_RADIUS as usize] = 1 << MAX_RADIUS;
        Self {
            centre,
            free,
            blocked: [0; SPAN],
            firm: [0; SPAN],
        }
    }

    /// Where the robot stood.
    pub const fn centre(&self) -> Cell {
        self.centre
    }

    /// Adds a cell seen free. Ignored beyond the radius, and where it was seen blocked.
    pub fn see_free(&mut self, cell: Cell) {
        if let Some((row, bit)) = self.place(cell)
            && let (Some(free), Some(blocked)) = (self.free.get_mut(row), self.blocked.get(row))
        {
            *free |= bit & !blocked;
        }
    }

    /// Adds a cell seen blocked; seen so before, it is firm. Ignored beyond the radius and
    /// for the robot's own cell.
    pub fn see_blocked(&mut self, cell: Cell) {
        if cell == self.centre {
            return;
        }
        if let Some((row, bit)) = self.place(cell)
            && let Some(free) = self.free.get_mut(row)
            && let (Some(blocked), Some(firm)) = (self.blocked.get_mut(row), self.firm.get_mut(row))
        {
            *firm |= *blocked & bit;
            *blocked |= bit;
            *free &= !bit;
        }
    }

    /// Adds cells of the row that lies `dy` below the robot's own: bit `n` stands for the
    /// cell `n - 15` to the right of it, as by [`see_free`](Self::see_free) and
    /// [`see_blocked`](Self::see_blocked). Ignored beyond the radius.
    pub fn see_row(&mut self, dy: i16, free: u32, blocked: u32) {
        let Some(row) = row_of(dy) else { return };
        let own = if dy == 0 { 1 << MAX_RADIUS } else { 0 };
        let blocked_now = WHOLE_ROW & blocked & !own;
        if let (Some(free_row), Some(blocked_row), Some(firm)) = (
            self.free.get_mut(row),
            self.blocked.get_mut(row),
            self.firm.get_mut(row),
        ) {
            *firm |= *blocked_row & blocked_now;
            *blocked_row |= blocked_now;
            *free_row = (*free_row | WHOLE_ROW & free) & !*blocked_row;
        }
    }

    /// The cells seen free in the row that lies `dy` below the robot's own, in the bits of
    /// [`see_row`](Self::see_row).
    pub fn free_row(&self, dy: i16) -> u32 {
        let row = row_of(dy).and_then(|row| self.free.get(row));
        row.copied().unwrap_or(0)
    }

    /// Blocked wins, also where cells were seen free past [`see_free`](Self::see_free).
    fn settle(&mut self) {
        for (free, blocked) in self.free.iter_mut().zip(&self.blocked) {
            *free &= WHOLE_ROW & !blocked;
        }
    }

    /// Whether the cell was seen free.
    pub fn is_free(&self, cell: Cell) -> bool {
        self.has(cell, &self.free)
    }

    /// Whether the cell was seen blocked.
    pub fn is_blocked(&self, cell: Cell) -> bool {
        self.has(cell, &self.blocked)
    }

    /// Whether the cell was seen blocked more than once.
    pub fn is_firm(&self, cell: Cell) -> bool {
        self.has(cell, &self.firm)
    }

    fn has(&self, cell: Cell, rows: &[u32; SPAN]) -> bool {
        self.place(cell)
            .is_some_and(|(row, bit)| rows.get(row).is_some_and(|row| row & bit != 0))
    }

    /// The cells seen free at most two columns and two rows away: bit `x - centre.x + 2` of
    /// row `y - centre.y + 2`.
    pub(crate) fn free_near(&self) -> [u8; 5] {
        const CORNER: usize = MAX_RADIUS as usize - 2;
        let mut near = [0; 5];
        for (near, row) in near.iter_mut().zip(self.free.iter().skip(CORNER)) {
            *near = (row >> CORNER) as u8 & 0x1f;
        }
        near
    }

    /// The cells seen free, row by row. At most 961.
    pub fn free_cells(&self) -> impl Iterator<Item = Cell> + '_ {
        self.cells(&self.free)
    }

    /// The cells seen blocked, row by row. At most 960.
    pub fn blocked_cells(&self) -> impl Iterator<Item = Cell> + '_ {
        self.cells(&self.blocked)
    }

    fn cells<'a>(&'a self, rows: &'a [u32; SPAN]) -> impl Iterator<Item = Cell> + 'a {
        let corner = self.corner();
        rows.iter().zip(0i16..).flat_map(move |(&row, dy)| {
            crate::tile::bits(u64::from(row)).map(move |dx| {
                Cell::new(
                    corner.0.saturating_add(dx as i16),
                    corner.1.saturating_add(dy),
                )
            })
        })
    }

    /// The north-western corner of the rows, as `(x, y)`.
    const fn corner(&self) -> (i16, i16) {
        (
            self.centre.x.saturating_sub(MAX_RADIUS as i16),
            self.centre.y.saturating_sub(MAX_RADIUS as i16),
        )
    }

    fn place(&self, cell: Cell) -> Option<(usize, u32)> {
        let (x, y) = self.corner();
        let column = u8::try_from(i32::from(cell.x) - i32::from(x)).ok()?;
        let row = usize::try_from(i32::from(cell.y) - i32::from(y)).ok()?;
        (usize::from(column) < SPAN && row < SPAN).then(|| (row, 1 << column))
    }

    /// The block of tiles that holds all cells seen: its corner in tiles, and its side,
    /// at most five.
    fn tile_block(&self) -> ((i16, i16), u8) {
        // The robot's own cell is among them.
        let (mut columns, mut rows) = (1u32 << MAX_RADIUS, 1u32 << MAX_RADIUS);
        for (row, (free, blocked)) in self.free.iter().zip(&self.blocked).enumerate() {
            columns |= free | blocked;
            rows |= u32::from(free | blocked != 0) << row;
        }
        let (x, y) = self.corner();
        let tiles = |corner: i16, seen: u32| {
            let tile = |bit: u32| corner.saturating_add(bit as i16) >> 3;
            (tile(seen.trailing_zeros()), tile(31 - seen.leading_zeros()))
        };
        let ((west, east), (north, south)) = (tiles(x, columns), tiles(y, rows));
        let side = 1 + (east - west).max(south - north);
        ((west, north), side as u8)
    }

    /// The tiles that hold cells seen, at most 25.
    pub(crate) fn tiles(&self) -> impl Iterator<Item = TileIndex> + use<> {
        let (corner, span) = self.tile_block();
        (0..span).flat_map(move |dy| {
            (0..span).filter_map(move |dx| {
                let x = u8::try_from(corner.0 + i16::from(dx)).ok()?;
                let y = u8::try_from(corner.1 + i16::from(dy)).ok()?;
                Some(TileIndex { x, y })
            })
        })
    }

    /// The cells of one tile seen free and seen blocked. Work: twice eight rows.
    pub(crate) fn tile(&self, at: TileIndex) -> (u64, u64) {
        (
            self.in_tile(at, &self.free),
            self.in_tile(at, &self.blocked),
        )
    }

    /// The firm cells of one tile. Work: eight rows.
    pub(crate) fn firm_tile(&self, at: TileIndex) -> u64 {
        self.in_tile(at, &self.firm)
    }

    fn in_tile(&self, at: TileIndex, rows: &[u32; SPAN]) -> u64 {
        let (x, y) = self.corner();
        let dx = i32::from(at.x) * TILE as i32 - i32::from(x);
        let dy = i32::from(at.y) * TILE as i32 - i32::from(y);
        let mut cells = 0;
        for row in 0..TILE as i32 {
            if let Ok(index) = usize::try_from(dy + row)
                && let Some(&seen) = rows.get(index)
            {
                cells |= u64::from(byte_at(seen, dx)) << (row * TILE as i32);
            }
        }
        cells
    }
}

/// The eight bits of `row` from bit number `from` on, which may be negative.
const fn byte_at(row: u32, from: i32) -> u8 {
    match from {
        0..=31 => (row >> from) as u8,
        -7..=-1 => (row << -from) as u8,
        _ => 0,
    }
}

/// The index of the row `dy` below the robot's own.
fn row_of(dy: i16) -> Option<usize> {
    let row = usize::try_from(i32::from(dy) + i32::from(MAX_RADIUS)).ok()?;
    (row < SPAN).then_some(row)
}

#[cfg(test)]
mod tests;
