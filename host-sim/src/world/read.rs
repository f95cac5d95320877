//! From a file to a world.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::error::{Problem, WorldError};
use super::foreign::{self, Foreign};
use super::{World, movingai, raster, ros, text};
use crate::excerpt::excerpt;

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
    /// obstacles; of the others those that are transparent or of the gray 205, which
    /// map_saver writes for what no ray has met, are unknown. map_server YAML files
    /// bring thresholds of their own.
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
    /// MovingAI if it begins with a line of such a header).
    ///
    /// Images are cut into N×N blocks from the top left. A block is an
    /// obstacle if any of its pixels is one, so that a wall of one pixel never
    /// vanishes, or if at least half of it is unknown; what lies beyond the
    /// right and bottom edge of the image is unknown. So what is unknown is an
    /// obstacle in the world: nobody drives where no map vouches for the ground.
    /// [`notes`](Self::notes) say how much was unknown.
    ///
    /// A file is read up to half a GiB; what its header says of its size is looked at
    /// before its pixels are.
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
    let bytes = open(path)?;
    match ending(path).as_str() {
        "png" | "pgm" => {
            let pixels = match options.scale {
                Scale::Pixel => 1,
                Scale::Pixels(pixels) => pixels,
                Scale::Metres(metres) => return Err(Problem::NoResolution { metres }),
            };
            let cut = raster::cut(&bytes, pixels, |pixel| {
                raster::plain(pixel, options.dark_below)
            })?;
            let tally = cut.tally;
            let mut world = cut.world(&name, GRAY)?;
            world.notes.extend((tally.unknown > 0).then(|| {
                let unknown = tally.unknown_in_words(GRAY);
                format!(
                    "{unknown}: taken as obstacles; paint white what is free, or name the \
                     YAML file of the map"
                )
            }));
            Ok(world)
        }
        "yaml" | "yml" => {
            let yaml = text(bytes, "a map_server YAML file")?;
            ros::read(&name, path, &yaml, options.scale, open)
        }
        "map" => {
            let map = text(bytes, "a MovingAI map")?;
            with_own_cells(movingai::parse(&name, &map), options.scale)
        }
        "txt" => {
            let map = text(bytes, "a text map")?;
            let world = if movingai::begins(&map) {
                movingai::parse(&name, &map)
            } else {
                text::parse(&name, &map)
            };
            with_own_cells(world, options.scale)
        }
        _ => Err(unreadable_ending(path, &bytes)),
    }
}

/// Why pixels of plain images are unknown.
const GRAY: &str = "of the gray 205, map_saver's for unknown";

/// The bytes as text, without a byte-order mark.
fn text(bytes: Vec<u8>, expected: &'static str) -> Result<String, Problem> {
    if let Some(foreign) = Foreign::of_bytes(&bytes) {
        return Err(foreign.into());
    }
    if let Some(format) = foreign::picture(&bytes) {
        return Err(misnamed(format));
    }
    if let [0xff, 0xfe, ..] | [0xfe, 0xff, ..] = bytes[..] {
        return Err(Problem::Utf16 { expected });
    }
    let mut text = String::from_utf8(bytes).map_err(|_| Problem::NotText { expected })?;
    if text.starts_with('\u{feff}') {
        text.remove(0);
    }
    Ok(text)
}

fn misnamed(format: &'static str) -> Problem {
    let ending = if format == "PNG" { "png" } else { "pgm" };
    Problem::Misnamed { format, ending }
}

/// What is wrong with a file of an ending that no reader takes.
fn unreadable_ending(path: &Path, bytes: &[u8]) -> Problem {
    let found = excerpt(&ending(path));
    if let Some(format) = foreign::picture(bytes) {
        return misnamed(format);
    }
    match Foreign::of_bytes(bytes).or_else(|| Foreign::of_ending(&found)) {
        None => unknown_ending(path, ENDINGS),
        Some(Foreign { what, advice }) => Problem::ForeignEnding {
            found,
            what,
            expected: ENDINGS,
            advice,
        },
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
        found: excerpt(&ending(path)),
        expected,
    }
}

/// Most bytes of a file that are read: a picture of 16,384×16,384 pixels, and more.
const MOST_BYTES: u64 = 1 << 29;

fn read_bytes(path: &Path) -> Result<Vec<u8>, Problem> {
    let mut bytes = Vec::new();
    File::open(path)
        .and_then(|file| file.take(MOST_BYTES + 1).read_to_end(&mut bytes))
        .map_err(Problem::from_read)?;
    match bytes.len() as u64 > MOST_BYTES {
        true => Err(Problem::TooLong { most: MOST_BYTES }),
        false => Ok(bytes),
    }
}
