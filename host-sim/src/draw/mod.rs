//! Pictures of a run, all from its trace: the final picture, the animation, the
//! coverage curve.

mod animation;
pub mod chart;
mod coverage;
mod paint;
mod picture;
mod replay;

use std::io;

use image::{ExtendedColorType, ImageEncoder, codecs::png::PngEncoder};
use thiserror::Error;

pub use animation::animation;
pub use coverage::{coverage_csv, coverage_plot};
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
struct Canvas {
    width: u32,
    height: u32,
    pixels: Vec<u8>,
}

impl Canvas {
    fn new(width: u32, height: u32) -> Self {
        Self {
            width,
            height,
            pixels: vec![255; (width * height * 3) as usize],
        }
    }

    fn write_png(&self, to: impl io::Write) -> Result<(), DrawError> {
        let color = ExtendedColorType::Rgb8;
        Ok(PngEncoder::new(to).write_image(&self.pixels, self.width, self.height, color)?)
    }
}
