//! The near decision: the best frontier within the 4×4 tiles around the robot, by
//! waves over rows of 32 cells.

use super::lean;
use super::others::MAX_OTHERS;
use super::surroundings::Surroundings;
use crate::cell::{Cell, Direction};
use crate::robot::RobotId;
use crate::role::Path;
use crate::tile::{TILE, TileIndex, bits};

/// Side of the window in cells and in tiles.
pub(crate) const SIDE: usize = 32;
const TILES: u8 = 4;
const _: () = assert!(SIDE == u32::BITS as usize, "a row of the window is a u32");
const _: () = assert!(
    SIDE == TILES as usize * TILE,
    "the window is made of whole tiles"
);

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
    /// Tiles that it is made of.
    pub(crate) const TILES: usize = (TILES as usize) * (TILES as usize);

    pub(crate) const fn new() -> Self {
        Self { x: 0, y: 0 }
    }

    /// Whether it holds the tile in this column and row of tiles.
    pub(crate) fn holds(self, (x, y): (i16, i16)) -> bool {
        let side = 0..i32::from(TILES);
        side.contains(&(i32::from(x) - i32::from(self.x)))
            && side.contains(&(i32::from(y) - i32::from(self.y)))
    }

    /// A number below [`Self::TILES`], another one for each tile of a window, and the same
    /// in all windows.
    pub(crate) const fn slot((x, y): (i16, i16)) -> usize {
        const SIDE: i16 = TILES as i16;
        (x.rem_euclid(SIDE) + SIDE * y.rem_euclid(SIDE)) as usize
    }

    /// Its tiles, also those that no map has, each with its slot.
    pub(crate) fn slots(self) -> impl Iterator<Item = ((i16, i16), usize)> {
        (0..i16::from(TILES)).flat_map(move |dy| {
            (0..i16::from(TILES)).map(move |dx| {
                let at = (self.x + dx, self.y + dy);
                (at, Self::slot(at))
            })
        })
    }

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

    /// Gives rows back to the tiles, those that have any. Work: 128 bytes.
    pub(crate) fn split(self, rows: Rows) -> impl Iterator<Item = (TileIndex, u64)> {
        self.tiles().filter_map(move |(at, row, column)| {
            let mut bytes = [0; 8];
            for (byte, row) in bytes.iter_mut().zip(rows.iter().skip(row)) {
                *byte = (row >> column) as u8;
            }
            let cells = u64::from_le_bytes(bytes);
            (cells != 0).then_some((at, cells))
        })
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

/// Rows and layers that a flood looks at before its last layer.
const FLOOD: u32 = 448;

/// What a robot's place costs, in the unit of work: a row.
const OTHER_WORK: u32 = 7;

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

/// One row of the fronts of the waves: the robot's own, and those of robots with lower
/// and with higher ids.
#[derive(Clone, Copy)]
struct Fronts {
    mine: u32,
    lower: u32,
    higher: u32,
}

impl Fronts {
    const NONE: Self = Self {
        mine: 0,
        lower: 0,
        higher: 0,
    };

    const fn all(self) -> u32 {
        self.mine | self.lower | self.higher
    }
}

/// One row of what the near decision works on.
#[derive(Clone, Copy)]
struct Row {
    fronts: Fronts,
    frontier: u32,
    /// Free cells that no wave has reached.
    open: u32,
    /// Direction back to the robot, a bit a plane.
    back: [u32; 2],
}

impl Row {
    const EMPTY: Self = Self {
        fronts: Fronts::NONE,
        frontier: 0,
        open: 0,
        back: [0; 2],
    };

    /// One step of all waves, in place, from the rows above and below as they were.
    #[inline(always)] // in the innermost loop
    fn advance(&mut self, above: Fronts, below: Fronts) {
        let here = self.fronts;
        let mut open = self.open;

        let lower = (here.lower << 1 | here.lower >> 1 | above.lower | below.lower) & open;
        open &= !lower;

        // Where the wave came from, first match wins: east, south, west, north.
        let from_east = here.mine >> 1 & open;
        let from_south = below.mine & open & !from_east;
        let sideways = from_east | from_south;
        let from_west = here.mine << 1 & open & !sideways;
        let from_north = above.mine & open & !(sideways | from_west);
        let mine = sideways | from_west | from_north;
        open &= !mine;
        // Direction numbers: east 0, south 1, west 2, north 3.
        let [low, high] = &mut self.back;
        *low |= from_south | from_north;
        *high |= from_west | from_north;

        let higher = (here.higher << 1 | here.higher >> 1 | above.higher | below.higher) & open;
        self.open = open & !higher;
        self.fronts = Fronts {
            mine,
            lower,
            higher,
        };
    }
}

/// The rows that the near decision works on: 0.9 kB, kept in place, off the stack.
pub(crate) struct NearSearch {
    window: Window,
    /// The last row stays empty: below it ends the window.
    rows: [Row; SIDE + 1],
}

impl NearSearch {
    /// What a near decision costs at most: gathering, and two floods with up to two
    /// places of every robot, a last layer and a way back.
    pub(crate) const LARGEST_WORK: u32 = {
        let side = SIDE as u32;
        let robots = OTHER_WORK * (2 * MAX_OTHERS as u32 + 1);
        5 * side + 2 * (side + robots + FLOOD + 1 + side + FLOOD / 2)
    };

    pub(crate) const fn new() -> Self {
        Self {
            window: Window::new(),
            rows: [Row::EMPTY; SIDE + 1],
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
        let frontier = self.window.load(|at| around.goals(at));
        if frontier.iter().all(|&row| row == 0) {
            return None;
        }
        for (row, frontier) in self.rows.iter_mut().zip(frontier) {
            row.frontier = frontier;
        }
        *work += 4 * SIDE as u32;
        let visited = self.window.load(|at| around.map.tile(at).visited());
        Some(Bonus::of(visited))
    }

    /// The best frontier that the robot is nearer to than anybody else, ties to
    /// the lower id. `others` gives where each other robot is and whether its id is
    /// lower; without any, every frontier counts. What a flood has not met after
    /// [`FLOOD`] rows and layers is not near.
    pub(crate) fn best<const TW: usize, const TH: usize>(
        &mut self,
        around: &Surroundings<TW, TH>,
        aim: &Aim,
        bonus: &Bonus,
        others: impl Iterator<Item = (Cell, bool)>,
        work: &mut u32,
    ) -> Option<Candidate> {
        *work += SIDE as u32;
        let open = self.window.load(|at| around.open(at));
        for (row, open) in self.rows.iter_mut().zip(open) {
            *row = Row {
                frontier: row.frontier,
                open,
                ..Row::EMPTY
            };
        }
        let own = self.window.place(around.position);
        for ((row, column), is_lower) in others
            .filter_map(|(cell, is_lower)| Some((self.window.place(cell)?, Some(is_lower))))
            .chain(own.map(|place| (place, None)))
        {
            *work += OTHER_WORK;
            if let Some(row) = self.rows.get_mut(row) {
                match is_lower {
                    Some(true) => row.fronts.lower |= row.open & 1 << column,
                    Some(false) => row.fronts.higher |= row.open & 1 << column,
                    None => row.fronts.mine |= 1 << column,
                }
            }
        }
        self.flood(around.position, aim, bonus, work)
    }

    /// Waves from everybody at once, a step a layer; each cell belongs to whoever
    /// reaches it first. Each layer looks at the rows beside those of its front.
    fn flood(&mut self, own: Cell, aim: &Aim, bonus: &Bonus, work: &mut u32) -> Option<Candidate> {
        let mut fronts = 0u32;
        for (row, y) in self.rows.iter_mut().zip(0..SIDE as u32) {
            row.fronts.mine &= !row.fronts.lower;
            row.fronts.higher &= !(row.fronts.mine | row.fronts.lower);
            let sources = row.fronts.all();
            row.open &= !sources;
            fronts |= u32::from(sources != 0) << y;
        }

        let mut best: Option<(i32, usize, u32, u32)> = None;
        let hysteresis = i32::from(aim.hysteresis);
        let largest_gain = aim.lean.map_or(0, |_| lean::LARGEST_GAIN);
        let end = *work + FLOOD;
        for length in 1..=(SIDE * SIDE) as u32 {
            // No frontier from here on can score better than this.
            let bound =
                STEP * (length as i32 - hysteresis) - PER_CELL * LARGEST_BONUS - largest_gain;
            if best.is_some_and(|(score, ..)| score <= bound) || *work >= end {
                break;
            }
            *work += 1;
            let mut rows = fronts | fronts << 1 | fronts >> 1;
            fronts = 0;
            let mut mine_left = false;
            let mut above = Fronts::NONE;
            while rows != 0 {
                *work += 1;
                let y = rows.trailing_zeros() as usize;
                rows &= rows - 1;
                let Some([row, below, ..]) = self.rows.get_mut(y..) else {
                    break;
                };
                let before = row.fronts;
                row.advance(above, below.fronts);
                // Where a row is left out, no front comes from above.
                above = if rows >> y & 2 == 0 {
                    Fronts::NONE
                } else {
                    before
                };
                fronts |= u32::from(row.fronts.all() != 0) << y;
                let mine = row.fronts.mine;
                mine_left |= mine != 0;
                for column in bits(u64::from(mine & row.frontier)) {
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
            let Some(row) = self.rows.get(row) else {
                break;
            };
            let [low, high] = row.back.map(|plane| (plane >> column & 1) as u8);
            let back = Direction::from_index(low | high << 1);
            path.push_front(back.opposite());
            cell = cell.step(back);
        }
        Candidate { goal, length, path }
    }
}
