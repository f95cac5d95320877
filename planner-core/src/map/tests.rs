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
struct Naive(Vec<Level>);

const FREE: [Level; 4] = [
    Level::Free,
    Level::Visited,
    Level::FreeAgain,
    Level::FreeForGood,
];

fn all_cells() -> impl Iterator<Item = Cell> {
    (0..EXTENT.height as i16).flat_map(|y| (0..EXTENT.width as i16).map(move |x| Cell::new(x, y)))
}

fn index(cell: Cell) -> usize {
    cell.y as usize * usize::from(EXTENT.width) + cell.x as usize
}

impl Naive {
    fn new() -> Self {
        Self(vec![Level::Unknown; EXTENT.cells() as usize])
    }

    fn level(&self, cell: Cell) -> Level {
        self.0[index(cell)]
    }

    fn raise(&mut self, cell: Cell, level: Level) {
        let own = &mut self.0[index(cell)];
        *own = level.max(*own);
    }

    fn is_known(&self, cell: Cell) -> bool {
        self.level(cell) >= Level::Free
    }

    fn is_free(&self, cell: Cell) -> bool {
        FREE.contains(&self.level(cell))
    }

    fn is_frontier(&self, cell: Cell) -> bool {
        self.is_free(cell)
            && Direction::ALL.into_iter().any(|direction| {
                let next = cell.step(direction);
                EXTENT.contains(next) && !self.is_known(next)
            })
    }
}

fn assert_same(map: &Small, naive: &Naive) {
    for cell in all_cells() {
        let (known, free) = (naive.is_known(cell), naive.is_free(cell));
        let level = naive.level(cell);
        assert_eq!(map.level(cell), level, "{cell}");
        assert_eq!(map.is_known(cell), known, "{cell}");
        assert_eq!(map.is_free(cell), free, "{cell}");
        assert_eq!(map.is_obstacle(cell), known && !free, "{cell}");
        assert_eq!(map.is_doubtful(cell), level == Level::Doubtful, "{cell}");
        assert_eq!(map.is_visited(cell), free && level != Level::Free, "{cell}");
        assert_eq!(map.is_frontier(cell), naive.is_frontier(cell), "{cell}");
    }
    let count = |is: &dyn Fn(&Cell) -> bool| all_cells().filter(|cell| is(cell)).count() as u32;
    assert_eq!(map.frontiers(), count(&|&cell| naive.is_frontier(cell)));
    assert_eq!(map.unknown_cells(), count(&|&cell| !naive.is_known(cell)));
    let (east, south) = (EXTENT.width as i16 - 1, EXTENT.height as i16 - 1);
    let edge = count(&|cell| {
        naive.is_free(*cell) && (cell.x == 0 || cell.y == 0 || cell.x == east || cell.y == south)
    });
    assert_eq!(map.free_edge_cells(), edge);
}

/// Any levels.
fn tile() -> impl Strategy<Value = Tile> {
    let plane = || prop_oneof![any::<u64>(), any::<(u64, u64)>().prop_map(|(a, b)| a & b)];
    [plane(), plane(), plane()].prop_map(Tile::from_planes)
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

#[test]
fn a_tile_is_its_levels() {
    let mut tile = Tile::UNKNOWN;
    for (bit, level) in (0..).zip(Level::ALL) {
        assert_eq!(level as u32, bit);
        tile = tile.with(1 << (5 * bit), level);
    }
    for (bit, level) in (0..).zip(Level::ALL) {
        assert_eq!(tile.level(5 * bit), level);
        let others = if level == Level::Unknown {
            !tile.known() & !tile.doubtful()
        } else {
            1 << (5 * bit)
        };
        assert_eq!(tile.at(level), others, "{level:?}");
    }
    assert_eq!(tile.free() & (tile.obstacle() | tile.doubtful()), 0);
    assert_eq!(tile.free() | tile.obstacle(), tile.known());
    assert_eq!(
        Tile::seen(0b110, 0b010),
        Tile::UNKNOWN
            .with(0b100, Level::Free)
            .with(0b010, Level::Wall)
    );
}

#[test]
fn where_a_robot_stands_is_free_twice_over() {
    let (at, bit) = TileIndex::of(Cell::new(9, 9)).unwrap();
    let mut map = Small::new(EXTENT).unwrap();
    let mut levels = Vec::new();
    for _ in 0..3 {
        map.stand(Cell::new(9, 9));
        levels.push(map.level(Cell::new(9, 9)));
        for wall in [Level::Wall, Level::WallAgain] {
            map.join_tile(at, Tile::UNKNOWN.with(bit, wall));
            levels.push(map.level(Cell::new(9, 9)));
        }
        map.stand(Cell::new(9, 9));
    }
    assert_eq!(
        levels,
        [
            Level::Visited,
            Level::Wall,
            Level::WallAgain,
            Level::FreeForGood,
            Level::FreeForGood,
            Level::FreeForGood,
            Level::FreeForGood,
            Level::FreeForGood,
            Level::FreeForGood,
        ]
    );
}

#[test]
fn what_was_free_and_is_a_wall_is_named_until_it_opens() {
    let mut map = Small::new(EXTENT).unwrap();
    let set = |map: &mut Small, x: i16, level| {
        let (at, bit) = TileIndex::of(Cell::new(x, 3)).unwrap();
        map.join_tile(at, Tile::UNKNOWN.with(bit, level));
    };
    let places = |map: &Small| {
        map.shut()
            .places()
            .iter()
            .map(|at| at.x)
            .collect::<Vec<_>>()
    };
    set(&mut map, 20, Level::Wall);
    assert_eq!(map.shut().cells(), 0, "it was never free");
    for x in 0..10 {
        set(&mut map, x, Level::Free);
        set(&mut map, x, Level::Wall);
    }
    assert_eq!((map.shut().cells(), places(&map)), (10, (2..10).collect()));
    set(&mut map, 4, Level::FreeAgain);
    set(&mut map, 20, Level::FreeAgain);
    assert_eq!(
        (map.shut().cells(), places(&map)),
        (9, vec![2, 3, 5, 6, 7, 8, 9])
    );
    set(&mut map, 4, Level::WallAgain);
    assert_eq!(
        (map.shut().cells(), places(&map)),
        (10, vec![2, 3, 5, 6, 7, 8, 9, 4])
    );
    for x in [10, 11] {
        set(&mut map, x, Level::Free);
        set(&mut map, x, Level::Wall);
    }
    set(&mut map, 4, Level::FreeForGood);
    assert_eq!(
        (map.shut().cells(), places(&map)),
        (11, vec![5, 6, 7, 8, 9, 10, 11])
    );
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
                    naive.raise(cell, tile.level(bit));
                }
            }
            let count = |of: &dyn Fn(Cell) -> bool| all_cells().filter(|&cell| of(cell)).count();
            let cells = count(&|cell| naive.is_known(cell) && !before.is_known(cell));
            prop_assert_eq!(learnt.cells as usize, cells);
            let is_wall = |naive: &Naive, cell| naive.is_known(cell) && !naive.is_free(cell);
            let closed = count(&|cell| is_wall(&naive, cell) && before.is_free(cell));
            prop_assert_eq!(learnt.closed as usize, closed);
            let opened = count(&|cell| naive.is_free(cell) && is_wall(&before, cell));
            prop_assert_eq!(learnt.opened as usize, opened);
            let doubtful = count(&|cell| {
                naive.level(cell) == Level::Doubtful && before.level(cell) == Level::Unknown
            });
            prop_assert_eq!(learnt.doubtful as usize, doubtful);
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
            if naive.level(sighting.centre()) == Level::Wall {
                naive.raise(sighting.centre(), Level::FreeAgain);
            }
            for cell in sighting.free_cells() {
                naive.raise(cell, Level::Free);
            }
            for cell in sighting.blocked_cells().filter(|&cell| EXTENT.contains(cell)) {
                naive.raise(cell, Level::Wall);
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
    map.stand(Cell::new(1, 1));
    assert_eq!(
        format!("{map:?}"),
        "5×3 cells, 5 unknown, 3 frontiers\n.#?  \n.+.? \n..?  \n"
    );
}
