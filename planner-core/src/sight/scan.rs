//! A sighting from a range scan: lidar, multi-ranger, a row of a time-of-flight
//! sensor.

use core::fmt;

use super::walk::Eye;
use super::{Beam, LongSighting, Look, RangeSensor, Row, Sighting};
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
    /// Direction that [`Bearing::AHEAD`](super::Bearing::AHEAD) points to, in radians;
    /// grows from east to south.
    pub heading: f32,
}

/// A scan: beams taken from one pose.
///
/// In a world of whole cells, free or blocked, and with errors within the sensor's
/// tolerance, no scan tells a blocked cell free or a free cell blocked.
///
/// ```
/// use planner_core::Cell;
/// use planner_core::sight::{Beam, Bearing, Pose, RangeScan, RangeSensor};
///
/// let scan = RangeScan {
///     pose: Pose { x: 5.5, y: 5.5, heading: 0.0 },
///     sensor: RangeSensor::new(4.0),
///     beams: [
///         Beam { bearing: Bearing::AHEAD, range: 2.5 },
///         Beam { bearing: Bearing::LEFT, range: f32::INFINITY }, // nothing within reach
///         Beam { bearing: Bearing::RIGHT, range: f32::NAN },     // no measurement
///     ],
/// };
/// let sighting = scan.sighting()?;
/// assert!(sighting.is_free(Cell::new(7, 5)) && sighting.is_blocked(Cell::new(8, 5)));
/// assert!(sighting.is_free(Cell::new(5, 2)));
/// assert!(!sighting.is_free(Cell::new(5, 6)) && !sighting.is_blocked(Cell::new(5, 6)));
/// # Ok::<(), planner_core::sight::ScanError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct RangeScan<I> {
    /// Where the sensor was.
    pub pose: Pose,
    /// What it can do.
    pub sensor: RangeSensor,
    /// The measurements, in any order: an array, or anything that yields [`Beam`]s.
    pub beams: I,
}

/// A scan that says nothing about any cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum ScanError {
    /// The pose is not finite, or outside of what a [`Cell`] can name.
    Pose,
    /// The largest range is not a positive, finite number.
    MaxRange,
    /// The tolerance is not a number from 0 to [`RangeSensor::MAX_TOLERANCE`].
    Tolerance,
}

impl fmt::Display for ScanError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Pose => "the pose of the scan is not finite or too far from the origin",
            Self::MaxRange => "the largest range of the sensor is not a positive number",
            Self::Tolerance => "the tolerance of the sensor is not between 0 and 0.25 cells",
        })
    }
}

impl core::error::Error for ScanError {}

/// Limit of the coordinates, well inside `i16`.
const FARTHEST: f32 = 16_000.0;

impl<I: IntoIterator<Item = Beam>> RangeScan<I> {
    /// The cells that the beams crossed, free, and those that they hit, blocked; firm if
    /// two of them did. A cell that was both crossed and hit is blocked. A hit in the
    /// corner between cells, or on a wall that the beam only grazes, says nothing of what
    /// was hit. Beams end at [`MAX_RADIUS`](super::MAX_RADIUS) cells.
    ///
    /// Work: a sine and a cosine, and at most `2·15 + 2` cells a beam, none of them with a
    /// division; `fixtures/budget.txt` has what that takes.
    ///
    /// # Errors
    /// The pose or the sensor is not usable; a bad beam is only left out.
    pub fn sighting(self) -> Result<Sighting, ScanError> {
        self.look()
    }

    /// As [`sighting`](Self::sighting), for a sensor that reaches farther: beams end at
    /// [`MAX_LONG_RADIUS`](super::MAX_LONG_RADIUS) cells.
    ///
    /// Work: as there, with at most `2·31 + 2` cells a beam.
    ///
    /// # Errors
    /// As [`sighting`](Self::sighting).
    pub fn long_sighting(self) -> Result<LongSighting, ScanError> {
        self.look()
    }

    fn look<R: Row, const SPAN: usize>(self) -> Result<Look<R, SPAN>, ScanError> {
        let (Pose { x, y, heading }, sensor) = (self.pose, self.sensor);
        let usable = |v: f32| v.is_finite() && (-FARTHEST..FARTHEST).contains(&v);
        if !(usable(x) && usable(y) && heading.is_finite()) {
            return Err(ScanError::Pose);
        }
        if !(sensor.max_range.is_finite() && sensor.max_range > 0.0) {
            return Err(ScanError::MaxRange);
        }
        if !(0.0..=RangeSensor::MAX_TOLERANCE).contains(&sensor.tolerance) {
            return Err(ScanError::Tolerance);
        }
        let (column, row) = (math::floor(x), math::floor(y));
        let mut sighting = Look::new(Cell::new(column as i16, row as i16));
        let eye = Eye::new(x - column, y - row, sensor.tolerance);
        let (sin, cos) = math::direction(heading);
        for Beam { bearing, range } in self.beams {
            let (ahead, right) = (bearing.ahead(), bearing.right());
            let direction = (ahead * cos - right * sin, ahead * sin + right * cos);
            eye.cast(&mut sighting, direction, range, sensor.max_range);
        }
        sighting.settle();
        Ok(sighting)
    }
}
