//! From a world to a file.

use std::path::Path;

use super::World;
use super::error::{Problem, WorldError};
use super::raster;
use super::read::{ending, unknown_ending};
#[cfg(not(target_arch = "wasm32"))]
use crate::files::write as write_file;
#[cfg(target_arch = "wasm32")]
use std::fs::write as write_file;

impl World {
    /// Writes the map in the format of the ending: `.png` or `.pgm` (a square
    /// of `pixels_per_cell` pixels for each cell), `.map` (MovingAI), `.txt`.
    /// Only text maps keep the starts. The file appears whole or not at all.
    ///
    /// # Errors
    /// Another ending; a file that cannot be written; `pixels_per_cell` 0 or
    /// so many that a side would have more than 16,384 pixels.
    pub fn write(&self, path: impl AsRef<Path>, pixels_per_cell: u32) -> Result<(), WorldError> {
        let path = path.as_ref();
        let bytes = match ending(path).as_str() {
            "png" => raster::png(self, pixels_per_cell),
            "pgm" => raster::pgm(self, pixels_per_cell),
            "map" => Ok(self.to_movingai().into_bytes()),
            "txt" => Ok(self.to_text().into_bytes()),
            _ => Err(unknown_ending(path, ".png, .pgm, .map or .txt")),
        };
        bytes
            .and_then(|bytes| write_file(path, &bytes).map_err(Problem::Unwritable))
            .map_err(|problem| problem.of(path.display().to_string()))
    }
}
