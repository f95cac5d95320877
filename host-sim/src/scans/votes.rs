//! The vote of all beams of a log: what the place was like, as far as its scans tell.

use planner_core::{Cell, Extent};

use super::line::line;
use crate::world::index;

/// A hit this near to the border between two cells, in cells, is on it: the surface of
/// what stands behind. Logs are written in millimetres.
const SURFACE: f64 = 0.01;

/// What the beams say of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Fewer than 3 beams crossed or hit it.
    Unknown,
    /// Fewer than 20 % of them hit it.
    Open,
    /// Some hit it.
    Unclear,
    /// At least 3 hit it, and at least 50 % of all.
    Wall,
}

/// Beams that crossed and hit each cell.
pub(super) struct Votes {
    extent: Extent,
    crossed: Vec<u32>,
    hit: Vec<u32>,
}

impl Votes {
    pub(super) fn new(extent: Extent) -> Self {
        let none = vec![0; extent.cells() as usize];
        Self {
            extent,
            crossed: none.clone(),
            hit: none,
        }
    }

    /// Counts a beam from a place in a direction: it crosses the cells that it leaves, and
    /// hits the one it ends in, if it `hit` anything.
    pub(super) fn count(&mut self, from: (f64, f64), angle: f64, length: f64, hit: bool) {
        let length = if hit { length + SURFACE } else { length };
        for (cell, left) in line(from, angle) {
            let ends = left >= length;
            if !ends || hit {
                self.add(cell, ends);
            }
            if ends {
                break;
            }
        }
    }

    fn add(&mut self, cell: Cell, hit: bool) {
        if self.extent.contains(cell) {
            let index = index(self.extent, cell);
            let votes = if hit {
                &mut self.hit
            } else {
                &mut self.crossed
            };
            votes[index] += 1;
        }
    }

    /// What the beams say of a cell of the extent.
    pub(super) fn verdict(&self, cell: Cell) -> Verdict {
        let index = index(self.extent, cell);
        let (crossed, hit) = (u64::from(self.crossed[index]), u64::from(self.hit[index]));
        match crossed + hit {
            0..3 => Verdict::Unknown,
            all if 5 * hit < all => Verdict::Open,
            _ if hit >= 3 && hit >= crossed => Verdict::Wall,
            _ => Verdict::Unclear,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn beams_cross_what_they_leave_and_hit_where_they_end() {
        let extent = Extent::new(6, 3);
        let mut votes = Votes::new(extent);
        for _ in 0..4 {
            votes.count((0.5, 1.5), 0.0, 3.0, true);
        }
        for _ in 0..2 {
            votes.count((0.5, 1.5), 0.1, 5.0, false);
        }
        let row = |y| -> String {
            let sign = |x| match votes.verdict(Cell::new(x, y)) {
                Verdict::Unknown => ' ',
                Verdict::Open => '.',
                Verdict::Unclear => '?',
                Verdict::Wall => '#',
            };
            (0..6).map(sign).collect()
        };
        assert_eq!(row(1), "...#  ");
        assert_eq!(row(0), "      ");
        votes.count((0.5, 1.5), 0.0, 5.0, false);
        votes.count((0.5, 1.5), 0.0, 5.0, false);
        votes.count((0.5, 1.5), 0.0, 5.0, false);
        // Four of nine.
        assert_eq!(votes.verdict(Cell::new(3, 1)), Verdict::Unclear);
        assert_eq!(votes.verdict(Cell::new(4, 1)), Verdict::Open);
    }
}
