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

/// The columns that a segment crosses, in order. Yields 1 + |Δcolumn| + |Δrow| items; from the
/// other end the same, the other way round, bit for bit.
// [Amanatides1987]
#[derive(Clone, Debug)]
pub struct Columns {
    from: Point,
    to: Point,
    /// Whether the way leads backwards; parameters count from its other end then.
    backwards: bool,
    cell: Cell,
    x: Axis,
    y: Axis,
    entered: f32,
    done: bool,
}

/// The borders that a line crosses along an axis.
#[derive(Clone, Debug)]
struct Axis {
    /// Where the line begins, and one over its length, of the way that is not backwards.
    first: f32,
    inverse: f32,
    /// The next border, and those that are left.
    border: f32,
    left: u16,
    step: i16,
}

impl Axis {
    fn new(from: f32, to: f32, (start, end): (i16, i16), backwards: bool) -> Self {
        let (first, last) = if backwards { (to, from) } else { (from, to) };
        let border = if end > start { 1.0 } else { 0.0 };
        Self {
            first,
            inverse: if start == end {
                0.0
            } else {
                1.0 / (last - first)
            },
            border: f32::from(start) + border,
            left: start.abs_diff(end),
            step: end.saturating_sub(start).signum(),
        }
    }

    /// The parameter at which the next border is crossed.
    fn next(&self) -> f32 {
        (self.border - self.first) * self.inverse
    }

    /// The border is crossed.
    fn cross(&mut self) -> i16 {
        self.left = self.left.saturating_sub(1);
        self.border += f32::from(self.step);
        self.step
    }
}

impl Columns {
    /// The columns between two points with finite coordinates.
    pub fn new(from: Point, to: Point) -> Self {
        let (start, end) = (from.cell(), to.cell());
        let backwards = (from.x, from.y, from.z) > (to.x, to.y, to.z);
        Self {
            from,
            to,
            backwards,
            cell: start,
            x: Axis::new(from.x, to.x, (start.x, end.x), backwards),
            y: Axis::new(from.y, to.y, (start.y, end.y), backwards),
            entered: from.z,
            done: false,
        }
    }

    fn height_at(&self, parameter: f32) -> f32 {
        let (first, last) = match self.backwards {
            true => (self.to.z, self.from.z),
            false => (self.from.z, self.to.z),
        };
        first + (last - first) * parameter.clamp(0.0, 1.0)
    }
}

impl Iterator for Columns {
    type Item = Crossing;

    fn next(&mut self) -> Option<Self::Item> {
        if self.done {
            return None;
        }
        let cell = self.cell;
        let (x, y) = (self.x.next(), self.y.next());
        // At a corner first along x, and backwards last, so that both ways are one.
        let is_x_first = (x <= y) != self.backwards;
        let left = if self.x.left == 0 && self.y.left == 0 {
            self.done = true;
            self.to.z
        } else if self.y.left == 0 || (self.x.left > 0 && is_x_first) {
            let step = self.x.cross();
            self.cell.x = self.cell.x.saturating_add(step);
            self.height_at(x)
        } else {
            let step = self.y.cross();
            self.cell.y = self.cell.y.saturating_add(step);
            self.height_at(y)
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
    let mut least = f32::INFINITY;
    for crossing in Columns::new(from, to) {
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
            let way: Vec<_> = Columns::new(from, to).map(|it| (it.cell, it.entered, it.left)).collect();
            let back: Vec<_> = Columns::new(to, from).map(|it| (it.cell, it.left, it.entered)).collect();
            prop_assert!(way.iter().eq(back.iter().rev()), "{:?} {:?}", way, back);
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
