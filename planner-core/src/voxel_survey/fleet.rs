//! What robots tell each other, and what that means for where they fly.

use heapless::Vec;

use super::{PATIENCE, VoxelSurvey};
use crate::radio::{FrameError, Hearsay, Key, MAX_LEN, VoxelFrame};
use crate::robot::{Activity, RobotId, Status};
use crate::volume::{Voxel, VoxelPatch};

impl<const TW: usize, const TH: usize, const L: usize> VoxelSurvey<TW, TH, L> {
    /// What the robot tells the others about itself.
    pub fn status(&self) -> Status<Voxel> {
        Status {
            position: self.position,
            goal: match self.mission.goal() {
                _ if self.stopped => None,
                None => (!self.way.is_empty()).then_some(self.goal),
                home => home,
            },
            activity: Activity::stopped_if(self.stopped || self.mission.has_errand()),
        }
    }

    /// Takes in what robot `id` told about itself.
    pub fn hear(&mut self, id: RobotId, status: Status<Voxel>) {
        self.peers.hear(id, status);
    }

    /// Whether a rival, or where it goes, is nearer to `pose`, and that counts.
    pub(super) fn is_a_rivals(&self, pose: Voxel) -> bool {
        if self.fruitless > PATIENCE {
            return false;
        }
        let own = pose.distance_squared(self.position);
        let is_nearer = |voxel: Voxel| pose.distance_squared(voxel) < own;
        self.peers.rivals().any(|rival| {
            is_nearer(rival.status.position) || rival.status.goal.is_some_and(is_nearer)
        })
    }

    /// Writes the next frame for the radio and returns its length, or `None` while the
    /// budget allows none: what the robot itself has seen change, round and round and
    /// each piece twice, and every fourth time, or when there is no such thing left,
    /// pieces of its whole map in turn. Call it as often as it gives one, after
    /// [`observe`](Self::observe) and after [`tick`](Self::tick).
    ///
    /// Cost: 256 words for each of at most 11 pieces, and a last time.
    pub fn transmit(&mut self, buffer: &mut [u8; MAX_LEN]) -> Option<usize> {
        if !self.sender.may_send() {
            return None;
        }
        let mut frame = VoxelFrame {
            grid: self.sender.grid,
            sender: self.sender.id,
            sequence: self.sender.sequence,
            status: self.status(),
            patches: Vec::new(),
        };
        self.news.tell(&self.volume, &mut frame);
        let write = |key: Option<&Key>, buffer: &mut _| frame.encode(key, buffer);
        Some(self.sender.send(buffer, write))
    }

    /// Takes in another robot's frame; gives the number of voxels that it brought.
    ///
    /// # Errors
    /// See [`FrameError`]; nothing but [`hearsay`](Self::hearsay) has changed then.
    pub fn receive(&mut self, bytes: &[u8]) -> Result<u32, FrameError> {
        let grid = self.sender.grid;
        let (extent, levels) = (self.volume.extent(), self.volume.levels());
        let read = VoxelFrame::decode(bytes, self.sender.key(), grid, extent, levels);
        let sender = |frame: &VoxelFrame| (frame.sender, frame.sequence);
        let frame = self.sender.admit(bytes, read, sender)?;
        let before = self.volume.known_voxels();
        for patch in &frame.patches {
            self.merge(patch);
            if self.volume.patch(patch.tile, patch.z) == *patch {
                self.news.forget(patch.tile, patch.z);
            }
        }
        self.peers
            .hear_frame(frame.sender, frame.status, frame.sequence);
        Ok(self.volume.known_voxels() - before)
    }

    /// Takes in a piece of another robot's map; says whether it brought anything.
    pub fn merge(&mut self, patch: &VoxelPatch) -> bool {
        let before = self.volume.known_voxels();
        let withdrawn = self.volume.withdrawn();
        let brought = self.volume.merge(patch);
        if self.volume.withdrawn() != withdrawn {
            self.undo(patch.tile, patch.z);
        }
        self.sender
            .hearsay
            .told(self.volume.known_voxels() - before);
        brought
    }

    /// How many voxels of the map others told first, and what was refused.
    /// Contradictions are not counted over voxels.
    pub const fn hearsay(&self) -> Hearsay {
        self.sender.hearsay
    }
}
