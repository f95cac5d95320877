//! From a file to a world.

use std::fs;
use std::path::Path;

use super::error::{Problem, WorldError};
use super::{World, movingai, raster, ros, text};

/// What a cell is, in the pixels of an image or in metres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Scale {
    /// One pixel is one cell.
    #[default]
    Pixel,
    /// N×N pixels are one cell. Text and MovingAI maps, which have cells
    /// already, stay as they are and get a note.
    Pixels(u32),
    /// Side of a cell in metres; for maps that have a resolution. Rounded to
    /// whole pixels, with a note if that changes anything.
    Metres(f64),
}

/// How a file becomes cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReadOptions {
    /// Size of a cell.
    pub scale: Scale,
    /// In PNG and PGM files, pixels darker than this (0 black, 255 white) are
    /// obstacles. map_server YAML files bring thresholds of their own.
    pub dark_below: u8,
}

impl Default for ReadOptions {
    fn default() -> Self {
        Self {
            scale: Scale::default(),
            dark_below: 128,
        }
    }
}

const ENDINGS: &str = ".png, .pgm, .yaml, .yml, .map or .txt";

impl World {
    /// Reads a map; the format follows from the ending: `.png`, `.pgm`,
    /// `.yaml`/`.yml` (ROS map_server), `.map` (MovingAI), `.txt` (plain, or
    /// MovingAI if it begins with `type `).
    ///
    /// Images are cut into N×N blocks from the top left. A block is an
    /// obstacle if any of its pixels is one, so that a wall of one pixel never
    /// vanishes, or if at least half of it is unknown; what lies beyond the
    /// right and bottom edge of the image is unknown.
    ///
    /// # Errors
    /// [`WorldError`] names the file, the line or key, what was expected and
    /// what to do.
    pub fn read(path: impl AsRef<Path>, options: &ReadOptions) -> Result<Self, WorldError> {
        Self::read_with(path, options, read_bytes)
    }

    /// As [`read`](Self::read), with files that are elsewhere: `open` gives the bytes
    /// of the map, and of the image that a map_server YAML file names.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn read_with(
        path: impl AsRef<Path>,
        options: &ReadOptions,
        open: impl Fn(&Path) -> Result<Vec<u8>, Problem>,
    ) -> Result<Self, WorldError> {
        let path = path.as_ref();
        read(path, options, &open).map_err(|problem| problem.of(path.display().to_string()))
    }
}

fn read(
    path: &Path,
    options: &ReadOptions,
    open: &dyn Fn(&Path) -> Result<Vec<u8>, Problem>,
) -> Result<World, Problem> {
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let text = |expected| String::from_utf8(open(path)?).map_err(|_| Problem::NotText { expected });
    match ending(path).as_str() {
        "png" | "pgm" => {
            let pixels = match options.scale {
                Scale::Pixel => 1,
                Scale::Pixels(pixels) => pixels,
                Scale::Metres(metres) => return Err(Problem::NoResolution { metres }),
            };
            raster::Image::decode(&open(path)?)
                .and_then(|image| image.cut(pixels, |gray| raster::dark(gray, options.dark_below)))
                .and_then(|grid| World::from_grid(&name, grid))
        }
        "yaml" | "yml" => {
            let yaml = text("a map_server YAML file")?;
            ros::read(&name, path, &yaml, options.scale, open)
        }
        "map" => {
            let map = text("a MovingAI map")?;
            with_own_cells(movingai::parse(&name, &map), options.scale)
        }
        "txt" => {
            let map = text("a text map")?;
            let world = if map.starts_with("type ") {
                movingai::parse(&name, &map)
            } else {
                text::parse(&name, &map)
            };
            with_own_cells(world, options.scale)
        }
        _ => Err(unknown_ending(path, ENDINGS)),
    }
}

/// The world of a format that has cells of its own, which no scale changes.
fn with_own_cells(world: Result<World, Problem>, scale: Scale) -> Result<World, Problem> {
    let mut world = world?;
    match scale {
        Scale::Pixels(pixels) if pixels != 1 => {
            let note =
                "--pixels-per-cell is for images; the cells of this map are used as they are";
            world.notes.push(note.into());
        }
        Scale::Metres(metres) => return Err(Problem::NoResolution { metres }),
        Scale::Pixel | Scale::Pixels(_) => {}
    }
    Ok(world)
}

/// The ending of a path in lower case, without its dot.
pub(super) fn ending(path: &Path) -> String {
    let ending = path.extension().unwrap_or_default();
    ending.to_string_lossy().to_lowercase()
}

pub(super) fn unknown_ending(path: &Path, expected: &'static str) -> Problem {
    Problem::UnknownEnding {
        found: ending(path),
        expected,
    }
}

fn read_bytes(path: &Path) -> Result<Vec<u8>, Problem> {
    fs::read(path).map_err(Problem::from_read)
}
