//! Terrains out of files: grey images, OctoMap trees, GeoTIFFs and ASCII grids, told apart by
//! their content.

use std::io::{self, Cursor};
use std::path::Path;

use image::io::{Limits, Reader as ImageReader};
use image::{ColorType, ImageFormat};
use planner_core::surface::Height;
use planner_core::{Cell, Extent};
use thiserror::Error;

use super::foreign::foreign;
use super::geotiff::{from_tiff, is_tiff};
use super::grid::{from_grid, is_grid};
use super::relief::from_metres;
use super::{Scale, Terrain, TerrainOptions};
use crate::bytes::{self, Unread};
use crate::options::OptionError;
use crate::pixels;
use crate::scene::octree::{Cube, OcTree};

/// Columns along the longest side of a map.
pub(crate) const LARGEST: u32 = 512;

/// Most bytes of a file that is read.
const MOST_BYTES: u64 = 64 << 20;

/// Highest relief in whole cells that [`Height`] can tell.
pub(super) const HIGHEST: u32 = 63;

/// A terrain that cannot be had from a file, said so that the reader can mend it.
#[derive(Debug, Error)]
#[allow(missing_docs)] // each variant's message is its documentation
pub enum TerrainError {
    #[error("no such file; expected {READ}; or gaussian:SEED, urban:SEED or town:SEED")]
    Missing,
    #[error("cannot be read: {0}; check that it is a file that you may read")]
    Unreadable(#[from] io::Error),
    #[error("is no file but a folder or a device; expected {READ}")]
    NoFile,
    #[error("has more than {} MiB; expected {READ} of at most {LARGEST}×{LARGEST} columns", MOST_BYTES >> 20)]
    TooLong,
    #[error("is empty; expected {READ}")]
    Empty,
    #[error("is {name}; expected {READ}: {advice}")]
    Foreign {
        name: &'static str,
        advice: &'static str,
    },
    #[error("is of no format that is known here; expected {READ}")]
    Unknown,
    #[error("is not a complete image ({0}); expected {READ}: copy it again or export it again")]
    BrokenImage(image::ImageError),
    #[error(
        "is not a complete OctoMap tree: {0}; expected {READ}: copy it again or export it again"
    )]
    BrokenTree(io::Error),
    #[error(
        "{width}×{height} columns; expected 1 to {LARGEST} on a side: scale it down, or cut a \
         part out"
    )]
    Size { width: u32, height: u32 },
    #[error(
        "the pixel in column {x}, row {y} is {what}; expected shades of grey from 0 to 255, \
         which are heights in quarters of a cell, or of 16 bits with --metres-per-level, in every \
         pixel: `magick IN -alpha off -colorspace gray -depth 8 OUT.png`"
    )]
    Pixel { x: u32, y: u32, what: &'static str },
    #[error("is a TIFF: {0}")]
    Tiff(String),
    #[error("does not say how wide its cells are; give --metres-per-cell M")]
    NoCell,
    #[error(transparent)]
    Option(#[from] OptionError),
    #[error("line {line} of the ASCII grid: expected {expected}")]
    Grid { line: usize, expected: String },
    #[error(
        "the highest place lies {relief:.1} cells over the lowest; expected at most {HIGHEST}: \
         take wider cells, for example with `gdalwarp -tr`"
    )]
    Relief { relief: f64 },
    #[error("no voxel is occupied; expected ground to fly over")]
    NoGround,
    #[error(
        "the highest voxel lies {found} voxels over the lowest; expected at most {HIGHEST}: \
         give a tree of a coarser resolution, or survey it voxel by voxel with --scene"
    )]
    TooHigh { found: u32 },
}

/// What is read.
const READ: &str = "a grey PNG or PGM, whose shades are heights in quarters of a cell, an \
                    OctoMap .bt or .ot tree, or a GeoTIFF or an ESRI ASCII grid of metres";

impl From<Unread> for TerrainError {
    fn from(unread: Unread) -> Self {
        match unread {
            Unread::Missing => Self::Missing,
            Unread::NoFile => Self::NoFile,
            Unread::TooLong => Self::TooLong,
            Unread::Io(error) => Self::Unreadable(error),
        }
    }
}

impl Terrain {
    /// Reads a terrain from a file, called like the file.
    ///
    /// # Errors
    /// [`TerrainError`] says what is wrong and what to do.
    pub fn read(path: &Path, options: &TerrainOptions) -> Result<Self, TerrainError> {
        let bytes = bytes::read(path, MOST_BYTES)?;
        let ending = path.extension().unwrap_or_default().to_string_lossy();
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        Ok(Self::from_bytes_with(&bytes, &ending, options)?.named(name))
    }

    /// A terrain out of what a file holds; the `ending` of its name, without the dot,
    /// tells what it is if its content does not.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn from_bytes(bytes: &[u8], ending: &str) -> Result<Self, TerrainError> {
        Self::from_bytes_with(bytes, ending, &TerrainOptions::default())
    }

    /// The same with what is said of its metres.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn from_bytes_with(
        bytes: &[u8],
        ending: &str,
        options: &TerrainOptions,
    ) -> Result<Self, TerrainError> {
        if bytes.is_empty() {
            return Err(TerrainError::Empty);
        }
        if OcTree::is_tree(bytes) {
            options.check_none("an OctoMap tree, which has metres")?;
            return from_tree(&OcTree::read(bytes).map_err(TerrainError::BrokenTree)?);
        }
        if is_grid(bytes) {
            options.check_none("an ASCII grid, which has metres")?;
            return from_grid(bytes);
        }
        if is_tiff(bytes) {
            return from_tiff(bytes, options);
        }
        match image::guess_format(bytes) {
            Ok(format @ (ImageFormat::Png | ImageFormat::Pnm)) => {
                from_image(bytes, format, options)
            }
            _ => Err(match foreign(bytes, ending) {
                Some(it) => TerrainError::Foreign {
                    name: it.name,
                    advice: it.advice,
                },
                None => TerrainError::Unknown,
            }),
        }
    }
}

fn from_image(
    bytes: &[u8],
    format: ImageFormat,
    options: &TerrainOptions,
) -> Result<Terrain, TerrainError> {
    let size = ImageReader::with_format(Cursor::new(bytes), format).into_dimensions();
    // Before a picture is decoded that is a few bytes of file and gigabytes of pixels.
    let extent = fitting(size.map_err(TerrainError::BrokenImage)?)?;
    let mut limits = Limits::default();
    limits.max_image_width = Some(LARGEST);
    limits.max_image_height = Some(LARGEST);
    let image = pixels::decode(bytes, format, limits).map_err(TerrainError::BrokenImage)?;
    use ColorType::{L16, La16, Rgb16, Rgba16};
    let is_deep = matches!(image.color(), L16 | La16 | Rgb16 | Rgba16);
    let image = image.into_rgba16();
    for (x, y, pixel) in image.enumerate_pixels() {
        let [red, green, blue, alpha] = pixel.0;
        let what = match () {
            () if alpha != u16::MAX => "transparent",
            () if red != green || green != blue => "coloured",
            // Of 16 bits, those are left that are 8 bits too.
            () if red % 257 != 0 && options.metres_per_level.is_none() => {
                "a shade between two of these"
            }
            () => continue,
        };
        return Err(TerrainError::Pixel { x, y, what });
    }
    let shade = |cell: Cell| image.get_pixel(cell.x as u32, cell.y as u32).0[0];
    let Some(level) = options.metres_per_level else {
        let terrain = Terrain::from_fn(extent, |cell| Height((shade(cell) / 257) as u8));
        return Ok(terrain.scaled(options.metres_per_cell.map(Scale::picture)));
    };
    let cell = options.metres_per_cell.ok_or(TerrainError::NoCell)?;
    // Of 8 bits, each shade has become 257 of 16.
    let level = if is_deep { level } else { level / 257.0 };
    let metres: Vec<f64> = image
        .pixels()
        .map(|pixel| f64::from(pixel.0[0]) * level)
        .collect();
    from_metres(extent, &metres, cell)
}

/// The highest occupied voxel of each column, over the lowest of all.
fn from_tree(tree: &OcTree) -> Result<Terrain, TerrainError> {
    let cubes = tree.cubes().into_iter();
    let cubes: Vec<Cube> = cubes.filter(|cube| cube.occupied).collect();
    let low = |axis: usize| cubes.iter().map(|cube| cube.corner[axis]).min();
    let high = |axis: usize| cubes.iter().map(|cube| cube.corner[axis] + cube.side).max();
    let (Some(west), Some(east)) = (low(0), high(0)) else {
        return Err(TerrainError::NoGround);
    };
    let (Some(north), Some(south)) = (low(1), high(1)) else {
        return Err(TerrainError::NoGround);
    };
    let (Some(floor), Some(top)) = (low(2), high(2)) else {
        return Err(TerrainError::NoGround);
    };
    let extent = fitting((west.abs_diff(east), north.abs_diff(south)))?;
    let found = floor.abs_diff(top);
    if found > HIGHEST {
        return Err(TerrainError::TooHigh { found });
    }
    let mut heights = vec![Height(0); extent.cells() as usize];
    for cube in cubes {
        let top = Height::from_cells((cube.corner[2] + cube.side - floor) as f32);
        for y in cube.corner[1]..cube.corner[1] + cube.side {
            for x in cube.corner[0]..cube.corner[0] + cube.side {
                let index = (y - north) as usize * usize::from(extent.width) + (x - west) as usize;
                heights[index] = heights[index].max(top);
            }
        }
    }
    let terrain = Terrain::from_fn(extent, |cell| {
        heights[cell.y as usize * usize::from(extent.width) + cell.x as usize]
    });
    let cell = tree.resolution();
    Ok(terrain.scaled(Some(Scale {
        cell,
        corner: [west, north, floor].map(|at| f64::from(at) * cell),
        northward: true,
    })))
}

pub(super) fn fitting((width, height): (u32, u32)) -> Result<Extent, TerrainError> {
    let sides = 1..=LARGEST;
    match sides.contains(&width) && sides.contains(&height) {
        true => Ok(Extent::new(width as u16, height as u16)),
        false => Err(TerrainError::Size { width, height }),
    }
}

#[cfg(test)]
mod tests {
    use image::{GrayImage, ImageBuffer, Luma, LumaA, Rgb};

    use super::*;

    fn error(bytes: &[u8], ending: &str) -> String {
        let error = Terrain::from_bytes(bytes, ending).unwrap_err();
        error.to_string()
    }

    fn png<P>(image: ImageBuffer<P, Vec<P::Subpixel>>) -> Vec<u8>
    where
        P: image::PixelWithColorType,
        [P::Subpixel]: image::EncodableLayout,
    {
        let mut bytes = Cursor::new(Vec::new());
        image.write_to(&mut bytes, ImageFormat::Png).unwrap();
        bytes.into_inner()
    }

    #[test]
    fn greys_are_heights_in_any_depth_that_tells_the_same() {
        let shade = |x: u32, y: u32| (x * 40 + y) as u8;
        let grey = GrayImage::from_fn(5, 3, |x, y| Luma([shade(x, y)]));
        let deep = ImageBuffer::from_fn(5, 3, |x, y| Luma([u16::from(shade(x, y)) * 257]));
        let rgb = ImageBuffer::from_fn(5, 3, |x, y| Rgb([shade(x, y); 3]));
        let mut pgm = b"P5 5 3 255\n".to_vec();
        pgm.extend(grey.as_raw());
        for bytes in [png(grey), png(deep), png(rgb), pgm] {
            let terrain = Terrain::from_bytes(&bytes, "").unwrap();
            assert_eq!(terrain.extent(), Extent::new(5, 3));
            assert_eq!(terrain.height(Cell::new(2, 1)), Some(Height(81)));
        }
    }

    #[test]
    fn pixels_without_one_height_are_named() {
        let colour = ImageBuffer::from_fn(4, 4, |x, y| Rgb([7, 7, 7 + (x * y / 6) as u8]));
        assert!(error(&png(colour), "png").contains("column 3, row 2 is coloured"));
        let clear = ImageBuffer::from_fn(4, 4, |x, _| LumaA([9u8, if x == 3 { 0 } else { 255 }]));
        assert!(error(&png(clear), "png").contains("column 3, row 0 is transparent"));
        let fine = ImageBuffer::from_fn(4, 4, |x, y| Luma([(x + y) as u16 * 257 + 1]));
        assert!(error(&png(fine), "png").contains("column 0, row 0 is a shade between"));
    }

    /// Of 8 and of 16 bits; the lowest is 0.
    #[test]
    fn levels_are_metres_where_they_are_said() {
        let said = TerrainOptions {
            metres_per_cell: Some(2.0),
            metres_per_level: Some(0.5),
        };
        let grey = GrayImage::from_fn(3, 1, |x, _| Luma([10 + 2 * x as u8]));
        let deep = ImageBuffer::from_fn(3, 1, |x, _| Luma([1010 + 2 * x as u16]));
        for bytes in [png(grey.clone()), png(deep)] {
            let terrain = Terrain::from_bytes_with(&bytes, "", &said).unwrap();
            let heights: Vec<_> = terrain.cells().map(|at| terrain.height(at)).collect();
            assert_eq!(heights, [0, 2, 4].map(|quarters| Some(Height(quarters))));
            assert_eq!(terrain.scale(), Some(Scale::picture(2.0)));
        }
        let cell = TerrainOptions {
            metres_per_level: None,
            ..said
        };
        let terrain = Terrain::from_bytes_with(&png(grey.clone()), "", &cell).unwrap();
        assert_eq!(terrain.height(Cell::new(0, 0)), Some(Height(10)));
        assert_eq!(terrain.scale(), Some(Scale::picture(2.0)));
        let level = TerrainOptions {
            metres_per_cell: None,
            ..said
        };
        let error = |bytes: &[u8]| {
            let read = Terrain::from_bytes_with(bytes, "", &level);
            read.unwrap_err().to_string()
        };
        assert!(error(&png(grey)).contains("give --metres-per-cell"));
        let grid = b"ncols 1\nnrows 1\ncellsize 1\n5\n";
        assert!(error(grid).contains("--metres-per-level does not apply to an ASCII grid"));
        let mut tree = Vec::new();
        OcTree::new(1.0).write(&mut tree).unwrap();
        assert!(error(&tree).contains("does not apply to an OctoMap tree"));
    }

    #[test]
    fn pictures_too_large_are_refused_by_their_header() {
        // 20,000×20,000 pixels without their data.
        let mut large = png(GrayImage::new(513, 2));
        assert!(error(&large, "png").contains("513×2 columns; expected 1 to 512"));
        large[16..24].copy_from_slice(&[0, 0, 0x4e, 0x20, 0, 0, 0x4e, 0x20]);
        let mut crc = crc32(&large[12..29]).to_be_bytes().to_vec();
        large.truncate(29);
        large.append(&mut crc);
        assert!(!error(&large, "png").is_empty());
        let pgm = b"P5 60000 60000 255\n";
        assert!(error(pgm, "pgm").contains("60000×60000"));
    }

    /// As PNG has it.
    fn crc32(bytes: &[u8]) -> u32 {
        !bytes.iter().fold(!0, |crc, byte| {
            (0..8).fold(crc ^ u32::from(*byte), |crc: u32, _| {
                (crc >> 1) ^ if crc & 1 == 1 { 0xedb8_8320 } else { 0 }
            })
        })
    }

    #[test]
    fn other_formats_are_named_with_a_way_to_what_is_read() {
        for (bytes, ending, words) in [
            (
                &b"# .PCD v0.7 - Point Cloud Data"[..],
                "pcd",
                ["PCD", "--scene"],
            ),
            (b"ply\nformat ascii 1.0", "ply", ["PLY", "--scene"]),
            (b"solid cube", "stl", ["STL", "--scene"]),
            (b"\0\0\0\0", "stl", ["STL", "--scene"]),
            (b"v 0 0 0", "obj", ["OBJ", "binvox2bt"]),
            (b"BM\x01", "png", ["a BMP", "magick"]),
            (b"\xff\xd8\xff\xe0", "png", ["a JPEG", "magick"]),
            (b"image: a.pgm", "yaml", ["a flat map", "host-sim explore"]),
            (b"\x1f\x8b\x08", "gz", ["compressed", "unpack"]),
            (b"?", "xyzzy", ["no format that is known", "grey PNG"]),
            (b"", "png", ["is empty", "grey PNG"]),
        ] {
            let error = error(bytes, ending);
            for word in words.into_iter().chain([".bt"]) {
                assert!(error.contains(word), "{word:?} is not in {error}");
            }
        }
    }

    #[test]
    fn a_tree_is_ground_if_it_is_neither_too_wide_nor_too_high() {
        let read = |voxels: &[[i32; 3]]| {
            let mut tree = OcTree::new(0.5);
            for &voxel in voxels {
                tree.insert(voxel, true);
            }
            let mut bytes = Vec::new();
            tree.write(&mut bytes).unwrap();
            Terrain::from_bytes(&bytes, "bt").map_err(|error| error.to_string())
        };
        let terrain = read(&[[0, 0, 0], [3, 1, 4]]).unwrap();
        assert_eq!(terrain.extent(), Extent::new(4, 2));
        assert_eq!(terrain.height(Cell::new(3, 1)), Some(Height(20)));
        assert_eq!(terrain.scale().map(|scale| scale.cell), Some(0.5));
        assert!(read(&[[0, 0, 0], [0, 0, 62]]).is_ok());
        assert!(
            read(&[[0, 0, 0], [0, 0, 63]])
                .unwrap_err()
                .contains("64 voxels")
        );
        assert!(
            read(&[[0, 0, 0], [512, 0, 0]])
                .unwrap_err()
                .contains("513×1")
        );
        assert!(read(&[]).unwrap_err().contains("no voxel is occupied"));
    }
}
