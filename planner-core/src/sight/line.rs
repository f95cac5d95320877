//! Line of sight between the centres of two cells.

use super::{LongSighting, Look, MAX_LONG_RADIUS, MAX_RADIUS, Row, Sighting};
use crate::cell::Cell;

/// Whether `to` can be seen from `from`: no cell that the segment between their
/// centres crosses is blocked, the two ends excepted. Where the segment passes
/// exactly through a corner, it is stopped only if both cells beside the corner
/// are blocked.
///
/// Symmetric. Work: at most `|dx| + |dy|` cells.
pub fn line_of_sight(from: Cell, to: Cell, is_blocked: impl Fn(Cell) -> bool) -> bool {
    let dx = i32::from(to.x) - i32::from(from.x);
    let dy = i32::from(to.y) - i32::from(from.y);
    let (columns, rows) = (dx.abs(), dy.abs());
    let (step_x, step_y) = (dx.signum() as i16, dy.signum() as i16);
    let (mut column, mut row) = (0, 0);
    let mut cell = from;
    while column < columns || row < rows {
        // The segment leaves the cell through its vertical side at parameter
        // (1 + 2·column) / (2·columns), through its horizontal one likewise.
        let vertical = (1 + 2 * column) * rows;
        let horizontal = (1 + 2 * row) * columns;
        let beside_x = Cell::new(cell.x.saturating_add(step_x), cell.y);
        let beside_y = Cell::new(cell.x, cell.y.saturating_add(step_y));
        if vertical == horizontal {
            if is_blocked(beside_x) && is_blocked(beside_y) {
                return false;
            }
            cell = Cell::new(beside_x.x, beside_y.y);
            column += 1;
            row += 1;
        } else if vertical < horizontal {
            cell = beside_x;
            column += 1;
        } else {
            cell = beside_y;
            row += 1;
        }
        if cell != to && is_blocked(cell) {
            return false;
        }
    }
    true
}

/// Everything in line of sight from `centre` within `radius` cells (Euclidean,
/// between centres; at most [`MAX_RADIUS`], larger values count as that).
///
/// Work: `(2·radius + 1)²` lines of at most `2·radius` cells.
pub fn look(centre: Cell, radius: u8, is_blocked: impl Fn(Cell) -> bool) -> Sighting {
    within(centre, radius.min(MAX_RADIUS), is_blocked)
}

/// As [`look`], of at most [`MAX_LONG_RADIUS`].
pub fn look_far(centre: Cell, radius: u8, is_blocked: impl Fn(Cell) -> bool) -> LongSighting {
    within(centre, radius.min(MAX_LONG_RADIUS), is_blocked)
}

fn within<R: Row, const SPAN: usize>(
    centre: Cell,
    radius: u8,
    is_blocked: impl Fn(Cell) -> bool,
) -> Look<R, SPAN> {
    let mut look = Look::new(centre);
    let radius = i16::from(radius);
    for dy in -radius..=radius {
        for dx in -radius..=radius {
            let cell = Cell::new(centre.x.saturating_add(dx), centre.y.saturating_add(dy));
            if dx * dx + dy * dy <= radius * radius && line_of_sight(centre, cell, &is_blocked) {
                if is_blocked(cell) {
                    look.see_blocked(cell);
                } else {
                    look.see_free(cell);
                }
            }
        }
    }
    look
}
