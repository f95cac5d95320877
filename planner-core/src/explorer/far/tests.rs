//! The far decision against a matching with sets and maps.

use std::boxed::Box;
use std::collections::{HashMap, HashSet, VecDeque};

use proptest::prelude::*;

use super::*;
use crate::cell::Extent;
use crate::explorer::aside::Aside;
use crate::map::{Map, Tile};
use crate::robot::{Activity, Status};
use crate::tile::every_tile;

const SIDE: u8 = 24;

/// What a scene draws: the kinds of the cells, and where robots are.
#[derive(Clone, Debug)]
struct Scene {
    /// 0 unknown, 1 a wall, else free.
    kinds: std::vec::Vec<u8>,
    own: Cell,
    others: std::vec::Vec<Cell>,
    id: u8,
}

fn cell() -> impl Strategy<Value = Cell> {
    (0..i16::from(SIDE), 0..i16::from(SIDE)).prop_map(|(x, y)| Cell::new(x, y))
}

fn scene() -> impl Strategy<Value = Scene> {
    let kind = prop_oneof![1 => Just(0u8), 12 => Just(1u8), 50 => Just(2u8)];
    (
        proptest::collection::vec(kind, usize::from(SIDE) * usize::from(SIDE)),
        cell(),
        proptest::collection::vec(prop_oneof![cell(), Just(Cell::new(3, 3))], 0..9),
        0u8..9,
    )
        .prop_map(|(mut kinds, own, others, id)| {
            for cell in others.iter().chain([&own]) {
                kinds[cell.y as usize * usize::from(SIDE) + cell.x as usize] = 2;
            }
            Scene {
                kinds,
                own,
                others,
                id,
            }
        })
}

/// The cells of the scene in the corner of a map as large as its type. The robot has an
/// even id between those of the others, which are odd.
fn around<const TW: usize, const TH: usize>(scene: &Scene) -> (Surroundings<TW, TH>, Others) {
    let mut map = Map::new(Extent::new(8 * TW as u16, 8 * TH as u16)).unwrap();
    for at in every_tile(3, 3) {
        let kind = |bit: u32| {
            let Cell { x, y } = at.cell(bit);
            scene.kinds[y as usize * usize::from(SIDE) + x as usize]
        };
        let of = |is: fn(u8) -> bool| {
            let bits = (0..64).filter(|bit| is(kind(*bit)));
            bits.fold(0, |cells, bit| cells | 1u64 << bit)
        };
        map.join_tile(at, Tile::seen(of(|kind| kind > 1), of(|kind| kind == 1)));
    }
    let mut others = Others::new();
    for (&position, number) in scene.others.iter().zip(0u8..) {
        let status = Status {
            position,
            goal: None,
            activity: Activity::Exploring,
        };
        others.hear(RobotId(2 * number + 1), status, scene.own, 0);
    }
    let around = Surroundings {
        clearance: 0,
        map,
        aside: Aside::new(),
        visits: Vec::new(),
        position: scene.own,
        now: 0,
    };
    (around, others)
}

fn search<const TW: usize, const TH: usize>(
    scene: &Scene,
    slice: u32,
) -> (Outcome, Surroundings<TW, TH>) {
    let (around, others) = around::<TW, TH>(scene);
    let mut far = Box::new(FarSearch::<TW, TH>::new());
    far.start_sweep(RobotId(2 * scene.id), &others, &around);
    let mut work = 0;
    loop {
        let before = work;
        let outcome = far.advance(&around, slice, &mut work);
        assert!(work - before <= slice + LAST_WORK + WAY_WORK);
        if !matches!(outcome, Outcome::Searching) {
            return (outcome, around);
        }
    }
}

/// The same matching with sets and maps: the cell of the robot's frontier, and how far
/// its wave went.
fn matched<const TW: usize, const TH: usize>(scene: &Scene) -> Option<(Cell, u32)> {
    let (around, _) = around::<TW, TH>(scene);
    let mut robots: std::vec::Vec<(u8, Cell)> = scene
        .others
        .iter()
        .zip(0u8..)
        .map(|(&cell, number)| (2 * number + 1, cell))
        .collect();
    let own = 2 * scene.id;
    robots.push((own, scene.own));
    robots.sort();
    let is_frontier = |cell| around.map.is_frontier(cell);
    let passes = if robots.len() > 1 { PASSES } else { 0 };
    for _ in 0..passes {
        let mut taken = HashSet::new();
        loop {
            let before = robots.len();
            let mut waves: std::vec::Vec<Cell> = std::vec::Vec::new();
            for (_, cell) in &robots {
                if !waves.contains(cell) {
                    waves.push(*cell);
                }
            }
            // By cell: whose it is, and how far from there.
            let mut reached = HashMap::new();
            let mut queue = VecDeque::new();
            // What was reached, in turn; a wave begins by reaching its own cell.
            let mut next: VecDeque<_> = waves.iter().map(|&cell| (cell, cell, 0)).collect();
            loop {
                while let Some((wave, cell, distance)) = next.pop_front() {
                    let is_over = |wave: Cell| !robots.iter().any(|(_, at)| *at == wave);
                    let is_free = reached.get(&cell).is_none_or(|&(wave, _)| is_over(wave));
                    if is_over(wave) || !around.map.is_free(cell) || !is_free {
                        continue;
                    }
                    let was_reached = reached.insert(cell, (wave, distance)).is_some();
                    queue.push_back(cell);
                    if was_reached || !is_frontier(cell) || taken.contains(&cell) {
                        continue;
                    }
                    let served = robots.iter().position(|(_, at)| *at == wave).unwrap();
                    if robots[served].0 == own {
                        return Some((cell, distance));
                    }
                    robots.remove(served);
                    for (at, cells) in
                        connected(cell, |window| around.window(window, Layer::Frontier))
                    {
                        taken.extend(crate::tile::bits(cells).map(|bit| at.cell(bit)));
                    }
                }
                let Some(from) = queue.pop_front() else {
                    break;
                };
                let (wave, distance) = reached[&from];
                for side in Direction::ALL {
                    next.push_back((wave, from.step(side), distance + 1));
                }
            }
            if robots.len() == before {
                break;
            }
        }
    }
    // Alone.
    let mut reached = HashSet::from([scene.own]);
    let mut queue = VecDeque::from([(scene.own, 0)]);
    while let Some((cell, distance)) = queue.pop_front() {
        if is_frontier(cell) {
            return Some((cell, distance));
        }
        for beside in Direction::ALL.map(|side| cell.step(side)) {
            if around.map.is_free(beside) && reached.insert(beside) {
                queue.push_back((beside, distance + 1));
            }
        }
    }
    None
}

fn follow(way: &Candidate, around: &Surroundings<3, 3>) -> Cell {
    let mut path = way.path;
    let mut cell = around.position;
    while let Some(step) = path.pop_front() {
        cell = cell.step(step);
        assert!(around.map.is_free(cell));
    }
    cell
}

proptest! {
    #[test]
    fn robots_are_matched_as_with_sets(scene in scene(), slice in 1u32..100_000) {
        // So large that the queue has room for every cell of the scene.
        let found = match search::<16, 16>(&scene, slice).0 {
            Outcome::Found(way) => Some((way.goal, way.length)),
            _ => None,
        };
        let expected = matched::<16, 16>(&scene);
        prop_assert_eq!(found.map(|way| way.0), expected.map(|way| way.0));
        if let (Some((_, length)), Some((_, distance))) = (found, expected) {
            prop_assert!(length <= distance);
        }
    }

    #[test]
    fn a_frontier_that_can_be_reached_is_found_though_the_queue_is_full(
        scene in scene(), slice in 1u32..100_000,
    ) {
        let (outcome, around) = search::<3, 3>(&scene, slice);
        match (outcome, matched::<3, 3>(&scene)) {
            (Outcome::Found(way), Some(_)) => {
                prop_assert!(around.is_goal(way.goal));
                prop_assert_eq!(follow(&way, &around), way.goal);
            }
            (Outcome::NothingLeft, None) => {}
            (outcome, expected) => prop_assert!(false, "{outcome:?}, not {expected:?}"),
        }
    }

    #[test]
    fn an_exact_way_is_the_shortest_though_the_queue_is_full(
        scene in scene(), to in cell(), slice in 1u32..100_000,
    ) {
        let (around, _) = around::<3, 3>(&scene);
        let mut far = Box::new(FarSearch::<3, 3>::new());
        far.start_way(to, &around);
        let mut work = 0;
        let found = loop {
            let before = work;
            let outcome = far.advance(&around, slice, &mut work);
            assert!(work - before <= slice + LAST_WORK + WAY_WORK);
            if !matches!(outcome, Outcome::Searching) {
                break outcome;
            }
        };
        let mut distances = HashMap::from([(scene.own, 0)]);
        let mut queue = VecDeque::from([scene.own]);
        while let Some(cell) = queue.pop_front() {
            for beside in Direction::ALL.map(|side| cell.step(side)) {
                if around.map.is_free(beside) && !distances.contains_key(&beside) {
                    distances.insert(beside, distances[&cell] + 1);
                    queue.push_back(beside);
                }
            }
        }
        match found {
            Outcome::Found(way) => {
                prop_assert_eq!(Some(&way.length), distances.get(&to));
                prop_assert_eq!(way.path.len(), way.length.min(256));
            }
            // The robot is there: it asks for no way.
            _ => prop_assert!(to == scene.own || !distances.contains_key(&to)),
        }
    }
}
