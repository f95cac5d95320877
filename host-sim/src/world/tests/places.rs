//! Reachability and starts, against slow and obvious counterparts.

use std::collections::BTreeSet;

use crate::world::Starts;

use super::*;

/// All cells joined to `from`, by repeating one round of steps until no cell
/// is added.
fn naive_flood(world: &World, from: Cell) -> BTreeSet<Cell> {
    let mut reached: BTreeSet<Cell> = [from].into_iter().filter(|&c| world.is_free(c)).collect();
    loop {
        let next: Vec<Cell> = world
            .free_cells()
            .filter(|c| {
                !reached.contains(c) && reached.iter().any(|r| r.direction_to(*c).is_some())
            })
            .collect();
        if next.is_empty() {
            return reached;
        }
        reached.extend(next);
    }
}

proptest! {
    #[test]
    fn reachability_is_the_naive_flood(world in any_world(), x in 0i16..12, y in 0i16..12) {
        let reachable = world.reachable(&[cell(x, y)]);
        let naive = naive_flood(&world, cell(x, y));
        prop_assert_eq!(reachable.cells().collect::<BTreeSet<_>>(), naive.clone());
        prop_assert_eq!(reachable.count() as usize, naive.len());
        let free = world.free_cells().count() as u32;
        prop_assert_eq!(reachable.count() + reachable.unreachable(), free);
        prop_assert!(world.free_cells().all(|c| reachable.contains(c) == naive.contains(&c)));
    }

    #[test]
    fn the_largest_component_is_the_largest(world in any_world()) {
        let largest = world.largest_component();
        let sizes = world.free_cells().map(|cell| naive_flood(&world, cell).len());
        prop_assert_eq!(largest.count() as usize, sizes.max().unwrap());
    }

    #[test]
    fn solid_robots_stand_apart_in_one_component(world in any_world(), seed: u64, robots in 0usize..9) {
        let largest = world.largest_component();
        for starts in [Starts::Center, Starts::Corner, Starts::Random(seed)] {
            let shared = world.place(robots, &starts, false).unwrap();
            prop_assert_eq!(shared.len(), robots);
            prop_assert!(shared.iter().all(|&cell| largest.contains(cell) && cell == shared[0]));
            match world.place(robots, &starts, true) {
                Ok(solid) => {
                    prop_assert_eq!(solid.iter().collect::<BTreeSet<_>>().len(), robots);
                    prop_assert!(solid.iter().all(|&cell| largest.contains(cell)));
                    prop_assert_eq!(solid.first(), shared.first());
                }
                Err(_) => prop_assert!(robots > largest.count() as usize),
            }
        }
    }
}

#[test]
fn anchors() {
    let world = world(&["#.#....", "#.#....", "#.#...#", "#.#...."]);
    let first = |starts: &Starts| world.place(1, starts, false).unwrap()[0];
    assert_eq!(first(&Starts::Corner), cell(3, 0)); // not 1,0: the smaller component
    assert_eq!(first(&Starts::Center), cell(3, 1));
    assert_eq!(first(&Starts::At(vec![cell(1, 3)])), cell(1, 3));
    assert_eq!(first(&Starts::Random(5)), first(&Starts::Random(5)));
}

#[test]
fn robots_that_are_spread_stand_as_far_apart_as_the_walls_let_them() {
    let world = world(&[".........", ".#######.", "........#"]);
    let ends = [cell(7, 2), cell(8, 1)];
    for seed in 0..20 {
        let places = world.place(3, &Starts::Spread(seed), true).unwrap();
        assert_eq!(
            places,
            world.place(3, &Starts::Spread(seed), false).unwrap()
        );
        let first = world.place(1, &Starts::Random(seed), false).unwrap()[0];
        assert_eq!(places[0], first);
        // The second is at an end of the corridor; the third at the other or between them.
        assert!(ends.contains(&places[1]), "{places:?}");
        if ends.contains(&first) {
            assert_eq!(places[2].x, 0, "{places:?}");
        }
    }
    // More robots than cells.
    let places = world.place(30, &Starts::Spread(1), false).unwrap();
    assert_eq!(places.iter().collect::<BTreeSet<_>>().len(), 19);
    world.place(30, &Starts::Spread(1), true).unwrap_err();
}

#[test]
fn solid_robots_fill_up_from_the_anchor() {
    let world = world(&["...#.", "...#."]);
    let places = world.place(4, &Starts::At(vec![cell(0, 0)]), true).unwrap();
    assert_eq!(places, [cell(0, 0), cell(1, 0), cell(0, 1), cell(2, 0)]);
}

#[test]
fn lists_of_starts_are_gone_through_again() {
    let world = world(&["1.2"]);
    let starts = world.default_starts();
    assert_eq!(starts, Starts::At(vec![cell(0, 0), cell(2, 0)]));
    let places = world.place(3, &starts, false).unwrap();
    assert_eq!(places, [cell(0, 0), cell(2, 0), cell(0, 0)]);
    assert_eq!(world.place(3, &starts, true).unwrap()[2], cell(1, 0));
}

#[test]
fn without_digits_robots_start_in_the_centre() {
    assert_eq!(world(&["..."]).default_starts(), Starts::Center);
}
