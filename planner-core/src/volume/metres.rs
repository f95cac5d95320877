//! From the units of the world to voxels, and back: as [`Pose`](crate::sight::Pose) on a grid,
//! with z up.

use super::{Heading, Voxel};
use crate::math;

/// Where a flying robot is, in voxels: the voxel `(x, y, z)` covers `[x, x + 1)` and so on.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct VoxelPose {
    /// Position along x.
    pub x: f32,
    /// Position along y.
    pub y: f32,
    /// Height above the bottom of the lowest level.
    pub z: f32,
    /// Where the robot is turned, in radians; grows from east to south.
    pub heading: f32,
}

impl VoxelPose {
    /// The pose of a robot at `x`, `y`, `z` in metres, `y` to the left of `x` and `z` above the
    /// bottom of the lowest level, whose `yaw` in radians grows counter-clockwise from x.
    /// `origin_mm` and `cell_mm` are those of the [`LinkConfig`](crate::radio::LinkConfig): see
    /// [`Pose::from_metres`](crate::sight::Pose::from_metres).
    pub fn from_metres(
        x: f32,
        y: f32,
        z: f32,
        yaw: f32,
        origin_mm: (i32, i32),
        cell_mm: u16,
    ) -> Self {
        let plan = crate::sight::Pose::from_metres(x, y, yaw, origin_mm, cell_mm);
        Self {
            x: plan.x,
            y: plan.y,
            z: z * 1000.0 / f32::from(cell_mm),
            heading: plan.heading,
        }
    }

    /// The voxel that the robot is in; `None` if the pose is not finite, or beyond all voxels.
    /// Whether it is in a box, [`Volume::contains`](super::Volume::contains) tells.
    pub fn voxel(&self) -> Option<Voxel> {
        let along = |at: f32| {
            let at = math::floor(at);
            let is_there = at >= f32::from(i16::MIN) && at <= f32::from(i16::MAX);
            is_there.then_some(at as i16)
        };
        Some(Voxel::new(along(self.x)?, along(self.y)?, along(self.z)?))
    }

    /// The nearest of the eight headings; `None` if that of the pose is not finite.
    pub fn heading(&self) -> Option<Heading> {
        let eighths = self.heading / core::f32::consts::FRAC_PI_4;
        let nearest = math::floor(eighths + 0.5);
        (nearest.abs() < 1e6).then(|| Heading::new((nearest as i32).rem_euclid(8) as u8))
    }
}

impl Voxel {
    /// Its middle in the frame of [`VoxelPose::from_metres`], in metres: where a robot flies that
    /// is sent there.
    pub fn middle_in_metres(self, origin_mm: (i32, i32), cell_mm: u16) -> (f32, f32, f32) {
        let (x, y) = self.cell().middle_in_metres(origin_mm, cell_mm);
        let z = (f32::from(self.z) + 0.5) * f32::from(cell_mm) / 1000.0;
        (x, y, z)
    }
}

impl Heading {
    /// As a yaw in radians, counter-clockwise from the east, above -π and up to π.
    pub const fn yaw(self) -> f32 {
        let eighths = match self.eighths() {
            south @ 0..=3 => -(south as f32),
            north => 8.0 - north as f32,
        };
        eighths * core::f32::consts::FRAC_PI_4
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// There and back; and what is no place.
    #[test]
    fn middles_are_in_their_voxels() {
        let (origin_mm, cell_mm) = ((-3500, 4250), 250);
        for voxel in [
            Voxel::new(0, 0, 0),
            Voxel::new(13, 7, 5),
            Voxel::new(-3, 39, -1),
        ] {
            let (x, y, z) = voxel.middle_in_metres(origin_mm, cell_mm);
            for eighths in 0..8 {
                let heading = Heading::new(eighths);
                for off in [-0.3, 0.0, 0.3, 6.3] {
                    let yaw = heading.yaw() + off;
                    let pose = VoxelPose::from_metres(x, y, z, yaw, origin_mm, cell_mm);
                    assert_eq!(pose.voxel(), Some(voxel));
                    assert_eq!(pose.heading(), Some(heading));
                }
            }
        }
        let pose = VoxelPose::from_metres(-3.5, 4.25, 0.0, 0.0, origin_mm, cell_mm);
        assert_eq!((pose.x, pose.y, pose.z), (0.0, 0.0, 0.0));
        for x in [f32::NAN, f32::INFINITY, 1e9] {
            assert_eq!(VoxelPose { x, ..pose }.voxel(), None);
            assert_eq!(VoxelPose { z: -x, ..pose }.voxel(), None);
            assert_eq!(VoxelPose { heading: x, ..pose }.heading(), None);
        }
        assert_eq!(
            VoxelPose::from_metres(1.0, 1.0, 1.0, 0.0, origin_mm, 0).voxel(),
            None
        );
    }
}
