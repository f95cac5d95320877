//! Images as maps.

use image::codecs::png::PngEncoder;
use image::codecs::pnm::{PnmEncoder, PnmSubtype, SampleEncoding};
use image::{GrayImage, ImageEncoder, Luma};
use planner_core::Cell;

use super::World;
use super::error::Problem;
use super::grid::{self, Grid, LARGEST};

const FREE: u8 = 255;
const OBSTACLE: u8 = 0;
/// Most pixels along a side of an image that is written.
const LONGEST_SIDE: u32 = 1 << 14;

/// What one pixel says about the ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ground {
    Free,
    Obstacle,
    Unknown,
}

/// The reading of plain images: what is darker than `threshold` is an obstacle.
pub(super) fn dark(gray: u8, threshold: u8) -> Ground {
    if gray < threshold {
        Ground::Obstacle
    } else {
        Ground::Free
    }
}

/// An image in shades of gray.
pub(super) struct Image(GrayImage);

impl Image {
    /// Decodes PNG or PGM, told apart by their first bytes. Colours become the
    /// mean of their channels, as in map_server; transparency lets white through.
    pub(super) fn decode(bytes: &[u8]) -> Result<Self, Problem> {
        let image = image::load_from_memory(bytes)
            .map_err(Problem::BrokenImage)?
            .into_rgba8();
        let gray = GrayImage::from_fn(image.width(), image.height(), |x, y| {
            let [red, green, blue, alpha] = image.get_pixel(x, y).0.map(u32::from);
            let mean = (red + green + blue) / 3;
            Luma([((mean * alpha + 255 * (255 - alpha)) / 255) as u8])
        });
        Ok(Self(gray))
    }

    /// Cuts the image into cells of `side`×`side` pixels, by the rule of
    /// [`World::read`].
    pub(super) fn cut(&self, side: u32, ground: impl Fn(u8) -> Ground) -> Result<Grid, Problem> {
        if side == 0 {
            return Err(Problem::NoPixelsPerCell);
        }
        let (width, height) = self.0.dimensions();
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
        Ok(Grid::from_fn(extent, |cell| {
            self.is_blocked(cell, side, &ground)
        }))
    }

    fn is_blocked(&self, cell: Cell, side: u32, ground: impl Fn(u8) -> Ground) -> bool {
        let (left, top) = (cell.x as u32 * side, cell.y as u32 * side);
        let mut free = 0;
        for y in top..self.0.height().min(top.saturating_add(side)) {
            for x in left..self.0.width().min(left.saturating_add(side)) {
                match ground(self.0.get_pixel(x, y).0[0]) {
                    Ground::Obstacle => return true,
                    Ground::Free => free += 1,
                    Ground::Unknown => {}
                }
            }
        }
        2 * free <= u64::from(side) * u64::from(side)
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
    let subtype = PnmSubtype::Graymap(SampleEncoding::Binary);
    let mut bytes = Vec::new();
    let encoder = PnmEncoder::new(&mut bytes).with_subtype(subtype);
    write(&draw(world, side)?, encoder);
    Ok(bytes)
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
