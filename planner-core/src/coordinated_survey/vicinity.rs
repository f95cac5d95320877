//! The unknown surface around a robot, a row to a word, for counting what a flight
//! would show.

use crate::cell::Cell;
use crate::math;
use crate::point::Point;
use crate::surface::Surface;
use crate::tile::TileIndex;

/// Rows, and columns of a row. Flights are judged as far as this reaches: at least
/// 27 columns to each side, and one more whose rim is not exact.
const SIDE: usize = 64;
const _: () = assert!(SIDE == u64::BITS as usize, "a row of the vicinity is a u64");

/// Unknown columns of one row, from west to east.
#[derive(Clone, Copy, Debug, Default)]
struct Row {
    unknown: u64,
    /// Those of them that have a neighbour that is known or outside.
    rim: u64,
}

/// What a place shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Shown {
    /// Unknown columns.
    pub(super) columns: u32,
    /// Those of them that lie along known surface or the border.
    pub(super) rim: u32,
}

/// The unknown columns around a place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vicinity {
    /// North-west column.
    origin: Cell,
    rows: [Row; SIDE],
}

impl Vicinity {
    /// Cost: 512 tile words read.
    pub(super) fn new<const TW: usize, const TH: usize>(
        surface: &Surface<TW, TH>,
        centre: Point,
    ) -> Self {
        let cell = centre.cell();
        // Starts with a column of tiles, so that a byte of a tile is a byte of a row.
        let origin = Cell::new(cell.x.saturating_sub(28) & !7, cell.y.saturating_sub(32));
        let mut unknown = [0u64; SIDE];
        for (y, row) in (0i16..).zip(&mut unknown) {
            for byte in 0..8i16 {
                let cell = Cell::new(
                    origin.x.saturating_add(8 * byte),
                    origin.y.saturating_add(y),
                );
                let shown = TileIndex::of(cell).map_or(0, |(tile, first)| {
                    surface.unknown(tile) >> first.trailing_zeros() & 0xff
                });
                *row |= shown << (8 * byte);
            }
        }
        let mut rows = unknown.map(|unknown| Row { unknown, rim: 0 });
        for (row, around) in rows.iter_mut().skip(1).zip(unknown.windows(3)) {
            if let &[north, here, south] = around {
                row.rim = here & !(here << 1 & here >> 1 & north & south);
            }
        }
        Self { origin, rows }
    }

    /// Leaves out the columns that are nearer to `rival` than to `here`.
    ///
    /// Cost: 64 rows.
    pub(super) fn leave_to(&mut self, rival: Point, here: Point) {
        let (dx, dy) = (here.x - rival.x, here.y - rival.y);
        // In each row the rival's part is everything on one side of the bisector.
        let (middle_x, middle_y) = (0.5 * (here.x + rival.x), 0.5 * (here.y + rival.y));
        for (y, row) in (0u8..).zip(&mut self.rows) {
            let centre_y = f32::from(self.origin.y) + f32::from(y) + 0.5;
            let across = (centre_y - middle_y) * dy;
            let rivals = if math::length(dx, 0.0) < 1e-6 {
                if across < 0.0 { !0 } else { 0 }
            } else {
                let border = middle_x - across / dx - f32::from(self.origin.x) - 0.5;
                let west = first_bits(math::floor(border.clamp(-1.0, 64.0)) + 1.0);
                if dx > 0.0 { west } else { !west }
            };
            row.unknown &= !rivals;
            row.rim &= !rivals;
        }
    }

    /// Takes out the columns within `radius` of `centre` and counts them.
    ///
    /// Cost: 2·`radius` rows.
    pub(super) fn take_disc(&mut self, centre: Point, radius: f32) -> Shown {
        let x = centre.x - f32::from(self.origin.x) - 0.5;
        let y = centre.y - f32::from(self.origin.y) - 0.5;
        let first = math::floor(y - radius).max(0.0) as usize;
        let number = math::floor(2.0 * radius) as usize + 3;
        let mut shown = Shown::default();
        for (row_y, row) in (0u8..).zip(&mut self.rows).skip(first).take(number) {
            let dy = f32::from(row_y) - y;
            let rest = radius * radius - dy * dy;
            if rest < 0.0 {
                continue;
            }
            let half = math::sqrt(rest);
            let east_of = first_bits(math::floor(x - half) + 1.0);
            let disc = first_bits(math::floor(x + half) + 1.0) & !east_of;
            shown.columns += (row.unknown & disc).count_ones();
            shown.rim += (row.rim & disc).count_ones();
            row.unknown &= !disc;
            row.rim &= !disc;
        }
        shown
    }
}

/// A word with the lowest `number` bits set.
fn first_bits(number: f32) -> u64 {
    let number = number.clamp(0.0, 64.0) as u32;
    1u64.checked_shl(number).map_or(!0, |bit| bit - 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cell::Extent;
    use crate::surface::{Column, Height};
    use proptest::prelude::*;
    use std::vec::Vec;

    const EXTENT: Extent = Extent::new(60, 50);

    fn unknown_cells(surface: &Surface<8, 8>) -> Vec<Cell> {
        (0..50)
            .flat_map(|y| (0..60).map(move |x| Cell::new(x, y)))
            .filter(|&cell| surface.is_unknown(cell))
            .collect()
    }

    proptest! {
        /// Against a look at every column.
        #[test]
        fn counts_what_a_scan_counts(
            known in prop::collection::vec((0i16..60, 0i16..50), 0..400),
            here in (20.0f32..36.0, 15.0f32..35.0),
            rival in (0.0f32..60.0, 0.0f32..50.0),
            disc in (-18.0f32..18.0, -18.0f32..18.0, 0.5f32..9.0),
        ) {
            let mut surface = Surface::<8, 8>::new(EXTENT).unwrap();
            for (x, y) in known {
                surface.learn(Column { cell: Cell::new(x, y), height: Height(0) });
            }
            let (here, rival) = (Point::new(here.0, here.1, 0.0), Point::new(rival.0, rival.1, 0.0));
            let (centre, radius) = (Point::new(here.x + disc.0, here.y + disc.1, 0.0), disc.2);
            let mut vicinity = Vicinity::new(&surface, here);
            vicinity.leave_to(rival, here);
            // What rounding may decide either way lies between these two.
            let seen = |slack: f32| {
                let mine: Vec<Cell> = unknown_cells(&surface)
                    .into_iter()
                    .filter(|&cell| {
                        let at = Point::over(cell, 0.0);
                        at.plan_distance(centre) <= radius + slack
                            && at.plan_distance(here) <= at.plan_distance(rival) + slack
                    })
                    .collect();
                let rim = mine.iter().filter(|&&cell| {
                    crate::cell::Direction::ALL.iter().any(|&d| !surface.is_unknown(cell.step(d)))
                });
                Shown { columns: mine.len() as u32, rim: rim.count() as u32 }
            };
            let (least, most) = (seen(-1e-4), seen(1e-4));
            let found = vicinity.take_disc(centre, radius);
            prop_assert!((least.columns..=most.columns).contains(&found.columns), "{found:?} {least:?} {most:?}");
            prop_assert!((least.rim..=most.rim).contains(&found.rim), "{found:?} {least:?} {most:?}");
            prop_assert_eq!(vicinity.take_disc(centre, radius), Shown::default());
        }
    }
}
