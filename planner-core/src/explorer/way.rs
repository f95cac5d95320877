//! The way at hand: its cells, how far along it the robot can go straight, and what poses
//! off its next cell make of it.
//!
//! A robot that steers for the waypoint tells where it is by looks from any cell. Between
//! it and the waypoint lies the *corridor*: the cells that the straight line touches, all
//! of them open. Where a pose lies in it, the way's beginning is laid anew along the line:
//! it is no longer for it.

use super::Explorer;
use super::body::{Fit, MAX_CLEARANCE, WINDOW_WORK, fit};
use super::near::Candidate;
use super::surroundings::Layer;
use super::window::{Rows, Window};
use crate::cell::{Cell, Direction};
use crate::role::{Path, Plan};

/// Steps of the way that are tried for a waypoint; the window around the robot seldom
/// holds more.
const LONGEST: u32 = 64;

/// Steps of a way that are kept clear of walls.
const NEXT: u16 = 16;

impl<const TW: usize, const TH: usize> Explorer<TW, TH> {
    /// The cells of the way at hand, from the next one on: at most 256, up to the goal or
    /// to where its rest is searched for. None without a plan. Each is 4-connected with the
    /// one before. Work: a few instructions a cell.
    pub fn way(&self) -> impl Iterator<Item = Cell> + use<TW, TH> {
        cells_of(self.around.position, self.role.plan.as_ref()).map(|(cell, _)| cell)
    }

    /// The farthest cell of the way that a straight line over open cells leads to, and its
    /// number of steps.
    pub(super) fn straight(&self) -> Option<(Cell, u32)> {
        self.next_step()?;
        let here = self.around.position;
        let window = Window::around(here);
        let from = window.place(here)?;
        let open = self.around.window(window, Layer::Open);
        let mut farthest = None;
        for (cell, steps) in cells_of(here, self.role.plan.as_ref()).take(LONGEST as usize) {
            match window.place(cell) {
                Some(to) if is_straight(&open, from, to) => farthest = Some((cell, steps)),
                Some(_) => {}
                None => break,
            }
        }
        farthest
    }

    /// From now on the robot follows this way.
    #[inline(never)] // small rather than fast
    pub(super) fn take(&mut self, way: Candidate) {
        let mut path = way.path;
        path.truncate(self.config.way.max(1));
        if self.around.clearance > 0 {
            self.work += 2 * WINDOW_WORK;
            self.keep_clear(&mut path);
        }
        self.role.plan = Some(Plan {
            goal: way.goal,
            remaining: way.length,
            path,
        });
    }

    /// As long a way, farther from walls: where one of the next steps leads beside a wall,
    /// and the one after it would not, they change places, turns being made sooner or later.
    /// Work: a few discs a step.
    fn keep_clear(&self, path: &mut Path) {
        let wider = (self.around.clearance + 1).min(MAX_CLEARANCE);
        let has_room = |cell: Cell| fit(&self.around.map, wider, cell) == Fit::Clear;
        for index in (0..NEXT).rev().chain(0..NEXT) {
            let (Some(step), Some(after)) = (path.get(index), path.get(index + 1)) else {
                continue;
            };
            let steps = path.steps().take(index.into());
            let at = steps.fold(self.around.position, Cell::step);
            let (here, other) = (at.step(step), at.step(after));
            if step != after && has_room(other) && !has_room(here) && self.around.is_open(other) {
                path.swap(index);
            }
        }
    }

    /// The robot is on `pose`, where no report told: keeps the plan if that is on the way,
    /// or beside it or the line to the waypoint. Says whether it does.
    pub(super) fn follow(&mut self, pose: Cell) -> bool {
        let Some(plan) = self.role.plan else {
            return false;
        };
        let before = plan.remaining;
        let mut entered = self.entered(plan, pose);
        let is_ahead = entered.is_some_and(|(plan, _)| plan.remaining < before);
        if !is_ahead && let Some((cell, steps)) = self.straight() {
            let mut straight = plan;
            straight.straighten(self.around.position, cell, steps);
            let other = self.entered(straight, pose);
            let left = |of: &(Plan, u32)| of.0.remaining;
            entered = entered.into_iter().chain(other).min_by_key(left);
        }
        let Some((plan, steps)) = entered else {
            return false;
        };
        self.role.plan = Some(plan);
        self.role.has_arrived = plan.remaining == 0;
        self.role.since = self.role.since.saturating_add(steps.min(255) as u8);
        self.holds = 0;
        true
    }

    /// The plan from where `pose` lies on its way, or led back to the farthest of its cells
    /// beside; and the steps that this leaves out.
    fn entered(&self, mut plan: Plan, pose: Cell) -> Option<(Plan, u32)> {
        let here = self.around.position;
        let mut entry = None;
        for (cell, steps) in [(here, 0)].into_iter().chain(cells_of(here, Some(&plan))) {
            if cell == pose {
                entry = Some((steps, [None, None]));
                break;
            }
            if let Some(back) = self.steps_beside(pose, cell) {
                entry = Some((steps, back));
            }
        }
        let (steps, back) = entry?;
        plan.enter(steps, back);
        Some((plan, steps))
    }

    /// The one or two steps from a cell to another one beside it, round no corner; `None` if
    /// it is not beside.
    fn steps_beside(&self, from: Cell, to: Cell) -> Option<[Option<Direction>; 2]> {
        if from.chebyshev(to) > 1 {
            return None;
        }
        if let Some(step) = from.direction_to(to) {
            return Some([Some(step), None]);
        }
        let corners = [Cell::new(to.x, from.y), Cell::new(from.x, to.y)];
        let open = corners
            .into_iter()
            .find(|cell| self.around.is_open(*cell))?;
        Some([from.direction_to(open), open.direction_to(to)])
    }
}

/// The cells of a plan's way from `here`, each with the number of steps to it.
fn cells_of(here: Cell, plan: Option<&Plan>) -> impl Iterator<Item = (Cell, u32)> + use<> {
    let path = plan.map_or(Path::new(), |plan| plan.path);
    path.steps().scan((here, 0), |at, step| {
        *at = (at.0.step(step), at.1 + 1);
        Some(*at)
    })
}

impl Plan {
    /// Leaves out the first steps, and puts others before the rest. A way that is used up
    /// stays so: its rest is being searched for.
    fn enter(&mut self, steps: u32, before: [Option<Direction>; 2]) {
        let is_used_up = self.path.is_empty();
        for _ in 0..steps {
            self.path.pop_front();
        }
        self.remaining = self.remaining.saturating_sub(steps);
        for step in before.into_iter().rev().flatten() {
            if !is_used_up {
                self.path.push_front(step);
            }
            self.remaining = self.remaining.saturating_add(1);
        }
    }

    /// Lays the first steps anew, along the straight line to the cell that they lead to:
    /// they become no more.
    fn straighten(&mut self, from: Cell, to: Cell, steps: u32) {
        let mut path = Path::new();
        for step in along_line(from, to) {
            path.push_back(step);
        }
        let straight = path.len();
        for step in self.path.steps().skip(steps as usize) {
            path.push_back(step);
        }
        self.path = path;
        self.remaining = self.remaining.saturating_sub(steps) + straight;
    }
}

/// Steps from cell to cell along the line between two centres; through a corner, by the
/// side.
fn along_line(from: Cell, to: Cell) -> impl Iterator<Item = Direction> {
    let dx = i32::from(to.x) - i32::from(from.x);
    let dy = i32::from(to.y) - i32::from(from.y);
    let across = if dx > 0 {
        Direction::East
    } else {
        Direction::West
    };
    let down = if dy > 0 {
        Direction::South
    } else {
        Direction::North
    };
    let (columns, rows) = (dx.abs(), dy.abs());
    let (mut column, mut row) = (0, 0);
    core::iter::from_fn(move || {
        // Where the line leaves the cell, as in `line_of_sight`.
        if column < columns && (1 + 2 * column) * rows <= (1 + 2 * row) * columns {
            column += 1;
            Some(across)
        } else if row < rows {
            row += 1;
            Some(down)
        } else {
            None
        }
    })
}

/// Whether every cell that the segment between the centres of two cells touches is open;
/// at a corner it touches all four. Cells are given as row and column. Work: a row of cells
/// at a time.
fn is_straight(open: &Rows, from: (usize, u32), to: (usize, u32)) -> bool {
    let ((top, first), (bottom, last)) = if from.0 <= to.0 {
        (from, to)
    } else {
        (to, from)
    };
    let (dx, dy) = (last as i32 - first as i32, (bottom - top) as i32);
    let mut rows = open.iter().skip(top).zip(0..=dy);
    rows.all(|(row, y)| {
        // The part of the segment in this row, as parameters times 2·dy.
        let (enters, leaves) = ((2 * y - 1).max(0) * dx, (2 * y + 1).min(2 * dy) * dx);
        let (west, east) = (enters.min(leaves), enters.max(leaves));
        // Columns whose cells reach from half a cell before their centre to half behind.
        let whole = |of: i32| of.checked_div_euclid(2 * dy);
        let columns = match (whole(west + dy - 1), whole(east + dy)) {
            (Some(west), Some(east)) => (west, east),
            _ => (dx.min(0), dx.max(0)),
        };
        let length = (columns.1 - columns.0).unsigned_abs().min(31);
        let cells = u32::MAX >> (31 - length) << (first as i32 + columns.0).unsigned_abs().min(31);
        row & cells == cells
    })
}

#[cfg(test)]
mod tests;
