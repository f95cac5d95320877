//! What the two sides say of a robot that flies.
//!
//! It begins with [`Request::Survey`](crate::Request::Survey); after that the
//! simulator sends [`SurveyRequest`]s, and the image a [`SurveyAnswer`] to each.

use heapless::Vec;
use planner_core::radio::{FrameError, LinkConfig};
use planner_core::surface::{Column, Height, Patch, Surface};
use planner_core::survey::Knowledge;
use planner_core::tile::{TileIndex, bits};
use planner_core::{Action, Cell, Motion, Point, RobotId, Status, Wait, coordinated_survey, fcao};
use serde::{Deserialize, Serialize};

use crate::{Answer, Memory};

/// Columns of one [`SurveyRequest::Look`] at most.
pub const LOOK: usize = 64;

/// Columns that a robot sees in one step at most: those within the longest range.
pub const SEEN: usize = 512;

/// Everything that a robot sees in one step.
pub type Seen = Vec<Column, SEEN>;

/// Which planner decides, and how.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum SurveyorConfig {
    /// FCAO as published.
    Fcao(fcao::Config),
    /// Its coordinated successor.
    Coordinated(coordinated_survey::Config),
}

impl SurveyorConfig {
    /// How the robot uses the radio.
    pub const fn link(&self) -> &LinkConfig {
        match self {
            Self::Fcao(config) => &config.link,
            Self::Coordinated(config) => &config.link,
        }
    }
}

/// A verb of [`Surveyor`](planner_core::survey::Surveyor), or something about it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[expect(
    clippy::large_enum_variant,
    reason = "there is one at a time, and no heap on the chip"
)]
pub enum SurveyRequest<'a> {
    /// Puts columns aside for [`Observe`](Self::Observe); [`SurveyReply::Done`].
    Look(Vec<Column, LOOK>),
    /// From here the robot sees the columns put aside; [`SurveyReply::Told`].
    Observe(Point),
    /// What another robot told about itself; [`SurveyReply::Done`].
    Hear(RobotId, Status<Point, Cell>),
    /// A piece of another robot's map; [`SurveyReply::Done`].
    #[serde(borrow)]
    Merge(PatchRecord<'a>),
    /// [`SurveyReply::Decided`].
    Tick,
    /// Tries again what was given up; [`SurveyReply::Done`].
    Resume,
    /// How the flight went, and where the robot is; [`SurveyReply::Done`].
    Report(Motion, Point),
    /// [`SurveyReply::Sent`].
    Transmit,
    /// A frame; [`SurveyReply::Heard`].
    #[serde(borrow)]
    Receive(&'a [u8]),
    /// [`SurveyReply::Memory`].
    Memory,
    /// The image ends, without an answer.
    End,
}

/// What the image answers to any other request, with what the robot would tell the others
/// about itself.
pub type SurveyAnswer = Answer<Status<Point, Cell>, SurveyReply>;

/// What a call returned.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum SurveyReply {
    /// Nothing to say.
    Done,
    /// [`patches_hash`] of what the robot would tell the others now.
    Told(u32),
    /// What was decided, and by what.
    Decided {
        /// What to do.
        action: Action<Point>,
        /// Why the robot hovers.
        waiting: Option<Wait>,
        /// Work of the decision.
        work: u32,
        /// What the step added to the reward.
        gain: f32,
        /// The reward so far.
        reward: f32,
        /// [`surface_hash`] of the map.
        map: u32,
    },
    /// [`frame_hash`] of the frame written, if there was one.
    Sent(Option<u32>),
    /// What a frame brought.
    Heard(Result<u32, FrameError>),
    /// What the image takes.
    Memory(Memory),
}

/// A [`Patch`] without the heights that mean nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PatchRecord<'a> {
    /// Column of tiles.
    x: u8,
    /// Row of tiles.
    y: u8,
    cells: u64,
    /// Of the cells, in the order of their bits.
    heights: &'a [u8],
    fresh: bool,
}

impl<'a> PatchRecord<'a> {
    /// The record of a patch; its heights go to `heights`.
    pub fn of(patch: &Patch, heights: &'a mut [u8; 64]) -> Self {
        let mut count = 0;
        for (place, height) in heights.iter_mut().zip(heights_of(patch)) {
            *place = height;
            count += 1;
        }
        Self {
            x: patch.tile.x,
            y: patch.tile.y,
            cells: patch.cells,
            heights: heights.get(..count).unwrap_or_default(),
            fresh: patch.fresh,
        }
    }

    /// The patch.
    pub fn patch(&self) -> Patch {
        let mut heights = [Height(0); 64];
        for (bit, &height) in bits(self.cells).zip(self.heights) {
            if let Some(place) = heights.get_mut(bit as usize) {
                *place = Height(height);
            }
        }
        Patch {
            tile: TileIndex {
                x: self.x,
                y: self.y,
            },
            cells: self.cells,
            heights,
            fresh: self.fresh,
        }
    }
}

fn heights_of(patch: &Patch) -> impl Iterator<Item = u8> {
    bits(patch.cells).map(|bit| patch.heights.get(bit as usize).map_or(0, |height| height.0))
}

/// A number that tells maps apart. Two maps of different compiled sizes with the same
/// columns have the same one.
#[inline(never)] // what it keeps on the stack goes with it
pub fn surface_hash<const TW: usize, const TH: usize>(surface: &Surface<TW, TH>) -> u32 {
    let known = surface
        .tiles()
        .filter(|&tile| surface.known(tile) != 0)
        .map(|tile| surface.patch(tile, !0));
    hash(known)
}

/// A number that tells apart what robots would tell.
#[inline(never)] // what it keeps on the stack goes with it
pub fn patches_hash<const TW: usize, const TH: usize>(knowledge: &Knowledge<TW, TH>) -> u32 {
    hash(knowledge.patches())
}

/// A number that tells frames apart.
pub fn frame_hash(frame: &[u8]) -> u32 {
    folded(
        frame
            .iter()
            .fold(SEED, |hash, &byte| eat(hash, byte.into())),
    )
}

/// FNV-1a over what the patches say, folded.
fn hash(patches: impl Iterator<Item = Patch>) -> u32 {
    folded(patches.fold(SEED, |hash, patch| {
        let TileIndex { x, y } = patch.tile;
        let head = u64::from_le_bytes([x, y, patch.fresh.into(), 0, 0, 0, 0, 0]);
        heights_of(&patch).fold(eat(eat(hash, head), patch.cells), |hash, height| {
            eat(hash, height.into())
        })
    }))
}

pub(crate) const SEED: u64 = 0xcbf2_9ce4_8422_2325;

/// Turned first, so that the highest bits of a word reach all others by the words after it.
pub(crate) const fn eat(hash: u64, word: u64) -> u64 {
    (hash.rotate_left(23) ^ word).wrapping_mul(0x517c_c1b7_2722_0a95)
}

pub(crate) const fn folded(hash: u64) -> u32 {
    (hash ^ hash >> 32) as u32
}
