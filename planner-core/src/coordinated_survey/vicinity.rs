//! The unknown surface around a robot, row by row in words, for counting what a
//! flight would show.

use crate::cell::Cell;
use crate::math;
use crate::point::Point;
use crate::surface::{Surface, Tile};

/// Columns and rows: four ranges of 8 to each side.
pub(super) const SIDE: usize = 64;

/// Unknown columns around a place, and which of them touch known ones.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vicinity {
    /// North-west column.
    origin: Cell,
    unknown: [u64; SIDE],
    rim: [u64; SIDE],
}

impl Vicinity {
    pub(super) fn new<const TW: usize, const TH: usize>(
        surface: &Surface<TW, TH>,
        centre: Point,
    ) -> Self {
        let cell = centre.cell();
        let origin = Cell::new((cell.x - 28) & !7, cell.y.saturating_sub(32));
        let mut unknown = [0u64; SIDE];
        let mut outside = [0u64; SIDE];
        for (y, (row, out)) in unknown.iter_mut().zip(outside.iter_mut()).enumerate() {
            for byte in 0..8 {
                let cell = Cell::new(origin.x + 8 * byte, origin.y + y as i16);
                let word = Tile::of(cell).map_or(0, |tile| surface.unknown(tile));
                let inside = Tile::of(cell).map_or(0, |tile| {
                    tile.inside(surface.extent().width, surface.extent().height)
                });
                let shift = Tile::bit(cell);
                *row |= (word >> shift & 0xff) << (8 * byte);
                *out |= (!(inside >> shift) & 0xff) << (8 * byte);
            }
        }
        let mut rim = [0u64; SIDE];
        for y in 1..SIDE - 1 {
            let closed = |y: usize| !unknown[y];
            let here = closed(y);
            rim[y] = unknown[y] & (here << 1 | here >> 1 | closed(y - 1) | closed(y + 1));
        }
        Self {
            origin,
            unknown,
            rim,
        }
    }

    /// Forgets the columns that are nearer to `rival` than to `here`.
    pub(super) fn leave_to(&mut self, rival: Point, here: Point, keep_rim: bool) {
        // |c - rival|² < |c - here|²  <=>  2 c·(here - rival) < |here|² - |rival|²
        let (dx, dy) = (here.x - rival.x, here.y - rival.y);
        let middle = Point::new(0.5 * (here.x + rival.x), 0.5 * (here.y + rival.y), 0.0);
        for y in 0..SIDE {
            let cy = f32::from(self.origin.y) + y as f32 + 0.5;
            let rest = (cy - middle.y) * dy;
            // dx (cx - mx) < -rest
            let mut mask = 0u64;
            if dx > -1e-6 && dx < 1e-6 {
                if rest < 0.0 {
                    mask = !0;
                }
            } else {
                let border = middle.x - rest / dx - f32::from(self.origin.x) - 0.5;
                let count = math::floor(border.clamp(-1.0, 64.0)) + 1.0;
                let count = (count.clamp(0.0, 64.0)) as u32;
                let low = if count >= 64 { !0 } else { (1u64 << count) - 1 };
                mask = if dx > 0.0 { low } else { !low };
            }
            self.unknown[y] &= !mask;
            if !keep_rim {
                self.rim[y] &= !mask;
            }
        }
    }

    /// Takes the columns within `radius` of `centre` out; gives their number, and
    /// how many of them are on the rim.
    pub(super) fn take_disc(&mut self, centre: Point, radius: f32) -> (u32, u32) {
        let (cx, cy) = (
            centre.x - f32::from(self.origin.x) - 0.5,
            centre.y - f32::from(self.origin.y) - 0.5,
        );
        let first = math::floor(cy - radius + 1.0).max(0.0) as usize;
        let last = math::floor(cy + radius).min(63.0);
        let (mut number, mut rim) = (0, 0);
        if last < 0.0 {
            return (0, 0);
        }
        for y in first..=last as usize {
            let dy = y as f32 - cy;
            let half = math::sqrt((radius * radius - dy * dy).max(0.0));
            let from = math::floor(cx - half + 1.0).clamp(0.0, 64.0) as u32;
            let to = (math::floor(cx + half) + 1.0).clamp(0.0, 64.0) as u32;
            if to <= from {
                continue;
            }
            let width = to - from;
            let mask = if width >= 64 {
                !0
            } else {
                ((1u64 << width) - 1) << from
            };
            number += (self.unknown[y] & mask).count_ones();
            rim += (self.rim[y] & mask).count_ones();
            self.unknown[y] &= !mask;
            self.rim[y] &= !mask;
        }
        (number, rim)
    }
}
