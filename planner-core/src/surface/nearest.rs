//! Tiles with frontiers, found without a look at every tile.

use heapless::Vec;

use super::Surface;
use crate::cell::Cell;
use crate::list;
use crate::math;
use crate::point::Point;
use crate::tile::{TileIndex, bits};

impl<const TW: usize, const TH: usize> Surface<TW, TH> {
    /// The `N` tiles with frontiers that are nearest to `from` on the ground plan,
    /// nearest first; and the number of words and tiles looked at.
    ///
    /// Cost: rows of tiles outwards from `from` until none can be nearer, one word
    /// each, and at most 2·`N` tiles in each.
    pub fn nearest_frontier_tiles<const N: usize>(&self, from: Point) -> (Vec<TileIndex, N>, u32) {
        let mut found: Vec<(f32, TileIndex), N> = Vec::new();
        let mut work = 0;
        let here = from.cell();
        let column = (here.x.max(0) >> 3).min(63) as u8;
        let row = (here.y.max(0) >> 3).min(TH.saturating_sub(1) as i16) as u8;
        for away in 0..TH as u8 {
            let before = row.checked_sub(away);
            let behind = row.checked_add(away).filter(|&y| away > 0 && y < TH as u8);
            let rows = [before, behind].into_iter().flatten();
            if found.is_full()
                && rows
                    .clone()
                    .all(|y| distance_to_row(from, y) >= farthest(&found))
            {
                break;
            }
            for y in rows {
                work += 1;
                let word = self.frontier_tiles.row(y);
                let east = word.checked_shr(u32::from(column)).unwrap_or(0);
                let west = word & !(u64::MAX.checked_shl(u32::from(column)).unwrap_or(0));
                let to_east = bits(east).map(|bit| column.saturating_add(bit as u8));
                let to_west = bits(west.reverse_bits()).map(|bit| 63 - bit as u8);
                for x in to_east.take(N) {
                    work += 1;
                    let tile = TileIndex { x, y };
                    if !list::keep_least(&mut found, distance_to_tile(from, tile), tile) {
                        break;
                    }
                }
                for x in to_west.take(N) {
                    work += 1;
                    let tile = TileIndex { x, y };
                    if !list::keep_least(&mut found, distance_to_tile(from, tile), tile) {
                        break;
                    }
                }
            }
        }
        (list::collect(found.iter().map(|&(_, tile)| tile)), work)
    }

    /// The first tile with frontiers behind `tile`, row by row and round again.
    ///
    /// Cost: a word for each row.
    pub fn next_frontier_tile(&self, tile: TileIndex) -> Option<TileIndex> {
        self.frontier_tiles.after(tile)
    }
}

fn farthest<const N: usize>(found: &Vec<(f32, TileIndex), N>) -> f32 {
    found
        .last()
        .map_or(f32::INFINITY, |&(distance, _)| distance)
}

fn distance_to_row(from: Point, y: u8) -> f32 {
    let first = f32::from(TileIndex { x: 0, y }.cell(0).y) + 0.5;
    (first - from.y).max(from.y - first - 7.0).max(0.0)
}

/// Distance on the plan from `from` to the nearest cell centre that `tile` can have.
pub(crate) fn distance_to_tile(from: Point, tile: TileIndex) -> f32 {
    let (north_west, south_east): (Cell, Cell) = (tile.cell(0), tile.cell(63));
    let beside = |at: f32, low: i16, high: i16| {
        (f32::from(low) + 0.5 - at)
            .max(at - f32::from(high) - 0.5)
            .max(0.0)
    };
    math::length(
        beside(from.x, north_west.x, south_east.x),
        beside(from.y, north_west.y, south_east.y),
    )
}
