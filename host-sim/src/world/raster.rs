//! Images as maps.

use std::io::Cursor;

use image::codecs::png::PngEncoder;
use image::codecs::pnm::{PnmEncoder, PnmSubtype, SampleEncoding};
use image::io::{Limits, Reader as ImageReader};
use image::{GenericImageView, GrayImage, ImageEncoder, ImageError, Luma, Rgba};
use planner_core::Cell;

use super::World;
use super::error::Problem;
use super::foreign::Foreign;
use super::grid::{self, Grid, LARGEST};
use crate::excerpt::excerpt;
use crate::pixels;

const FREE: u8 = 255;
const OBSTACLE: u8 = 0;
/// Most pixels along a side of an image that is written.
const LONGEST_SIDE: u32 = 1 << 14;

/// Largest picture that is decoded, in bytes: one of [`LONGEST_SIDE`] in gray, and more.
const MOST_BYTES: u64 = 1 << 29;
/// map_saver's gray for what no ray has met.
const UNKNOWN: f64 = 205.0;

/// One pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pixel {
    /// Mean of red, green and blue, 0 (dark) to 255 (light), as in map_server.
    pub(super) mean: f64,
    /// 0 (nothing is there) to 255; `None` in a picture without transparency.
    pub(super) alpha: Option<u8>,
}

impl Pixel {
    /// Whether anything shines through.
    pub(super) fn is_transparent(&self) -> bool {
        self.alpha.is_some_and(|alpha| alpha < 255)
    }
}

/// What one pixel says about the ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ground {
    Free,
    /// Free, but not for certain.
    Costly,
    Obstacle,
    Unknown,
}

/// The reading of plain images: what is darker than `threshold` is an obstacle, white
/// shining through; else what is transparent, or has map_saver's gray, is unknown.
pub(super) fn plain(pixel: Pixel, threshold: u8) -> Ground {
    let alpha = f64::from(pixel.alpha.unwrap_or(255));
    if pixel.mean * alpha + 255.0 * (255.0 - alpha) < 255.0 * f64::from(threshold) {
        Ground::Obstacle
    } else if pixel.is_transparent() || pixel.mean == UNKNOWN {
        Ground::Unknown
    } else {
        Ground::Free
    }
}

/// How many pixels are what, of those that the reader should hear about.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Tally {
    pub(super) pixels: u64,
    /// Unknown, transparent ones included.
    pub(super) unknown: u64,
    /// Unknown and transparent.
    pub(super) transparent: u64,
    /// [`Ground::Costly`].
    pub(super) costly: u64,
}

impl Tally {
    fn add(&mut self, ground: Ground, pixel: Pixel) {
        self.pixels += 1;
        match ground {
            Ground::Unknown => {
                self.unknown += 1;
                self.transparent += u64::from(pixel.is_transparent());
            }
            Ground::Costly => self.costly += 1,
            Ground::Free | Ground::Obstacle => {}
        }
    }

    /// "12 of 100 pixels are unknown", and why.
    pub(super) fn unknown_in_words(&self, why: &str) -> String {
        let Self {
            pixels,
            unknown,
            transparent,
            ..
        } = self;
        let because = match (*transparent, unknown - transparent) {
            (0, _) => why.into(),
            (_, 0) => "transparent".into(),
            (transparent, rest) => format!("{transparent} transparent, {rest} {why}"),
        };
        format!("{unknown} of {pixels} pixels are unknown ({because})")
    }
}

/// A picture cut into cells.
pub(super) struct Cut {
    pub(super) grid: Grid,
    pub(super) tally: Tally,
    /// Rows of pixels that the lowest cells lack.
    pub(super) lacking: u32,
}

/// Decodes PNG or PGM, told apart by their first bytes, and cuts the picture into cells
/// of `side`×`side` pixels, by the rule of [`World::read`]. Whether it fits is seen from
/// its header, before a pixel is decoded.
pub(super) fn cut(
    bytes: &[u8],
    side: u32,
    ground: impl Fn(Pixel) -> Ground,
) -> Result<Cut, Problem> {
    if side == 0 {
        return Err(Problem::NoPixelsPerCell);
    }
    if let Some(foreign) = Foreign::of_bytes(bytes) {
        return Err(foreign.into());
    }
    let broken = |error: ImageError| match error {
        ImageError::Limits(_) => Problem::TooManyPixels,
        error => Problem::BrokenImage(excerpt(&error.to_string())),
    };
    if bytes.is_empty() {
        return Err(Problem::BrokenImage("the file is empty".into()));
    }
    let format = image::guess_format(bytes).map_err(broken)?;
    let reader = ImageReader::with_format(Cursor::new(bytes), format);
    let (width, height) = reader.into_dimensions().map_err(broken)?;
    if width == 0 || height == 0 {
        return Err(Problem::Empty);
    }
    if u64::from(width) * u64::from(height) > MOST_BYTES {
        return Err(Problem::TooManyPixels);
    }
    let extent = grid::checked_extent(
        width.div_ceil(side) as usize,
        height.div_ceil(side) as usize,
        || {
            let enough = width
                .div_ceil(LARGEST.width.into())
                .max(height.div_ceil(LARGEST.height.into()));
            format!("use --pixels-per-cell {enough} or more")
        },
    )?;
    let mut limits = Limits::default();
    limits.max_alloc = Some(MOST_BYTES);
    let image = pixels::decode(bytes, format, limits).map_err(broken)?;

    let has_alpha = image.color().has_alpha();
    let mut tally = Tally::default();
    // Of each cell, whether it has an obstacle, and its free pixels.
    let mut cells = vec![(false, 0u64); extent.cells() as usize];
    for (x, y, Rgba([red, green, blue, alpha])) in image.pixels() {
        let sum = u32::from(red) + u32::from(green) + u32::from(blue);
        let pixel = Pixel {
            mean: f64::from(sum) / 3.0,
            alpha: has_alpha.then_some(alpha),
        };
        let ground = ground(pixel);
        tally.add(ground, pixel);
        let index = (y / side) as usize * usize::from(extent.width) + (x / side) as usize;
        let Some((blocked, free)) = cells.get_mut(index) else {
            continue;
        };
        match ground {
            Ground::Obstacle => *blocked = true,
            Ground::Free | Ground::Costly => *free += 1,
            Ground::Unknown => {}
        }
    }
    let whole = u64::from(side) * u64::from(side);
    let mut cells = cells
        .into_iter()
        .map(|(blocked, free)| blocked || 2 * free <= whole);
    let grid = Grid::from_fn(extent, |_| cells.next() != Some(false));
    let lacking = height.next_multiple_of(side) - height;
    Ok(Cut {
        grid,
        tally,
        lacking,
    })
}

impl Cut {
    /// The world, if it has a free cell.
    pub(super) fn world(self, name: &str, why_unknown: &str) -> Result<World, Problem> {
        let tally = self.tally;
        World::from_grid(name, self.grid).map_err(|problem| match problem {
            Problem::NoFreeCell if tally.unknown > 0 => {
                Problem::NothingKnown(tally.unknown_in_words(why_unknown))
            }
            problem => problem,
        })
    }
}

/// The world as a PNG image, as [`draw`] draws it.
pub(super) fn png(world: &World, side: u32) -> Result<Vec<u8>, Problem> {
    let mut bytes = Vec::new();
    write(&draw(world, side)?, PngEncoder::new(&mut bytes));
    Ok(bytes)
}

/// The world as a binary PGM image, as [`draw`] draws it.
pub(super) fn pgm(world: &World, side: u32) -> Result<Vec<u8>, Problem> {
    Ok(pgm_of(&draw(world, side)?))
}

/// A picture as binary PGM.
pub(super) fn pgm_of(image: &GrayImage) -> Vec<u8> {
    let subtype = PnmSubtype::Graymap(SampleEncoding::Binary);
    let mut bytes = Vec::new();
    let encoder = PnmEncoder::new(&mut bytes).with_subtype(subtype);
    write(image, encoder);
    bytes
}

/// A square of `side` pixels for each cell: free cells white, obstacles black.
fn draw(world: &World, side: u32) -> Result<GrayImage, Problem> {
    let extent = world.extent();
    let longest = u32::from(extent.width.max(extent.height));
    match side {
        0 => return Err(Problem::NoPixelsPerCell),
        _ if side > LONGEST_SIDE / longest => {
            let most = LONGEST_SIDE / longest;
            return Err(Problem::TooManyPixelsPerCell { found: side, most });
        }
        _ => {}
    }
    let (width, height) = (u32::from(extent.width), u32::from(extent.height));
    Ok(GrayImage::from_fn(width * side, height * side, |x, y| {
        let cell = Cell::new((x / side) as i16, (y / side) as i16);
        Luma([if world.is_free(cell) { FREE } else { OBSTACLE }])
    }))
}

fn write(image: &GrayImage, to_memory: impl ImageEncoder) {
    image
        .write_with_encoder(to_memory)
        .expect("nothing fails in memory");
}
