use std::format;
use std::vec;
use std::vec::Vec;

use proptest::prelude::*;

use super::*;
use crate::sight::look;

type Small = Map<4, 3>;
const EXTENT: Extent = Extent::new(29, 19);

/// The obviously correct map.
#[derive(Clone, PartialEq, Debug)]
struct Naive {
    known: Vec<bool>,
    obstacle: Vec<bool>,
    visited: Vec<bool>,
}

fn all_cells() -> impl Iterator<Item = Cell> {
    (0..EXTENT.height as i16).flat_map(|y| (0..EXTENT.width as i16).map(move |x| Cell::new(x, y)))
}

fn index(cell: Cell) -> usize {
    cell.y as usize * usize::from(EXTENT.width) + cell.x as usize
}

impl Naive {
    fn new() -> Self {
        let nothing = vec![false; EXTENT.cells() as usize];
        Self {
            known: nothing.clone(),
            obstacle: nothing.clone(),
            visited: nothing,
        }
    }

    fn is_frontier(&self, cell: Cell) -> bool {
        self.known[index(cell)]
            && !self.obstacle[index(cell)]
            && Direction::ALL.into_iter().any(|direction| {
                let next = cell.step(direction);
                EXTENT.contains(next) && !self.known[index(next)]
            })
    }
}

fn assert_same(map: &Small, naive: &Naive) {
    for cell in all_cells() {
        assert_eq!(map.is_known(cell), naive.known[index(cell)], "{cell}");
        assert_eq!(map.is_obstacle(cell), naive.obstacle[index(cell)], "{cell}");
        assert_eq!(map.is_visited(cell), naive.visited[index(cell)], "{cell}");
        assert_eq!(map.is_frontier(cell), naive.is_frontier(cell), "{cell}");
    }
    let frontiers = all_cells().filter(|&cell| naive.is_frontier(cell)).count();
    assert_eq!(map.frontiers() as usize, frontiers);
    let unknown = naive.known.iter().filter(|&&known| !known).count();
    assert_eq!(map.unknown_cells() as usize, unknown);
    let (east, south) = (EXTENT.width as i16 - 1, EXTENT.height as i16 - 1);
    let edge = all_cells().filter(|cell| {
        let is_free = naive.known[index(*cell)] && !naive.obstacle[index(*cell)];
        is_free && (cell.x == 0 || cell.y == 0 || cell.x == east || cell.y == south)
    });
    assert_eq!(map.free_edge_cells() as usize, edge.count());
}

/// Tiles as frames may carry them: not only valid ones.
fn tile() -> impl Strategy<Value = Tile> {
    let layer = || prop_oneof![any::<u64>(), any::<(u64, u64)>().prop_map(|(a, b)| a & b)];
    (layer(), layer(), layer()).prop_map(|(known, obstacle, visited)| Tile {
        known,
        obstacle,
        visited,
    })
}

fn tiles() -> impl Strategy<Value = Vec<(TileIndex, Tile)>> {
    let at = (0u8..5, 0u8..4).prop_map(|(x, y)| TileIndex { x, y });
    proptest::collection::vec((at, tile()), 0..12)
}

fn map_of(tiles: &[(TileIndex, Tile)]) -> Small {
    let mut map = Small::new(EXTENT).unwrap();
    for &(at, tile) in tiles {
        map.join_tile(at, tile);
    }
    map.take_changed();
    map
}

fn joined(mut a: Small, b: &Small) -> Small {
    a.join(b);
    a.take_changed();
    a
}

proptest! {
    #[test]
    fn tiles_join_as_the_naive_map_does(tiles in tiles()) {
        let mut map = Small::new(EXTENT).unwrap();
        let mut naive = Naive::new();
        for (at, tile) in tiles {
            let before = naive.clone();
            let learnt = map.join_tile(at, tile);
            for bit in 0..64 {
                let cell = at.cell(bit);
                if EXTENT.contains(cell) && at.x < 4 && at.y < 3 {
                    let i = index(cell);
                    let known = tile.known >> bit & 1 == 1;
                    let obstacle = tile.obstacle >> bit & 1 == 1;
                    let visited = tile.visited >> bit & 1 == 1;
                    naive.known[i] |= known | obstacle | visited;
                    naive.obstacle[i] |= obstacle;
                    naive.visited[i] = (naive.visited[i] | visited) & !naive.obstacle[i];
                }
            }
            let cells = (0..naive.known.len()).filter(|&i| naive.known[i] && !before.known[i]);
            prop_assert_eq!(learnt.cells as usize, cells.count());
            let closed = (0..naive.known.len())
                .filter(|&i| naive.obstacle[i] && before.known[i] && !before.obstacle[i]);
            prop_assert_eq!(learnt.closed as usize, closed.count());
        }
        assert_same(&map, &naive);
    }

    #[test]
    fn join_is_commutative_associative_idempotent(a in tiles(), b in tiles(), c in tiles()) {
        let (a, b, c) = (map_of(&a), map_of(&b), map_of(&c));
        prop_assert_eq!(joined(a.clone(), &b), joined(b.clone(), &a));
        prop_assert_eq!(
            joined(joined(a.clone(), &b), &c),
            joined(a.clone(), &joined(b.clone(), &c))
        );
        prop_assert_eq!(joined(a.clone(), &a), a.clone());
        let ab = joined(a.clone(), &b);
        prop_assert_eq!(joined(ab.clone(), &a), ab);
    }

    #[test]
    fn changed_tiles_carry_everything(a in tiles(), b in tiles()) {
        let mut sender = map_of(&a);
        let mut receiver = sender.clone();
        for &(at, tile) in &b {
            sender.join_tile(at, tile);
        }
        let changed = sender.take_changed();
        receiver.join_tiles(&sender, &changed);
        receiver.take_changed();
        prop_assert_eq!(receiver, sender);
    }

    #[test]
    fn sightings_reach_the_map_unchanged(
        walls in proptest::collection::vec(any::<bool>(), EXTENT.cells() as usize),
        looks in proptest::collection::vec((0i16..29, 0i16..19, 1u8..=15), 1..6),
    ) {
        let blocked = |cell: Cell| !EXTENT.contains(cell) || walls[index(cell)];
        let mut map = Small::new(EXTENT).unwrap();
        let mut naive = Naive::new();
        for (x, y, radius) in looks {
            let sighting = look(Cell::new(x, y), radius, blocked);
            map.observe(&sighting);
            // A robot that stands in a wall is right, and the wall is wrong.
            let own = index(sighting.centre());
            naive.visited[own] |= naive.obstacle[own];
            naive.obstacle[own] = false;
            for cell in sighting.free_cells() {
                naive.known[index(cell)] = true;
            }
            for cell in sighting.blocked_cells().filter(|&cell| EXTENT.contains(cell)) {
                naive.known[index(cell)] = true;
                naive.obstacle[index(cell)] = true;
            }
        }
        assert_same(&map, &naive);
    }
}

#[test]
fn a_grid_that_does_not_fit_is_refused() {
    let asked = Extent::new(33, 4);
    let capacity = Extent::new(32, 24);
    let error = Small::new(asked).unwrap_err();
    assert_eq!(error, ExtentError::TooLarge { asked, capacity });
    assert_eq!(
        format!("{error}"),
        "a grid of 33×4 cells does not fit a map compiled for 32×24"
    );
    assert_eq!(Small::new(Extent::new(0, 9)), Err(ExtentError::Empty));
}

#[test]
fn beyond_the_extent_is_obstacle() {
    let map = Small::new(EXTENT).unwrap();
    for cell in [(-1, 0), (0, -1), (29, 0), (0, 19), (-300, 4), (9000, 9000)] {
        let cell = Cell::new(cell.0, cell.1);
        assert!(map.is_obstacle(cell) && map.is_known(cell) && !map.is_free(cell));
    }
    assert_eq!(map.unknown_cells(), EXTENT.cells());
    assert_eq!(map.frontiers(), 0);
}

#[test]
fn debug_draws_the_map() {
    let mut map = Map::<1, 1>::new(Extent::new(5, 3)).unwrap();
    let walls = |cell: Cell| !Extent::new(5, 3).contains(cell) || cell == Cell::new(1, 0);
    map.observe(&look(Cell::new(1, 1), 2, walls));
    map.visit(Cell::new(1, 1));
    assert_eq!(
        format!("{map:?}"),
        "5×3 cells, 5 unknown, 3 frontiers\n.#?  \n.+.? \n..?  \n"
    );
}
