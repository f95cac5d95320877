//! How a log lies on a grid.

use std::ops::RangeInclusive;

use planner_core::Extent;
use planner_core::explorer::SensorModel;
use thiserror::Error;

use super::{Log, Look};
use crate::world::LARGEST;

/// Sides of a cell in metres.
const SIZES: RangeInclusive<f64> = 0.001..=1000.0;

/// How a log is replayed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Side of a cell in metres.
    pub cell_size: f64,
    /// How far beams count, in cells, 1 to [`MAX_RADIUS`](planner_core::sight::MAX_RADIUS).
    pub range: u8,
    /// How far the map believes a look.
    pub sensor: SensorModel,
}

/// Cells of a size that does not fit the log.
#[derive(Debug, Error, PartialEq)]
pub enum CellSizeError {
    /// Not a size.
    #[error("cells of {size} m: expected {} to {} m", SIZES.start(), SIZES.end())]
    Size {
        /// In metres.
        size: f64,
    },
    /// The planner's largest map does not hold them.
    #[error(
        "{name}: the log spans {width}×{height} cells of {cell_size} m, more than the largest \
         planner's {LARGEST}; take cells of {suggested} m or more"
    )]
    TooMany {
        /// The log.
        name: String,
        /// Cells from the westernmost to the easternmost that can be seen.
        width: u64,
        /// The same from north to south.
        height: u64,
        /// The size asked for.
        cell_size: f64,
        /// One that fits.
        suggested: f64,
    },
}

/// How places of a log lie on the grid: `y` goes down, cell borders lie at multiples
/// of the cell's size.
pub(super) struct Frame {
    pub(super) options: Options,
    /// Column and row of the log's origin.
    origin: (f64, f64),
    pub(super) extent: Extent,
}

impl Frame {
    pub(super) fn of(log: &Log, options: Options) -> Result<Self, CellSizeError> {
        let size = options.cell_size;
        if !SIZES.contains(&size) {
            return Err(CellSizeError::Size { size });
        }
        let margin = f64::from(options.range) + 1.0;
        let span = |place: fn(&Look) -> f64| {
            let places = log.looks.iter().map(|look| (place(look) / size).floor());
            let low = places.clone().fold(f64::INFINITY, f64::min) - margin;
            let high = places.fold(f64::NEG_INFINITY, f64::max) + margin;
            (low, high - low + 1.0)
        };
        let ((west, width), (north, height)) = (span(|look| look.x), span(|look| -look.y));
        let most = f64::from(LARGEST.width.min(LARGEST.height));
        if width.max(height) > most {
            let metres = (width.max(height) - 2.0 * margin) * size;
            return Err(CellSizeError::TooMany {
                name: log.name.clone(),
                width: width as u64,
                height: height as u64,
                cell_size: size,
                suggested: (100.0 * metres / (most - 2.0 * margin - 2.0)).ceil() / 100.0,
            });
        }
        Ok(Self {
            options,
            origin: (-west, -north),
            extent: Extent::new(width as u16, height as u16),
        })
    }

    /// In cells, from the corner of the grid.
    pub(super) fn place(&self, look: &Look) -> (f64, f64) {
        let size = self.options.cell_size;
        (self.origin.0 + look.x / size, self.origin.1 - look.y / size)
    }

    /// How far beams count, in cells: no farther than the scanner reaches.
    pub(super) fn reach(&self, log: &Log) -> f64 {
        f64::from(self.options.range).min(f64::from(log.nothing_from) / self.options.cell_size)
    }

    /// The measurements of a look: bearings, from east to south, and ranges in cells,
    /// infinite where nothing was hit.
    pub(super) fn measured(&self, log: &Log, look: &Look) -> impl Iterator<Item = (f64, f64)> {
        let (size, nothing_from) = (self.options.cell_size, log.nothing_from);
        let readings = look.readings.iter().filter(|reading| reading.range >= 0.0);
        readings.map(move |reading| {
            let range = match reading.range >= nothing_from {
                true => f64::INFINITY,
                false => f64::from(reading.range) / size,
            };
            (-f64::from(reading.bearing), range)
        })
    }
}
