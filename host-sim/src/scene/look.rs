//! What robots see of a scene.

use std::collections::HashSet;

use planner_core::volume::{Voxel, in_sight};

use super::Scene;

/// What `eye` sees within `range` voxels, each with whether it is occupied.
pub fn look(scene: &Scene, eye: Voxel, range: u8) -> Vec<(Voxel, bool)> {
    look_for(scene, eye, range, |_, _| true)
}

/// What `eye` sees of what is wanted.
fn look_for(
    scene: &Scene,
    eye: Voxel,
    range: u8,
    is_wanted: impl Fn(Voxel, bool) -> bool,
) -> Vec<(Voxel, bool)> {
    let reach = i16::from(range);
    let mut seen = Vec::new();
    for z in eye.z - reach..=eye.z + reach {
        for y in eye.y - reach..=eye.y + reach {
            for x in eye.x - reach..=eye.x + reach {
                let voxel = Voxel::new(x, y, z);
                if let Some(occupied) = scene.is_occupied(voxel)
                    && eye.distance_squared(voxel) <= u32::from(range).pow(2)
                    && is_wanted(voxel, occupied)
                    && in_sight(eye, voxel, |at| scene.is_occupied(at) != Some(true))
                {
                    seen.push((voxel, occupied));
                }
            }
        }
    }
    seen
}

/// The occupied voxels that can be seen from any place that can be reached from `start`.
pub(crate) fn visible(scene: &Scene, start: Voxel, range: u8) -> HashSet<Voxel> {
    let mut reached = vec![start];
    let mut is_reached: HashSet<Voxel> = reached.iter().copied().collect();
    let mut visible: HashSet<Voxel> = HashSet::new();
    let mut next = 0;
    while let Some(&at) = reached.get(next) {
        next += 1;
        let is_new = |voxel, occupied| occupied && !visible.contains(&voxel);
        let new = look_for(scene, at, range, is_new);
        visible.extend(new.into_iter().map(|(voxel, _)| voxel));
        for beside in at.beside() {
            if scene.is_pose(beside) && is_reached.insert(beside) {
                reached.push(beside);
            }
        }
    }
    visible
}
