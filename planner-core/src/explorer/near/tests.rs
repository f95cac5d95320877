//! The near decision against a rule that goes cell by cell.

use std::boxed::Box;
use std::collections::{HashMap, VecDeque};
use std::vec::Vec;

use proptest::prelude::*;

use super::*;
use crate::cell::Extent;
use crate::explorer::aside::Aside;
use crate::map::{Map, Tile};
use crate::tile::every_tile;

/// Tiles along a side of the map.
const TILES: usize = 4;

fn cell() -> impl Strategy<Value = Cell> {
    (0..SIDE as i16, 0..SIDE as i16).prop_map(|(x, y)| Cell::new(x, y))
}

/// Steps from the nearest of some cells, over free cells of the window.
fn distances(
    around: &Surroundings<TILES, TILES>,
    window: Window,
    from: &[Cell],
) -> HashMap<Cell, u32> {
    let mut steps: HashMap<Cell, u32> = from.iter().map(|&cell| (cell, 0)).collect();
    let mut queue: VecDeque<Cell> = from.iter().copied().collect();
    while let Some(cell) = queue.pop_front() {
        for beside in Direction::ALL.map(|side| cell.step(side)) {
            let can = around.is_open(beside) && window.place(beside).is_some();
            if can && !steps.contains_key(&beside) {
                steps.insert(beside, steps[&cell] + 1);
                queue.push_back(beside);
            }
        }
    }
    steps
}

/// How often the visited cells must grow to cover a cell, cell by cell.
fn bonus(around: &Surroundings<TILES, TILES>, window: Window, cell: Cell) -> i32 {
    let mut near: Vec<Cell> = (0..SIDE)
        .flat_map(|row| (0..SIDE as u32).map(move |column| window.cell(row, column)))
        .filter(|&cell| around.map.is_visited(cell))
        .collect();
    for growth in 0..LARGEST_BONUS - 1 {
        let mut grown = near.clone();
        for &from in &near {
            for (dx, dy) in (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| (dx, dy))) {
                let to = Cell::new(from.x + dx, from.y + dy);
                let beside = growth % 2 == 1 || dx == 0 || dy == 0;
                if beside && window.place(to).is_some() {
                    grown.push(to);
                }
            }
        }
        grown.sort();
        grown.dedup();
        near = grown;
        if near.contains(&cell) {
            return growth + 1;
        }
    }
    LARGEST_BONUS
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(if cfg!(miri) { 1 } else { 64 }))]
    #[test]
    fn the_best_are_those_that_a_rule_cell_by_cell_finds(
        kinds in proptest::collection::vec(
            prop_oneof![1 => Just(0u8), 8 => Just(1u8), 30 => Just(2u8), 1 => Just(3u8)],
            SIDE * SIDE,
        ),
        own in (8i16..24, 8i16..24),
        lower in proptest::collection::vec(cell(), 0..4),
        higher in proptest::collection::vec(cell(), 0..4),
        goal in proptest::option::of(cell()),
        lean in proptest::option::of(0u8..8),
        wants_any: bool,
    ) {
        let own = Cell::new(own.0, own.1);
        let mut map = Map::new(Extent::new(SIDE as u16, SIDE as u16)).unwrap();
        for at in every_tile(TILES, TILES) {
            let of = |is: fn(u8) -> bool| {
                let kind = |bit: &u32| {
                    let Cell { x, y } = at.cell(*bit);
                    kinds[y as usize * SIDE + x as usize]
                };
                (0..64).filter(|bit| is(kind(bit))).fold(0, |cells, bit| cells | 1u64 << bit)
            };
            map.join_tile(at, Tile::seen(of(|kind| kind > 1), of(|kind| kind == 1)));
        }
        for (&kind, place) in kinds.iter().zip(0i16..) {
            if kind == 3 {
                map.stand(Cell::new(place % SIDE as i16, place / SIDE as i16));
            }
        }
        map.stand(own);
        let around = Surroundings {
            clearance: 0,
            map,
            aside: Aside::new(),
            visits: heapless::Vec::new(),
            position: own,
            now: 0,
        };
        let aim = Aim { goal, hysteresis: 3, lean: lean.map(RobotId) };
        let mut near = Box::new(NearSearch::new());
        let mut work = 0;
        let Some(of_all) = near.load(&around, &mut work) else {
            return Ok(());
        };
        let others = lower.iter().map(|&cell| (cell, true));
        let others = others.chain(higher.iter().map(|&cell| (cell, false)));
        let before = work;
        let best = near.best(own, &aim, &of_all, others, wants_any, &mut work);
        let rows = (work - before) / ROW_WORK;
        // What is cut off is another matter. A layer counts as a row more, and has two at least.
        prop_assume!(rows + rows / 2 < FLOOD);

        let window = Window::around(own);
        let free = |cells: &[Cell]| -> Vec<Cell> {
            let is_near = |cell: &Cell| around.is_open(*cell) && window.place(*cell).is_some();
            cells.iter().copied().filter(is_near).collect()
        };
        let of_own = distances(&around, window, &[own]);
        let of_lower = distances(&around, window, &free(&lower));
        let of_higher = distances(&around, window, &free(&higher));
        let mut expected: [Option<(i32, Cell, u32)>; 2] = [None; 2];
        let mut cells: Vec<_> = of_own.iter().map(|(&cell, &steps)| (steps, cell)).collect();
        cells.sort_by_key(|&(steps, cell)| (steps, cell.y, cell.x));
        for (steps, cell) in cells {
            if steps == 0 || !around.is_goal(cell) {
                continue;
            }
            let preference = if goal.is_some_and(|goal| goal.chebyshev(cell) <= 3) { 3 } else { 0 };
            let score = STEP * (steps as i32 - preference)
                - PER_CELL * bonus(&around, window, cell)
                - aim.lean.map_or(0, |id| lean::gain(id, own, cell));
            let is_mine = of_lower.get(&cell).is_none_or(|&lower| steps < lower)
                && of_higher.get(&cell).is_none_or(|&higher| steps <= higher);
            for (best, counts) in expected.iter_mut().zip([is_mine, true]) {
                if counts && best.is_none_or(|(least, ..)| score < least) {
                    *best = Some((score, cell, steps));
                }
            }
        }
        let [mine, any] = expected.map(|best| best.map(|(_, cell, steps)| (cell, steps)));
        let found = near.mine(&best, &mut work);
        prop_assert_eq!(found.map(|way| (way.goal, way.length)), mine);
        let found = if wants_any && mine.is_none() {
            let found = near.any(&best, &mut work);
            prop_assert_eq!(found.map(|way| (way.goal, way.length)), any);
            found
        } else {
            found
        };
        prop_assert!(work <= NearSearch::LARGEST_WORK);
        // The way leads there by the first of the ways back.
        let Some(way) = found else {
            return Ok(());
        };
        let mut back = way.goal;
        let mut steps = Vec::new();
        while of_own[&back] > 0 {
            let is_nearer = |side: &Direction| {
                of_own.get(&back.step(*side)).is_some_and(|&steps| steps < of_own[&back])
            };
            let side = Direction::ALL.into_iter().find(is_nearer).unwrap();
            steps.push(side.opposite());
            back = back.step(side);
        }
        let mut path = way.path;
        let path: Vec<_> = core::iter::from_fn(|| path.pop_front()).collect();
        steps.reverse();
        prop_assert_eq!(path, steps);
    }
}
