//! What the two sides say of a robot that flies among voxels.
//!
//! It begins with [`Request::Voxels`](crate::Request::Voxels); after that the simulator
//! sends [`VoxelRequest`]s, and the image a [`VoxelAnswer`] to each.

use heapless::Vec;
use planner_core::radio::FrameError;
use planner_core::tile::TileIndex;
use planner_core::volume::{Heading, Voxel, VoxelPatch};
use planner_core::{Action, RobotId, Status};
use serde::{Deserialize, Serialize};

use crate::survey::{SEED, eat, folded};
use crate::{Answer, FrameBytes, Memory};

/// Voxels of one [`VoxelRequest::Look`] at most.
pub const VOXEL_LOOK: usize = 56;

/// Voxels that a robot sees in one step at most: those within the longest range.
pub const SEEN_VOXELS: usize = 7153;

/// Everything that a robot sees in one step, each with whether it is occupied.
pub type SeenVoxels = Vec<(Voxel, bool), SEEN_VOXELS>;

/// A call of [`VoxelSurvey`](planner_core::voxel_survey::VoxelSurvey), or something about it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[expect(
    clippy::large_enum_variant,
    reason = "there is one at a time, and no heap on the chip"
)]
pub enum VoxelRequest<'a> {
    /// Puts voxels aside for [`Observe`](Self::Observe); [`VoxelReply::Done`].
    Look(Vec<(Voxel, bool), VOXEL_LOOK>),
    /// From here, with its sensor turned there, the robot sees the voxels put aside;
    /// [`VoxelReply::Done`].
    Observe(Voxel, Heading),
    /// [`VoxelReply::Decided`].
    Tick,
    /// Somebody else decides in this step; [`VoxelReply::Done`].
    Pass,
    /// Tries again what was given up; [`VoxelReply::Done`].
    Resume,
    /// Ticks that the robot's energy lasts for from now on; [`VoxelReply::Done`].
    Energy(u32),
    /// [`VoxelReply::Frame`].
    Transmit,
    /// A frame; [`VoxelReply::Heard`].
    #[serde(borrow)]
    Receive(&'a [u8]),
    /// What another robot told about itself; [`VoxelReply::Done`].
    Hear(RobotId, Status<Voxel>),
    /// A piece of another robot's map; [`VoxelReply::Done`].
    Merge {
        /// Which tile.
        tile: TileIndex,
        /// Of which level.
        z: u8,
        /// Known voxels, a bit each.
        known: u64,
        /// Occupied voxels.
        occupied: u64,
    },
    /// [`VoxelReply::Memory`].
    Memory,
    /// The image ends, without an answer.
    End,
}

impl From<VoxelPatch> for VoxelRequest<'_> {
    fn from(patch: VoxelPatch) -> Self {
        let VoxelPatch {
            tile,
            z,
            known,
            occupied,
        } = patch;
        Self::Merge {
            tile,
            z,
            known,
            occupied,
        }
    }
}

/// What the image answers to any other request.
pub type VoxelAnswer = Answer<VoxelState, VoxelReply>;

/// What has become of the planner.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct VoxelState {
    /// What the robot would tell the others.
    pub status: Status<Voxel>,
    /// Where it wants its sensor to be turned.
    pub heading: Heading,
}

/// What a call returned.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum VoxelReply {
    /// Nothing to say.
    Done,
    /// What was decided, and by what.
    Decided {
        /// What to do.
        action: Action<Voxel, Voxel>,
        /// Work of the decision.
        work: u32,
        /// [`voxels_hash`] of the map.
        map: u32,
    },
    /// The next frame for the radio, if there is one.
    Frame(Option<FrameBytes>),
    /// What a frame brought.
    Heard(Result<u32, FrameError>),
    /// What the image takes.
    Memory(Memory),
}

/// A number that tells maps apart, over the words of all tiles of all levels: `patch` gives
/// one, `after` says which is next, and after the last comes the first. Two maps of different
/// compiled sizes with the same voxels have the same one.
pub fn voxels_hash(
    patch: impl Fn(TileIndex, u8) -> VoxelPatch,
    after: impl Fn(TileIndex, u8) -> (TileIndex, u8),
) -> u32 {
    let first = (TileIndex::new(0, 0), 0);
    let (mut at, mut hash) = (first, SEED);
    loop {
        let VoxelPatch {
            known, occupied, ..
        } = patch(at.0, at.1);
        hash = eat(eat(hash, known), occupied);
        at = after(at.0, at.1);
        if at == first {
            return folded(hash);
        }
    }
}

#[cfg(test)]
mod tests {
    use planner_core::Extent;
    use planner_core::volume::Volume;
    use planner_core::voxel_survey::MAX_RANGE;

    use super::*;
    use crate::{MAX_MESSAGE, decode, encode};

    #[test]
    fn there_is_room_for_the_longest_range() {
        let reach = i16::from(MAX_RANGE);
        let (eye, most) = (Voxel::new(0, 0, 0), u32::from(MAX_RANGE).pow(2));
        let along = || -reach..=reach;
        let ball = along().flat_map(|z| along().flat_map(move |y| along().map(move |x| (x, y, z))));
        let seen = ball.filter(|&(x, y, z)| Voxel::new(x, y, z).distance_squared(eye) <= most);
        assert_eq!(seen.count(), SEEN_VOXELS);
    }

    #[test]
    fn the_longest_look_fits_in_a_message() {
        let far = (Voxel::new(i16::MIN, i16::MAX, i16::MIN), true);
        let look = VoxelRequest::Look([far; VOXEL_LOOK].into_iter().collect());
        let mut buffer = [0; MAX_MESSAGE];
        let bytes = encode(&look, &mut buffer).unwrap();
        assert_eq!(decode::<VoxelRequest<'_>>(&bytes[2..]).unwrap(), look);
    }

    fn hash<const T: usize, const L: usize>(volume: &Volume<T, T, L>) -> u32 {
        voxels_hash(
            |tile, z| volume.patch(tile, z),
            |tile, z| volume.after(tile, z),
        )
    }

    #[test]
    fn a_fingerprint_sees_every_voxel_and_not_the_compiled_size() {
        let extent = Extent::new(9, 17);
        let mut small = Volume::<3, 3, 4>::new(extent, 4).unwrap();
        let mut large = Volume::<8, 8, 24>::new(extent, 4).unwrap();
        let mut seen = std::collections::HashSet::from([hash(&small)]);
        for (x, y) in (0..9).flat_map(|x| (0..17).map(move |y| (x, y))) {
            for (z, occupied) in (0..4).flat_map(|z| [(z, false), (z, true)]) {
                small.learn(Voxel::new(x, y, z), occupied);
                large.learn(Voxel::new(x, y, z), occupied);
                assert_eq!(hash(&small), hash(&large));
                assert!(seen.insert(hash(&small)), "the same after {x},{y},{z}");
            }
        }
    }
}
