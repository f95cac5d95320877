//! The view from the south-east and above: columns as blocks, ways in the air.

use image::{Rgb, RgbImage};
use planner_core::{Cell, Point};

use super::{ROBOT_COLOURS, shade};
use crate::survey::Trace;

/// Pixels of a cell along the picture's x axis, and up.
const SCALE: f32 = 4.0;

/// Where a point falls: an isometric view with north away to the right.
fn project(at: Point, origin: (f32, f32)) -> (f32, f32) {
    (
        origin.0 + (at.x - at.y) * SCALE,
        origin.1 + (at.x + at.y) * SCALE * 0.5 - at.z * SCALE,
    )
}

/// What had been mapped after `step` steps, with the ways flown; what is unknown is
/// left dark.
pub fn oblique_view(trace: &Trace, step: u32) -> RgbImage {
    let terrain = &trace.terrain;
    let extent = terrain.extent();
    let (width, height) = (f32::from(extent.width), f32::from(extent.height));
    let margin = 20.0;
    let top = terrain.highest().cells() + 8.0;
    let origin = (height * SCALE + margin, top * SCALE + margin);
    let mut picture = RgbImage::from_pixel(
        ((width + height) * SCALE + 2.0 * margin) as u32,
        ((width + height) * SCALE * 0.5 + top * SCALE + 2.0 * margin) as u32,
        Rgb([24, 26, 30]),
    );
    let mut known = vec![None; extent.cells() as usize];
    for column in trace.mapped(step) {
        let index = column.cell.y as usize * usize::from(extent.width) + column.cell.x as usize;
        known[index] = Some(column.height.cells());
    }
    // Far columns first, so that near ones cover them.
    let mut cells: Vec<Cell> = terrain.cells().collect();
    cells.sort_by_key(|cell| cell.x + cell.y);
    for cell in cells {
        let index = cell.y as usize * usize::from(extent.width) + cell.x as usize;
        if let Some(ground) = known[index] {
            block(
                &mut picture,
                cell,
                ground,
                terrain.highest().cells(),
                origin,
            );
        }
    }
    for robot in 0..trace.robots {
        let colour = ROBOT_COLOURS[robot % ROBOT_COLOURS.len()];
        let way = trace.way(robot, step);
        for leg in way.windows(2) {
            let ((x0, y0), (x1, y1)) = (project(leg[0], origin), project(leg[1], origin));
            let pixels = (x1 - x0).abs().max((y1 - y0).abs()).ceil().max(1.0);
            for i in 0..=pixels as u32 {
                let share = i as f32 / pixels;
                put(
                    &mut picture,
                    x0 + (x1 - x0) * share,
                    y0 + (y1 - y0) * share,
                    colour,
                );
                put(
                    &mut picture,
                    x0 + (x1 - x0) * share,
                    y0 + (y1 - y0) * share + 1.0,
                    colour,
                );
            }
        }
        if let Some(last) = way.last() {
            let (x, y) = project(*last, origin);
            for dy in -4i8..=4 {
                for dx in -4i8..=4 {
                    if i32::from(dx).pow(2) + i32::from(dy).pow(2) <= 16 {
                        put(&mut picture, x + f32::from(dx), y + f32::from(dy), colour);
                    }
                }
            }
        }
    }
    picture
}

/// One column: its top, and its two sides that face the viewer.
fn block(picture: &mut RgbImage, cell: Cell, ground: f32, highest: f32, origin: (f32, f32)) {
    let colour = shade(ground, highest);
    let darker = |share: f32| Rgb(colour.0.map(|value| (f32::from(value) * share) as u8));
    let (x, y) = project(Point::over(cell, ground), origin);
    let wide = SCALE as i32;
    let deep = (ground * SCALE) as i32;
    for dx in -wide..=wide {
        let half = (SCALE * 0.5 * (1.0 - dx.abs() as f32 / SCALE)) as i32;
        for dy in -half..=half {
            put(picture, x + dx as f32, y + dy as f32, colour);
        }
        let side = if dx < 0 { darker(0.7) } else { darker(0.5) };
        for dy in half + 1..=half + deep {
            put(picture, x + dx as f32, y + dy as f32, side);
        }
    }
}

fn put(picture: &mut RgbImage, x: f32, y: f32, colour: Rgb<u8>) {
    if x >= 0.0 && y >= 0.0 && (x as u32) < picture.width() && (y as u32) < picture.height() {
        picture.put_pixel(x as u32, y as u32, colour);
    }
}
