//! Beams from a time-of-flight sensor with 8×8 zones: VL53L5CX and its kin.
//!
//! Such a sensor sees the floor and what is above the robot, too. Each column of zones
//! becomes one beam: to the nearest thing that stands between the floor and the robot's
//! height.

use core::f32::consts::{FRAC_PI_2, FRAC_PI_4};
use core::fmt;

use super::{Beam, Bearing, RangeSensor};
use crate::math;

/// Rows and columns of zones.
const SIDE: usize = 8;

/// What a distance is measured along.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Distances {
    /// The sensor's axis: a wall right across it is at one distance in all zones. So do
    /// the VL53L5CX, VL53L7CX and VL53L8CX, which convert by themselves [ST community,
    /// "what does distance_mm exactly mean", answer of ST's staff].
    Perpendicular,
    /// The line to what was hit: of a wall the outer zones say more than the inner ones.
    Radial,
}

/// What one zone says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Zone {
    /// Something at this distance in millimetres.
    At(u16),
    /// Nothing within [`ZoneSensor::max_range_mm`].
    Nothing,
    /// No measurement, which says nothing.
    Invalid,
}

impl Zone {
    /// From the status and the distance in millimetres that the driver of a VL53L5CX,
    /// VL53L7CX or VL53L8CX gives for a zone: 5 and 9 are valid, 255 is "no target", which
    /// the driver tells if it is asked for the number of targets, and all others are doubtful
    /// [UM2884 §5.5, table 4].
    pub const fn from_vl53(status: u8, mm: i16) -> Self {
        match status {
            5 | 9 if mm > 0 => Self::At(mm.unsigned_abs()),
            255 => Self::Nothing,
            _ => Self::Invalid,
        }
    }
}

/// A sensor and how it is mounted. Lengths in millimetres, angles in radians.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ZoneSensor {
    /// What its distances are.
    pub distances: Distances,
    /// Angle that its 8 columns, and its 8 rows, see together: above 0, up to π/2. π/4 for
    /// the VL53L5CX, π/3 for the VL53L7CX.
    pub field_of_view: f32,
    /// Distance up to which every obstacle gives a measurement, black ones too.
    pub max_range_mm: u16,
    /// Where it points to, from the robot's heading; grows from east to south.
    pub yaw: f32,
    /// How far it points up, -π/4 to π/4: that of the mounting and of a body that tilts.
    pub pitch: f32,
    /// How far it sits from the robot's middle, in the direction that it points to.
    pub ahead_mm: i16,
    /// How high it sits above the floor.
    pub height_mm: u16,
    /// What lies lower may be the floor: below [`height_mm`](Self::height_mm). Not less than
    /// the sensor's error there, and the error of the pitch times the range.
    pub floor_mm: u16,
    /// What lies higher is not in the robot's way: above the sensor.
    pub top_mm: u16,
    /// Side of a cell.
    pub cell_mm: u16,
}

/// A sensor that gives no beams, and why.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum ZoneError {
    /// The field of view is not above 0 and up to π/2.
    FieldOfView,
    /// The pitch is not between -π/4 and π/4, or, among voxels, -π/2 and π/2.
    Pitch,
    /// The yaw is not finite.
    Yaw,
    /// Not `floor_mm < height_mm < top_mm`.
    Heights,
    /// The largest range or the side of a cell is 0.
    Zero,
}

impl fmt::Display for ZoneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::FieldOfView => "the field of view is not above 0 and up to π/2",
            Self::Pitch => "the pitch is not between -π/4 and π/4, or -π/2 and π/2 among voxels",
            Self::Yaw => "the yaw is not finite",
            Self::Heights => "the floor must end below the sensor, and the robot above it",
            Self::Zero => "the largest range and the side of a cell must be above 0",
        })
    }
}

impl core::error::Error for ZoneError {}

/// A row of zones.
#[derive(Clone, Copy, Debug)]
struct Row {
    /// Tangent of its middle against the sensor's axis, upwards.
    tangent: f32,
    /// Way along the floor for each unit along the sensor's axis.
    forward: f32,
    /// How much its lower edge rises for each unit along the floor.
    slope: f32,
    /// As far as it sees whatever stands in the robot's way, in millimetres.
    reach: f32,
}

/// A sensor that is ready to be read: the geometry of its rows and columns, 200 bytes.
///
/// ```
/// use planner_core::Cell;
/// use planner_core::sight::{Distances, Pose, RangeScan, Zone, ZoneSensor};
///
/// let front = ZoneSensor {
///     distances: Distances::Perpendicular,
///     field_of_view: core::f32::consts::FRAC_PI_4,
///     max_range_mm: 1000,
///     yaw: 0.0,
///     pitch: 0.0,
///     ahead_mm: 0,
///     height_mm: 80,
///     floor_mm: 30,
///     top_mm: 120,
///     cell_mm: 100,
/// };
/// let front = front.beams()?;
/// // The driver's answer: a wall at 550 mm, but below the floor is nearer.
/// let mut zones = [Zone::from_vl53(5, 550); 64];
/// zones[56..].fill(Zone::from_vl53(5, 200));
/// let scan = RangeScan {
///     pose: Pose { x: 5.5, y: 5.5, heading: 0.0 },
///     sensor: front.sensor(0.1),
///     beams: front.read(&zones),
/// };
/// let sighting = scan.sighting()?;
/// assert!(sighting.is_free(Cell::new(10, 5)) && sighting.is_blocked(Cell::new(11, 5)));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct ZoneBeams {
    distances: Distances,
    /// Sine and cosine of the yaw.
    yaw: (f32, f32),
    /// Tangents of the middles of the columns against the sensor's axis, to the right.
    columns: [f32; SIDE],
    rows: [Row; SIDE],
    ahead: f32,
    height: f32,
    floor: f32,
    top: f32,
    cell: f32,
    /// The largest of the rows' reaches, and how far that row leads ahead.
    reach: f32,
    level: f32,
}

impl ZoneSensor {
    /// Its geometry, made once; or, where the body tilts, whenever the pitch is measured.
    /// Work: 18 sines and cosines.
    ///
    /// # Errors
    /// Which of the values gives no beams.
    pub fn beams(&self) -> Result<ZoneBeams, ZoneError> {
        if !(self.field_of_view > 0.0 && self.field_of_view <= FRAC_PI_2) {
            return Err(ZoneError::FieldOfView);
        }
        if !(-FRAC_PI_4..=FRAC_PI_4).contains(&self.pitch) {
            return Err(ZoneError::Pitch);
        }
        if !self.yaw.is_finite() {
            return Err(ZoneError::Yaw);
        }
        if !(self.floor_mm < self.height_mm && self.height_mm < self.top_mm) {
            return Err(ZoneError::Heights);
        }
        if self.max_range_mm == 0 || self.cell_mm == 0 {
            return Err(ZoneError::Zero);
        }
        let side = self.field_of_view / SIDE as f32;
        let columns = core::array::from_fn(|column| tangent((column as f32 - 3.5) * side));
        let outermost = tangent(3.5 * side);
        let rows = core::array::from_fn(|row| self.row((3.5 - row as f32) * side, outermost));
        let (mut reach, mut level) = (0.0, 1.0);
        for row in &rows {
            let Row {
                reach: other,
                forward,
                ..
            } = *row;
            if other > reach {
                (reach, level) = (other, forward);
            }
        }
        Ok(ZoneBeams {
            distances: self.distances,
            yaw: math::direction(self.yaw),
            columns,
            rows,
            ahead: f32::from(self.ahead_mm),
            height: f32::from(self.height_mm),
            floor: f32::from(self.floor_mm),
            top: f32::from(self.top_mm),
            cell: f32::from(self.cell_mm),
            reach,
            level,
        })
    }

    /// The row whose middle is at an angle above the sensor's axis.
    fn row(&self, angle: f32, outermost: f32) -> Row {
        let (sin, cos) = math::direction(self.pitch);
        let along = |tangent: f32| (cos - sin * tangent, sin + cos * tangent);
        let tangent_here = tangent(angle);
        let (forward, _) = along(tangent_here);
        let half = self.field_of_view / (2 * SIDE) as f32;
        let (out, up) = along(tangent(angle - half));
        let slope = up / out;
        let mut reach = f32::from(self.max_range_mm) * forward;
        if self.distances == Distances::Radial {
            reach /= norm(outermost, tangent_here);
        }
        // Where its lower edge leaves what is in the robot's way: through the floor, or above.
        let height = f32::from(self.height_mm);
        if slope < 0.0 {
            reach = reach.min((height - f32::from(self.floor_mm)) / -slope);
        } else if slope > 0.0 {
            reach = reach.min((f32::from(self.top_mm) - height) / slope);
        }
        Row {
            tangent: tangent_here,
            forward,
            slope,
            reach,
        }
    }
}

impl ZoneBeams {
    /// What its beams can do: they reach as far as the row that sees farthest before it meets
    /// the floor or looks over what is as high as the robot. A scan with several sensors takes
    /// the least of their ranges. `tolerance`: see [`RangeSensor::tolerance`].
    pub fn sensor(&self, tolerance: f32) -> RangeSensor {
        RangeSensor {
            max_range: (self.reach + self.ahead) / self.cell,
            tolerance,
        }
    }

    /// One beam for each column, from left to right, from the robot's middle.
    ///
    /// `zones` lie row by row, the topmost row first and each from left to right, as the robot
    /// sees them. In which order a driver gives them hangs on how the sensor is mounted: hold
    /// a hand before its upper left corner.
    ///
    /// A beam ends at the nearest obstacle of its column: at what a zone has measured whose
    /// lower edge is there above the floor and not above the robot. Zones that see the floor
    /// or what is too high are left out, those without a measurement say nothing. A column
    /// without an obstacle is free if one of its zones that see as far as
    /// [`sensor`](Self::sensor) says found nothing so far; else it says nothing.
    ///
    /// What is lower than the robot can be missed: from afar it fills little of a zone. Work:
    /// 64 zones, each with a square root if distances are radial, and 8 square roots.
    pub fn read(&self, zones: &[Zone; SIDE * SIDE]) -> [Beam; SIDE] {
        let mut nearest = [Way::ENDLESS; SIDE];
        let mut is_clear = [false; SIDE];
        for (row, zones) in self.rows.iter().zip(zones.chunks_exact(SIDE)) {
            let columns = self.columns.iter().zip(&mut nearest).zip(&mut is_clear);
            for (&zone, ((&column, nearest), is_clear)) in zones.iter().zip(columns) {
                let Some(way) = self.way(zone, row, column) else {
                    continue;
                };
                let height = self.height + way.ahead * row.slope;
                if !way.ahead.is_finite() || !(self.floor..=self.top).contains(&height) {
                    *is_clear |= way.ahead.min(row.reach) >= self.reach;
                } else if way.ahead < nearest.ahead {
                    *nearest = way;
                }
            }
        }
        let mut columns = self.columns.iter().zip(nearest).zip(is_clear);
        [(); SIDE]
            .map(|()| {
                let ((&column, nearest), is_clear) = columns.next()?;
                if nearest.ahead.is_finite() {
                    let (ahead, right) = (nearest.ahead + self.ahead, nearest.right);
                    let range = math::length(ahead, right) / self.cell;
                    return self.beam(ahead, right, range);
                }
                let range = if is_clear { f32::INFINITY } else { f32::NAN };
                self.beam(self.level, column, range)
            })
            .map(|beam| beam.unwrap_or(NOTHING))
    }

    /// Where what a zone has measured is; endless if that is nothing.
    fn way(&self, zone: Zone, row: &Row, column: f32) -> Option<Way> {
        let along = match (zone, self.distances) {
            (Zone::Invalid, _) => return None,
            (Zone::Nothing, _) => return Some(Way::ENDLESS),
            (Zone::At(mm), Distances::Perpendicular) => f32::from(mm),
            (Zone::At(mm), Distances::Radial) => f32::from(mm) / norm(column, row.tangent),
        };
        Some(Way {
            ahead: along * row.forward,
            right: along * column,
        })
    }

    /// A beam along a vector in the sensor's own frame.
    fn beam(&self, ahead: f32, right: f32, range: f32) -> Option<Beam> {
        let length = math::length(ahead, right);
        let (ahead, right) = (ahead / length, right / length);
        let (sin, cos) = self.yaw;
        let bearing = Bearing::from_unit(ahead * cos - right * sin, ahead * sin + right * cos)?;
        Some(Beam { bearing, range })
    }
}

/// A way along the floor in the sensor's own frame, in millimetres.
#[derive(Clone, Copy)]
struct Way {
    ahead: f32,
    right: f32,
}

impl Way {
    const ENDLESS: Self = Self {
        ahead: f32::INFINITY,
        right: 0.0,
    };
}

/// A beam that says nothing.
const NOTHING: Beam = Beam {
    bearing: Bearing::AHEAD,
    range: f32::NAN,
};

fn tangent(angle: f32) -> f32 {
    let (sin, cos) = math::direction(angle);
    sin / cos
}

/// Length of a line for each unit along the sensor's axis.
fn norm(column: f32, row: f32) -> f32 {
    math::sqrt(1.0 + column * column + row * row)
}
