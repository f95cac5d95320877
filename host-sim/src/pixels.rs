//! Pictures of others as pixels.

use std::io::Cursor;

use image::error::{DecodingError, ImageFormatHint};
use image::io::{Limits, Reader};
use image::{DynamicImage, ImageError, ImageFormat, ImageResult};

/// Decodes a picture.
///
/// # Errors
/// It is none, is damaged, or is larger than the limits.
pub(crate) fn decode(
    bytes: &[u8],
    format: ImageFormat,
    limits: Limits,
) -> ImageResult<DynamicImage> {
    if format == ImageFormat::Png && !has_whole_colors(bytes) {
        let hint = ImageFormatHint::Exact(format);
        let words = "its palette ends within a colour";
        return Err(ImageError::Decoding(DecodingError::new(hint, words)));
    }
    let mut reader = Reader::with_format(Cursor::new(bytes), format);
    reader.limits(limits);
    reader.decode()
}

/// Whether the palette of a PNG, if it has one, is made of three bytes a colour: the
/// decoder takes that for granted.
fn has_whole_colors(bytes: &[u8]) -> bool {
    // Chunks of a length, a name, content and a check sum, behind the signature.
    let mut rest = bytes.get(8..).unwrap_or(&[]);
    while let Some((length, behind)) = rest.split_first_chunk() {
        let length = u32::from_be_bytes(*length) as usize;
        match behind.first_chunk() {
            Some(b"PLTE") => return length.is_multiple_of(3),
            Some(b"IDAT") | None => return true,
            Some(_) => rest = behind.get(length.saturating_add(8)..).unwrap_or(&[]),
        }
    }
    true
}
