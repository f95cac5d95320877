//! The floor plan of a scene of voxels: what a cut at one level leaves, from above.

use image::{Rgb, RgbImage};
use planner_core::{Cell, Point};

use super::compass::{Drawn, Rows, Sides, ways_among_voxels};
use super::paint::{Ground, disc, line, pale, rgb, robot_color, square};
use crate::record::voxels::VoxelTrace;

/// Side of a plan in pixels, about.
const SIDE: u32 = 900;

/// Colours of what lies just beneath the cut, and of what lies deepest.
pub(super) const DEPTHS: [Rgb<u8>; 2] = [Rgb([244, 222, 150]), Rgb([255; 3])];

/// The robots' map in the end, at one level and what is seen beneath it, with all ways; what was
/// flown higher is pale. A ring where a robot started, a disc where it ended.
pub(super) fn plan(trace: &VoxelTrace, level: i16) -> Drawn {
    let extent = trace.scene.extent();
    let rows = Rows::of_voxels(extent);
    let scale = (SIDE / u32::from(extent.width.max(extent.height))).clamp(2, 24);
    let mut picture = RgbImage::from_pixel(
        u32::from(extent.width) * scale,
        u32::from(extent.height) * scale,
        rgb(Ground::Unknown.color()),
    );
    for (cell, colour) in columns(trace, level) {
        let corner = rows.corner(cell, scale);
        square(&mut picture, corner, scale, colour);
    }
    let ways = ways_among_voxels(trace, u32::MAX);
    draw_ways(&mut picture, &ways, f32::from(level) + 1.0, scale as f32);
    Drawn {
        image: picture,
        sides: Sides::from_above(scale),
    }
}

/// The columns that are known at `level`, each with its colour.
fn columns(trace: &VoxelTrace, level: i16) -> impl Iterator<Item = (Cell, Rgb<u8>)> {
    let extent = trace.scene.extent();
    let width = usize::from(extent.width);
    let index = move |cell: Cell| cell.y as usize * width + cell.x as usize;
    let map = trace.map(u32::MAX);
    // The level of the highest that is known to be beneath; -1 where nothing is.
    let mut ground = vec![-1; extent.cells() as usize];
    for (voxel, _) in map.iter().filter(|(at, full)| *full && at.z < level) {
        let ground = &mut ground[index(voxel.cell())];
        *ground = voxel.z.max(*ground);
    }
    let deepest = level - ground.iter().filter(|&&z| z >= 0).min().unwrap_or(&0);
    let at_level = map.into_iter().filter(move |(voxel, _)| voxel.z == level);
    at_level.map(move |(voxel, is_occupied)| {
        let colour = match is_occupied {
            true => rgb(Ground::Obstacle.color()),
            false => depth(level - ground[index(voxel.cell())], deepest),
        };
        (voxel.cell(), colour)
    })
}

/// The colour of what lies so many levels beneath the cut, of at most so many.
fn depth(levels: i16, most: i16) -> Rgb<u8> {
    let share = match most > 1 {
        true => f32::from(levels - 1) / f32::from(most - 1),
        false => 1.0,
    };
    let [near, deep] = DEPTHS.map(|colour| colour.0.map(f32::from));
    Rgb([0, 1, 2].map(|i| (near[i] + (deep[i] - near[i]) * share.min(1.0)) as u8))
}

/// The ways in cells; what lies higher than `top` first, so that it covers nothing.
fn draw_ways(picture: &mut RgbImage, ways: &[Vec<Point>], top: f32, scale: f32) {
    let pixel = |at: &Point| (at.x * scale, at.y * scale);
    let pen = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)];
    for is_higher in [true, false] {
        for (robot, way) in ways.iter().enumerate() {
            let colour = match is_higher {
                true => pale(robot_color(robot)),
                false => rgb(robot_color(robot)),
            };
            let legs = way.windows(2);
            for leg in legs.filter(|leg| (leg[0].z.max(leg[1].z) > top) == is_higher) {
                line(picture, pixel(&leg[0]), pixel(&leg[1]), &pen, colour);
            }
        }
    }
    for (robot, way) in ways.iter().enumerate() {
        let colour = rgb(robot_color(robot));
        if let (Some(first), Some(last)) = (way.first(), way.last()) {
            disc(picture, pixel(first), 0.0..=7.0, Rgb([255; 3]));
            disc(picture, pixel(first), 5.0..=7.0, colour);
            disc(picture, pixel(last), 0.0..=6.0, Rgb([255; 3]));
            disc(picture, pixel(last), 0.0..=5.0, colour);
        }
    }
}

#[cfg(test)]
mod tests {
    use planner_core::volume::Voxel;

    use super::super::oblique::tests::house;
    use super::*;

    #[test]
    fn a_plan_has_walls_rooms_and_the_north_above() {
        let trace = house(Voxel::new(7, 7, 2));
        let drawn = plan(&trace, 3);
        let scale = 24;
        assert_eq!(drawn.image.dimensions(), (15 * scale, 16 * scale));
        // Beside the middle, where a way may be.
        let at = |x: u32, y: u32| *drawn.image.get_pixel(x * scale + 2, (15 - y) * scale + 2);
        let [wall, unknown] = [Ground::Obstacle, Ground::Unknown].map(|it| rgb(it.color()));
        let [near, floor] = DEPTHS;
        assert_eq!([at(4, 7), at(7, 10), at(5, 4)], [wall; 3]);
        // The door is in the south; what is inside of a wall nobody sees.
        assert_eq!([at(6, 4), at(6, 7), at(1, 1)], [floor; 3]);
        assert_ne!(at(7, 4), wall);
        let top = plan(&trace, 7);
        assert_eq!(*top.image.get_pixel(7 * scale + 2, 8 * scale + 2), near);
        let bottom = plan(&trace, -1);
        assert!(bottom.image.pixels().any(|it| *it == unknown));
    }
}
