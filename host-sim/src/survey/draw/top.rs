//! The view from above: heights as shades, ways as lines.

use image::{Rgb, RgbImage};
use planner_core::Point;

use super::{ROBOT_COLOURS, shade};
use crate::survey::Trace;

/// Pixels of a cell's side.
const SCALE: u32 = 6;

/// What had been mapped after `step` steps, light where it is high, with the way of each robot flown
/// until then, a ring where it started and a disc where it is.
pub fn top_view(trace: &Trace, step: u32) -> RgbImage {
    let terrain = &trace.terrain;
    let extent = terrain.extent();
    let mut picture = RgbImage::from_pixel(
        u32::from(extent.width) * SCALE,
        u32::from(extent.height) * SCALE,
        Rgb([24, 26, 30]),
    );
    let highest = terrain.highest().cells();
    for column in trace.mapped(step) {
        let colour = shade(column.height.cells(), highest);
        for dy in 0..SCALE {
            for dx in 0..SCALE {
                let x = column.cell.x as u32 * SCALE + dx;
                picture.put_pixel(x, column.cell.y as u32 * SCALE + dy, colour);
            }
        }
    }
    for robot in 0..trace.robots {
        let colour = ROBOT_COLOURS[robot % ROBOT_COLOURS.len()];
        let way = trace.way(robot, step);
        for leg in way.windows(2) {
            line(&mut picture, leg[0], leg[1], colour);
        }
        if let (Some(first), Some(last)) = (way.first(), way.last()) {
            disc(&mut picture, *first, 3.0..=5.0, colour);
            disc(&mut picture, *last, 0.0..=5.0, colour);
        }
    }
    picture
}

fn pixel(at: Point) -> (f32, f32) {
    (at.x * SCALE as f32, at.y * SCALE as f32)
}

fn put(picture: &mut RgbImage, x: f32, y: f32, colour: Rgb<u8>) {
    if x >= 0.0 && y >= 0.0 && (x as u32) < picture.width() && (y as u32) < picture.height() {
        picture.put_pixel(x as u32, y as u32, colour);
    }
}

fn line(picture: &mut RgbImage, from: Point, to: Point, colour: Rgb<u8>) {
    let ((x0, y0), (x1, y1)) = (pixel(from), pixel(to));
    let length = (x1 - x0).abs().max((y1 - y0).abs()).ceil().max(1.0);
    for i in 0..=length as u32 {
        let share = i as f32 / length;
        let (x, y) = (x0 + (x1 - x0) * share, y0 + (y1 - y0) * share);
        for (dx, dy) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)] {
            put(picture, x + dx, y + dy, colour);
        }
    }
}

fn disc(
    picture: &mut RgbImage,
    centre: Point,
    radii: std::ops::RangeInclusive<f32>,
    colour: Rgb<u8>,
) {
    let (x, y) = pixel(centre);
    let reach = radii.end().ceil() as i32;
    for dy in -reach..=reach {
        for dx in -reach..=reach {
            if radii.contains(&((dx * dx + dy * dy) as f32).sqrt()) {
                put(picture, x + dx as f32, y + dy as f32, colour);
            }
        }
    }
}
