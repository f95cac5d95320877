//! What robots see of a scene.

use planner_core::volume::{Content, Field, Heading, Voxel, in_sight};

use super::sensor::shows_part;
use super::{Marks, Scene};

/// What `eye` sees within `range` voxels in all directions, each with whether it is solid. A
/// voxel that the scene does not know ends the sight like one that is occupied.
pub fn look(scene: &Scene, eye: Voxel, range: u8) -> Vec<(Voxel, bool)> {
    look_towards(scene, eye, range, Field::ALL_ROUND, Heading::EAST)
}

/// The same of a sensor with a field of view, turned to `heading`: of which it has a part in
/// its field.
pub(crate) fn look_towards(
    scene: &Scene,
    eye: Voxel,
    range: u8,
    field: Field,
    heading: Heading,
) -> Vec<(Voxel, bool)> {
    let mut seen = Vec::new();
    for voxel in around(eye, range) {
        if shows_part(field, eye, heading, voxel)
            && let Some(content) = scene.content(voxel)
            && in_sight(eye, voxel, |at| !scene.is_solid(at))
        {
            seen.push((voxel, content != Content::Free));
        }
    }
    seen
}

/// The voxels within `range` of `eye`, level by level.
fn around(eye: Voxel, range: u8) -> impl Iterator<Item = Voxel> {
    let reach = i16::from(range);
    let span = move |at: i16| at - reach..=at + reach;
    let voxels = span(eye.z).flat_map(move |z| {
        span(eye.y).flat_map(move |y| span(eye.x).map(move |x| Voxel::new(x, y, z)))
    });
    voxels.filter(move |voxel| eye.distance_squared(*voxel) <= u32::from(range).pow(2))
}

/// The occupied voxels that can be seen from any place that a robot of this clearance can reach
/// from `start`, in any heading, with their middle in the field.
///
/// Cost: for each occupied voxel beside a free one, a ray to the nearest such place that
/// sees it; to all within range if none does.
pub(crate) fn visible(
    scene: &Scene,
    start: Voxel,
    clearance: u8,
    range: u8,
    field: Field,
) -> Marks {
    let reached = scene.reached(start, clearance);
    let centre = Voxel::new(0, 0, 0);
    let mut offsets: Vec<Voxel> = around(centre, range)
        .filter(|&eye| Heading::all().any(|heading| field.shows(eye, heading, centre)))
        .collect();
    offsets.sort_by_key(|offset| centre.distance_squared(*offset));
    let mut visible = Marks::of(scene);
    for voxel in scene.voxels() {
        if scene.content(voxel) != Some(Content::Occupied) {
            continue;
        }
        // A ray comes to a voxel over one of the 26 about it.
        if around(voxel, 2).all(|at| scene.content(at) != Some(Content::Free)) {
            continue;
        }
        let sees = |offset: &Voxel| {
            let eye = Voxel::new(voxel.x + offset.x, voxel.y + offset.y, voxel.z + offset.z);
            reached.contains(scene, eye) && in_sight(eye, voxel, |at| !scene.is_solid(at))
        };
        if offsets.iter().any(sees) {
            visible.insert(scene, voxel);
        }
    }
    visible
}
