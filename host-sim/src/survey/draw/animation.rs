//! A run as an animated GIF.

use std::io::Write;

use gif::{Encoder, Frame, Repeat};

use image::RgbImage;

use super::top_view;
use crate::draw::DrawError;
use crate::survey::Trace;

/// Frames at most; a longer run is shown in larger strides.
const MOST_FRAMES: u32 = 120;

/// Writes the view from above over time.
///
/// # Errors
/// Those of `to`.
pub fn animation(trace: &Trace, to: impl Write) -> Result<(), DrawError> {
    animate(trace.seen.len() as u32, |step| top_view(trace, step), to)
}

/// Writes `picture` of the steps 0 to `steps` - 1 one after the other.
///
/// # Errors
/// Those of `to`.
pub fn animate(
    steps: u32,
    picture: impl Fn(u32) -> RgbImage,
    to: impl Write,
) -> Result<(), DrawError> {
    let stride = steps.div_ceil(MOST_FRAMES).max(1);
    let first = picture(0);
    let (width, height) = (first.width() as u16, first.height() as u16);
    let mut encoder = Encoder::new(to, width, height, &[])?;
    encoder.set_repeat(Repeat::Infinite)?;
    // The last step is always shown.
    for step in (0..steps)
        .rev()
        .step_by(stride as usize)
        .collect::<Vec<_>>()
        .into_iter()
        .rev()
    {
        let mut frame = Frame::from_rgb_speed(width, height, picture(step).as_raw(), 20);
        frame.delay = 8;
        encoder.write_frame(&frame)?;
    }
    Ok(())
}
