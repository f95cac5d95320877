//! Discs over rows of tiles against discs cell by cell.

use std::vec::Vec;

use proptest::prelude::*;

use super::*;
use crate::cell::Extent;
use crate::map::Level;
use crate::sight::look;
use crate::tile::bits;

/// By the words of the rule.
fn naive(map: &Map<4, 3>, clearance: u8, centre: Cell) -> Fit {
    let r = i16::from(clearance);
    let (mut is_clear, mut is_shut) = (true, false);
    for (dx, dy) in (-r..=r).flat_map(|dy| (-r..=r).map(move |dx| (dx, dy))) {
        // dx² + dy² ≤ (r + ½)², times 4.
        if 4 * (dx * dx + dy * dy) <= (2 * r + 1) * (2 * r + 1) {
            let cell = Cell::new(centre.x + dx, centre.y + dy);
            is_clear &= map.is_free(cell);
            is_shut |= map.is_obstacle(cell);
        }
    }
    match (is_shut, is_clear) {
        (true, _) => Fit::Shut,
        (_, true) => Fit::Clear,
        _ => Fit::Doubtful,
    }
}

fn map(kinds: &[u8], extent: Extent) -> Map<4, 3> {
    let mut map = Map::new(extent).unwrap();
    for (kind, i) in kinds.iter().zip(0i16..) {
        let cell = Cell::new(i % extent.width as i16, i / extent.width as i16);
        let level = match kind {
            0 => Level::Wall,
            1 => Level::Unknown,
            2 => Level::Doubtful,
            3 => Level::Visited,
            _ => Level::Free,
        };
        let (at, bit) = TileIndex::of(cell).unwrap();
        map.join_tile(at, Tile::UNKNOWN.with(bit, level));
    }
    map
}

proptest! {
    #[test]
    fn tiles_and_cells_are_as_by_the_rule(
        kinds in prop::collection::vec(0u8..90, 29 * 21), clearance in 1u8..=3,
    ) {
        let map = map(&kinds, Extent::new(29, 21));
        let rows: Vec<_> = (0..3).map(|y| strip::<4, 3>(&map, clearance, (0, y))).collect();
        for at in (0..3).flat_map(|y| (0..4).map(move |x| TileIndex::new(x, y))) {
            let layers = tile(&map, clearance, at);
            prop_assert_eq!(rows[usize::from(at.y)][usize::from(at.x)], layers);
            for bit in bits(u64::MAX) {
                let cell = at.cell(bit);
                let is_clear = naive(&map, clearance, cell) == Fit::Clear;
                prop_assert_eq!(fit(&map, clearance, cell), naive(&map, clearance, cell));
                prop_assert_eq!(layers.clear >> bit & 1 == 1, is_clear);
                let beside = Direction::ALL.map(|side| naive(&map, clearance, cell.step(side)));
                let is_frontier = is_clear && beside.contains(&Fit::Doubtful);
                prop_assert_eq!(layers.frontier >> bit & 1 == 1, is_frontier, "{}", cell);
            }
        }
    }
}

#[test]
fn a_look_from_a_clear_cell_decides_of_those_beside_it() {
    let here = Cell::new(20, 20);
    for clearance in 1..=MAX_CLEARANCE {
        for side in Direction::ALL {
            let both: Vec<_> = body_cells(clearance, here)
                .chain(body_cells(clearance, here.step(side)))
                .collect();
            let sighting = look(here, clearance + 2, |cell| !both.contains(&cell));
            let seen: Vec<_> = sighting.free_cells().collect();
            assert!(both.iter().all(|cell| seen.contains(cell)), "{clearance}");
        }
    }
    let sizes = [0, 1, 2, 3].map(|clearance| body_cells(clearance, here).count());
    assert_eq!(sizes, [1, 9, 21, 37]);
}
