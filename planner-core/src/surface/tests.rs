use std::vec;
use std::vec::Vec;

use proptest::prelude::*;

use super::*;
use crate::point::Point;

type Map = Surface<3, 2>;
const EXTENT: Extent = Extent::new(21, 14);

fn column() -> impl Strategy<Value = Column> {
    (-2i16..24, -2i16..18, any::<u8>()).prop_map(|(x, y, height)| Column {
        cell: Cell::new(x, y),
        height: Height(height),
    })
}

/// The map as a plain table.
fn table(columns: &[Column]) -> Vec<Vec<Option<Height>>> {
    let mut table = vec![vec![None; EXTENT.width.into()]; EXTENT.height.into()];
    for column in columns.iter().filter(|c| EXTENT.contains(c.cell)) {
        let entry = &mut table[column.cell.y as usize][column.cell.x as usize];
        *entry = (*entry).max(Some(column.height));
    }
    table
}

fn cells() -> impl Iterator<Item = Cell> {
    (-1..15).flat_map(|y| (-1..22).map(move |x| Cell::new(x, y)))
}

proptest! {
    #[test]
    fn agrees_with_a_plain_table(columns in prop::collection::vec(column(), 0..300)) {
        let mut map = Map::new(EXTENT).unwrap();
        for &column in &columns {
            map.learn(column);
        }
        let table = table(&columns);
        let at = |cell: Cell| {
            EXTENT.contains(cell).then(|| table[cell.y as usize][cell.x as usize])
        };
        let mut frontiers = 0;
        for cell in cells() {
            prop_assert_eq!(map.height(cell), at(cell).flatten());
            let frontier = at(cell).flatten().is_some()
                && crate::cell::Direction::ALL.iter().any(|&d| at(cell.step(d)) == Some(None));
            prop_assert_eq!(map.is_frontier(cell), frontier);
            frontiers += u32::from(frontier);
        }
        prop_assert_eq!(map.frontiers(), frontiers);
        prop_assert_eq!(map.known_columns() as usize, table.iter().flatten().flatten().count());
        let by_tile: u32 = map.tiles().map(|tile| u32::from(map.frontiers_in(tile))).sum();
        prop_assert_eq!(by_tile, frontiers);
    }

    /// Against a look at every tile.
    #[test]
    fn the_nearest_tiles_are_those_of_a_scan(
        columns in prop::collection::vec(column(), 0..40),
        x in -5.0f32..30.0,
        y in -5.0f32..20.0,
    ) {
        let mut map = Map::new(EXTENT).unwrap();
        for &column in &columns {
            map.learn(column);
        }
        let from = Point::new(x, y, 0.0);
        let mut distances: Vec<f32> = map
            .tiles()
            .filter(|&tile| map.frontiers_in(tile) > 0)
            .map(|tile| distance_to_tile(from, tile))
            .collect();
        distances.sort_by(f32::total_cmp);
        distances.truncate(3);
        let (found, _) = map.nearest_frontier_tiles::<3>(from);
        let found: Vec<f32> = found.iter().map(|&tile| distance_to_tile(from, tile)).collect();
        prop_assert_eq!(found, distances);

        let all = map.tiles().filter(|&tile| map.frontiers_in(tile) > 0).count();
        let mut round = std::collections::BTreeSet::new();
        let mut tile = TileIndex { x: 1, y: 1 };
        for _ in 0..all {
            tile = map.next_frontier_tile(tile).unwrap();
            round.insert(tile);
        }
        prop_assert_eq!(round.len(), all);
        prop_assert_eq!(map.next_frontier_tile(tile).is_some(), all > 0);
    }

    /// Any order and any repetition of the same patches gives the same map.
    #[test]
    fn merging_is_a_join(
        columns in prop::collection::vec(column(), 0..200),
        cut in 0usize..200,
        again in 0usize..6,
    ) {
        let mut whole = Map::new(EXTENT).unwrap();
        let mut parts = [whole.clone(), whole.clone()];
        for (i, &column) in columns.iter().enumerate() {
            whole.learn(column);
            parts[usize::from(i < cut)].learn(column);
        }
        for order in [[0, 1], [1, 0]] {
            let mut merged = Map::new(EXTENT).unwrap();
            for part in order {
                for tile in merged.tiles() {
                    let patch = parts[part].patch(tile, !0);
                    merged.merge(&patch);
                    if tile.x as usize == again {
                        merged.merge(&patch);
                    }
                }
            }
            prop_assert_eq!(merged.frontiers(), whole.frontiers());
            for cell in cells() {
                prop_assert_eq!(merged.height(cell), whole.height(cell));
            }
        }
    }
}

#[test]
fn a_map_that_does_not_fit_is_refused() {
    let extent = Extent::new(25, 16);
    let error = Surface::<3, 2>::new(extent).unwrap_err();
    let capacity = Extent::new(24, 16);
    let asked = extent;
    assert_eq!(error, ExtentError::TooLarge { asked, capacity });
}
