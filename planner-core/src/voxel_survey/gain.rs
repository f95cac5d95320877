//! What a pose would show.

use super::VoxelSurvey;
use crate::tile::{TileIndex, bits};
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
            self.finish(pose);
        }
        gain
    }

    fn count(&mut self, pose: Voxel, enough: u32) -> u32 {
        let mut gain = 0u32;
        for (tile, z) in self.words_within_range(pose) {
            self.work = self.work.saturating_add(1);
            for voxel in voxels(tile, z, self.volume.unknown(tile, z)) {
                if !self.is_in_range(pose, voxel) {
                    continue;
                }
                self.work = self.work.saturating_add(RAY);
                let is_clear = |at| self.volume.content(at) != Content::Occupied;
                gain = gain.saturating_add(in_sight(pose, voxel, is_clear).into());
                if gain >= enough {
                    return gain;
                }
            }
        }
        gain
    }

    /// Notes the voxels that the look from here should have shown and did not: unknown
    /// ones beside a free one, in sight over free ones alone.
    ///
    /// Cost: 14 words for every tile of a level within range, and a ray for each unknown
    /// voxel beside a free one there.
    pub(super) fn note_missed(&mut self) {
        let here = self.position;
        for (tile, z) in self.words_within_range(here) {
            let unknown = self.volume.unknown_beside_free(tile, z);
            for voxel in voxels(tile, z, unknown & !self.missed.word(tile, z)) {
                let is_clear = |at| self.volume.content(at) == Content::Free;
                if self.is_in_range(here, voxel) && in_sight(here, voxel, is_clear) {
                    self.missed.set(voxel);
                    self.has_missed = true;
                }
            }
        }
    }

    fn is_in_range(&self, pose: Voxel, voxel: Voxel) -> bool {
        pose.distance_squared(voxel) <= u32::from(self.range) * u32::from(self.range)
    }

    /// The tiles of levels that have a voxel within range of `pose`, and a few more.
    fn words_within_range(
        &self,
        pose: Voxel,
    ) -> impl Iterator<Item = (TileIndex, u8)> + use<TW, TH, L> {
        let reach = i16::from(self.range);
        let span = move |at: i16, end: i16| {
            let last = at.saturating_add(reach).min(end.saturating_sub(1));
            at.saturating_sub(reach).max(0)..=last
        };
        let tiles = move |at: i16, end: u16| {
            let cells = span(at, end as i16);
            (cells.start() >> 3) as u8..=(cells.end() >> 3) as u8
        };
        let extent = self.volume.extent();
        span(pose.z, self.volume.levels().into()).flat_map(move |z| {
            tiles(pose.y, extent.height).flat_map(move |y| {
                tiles(pose.x, extent.width).map(move |x| (TileIndex { x, y }, z as u8))
            })
        })
    }
}

/// The voxels of a tile of a level whose bits are set.
pub(super) fn voxels(tile: TileIndex, z: u8, word: u64) -> impl Iterator<Item = Voxel> {
    bits(word).map(move |bit| Voxel::of(tile, z, bit))
}
