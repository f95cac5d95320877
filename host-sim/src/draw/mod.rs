//! Pictures of a run, all from its trace: the final picture, the animation, the
//! coverage curve. In the browser, where there is no font for them, only the animation.

mod animation;
#[cfg(not(target_arch = "wasm32"))]
pub mod chart;
#[cfg(not(target_arch = "wasm32"))]
mod coverage;
mod paint;
#[cfg(not(target_arch = "wasm32"))]
mod picture;
mod replay;

use std::io;

#[cfg(not(target_arch = "wasm32"))]
use image::{ColorType, ImageEncoder, codecs::png::PngEncoder};
use thiserror::Error;

pub use animation::animation;
#[cfg(not(target_arch = "wasm32"))]
pub use coverage::{coverage_csv, coverage_plot};
#[cfg(not(target_arch = "wasm32"))]
pub use picture::picture;
pub use replay::Replay;

/// A picture that cannot be made.
#[derive(Debug, Error)]
pub enum DrawError {
    /// See the message.
    #[error("cannot be written: {0}")]
    Io(#[from] io::Error),
    /// See the message.
    #[error("cannot be encoded as PNG: {0}")]
    Png(#[from] image::ImageError),
    /// See the message.
    #[error("cannot be encoded as GIF: {0}")]
    Gif(#[from] gif::EncodingError),
    /// See the message.
    #[error("cannot be drawn: {0}")]
    Plot(String),
}

impl<E: std::error::Error + Send + Sync> From<plotters::drawing::DrawingAreaErrorKind<E>>
    for DrawError
{
    fn from(error: plotters::drawing::DrawingAreaErrorKind<E>) -> Self {
        Self::Plot(error.to_string())
    }
}

/// Pixels, three bytes each, row by row.
#[cfg(not(target_arch = "wasm32"))]
struct Canvas {
    width: u32,
    height: u32,
    pixels: Vec<u8>,
}

#[cfg(not(target_arch = "wasm32"))]
impl Canvas {
    fn new(width: u32, height: u32) -> Self {
        Self {
            width,
            height,
            pixels: vec![255; (width * height * 3) as usize],
        }
    }

    fn write_png(&self, to: impl io::Write) -> Result<(), DrawError> {
        let color = ColorType::Rgb8;
        Ok(PngEncoder::new(to).write_image(&self.pixels, self.width, self.height, color)?)
    }
}
