//! A sighting from a range scan: lidar, multi-ranger, a row of a time-of-flight
//! sensor.

use core::fmt;

use super::{MAX_RADIUS, Sighting};
use crate::cell::Cell;
use crate::math;

/// Where the robot is, in cells: the cell `(x, y)` covers `[x, x + 1) × [y, y + 1)`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Pose {
    /// Position along `x`, in cells.
    pub x: f32,
    /// Position along `y`, in cells.
    pub y: f32,
    /// Direction that bearing 0 points to, in radians; grows from east to south.
    pub heading: f32,
}

/// One distance measured.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Beam {
    /// Direction relative to the heading, in radians; grows from east to south.
    pub bearing: f32,
    /// Distance to what was hit, in cells. Not below the scan's `max_range`, or
    /// infinite: nothing was hit. Negative or not a number: no measurement.
    pub range: f32,
}

/// A scan: beams taken from one pose.
#[derive(Clone, Copy, Debug)]
pub struct RangeScan<'a> {
    /// Where the sensor was.
    pub pose: Pose,
    /// Distance in cells up to which the sensor measures.
    pub max_range: f32,
    /// The measurements, in any order.
    pub beams: &'a [Beam],
}

/// A scan that says nothing about any cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum ScanError {
    /// The pose is not finite, or outside of what a [`Cell`] can name.
    Pose,
    /// The largest range is not a positive, finite number.
    MaxRange,
}

impl fmt::Display for ScanError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Pose => "the pose of the scan is not finite or too far from the origin",
            Self::MaxRange => "the largest range of the scan is not a positive number",
        })
    }
}

impl core::error::Error for ScanError {}

/// A hit this near (in cells) to the border between two cells is taken to be on
/// the border: the surface of the obstacle behind it.
const SURFACE: f32 = 0.02;

/// Limit of the coordinates, well inside `i16`.
const FARTHEST: f32 = 16_000.0;

impl RangeScan<'_> {
    /// The cells that the beams crossed and those that they hit. A hit in the
    /// corner between cells says nothing, for it is not clear which one was hit.
    /// Beams end at [`MAX_RADIUS`] cells.
    ///
    /// Work: at most `2·15 + 3` cells a beam.
    ///
    /// # Errors
    /// The pose or the largest range is not usable; a bad beam is only left out.
    pub fn sighting(&self) -> Result<Sighting, ScanError> {
        let Pose { x, y, heading } = self.pose;
        let usable = |v: f32| v.is_finite() && (-FARTHEST..FARTHEST).contains(&v);
        if !(usable(x) && usable(y) && heading.is_finite()) {
            return Err(ScanError::Pose);
        }
        if !(self.max_range.is_finite() && self.max_range > 0.0) {
            return Err(ScanError::MaxRange);
        }
        let centre = Cell::new(math::floor(x) as i16, math::floor(y) as i16);
        let mut sighting = Sighting::new(centre);
        for beam in self.beams {
            self.cast(&mut sighting, *beam);
        }
        Ok(sighting)
    }

    fn cast(&self, sighting: &mut Sighting, beam: Beam) {
        if beam.range.is_nan() || beam.range < 0.0 || !beam.bearing.is_finite() {
            return;
        }
        let reach = self.max_range.min(f32::from(MAX_RADIUS));
        let hit = beam.range < self.max_range && beam.range <= f32::from(MAX_RADIUS);
        let length = if hit { beam.range } else { reach };
        let angle = self.pose.heading + beam.bearing;
        let mut cell = sighting.centre();
        let (sin, cos) = math::exact_sin_cos(angle);
        let mut along_x = Axis::new(self.pose.x, cos);
        let mut along_y = Axis::new(self.pose.y, sin);

        // A beam crosses at most 15 columns and 15 rows, and one more of each at its end.
        for _ in 0..2 * (u32::from(MAX_RADIUS) + 1) {
            let (next, other) = if along_x.crossing < along_y.crossing {
                (along_x.crossing, along_y.crossing)
            } else {
                (along_y.crossing, along_x.crossing)
            };
            if next > length + SURFACE {
                // The beam ends inside of this cell: what it hit stands in it.
                if hit {
                    sighting.see_blocked(cell);
                }
                return;
            }
            let at_corner = other - next <= SURFACE;
            if along_x.crossing <= along_y.crossing {
                cell.x = cell.x.saturating_add(along_x.cross());
            } else {
                cell.y = cell.y.saturating_add(along_y.cross());
            }
            if hit && next >= length - SURFACE {
                if !at_corner {
                    sighting.see_blocked(cell);
                }
                return;
            }
            // Free if the beam leaves the cell again; at the end of its reach also
            // if it got half a cell into it.
            let leaves = along_x.crossing.min(along_y.crossing);
            let through = leaves <= length + SURFACE;
            if leaves - next > SURFACE && (through || !hit && length - next > 0.5 - SURFACE) {
                sighting.see_free(cell);
            }
        }
    }
}

/// One coordinate of a beam: at which distance it enters the next cell.
struct Axis {
    step: i16,
    crossing: f32,
    spacing: f32,
}

impl Axis {
    fn new(position: f32, slope: f32) -> Self {
        // Below this a beam of 15 cells does not leave its row.
        if slope.abs() < 1e-6 {
            return Self {
                step: 0,
                crossing: f32::INFINITY,
                spacing: f32::INFINITY,
            };
        }
        let inside = position - math::floor(position);
        let to_border = if slope > 0.0 { 1.0 - inside } else { inside };
        Self {
            step: if slope > 0.0 { 1 } else { -1 },
            crossing: to_border / slope.abs(),
            spacing: 1.0 / slope.abs(),
        }
    }

    fn cross(&mut self) -> i16 {
        self.crossing += self.spacing;
        self.step
    }
}
