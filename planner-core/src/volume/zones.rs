//! Rays of a time-of-flight sensor with 8×8 zones, among voxels.

use core::f32::consts::FRAC_PI_2;

use super::{Ray, Vector};
use crate::math;
use crate::sight::{Distances, RangeSensor, Zone, ZoneError, ZoneSensor};

/// Rows and columns of zones.
const SIDE: usize = 8;

/// A sensor that is ready to be read: 80 bytes.
#[derive(Clone, Copy, Debug)]
pub struct ZoneRays {
    distances: Distances,
    /// Sine and cosine of the yaw and of the pitch.
    yaw: (f32, f32),
    pitch: (f32, f32),
    /// Tangents of the middles of the columns, to the right, and of the rows, downwards, against
    /// the sensor's axis.
    tangents: [f32; SIDE],
    ahead: f32,
    max_range: f32,
    /// Voxels a millimetre.
    scale: f32,
}

impl ZoneSensor {
    /// Its rays among voxels, made once; or, where the body tilts, whenever the pitch is measured.
    /// The pitch may be that of a sensor that points straight up or down, -π/2 to π/2;
    /// [`height_mm`](Self::height_mm), [`floor_mm`](Self::floor_mm) and
    /// [`top_mm`](Self::top_mm) are not read. The sensor sits [`ahead_mm`](Self::ahead_mm) from
    /// the robot's middle along its axis: rays of one that sits a voxel away say nothing. Work: 10
    /// sines and cosines.
    ///
    /// # Errors
    /// Which of the values gives no rays.
    pub fn rays(&self) -> Result<ZoneRays, ZoneError> {
        if !(self.field_of_view > 0.0 && self.field_of_view <= FRAC_PI_2) {
            return Err(ZoneError::FieldOfView);
        }
        if !(-FRAC_PI_2..=FRAC_PI_2).contains(&self.pitch) {
            return Err(ZoneError::Pitch);
        }
        if !self.yaw.is_finite() {
            return Err(ZoneError::Yaw);
        }
        if self.max_range_mm == 0 || self.cell_mm == 0 {
            return Err(ZoneError::Zero);
        }
        let scale = 1.0 / f32::from(self.cell_mm);
        Ok(ZoneRays {
            distances: self.distances,
            yaw: math::direction(self.yaw),
            pitch: math::direction(self.pitch),
            tangents: core::array::from_fn(|zone| {
                let angle = (zone as f32 - 3.5) * self.field_of_view / SIDE as f32;
                let (sin, cos) = math::direction(angle);
                sin / cos
            }),
            ahead: f32::from(self.ahead_mm) * scale,
            max_range: f32::from(self.max_range_mm) * scale,
            scale,
        })
    }
}

impl ZoneRays {
    /// How far its rays reach. `tolerance`: see [`RangeSensor::tolerance`].
    pub const fn sensor(&self, tolerance: f32) -> RangeSensor {
        RangeSensor {
            max_range: self.max_range,
            tolerance,
        }
    }

    /// A ray for each zone, along its middle. `zones` lie row by row as those of
    /// [`ZoneBeams::read`](crate::sight::ZoneBeams::read): the topmost row first, each from left
    /// to right.
    pub fn read<'a>(&'a self, zones: &'a [Zone; SIDE * SIDE]) -> impl Iterator<Item = Ray> + 'a {
        let from = self.mounted(Vector::new(self.ahead, 0.0, 0.0));
        let rows = self.tangents.iter().zip(zones.chunks_exact(SIDE));
        rows.flat_map(move |(&down, zones)| {
            let zones = self.tangents.iter().zip(zones);
            zones.map(move |(&right, zone)| {
                let norm = math::sqrt(1.0 + right * right + down * down);
                let range = match (zone, self.distances) {
                    (Zone::Invalid, _) => f32::NAN,
                    (Zone::Nothing, _) => f32::INFINITY,
                    (Zone::At(mm), Distances::Perpendicular) => f32::from(*mm) * norm * self.scale,
                    (Zone::At(mm), Distances::Radial) => f32::from(*mm) * self.scale,
                };
                let direction = Vector::new(1.0 / norm, right / norm, -down / norm);
                Ray {
                    from,
                    direction: self.mounted(direction),
                    range,
                }
            })
        })
    }

    /// From the sensor's own frame to the robot's.
    fn mounted(&self, vector: Vector) -> Vector {
        let ((sin, cos), Vector { ahead, right, up }) = (self.pitch, vector);
        let (ahead, up) = (ahead * cos - up * sin, ahead * sin + up * cos);
        let (sin, cos) = self.yaw;
        Vector::new(ahead * cos - right * sin, ahead * sin + right * cos, up)
    }
}
