//! A beam's way over the grid, in whole numbers: no division, and the same cells on every
//! chip.
//!
//! Each axis is mirrored so that a beam goes towards larger numbers: the robot's own cell
//! is column 0 of row 0 of the walk, and every step leads one column or one row on. Where
//! the tolerance is t, a beam's true way lies within t of the computed one, and its true
//! end within t of the computed end in both axes. From this follows:
//!
//! - If t around the end lies beyond a cell in one axis, the true end does not touch the
//!   cell. If besides the line has a corner of the cell on either side, more than t away,
//!   the true way led through the cell, and before its end: it is *free*.
//! - If t around the end touches one border alone, the true end is on it, and not where
//!   others meet it: the cell behind is *blocked*, the one before it free. If it touches
//!   two, the corner says nothing.
//! - If t around the end touches no border, the world is not one of whole cells: what
//!   was hit stands in this cell.

use super::{Look, Row};
use crate::cell::Cell;

/// 1 as a number of the walk: cells with 24 bits behind the point.
const ONE: i32 = 1 << FRACTION;
const FRACTION: u32 = 24;

/// What all roundings of a walk together stay below: 0.0001 cells.
const ROUNDING: i32 = ONE / 8192;

/// A beam along a border, by this or less a unit, only grazes what it hits there.
const GRAZING: i32 = ONE / 5;

const fn fixed(value: f32) -> i32 {
    (value * ONE as f32) as i32
}

/// Where the beams of a scan begin, in the robot's cell.
pub(super) struct Eye {
    x: i32,
    y: i32,
    tolerance: i32,
}

impl Eye {
    /// At `(x, y)` from the north-western corner of its cell, each in `[0, 1)`.
    pub(super) const fn new(x: f32, y: f32, tolerance: f32) -> Self {
        Self {
            x: fixed(x),
            y: fixed(y),
            tolerance: fixed(tolerance) + ROUNDING,
        }
    }

    /// Adds to the sighting what a beam shows. Cells that were crossed stay free beside
    /// blocked ones until [`Look::settle`].
    pub(super) fn cast<R: Row, const SPAN: usize>(
        &self,
        sighting: &mut Look<R, SPAN>,
        direction: (f32, f32),
        range: f32,
        max_range: f32,
    ) {
        if range.is_nan() || range < 0.0 || direction.0.is_nan() {
            return;
        }
        let reach = max_range.min((SPAN / 2) as f32);
        let is_hit = range < max_range && range <= reach;
        let length = if is_hit { range } else { reach };
        let beam = Way {
            x: Axis::new(self.x, direction.0, length),
            y: Axis::new(self.y, direction.1, length),
            tolerance: self.tolerance,
        };
        let last = beam.follow(sighting);
        if is_hit {
            beam.hit(sighting);
        } else if let Some(last) = last
            && beam.gets_into(last)
        {
            sighting.see_free(beam.cell(sighting, last));
        }
    }
}

/// One coordinate of a beam.
struct Axis {
    /// Whether it was mirrored: the beam goes west, or north.
    is_back: bool,
    /// How much it grows along the beam, 0 to 1.
    slope: i32,
    /// Where the beam begins and ends.
    start: i32,
    end: i32,
}

impl Axis {
    fn new(inside: i32, slope: f32, length: f32) -> Self {
        let is_back = slope < 0.0;
        let slope = slope.abs();
        let start = if is_back { ONE - inside } else { inside };
        Self {
            is_back,
            slope: fixed(slope),
            start,
            end: start + fixed(slope * length),
        }
    }

    /// How many borders the end lies beyond, by more than the tolerance.
    const fn crossed(&self, tolerance: i32) -> i32 {
        (self.end - tolerance - 1) >> FRACTION
    }

    /// The border that the end touches: border `n` lies before cell `n`.
    const fn border(&self, tolerance: i32) -> Option<i32> {
        let end = self.end + tolerance;
        if end & (ONE - 1) <= 2 * tolerance {
            Some(end >> FRACTION)
        } else {
            None
        }
    }
}

/// A cell of a walk: column and row.
type Place = (i32, i32);

/// The way of a beam.
struct Way {
    x: Axis,
    y: Axis,
    tolerance: i32,
}

impl Way {
    /// Sees the cells free that the beam crossed before its end. Gives the one after
    /// them, if the beam leads through that too.
    fn follow<R: Row, const SPAN: usize>(&self, sighting: &mut Look<R, SPAN>) -> Option<Place> {
        let (x, y, tolerance) = (&self.x, &self.y, self.tolerance);
        let ends = (x.crossed(tolerance), y.crossed(tolerance));
        let (mut columns, mut rows) = ends;
        // How far the far corner of the cell lies beside the line: above 0 the line leaves
        // by the column. `margin` more, and it lies between 0 and `band` where the line
        // has corners on either side.
        let far = |slope: i32, start: i32| (i64::from(slope) * i64::from(ONE - start)) >> FRACTION;
        let margin = y.slope - tolerance;
        let band = (x.slope + margin - tolerance) as u32;
        let mut beside = (far(x.slope, y.start) - far(y.slope, x.start)) as i32 + margin;
        let turn = if x.is_back { 1 } else { R::BITS - 1 };
        let down = if y.is_back { usize::MAX } else { 1 };
        let (mut bit, mut row) = (Look::<R, SPAN>::own(), SPAN / 2);
        // A beam crosses as many columns and rows as the radius, and one more of each.
        for _ in 0..2 * (SPAN / 2 + 1) {
            // Below 0 it is a large number.
            let is_through = beside as u32 <= band;
            if columns <= 0 && rows <= 0 {
                return is_through.then_some((ends.0 - columns, ends.1 - rows));
            }
            if is_through && let Some(free) = sighting.free.get_mut(row) {
                *free |= bit;
            }
            if beside > margin {
                beside -= y.slope;
                columns -= 1;
                bit = bit.turned(turn);
            } else {
                beside += x.slope;
                rows -= 1;
                row = row.wrapping_add(down);
            }
        }
        None
    }

    /// Whether the beam, which hit nothing, ends half a cell or more into this one.
    const fn gets_into(&self, (column, row): Place) -> bool {
        let (x, y) = (self.x.end - column * ONE, self.y.end - row * ONE);
        let deep = if self.x.slope > self.y.slope { x } else { y };
        x > self.tolerance && y > self.tolerance && deep >= ONE / 2 - self.tolerance
    }

    /// Sees what the beam hit.
    fn hit<R: Row, const SPAN: usize>(&self, sighting: &mut Look<R, SPAN>) {
        let (x, y) = (&self.x, &self.y);
        let (column, row) = (x.end >> FRACTION, y.end >> FRACTION);
        let (front, behind) = match (x.border(self.tolerance), y.border(self.tolerance)) {
            (None, None) => (None, (column, row)),
            (Some(border @ 1..), None) if x.slope > GRAZING => {
                (Some((border - 1, row)), (border, row))
            }
            (None, Some(border @ 1..)) if y.slope > GRAZING => {
                (Some((column, border - 1)), (column, border))
            }
            _ => return,
        };
        if let Some(front) = front {
            sighting.see_free(self.cell(sighting, front));
        }
        sighting.see_blocked(self.cell(sighting, behind));
    }

    fn cell<R: Row, const SPAN: usize>(
        &self,
        sighting: &Look<R, SPAN>,
        (column, row): Place,
    ) -> Cell {
        let on = |from: i16, axis: &Axis, by: i32| match axis.is_back {
            true => from.saturating_sub(by as i16),
            false => from.saturating_add(by as i16),
        };
        let centre = sighting.centre();
        Cell::new(on(centre.x, &self.x, column), on(centre.y, &self.y, row))
    }
}
