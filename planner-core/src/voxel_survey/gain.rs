//! What a pose would show.

use super::VoxelSurvey;
use crate::volume::{Content, Voxel, in_sight};

/// Unknown voxels in sight that are counted.
const ENOUGH: u32 = 64;

impl<const TW: usize, const TH: usize, const L: usize> VoxelSurvey<TW, TH, L> {
    /// Number of unknown voxels in sight of `pose` where unknown voxels do not block
    /// sight, at most 64. At 0 the pose is done.
    ///
    /// Cost: every voxel within range, and a ray for each unknown one until there are
    /// enough.
    pub(super) fn gain(&mut self, pose: Voxel) -> u32 {
        let reach = i16::from(self.range);
        let range = u32::from(self.range) * u32::from(self.range);
        let (mut gain, mut work) = (0, 0u32);
        'count: for dz in -reach..=reach {
            for dy in -reach..=reach {
                for dx in -reach..=reach {
                    let voxel = Voxel::new(
                        pose.x.saturating_add(dx),
                        pose.y.saturating_add(dy),
                        pose.z.saturating_add(dz),
                    );
                    if pose.distance_squared(voxel) > range
                        || self.volume.content(voxel) != Content::Unknown
                    {
                        continue;
                    }
                    work += 1;
                    if in_sight(pose, voxel, |at| {
                        self.volume.content(at) != Content::Occupied
                    }) {
                        gain += 1;
                    }
                    if gain >= ENOUGH {
                        break 'count;
                    }
                }
            }
        }
        self.work = self.work.saturating_add(work);
        if gain == 0 {
            self.done.set(pose);
        }
        gain
    }
}
