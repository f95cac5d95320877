//! A run as an animated GIF.

use std::io::Write;

use gif::{Encoder, Frame, Repeat};
use image::{GenericImageView, Rgb, RgbImage};
use planner_core::explorer::body_cells;
use planner_core::{Cell, Extent};

use super::DrawError;
use super::paint::{Ground, INK, pale, rgb, robot_color};
use super::replay::Replay;
use crate::record::grid::Trace;
use crate::world::cells;

/// Frames at most; a longer run is shown in larger strides.
const MOST_FRAMES: u32 = 200;
/// How long a frame is shown, in hundredths of a second.
const DELAY: u16 = 6;
/// The same for the last frame.
const LAST_DELAY: u16 = 200;

/// Largest side of the map of an exploration in pixels.
const SIDE: u32 = 512;
/// Height of the bar that shows how much has been seen, in pixels.
const BAR: u32 = 6;

/// Writes `picture` of the steps 0 to `steps` - 1, all of one size, one after the other;
/// of a long run in strides, the last always.
///
/// # Errors
/// Those of `to`.
pub fn animate(
    steps: u32,
    mut picture: impl FnMut(u32) -> RgbImage,
    to: impl Write,
) -> Result<(), DrawError> {
    let stride = steps.div_ceil(MOST_FRAMES).max(1);
    let last = steps.saturating_sub(1);
    let mut shown = picture(last % stride);
    let (width, height) = (shown.width() as u16, shown.height() as u16);
    let mut encoder = Encoder::new(to, width, height, &[])?;
    encoder.set_repeat(Repeat::Infinite)?;
    encoder.write_frame(&frame(
        &shown,
        (0, 0, shown.width(), shown.height()),
        steps < 2,
    ))?;
    for step in (last % stride..steps).step_by(stride as usize).skip(1) {
        let next = picture(step);
        if let Some(changed) = changes(&shown, &next) {
            encoder.write_frame(&frame(&next, changed, step == last))?;
        }
        shown = next;
    }
    Ok(())
}

/// Left, top, width and height of a part of a picture.
type Part = (u32, u32, u32, u32);

/// That part of a picture, over what was shown before.
fn frame(picture: &RgbImage, (left, top, width, height): Part, is_last: bool) -> Frame<'static> {
    let part = picture.view(left, top, width, height).to_image();
    let (width, height) = (width as u16, height as u16);
    let frame = match indexed(&part) {
        Some((pixels, palette)) => Frame::from_palette_pixels(width, height, pixels, palette, None),
        None => Frame::from_rgb_speed(width, height, part.as_raw(), 20),
    };
    Frame {
        left: left as u16,
        top: top as u16,
        delay: if is_last { LAST_DELAY } else { DELAY },
        ..frame
    }
}

/// The pixels as numbers of colours, and the colours; `None`: there are more than 256.
/// Most pictures have a dozen, which are found sooner in a list than in a tree.
fn indexed(part: &RgbImage) -> Option<(Vec<u8>, Vec<u8>)> {
    let mut palette: Vec<Rgb<u8>> = Vec::new();
    let number = |&color: &Rgb<u8>| {
        let known = palette.iter().position(|&of| of == color);
        u8::try_from(known.unwrap_or_else(|| {
            palette.push(color);
            palette.len() - 1
        }))
        .ok()
    };
    let pixels = part.pixels().map(number).collect::<Option<_>>()?;
    Some((pixels, palette.iter().flat_map(|color| color.0).collect()))
}

/// The box around all pixels that differ, if any does.
fn changes(old: &RgbImage, new: &RgbImage) -> Option<Part> {
    let pixels = old.enumerate_pixels().zip(new.pixels());
    let changed = pixels.filter(|((_, _, old), new)| old != new);
    let (mut left, mut top, mut right, mut bottom) = (u32::MAX, u32::MAX, 0, 0);
    for ((x, y, _), _) in changed {
        (left, top) = (left.min(x), top.min(y));
        (right, bottom) = (right.max(x + 1), bottom.max(y + 1));
    }
    (left < right).then(|| (left, top, right - left, bottom - top))
}

/// Writes an exploration: what the team has seen, where the robots are, and as a bar at
/// the bottom the share of reachable cells seen.
///
/// # Errors
/// Those of `to`.
pub fn animation(trace: &Trace, to: impl Write) -> Result<(), DrawError> {
    let mut replay = Replay::new(trace);
    let picture = |tick| {
        while replay.ticks() <= tick && replay.tick() {}
        screen(&replay)
    };
    animate(trace.ticks(), picture, to)
}

/// What is on the screen after the ticks that were played.
fn screen(replay: &Replay<'_>) -> RgbImage {
    let Extent { width, height } = replay.extent();
    let scale = (SIDE / u32::from(width.max(height))).clamp(1, 12);
    let (width, height) = (u32::from(width) * scale, u32::from(height) * scale);
    let mut screen = RgbImage::new(width, height + BAR);
    // A cell, and `grow` pixels around it.
    let mut fill = |cell: Cell, grow: u32, color: Rgb<u8>| {
        let span = |at: i16, end: u32| {
            let first = at as u32 * scale;
            first.saturating_sub(grow)..(first + scale + grow).min(end)
        };
        for y in span(cell.y, height) {
            for x in span(cell.x, width) {
                screen.put_pixel(x, y, color);
            }
        }
    };
    for cell in cells(replay.extent()) {
        fill(cell, 0, rgb(replay.ground(cell).color()));
    }
    // Robots at least five pixels wide, so that they can be seen on large maps.
    let grow = 5u32.saturating_sub(scale).div_ceil(2);
    for (robot, &cell) in replay.positions().iter().enumerate() {
        let body = body_cells(replay.clearance(), cell);
        body.for_each(|cell| fill(cell, 0, pale(robot_color(robot))));
        fill(cell, grow, rgb(robot_color(robot)));
    }
    let seen = u64::from(width) * u64::from(replay.seen_cells());
    let seen = (seen / u64::from(replay.reachable_cells().max(1))) as u32;
    let (ink, rest) = (INK, Ground::Free.color());
    for y in height..height + BAR {
        for x in 0..width {
            let color = if x < seen { ink } else { rest };
            screen.put_pixel(x, y, rgb(color));
        }
    }
    screen
}
