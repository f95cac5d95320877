//! A look from measured distances: the voxels that rays show.

use super::{MAX_REACH, Voxel, VoxelPose};
use crate::math;
use crate::sight::{RangeSensor, ScanError};

const REACH: i16 = MAX_REACH as i16;

/// Rows of a level, and levels.
const SPAN: usize = 2 * MAX_REACH as usize + 1;

/// What all roundings of a ray stay below, in voxels.
const ROUNDING: f32 = 1.0 / 8192.0;

/// A ray that comes to a border by this or less a voxel only grazes what it hits there.
const GRAZING: f32 = 0.2;

/// The least that a ray changes along any axis, a voxel: nothing is divided by 0.
const FLAT: f32 = 1e-6;

/// Borders that a ray crosses at most, and the voxel that it begins in.
const MOST: usize = 3 * (MAX_REACH as usize + 1);

/// A vector in the frame of a robot that is level.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Vector {
    /// Its part along the heading.
    pub ahead: f32,
    /// Its part to the right of that.
    pub right: f32,
    /// Its part upwards.
    pub up: f32,
}

impl Vector {
    /// Nowhere: the robot's middle.
    pub const ZERO: Self = Self::new(0.0, 0.0, 0.0);
    /// Ahead.
    pub const AHEAD: Self = Self::new(1.0, 0.0, 0.0);
    /// To the right.
    pub const RIGHT: Self = Self::new(0.0, 1.0, 0.0);
    /// Up.
    pub const UP: Self = Self::new(0.0, 0.0, 1.0);

    /// The vector with these parts.
    pub const fn new(ahead: f32, right: f32, up: f32) -> Self {
        Self { ahead, right, up }
    }

    /// The other way.
    pub const fn back(self) -> Self {
        Self::new(-self.ahead, -self.right, -self.up)
    }

    /// Along x, y and z, for a heading with this sine and cosine.
    fn turned(self, (sin, cos): (f32, f32)) -> [f32; 3] {
        [
            self.ahead * cos - self.right * sin,
            self.ahead * sin + self.right * cos,
            self.up,
        ]
    }
}

/// One distance measured, by a range finder or a point of a depth image.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Ray {
    /// Where the sensor sits, from the robot's middle, in voxels: less than one away.
    pub from: Vector,
    /// Where it points to: a vector of length 1. With another length, by more than 0.001, the ray
    /// says nothing.
    pub direction: Vector,
    /// Distance to what was hit, in voxels. Infinite, or not below the sensor's
    /// `max_range`: nothing within reach, so what lies on the ray is free. Negative or not a
    /// number: no measurement, which says nothing.
    pub range: f32,
}

/// The voxels that one look shows, each once: those that rays from all sensors passed are free,
/// those that one has hit are occupied, whatever else passed them. About 5 KB.
///
/// In a world of whole voxels, free or occupied, and with errors within the sensors' tolerance, no
/// ray tells an occupied voxel free or a free one occupied. A voxel that rays pass near its rim
/// alone, and one that is hit in a corner, is left out: a look misses some that are in sight, which
/// others show.
///
/// ```
/// use planner_core::sight::{Distances, RangeSensor, Zone, ZoneSensor};
/// use planner_core::volume::{Ray, Vector, VoxelLook, VoxelPose};
/// use planner_core::voxel_survey::{Config, VoxelSurvey};
/// use planner_core::{Extent, RobotId};
/// # const NONE: u16 = 0;
/// # let front = ZoneSensor {
/// #     distances: Distances::Perpendicular, field_of_view: core::f32::consts::FRAC_PI_4,
/// #     max_range_mm: 2000, yaw: 0.0, pitch: 0.0, ahead_mm: 0, height_mm: NONE, floor_mm: NONE,
/// #     top_mm: NONE, cell_mm: 250,
/// # };
/// # let zones = [Zone::from_vl53(5, 1125); 64];
/// # let up_mm = 875.0;
/// let config = Config { clearance: 0, ..Config::new() };
/// let (origin_mm, cell_mm) = (config.link.origin_mm, 250);
/// # let mut robot = VoxelSurvey::<2, 2, 8>::new(config, RobotId(1), Extent::new(14, 12), 8)?;
/// // Once: the geometry of the zones. `front` is a `ZoneSensor`.
/// let front = front.rays()?;
/// // In each step: the pose from your estimate, then what each sensor has measured.
/// let pose = VoxelPose::from_metres(0.875, -0.875, 0.875, 0.0, origin_mm, cell_mm);
/// # let mut look = VoxelLook::vacant();
/// look.begin(pose, config.range)?; // a `VoxelLook`, for example a static one
/// look.see(front.sensor(0.1), front.read(&zones))?;
/// let range = up_mm / f32::from(cell_mm);
/// let up = Ray { from: Vector::ZERO, direction: Vector::UP, range };
/// look.see(RangeSensor { max_range: 8.0, tolerance: 0.1 }, [up])?;
/// let (at, heading) = (look.eye(), pose.heading().ok_or("no pose")?);
/// robot.observe_towards(at, heading, look.seen());
/// // Where to fly: the middle of the voxel that the tick moves to.
/// let (x, y, z) = at.middle_in_metres(origin_mm, cell_mm);
/// # assert_eq!((at.x, at.y, at.z), (3, 3, 3));
/// # let volume = robot.volume();
/// # use planner_core::volume::{Content, Voxel};
/// # assert_eq!(volume.content(Voxel::new(7, 3, 3)), Content::Free);
/// # assert_eq!(volume.content(Voxel::new(8, 3, 3)), Content::Occupied);
/// # assert_eq!(volume.content(Voxel::new(3, 3, 7)), Content::Occupied);
/// # assert_eq!(volume.content(Voxel::new(9, 3, 3)), Content::Unknown);
/// # assert!((x - 0.875).abs() < 1e-6 && (y + 0.875).abs() < 1e-6 && (z - 0.875).abs() < 1e-6);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct VoxelLook {
    eye: Voxel,
    /// The robot's middle, from the corner of its voxel.
    middle: [f32; 3],
    /// Sine and cosine of the heading.
    heading: (f32, f32),
    reach: f32,
    /// Bit `REACH` + x of a row is the voxel that far east of the robot's.
    free: [[u32; SPAN]; SPAN],
    occupied: [[u32; SPAN]; SPAN],
}

impl VoxelLook {
    /// A look from nowhere, to be [begun](Self::begin): all zero, a `static` of it costs no flash.
    pub const fn vacant() -> Self {
        Self {
            eye: Voxel::new(0, 0, 0),
            middle: [0.0; 3],
            heading: (0.0, 0.0),
            reach: 0.0,
            free: [[0; SPAN]; SPAN],
            occupied: [[0; SPAN]; SPAN],
        }
    }

    /// Begins a look in place: nothing is seen yet but the robot's own voxel, which is free. Rays
    /// end at `range` voxels, at most [`MAX_RANGE`](crate::voxel_survey::MAX_RANGE): that of the
    /// configuration.
    ///
    /// # Errors
    /// The pose is in no voxel; nothing has changed then.
    pub fn begin(&mut self, pose: VoxelPose, range: u8) -> Result<(), ScanError> {
        let eye = pose.voxel().ok_or(ScanError::Pose)?;
        if !pose.heading.is_finite() {
            return Err(ScanError::Pose);
        }
        self.eye = eye;
        self.middle = [(pose.x, eye.x), (pose.y, eye.y), (pose.z, eye.z)]
            .map(|(at, corner)| at - f32::from(corner));
        self.heading = math::direction(pose.heading);
        self.reach = range.min(MAX_REACH).into();
        self.free.as_flattened_mut().fill(0);
        self.occupied.as_flattened_mut().fill(0);
        self.add(eye, false);
        Ok(())
    }

    /// The robot's voxel.
    pub const fn eye(&self) -> Voxel {
        self.eye
    }

    /// Adds what a sensor has measured. Several may do so, each with its own reach and tolerance.
    ///
    /// Cost: at most 39 voxels a ray.
    ///
    /// # Errors
    /// The sensor's values cannot be; nothing was added then.
    pub fn see(
        &mut self,
        sensor: RangeSensor,
        rays: impl IntoIterator<Item = Ray>,
    ) -> Result<(), ScanError> {
        let RangeSensor {
            max_range,
            tolerance,
        } = sensor;
        if !(max_range > 0.0 && max_range.is_finite()) {
            return Err(ScanError::MaxRange);
        }
        if !(0.0..=RangeSensor::MAX_TOLERANCE).contains(&tolerance) {
            return Err(ScanError::Tolerance);
        }
        for ray in rays {
            self.cast(&ray, max_range, tolerance + ROUNDING);
        }
        Ok(())
    }

    /// Adds a voxel that was seen otherwise. Ignored if it is more than
    /// [`MAX_RANGE`](crate::voxel_survey::MAX_RANGE) away along an axis. The robot's own is free.
    pub fn add(&mut self, voxel: Voxel, occupied: bool) {
        let place = |at: i16, eye: i16| {
            let place = usize::try_from(i32::from(at) - i32::from(eye) + i32::from(REACH));
            place.ok().filter(|&place| place < SPAN)
        };
        let places = (
            place(voxel.x, self.eye.x),
            place(voxel.y, self.eye.y),
            place(voxel.z, self.eye.z),
        );
        let (Some(column), Some(row), Some(level)) = places else {
            return;
        };
        let cells = match occupied && voxel != self.eye {
            true => &mut self.occupied,
            false => &mut self.free,
        };
        if let Some(row) = cells.get_mut(level).and_then(|level| level.get_mut(row)) {
            *row |= 1 << column;
        }
    }

    /// Every voxel that was seen, and whether it is occupied: for
    /// [`observe_towards`](crate::voxel_survey::VoxelSurvey::observe_towards).
    pub fn seen(&self) -> impl Iterator<Item = (Voxel, bool)> + '_ {
        let Voxel { x, y, z } = self.eye;
        let rows = self.free.as_flattened().iter();
        let rows = rows.zip(self.occupied.as_flattened());
        (0i16..)
            .zip(rows)
            .flat_map(move |(number, (free, occupied))| {
                let (level, row) = (number / SPAN as i16, number % SPAN as i16);
                let at = move |eye: i16, place: i16| eye.saturating_add(place - REACH);
                crate::tile::bits(u64::from(free | occupied)).map(move |bit| {
                    let voxel = Voxel::new(at(x, bit as i16), at(y, row), at(z, level));
                    (voxel, occupied >> bit & 1 != 0)
                })
            })
    }

    /// What one ray shows: the voxels that it passes at least `tolerance` from all their faces,
    /// and the one that it ends in, or at the face of.
    // [Amanatides1987]
    fn cast(&mut self, ray: &Ray, max_range: f32, tolerance: f32) {
        let direction = ray.direction.turned(self.heading);
        let squared = direction.iter().map(|part| part * part).sum::<f32>();
        let from = ray.from.turned(self.heading);
        let is_said = ray.range >= 0.0 && squared > 0.998 && squared < 1.002;
        if !is_said || !from.iter().all(|part| part.abs() < 1.0) {
            return;
        }
        let reach = max_range.min(self.reach);
        let is_hit = ray.range < max_range && ray.range <= reach;
        let length = if is_hit { ray.range } else { reach };
        let [x, y, z] = [0, 1, 2].map(|axis| {
            let part = |of: &[f32; 3]| of.get(axis).copied().unwrap_or(0.0);
            Axis::new(part(&self.middle) + part(&from), part(&direction))
        });
        let mut axes = [x, y, z];
        for _ in 0..MOST {
            let [x, y, z] = &axes;
            let enters = |axis: &Axis| axis.next - (1.0 - tolerance) * axis.voxel;
            let leaves = |axis: &Axis| axis.next - tolerance * axis.voxel;
            let enter = enters(x).max(enters(y)).max(enters(z)).max(0.0);
            let leave = leaves(x).min(leaves(y)).min(leaves(z));
            // What stands in the far half of a voxel lies behind what was measured.
            let is_before = match is_hit {
                true => enter < length,
                false => 0.5 * (enter + leave) <= length + tolerance,
            };
            if enter <= leave && is_before {
                self.add_at([x, y, z].map(|axis| axis.passed), &axes, false);
            }
            let next = x.next.min(y.next).min(z.next);
            if next >= length {
                break;
            }
            if let Some(axis) = axes.iter_mut().find(|axis| axis.next == next) {
                axis.next += axis.voxel;
                axis.passed += 1;
            }
        }
        if is_hit {
            self.hit(&axes, length, tolerance);
        }
    }

    /// A ray ends at what it has hit: behind the border that the end touches, or, if it touches
    /// none, in the voxel where it ends. If it touches two, the corner says nothing.
    fn hit(&mut self, axes: &[Axis; 3], length: f32, tolerance: f32) {
        let mut touched = 0;
        let passed = axes.each_ref().map(|axis| {
            let end = axis.inside + length / axis.voxel;
            let border = (end + tolerance) as i16;
            if end + tolerance - f32::from(border) > 2.0 * tolerance {
                return end as i16;
            }
            let is_met = border > 0 && axis.voxel * GRAZING < 1.0;
            touched += if is_met { 1 } else { 2 };
            border
        });
        if touched < 2 {
            self.add_at(passed, axes, true);
        }
    }

    /// Adds the voxel behind so many borders of each axis.
    fn add_at(&mut self, passed: [i16; 3], axes: &[Axis; 3], occupied: bool) {
        let Voxel { x, y, z } = self.eye;
        let [i, j, k] = passed;
        let [east, south, up] = axes;
        let voxel = Voxel::new(east.at(x, i), south.at(y, j), up.at(z, k));
        self.add(voxel, occupied);
    }
}

/// A ray along one axis, mirrored so that it goes towards greater numbers.
#[derive(Clone, Copy)]
struct Axis {
    is_back: bool,
    /// Where it begins: voxels from that of the robot, and from the border behind.
    begin: i16,
    inside: f32,
    /// Length of the ray for each voxel along the axis.
    voxel: f32,
    /// Borders that were crossed, and where it crosses the next one.
    passed: i16,
    next: f32,
}

impl Axis {
    fn new(from: f32, slope: f32) -> Self {
        let is_back = slope < 0.0;
        let begin = math::floor(from);
        let inside = match is_back {
            true => 1.0 - (from - begin),
            false => from - begin,
        };
        let voxel = 1.0 / slope.abs().max(FLAT);
        Self {
            is_back,
            begin: begin as i16,
            inside,
            voxel,
            passed: 0,
            next: (1.0 - inside) * voxel,
        }
    }

    /// The place along the axis behind so many borders.
    const fn at(&self, eye: i16, passed: i16) -> i16 {
        let begin = eye.saturating_add(self.begin);
        match self.is_back {
            true => begin.saturating_sub(passed),
            false => begin.saturating_add(passed),
        }
    }
}

#[cfg(test)]
mod tests;
