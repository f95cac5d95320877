//! A run as an animated GIF.

use std::io::Write;

use gif::{Encoder, Frame, Repeat};

use super::top_view;
use crate::survey::{Terrain, Trace};

/// Frames at most; a longer run is shown in larger strides.
const MOST_FRAMES: u32 = 120;

/// Writes the view from above over time.
pub fn animation(terrain: &Terrain, trace: &Trace, to: impl Write) -> Result<(), String> {
    let steps = trace.seen.len() as u32;
    let stride = steps.div_ceil(MOST_FRAMES).max(1);
    let mut to = Some(to);
    let mut encoder = None;
    for step in (0..steps).step_by(stride as usize) {
        let picture = top_view(terrain, trace, step);
        let size = (picture.width() as u16, picture.height() as u16);
        if let Some(to) = to.take() {
            let mut new = Encoder::new(to, size.0, size.1, &[]).map_err(|e| e.to_string())?;
            new.set_repeat(Repeat::Infinite)
                .map_err(|e| e.to_string())?;
            encoder = Some(new);
        }
        let mut frame = Frame::from_rgb_speed(size.0, size.1, picture.as_raw(), 20);
        frame.delay = 8;
        if let Some(encoder) = &mut encoder {
            encoder.write_frame(&frame).map_err(|e| e.to_string())?;
        }
    }
    Ok(())
}
