//! The dialogue between the simulator, which plays the world and the radio, and
//! the image of one robot, which runs the planner.
//!
//! It is in lock step: the simulator sends a [`Request`], one verb of
//! [`Planner`](planner_core::Planner), and waits for the [`Answer`]; for a robot
//! that flies, a [`SurveyRequest`] and a [`SurveyAnswer`], and among voxels a
//! [`VoxelRequest`] and a [`VoxelAnswer`]. Either goes
//! as [postcard](https://postcard.jamesmunns.com) behind its length in two bytes,
//! little-endian.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

mod message;
mod survey;
mod voxels;
mod wire;

pub use message::{
    Answer, Cost, FrameBytes, Hello, Memory, PlannerConfig, Reply, Request, Rows, STAGED, State,
    Welcome, grid_hash,
};
pub use survey::{
    LOOK, PatchRecord, SEEN, Seen, SurveyAnswer, SurveyReply, SurveyRequest, SurveyorConfig,
    frame_hash, patches_hash, surface_hash,
};
pub use voxels::{
    SEEN_VOXELS, SeenVoxels, VOXEL_LOOK, VoxelAnswer, VoxelReply, VoxelRequest, VoxelState,
    voxels_hash,
};
pub use wire::{Inbox, MAX_MESSAGE, ReadError, decode, encode};

/// Raised whenever a message changes: both sides must be built from one source.
pub const VERSION: u8 = 5;
