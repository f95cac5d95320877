//! A run as an animated GIF.

use std::io::Write;

use gif::{Encoder, Frame, Repeat};

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
    let steps = trace.seen.len() as u32;
    let stride = steps.div_ceil(MOST_FRAMES).max(1);
    let mut to = Some(to);
    let mut encoder = None;
    for step in (0..steps).step_by(stride as usize) {
        let picture = top_view(trace, step);
        let size = (picture.width() as u16, picture.height() as u16);
        if let Some(to) = to.take() {
            let mut new = Encoder::new(to, size.0, size.1, &[])?;
            new.set_repeat(Repeat::Infinite)?;
            encoder = Some(new);
        }
        let mut frame = Frame::from_rgb_speed(size.0, size.1, picture.as_raw(), 20);
        frame.delay = 8;
        if let Some(encoder) = &mut encoder {
            encoder.write_frame(&frame)?;
        }
    }
    Ok(())
}
