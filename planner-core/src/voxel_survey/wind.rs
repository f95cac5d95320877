//! What a robot does that was pushed.

use heapless::Vec;

use super::VoxelSurvey;
use super::near::{POSES, Place};
use crate::robot::{Action, Stop};
use crate::volume::Voxel;

/// Pushes without progress after which the robot gives up.
const PUSHES: u16 = 4096;

impl<const TW: usize, const TH: usize, const L: usize> VoxelSurvey<TW, TH, L> {
    /// Gives up, or flies back to a pose; `None`: the robot is at one, or none is known near by.
    pub(super) fn mind_wind(&mut self) -> Option<Action<Voxel, Voxel>> {
        if !self.is_adrift {
            return None;
        }
        if self.fruitless == 0 || self.volume.age() != self.last_known {
            self.pushes = 0;
        }
        if self.pushes >= PUSHES {
            return Some(self.stop(Stop::Blocked {
                frontiers: self.volume.frontiers(),
                at: self.position,
            }));
        }
        let here = self.position;
        if self.volume.is_pose(here, self.clearance) {
            self.is_adrift = false;
            return None;
        }
        let next = self.fly_to_a_pose()?;
        // No progress, until something is learnt or done with.
        self.fruitless = self.fruitless.saturating_add(1);
        self.last_known = self.volume.age();
        Some(Action::Move(next))
    }

    /// The first step to the nearest pose, over free voxels.
    #[inline(never)]
    fn fly_to_a_pose(&mut self) -> Option<Voxel> {
        let here = self.position;
        let mut places: Vec<Place, POSES> = Vec::new();
        self.find_places(&mut places, 0);
        let is_pose = |place: &&Place| self.volume.is_pose(place.at(here), self.clearance);
        let mut place = *places.iter().find(is_pose)?;
        for _ in 0..POSES {
            match places.get(usize::from(place.before)) {
                Some(before) if before.steps > 0 => place = *before,
                _ => break,
            }
        }
        Some(place.at(here))
    }
}
