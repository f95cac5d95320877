//! The view from above: heights as shades, ways as lines.

use image::RgbImage;
use planner_core::Point;

use super::compass::{Drawn, Rows, Sides, ways_over_heights};
use super::paint::{DARK, disc, line, shade, square, way_color};
use crate::record::heights::Trace;

/// Pixels of a cell's side.
const SCALE: u32 = 6;

/// What had been mapped after `step` steps, light where it is high, with the way of each robot flown
/// until then, a ring where it started and a disc where it is. North is above.
pub fn top_view(trace: &Trace, step: u32) -> RgbImage {
    top(trace, step).image
}

pub(super) fn top(trace: &Trace, step: u32) -> Drawn {
    let terrain = &trace.terrain;
    let (extent, rows) = (terrain.extent(), Rows::of_heights(trace));
    let mut picture = RgbImage::from_pixel(
        u32::from(extent.width) * SCALE,
        u32::from(extent.height) * SCALE,
        DARK,
    );
    let highest = terrain.highest().cells();
    for column in trace.mapped(step) {
        let colour = shade(column.height.cells(), highest);
        let corner = rows.corner(column.cell, SCALE);
        square(&mut picture, corner, SCALE, colour);
    }
    for (robot, way) in ways_over_heights(trace, step).iter().enumerate() {
        let colour = way_color(robot);
        for leg in way.windows(2) {
            let pen = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)];
            line(&mut picture, pixel(leg[0]), pixel(leg[1]), &pen, colour);
        }
        if let (Some(first), Some(last)) = (way.first(), way.last()) {
            disc(&mut picture, pixel(*first), 3.0..=5.0, colour);
            disc(&mut picture, pixel(*last), 0.0..=5.0, colour);
        }
    }
    Drawn {
        image: picture,
        sides: Sides::from_above(SCALE),
    }
}

fn pixel(at: Point) -> (f32, f32) {
    (at.x * SCALE as f32, at.y * SCALE as f32)
}
