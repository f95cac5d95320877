//! What is shown, as files.

use host_sim::draw;
use host_sim::record::grid::Trace;
use image::codecs::png::PngEncoder;
use image::{ColorType, ImageEncoder};
use planner_core::Cell;

use crate::colors::Colors;
use crate::ground::{self, ALL_TICKS, Layers, Subject};
use crate::watch::Watch;

/// Sides of the picture in pixels, about.
const SIDE: usize = 1024;

/// The world as it was seen up to the shown tick, with every robot's way, as PNG.
///
/// # Errors
/// Those of the encoder.
pub fn png(watch: &Watch) -> Result<Vec<u8>, String> {
    let colors = &Colors::LIGHT;
    let ground = ground::image(watch, Subject::World, &Layers::default(), colors);
    let [columns, rows] = ground.size;
    let scale = (SIDE / columns.max(rows)).clamp(2, 24);
    let (width, height) = (columns * scale, rows * scale);
    let mut pixels = Vec::with_capacity(width * height);
    for row in ground.pixels.chunks_exact(columns) {
        let line: Vec<_> = row
            .iter()
            .flat_map(|&pixel| std::iter::repeat_n(pixel, scale))
            .collect();
        for _ in 0..scale {
            pixels.extend_from_slice(&line);
        }
    }
    let mut fill = |x: i32, y: i32, side: i32, color| {
        let span = |at: i32, end: usize| at.max(0) as usize..((at + side).max(0) as usize).min(end);
        for y in span(y, height) {
            pixels[y * width..][span(x, width)].fill(color);
        }
    };
    let robots = watch.scenario().starts.len();
    let lanes = robots.min(7) as i32;
    let scale = scale as i32;
    let middle = |robot: usize, cell: Cell| {
        let aside = (2 * (robot as i32 % 7) - (lanes - 1)) * scale / (3 * lanes);
        let at = |place: i16| i32::from(place) * scale + scale / 2 + aside;
        (at(cell.x), at(cell.y))
    };
    let thick = (scale / 6).max(1);
    for (robot, way) in ground::ways(watch, ALL_TICKS).iter().enumerate() {
        for leg in way.windows(2) {
            let (mut at, end) = (middle(robot, leg[0]), middle(robot, leg[1]));
            loop {
                fill(at.0, at.1, thick, colors.robot(robot));
                if at == end {
                    break;
                }
                at = (
                    at.0 + (end.0 - at.0).signum(),
                    at.1 + (end.1 - at.1).signum(),
                );
            }
        }
    }
    let side = (scale * 3 / 4).max(5);
    for (robot, cell) in watch.positions().into_iter().enumerate() {
        let at = |place: i16| i32::from(place) * scale + scale / 2 - side / 2;
        let (x, y) = (at(cell.x), at(cell.y));
        fill(x - 1, y - 1, side + 2, colors.ink);
        fill(x, y, side, colors.robot(robot));
    }
    let bytes: Vec<u8> = ground::rgb(&pixels).collect();
    let mut png = Vec::new();
    let kind = ColorType::Rgb8;
    PngEncoder::new(&mut png)
        .write_image(&bytes, width as u32, height as u32, kind)
        .map_err(|error| error.to_string())?;
    Ok(png)
}

/// The run up to its last tick as an animation.
///
/// # Errors
/// Those of the encoder.
pub fn gif(trace: &Trace) -> Result<Vec<u8>, String> {
    let mut gif = Vec::new();
    draw::animation(trace, &mut gif).map_err(|error| error.to_string())?;
    Ok(gif)
}

/// The trace as host-sim writes it.
///
/// # Errors
/// None in memory.
pub fn trace(trace: &Trace) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    trace.write(&mut bytes).map_err(|error| error.to_string())?;
    Ok(bytes)
}
