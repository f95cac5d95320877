//! Pictures of a run, all from its trace.

mod animation;
#[cfg(not(target_arch = "wasm32"))]
mod coverage;
mod oblique;
mod top;

pub use animation::{animate, animation};
#[cfg(not(target_arch = "wasm32"))]
pub use coverage::coverage_plot;
pub use oblique::oblique_view;
pub(super) use oblique::{Block, oblique};
pub use top::top_view;

use std::io;

use image::codecs::png::PngEncoder;
use image::{ImageEncoder, Rgb, RgbImage};

use crate::draw::DrawError;

/// Colours of the robots, in turn; distinguishable for most colour-blind readers.
// [Okabe2008]
pub(super) const ROBOT_COLOURS: [Rgb<u8>; 8] = [
    Rgb([230, 159, 0]),
    Rgb([86, 180, 233]),
    Rgb([0, 158, 115]),
    Rgb([240, 228, 66]),
    Rgb([0, 114, 178]),
    Rgb([213, 94, 0]),
    Rgb([204, 121, 167]),
    Rgb([120, 120, 120]),
];

/// Writes `picture` as PNG.
///
/// # Errors
/// Those of `to`.
pub fn write_png(picture: &RgbImage, to: impl io::Write) -> Result<(), DrawError> {
    let (width, height) = picture.dimensions();
    let colour = image::ColorType::Rgb8;
    Ok(PngEncoder::new(to).write_image(picture.as_raw(), width, height, colour)?)
}

/// Colour of ground at height `ground` where the highest is `highest`.
pub(super) fn shade(ground: f32, highest: f32) -> Rgb<u8> {
    let share = ground / highest.max(1.0);
    Rgb([70.0, 78.0, 84.0].map(|dark| (dark + share * 165.0) as u8))
}
