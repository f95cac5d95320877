//! What the two sides say.

use heapless::Vec;
use planner_core::ExtentError;
use planner_core::radio::{FrameError, Heard, Hearsay, LinkConfig, MAX_LEN, TileRecord};
use planner_core::role::Role;
use planner_core::survey::SetupError;
use planner_core::tile::TileIndex;
use planner_core::{
    Action, Cell, Extent, Learnt, Map, Motion, RobotId, Sighting, Status, Wait, explorer,
    local_frontiers, voxel_survey,
};
use serde::{Deserialize, Serialize};

use crate::SurveyorConfig;

/// Tiles of one [`Request::Stage`] at most.
pub const STAGED: usize = 12;

/// A set of tiles: a bit a column, row by row, as far as there are any.
pub type Rows = Vec<u64, 64>;

/// A frame for the radio.
pub type FrameBytes = Vec<u8, MAX_LEN>;

/// Which planner decides, and how.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum PlannerConfig {
    /// The complete planner.
    Explorer(explorer::Config),
    /// Local frontiers as published.
    LocalFrontiers(local_frontiers::Config),
}

impl PlannerConfig {
    /// How the planner uses the radio.
    pub const fn link(&self) -> &LinkConfig {
        match self {
            Self::Explorer(config) => &config.link,
            Self::LocalFrontiers(config) => &config.link,
        }
    }
}

/// What the simulator asks for: a verb of the planner, or something about it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Request<'a> {
    /// Sets up a planner. The first request, or else [`Survey`](Self::Survey) or
    /// [`Voxels`](Self::Voxels); answered by a [`Welcome`].
    Start {
        /// Which one.
        planner: PlannerConfig,
        /// The robot's number.
        id: RobotId,
        /// Size of the grid.
        extent: Extent,
        /// Where the robot stands.
        start: Cell,
    },
    /// Sets up a planner of a robot that flies; answered by a [`Welcome`]. Whatever
    /// follows is a [`SurveyRequest`](crate::SurveyRequest).
    Survey {
        /// Which one.
        planner: SurveyorConfig,
        /// The robot's number.
        id: RobotId,
        /// Size of the surface.
        extent: Extent,
    },
    /// Sets up the planner of a robot that flies among voxels; answered by a [`Welcome`].
    /// Whatever follows is a [`VoxelRequest`](crate::VoxelRequest).
    Voxels {
        /// How it decides.
        planner: voxel_survey::Config,
        /// The robot's number.
        id: RobotId,
        /// Columns of the box.
        extent: Extent,
        /// Its levels.
        levels: u8,
    },
    /// [`Reply::Learnt`].
    Observe(Sighting),
    /// [`Reply::Action`].
    Tick,
    /// [`Reply::Done`].
    Report(Motion),
    /// [`Reply::Done`].
    Resume,
    /// [`Reply::Frame`].
    Transmit,
    /// A frame; [`Reply::Heard`].
    #[serde(borrow)]
    Receive(&'a [u8]),
    /// [`Reply::Changed`].
    TakeChanged,
    /// Puts tiles of another robot's map aside for [`Join`](Self::Join);
    /// [`Reply::Done`].
    Stage(Vec<TileRecord, STAGED>),
    /// Joins the tiles put aside; [`Reply::Learnt`].
    Join,
    /// What another robot told about itself; [`Reply::Done`].
    Hear(RobotId, Status),
    /// [`Reply::Done`].
    Adopt(Role),
    /// [`Reply::Memory`].
    Memory,
    /// The image ends, without an answer.
    End,
}

/// What the image answers to any other request.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Answer<S = State, R = Reply> {
    /// What the planner's call took.
    pub cost: Cost,
    /// What has become of the planner.
    pub state: S,
    /// What the call returned.
    pub reply: R,
}

/// What a call takes of the chip.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Cost {
    /// Ticks of the image's clock.
    pub clock_ticks: u32,
    /// Bytes of the stack.
    pub stack: u32,
}

/// What the simulator records of a planner after every call.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct State {
    /// What the robot would tell the others.
    pub status: Status,
    /// Work of its last tick.
    pub work: u32,
    /// [`grid_hash`] of its map.
    pub map: u32,
    /// The tile that the robot stands on.
    pub here: TileRecord,
    /// What the robot is about to do.
    pub role: Option<Role>,
    /// Why it waits.
    pub waiting: Option<Wait>,
    /// What it has from others.
    pub hearsay: Hearsay,
}

/// What a call returned.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[expect(
    clippy::large_enum_variant,
    reason = "there is one at a time, and no heap on the chip"
)]
pub enum Reply {
    /// Nothing to say.
    Done,
    /// What was learnt.
    Learnt(Learnt),
    /// What was decided.
    Action(Action),
    /// The next frame for the radio, if there is one.
    Frame(Option<FrameBytes>),
    /// What a received frame brought.
    Heard(Result<Heard, FrameError>),
    /// Tiles that changed.
    Changed(Rows),
    /// What the image takes.
    Memory(Memory),
}

/// The answer to [`Request::Start`], [`Request::Survey`] and [`Request::Voxels`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Welcome {
    /// The planner is set up.
    Ready(Hello),
    /// The grid or box does not fit the image's map; the image ends.
    Refused(ExtentError),
    /// The robot cannot fly like this; the image ends.
    Grounded(SetupError),
    /// The image hosts no planner of this kind; it ends.
    NotHosted,
}

/// Who answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Hello {
    /// [`VERSION`](crate::VERSION) of the image.
    pub version: u8,
    /// Ticks of the image's clock in a second.
    pub clock_hz: u32,
}

/// What the image and its planner take, in bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Memory {
    /// The planner, everything included.
    pub planner: u32,
    /// All statics of the image: every planner that it can host, and the dialogue.
    pub statics: u32,
    /// Code, constants and initial values of the image.
    pub flash: u32,
    /// The most of the stack that was ever in use.
    pub stack_peak: u32,
    /// The whole stack.
    pub stack: u32,
}

/// A number that tells maps apart: FNV-1a over the words of all tiles, folded.
/// Two maps of different compiled sizes with the same cells have the same one.
pub fn grid_hash<const TW: usize, const TH: usize>(map: &Map<TW, TH>) -> u32 {
    let (columns, rows) = map.tile_extent();
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    for y in 0..rows {
        for x in 0..columns {
            let tile = map.tile_inside(TileIndex { x, y });
            for word in tile.planes() {
                hash = (hash ^ word).wrapping_mul(0x0000_0100_0000_01b3);
            }
        }
    }
    (hash ^ hash >> 32) as u32
}
