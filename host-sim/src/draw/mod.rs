//! Pictures of a run, all from its trace: the final picture, views from above and aslant,
//! the animation, the coverage curve. In the browser, where there is no font, those
//! without words.

mod animation;
#[cfg(not(target_arch = "wasm32"))]
pub mod chart;
mod compass;
#[cfg(not(target_arch = "wasm32"))]
mod coverage;
#[cfg(not(target_arch = "wasm32"))]
mod legend;
mod oblique;
mod paint;
#[cfg(not(target_arch = "wasm32"))]
mod picture;
#[cfg(not(target_arch = "wasm32"))]
mod plan;
#[cfg(all(feature = "mcap", not(target_arch = "wasm32")))]
mod recording;
mod replay;
#[cfg(not(target_arch = "wasm32"))]
mod scans;
#[cfg(not(target_arch = "wasm32"))]
mod sheet;
mod top;

use std::io;

use image::codecs::png::PngEncoder;
use image::{ColorType, ImageEncoder, RgbImage};
use thiserror::Error;

pub use animation::{animate, animation};
#[cfg(not(target_arch = "wasm32"))]
pub use coverage::Coverage;
pub use oblique::{oblique_view, oblique_voxels, usual_cut};
#[cfg(not(target_arch = "wasm32"))]
pub use picture::picture;
#[cfg(all(feature = "mcap", not(target_arch = "wasm32")))]
pub use recording::recording;
pub use replay::Replay;
#[cfg(not(target_arch = "wasm32"))]
pub use scans::scans;
#[cfg(not(target_arch = "wasm32"))]
pub use sheet::{oblique_sheet, oblique_voxels_sheet, plan_sheet, top_sheet};
pub use top::top_view;

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

/// Writes `picture` as PNG.
///
/// # Errors
/// Those of `to`.
pub fn write_png(picture: &RgbImage, to: impl io::Write) -> Result<(), DrawError> {
    let (width, height) = picture.dimensions();
    let color = ColorType::Rgb8;
    Ok(PngEncoder::new(to).write_image(picture, width, height, color)?)
}
