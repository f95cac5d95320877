//! What a range sensor measures: beams, and how far they can be trusted.

use crate::math;

/// A direction relative to the robot's heading, as a unit vector: made once for each
/// beam of a sensor, so that a look takes no sine of it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Bearing {
    ahead: f32,
    right: f32,
}

impl Bearing {
    /// Where the heading points to.
    pub const AHEAD: Self = Self::new(1.0, 0.0);
    /// A quarter turn from the heading, from east to south.
    pub const RIGHT: Self = Self::new(0.0, 1.0);
    /// Against the heading.
    pub const BACK: Self = Self::new(-1.0, 0.0);
    /// A quarter turn from the heading, from east to north.
    pub const LEFT: Self = Self::new(0.0, -1.0);

    const fn new(ahead: f32, right: f32) -> Self {
        Self { ahead, right }
    }

    /// The direction `angle` radians from the heading; grows from east to south. If the
    /// angle is not finite, beams in this direction say nothing. Work: a sine and a cosine.
    pub fn from_radians(angle: f32) -> Self {
        let (right, ahead) = math::direction(angle);
        Self { ahead, right }
    }

    /// The direction of a vector of length 1, `None` if its length is off by more than
    /// 0.001.
    pub const fn from_unit(ahead: f32, right: f32) -> Option<Self> {
        let squared = ahead * ahead + right * right;
        if squared > 0.998 && squared < 1.002 {
            Some(Self { ahead, right })
        } else {
            None
        }
    }

    /// Its part along the heading: the cosine of its angle.
    pub const fn ahead(self) -> f32 {
        self.ahead
    }

    /// Its part to the right of the heading: the sine of its angle.
    pub const fn right(self) -> f32 {
        self.right
    }
}

/// One distance measured.
///
/// Three things that sensors say must be told apart, whatever number the driver has for
/// them: an obstacle at a distance, nothing within reach, and no measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Beam {
    /// Where it pointed to.
    pub bearing: Bearing,
    /// Distance to what was hit, in cells. Infinite, or not below the sensor's
    /// `max_range`: nothing within reach, so what lies on the beam is free. Negative or
    /// not a number: no measurement, which says nothing about any cell.
    pub range: f32,
}

/// A range sensor: how far it measures, and how well its beams are known.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct RangeSensor {
    /// Distance in cells up to which every obstacle gives a measurement. Above 0.
    pub max_range: f32,
    /// How far, in cells, the end of a beam may lie from where it is reported, 0 to
    /// [`MAX_TOLERANCE`](Self::MAX_TOLERANCE):
    ///
    /// `(range error + position error + max range × heading error) / side of a cell`
    ///
    /// with lengths in one unit, the heading's error in radians, and rounding counted
    /// among the errors (half a step). Take the error that one beam in a hundred exceeds,
    /// about 2.5 standard deviations.
    ///
    /// In a world of whole cells no scan then tells a lie: see [`RangeScan`]. A larger
    /// tolerance shows less, for a hit in the corner between cells is left out, and so
    /// is a cell that a beam crosses near its edge alone.
    ///
    /// [`RangeScan`]: super::RangeScan
    pub tolerance: f32,
}

impl RangeSensor {
    /// The tolerance of [`new`](Self::new), in cells: for ranges in whole millimetres
    /// and a few millimetres of error on cells of 50 mm and more.
    pub const TOLERANCE: f32 = 0.1;

    /// The largest tolerance, in cells.
    pub const MAX_TOLERANCE: f32 = 0.25;

    /// A sensor that measures up to `max_range` cells, with the usual tolerance.
    pub const fn new(max_range: f32) -> Self {
        Self {
            max_range,
            tolerance: Self::TOLERANCE,
        }
    }
}
