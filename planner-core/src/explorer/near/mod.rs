//! The near decision: the best frontier within the 4×4 tiles around the robot, by
//! waves over rows of 32 cells.

mod bonus;

use super::body::WINDOW_WORK;
use super::lean;
use super::others::MAX_OTHERS;
use super::surroundings::{Layer, Surroundings};
use super::window::{SIDE, Window};
use crate::cell::{Cell, Direction};
use crate::robot::RobotId;
use crate::role::Path;
use crate::tile::bits;

pub(crate) use bonus::Bonus;

/// What the near decision looks for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Aim {
    /// The goal chosen last, resolved or not: frontiers near it are preferred, so
    /// that the robot goes on the way it was going.
    pub(crate) goal: Option<Cell>,
    /// By how many steps.
    pub(crate) hysteresis: u8,
    /// The robot's id while it does not know where others went.
    pub(crate) lean: Option<RobotId>,
}

/// A frontier found, and the way to it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Candidate {
    pub(crate) goal: Cell,
    /// Steps to the goal.
    pub(crate) length: u32,
    /// The first of them.
    pub(crate) path: Path,
}

/// What a step costs in the score of a frontier cell.
const STEP: i32 = 4;
/// What each cell between it and the nearest visited one is worth.
const PER_CELL: i32 = 5;
/// Cells that count at most.
const LARGEST_BONUS: i32 = 8;

/// Work of gathering the frontiers, in instructions.
const GOALS_WORK: u32 = 2000;
/// Work of the bonus, and of gathering what else a flood needs.
const LOAD_WORK: u32 = 14_000;
/// Work of a robot's place.
const OTHER_WORK: u32 = 80;
/// Work of a row of the robot's own wave, and of the others'.
const ROW_WORK: u32 = 70;
const THEIR_ROW_WORK: u32 = 34;
/// Rows that weighing the frontier cells of a row takes as long as, and each of them where
/// robots lean.
const HITS_ROWS: i32 = 3;
const HIT_ROWS: i32 = 2;
/// Work of a step back.
const STEP_BACK_WORK: u32 = 30;

/// Rows that the robot's own wave takes, and as many that the others' does, before the last
/// layer of a flood.
const FLOOD: u32 = 320;

/// One row of the robot's own wave.
#[derive(Clone, Copy)]
struct Row {
    front: u32,
    /// Cells that the wave has not reached, and walls.
    unreached: u32,
    /// Cells whose layer has bit 1, and walls. Beside a cell the layers are one less or
    /// one more: this bit tells which.
    bit: u32,
    frontier: u32,
}

impl Row {
    const EMPTY: Self = Self {
        front: 0,
        unreached: u32::MAX,
        bit: u32::MAX,
        frontier: 0,
    };
}

/// One row of the others' wave.
#[derive(Clone, Copy)]
struct TheirRow {
    front: u32,
    /// Free cells that no robot has reached.
    open: u32,
}

impl TheirRow {
    const EMPTY: Self = Self { front: 0, open: 0 };
}

/// A frontier cell that a flood met.
#[derive(Clone, Copy)]
struct Met {
    score: i32,
    row: usize,
    column: u32,
    length: u32,
}

/// The best frontiers of a flood.
#[derive(Clone, Copy)]
pub(crate) struct Best {
    /// Of those that the robot is nearer to than anybody else.
    mine: Option<Met>,
    /// Of all; only where it is asked for and there is none of the robot's own.
    any: Option<Met>,
}

/// The rows that the near decision works on: 0.8 kB, kept in place, off the stack.
pub(crate) struct NearSearch {
    window: Window,
    /// The last rows stay empty: below them ends the window.
    rows: [Row; SIDE + 1],
    theirs: [TheirRow; SIDE + 1],
}

impl NearSearch {
    /// What a near decision costs at most: gathering, two places of every robot, a flood
    /// with its last layer, and a way back.
    pub(crate) const LARGEST_WORK: u32 = {
        let side = SIDE as u32;
        // In the last layer each row may be weighed, and two cells of it. Each layer takes
        // as long as three rows at least.
        let last = side * (1 + HITS_ROWS + 2 * HIT_ROWS) as u32;
        GOALS_WORK
            + LOAD_WORK
            + OTHER_WORK * (2 * MAX_OTHERS as u32 + 1)
            + (FLOOD + last) * ROW_WORK
            + (FLOOD + side) * THEIR_ROW_WORK
            + FLOOD / 3 * STEP_BACK_WORK
    };

    /// All zero, as a vacant planner must be: nothing is read before it is loaded.
    pub(crate) const fn new() -> Self {
        const ZERO: Row = Row {
            front: 0,
            unreached: 0,
            bit: 0,
            frontier: 0,
        };
        Self {
            window: Window::new(),
            rows: [ZERO; SIDE + 1],
            theirs: [TheirRow::EMPTY; SIDE + 1],
        }
    }

    /// Looks at the map around the robot. `None` if no frontier is in the window.
    #[inline(never)] // its rows leave the stack before a flood
    pub(crate) fn load<const TW: usize, const TH: usize>(
        &mut self,
        around: &Surroundings<TW, TH>,
        work: &mut u32,
    ) -> Option<Bonus> {
        self.window = Window::around(around.position);
        *work += GOALS_WORK;
        if around.clearance > 0 {
            *work += 2 * WINDOW_WORK;
        }
        let frontier = around.window(self.window, Layer::Goals);
        if frontier.iter().all(|&row| row == 0) {
            return None;
        }
        *work += LOAD_WORK;
        let open = around.window(self.window, Layer::Open);
        for ((row, theirs), (frontier, open)) in self
            .rows
            .iter_mut()
            .zip(&mut self.theirs)
            .zip(frontier.into_iter().zip(open))
        {
            *row = Row {
                front: 0,
                unreached: u32::MAX,
                bit: !open,
                frontier,
            };
            *theirs = TheirRow { front: 0, open };
        }
        if let Some(last) = self.rows.last_mut() {
            *last = Row::EMPTY;
        }
        let visited = self.window.load(|at| around.map.tile(at).visited());
        Some(Bonus::of(visited))
    }

    /// After [`load`](Self::load), once: the best frontier that the robot is nearer to
    /// than anybody else, ties to the lower id, and the best of all, if there is no such
    /// and `wants_any`. `others` gives where each other robot is and whether its id is
    /// lower. What a flood has not met after [`FLOOD`] rows is not near.
    ///
    /// Each cell belongs to whoever is nearest to it. The robot's own wave runs everywhere,
    /// a step a layer; those of the others run together, those with higher ids a layer
    /// late: the robot's are the cells that it reaches before them. All its ways there
    /// lead over cells of its own.
    #[inline(never)] // its rows leave the stack before the way
    pub(crate) fn best(
        &mut self,
        own: Cell,
        aim: &Aim,
        bonus: &Bonus,
        others: impl Iterator<Item = (Cell, bool)>,
        wants_any: bool,
        work: &mut u32,
    ) -> Best {
        let mut higher = [0; SIDE];
        let mut their_rows = 0u32;
        let mut late_rows = 0u32;
        for (cell, is_lower) in others {
            *work += OTHER_WORK;
            let Some((row, column)) = self.window.place(cell) else {
                continue;
            };
            let (Some(theirs), Some(late)) = (self.theirs.get_mut(row), higher.get_mut(row)) else {
                continue;
            };
            let bit = theirs.open & 1 << column;
            if is_lower {
                theirs.front |= bit;
                their_rows |= 1 << row;
            } else {
                *late |= bit;
                late_rows |= 1 << row;
            }
        }
        for theirs in &mut self.theirs {
            theirs.open &= !theirs.front;
        }
        let mut best = Best {
            mine: None,
            any: None,
        };
        let Some((row, column)) = self.window.place(own) else {
            return best;
        };
        let mut rows = 1u32 << row;
        let mut mine_left = true;
        if let (Some(row), Some(theirs)) = (self.rows.get_mut(row), self.theirs.get_mut(row)) {
            row.front = 1 << column;
            row.unreached &= !row.front;
            row.bit &= !row.front;
            mine_left = theirs.front & row.front == 0;
            theirs.open &= !row.front;
            if !mine_left && !wants_any {
                return best;
            }
        }
        let hysteresis = i32::from(aim.hysteresis);
        let largest_gain = aim.lean.map_or(0, |_| lean::LARGEST_GAIN);
        let (mut left, mut their_left) = (FLOOD as i32, FLOOD as i32);
        let weigh = Weigh {
            window: self.window,
            own,
            aim,
            bonus,
        };
        for length in 1..=(SIDE * SIDE) as u32 {
            // No frontier from here on can score better than this.
            let bound =
                STEP * (length as i32 - hysteresis) - PER_CELL * LARGEST_BONUS - largest_gain;
            let met = if mine_left { best.mine } else { best.any };
            if met.is_some_and(|met| met.score <= bound) || left <= 0 {
                break;
            }
            left -= 1;
            let before = left;
            if their_left > 0 {
                their_rows = self.advance_theirs(their_rows, work, &mut their_left);
            }
            if length == 1 {
                their_rows |= late_rows;
                for (theirs, late) in self.theirs.iter_mut().zip(higher) {
                    let late = late & theirs.open;
                    theirs.front |= late;
                    theirs.open &= !late;
                }
            }
            let mut todo = rows | rows << 1 | rows >> 1;
            (rows, mine_left) = (0, false);
            let bit = all_if(length & 2 != 0);
            let mut above = 0;
            while todo != 0 {
                left -= 1;
                let y = todo.trailing_zeros() as usize;
                todo &= todo - 1;
                let (Some([row, below, ..]), Some(theirs)) =
                    (self.rows.get_mut(y..), self.theirs.get_mut(y))
                else {
                    break;
                };
                let front = row.front;
                let near = front << 1 | front >> 1 | above | below.front;
                // Where a row is left out, no front comes from above.
                above = if todo >> y & 2 == 0 { 0 } else { front };
                let new = near & row.unreached & !row.bit;
                row.unreached &= !new;
                row.bit |= new & bit;
                let mine = new & theirs.open;
                theirs.open &= !new;
                row.front = if wants_any { new } else { mine };
                rows |= u32::from(row.front != 0) << y;
                mine_left |= mine != 0;
                let (mut hits, mut met) = (mine & row.frontier, &mut best.mine);
                if hits == 0 && met.is_none() && wants_any {
                    (hits, met) = (new & row.frontier, &mut best.any);
                }
                if hits != 0 {
                    let weighed = weigh.row(y, hits, length, *met, &mut left);
                    *met = weighed;
                }
            }
            *work += (before - left).unsigned_abs() * ROW_WORK;
            if !mine_left && (best.mine.is_some() || !wants_any) || rows == 0 {
                break;
            }
        }
        best
    }

    /// One step of the others' wave, from the rows with a front; those of the next one.
    fn advance_theirs(&mut self, fronts: u32, work: &mut u32, left: &mut i32) -> u32 {
        let mut todo = fronts | fronts << 1 | fronts >> 1;
        let (mut fronts, mut above) = (0, 0);
        let mut count = 0;
        while todo != 0 {
            count += 1;
            let y = todo.trailing_zeros() as usize;
            todo &= todo - 1;
            let Some([row, below, ..]) = self.theirs.get_mut(y..) else {
                break;
            };
            let front = row.front;
            row.front = (front << 1 | front >> 1 | above | below.front) & row.open;
            row.open &= !row.front;
            above = if todo >> y & 2 == 0 { 0 } else { front };
            fronts |= u32::from(row.front != 0) << y;
        }
        *work += count * THEIR_ROW_WORK;
        *left -= count as i32;
        fronts
    }

    /// The way to the best of the robot's own frontiers.
    pub(crate) fn mine(&self, best: &Best, work: &mut u32) -> Option<Candidate> {
        best.mine.map(|met| self.way(met, work))
    }

    /// The way to the best of all.
    pub(crate) fn any(&self, best: &Best, work: &mut u32) -> Option<Candidate> {
        best.any.map(|met| self.way(met, work))
    }

    /// Back from layer to layer: the neighbour that comes first of east, south, west and
    /// north.
    fn way(&self, met: Met, work: &mut u32) -> Candidate {
        let mut path = Path::new();
        let (mut row, mut column) = (met.row, met.column);
        for layer in (0..met.length).rev() {
            *work += STEP_BACK_WORK;
            let bit = all_if(layer & 2 != 0);
            let is_before = |row: usize, column: u32| {
                let row = self.rows.get(row).copied().unwrap_or(Row::EMPTY);
                (row.unreached | (row.bit ^ bit))
                    .checked_shr(column)
                    .is_some_and(|x| x & 1 == 0)
            };
            let back = if is_before(row, column + 1) {
                column += 1;
                Direction::East
            } else if is_before(row + 1, column) {
                row += 1;
                Direction::South
            } else if is_before(row, column.wrapping_sub(1)) {
                column -= 1;
                Direction::West
            } else if row > 0 {
                row -= 1;
                Direction::North
            } else {
                break;
            };
            path.push_front(back.opposite());
        }
        Candidate {
            goal: self.window.cell(met.row, met.column),
            length: met.length,
            path,
        }
    }
}

/// All cells of a row or none.
const fn all_if(condition: bool) -> u32 {
    (condition as u32).wrapping_neg()
}

/// What frontier cells are weighed by.
struct Weigh<'a> {
    window: Window,
    own: Cell,
    aim: &'a Aim,
    bonus: &'a Bonus,
}

impl Weigh<'_> {
    /// The best of what was met before and some frontier cells of a row, `length` steps
    /// away: the lowest score, else the first.
    fn row(
        &self,
        y: usize,
        hits: u32,
        length: u32,
        best: Option<Met>,
        left: &mut i32,
    ) -> Option<Met> {
        *left -= HITS_ROWS;
        let mut best = best;
        let preferred = hits & self.near_goal(y);
        let classes = [
            (preferred, i32::from(self.aim.hysteresis)),
            (hits & !preferred, 0),
        ];
        let mut first: Option<Met> = None;
        for (cells, preference) in classes {
            if cells == 0 {
                continue;
            }
            let (bonus, having) = self.bonus.largest(y, cells);
            let score = STEP * (length as i32 - preference) - PER_CELL * bonus;
            let met = |score, column| Met {
                score,
                row: y,
                column,
                length,
            };
            let Some(id) = self.aim.lean else {
                let met = met(score, having.trailing_zeros());
                if first.is_none_or(|first| (met.score, met.column) < (first.score, first.column)) {
                    first = Some(met);
                }
                continue;
            };
            if best.is_some_and(|best| best.score <= score - lean::LARGEST_GAIN) {
                continue;
            }
            for column in bits(cells.into()) {
                *left -= HIT_ROWS;
                let gain = lean::gain(id, self.own, self.window.cell(y, column));
                let score = STEP * (length as i32 - preference)
                    - PER_CELL * self.bonus.at(y, column)
                    - gain;
                let met = met(score, column);
                if first.is_none_or(|first| (met.score, met.column) < (first.score, first.column)) {
                    first = Some(met);
                }
            }
        }
        if let Some(first) = first
            && best.is_none_or(|best| first.score < best.score)
        {
            best = Some(first);
        }
        best
    }

    /// The cells of a row that are at most three steps from the goal chosen last, each way.
    fn near_goal(&self, y: usize) -> u32 {
        let Some(goal) = self.aim.goal else {
            return 0;
        };
        let corner = self.window.cell(y, 0);
        let column = i32::from(goal.x) - i32::from(corner.x);
        if goal.y.abs_diff(corner.y) > 3 || !(-3..SIDE as i32 + 3).contains(&column) {
            return 0;
        }
        ((0x7f_u64 << (column + 3)) >> 6) as u32
    }
}

#[cfg(test)]
mod tests;
