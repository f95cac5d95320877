use std::collections::BTreeSet;
use std::vec::Vec;

use proptest::prelude::*;

use super::*;
use crate::volume::in_sight;

const EXTENT: Extent = Extent::new(11, 10);
const LEVELS: u8 = 7;
const RANGE: u8 = 4;

const CONFIG: Config = Config {
    range: RANGE,
    link: LinkConfig::new(),
};

type Robot = VoxelSurvey<2, 2, 7>;

fn all() -> impl Iterator<Item = Voxel> {
    (0..LEVELS as i16)
        .flat_map(|z| (0..10).flat_map(move |y| (0..11).map(move |x| Voxel::new(x, y, z))))
}

fn is_inside(voxel: Voxel) -> bool {
    EXTENT.contains(voxel.cell()) && (0..LEVELS as i16).contains(&voxel.z)
}

/// What a sensor at `eye` shows.
fn look(walls: &BTreeSet<Voxel>, eye: Voxel) -> Vec<(Voxel, bool)> {
    let range = u32::from(RANGE * RANGE);
    all()
        .filter(|&voxel| eye.distance_squared(voxel) <= range)
        .filter(|&voxel| in_sight(eye, voxel, |at| !walls.contains(&at)))
        .map(|voxel| (voxel, walls.contains(&voxel)))
        .collect()
}

/// Every voxel that is seen from any place that can be reached, by brute force.
fn visible(walls: &BTreeSet<Voxel>, start: Voxel) -> BTreeSet<Voxel> {
    let is_pose = |voxel: Voxel| {
        is_inside(voxel)
            && !walls.contains(&voxel)
            && voxel.beside().iter().all(|beside| !walls.contains(beside))
    };
    let mut reached = Vec::from([start]);
    let mut next = 0;
    while let Some(&at) = reached.get(next) {
        next += 1;
        for beside in at.beside() {
            if is_pose(beside) && !reached.contains(&beside) {
                reached.push(beside);
            }
        }
    }
    reached
        .iter()
        .flat_map(|&eye| look(walls, eye))
        .map(|(voxel, _)| voxel)
        .collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Everything that can be seen from anywhere that can be reached is seen, and the
    /// robot never touches anything.
    #[test]
    fn all_that_can_be_seen_is_seen(
        scattered in prop::collection::btree_set((0i16..11, 0i16..10, 0i16..7), 0..40),
        slabs in prop::collection::vec(((0i16..11, 0i16..10, 0i16..7), (1i16..7, 1i16..7, 1i16..4)), 0..5),
    ) {
        let mut walls: BTreeSet<Voxel> =
            scattered.into_iter().map(|(x, y, z)| Voxel::new(x, y, z)).collect();
        for ((x, y, z), (wide, deep, high)) in slabs {
            walls.extend(all().filter(|v| {
                (x..x + wide).contains(&v.x) && (y..y + deep).contains(&v.y) && (z..z + high).contains(&v.z)
            }));
        }
        let start = Voxel::new(5, 5, 4);
        walls.remove(&start);
        for beside in start.beside() {
            walls.remove(&beside);
        }
        let mut robot = Robot::new(EXTENT, LEVELS, CONFIG, 0).unwrap();
        let mut at = start;
        let mut steps = 0;
        loop {
            robot.observe(at, &look(&walls, at));
            match robot.tick() {
                Action::Fly(to) => {
                    prop_assert_eq!(at.distance_squared(to), 1);
                    prop_assert!(is_inside(to) && !walls.contains(&to));
                    prop_assert!(to.beside().iter().all(|beside| !walls.contains(beside)));
                    at = to;
                }
                Action::Hover => {}
                Action::Stop => break,
            }
            steps += 1;
            prop_assert!(steps < 20_000);
        }
        for voxel in visible(&walls, start) {
            prop_assert!(robot.volume().content(voxel) != crate::volume::Content::Unknown, "{voxel:?}");
        }
    }
}

/// Whole state for 40×40×16 voxels.
#[test]
fn a_robot_fits_into_24_kib() {
    assert!(size_of::<VoxelSurvey<5, 5, 16>>() <= 24 * 1024);
}
