//! Beams from time-of-flight sensors with 8×8 zones.

use planner_core::sight::{Distances, RangeSensor, Zone, ZoneError, ZoneSensor};

use crate::answer;
use crate::place::{input, output};
use crate::types::{PlannerBeam, PlannerResult};

/// Zones of a sensor.
pub const PLANNER_ZONES: usize = 64;
/// Beams that they make: one for each column.
pub const PLANNER_ZONE_BEAMS: usize = 8;

/// A sensor with 8×8 zones, and how it is mounted.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PlannerZoneSensor {
    /// 0: it tells distances along its axis, as the VL53L5CX, VL53L7CX and VL53L8CX do.
    /// Anything else: distances to what was hit, of which the outer zones say more.
    pub is_radial: u8,
    /// Angle in radians that its 8 columns, and its 8 rows, see together: above 0, up to
    /// pi/2. pi/4 for the VL53L5CX, pi/3 for the VL53L7CX.
    pub field_of_view: f32,
    /// Distance up to which every obstacle gives a measurement, black ones too.
    pub max_range_mm: u16,
    /// Where it points to, in radians from the robot's heading; grows from east to south.
    pub yaw: f32,
    /// How far it points up, in radians, -pi/4 to pi/4: that of the mounting and of a body
    /// that tilts.
    pub pitch: f32,
    /// How far it sits from the robot's middle, in the direction that it points to.
    pub ahead_mm: i16,
    /// How high it sits above the floor.
    pub height_mm: u16,
    /// What lies lower may be the floor: below `height_mm`. Not less than the sensor's error
    /// there, and the error of the pitch times the range.
    pub floor_mm: u16,
    /// What lies higher is not in the robot's way: above `height_mm`.
    pub top_mm: u16,
    /// Side of a cell: that of the planner's configuration.
    pub cell_mm: u16,
}

/// What one zone says.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PlannerZone {
    /// As the driver of a VL53L5CX, VL53L7CX or VL53L8CX tells it. 5 or 9: something is at
    /// `distance_mm`, if that is above 0. 255: nothing is within `max_range_mm`; that driver
    /// tells it if it is asked for the number of targets. Any other: no measurement, which
    /// says nothing.
    pub status: u8,
    /// How far away.
    pub distance_mm: i16,
}

impl From<&PlannerZoneSensor> for ZoneSensor {
    fn from(sensor: &PlannerZoneSensor) -> Self {
        Self {
            distances: match sensor.is_radial {
                0 => Distances::Perpendicular,
                _ => Distances::Radial,
            },
            field_of_view: sensor.field_of_view,
            max_range_mm: sensor.max_range_mm,
            yaw: sensor.yaw,
            pitch: sensor.pitch,
            ahead_mm: sensor.ahead_mm,
            height_mm: sensor.height_mm,
            floor_mm: sensor.floor_mm,
            top_mm: sensor.top_mm,
            cell_mm: sensor.cell_mm,
        }
    }
}

impl From<ZoneError> for PlannerResult {
    fn from(error: ZoneError) -> Self {
        match error {
            ZoneError::FieldOfView => Self::ZoneFieldOfView,
            ZoneError::Pitch => Self::ZonePitch,
            ZoneError::Yaw => Self::ZoneYaw,
            ZoneError::Heights => Self::ZoneHeights,
            ZoneError::Zero => Self::ZoneZero,
        }
    }
}

/// Makes beams for `planner_observe_scan` of what a sensor with 8×8 zones measured: one for
/// each column, from left to right, from the robot's middle to the nearest thing that stands
/// between the floor and the robot's height. Writes [`PLANNER_ZONE_BEAMS`] of them into
/// `beams`, and how far they reach, in cells, into `max_range`. A scan with several sensors
/// takes the beams of all, and the least of their ranges.
///
/// `zones` are [`PLANNER_ZONES`], row by row, the topmost row first and each from left to
/// right, as the robot sees them. In which order a driver gives them hangs on how the sensor
/// is mounted: hold a hand before its upper left corner.
///
/// Zones that see the floor or what is too high are left out. A column without an obstacle is
/// free if one of its zones that see as far as `max_range` found nothing so far; else it says
/// nothing. What is lower than the robot can be missed: from afar it fills little of a zone.
///
/// A result from `PLANNER_RESULT_ZONE_FIELD_OF_VIEW` on tells which value of `sensor` cannot
/// be; nothing is written then. Work: 18 sines and cosines, and 64 zones.
///
/// Stack: 2048 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_zone_beams(
    sensor: *const PlannerZoneSensor,
    zones: *const PlannerZone,
    beams: *mut PlannerBeam,
    max_range: *mut f32,
) -> PlannerResult {
    answer(|| {
        let sensor = ZoneSensor::from(input(sensor)?);
        let zones = input(zones.cast::<[PlannerZone; PLANNER_ZONES]>())?;
        let beams = output(beams.cast::<[PlannerBeam; PLANNER_ZONE_BEAMS]>())?;
        let max_range = output(max_range)?;
        let made = sensor.beams()?;
        let zones = zones.map(|zone| Zone::from_vl53(zone.status, zone.distance_mm));
        beams.write(made.read(&zones).map(PlannerBeam::from));
        // A tolerance is the scan's own, and changes no range.
        max_range.write(made.sensor(RangeSensor::TOLERANCE).max_range);
        Ok(())
    })
}
