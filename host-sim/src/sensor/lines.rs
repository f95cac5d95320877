//! What must be free for a cell to be in sight, worked out once for each offset.

use std::sync::OnceLock;

use planner_core::Cell;
use planner_core::sight::{LongSighting, MAX_LONG_RADIUS, line_of_sight};

use crate::world::World;

/// The window around a robot: as many rows and columns as a [`LongSighting`] has, and the
/// same bits.
const SPAN: usize = 2 * MAX_LONG_RADIUS as usize + 1;
const MIDDLE: i16 = MAX_LONG_RADIUS as i16;

/// Blocked cells of the window.
type Window = [u64; SPAN];

/// The obstacles of a world as rows of bits, with blocked cells all around.
#[derive(Debug)]
pub(super) struct Obstacles {
    /// Words in a row.
    words: usize,
    bits: Vec<u64>,
}

impl Obstacles {
    pub(super) fn of(world: &World) -> Self {
        let extent = world.extent();
        let margin = 2 * usize::from(MAX_LONG_RADIUS);
        let words = (usize::from(extent.width) + margin).div_ceil(64) + 1;
        let rows = usize::from(extent.height) + margin;
        let mut bits = vec![u64::MAX; words * rows];
        for cell in world.free_cells() {
            let (x, y) = ((cell.x + MIDDLE) as usize, (cell.y + MIDDLE) as usize);
            bits[y * words + x / 64] &= !(1 << (x % 64));
        }
        Self { words, bits }
    }

    /// The window around a cell of the world, its rows within `range` alone.
    fn around(&self, cell: Cell, range: u8) -> Window {
        let (x, y) = (cell.x as usize, cell.y as usize);
        let mut window = [u64::MAX; SPAN];
        let rows = usize::from(MAX_LONG_RADIUS - range)..=usize::from(MAX_LONG_RADIUS + range);
        for row in rows {
            let first = (y + row) * self.words + x / 64;
            let pair = u128::from(self.bits[first]) | u128::from(self.bits[first + 1]) << 64;
            window[row] = (pair >> (x % 64)) as u64;
        }
        window
    }
}

/// A part of a row of the window.
#[derive(Clone, Copy, Debug)]
struct Part {
    row: usize,
    bits: u64,
}

impl Part {
    fn at(dx: i16, dy: i16) -> Self {
        Self {
            row: (dy + MIDDLE) as usize,
            bits: 1 << (dx + MIDDLE),
        }
    }

    fn is_in(self, window: &Window) -> bool {
        window[self.row] & self.bits != 0
    }
}

/// One cell of a disc.
#[derive(Debug)]
struct Line {
    to: Part,
    /// None of these may be blocked.
    free: Vec<Part>,
    /// Nor both of any of these: corners that the line goes through.
    corners: Vec<[Part; 2]>,
}

/// The lines to all cells of a disc, for all robots that see so far.
pub(super) fn lines(range: u8) -> &'static Lines {
    static ALL: [OnceLock<Lines>; MAX_LONG_RADIUS as usize + 1] =
        [const { OnceLock::new() }; MAX_LONG_RADIUS as usize + 1];
    let range = range.min(MAX_LONG_RADIUS);
    ALL[usize::from(range)].get_or_init(|| Lines::new(range))
}

/// The lines to all cells within a range.
#[derive(Debug)]
pub(super) struct Lines {
    range: u8,
    lines: Vec<Line>,
}

impl Lines {
    fn new(range: u8) -> Self {
        let reach = i16::from(range);
        let offsets = (-reach..=reach).flat_map(|dy| (-reach..=reach).map(move |dx| (dx, dy)));
        let near = offsets.filter(|&(dx, dy)| dx * dx + dy * dy <= reach * reach);
        let others = near.filter(|&offset| offset != (0, 0));
        Self {
            range,
            lines: others.map(|(dx, dy)| Line::new(dx, dy)).collect(),
        }
    }

    /// What [`look_far`](planner_core::sight::look_far) shows in a world where the cells of `more`
    /// are blocked too.
    pub(super) fn look(&self, obstacles: &Obstacles, from: Cell, more: &[Cell]) -> LongSighting {
        let mut window = obstacles.around(from, self.range);
        for cell in more {
            let (dx, dy) = (cell.x - from.x, cell.y - from.y);
            if dx.abs().max(dy.abs()) <= MIDDLE {
                let part = Part::at(dx, dy);
                window[part.row] |= part.bits;
            }
        }
        let mut seen = [0; SPAN];
        for line in &self.lines {
            let is_in_sight = !line.free.iter().any(|part| part.is_in(&window))
                && !line
                    .corners
                    .iter()
                    .any(|pair| pair.iter().all(|part| part.is_in(&window)));
            if is_in_sight {
                seen[line.to.row] |= line.to.bits;
            }
        }
        let mut sighting = LongSighting::new(from);
        for ((seen, blocked), dy) in seen.iter().zip(&window).zip(-MIDDLE..) {
            sighting.see_row(dy, seen & !blocked, seen & blocked);
        }
        sighting
    }
}

impl Line {
    /// The line to an offset. Whether it is stopped by one cell alone, or by two together,
    /// [`line_of_sight`] tells.
    fn new(dx: i16, dy: i16) -> Self {
        let (here, to) = (Cell::new(0, 0), Cell::new(dx, dy));
        let is_stopped_by =
            |blocked: &[Cell]| !line_of_sight(here, to, |cell| blocked.contains(&cell));
        let (columns, rows) = (0.min(dx)..=0.max(dx), 0.min(dy)..=0.max(dy));
        let between = rows.flat_map(|y| columns.clone().map(move |x| Cell::new(x, y)));
        let between: Vec<Cell> = between.filter(|&cell| cell != here && cell != to).collect();
        let (alone, rest): (Vec<Cell>, Vec<Cell>) =
            between.iter().partition(|&&cell| is_stopped_by(&[cell]));
        let mut free: Vec<Part> = Vec::new();
        for cell in alone {
            let part = Part::at(cell.x, cell.y);
            match free.iter_mut().find(|known| known.row == part.row) {
                Some(known) => known.bits |= part.bits,
                None => free.push(part),
            }
        }
        let part = |cell: Cell| Part::at(cell.x, cell.y);
        let mut corners = Vec::new();
        for (index, &one) in rest.iter().enumerate() {
            // The two cells beside a corner touch it from opposite sides.
            let beside = rest[index + 1..]
                .iter()
                .filter(|other| other.distance_squared(one) == 2);
            let stop = beside.filter(|&&other| is_stopped_by(&[one, other]));
            corners.extend(stop.map(|&other| [part(one), part(other)]));
        }
        Self {
            to: part(to),
            free,
            corners,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dice::Dice;
    use planner_core::{Extent, sight};

    #[test]
    fn masks_show_what_lines_of_sight_show() {
        for seed in 0..40 {
            let mut dice = Dice::new(seed);
            let density = [5, 15, 30, 50][seed as usize % 4];
            let extent = Extent::new(3 + 2 * seed as u16, 70 - seed as u16);
            let world = World::from_fn("any", extent, |cell| {
                cell != Cell::new(1, 1) && dice.chance(density)
            });
            let world = world.unwrap();
            let obstacles = Obstacles::of(&world);
            let range = 1 + (seed % 31) as u8;
            for from in world.free_cells() {
                let more = [from.step(planner_core::Direction::East), Cell::new(0, 30)];
                for more in [&more[..0], &more] {
                    let is_blocked = |cell| !world.is_free(cell) || more.contains(&cell);
                    let shown = lines(range).look(&obstacles, from, more);
                    assert_eq!(shown, sight::look_far(from, range, is_blocked));
                    if range <= sight::MAX_RADIUS {
                        assert_eq!(shown.near(), sight::look(from, range, is_blocked));
                    }
                }
            }
        }
    }
}
