//! The view from above: heights as shades, ways as lines.

use image::RgbImage;
use planner_core::Point;

use super::paint::{DARK, disc, line, shade, way_color};
use crate::record::heights::Trace;

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
        DARK,
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
        let colour = way_color(robot);
        let way = trace.way(robot, step);
        for leg in way.windows(2) {
            let pen = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)];
            line(&mut picture, pixel(leg[0]), pixel(leg[1]), &pen, colour);
        }
        if let (Some(first), Some(last)) = (way.first(), way.last()) {
            disc(&mut picture, pixel(*first), 3.0..=5.0, colour);
            disc(&mut picture, pixel(*last), 0.0..=5.0, colour);
        }
    }
    picture
}

fn pixel(at: Point) -> (f32, f32) {
    (at.x * SCALE as f32, at.y * SCALE as f32)
}
