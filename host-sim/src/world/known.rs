//! What is known of a world, as ROS map_server reads it.

use image::{GrayImage, Luma};
use planner_core::{Cell, Extent};

use super::{cells, index, raster};

/// What robots know: of each cell whether it is free, if they know it.
#[derive(Clone, Debug, PartialEq)]
pub struct KnownMap {
    extent: Extent,
    /// Row by row.
    free: Vec<Option<bool>>,
}

/// map_saver's grays, which its thresholds tell apart.
const FREE: u8 = 254;
const OBSTACLE: u8 = 0;
const UNKNOWN: u8 = 205;

impl KnownMap {
    /// Of so many cells; `free` says whether a cell is free, if that is known.
    pub fn from_fn(extent: Extent, free: impl FnMut(Cell) -> Option<bool>) -> Self {
        let free = cells(extent).map(free).collect();
        Self { extent, free }
    }

    /// Whether a cell is free, if that is known; nothing is outside.
    pub fn is_free(&self, cell: Cell) -> Option<bool> {
        let is_inside = self.extent.contains(cell);
        is_inside.then(|| self.free[index(self.extent, cell)])?
    }

    /// A picture (PGM) with a pixel for each cell.
    pub fn pgm(&self) -> Vec<u8> {
        let Extent { width, height } = self.extent;
        raster::pgm_of(&GrayImage::from_fn(width.into(), height.into(), |x, y| {
            Luma([match self.is_free(Cell::new(x as i16, y as i16)) {
                Some(true) => FREE,
                Some(false) => OBSTACLE,
                None => UNKNOWN,
            }])
        }))
    }

    /// What map_server has to know of that picture, in the file `image` beside it: cells of so
    /// many metres, and the pose of the lower left corner.
    pub fn yaml(image: &str, cell: f64, origin: [f64; 3]) -> String {
        format!(
            "image: {image}\nmode: trinary\nresolution: {cell}\norigin: {origin:?}\n\
             negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
        )
    }
}
