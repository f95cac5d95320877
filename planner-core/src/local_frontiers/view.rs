//! What is in view, as rows of bits, and waves through it.
//!
//! A row of a window holds 31 cells, bit 15 the one in the column of the centre.
//! Waves advance by whole rows, layer by layer: exact shortest ways, without a
//! queue.

use crate::cell::{Cell, Direction};
use crate::map::{Map, Tile};
use crate::sight::{MAX_RADIUS, Sighting};
use crate::tile::{TileIndex, bits};

use super::config::{Distance, Neighbourhood};

const RADIUS: i16 = MAX_RADIUS as i16;
/// Rows and columns of a window.
pub(super) const SPAN: usize = 2 * MAX_RADIUS as usize + 1;
const _: () = assert!(
    SPAN <= u32::BITS as usize && SPAN + 2 <= u64::BITS as usize,
    "a row of a window is a u32, and with a cell more at each end a u64"
);
/// The 31 bits of a row that are cells.
const COLUMNS: u64 = (1 << SPAN) - 1;
/// How far the search for visited cells goes beyond a frontier cell. The robot's
/// previous cell lies within this of anything in view.
pub(super) const REACH: usize = MAX_RADIUS as usize + 1;

pub(super) type Rows = [u32; SPAN];

/// The free cells of the last sighting. 128 bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct View {
    centre: Cell,
    free: Rows,
}

impl View {
    /// Nothing in view.
    pub(super) const fn vacant() -> Self {
        Self {
            centre: Cell::new(0, 0),
            free: [0; SPAN],
        }
    }

    pub(super) fn of(sighting: &Sighting) -> Self {
        let mut view = Self {
            centre: sighting.centre(),
            free: [0; SPAN],
        };
        for cell in sighting.free_cells() {
            set(&mut view.free, place(view.centre, cell));
        }
        view
    }
}

/// The cells in view that can be walked, for one decision, and the work spent on it.
pub(super) struct Window {
    centre: Cell,
    open: Rows,
    /// First row with a cell, and the number of rows up to the last one.
    first: usize,
    rows: usize,
    /// Rows worked on so far.
    pub(super) work: u32,
}

impl Window {
    /// Cells that are in view and free on the map, without those in `closed`; and
    /// the robot's own.
    pub(super) fn new<const TW: usize, const TH: usize>(
        view: &View,
        map: &Map<TW, TH>,
        closed: impl Iterator<Item = Cell>,
        own: Cell,
    ) -> Self {
        let mut window = Self {
            centre: view.centre,
            open: view.free,
            first: 0,
            rows: 0,
            work: 0,
        };
        for cell in closed {
            if let Some((row, bit)) = place(window.centre, cell)
                && let Some(open) = window.open.get_mut(row)
            {
                *open &= !bit;
            }
        }
        set(&mut window.open, place(window.centre, own));
        window.first = window.open.iter().take_while(|&&row| row == 0).count();
        let end = window.open.iter().rposition(|&row| row != 0);
        window.rows = end.map_or(0, |last| last + 1 - window.first);
        for (row, y) in window.numbered_rows() {
            let obstacle = row_of(map, window.corner(0, y), Tile::obstacle);
            if let Some(open) = window.open.get_mut(row) {
                *open &= !(obstacle as u32);
            }
        }
        set(&mut window.open, place(window.centre, own));
        window.count_rows();
        window
    }

    /// Whether the cell is in view and can be walked.
    pub(super) fn is_open(&self, cell: Cell) -> bool {
        is_set(&self.open, place(self.centre, cell))
    }

    /// Every cell of the window that can be walked.
    pub(super) const fn open(&self) -> Rows {
        self.open
    }

    /// The local frontiers: open cells with an unknown neighbour.
    pub(super) fn frontiers<const TW: usize, const TH: usize>(
        &mut self,
        map: &Map<TW, TH>,
        neighbourhood: Neighbourhood,
    ) -> Rows {
        let mut frontiers = [0; SPAN];
        // Bit 0 is one column west of the window.
        let unknown = |y| row_of(map, self.corner(-1, y), |tile| !tile.known());
        let top = self.first as i16 - RADIUS;
        let (mut above, mut here) = (unknown(top - 1), unknown(top));
        for (row, y) in self.numbered_rows() {
            let below = unknown(y + 1);
            let vertical = above | below;
            let mut beside = here | here >> 2 | vertical >> 1;
            if neighbourhood == Neighbourhood::Eight {
                beside |= vertical | vertical >> 2;
            }
            if let (Some(frontier), Some(open)) = (frontiers.get_mut(row), self.open.get(row)) {
                *frontier = open & (beside & COLUMNS) as u32;
            }
            (above, here) = (here, below);
        }
        self.work += 2;
        self.count_rows();
        frontiers
    }

    /// Of the `candidates` connected to `from` through open cells one with the
    /// highest score. `from` itself is none. Among n equals, in order of the
    /// length of the way, then by rows from the north, each from the west, it is
    /// number `turn` modulo n: robots in one place with different turns part.
    pub(super) fn best_reached(
        &mut self,
        from: Cell,
        candidates: &Rows,
        turn: u8,
        mut score: impl FnMut(Cell) -> u32,
    ) -> Option<Cell> {
        let mut first = None;
        let mut highest = 0;
        let mut equals = [0; SPAN];
        self.for_each_reached(from, candidates, |cell, place| {
            let score = score(cell);
            if first.is_none() || score > highest {
                (first, highest, equals) = (Some(cell), score, [0; SPAN]);
            }
            if score == highest {
                set(&mut equals, Some(place));
            }
            true
        });
        let count = equals.iter().map(|row| row.count_ones()).sum();
        let mut left = u32::from(turn).checked_rem(count)?;
        if left > 0 {
            self.for_each_reached(from, &equals, |cell, _| {
                first = Some(cell);
                let go_on = left > 0;
                left = left.saturating_sub(1);
                go_on
            });
        }
        first
    }

    /// The first step of a shortest way through open cells; among equals in the
    /// order of [`Direction::ALL`]. A wave from the far end, so that nothing but
    /// its reach need be stored.
    pub(super) fn first_step(&mut self, from: Cell, to: Cell) -> Option<Direction> {
        let mut wave = Wave::new(self.centre, to);
        loop {
            let step = Direction::ALL
                .into_iter()
                .find(|&direction| is_set(&wave.reached, place(self.centre, from.step(direction))));
            if step.is_some() || !self.advance(&mut wave) {
                return step;
            }
        }
    }

    /// Visits the candidates that a wave from `from` reaches, nearest first, each
    /// with its place, until `visit` says no.
    fn for_each_reached(
        &mut self,
        from: Cell,
        candidates: &Rows,
        mut visit: impl FnMut(Cell, (usize, u32)) -> bool,
    ) {
        let mut wave = Wave::new(self.centre, from);
        while self.advance(&mut wave) {
            for (row, y) in self.numbered_rows() {
                let (Some(fresh), Some(candidate)) = (wave.fresh.get(row), candidates.get(row))
                else {
                    continue;
                };
                for column in bits(u64::from(fresh & candidate)) {
                    if !visit(self.corner(column as i16, y), (row, 1 << column)) {
                        return;
                    }
                }
            }
        }
    }

    /// Advances a wave by one step; false when it has ended.
    fn advance(&mut self, wave: &mut Wave) -> bool {
        let before = wave.fresh;
        let row_at = |row: usize| before.get(row).copied().unwrap_or(0);
        let mut any = 0;
        let rows = wave.fresh.iter_mut().zip(&mut wave.reached);
        let rows = rows.zip(&self.open).enumerate();
        for (row, ((fresh, reached), open)) in rows.skip(self.first).take(self.rows) {
            let spread = *fresh << 1 | *fresh >> 1 | row_at(row.wrapping_sub(1)) | row_at(row + 1);
            *fresh = spread & open & !*reached;
            *reached |= *fresh;
            any |= *fresh;
        }
        self.count_rows();
        any != 0
    }

    /// The visited cells in and around the window.
    pub(super) fn visited<const TW: usize, const TH: usize>(
        &mut self,
        map: &Map<TW, TH>,
    ) -> Visited {
        let reach = REACH as i16;
        let mut rows = [0; SPAN + 2 * REACH];
        let used = rows.iter_mut().zip(-RADIUS - reach..);
        for (row, y) in used.skip(self.first).take(self.rows + 2 * REACH) {
            *row = row_of(map, self.corner(-reach, y), Tile::visited);
        }
        self.work += 2 * REACH as u32;
        self.count_rows();
        Visited {
            corner: self.corner(-reach, -RADIUS - reach),
            rows,
        }
    }

    /// The rows that hold cells, as `(row, y - centre.y)`.
    fn numbered_rows(&self) -> impl Iterator<Item = (usize, i16)> + use<> {
        (0..SPAN).zip(-RADIUS..).skip(self.first).take(self.rows)
    }

    /// The cell in column `column` of the row `y` cells below the centre.
    fn corner(&self, column: i16, y: i16) -> Cell {
        Cell::new(
            self.centre.x.saturating_add(column - RADIUS),
            self.centre.y.saturating_add(y),
        )
    }

    fn count_rows(&mut self) {
        self.work += self.rows as u32;
    }
}

/// Cells reached so far, and those reached last.
struct Wave {
    reached: Rows,
    fresh: Rows,
}

impl Wave {
    fn new(centre: Cell, from: Cell) -> Self {
        let mut reached = [0; SPAN];
        set(&mut reached, place(centre, from));
        Self {
            reached,
            fresh: reached,
        }
    }
}

/// Visited cells around a window: 63 rows of 63 bits. 512 bytes.
pub(super) struct Visited {
    corner: Cell,
    rows: [u64; SPAN + 2 * REACH],
}

impl Visited {
    /// The distance from a cell of the window to the nearest visited cell; where
    /// that is more than 16 columns or rows away, more than any other.
    /// Work: at most 33 rows, which are added to `work`.
    pub(super) fn distance(&self, cell: Cell, distance: Distance, work: &mut u32) -> u32 {
        let column = cell.x.abs_diff(self.corner.x) as u32 & 63;
        let row = usize::from(cell.y.abs_diff(self.corner.y));
        let mut nearest = u32::MAX;
        for dy in 0..=REACH {
            if distance.measure(0, dy as u32) >= nearest {
                break;
            }
            let north = row.checked_sub(dy).and_then(|row| self.rows.get(row));
            let south = self.rows.get(row + dy);
            for &visited in north.into_iter().chain(south) {
                let east = (visited >> column).trailing_zeros();
                let west = (visited << (63 - column)).leading_zeros();
                let dx = east.min(west);
                if dx as usize <= REACH {
                    nearest = nearest.min(distance.measure(dx, dy as u32));
                }
                *work += 1;
            }
        }
        nearest
    }
}

/// 64 cells of one layer of the map from `west` on, the westernmost in bit 0.
/// Work: nine tiles.
fn row_of<const TW: usize, const TH: usize>(
    map: &Map<TW, TH>,
    west: Cell,
    layer: impl Fn(Tile) -> u64,
) -> u64 {
    let mut row = 0u128;
    for column in 0..9u8 {
        let x = (west.x >> 3).saturating_add(i16::from(column));
        let tile = match (u8::try_from(x), u8::try_from(west.y >> 3)) {
            (Ok(x), Ok(y)) => map.tile(TileIndex::new(x, y)),
            _ => Tile::OUTSIDE,
        };
        let eight = layer(tile) >> ((west.y & 7) * 8) & 0xff;
        row |= u128::from(eight) << (8 * column);
    }
    (row >> (west.x & 7)) as u64
}

/// Row and bit of a cell in a window around `centre`.
fn place(centre: Cell, cell: Cell) -> Option<(usize, u32)> {
    let column = i32::from(cell.x) - i32::from(centre.x) + i32::from(RADIUS);
    let row = i32::from(cell.y) - i32::from(centre.y) + i32::from(RADIUS);
    let inside = 0..SPAN as i32;
    (inside.contains(&column) && inside.contains(&row)).then(|| (row as usize, 1 << column))
}

fn set(rows: &mut Rows, place: Option<(usize, u32)>) {
    if let Some((row, bit)) = place
        && let Some(row) = rows.get_mut(row)
    {
        *row |= bit;
    }
}

fn is_set(rows: &Rows, place: Option<(usize, u32)>) -> bool {
    place.is_some_and(|(row, bit)| rows.get(row).is_some_and(|row| row & bit != 0))
}
