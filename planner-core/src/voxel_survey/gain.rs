//! What a pose would show.

use super::VoxelSurvey;
use crate::surface::{Bits, Tile};
use crate::volume::{Content, Voxel, in_sight};

/// Words that a ray looks at, about.
pub(super) const RAY: u32 = 16;

impl<const TW: usize, const TH: usize, const L: usize> VoxelSurvey<TW, TH, L> {
    /// Number of unknown voxels in sight of `pose` where unknown voxels do not block
    /// sight, at most `enough`. At 0 the pose is done.
    ///
    /// Cost: every tile of a level within range, and a ray for each unknown voxel until
    /// there are enough.
    pub(super) fn gain(&mut self, pose: Voxel, enough: u32) -> u32 {
        let gain = self.count(pose, enough);
        if gain == 0 {
            self.done.set(pose);
        }
        gain
    }

    fn count(&mut self, pose: Voxel, enough: u32) -> u32 {
        let reach = i16::from(self.range);
        let range = u32::from(self.range) * u32::from(self.range);
        let span = |at: i16, end: i16| {
            let last = at.saturating_add(reach).min(end.saturating_sub(1));
            at.saturating_sub(reach).max(0)..=last
        };
        let extent = self.volume.extent();
        let tiles = |at: i16, end: u16| {
            let cells = span(at, end as i16);
            (cells.start() >> 3) as u8..=(cells.end() >> 3) as u8
        };
        let mut gain = 0;
        for z in span(pose.z, self.volume.levels().into()) {
            for y in tiles(pose.y, extent.height) {
                for x in tiles(pose.x, extent.width) {
                    let tile = Tile { x, y };
                    self.work = self.work.saturating_add(1);
                    for bit in Bits(self.volume.unknown(tile, z as u8)) {
                        let cell = tile.cell(bit);
                        let voxel = Voxel::new(cell.x, cell.y, z);
                        if pose.distance_squared(voxel) > range {
                            continue;
                        }
                        self.work = self.work.saturating_add(RAY);
                        let is_clear = |at| self.volume.content(at) != Content::Occupied;
                        gain += u32::from(in_sight(pose, voxel, is_clear));
                        if gain >= enough {
                            return gain;
                        }
                    }
                }
            }
        }
        gain
    }
}
