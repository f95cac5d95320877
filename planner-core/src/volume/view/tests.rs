use std::collections::BTreeSet;
use std::vec::Vec;

use proptest::prelude::*;

use super::*;
use crate::cell::Extent;
use crate::volume::{Layer, in_sight};

const EXTENT: Extent = Extent::new(29, 26);
const LEVELS: i16 = 20;

type Bits = Layer<4, 4, 20>;

fn voxel() -> impl Strategy<Value = Voxel> {
    (0i16..29, 0i16..26, 0i16..LEVELS).prop_map(|(x, y, z)| Voxel::new(x, y, z))
}

fn all() -> impl Iterator<Item = Voxel> {
    (0..LEVELS).flat_map(|z| {
        (0..EXTENT.height as i16)
            .flat_map(move |y| (0..EXTENT.width as i16).map(move |x| Voxel::new(x, y, z)))
    })
}

fn layer(is_set: impl Fn(Voxel) -> bool) -> Bits {
    let mut bits = Layer::EMPTY;
    for voxel in all().filter(|&voxel| is_set(voxel)) {
        bits.set(voxel);
    }
    bits
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// The same as a ray to each, in the open and among walls, at the edges of a box.
    #[test]
    fn a_view_has_what_a_ray_to_each_has(
        eye in voxel(),
        reach in 0u8..=MAX_REACH,
        slabs in prop::collection::vec((voxel(), voxel()), 0..6),
        density in 0u32..24,
        seed in any::<u64>(),
        is_wanted_everywhere in any::<bool>(),
    ) {
        let mut dice = crate::rng::Rng::new(seed, 0);
        let is_between = |at: i16, a: i16, b: i16| (a.min(b)..=a.max(b)).contains(&at);
        let blocked: BTreeSet<Voxel> = all()
            .filter(|at| {
                let is_in_slab = |(a, b): &(Voxel, Voxel)| {
                    // Two voxels thick at most, as walls are.
                    is_between(at.x, a.x, b.x) && is_between(at.y, a.y, b.y) && a.z.abs_diff(at.z) < 2
                };
                dice.next_u32() % 64 < density || slabs.iter().any(is_in_slab)
            })
            .collect();
        let wanted: BTreeSet<Voxel> = all()
            .filter(|_| is_wanted_everywhere || dice.next_u32().is_multiple_of(8))
            .collect();
        let (stops, asked) = (layer(|at| blocked.contains(&at)), layer(|at| wanted.contains(&at)));
        let mut view = View::new(eye, reach);
        view.aim(|tile, z| asked.word(tile, z));
        let mut seen: Vec<Voxel> = Vec::new();
        let mut count = 0;
        let ended = view.look(|tile, z| stops.word(tile, z), |tile, z| asked.word(tile, z), |row| {
            count += row.count() as usize;
            seen.extend(row.voxels(u32::MAX));
            ControlFlow::Continue(())
        });
        prop_assert!(ended.is_continue());
        let range = u32::from(reach) * u32::from(reach);
        let expected: BTreeSet<Voxel> = wanted
            .into_iter()
            .filter(|&at| eye.distance_squared(at) <= range)
            .filter(|&at| in_sight(eye, at, |at| !blocked.contains(&at)))
            .collect();
        prop_assert_eq!(count, seen.len());
        // Each once.
        prop_assert_eq!(count, expected.len());
        prop_assert_eq!(seen.into_iter().collect::<BTreeSet<_>>(), expected);
    }
}

/// In the open nothing needs a ray, and whoever has enough ends the look.
#[test]
fn what_is_open_needs_no_ray() {
    let mut view = View::new(Voxel::new(14, 13, 9), 8);
    assert!(view.aim(|_, _| !0));
    let mut rows = 0;
    let everything = view.look(
        |_, _| 0,
        |_, _| !0,
        |_| {
            rows += 1;
            ControlFlow::Continue(())
        },
    );
    assert!(everything.is_continue() && rows > 300);
    let first = view.look(|_, _| 0, |_, _| !0, |_| ControlFlow::Break(()));
    assert!(first.is_break());
    // The words of 17 levels and the rows of two octants at most.
    assert!(view.work < 2000, "{}", view.work);
}
