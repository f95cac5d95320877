//! What a pose would show.

use core::ops::ControlFlow;

use super::VoxelSurvey;
use crate::tile::{TileIndex, bits};
use crate::volume::{View, Voxel};

impl<const TW: usize, const TH: usize, const L: usize> VoxelSurvey<TW, TH, L> {
    /// Number of unknown voxels in sight of `pose` where unknown voxels do not block
    /// sight, at most `enough`. At 0 the pose is done.
    ///
    /// Cost: every tile of a level within range; a view, and its rays, if something there is
    /// unknown.
    pub(super) fn gain(&mut self, pose: Voxel, enough: u32) -> u32 {
        let gain = self.count(pose, enough);
        if gain == 0 {
            self.finish(pose);
        }
        gain
    }

    // Not in line: one view at a time is on the stack.
    #[inline(never)]
    fn count(&mut self, pose: Voxel, enough: u32) -> u32 {
        let volume = &self.volume;
        let mut view = View::new(pose, self.range);
        let mut gain = 0u32;
        if view.aim(|tile, z| volume.unknown(tile, z)) {
            let _ = view.look(
                |tile, z| volume.occupied(tile, z),
                |tile, z| volume.unknown(tile, z),
                |row| {
                    gain = gain.saturating_add(row.count());
                    if gain < enough {
                        ControlFlow::Continue(())
                    } else {
                        ControlFlow::Break(())
                    }
                },
            );
        }
        self.work = self.work.saturating_add(view.work);
        gain.min(enough)
    }

    /// Notes the voxels that the look from here should have shown and did not: unknown
    /// ones beside a free one, in sight over free ones alone.
    ///
    /// Cost: 28 words for every tile of a level within range, and a view if any is new.
    pub(super) fn note_missed(&mut self) {
        let (volume, missed) = (&self.volume, &mut self.missed);
        let unknown = |tile, z| volume.unknown_beside_free(tile, z);
        let mut view = View::new(self.position, self.range);
        if !view.aim(|tile, z| unknown(tile, z) & !missed.word(tile, z)) {
            return;
        }
        let _ = view.look(
            |tile, z| volume.bad(tile, z),
            unknown,
            |row| {
                self.has_missed = true;
                row.voxels().for_each(|voxel| missed.set(voxel));
                ControlFlow::Continue(())
            },
        );
    }
}

/// The voxels of a tile of a level whose bits are set.
pub(super) fn voxels(tile: TileIndex, z: u8, word: u64) -> impl Iterator<Item = Voxel> {
    bits(word).map(move |bit| Voxel::of(tile, z, bit))
}
