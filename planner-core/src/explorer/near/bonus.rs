//! What frontier cells far from all visited ones are worth.

use super::{LARGEST_BONUS, all_if};
use crate::explorer::window::{Rows, SIDE};

/// How far every cell of the window is from the visited ones: 1 to 8, less one, a
/// bit a plane.
pub(crate) struct Bonus([Rows; 3]);

impl Bonus {
    /// 1 + the number of times that the visited cells can grow, by 4 and by 8
    /// neighbours in turn (so in octagons, within 6 % of Euclidean distance),
    /// before they cover a cell; at most 8.
    pub(super) fn of(visited: Rows) -> Self {
        let mut near = visited;
        let mut planes = [[0; SIDE]; 3];
        for growth in 0..LARGEST_BONUS - 1 {
            let every_second = all_if(growth % 2 == 1);
            let every_fourth = all_if(growth % 4 == 3);
            let mut above = 0;
            for y in 0..SIDE {
                let row = near.get(y).copied().unwrap_or(0);
                let below = near.get(y + 1).copied().unwrap_or(0);
                let grown = if growth % 2 == 0 {
                    row | row << 1 | row >> 1 | above | below
                } else {
                    let column = row | above | below;
                    column | column << 1 | column >> 1
                };
                above = row;
                if let Some(row) = near.get_mut(y) {
                    *row = grown;
                }
                // Counts how often a cell is not covered, which it never is again.
                let left = !grown;
                let [ones, twos, fours] = &mut planes;
                if let (Some(ones), Some(twos), Some(fours)) =
                    (ones.get_mut(y), twos.get_mut(y), fours.get_mut(y))
                {
                    *ones ^= left;
                    *twos ^= left & every_second;
                    *fours ^= left & every_fourth;
                }
            }
        }
        Self(planes)
    }

    pub(super) fn at(&self, row: usize, column: u32) -> i32 {
        let mut bonus = 1;
        for (plane, value) in self.0.iter().zip([1, 2, 4]) {
            if get(plane, row, column) {
                bonus += value;
            }
        }
        bonus
    }

    /// The largest of some cells of a row, and those that have it.
    pub(super) fn largest(&self, row: usize, mut cells: u32) -> (i32, u32) {
        let [ones, twos, fours] = &self.0;
        let mut bonus = 1;
        for (plane, value) in [(fours, 4), (twos, 2), (ones, 1)] {
            let have = cells & plane.get(row).copied().unwrap_or(0);
            if have != 0 {
                cells = have;
                bonus += value;
            }
        }
        (bonus, cells)
    }
}

fn get(rows: &Rows, row: usize, column: u32) -> bool {
    rows.get(row).is_some_and(|row| row >> column & 1 == 1)
}
