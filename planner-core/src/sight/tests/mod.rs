mod metres;
mod scan;
mod zones;

use std::vec::Vec;

use proptest::prelude::*;

use super::*;
use crate::cell::Extent;

const EXTENT: Extent = Extent::new(24, 24);

fn walls() -> impl Strategy<Value = Vec<bool>> {
    (0.0..0.5f64).prop_flat_map(|share| {
        proptest::collection::vec(proptest::bool::weighted(share), EXTENT.cells() as usize)
    })
}

fn blocked_in(walls: &[bool]) -> impl Fn(Cell) -> bool + '_ {
    |cell| !EXTENT.contains(cell) || walls[cell.y as usize * 24 + cell.x as usize]
}

fn cell() -> impl Strategy<Value = Cell> {
    (0i16..24, 0i16..24).prop_map(|(x, y)| Cell::new(x, y))
}

/// Line of sight in exact rational geometry: the open segment between the centres
/// meets the interior of no blocked cell, and no corner whose two cells beside
/// the segment are both blocked.
fn exact_line_of_sight(from: Cell, to: Cell, is_blocked: &impl Fn(Cell) -> bool) -> bool {
    let (dx, dy) = (i32::from(to.x - from.x), i32::from(to.y - from.y));
    let (west, east) = (from.x.min(to.x), from.x.max(to.x));
    let (north, south) = (from.y.min(to.y), from.y.max(to.y));
    let side = |corner_x: i32, corner_y: i32| dx * corner_y - dy * corner_x;
    for y in north..=south {
        for x in west..=east {
            // Corners relative to the centre of `from`, doubled.
            let (cx, cy) = (2 * i32::from(x - from.x), 2 * i32::from(y - from.y));
            let sides = [(-1, -1), (1, -1), (-1, 1), (1, 1)].map(|(a, b)| side(cx + a, cy + b));
            let crosses = sides.iter().any(|&s| s > 0) && sides.iter().any(|&s| s < 0);
            let cell = Cell::new(x, y);
            if crosses && cell != from && cell != to && is_blocked(cell) {
                return false;
            }
            // The south-eastern and the south-western corner of this cell.
            for (a, diagonal) in [(1i16, dx * dy > 0), (-1, dx * dy < 0)] {
                let inside = x + a >= west && x + a <= east && y < south;
                if diagonal && inside && side(cx + i32::from(a), cy + 1) == 0 {
                    let beside = (Cell::new(x + a, y), Cell::new(x, y + 1));
                    if is_blocked(beside.0) && is_blocked(beside.1) {
                        return false;
                    }
                }
            }
        }
    }
    true
}

proptest! {
    #[test]
    fn a_row_at_once_is_its_cells_one_by_one(
        rows in proptest::collection::vec((-17i16..18, any::<u32>(), any::<u32>()), 0..6),
    ) {
        let centre = Cell::new(3, -2);
        let (mut at_once, mut one_by_one) = (Sighting::new(centre), Sighting::new(centre));
        for (dy, free, blocked) in rows {
            at_once.see_row(dy, free, blocked);
            for bit in 0..32 {
                let cell = Cell::new(centre.x + bit - 15, centre.y + dy);
                if blocked >> bit & 1 == 1 {
                    one_by_one.see_blocked(cell);
                }
                if free >> bit & 1 == 1 {
                    one_by_one.see_free(cell);
                }
            }
        }
        prop_assert_eq!(&at_once, &one_by_one);
        let cells: u32 = (-20..20).map(|dy| at_once.free_row(dy).count_ones()).sum();
        prop_assert_eq!(cells as usize, at_once.free_cells().count());
    }

    #[test]
    fn sight_is_symmetric(walls in walls(), a in cell(), b in cell()) {
        let blocked = blocked_in(&walls);
        prop_assert_eq!(line_of_sight(a, b, &blocked), line_of_sight(b, a, &blocked));
    }

    #[test]
    fn sight_is_what_geometry_says(walls in walls(), a in cell(), b in cell()) {
        let blocked = blocked_in(&walls);
        prop_assert_eq!(line_of_sight(a, b, &blocked), exact_line_of_sight(a, b, &blocked));
    }

    #[test]
    fn a_look_holds_exactly_the_disc_in_sight(walls in walls(), centre in cell(), radius in 1u8..=15) {
        let blocked = blocked_in(&walls);
        let sighting = look(centre, radius, &blocked);
        for y in -20..44 {
            for x in -20..44 {
                let cell = Cell::new(x, y);
                let seen = cell.distance_squared(centre) <= u32::from(radius) * u32::from(radius)
                    && line_of_sight(centre, cell, &blocked);
                let free = !blocked(cell) || cell == centre;
                prop_assert_eq!(sighting.is_free(cell), seen && free);
                prop_assert_eq!(sighting.is_blocked(cell), seen && !free);
            }
        }
        prop_assert_eq!(sighting.free_cells().filter(|&c| !sighting.is_free(c)).count(), 0);
    }

    #[test]
    fn a_long_look_is_what_is_near_and_far_tiles(
        walls in walls(), centre in cell(), radius in 1u8..=40,
    ) {
        let blocked = blocked_in(&walls);
        let long = look_far(centre, radius, &blocked);
        let cells = |look: &mut dyn Iterator<Item = Cell>| -> Vec<Cell> {
            let mut cells: Vec<Cell> = look.collect();
            cells.sort();
            cells
        };
        let near = long.near();
        if radius <= MAX_RADIUS {
            prop_assert_eq!(&near, &look(centre, radius, &blocked));
        }
        let far: Vec<_> = long.far_tiles().collect();
        prop_assert!(far.len() <= 81);
        // Beyond the origin no map has cells.
        let has_tile = |cell: &Cell| cell.x >= 0 && cell.y >= 0;
        let in_tiles = |cells: fn(&(TileIndex, u64, u64)) -> u64| {
            let bits = move |tile| crate::tile::bits(cells(tile)).map(|bit| tile.0.cell(bit));
            far.iter().flat_map(bits).collect::<Vec<_>>()
        };
        let free = in_tiles(|tile| tile.1);
        prop_assert_eq!(
            cells(&mut near.free_cells().chain(free).filter(has_tile)),
            cells(&mut long.free_cells().filter(has_tile))
        );
        let walls = in_tiles(|tile| tile.2);
        prop_assert_eq!(
            cells(&mut near.blocked_cells().chain(walls).filter(has_tile)),
            cells(&mut long.blocked_cells().filter(has_tile))
        );
    }
}

#[test]
fn what_is_told_blocked_twice_is_firm() {
    let mut sighting = Sighting::new(Cell::new(12, 12));
    let cell = Cell::new(9, 20);
    sighting.see_blocked(cell);
    assert!(sighting.is_blocked(cell) && !sighting.is_firm(cell));
    sighting.see_free(cell);
    assert!(!sighting.is_free(cell));
    sighting.see_blocked(cell);
    assert!(sighting.is_blocked(cell) && sighting.is_firm(cell));
    let tile = TileIndex { x: 1, y: 2 };
    assert_eq!(sighting.firm_tile(tile), 1 << (4 * 8 + 1));
    assert_eq!(sighting.tile(tile), (0, 1 << (4 * 8 + 1)));
    for _ in 0..2 {
        sighting.see_blocked(sighting.centre());
    }
    assert!(!sighting.is_firm(sighting.centre()));
}
