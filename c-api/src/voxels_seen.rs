//! From metres, zones and rays to what a look among voxels shows.

use planner_core::sight::{RangeSensor, ScanError, Zone, ZoneSensor};
use planner_core::volume::{Field, Heading, Ray, Vector, Voxel, VoxelLook, VoxelPose};

use crate::answer;
use crate::place::{input, inputs, output};
use crate::types::PlannerResult;
use crate::voxels::{PlannerVoxel, PlannerVoxelConfig, PlannerVoxelField, PlannerVoxelSeen};
use crate::zones::{PLANNER_ZONES, PlannerZone, PlannerZoneSensor};

/// Voxels that a sensor with 8×8 zones shows at most: 24 for each zone, and the robot's own.
pub const PLANNER_VOXEL_ZONES_SEEN: usize = 1537;

/// Where a flying robot is, in voxels: the voxel x,y,z covers x to x + 1, y to y + 1 and z to
/// z + 1.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlannerVoxelPose {
    /// Position along x, in voxels.
    pub x: f32,
    /// Position along y, in voxels.
    pub y: f32,
    /// Height above the bottom of the lowest level, in voxels.
    pub z: f32,
    /// Where the robot is turned, in radians; grows from east to south.
    pub heading: f32,
}

impl From<PlannerVoxelPose> for VoxelPose {
    fn from(PlannerVoxelPose { x, y, z, heading }: PlannerVoxelPose) -> Self {
        Self { x, y, z, heading }
    }
}

impl From<VoxelPose> for PlannerVoxelPose {
    fn from(VoxelPose { x, y, z, heading }: VoxelPose) -> Self {
        Self { x, y, z, heading }
    }
}

/// A vector in the frame of a robot that is level.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PlannerVector {
    /// Its part along the heading.
    pub ahead: f32,
    /// Its part to the right of that.
    pub right: f32,
    /// Its part upwards.
    pub up: f32,
}

impl From<PlannerVector> for Vector {
    fn from(PlannerVector { ahead, right, up }: PlannerVector) -> Self {
        Self { ahead, right, up }
    }
}

/// One distance measured, by a range finder or a point of a depth image.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PlannerRay {
    /// Where the sensor sits, from the robot's middle, in voxels: less than one away.
    pub from: PlannerVector,
    /// Where it points to: a vector of length 1. With another length, by more than 0.001, the
    /// ray says nothing.
    pub direction: PlannerVector,
    /// Distance to what was hit, in voxels, as of `PlannerBeam`.
    pub range: f32,
}

impl From<&PlannerRay> for Ray {
    fn from(ray: &PlannerRay) -> Self {
        Self {
            from: ray.from.into(),
            direction: ray.direction.into(),
            range: ray.range,
        }
    }
}

impl PlannerVoxelConfig {
    /// Where its frame begins, and the side of a voxel.
    fn grid(&self) -> Result<((i32, i32), u16), PlannerResult> {
        match self.cell_mm {
            0 => Err(PlannerResult::CellSize),
            cell_mm => Ok(((self.origin_x_mm, self.origin_y_mm), cell_mm)),
        }
    }

    fn contains(&self, Voxel { x, y, z }: Voxel) -> bool {
        let is_in = |at: i16, side: u16| u16::try_from(at).is_ok_and(|at| at < side);
        is_in(x, self.width) && is_in(y, self.depth) && is_in(z, self.levels.into())
    }
}

/// The pose of a robot at `x`, `y`, `z` in metres, y to the left of x and z above the bottom of
/// the lowest level, whose `yaw` in radians grows counter-clockwise from x: the frame of ROS and
/// of the Crazyflie. `PLANNER_RESULT_CELL_SIZE`: the configuration's `cell_mm` is 0.
///
/// Stack: 128 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_voxel_pose_from_metres(
    config: *const PlannerVoxelConfig,
    x: f32,
    y: f32,
    z: f32,
    yaw: f32,
    pose: *mut PlannerVoxelPose,
) -> PlannerResult {
    answer(|| {
        let (origin_mm, cell_mm) = input(config)?.grid()?;
        let made = VoxelPose::from_metres(x, y, z, yaw, origin_mm, cell_mm);
        output(pose)?.write(made.into());
        Ok(())
    })
}

/// The voxel that a pose is in, and the nearest of the eight headings, for
/// `planner_voxel_observe`. `PLANNER_RESULT_OFF_GRID`: the pose is not in the box, or not
/// finite, and nothing is written.
///
/// Stack: 128 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_voxel_at(
    config: *const PlannerVoxelConfig,
    pose: *const PlannerVoxelPose,
    at: *mut PlannerVoxel,
    heading: *mut u8,
) -> PlannerResult {
    answer(|| {
        let config = input(config)?;
        let pose = VoxelPose::from(*input(pose)?);
        let (at, heading) = (output(at)?, output(heading)?);
        let voxel = pose.voxel().filter(|&voxel| config.contains(voxel));
        let (Some(voxel), Some(turned)) = (voxel, pose.heading()) else {
            return Err(PlannerResult::OffGrid);
        };
        at.write(voxel.into());
        heading.write(turned.eighths());
        Ok(())
    })
}

/// The middle of a voxel in the frame of `planner_voxel_pose_from_metres`, in metres: where to
/// fly for a move to that voxel.
///
/// Stack: 128 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_voxel_middle_in_metres(
    config: *const PlannerVoxelConfig,
    voxel: PlannerVoxel,
    x: *mut f32,
    y: *mut f32,
    z: *mut f32,
) -> PlannerResult {
    answer(|| {
        let (origin_mm, cell_mm) = input(config)?.grid()?;
        let (x, y, z) = (output(x)?, output(y)?, output(z)?);
        let middle = Voxel::from(voxel).middle_in_metres(origin_mm, cell_mm);
        x.write(middle.0);
        y.write(middle.1);
        z.write(middle.2);
        Ok(())
    })
}

/// A heading of `PlannerVoxelAction`, in eighths of a turn, as a yaw in radians,
/// counter-clockwise from the east.
///
/// Stack: 128 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_voxel_yaw(heading: u8) -> f32 {
    Heading::new(heading).yaw()
}

/// Makes the field of a configuration `PLANNER_VOXEL_FIELD_CUSTOM`, of a sensor that shows so
/// far up and down, and `side` to each side, in radians, 0 to pi/2; pi/2 up or down is all of
/// it, and a `side` of 0 all round. pi/8 three times for a VL53L5CX that points ahead. `near`
/// stays as it is. `PLANNER_RESULT_SENSOR`: there is no such angle, and nothing has changed.
///
/// Stack: 384 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_voxel_set_field(
    config: *mut PlannerVoxelConfig,
    up: f32,
    down: f32,
    side: f32,
) -> PlannerResult {
    answer(|| {
        let mut changed = *input(config)?;
        let is_angle = |angle: &f32| (0.0..=core::f32::consts::FRAC_PI_2 + 1e-6).contains(angle);
        if ![up, down, side].iter().all(is_angle) {
            return Err(PlannerResult::Sensor);
        }
        let side = (side > 0.0).then_some(side);
        let field = Field::of_angles(up, down, side, changed.near);
        changed.field = PlannerVoxelField::Custom as u8;
        changed.up = field.up;
        changed.down = field.down;
        changed.side = field.side.unwrap_or(0);
        output(config)?.write(changed);
        Ok(())
    })
}

/// A look that sensors are added to, one after the other, for `planner_voxel_observe`.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PlannerVoxelLook {
    /// Memory of yours: an array of voxels.
    pub seen: *mut PlannerVoxelSeen,
    /// How many it has room for. 24 for each zone or ray, and one for the robot's own voxel,
    /// always suffice: [`PLANNER_VOXEL_ZONES_SEEN`] for a sensor with 8×8 zones.
    pub room: usize,
    /// How many of them are in the look: 0 before the first sensor.
    pub count: usize,
}

/// Adds the voxels to a look that a sensor with 8×8 zones shows: those that the middle line of a
/// zone passes are free, the one that it ends in, or at the face of, is occupied, what is behind
/// stays unknown; a zone without a target shows free voxels alone, up to `max_range_mm` or the
/// range of the configuration. A voxel that one zone hits and another passes is occupied. In the
/// look each voxel is once, the robot's own is one of them, and what lies more than
/// `PLANNER_VOXEL_MAX_RANGE` away along an axis is dropped. `PLANNER_RESULT_TOO_MANY`: there is
/// no room for all. `PLANNER_RESULT_SCAN`: the pose is not finite, or the tolerance not 0 to 0.25.
/// After any result but `PLANNER_RESULT_OK` the look is as it was.
///
/// `zones` are those of `planner_zone_beams`. Of `sensor` the heights and `cell_mm` are not
/// read, and the pitch may be -pi/2 to pi/2: straight down to straight up. It sits `ahead_mm`
/// from the robot's middle along its axis. `tolerance`: as of `planner_observe_scan`, in voxels.
/// What is passed within it of a face, and what is hit in a corner, is left out: of the voxels
/// in sight a look misses some, which others show.
///
/// Work: 10 sines and cosines, at most 39 voxels for each zone, and 1,250 words.
///
/// Stack: 8960 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_voxel_zones(
    config: *const PlannerVoxelConfig,
    pose: *const PlannerVoxelPose,
    sensor: *const PlannerZoneSensor,
    tolerance: f32,
    zones: *const PlannerZone,
    look: *mut PlannerVoxelLook,
) -> PlannerResult {
    answer(|| {
        let (_, cell_mm) = input(config)?.grid()?;
        let sensor = ZoneSensor {
            cell_mm,
            ..ZoneSensor::from(input(sensor)?)
        };
        let zones = input(zones.cast::<[PlannerZone; PLANNER_ZONES]>())?;
        let rays = sensor.rays()?;
        let zones = zones.map(|zone| Zone::from_vl53(zone.status, zone.distance_mm));
        add(
            config,
            pose,
            rays.sensor(tolerance),
            rays.read(&zones),
            look,
        )
    })
}

/// The same for other sensors: the points of a depth image, or single range finders, as those
/// that tell what is beside, above and behind the robot. `max_range`: distance in voxels, above
/// 0, up to which every obstacle gives a measurement.
///
/// Stack: 8320 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn planner_voxel_rays(
    config: *const PlannerVoxelConfig,
    pose: *const PlannerVoxelPose,
    max_range: f32,
    tolerance: f32,
    rays: *const PlannerRay,
    count: usize,
    look: *mut PlannerVoxelLook,
) -> PlannerResult {
    answer(|| {
        let sensor = RangeSensor {
            max_range,
            tolerance,
        };
        let rays = inputs(rays, count)?.iter().map(Ray::from);
        add(config, pose, sensor, rays, look)
    })
}

fn add(
    config: *const PlannerVoxelConfig,
    pose: *const PlannerVoxelPose,
    sensor: RangeSensor,
    rays: impl IntoIterator<Item = Ray>,
    look: *mut PlannerVoxelLook,
) -> Result<(), PlannerResult> {
    let range = input(config)?.range;
    let pose = VoxelPose::from(*input(pose)?);
    let mut told = *input(look)?;
    let mut made = VoxelLook::vacant();
    made.begin(pose, range)?;
    if told.count > told.room {
        return Err(PlannerResult::TooMany);
    }
    for seen in inputs(told.seen, told.count)? {
        made.add(seen.voxel.into(), seen.occupied != 0);
    }
    made.see(sensor, rays)?;
    told.count = made.seen().count();
    if told.count > told.room {
        return Err(PlannerResult::TooMany);
    }
    for (number, (voxel, occupied)) in made.seen().enumerate() {
        output(told.seen.wrapping_add(number))?.write(PlannerVoxelSeen {
            voxel: voxel.into(),
            occupied: occupied.into(),
        });
    }
    output(look)?.write(told);
    Ok(())
}

impl From<ScanError> for PlannerResult {
    fn from(error: ScanError) -> Self {
        match error {
            ScanError::Pose | ScanError::MaxRange | ScanError::Tolerance => Self::Scan,
        }
    }
}
