//! Straight lines through columns: sight and flight in 3-D.

use super::Height;
use crate::cell::Cell;
use crate::point::Point;

/// The part of a segment that lies in one column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// The column.
    pub cell: Cell,
    /// z where the segment enters it.
    pub entered: f32,
    /// z where the segment leaves it.
    pub left: f32,
}

/// The columns that a segment crosses, in order. Yields 1 + |Δcolumn| + |Δrow| items.
// [Amanatides1987]
#[derive(Clone, Debug)]
pub struct Columns {
    from: Point,
    to: Point,
    cell: Cell,
    /// Segment parameters at which the next column and row begin, and their period.
    next: (f32, f32),
    period: (f32, f32),
    step: (i16, i16),
    left: (u16, u16),
    entered: f32,
    done: bool,
}

impl Columns {
    /// The columns between two points with finite coordinates.
    pub fn new(from: Point, to: Point) -> Self {
        let (start, end) = (from.cell(), to.cell());
        let axis = |from: f32, to: f32, start: i16, end: i16| {
            let span = to - from;
            let border = if end > start {
                start as f32 + 1.0
            } else {
                start as f32
            };
            if start == end {
                (f32::INFINITY, f32::INFINITY)
            } else {
                ((border - from) / span, 1.0 / span.abs())
            }
        };
        let (next_x, period_x) = axis(from.x, to.x, start.x, end.x);
        let (next_y, period_y) = axis(from.y, to.y, start.y, end.y);
        Self {
            from,
            to,
            cell: start,
            next: (next_x, next_y),
            period: (period_x, period_y),
            step: (
                end.x.saturating_sub(start.x).signum(),
                end.y.saturating_sub(start.y).signum(),
            ),
            left: (start.x.abs_diff(end.x), start.y.abs_diff(end.y)),
            entered: from.z,
            done: false,
        }
    }

    fn height_at(&self, parameter: f32) -> f32 {
        self.from.z + (self.to.z - self.from.z) * parameter.clamp(0.0, 1.0)
    }
}

impl Iterator for Columns {
    type Item = Crossing;

    fn next(&mut self) -> Option<Self::Item> {
        if self.done {
            return None;
        }
        let cell = self.cell;
        let left = if self.left == (0, 0) {
            self.done = true;
            self.to.z
        } else if self.left.1 == 0 || (self.left.0 > 0 && self.next.0 <= self.next.1) {
            let height = self.height_at(self.next.0);
            self.next.0 += self.period.0;
            self.left.0 -= 1;
            self.cell.x = self.cell.x.saturating_add(self.step.0);
            height
        } else {
            let height = self.height_at(self.next.1);
            self.next.1 += self.period.1;
            self.left.1 -= 1;
            self.cell.y = self.cell.y.saturating_add(self.step.1);
            height
        };
        let entered = core::mem::replace(&mut self.entered, left);
        Some(Crossing {
            cell,
            entered,
            left,
        })
    }
}

/// Whether `eye` sees the point `target`: whether the straight line between them
/// passes over the ground that `height` gives. A column's height is that of its
/// centre, so the line is compared with it half-way through the column: on a slope
/// the ground between two centres is not a stair. Ground that `height` does not know
/// blocks.
///
/// Cost: one call of `height` for each column crossed.
// [Renzaglia2019 §3, O(s, P)]
pub fn in_sight(eye: Point, target: Point, mut height: impl FnMut(Cell) -> Option<Height>) -> bool {
    Columns::new(eye, target).all(|crossing| {
        let middle = 0.5 * (crossing.entered + crossing.left);
        height(crossing.cell).is_some_and(|ground| middle >= ground.cells())
    })
}

/// The least height over ground along the straight line between two points, or
/// `None` if it crosses ground that `height` does not know. The same from `to` to `from`, bit
/// for bit.
///
/// Cost: one call of `height` for each column crossed.
pub fn clearance(
    from: Point,
    to: Point,
    mut height: impl FnMut(Cell) -> Option<Height>,
) -> Option<f32> {
    let is_forward = (from.x, from.y, from.z) <= (to.x, to.y, to.z);
    let (first, last) = if is_forward { (from, to) } else { (to, from) };
    let mut least = f32::INFINITY;
    for crossing in Columns::new(first, last) {
        let low = crossing.entered.min(crossing.left);
        least = least.min(low - height(crossing.cell)?.cells());
    }
    Some(least)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math;
    use proptest::prelude::*;
    use std::vec::Vec;

    fn point() -> impl Strategy<Value = Point> {
        (0.0f32..20.0, 0.0f32..20.0, 0.0f32..20.0).prop_map(|(x, y, z)| Point::new(x, y, z))
    }

    proptest! {
        /// Against a walk in 10,000 small steps: every column of it is yielded, in a
        /// chain of 4-neighbours from end to end, and never with a height too large.
        #[test]
        fn crosses_what_a_slow_walk_crosses(from in point(), to in point()) {
            let columns: Vec<_> = Columns::new(from, to).collect();
            prop_assert_eq!(columns.first().unwrap().cell, from.cell());
            prop_assert_eq!(columns.last().unwrap().cell, to.cell());
            for pair in columns.windows(2) {
                prop_assert_eq!(pair[0].cell.distance_squared(pair[1].cell), 1);
            }
            let near_border = |v: f32| (v - math::floor(v + 0.5)).abs() < 1e-3;
            for i in 0..=10_000 {
                let t = i as f32 / 10_000.0;
                let at = from.offset((to.x - from.x) * t, (to.y - from.y) * t, (to.z - from.z) * t);
                if near_border(at.x) || near_border(at.y) {
                    continue;
                }
                let found = columns.iter().find(|crossing| crossing.cell == at.cell());
                prop_assert!(
                    found.is_some_and(|crossing| {
                        let (low, high) = (crossing.entered.min(crossing.left), crossing.entered.max(crossing.left));
                        low <= at.z + 1e-3 && at.z <= high + 1e-3
                    }),
                    "{:?} {:?}", at, found
                );
            }
        }
    }

    proptest! {
        /// Whoever flew somewhere may fly back: at corners of columns, too.
        #[test]
        fn clearance_is_the_same_both_ways(
            (from, to) in prop_oneof![
                (point(), point()),
                prop::array::uniform6(0u8..40).prop_map(|of| {
                    let [a, b, c, d, e, f] = of.map(|it| f32::from(it) * 0.5);
                    (Point::new(a, b, c), Point::new(d, e, f))
                }),
            ],
            heights in prop::collection::vec(prop::option::weighted(0.98, 0u8..40), 441),
        ) {
            let ground = |cell: Cell| heights.get(cell.y as usize * 21 + cell.x as usize)?.map(Height);
            prop_assert_eq!(clearance(from, to, ground), clearance(to, from, ground));
        }

        /// A sensor that looks down misses nothing of a surface: no column whose top is higher
        /// than the eye is in sight.
        #[test]
        fn what_is_higher_than_the_eye_is_not_in_sight(
            eye in point(),
            (x, y) in (0i16..20, 0i16..20),
            heights in prop::collection::vec(0u8..80, 400),
        ) {
            let ground = |cell: Cell| heights.get(cell.y as usize * 20 + cell.x as usize).map(|&it| Height(it));
            let cell = Cell::new(x, y);
            let top = ground(cell).unwrap().cells();
            prop_assert!(top <= eye.z || !in_sight(eye, Point::over(cell, top), ground));
        }
    }

    #[test]
    fn a_wall_hides_what_is_behind_it() {
        let wall = |cell: Cell| Some(Height(if cell.x == 3 { 20 } else { 0 }));
        let eye = Point::new(0.5, 0.5, 3.0);
        assert!(in_sight(eye, Point::over(Cell::new(2, 0), 0.0), wall));
        assert!(!in_sight(eye, Point::over(Cell::new(5, 0), 0.0), wall));
        assert!(
            !in_sight(eye, Point::over(Cell::new(3, 0), 5.0), wall),
            "its top, from below"
        );
        let above = Point::new(0.5, 0.5, 9.0);
        assert!(in_sight(above, Point::over(Cell::new(3, 0), 5.0), wall));
    }

    #[test]
    fn clearance_is_the_least_on_the_way() {
        let hill = |cell: Cell| (cell.x < 9).then_some(Height(if cell.x == 3 { 16 } else { 4 }));
        let from = Point::new(0.5, 0.5, 6.0);
        assert_eq!(clearance(from, from.offset(5.0, 0.0, 0.0), hill), Some(2.0));
        assert_eq!(
            clearance(from, from.offset(0.0, 0.0, -2.0), hill),
            Some(3.0)
        );
        assert_eq!(clearance(from, from.offset(9.0, 0.0, 0.0), hill), None);
    }
}
