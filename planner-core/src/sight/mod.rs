//! What one look shows: cells seen free and cells seen blocked around the robot.
//!
//! A sighting comes from a range scan ([`RangeScan`]) on a robot, or from
//! [`look`] where the world is at hand (simulator, tests).

mod beam;
mod line;
mod metres;
mod row;
mod scan;
mod walk;
mod zones;

pub use beam::{Beam, Bearing, RangeSensor};
pub use line::{line_of_sight, look, look_far};
pub use row::Row;
pub use scan::{Pose, RangeScan, ScanError};
pub use zones::{Distances, Zone, ZoneBeams, ZoneError, ZoneSensor};

use crate::cell::Cell;
use crate::tile::{TILE, TileIndex};

/// The largest perception radius of a [`Sighting`] in cells.
pub const MAX_RADIUS: u8 = 15;

/// That of a [`LongSighting`].
pub const MAX_LONG_RADIUS: u8 = 31;

/// Cells seen from `centre`, within [`MAX_RADIUS`] in both axes. 376 bytes.
///
/// Bit `x - centre.x + 15` of row `y - centre.y + 15` is the cell `(x, y)`.
pub type Sighting = Look<u32, { 2 * MAX_RADIUS as usize + 1 }>;

/// Cells seen by a sensor that reaches farther, within [`MAX_LONG_RADIUS`]; bits as in a
/// [`Sighting`], with 31 instead of 15. 1,520 bytes. See
/// [`LongSight`](crate::LongSight).
pub type LongSighting = Look<u64, { 2 * MAX_LONG_RADIUS as usize + 1 }>;

/// Cells seen from `centre`, in `SPAN` rows of as many columns around it.
///
/// No cell is both free and blocked: blocked wins. A cell that was seen blocked more than
/// once, by two beams of a scan for example, is *firm*.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "[R; SPAN]: serde::Serialize",
        deserialize = "[R; SPAN]: serde::Deserialize<'de>"
    ))
)]
pub struct Look<R, const SPAN: usize> {
    centre: Cell,
    free: [R; SPAN],
    blocked: [R; SPAN],
    firm: [R; SPAN],
}

impl Sighting {
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
}

impl LongSighting {
    /// The cells within [`MAX_RADIUS`].
    pub fn near(&self) -> Sighting {
        const BY: usize = (MAX_LONG_RADIUS - MAX_RADIUS) as usize;
        let mut near = Sighting::new(self.centre);
        let part = |to: &mut [u32], from: &[u64]| {
            for (to, from) in to.iter_mut().zip(from.iter().skip(BY)) {
                *to = (from >> BY) as u32 & Sighting::whole();
            }
        };
        part(&mut near.free, &self.free);
        part(&mut near.blocked, &self.blocked);
        part(&mut near.firm, &self.firm);
        near
    }

    /// The cells seen beyond [`MAX_RADIUS`]: of each tile those free and those blocked. At
    /// most 81 tiles. Work: 16 rows a tile.
    pub fn far_tiles(&self) -> impl Iterator<Item = (TileIndex, u64, u64)> + '_ {
        self.tiles().filter_map(move |at| {
            let near = at.near(self.centre, MAX_RADIUS);
            let (free, blocked) = self.tile(at);
            let (free, blocked) = (free & !near, blocked & !near);
            (free | blocked != 0).then_some((at, free, blocked))
        })
    }
}

impl<R: Row, const SPAN: usize> Look<R, SPAN> {
    const RADIUS: usize = {
        assert!(
            SPAN % 2 == 1 && SPAN < R::BITS as usize && SPAN < u8::MAX as usize,
            "a row of a look has an odd number of columns, and fits its bits"
        );
        SPAN / 2
    };

    /// Nothing seen yet but the cell that the robot stands on, which is free.
    pub fn new(centre: Cell) -> Self {
        let mut free = [R::NONE; SPAN];
        if let Some(row) = free.get_mut(Self::RADIUS) {
            *row = Self::own();
        }
        Self {
            centre,
            free,
            blocked: [R::NONE; SPAN],
            firm: [R::NONE; SPAN],
        }
    }

    /// The bits of all columns.
    fn whole() -> R {
        !(R::ALL << SPAN as u32)
    }

    /// The bit of the robot's own column.
    fn own() -> R {
        R::FIRST << Self::RADIUS as u32
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
            *free |= bit & !*blocked;
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

    /// Adds cells of the row that lies `dy` below the robot's own, with its bits (of a
    /// [`Sighting`], bit `n` stands for the cell `n - 15` to the right), as by
    /// [`see_free`](Self::see_free) and [`see_blocked`](Self::see_blocked). Ignored beyond
    /// the radius.
    pub fn see_row(&mut self, dy: i16, free: R, blocked: R) {
        let Some(row) = Self::row_of(dy) else { return };
        let own = if dy == 0 { Self::own() } else { R::NONE };
        let blocked_now = Self::whole() & blocked & !own;
        if let (Some(free_row), Some(blocked_row), Some(firm)) = (
            self.free.get_mut(row),
            self.blocked.get_mut(row),
            self.firm.get_mut(row),
        ) {
            *firm |= *blocked_row & blocked_now;
            *blocked_row |= blocked_now;
            *free_row = (*free_row | Self::whole() & free) & !*blocked_row;
        }
    }

    /// The cells seen free in the row that lies `dy` below the robot's own, in the bits of
    /// [`see_row`](Self::see_row).
    pub fn free_row(&self, dy: i16) -> R {
        let row = Self::row_of(dy).and_then(|row| self.free.get(row));
        row.copied().unwrap_or(R::NONE)
    }

    /// Blocked wins, also where cells were seen free past [`see_free`](Self::see_free).
    fn settle(&mut self) {
        for (free, blocked) in self.free.iter_mut().zip(&self.blocked) {
            *free &= Self::whole() & !*blocked;
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

    fn has(&self, cell: Cell, rows: &[R; SPAN]) -> bool {
        self.place(cell)
            .is_some_and(|(row, bit)| rows.get(row).is_some_and(|row| *row & bit != R::NONE))
    }

    /// The cells seen free, row by row. At most 961 of a [`Sighting`].
    pub fn free_cells(&self) -> impl Iterator<Item = Cell> + '_ {
        self.cells(&self.free)
    }

    /// The cells seen blocked, row by row. At most 960 of a [`Sighting`].
    pub fn blocked_cells(&self) -> impl Iterator<Item = Cell> + '_ {
        self.cells(&self.blocked)
    }

    fn cells<'a>(&'a self, rows: &'a [R; SPAN]) -> impl Iterator<Item = Cell> + 'a {
        let corner = self.corner();
        rows.iter().zip(0i16..).flat_map(move |(&row, dy)| {
            crate::tile::bits(row.into()).map(move |dx| {
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
            self.centre.x.saturating_sub(Self::RADIUS as i16),
            self.centre.y.saturating_sub(Self::RADIUS as i16),
        )
    }

    fn place(&self, cell: Cell) -> Option<(usize, R)> {
        let (x, y) = self.corner();
        let column = u8::try_from(i32::from(cell.x) - i32::from(x)).ok()?;
        let row = usize::try_from(i32::from(cell.y) - i32::from(y)).ok()?;
        (usize::from(column) < SPAN && row < SPAN).then(|| (row, R::FIRST << u32::from(column)))
    }

    /// The block of tiles that holds all cells seen: its corner in tiles, and its side,
    /// at most five, or nine of a [`LongSighting`].
    fn tile_block(&self) -> ((i16, i16), u8) {
        // The robot's own cell is among them.
        let (mut columns, mut rows) = (Self::own(), Self::own());
        for ((free, blocked), row) in self.free.iter().zip(&self.blocked).zip(0u32..) {
            columns |= *free | *blocked;
            if *free | *blocked != R::NONE {
                rows |= R::FIRST << row;
            }
        }
        let (x, y) = self.corner();
        let tiles = |corner: i16, seen: R| {
            let tile = |bit: u32| corner.saturating_add(bit as i16) >> 3;
            (tile(seen.first()), tile(seen.last()))
        };
        let ((west, east), (north, south)) = (tiles(x, columns), tiles(y, rows));
        let side = 1 + (east - west).max(south - north);
        ((west, north), side as u8)
    }

    /// The tiles that hold cells seen, at most 25, or 81 of a [`LongSighting`].
    pub(crate) fn tiles(&self) -> impl Iterator<Item = TileIndex> + use<R, SPAN> {
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

    fn in_tile(&self, at: TileIndex, rows: &[R; SPAN]) -> u64 {
        let (x, y) = self.corner();
        let dx = i32::from(at.x) * TILE as i32 - i32::from(x);
        let dy = i32::from(at.y) * TILE as i32 - i32::from(y);
        let mut cells = 0;
        for row in 0..TILE as i32 {
            if let Ok(index) = usize::try_from(dy + row)
                && let Some(&seen) = rows.get(index)
            {
                cells |= u64::from(seen.byte_at(dx)) << (row * TILE as i32);
            }
        }
        cells
    }

    /// The index of the row `dy` below the robot's own.
    fn row_of(dy: i16) -> Option<usize> {
        let row = usize::try_from(i32::from(dy) + Self::RADIUS as i32).ok()?;
        (row < SPAN).then_some(row)
    }
}

#[cfg(test)]
mod tests;
