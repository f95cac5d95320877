//! How a robot among voxels is set up.

use super::Sensor;
use crate::radio::LinkConfig;
use crate::volume::Field;

/// What a fleet agrees on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Config {
    /// Sensor range in voxels, 2 to [`MAX_RANGE`](super::MAX_RANGE) and one more than the
    /// clearance at least; others are brought into these bounds.
    pub range: u8,
    /// How far the body of a robot reaches beyond the voxel of its middle, 0 to
    /// [`MAX_CLEARANCE`](crate::volume::MAX_CLEARANCE); more counts as that. With 0 it stays in
    /// its voxel, with 1 those that share a face with it are kept free, then all within so many
    /// voxels. A ball of 0.5, 0.70, 1.58 and 2.54 voxels' radius touches nothing.
    pub clearance: u8,
    /// What of that the sensors show; of a clearance of 2 or 3 [`Field::for_body`].
    pub field: Field,
    /// Whether they err.
    pub sensor: Sensor,
    /// Whether a robot that has surveyed all flies home, to where it started, before it stops.
    pub come_home: bool,
    /// Ticks in the air that the robot's energy lasts for, as by
    /// [`energy`](super::VoxelSurvey::energy) at the start; 0: no limit.
    pub energy: u32,
    /// How the robots use the radio. Its origin is that of the lowest level.
    pub link: LinkConfig,
}

impl Config {
    /// A range of 8 voxels all round, and a voxel kept clear.
    pub const fn new() -> Self {
        Self {
            range: 8,
            clearance: 1,
            field: Field::ALL_ROUND,
            sensor: Sensor::Truthful,
            come_home: false,
            energy: 0,
            link: LinkConfig::new(),
        }
    }
}

impl Default for Config {
    fn default() -> Self {
        Self::new()
    }
}
