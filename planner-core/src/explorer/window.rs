//! The near decision: the best frontier within the 4×4 tiles around the robot, by
//! waves over rows of 32 cells.

use super::lean;
use super::path::Path;
use super::surroundings::Surroundings;
use crate::cell::{Cell, Direction};
use crate::map::{TileIndex, bits};
use crate::planner::RobotId;

/// Side of the window in cells and in tiles.
pub(crate) const SIDE: usize = 32;
const TILES: u8 = 4;

/// One layer of the window: bit `x` of row `y` is the cell `(x, y)` from its corner.
pub(crate) type Rows = [u32; SIDE];

/// The 4×4 tiles around a cell, such that the cell is at least 12 cells from the edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Window {
    /// Corner, in tiles; may lie outside of the map.
    x: i16,
    y: i16,
}

impl Window {
    pub(crate) const fn around(cell: Cell) -> Self {
        Self {
            x: (cell.x.saturating_add(4) >> 3) - 2,
            y: (cell.y.saturating_add(4) >> 3) - 2,
        }
    }

    /// Row and bit number of a cell, if it lies in the window.
    pub(crate) fn place(self, cell: Cell) -> Option<(usize, u32)> {
        let column = u32::try_from(i32::from(cell.x) - 8 * i32::from(self.x)).ok()?;
        let row = usize::try_from(i32::from(cell.y) - 8 * i32::from(self.y)).ok()?;
        (column < SIDE as u32 && row < SIDE).then_some((row, column))
    }

    pub(crate) const fn cell(self, row: usize, column: u32) -> Cell {
        Cell::new(self.x * 8 + column as i16, self.y * 8 + row as i16)
    }

    /// The tiles of the window that can exist, each with the row and the bit
    /// number of its corner.
    pub(crate) fn tiles(self) -> impl Iterator<Item = (TileIndex, usize, u32)> {
        (0..TILES).flat_map(move |dy| {
            (0..TILES).filter_map(move |dx| {
                let at = TileIndex {
                    x: u8::try_from(self.x + i16::from(dx)).ok()?,
                    y: u8::try_from(self.y + i16::from(dy)).ok()?,
                };
                Some((at, usize::from(dy) * 8, u32::from(dx) * 8))
            })
        })
    }

    /// Gathers one layer of the tiles into rows. Work: 128 bytes.
    pub(crate) fn load(self, layer: impl Fn(TileIndex) -> u64) -> Rows {
        let mut rows = [0; SIDE];
        for (at, row, column) in self.tiles() {
            let bytes = layer(at).to_le_bytes();
            for (row, byte) in rows.iter_mut().skip(row).zip(bytes) {
                *row |= u32::from(byte) << column;
            }
        }
        rows
    }
}

/// Sets a bit of the rows; ignored outside.
fn set(rows: &mut Rows, place: Option<(usize, u32)>) {
    if let Some((row, column)) = place
        && let Some(row) = rows.get_mut(row)
    {
        *row |= 1 << column;
    }
}

fn get(rows: &Rows, row: usize, column: u32) -> bool {
    rows.get(row).is_some_and(|row| row >> column & 1 == 1)
}

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

/// How far every cell of the window is from the visited ones: 1 to 8, less one, a
/// bit a plane.
pub(crate) struct Bonus([Rows; 3]);

impl Bonus {
    /// 1 + the number of times that the visited cells can grow, by 4 and by 8
    /// neighbours in turn (so in octagons, within 6 % of Euclidean distance),
    /// before they cover a cell; at most 8.
    fn of(visited: Rows) -> Self {
        let mut near = visited;
        let mut planes = [[0; SIDE]; 3];
        for growth in 0..LARGEST_BONUS - 1 {
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
                // Count the cells that are still not covered: a ripple-carry adder.
                let mut carry = !grown;
                for plane in &mut planes {
                    if let Some(row) = plane.get_mut(y) {
                        let sum = *row ^ carry;
                        carry &= *row;
                        *row = sum;
                    }
                }
            }
        }
        Self(planes)
    }

    fn at(&self, row: usize, column: u32) -> i32 {
        let mut bonus = 1;
        for (plane, value) in self.0.iter().zip([1, 2, 4]) {
            if get(plane, row, column) {
                bonus += value;
            }
        }
        bonus
    }
}

/// The rows that the near decision works on: 0.9 kB, kept in place, off the stack.
pub(crate) struct NearSearch {
    window: Window,
    frontier: Rows,
    open: Rows,
    /// Direction back to the robot, a bit a plane.
    parent: [Rows; 2],
    mine: Rows,
    lower: Rows,
    higher: Rows,
}

impl NearSearch {
    pub(crate) const fn new() -> Self {
        Self {
            window: Window { x: 0, y: 0 },
            frontier: [0; SIDE],
            open: [0; SIDE],
            parent: [[0; SIDE]; 2],
            mine: [0; SIDE],
            lower: [0; SIDE],
            higher: [0; SIDE],
        }
    }

    /// Looks at the map around the robot. `None` if no frontier is in the window.
    pub(crate) fn load<const TW: usize, const TH: usize>(
        &mut self,
        around: &Surroundings<TW, TH>,
        work: &mut u32,
    ) -> Option<Bonus> {
        self.window = Window::around(around.position);
        *work += SIDE as u32;
        self.frontier = self.window.load(|at| around.map.frontier(at));
        if self.frontier.iter().all(|&row| row == 0) {
            return None;
        }
        *work += 9 * SIDE as u32;
        let visited = self.window.load(|at| around.map.tile(at).visited);
        Some(Bonus::of(visited))
    }

    /// The best frontier that the robot is nearer to than anybody else, ties to
    /// the lower id. `others` gives where each other robot is and whether its id is
    /// lower; without any, every frontier counts.
    pub(crate) fn best<const TW: usize, const TH: usize>(
        &mut self,
        around: &Surroundings<TW, TH>,
        aim: &Aim,
        bonus: &Bonus,
        others: impl Iterator<Item = (Cell, bool)>,
        work: &mut u32,
    ) -> Option<Candidate> {
        *work += SIDE as u32;
        self.open = self.window.load(|at| around.open(at));
        self.lower = [0; SIDE];
        self.higher = [0; SIDE];
        for (cell, is_lower) in others {
            let place = self.window.place(cell);
            if place.is_some_and(|(row, column)| get(&self.open, row, column)) {
                let sources = if is_lower {
                    &mut self.lower
                } else {
                    &mut self.higher
                };
                set(sources, place);
            }
        }
        self.flood(around.position, aim, bonus, work)
    }

    /// Waves from everybody at once, a step a layer; each cell belongs to whoever
    /// reaches it first. Each layer looks at the rows beside those of its front,
    /// and each cell is in one front: at most 3 · 1024 rows.
    fn flood(&mut self, own: Cell, aim: &Aim, bonus: &Bonus, work: &mut u32) -> Option<Candidate> {
        self.parent = [[0; SIDE]; 2];
        self.mine = [0; SIDE];
        set(&mut self.mine, self.window.place(own));
        let mut fronts = 0u32;
        for y in 0..SIDE {
            let (Some(open), Some(mine), Some(lower), Some(higher)) = (
                self.open.get_mut(y),
                self.mine.get_mut(y),
                self.lower.get_mut(y),
                self.higher.get_mut(y),
            ) else {
                continue;
            };
            *mine &= !*lower;
            *higher &= !(*mine | *lower);
            *open &= !(*mine | *lower | *higher);
            if (*mine | *lower | *higher) != 0 {
                fronts |= 1 << y;
            }
        }

        let mut best: Option<(i32, usize, u32, u32)> = None;
        let hysteresis = i32::from(aim.hysteresis);
        let largest_gain = aim.lean.map_or(0, |_| lean::LARGEST_GAIN);
        for length in 1..=(SIDE * SIDE) as u32 {
            // No frontier from here on can score better than this.
            let bound =
                STEP * (length as i32 - hysteresis) - PER_CELL * LARGEST_BONUS - largest_gain;
            if best.is_some_and(|(score, ..)| score <= bound) {
                break;
            }
            let rows = fronts | fronts << 1 | fronts >> 1;
            fronts = 0;
            let mut mine_left = false;
            let mut above = (0, 0, 0);
            let mut row_above = None;
            for y in bits(u64::from(rows)) {
                *work += 1;
                if row_above != y.checked_sub(1) {
                    above = (0, 0, 0);
                }
                row_above = Some(y);
                let y = y as usize;
                let (new_mine, any) = self.flood_row(y, &mut above);
                if any {
                    fronts |= 1 << y;
                }
                mine_left |= new_mine != 0;
                let hits = new_mine & self.frontier.get(y).copied().unwrap_or(0);
                for column in bits(u64::from(hits)) {
                    let cell = self.window.cell(y, column);
                    let near_goal = aim.goal.is_some_and(|goal| goal.chebyshev(cell) <= 3);
                    let preference = if near_goal { hysteresis } else { 0 };
                    let score = STEP * (length as i32 - preference)
                        - PER_CELL * bonus.at(y, column)
                        - aim.lean.map_or(0, |id| lean::gain(id, own, cell));
                    if best.is_none_or(|(least, ..)| score < least) {
                        best = Some((score, y, column, length));
                    }
                }
            }
            if !mine_left {
                break;
            }
        }
        best.map(|(_, row, column, length)| self.trace(row, column, length, work))
    }

    /// One step of all waves in one row, in place. `above` holds the fronts of the
    /// row above as they were before this layer, and is moved on by one row.
    /// Returns the own new cells, and whether the row holds any front.
    fn flood_row(&mut self, y: usize, above: &mut (u32, u32, u32)) -> (u32, bool) {
        let below = (
            self.mine.get(y + 1).copied().unwrap_or(0),
            self.lower.get(y + 1).copied().unwrap_or(0),
            self.higher.get(y + 1).copied().unwrap_or(0),
        );
        let [parent_low, parent_high] = &mut self.parent;
        let (Some(open), Some(mine), Some(lower), Some(higher)) = (
            self.open.get_mut(y),
            self.mine.get_mut(y),
            self.lower.get_mut(y),
            self.higher.get_mut(y),
        ) else {
            return (0, false);
        };
        let here = (*mine, *lower, *higher);

        *lower = (here.1 << 1 | here.1 >> 1 | above.1 | below.1) & *open;
        *open &= !*lower;

        // Where the wave came from, first match wins: east, south, west, north.
        let from_east = here.0 >> 1 & *open;
        let from_south = below.0 & *open & !from_east;
        let from_west = here.0 << 1 & *open & !(from_east | from_south);
        let from_north = above.0 & *open & !(from_east | from_south | from_west);
        *mine = from_east | from_south | from_west | from_north;
        *open &= !*mine;
        // Direction numbers: east 0, south 1, west 2, north 3.
        if let (Some(low), Some(high)) = (parent_low.get_mut(y), parent_high.get_mut(y)) {
            *low |= from_south | from_north;
            *high |= from_west | from_north;
        }

        *higher = (here.2 << 1 | here.2 >> 1 | above.2 | below.2) & *open;
        *open &= !*higher;

        *above = here;
        (*mine, (*mine | *lower | *higher) != 0)
    }

    /// Follows the parents back to the robot.
    fn trace(&self, row: usize, column: u32, length: u32, work: &mut u32) -> Candidate {
        let goal = self.window.cell(row, column);
        let mut path = Path::new();
        let mut cell = goal;
        for _ in 0..length {
            *work += 1;
            let Some((row, column)) = self.window.place(cell) else {
                break;
            };
            let [low, high] = &self.parent;
            let index = u8::from(get(low, row, column)) | u8::from(get(high, row, column)) << 1;
            let back = Direction::from_index(index);
            path.push_front(back.opposite());
            cell = cell.step(back);
        }
        Candidate { goal, length, path }
    }
}
