//! The parts against obviously correct slow ones.

use proptest::prelude::*;

use super::*;
use crate::local_frontiers::view::{SPAN, Window};
use crate::sight::look;

const EXTENT: Extent = Extent::new(24, 24);

/// A robot's map and view after a few looks, and a cell of the last view.
fn scene() -> impl Strategy<Value = (Map<3, 3>, View, Cell, u8)> {
    let walls = proptest::collection::vec(proptest::bool::weighted(0.25), 24 * 24);
    let centres = proptest::collection::vec((0i16..24, 0i16..24), 1..4);
    let visits = proptest::collection::vec((0i16..24, 0i16..24), 0..12);
    (walls, centres, visits, 1u8..=15).prop_map(|(walls, centres, visits, radius)| {
        let mut map = Map::new(EXTENT).unwrap();
        let mut own = Cell::new(0, 0);
        let mut view = View::vacant();
        for (x, y) in centres {
            own = Cell::new(x, y);
            let wall = |cell: Cell| {
                !EXTENT.contains(cell) || cell != own && walls[(cell.y * 24 + cell.x) as usize]
            };
            let sighting = look(own, radius, wall);
            map.observe(&sighting);
            view = View::of(&sighting);
        }
        for (x, y) in visits {
            map.stand(Cell::new(x, y));
        }
        (map, view, own, radius)
    })
}

fn all_cells() -> impl Iterator<Item = Cell> {
    (0..24).flat_map(|y| (0..24).map(move |x| Cell::new(x, y)))
}

/// The lengths of shortest ways through open cells, by relaxation.
fn distances(window: &Window, from: Cell) -> std::collections::BTreeMap<Cell, u32> {
    let mut known = std::collections::BTreeMap::from([(from, 0)]);
    let mut layer = std::vec![from];
    for distance in 1.. {
        let mut next = Vec::new();
        for cell in layer {
            for direction in Direction::ALL {
                let neighbour = cell.step(direction);
                if window.is_open(neighbour) && !known.contains_key(&neighbour) {
                    known.insert(neighbour, distance);
                    next.push(neighbour);
                }
            }
        }
        if next.is_empty() {
            break;
        }
        layer = next;
    }
    known
}

proptest! {
    #[test]
    fn frontiers_in_view_are_those_of_the_map((map, view, own, radius) in scene()) {
        for neighbourhood in [Neighbourhood::Four, Neighbourhood::Eight] {
            let mut window = Window::new(&view, &map, core::iter::empty(), own);
            let frontiers = window.frontiers(&map, neighbourhood);
            // The own cell is open even where the map knows better, and no candidate.
            for cell in all_cells().filter(|&cell| cell != own) {
                let (row, column) = (cell.y - own.y + 15, cell.x - own.x + 15);
                let inside = 0..SPAN as i16;
                let found = inside.contains(&row) && inside.contains(&column)
                    && frontiers[row as usize] >> column & 1 == 1;
                let expected = window.is_open(cell) && neighbourhood.is_frontier(&map, cell);
                prop_assert_eq!(found, expected, "{} from {} radius {}", cell, own, radius);
            }
        }
    }

    #[test]
    fn ways_are_shortest((map, view, own, _) in scene(), score in any::<u32>(), turn in any::<u8>()) {
        let mut window = Window::new(&view, &map, core::iter::empty(), own);
        let distances = distances(&window, own);
        for cell in all_cells() {
            if cell == own || !window.is_open(cell) {
                continue;
            }
            let step = window.first_step(own, cell);
            prop_assert_eq!(step.is_some(), distances.contains_key(&cell));
            if let Some(step) = step {
                let rest = self::distances(&window, own.step(step));
                prop_assert_eq!(rest[&cell] + 1, distances[&cell]);
            }
        }
        // Any score: the best one, then the shortest way, then by rows.
        let score = |cell: Cell| (cell.x as u32 ^ cell.y as u32 ^ score) & 3;
        let open = window.open();
        let found = window.best_reached(own, &open, turn, score);
        let others = || distances.iter().filter(|(cell, _)| **cell != own);
        let highest = others().map(|(cell, _)| score(*cell)).max();
        let mut equals: Vec<_> = others()
            .filter(|(cell, _)| Some(score(**cell)) == highest)
            .map(|(cell, distance)| (*distance, cell.y, cell.x))
            .collect();
        equals.sort();
        let expected = usize::from(turn).checked_rem(equals.len()).map(|i| equals[i]);
        prop_assert_eq!(found, expected.map(|(_, y, x)| Cell::new(x, y)));
    }

    #[test]
    fn the_nearest_visited_cell_is_found((map, view, own, _) in scene()) {
        let mut window = Window::new(&view, &map, core::iter::empty(), own);
        let visited = window.visited(&map);
        let mut work = 0;
        for cell in all_cells().filter(|&cell| window.is_open(cell)) {
            for distance in [Distance::Euclidean, Distance::Manhattan] {
                let expected = all_cells()
                    .filter(|&other| map.is_visited(other))
                    .map(|other| (other.x.abs_diff(cell.x).into(), other.y.abs_diff(cell.y).into()))
                    .filter(|&(dx, dy): &(u32, u32)| dx <= 16 && dy <= 16)
                    .map(|(dx, dy)| distance.measure(dx, dy))
                    .min();
                let found = visited.distance(cell, distance, &mut work);
                prop_assert_eq!(found, expected.unwrap_or(u32::MAX));
            }
        }
    }
}

#[test]
fn ranks_grow_along_the_way_and_never_change() {
    let mut trace = Trace::<2, 2>::new();
    for (x, rank) in [(6, 1), (7, 2), (8, 3), (7, 2), (6, 1)] {
        trace.mark(Cell::new(x, 9));
        assert_eq!(trace.rank(Cell::new(x, 9)), rank);
    }
    for outside in [
        Cell::new(-1, 0),
        Cell::new(0, 16),
        Cell::new(i16::MAX, i16::MIN),
    ] {
        trace.mark(outside);
        assert_eq!(trace.rank(outside), 0);
    }
    trace.clear();
    assert!(trace == Trace::new());
}

#[test]
fn others_count_while_they_explore_and_are_heard() {
    let mut others = Others::new();
    for id in 0..=255 {
        others.hear(RobotId(id), Activity::Exploring);
    }
    for id in 0..255 {
        assert!(others.anybody_explores());
        let activity = [Activity::Stopped, Activity::SecondChance][usize::from(id) % 2];
        others.hear(RobotId(id), activity);
    }
    let mut ticks = 0;
    while others.anybody_explores() {
        others.age(10);
        ticks += 1;
    }
    assert!((10..=22).contains(&ticks), "{ticks}");
    assert!(others == Others::new());
}

#[test]
fn closed_cells_open_later_each_time() {
    let mut closed = Closed::new();
    let cell = Cell::new(3, 4);
    for expected in [4, 8, 16, 32, 64, 64] {
        closed.close(cell);
        let mut ticks = 0;
        while closed.contains(cell) {
            closed.age();
            ticks += 1;
        }
        assert_eq!(ticks, expected);
    }
    closed.renew();
    // More than fit: the newest are all there.
    for x in 0..20 {
        closed.close(Cell::new(x, 0));
        assert!(closed.contains(Cell::new(x, 0)));
    }
    assert_eq!(closed.iter().count(), 8);
    assert!(closed.is_hopeless());
}
