//! The columns that a robot saw first in its last few steps, and how many robots
//! saw them first together with it.

use crate::cell::Cell;
use crate::point::Point;
use crate::radio::MAX_PEERS;
use crate::tile::{TILE, TileIndex, bits};

/// Tiles along one side of the window around a robot.
const WINDOW: usize = 4;

/// Longest sensor range for which the window covers every column in range, however
/// the robot stands on the tiles.
pub const MAX_RANGE: f32 = 12.0;
const _: () = assert!(
    2 * MAX_RANGE as usize + TILE <= WINDOW * TILE,
    "the window holds every column in range, wherever in its tile the robot is"
);

/// Steps for which own discoveries are repeated to the others, so that a lost message
/// does little harm.
pub(super) const REPEATS: usize = 4;

/// A layer of bits on the tiles around a robot.
#[derive(Clone, Copy, Debug)]
struct Window {
    /// The north-west tile, in tiles; may lie outside the map.
    origin: (i16, i16),
    words: [[u64; WINDOW]; WINDOW],
}

impl Window {
    const EMPTY: Self = Self {
        origin: (0, 0),
        words: [[0; WINDOW]; WINDOW],
    };

    fn word_mut(&mut self, tile: TileIndex) -> Option<&mut u64> {
        let x = usize::try_from(i16::from(tile.x) - self.origin.0).ok()?;
        let y = usize::try_from(i16::from(tile.y) - self.origin.1).ok()?;
        self.words.get_mut(y)?.get_mut(x)
    }

    fn word(mut self, tile: TileIndex) -> u64 {
        self.word_mut(tile).map_or(0, |word| *word)
    }

    /// The tiles inside the map with a bit set.
    fn tiles(self) -> impl Iterator<Item = (TileIndex, u64)> {
        self.words
            .into_iter()
            .enumerate()
            .flat_map(move |(y, row)| {
                row.into_iter().enumerate().filter_map(move |(x, word)| {
                    let x = u8::try_from(self.origin.0.saturating_add(x as i16)).ok()?;
                    let y = u8::try_from(self.origin.1.saturating_add(y as i16)).ok()?;
                    (word != 0).then_some((TileIndex { x, y }, word))
                })
            })
    }
}

/// What this robot saw first, by step, the current one in front; and for the
/// current step, per column, how many others saw it first too.
#[derive(Clone, Debug)]
pub(super) struct News {
    steps: [Window; REPEATS],
    /// Those of them that were not yet sent in this step.
    unsent: [Window; REPEATS],
    /// Bit k of the number of others, in the words of plane k.
    others: [Window; COUNT_BITS],
}

/// Bits of the number of others.
const COUNT_BITS: usize = 4;
const _: () = assert!(
    MAX_PEERS < 1 << COUNT_BITS,
    "the number of robots that saw a column too must fit"
);

impl News {
    pub(super) const fn new() -> Self {
        Self {
            steps: [Window::EMPTY; REPEATS],
            unsent: [Window::EMPTY; REPEATS],
            others: [Window::EMPTY; COUNT_BITS],
        }
    }

    /// Begins a step of a robot at `at`.
    pub(super) fn begin(&mut self, at: Point) {
        let cell = at.cell();
        let reach = MAX_RANGE as i16;
        let origin = (
            cell.x.saturating_sub(reach) >> 3,
            cell.y.saturating_sub(reach) >> 3,
        );
        let fresh = Window {
            origin,
            ..Window::EMPTY
        };
        self.steps.rotate_right(1);
        if let Some(current) = self.steps.first_mut() {
            *current = fresh;
        }
        self.others = [fresh; COUNT_BITS];
        self.unsent = self.steps;
    }

    /// The robot itself sees `cell` for the first time.
    pub(super) fn add(&mut self, cell: Cell) {
        let Some((tile, bit)) = TileIndex::of(cell) else {
            return;
        };
        for windows in [&mut self.steps, &mut self.unsent] {
            if let Some(word) = windows.first_mut().and_then(|step| step.word_mut(tile)) {
                *word |= bit;
            }
        }
    }

    /// Columns to send next, newest first, and whether they are of this very step.
    pub(super) fn next_unsent(&self) -> Option<(TileIndex, u64, bool)> {
        (0..).zip(&self.unsent).find_map(|(age, step)| {
            let (tile, cells) = step.tiles().next()?;
            Some((tile, cells, age == 0))
        })
    }

    /// These columns were sent: they wait for the next step.
    pub(super) fn mark_sent(&mut self, tile: TileIndex, cells: u64) {
        let waiting = |step: &&mut Window| step.word(tile) & cells != 0;
        if let Some(word) = self
            .unsent
            .iter_mut()
            .find(waiting)
            .and_then(|step| step.word_mut(tile))
        {
            *word &= !cells;
        }
    }

    /// Another robot saw `cells` of `tile` first in this same step.
    pub(super) fn share(&mut self, tile: TileIndex, cells: u64) {
        let mut carry = cells & self.steps.first().map_or(0, |step| step.word(tile));
        for plane in &mut self.others {
            if let Some(word) = plane.word_mut(tile) {
                let overflow = *word & carry;
                *word ^= carry;
                carry = overflow;
            }
        }
    }

    /// The reward of this step: Σ 1/|e(s)| over the columns s that this robot is
    /// among the first to see.
    // [Renzaglia2019 eq. 1]
    pub(super) fn reward(&self) -> f32 {
        let Some(own) = self.steps.first() else {
            return 0.0;
        };
        let mut reward = 0.0;
        for (tile, word) in own.tiles() {
            for bit in bits(word) {
                let others = self.others.iter().rev().fold(0u8, |number, plane| {
                    number << 1 | (plane.word(tile) >> bit & 1) as u8
                });
                reward += 1.0 / (1.0 + f32::from(others));
            }
        }
        reward
    }

    /// Tiles with own discoveries of the step `age` steps ago, and which cells.
    pub(super) fn tiles(&self, age: usize) -> impl Iterator<Item = (TileIndex, u64)> + use<> {
        self.steps
            .get(age)
            .copied()
            .unwrap_or(Window::EMPTY)
            .tiles()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_column_seen_by_n_robots_is_worth_one_nth_to_each() {
        let mut news = News::new();
        news.begin(Point::new(20.0, 20.0, 5.0));
        let cell = Cell::new(12, 27);
        let (tile, bit) = TileIndex::of(cell).unwrap();
        news.add(cell);
        for others in 1..=15u8 {
            news.share(tile, !0);
            assert_eq!(news.reward(), 1.0 / f32::from(others + 1));
        }
        assert_eq!(news.tiles(0).collect::<std::vec::Vec<_>>(), [(tile, bit)]);
        news.begin(Point::new(21.0, 20.0, 5.0));
        assert_eq!(news.reward(), 0.0);
        assert_eq!(news.tiles(1).count(), 1);
    }

    /// Every column within [`MAX_RANGE`] has a place, wherever the robot stands.
    #[test]
    fn the_window_covers_the_range() {
        for x in 12..40 {
            let at = Point::new(x as f32 + 0.99, 30.01, 5.0);
            let mut news = News::new();
            news.begin(at);
            let reach = MAX_RANGE as i16;
            let cells = [
                Cell::new(x - reach, 30),
                Cell::new(x + reach, 30),
                Cell::new(x, 30 - reach),
                Cell::new(x, 30 + reach),
            ];
            for cell in cells {
                news.add(cell);
            }
            assert_eq!(news.reward(), 4.0);
        }
    }
}
