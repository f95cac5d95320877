//! Straight lines over cells, with real coordinates: the cell `(x, y)` covers
//! `[x, x + 1) × [y, y + 1)`.

use planner_core::Cell;

/// The cell that a place lies in.
pub(super) fn cell((x, y): (f64, f64)) -> Cell {
    Cell::new(x.floor() as i16, y.floor() as i16)
}

/// The cells that a line from a place in a direction (from east to south, in radians)
/// goes through, each with the distance at which it is left. Without end.
pub(super) fn line(from: (f64, f64), angle: f64) -> impl Iterator<Item = (Cell, f64)> {
    let (sin, cos) = angle.sin_cos();
    let (mut along_x, mut along_y) = (Axis::new(from.0, cos), Axis::new(from.1, sin));
    let mut next = cell(from);
    std::iter::repeat_with(move || {
        let (at, left) = (next, along_x.crossing.min(along_y.crossing));
        if along_x.crossing <= along_y.crossing {
            next.x = next.x.saturating_add(along_x.cross());
        } else {
            next.y = next.y.saturating_add(along_y.cross());
        }
        (at, left)
    })
}

/// One coordinate of a line.
struct Axis {
    step: i16,
    /// Distance at which the line enters the next cell.
    crossing: f64,
    spacing: f64,
}

impl Axis {
    fn new(position: f64, slope: f64) -> Self {
        let inside = position - position.floor();
        let to_border = if slope > 0.0 { 1.0 - inside } else { inside };
        Self {
            step: if slope > 0.0 { 1 } else { -1 },
            // Of a line along the border, never.
            crossing: match slope == 0.0 {
                true => f64::INFINITY,
                false => to_border / slope.abs(),
            },
            spacing: 1.0 / slope.abs(),
        }
    }

    fn cross(&mut self) -> i16 {
        self.crossing += self.spacing;
        self.step
    }
}
