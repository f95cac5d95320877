use std::vec::Vec;

use proptest::prelude::*;

use super::*;

type Map = Volume<2, 2, 6>;

fn voxel() -> impl Strategy<Value = Voxel> {
    (-1i16..14, -1i16..12, -1i16..7).prop_map(|(x, y, z)| Voxel::new(x, y, z))
}

fn map() -> Map {
    Map::new(Extent::new(13, 11), 6).unwrap()
}

fn all() -> impl Iterator<Item = Voxel> {
    (-1..7).flat_map(|z| (-1..12).flat_map(move |y| (-1..14).map(move |x| Voxel::new(x, y, z))))
}

proptest! {
    #[test]
    fn poses_of_a_tile_are_those_of_its_voxels(
        learnt in prop::collection::vec((voxel(), prop::bool::weighted(0.02)), 0..3000),
    ) {
        let mut map = map();
        for &(voxel, occupied) in &learnt {
            map.learn(voxel, occupied);
        }
        for voxel in all().filter(|&voxel| map.contains(voxel)) {
            let (tile, z, bit) = voxel.place().unwrap();
            let is_free = |voxel| map.content(voxel) == Content::Free;
            for clearance in 0..=MAX_CLEARANCE {
                let is_pose = body_voxels(clearance, voxel).all(is_free);
                prop_assert_eq!(map.is_pose(voxel, clearance), is_pose, "{} {}", voxel, clearance);
                prop_assert_eq!(map.poses(tile, z, clearance) & bit != 0, is_pose);
            }
        }
        let known: std::collections::BTreeSet<_> =
            learnt.iter().map(|l| l.0).filter(|&v| map.contains(v)).collect();
        prop_assert_eq!(map.known_voxels() as usize, known.len());
        let is_unknown = |voxel| map.content(voxel) == Content::Unknown;
        let is_frontier = |voxel: &Voxel| {
            map.content(*voxel) == Content::Free && voxel.beside().into_iter().any(is_unknown)
        };
        prop_assert_eq!(map.frontiers() as usize, known.iter().copied().filter(is_frontier).count());
        for voxel in all().filter(|&voxel| map.contains(voxel)) {
            let is_free = |voxel| map.contains(voxel) && map.content(voxel) == Content::Free;
            let (tile, z, bit) = voxel.place().unwrap();
            let word = map.unknown_beside_free(tile, z);
            prop_assert_eq!(
                word & bit != 0,
                is_unknown(voxel) && voxel.beside().into_iter().any(is_free)
            );
        }
    }

    /// Any order and any repetition of the same patches gives the same map.
    #[test]
    fn merging_is_a_join(
        learnt in prop::collection::vec((voxel(), 0u8..3, 0usize..3), 0..600),
        order in Just([0usize, 1, 2, 1]).prop_shuffle(),
    ) {
        let mut whole = map();
        let mut parts = [map(), map(), map()];
        for &(voxel, level, part) in &learnt {
            for map in [&mut whole, &mut parts[part]] {
                match level {
                    2 => map.withdraw(voxel),
                    level => map.learn(voxel, level == 1),
                };
            }
        }
        for voxel in all().filter(|&voxel| whole.contains(voxel)) {
            let levels = learnt.iter().filter(|learnt| learnt.0 == voxel).map(|learnt| learnt.1);
            let content = match levels.max() {
                None => Content::Unknown,
                Some(1) => Content::Occupied,
                Some(_) => Content::Free,
            };
            prop_assert_eq!(whole.content(voxel), content);
        }
        let mut merged = map();
        for part in order {
            let (mut tile, mut z) = (TileIndex { x: 0, y: 0 }, 0);
            for _ in 0..2 * 2 * 6 {
                merged.merge(&parts[part].patch(tile, z));
                (tile, z) = merged.after(tile, z);
            }
        }
        for voxel in all() {
            prop_assert_eq!(merged.content(voxel), whole.content(voxel));
            prop_assert_eq!(merged.is_withdrawn(voxel), whole.is_withdrawn(voxel));
        }
        prop_assert_eq!(merged.known_voxels(), whole.known_voxels());
        prop_assert_eq!(merged.withdrawn(), whole.withdrawn());
    }

    /// Sight is mutual, and what it asks for lies near the line.
    #[test]
    fn sight_is_symmetric(
        from in voxel(), to in voxel(), walls in prop::collection::hash_set(voxel(), 0..200),
    ) {
        let is_clear = |voxel: Voxel| !walls.contains(&voxel);
        prop_assert_eq!(in_sight(from, to, is_clear), in_sight(to, from, is_clear));
        in_sight(from, to, |at| {
            let d = |v: Voxel| [f64::from(v.x - from.x), f64::from(v.y - from.y), f64::from(v.z - from.z)];
            let (p, q) = (d(at), d(to));
            let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
            let t = dot(p, q) / dot(q, q).max(1e-9);
            let off: Vec<f64> = (0..3).map(|i| (p[i] - t * q[i]).abs()).collect();
            assert!(off.iter().all(|&o| o <= 1.0), "{from:?} {to:?} {at:?}");
            true
        });
    }
}

/// What the completeness of surveys rests on: from a place for a body, the body one voxel on
/// is in sight over the two bodies alone.
#[test]
fn the_next_body_is_in_sight() {
    let here = Voxel::new(0, 0, 0);
    for clearance in 0..=MAX_CLEARANCE {
        let own: Vec<Voxel> = body_voxels(clearance, here).collect();
        let size = [1, 7, 33, 123][usize::from(clearance)];
        assert_eq!(own.len(), size);
        let reach = u32::from(clearance);
        assert!(
            own.iter()
                .all(|at| here.distance_squared(*at) <= reach * reach)
        );
        for next in here.beside() {
            let there: Vec<Voxel> = body_voxels(clearance, next).collect();
            for &voxel in &there {
                assert!(here.distance_squared(voxel) <= (reach + 1) * (reach + 1));
                let is_free = |at| own.contains(&at) || there.contains(&at);
                assert!(
                    in_sight(here, voxel, is_free),
                    "{clearance}: {voxel} from {next}"
                );
            }
        }
    }
}

#[test]
fn sight_does_not_slip_between_walls() {
    let (from, to) = (Voxel::new(0, 0, 0), Voxel::new(1, 1, 0));
    let one = |wall: Voxel| move |at: Voxel| at != wall;
    assert!(in_sight(from, to, one(Voxel::new(1, 0, 0))));
    assert!(in_sight(from, to, one(Voxel::new(0, 1, 0))));
    assert!(!in_sight(from, to, |at| at != Voxel::new(1, 0, 0)
        && at != Voxel::new(0, 1, 0)));
    assert!(!in_sight(
        from,
        Voxel::new(4, 2, 2),
        one(Voxel::new(2, 1, 1))
    ));
    // Through a corner, three borders at once: one way round it must be clear, and it is
    // the same way back.
    let (a, b) = (Voxel::new(0, 0, 0), Voxel::new(1, 1, 1));
    let walls = [[0, 1, 1], [1, 0, 1], [1, 1, 0]].map(|[x, y, z]| Voxel::new(x, y, z));
    for (from, to) in [(a, b), (b, a)] {
        assert!(in_sight(from, to, |at| !walls[..2].contains(&at)));
        assert!(!in_sight(from, to, |at| !walls.contains(&at)));
        // Clear are (1, 0, 0) and (0, 1, 1) alone: not side by side.
        let clear = [Voxel::new(1, 0, 0), walls[0]];
        assert!(!in_sight(from, to, |at| clear.contains(&at)));
    }
    assert!(in_sight(from, from, |_| false));
}
