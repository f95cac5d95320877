//! The frontier cells that a robot speaks for when it goes to one of them: it will see
//! what lies behind them.

use super::window::{Rows, SIDE, Window};
use crate::cell::Cell;
use crate::tile::TileIndex;

/// How far from the goal, each way: what the usual sensor sees at once.
const REACH: usize = 5;
const _: () = assert!(
    REACH <= 12,
    "the window around a cell reaches at least 12 cells"
);

/// Rounds of growth at most; what winds more is left to others.
const ROUNDS: u32 = 2 * REACH as u32;

/// Of a layer of the map the cells that are 8-connected to `goal` within 5 cells each
/// way, tile by tile. Work: 256 bytes, and 10 rounds over 11 rows.
pub(crate) fn connected(
    goal: Cell,
    layer: impl FnOnce(Window) -> Rows,
) -> impl Iterator<Item = (TileIndex, u64)> {
    let window = Window::around(goal);
    let mut rows = layer(window);
    if let Some((row, column)) = window.place(goal) {
        keep_connected(&mut rows, row, column);
    }
    window.split(rows)
}

/// Clears all cells but those connected to the one in this row and column.
fn keep_connected(rows: &mut Rows, row: usize, column: u32) {
    let first = row.saturating_sub(REACH);
    let columns = (1u32 << (2 * REACH + 1)) - 1;
    let columns = columns << column.saturating_sub(REACH as u32);
    let mut found = [0u32; SIDE];
    if let Some(row) = found.get_mut(row) {
        *row = 1 << column;
    }
    for _ in 0..ROUNDS {
        let mut above = 0;
        let mut grew = false;
        for y in first..=row + REACH {
            let below = found.get(y + 1).copied().unwrap_or(0);
            let cells = rows.get(y).copied().unwrap_or(0) & columns;
            if let Some(row) = found.get_mut(y) {
                let near = above | *row | below;
                let grown = *row | (near | near << 1 | near >> 1) & cells;
                grew |= grown != *row;
                *row = grown;
                above = grown;
            }
        }
        if !grew {
            break;
        }
    }
    *rows = found;
}

#[cfg(test)]
mod tests {
    use std::collections::{HashMap, HashSet};

    use proptest::prelude::*;

    use super::*;
    use crate::tile::bits;

    /// A layer with the cells that a draw gives, around `(20, 20)`.
    fn layer(cells: &[bool], width: i16) -> (HashSet<Cell>, HashMap<TileIndex, u64>) {
        let mut set = HashSet::new();
        let mut tiles = HashMap::new();
        for (&is_set, i) in cells.iter().zip(0i16..) {
            let cell = Cell::new(12 + i % width, 12 + i / width);
            if is_set && let Some((at, bit)) = TileIndex::of(cell) {
                set.insert(cell);
                *tiles.entry(at).or_insert(0) |= bit;
            }
        }
        (set, tiles)
    }

    proptest! {
        #[test]
        fn connected_cells_are_those_that_a_walk_reaches(
            cells in proptest::collection::vec(proptest::bool::weighted(0.4), 17 * 17),
            x in 14i16..27, y in 14i16..27,
        ) {
            let (mut set, mut tiles) = layer(&cells, 17);
            let goal = Cell::new(x, y);
            set.insert(goal);
            if let Some((at, bit)) = TileIndex::of(goal) {
                *tiles.entry(at).or_insert(0) |= bit;
            }
            // A walk of king's moves over cells of the layer that stays within reach.
            let mut reached = HashSet::from([goal]);
            let mut to_visit = std::vec![goal];
            while let Some(cell) = to_visit.pop() {
                for near in &set {
                    let is_near = near.chebyshev(cell) <= 1 && near.chebyshev(goal) <= REACH as u16;
                    if is_near && reached.insert(*near) {
                        to_visit.push(*near);
                    }
                }
            }
            let mut found = HashSet::new();
            for (at, cells) in connected(goal, |window| window.load(|at| tiles.get(&at).copied().unwrap_or(0))) {
                found.extend(bits(cells).map(|bit| at.cell(bit)));
            }
            prop_assert!(found.is_subset(&reached));
            // What is missing winds: it is more king's moves away than there are rounds.
            let mut within = HashSet::from([goal]);
            for _ in 0..ROUNDS {
                let grown: HashSet<Cell> = reached
                    .iter()
                    .filter(|cell| within.iter().any(|near| near.chebyshev(**cell) <= 1))
                    .copied()
                    .collect();
                within = grown;
            }
            prop_assert!(within.is_subset(&found));
        }
    }

    #[test]
    fn a_line_is_spoken_for_five_cells_each_way() {
        let row = |at: TileIndex| if at.y == 1 { 0xff << 16 } else { 0 };
        let goal = Cell::new(17, 10);
        let found: HashSet<Cell> = connected(goal, |window| window.load(row))
            .flat_map(|(at, cells)| bits(cells).map(move |bit| at.cell(bit)))
            .collect();
        let expected: HashSet<Cell> = (12..=22).map(|x| Cell::new(x, 10)).collect();
        assert_eq!(found, expected);
    }
}
