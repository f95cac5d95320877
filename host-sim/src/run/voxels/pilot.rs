//! The planner of a robot, as large as its scene needs.

use planner_core::radio::{FrameError, MAX_LEN};
use planner_core::tile::TileIndex;
use planner_core::volume::{Content, Heading, Voxel, VoxelPatch};
use planner_core::voxel_survey::{Config, VoxelSurvey};
use planner_core::{Action, Extent, ExtentError, RobotId, Status};

use super::follower::Follower;
use crate::baselines::voxels::Body;
use crate::run::{Here, Site};
use crate::scenario::voxels::Planner;
use crate::scene::Scene;
#[cfg(not(target_arch = "wasm32"))]
use crate::scene::{LARGEST, LEVELS};

/// Largest planner that is built where everything else is; larger ones need more stack.
#[cfg(not(target_arch = "wasm32"))]
const MOST_ON_STACK: usize = 128 << 10;

/// Where the planners of a survey among voxels are.
pub trait Host: Site {
    /// The planner of a robot in a box of `extent` columns and `levels` levels.
    ///
    /// # Errors
    /// The box is larger than the largest.
    fn pilot(
        &self,
        config: Config,
        id: RobotId,
        extent: Extent,
        levels: u8,
    ) -> Result<Box<dyn Pilot>, ExtentError>;
}

impl Host for Here {
    fn pilot(
        &self,
        config: Config,
        id: RobotId,
        extent: Extent,
        levels: u8,
    ) -> Result<Box<dyn Pilot>, ExtentError> {
        of_core(config, id, extent, levels)
    }
}

/// [`VoxelSurvey`] of any size, wherever it is: its calls, and what they change.
#[expect(missing_docs, reason = "they are the calls of VoxelSurvey and Volume")]
pub trait Pilot {
    fn observe(&mut self, at: Voxel, heading: Heading, seen: &[(Voxel, bool)]);
    fn heading(&self) -> Heading;
    fn tick(&mut self) -> Action<Voxel, Voxel>;
    fn work(&self) -> u32;
    fn resume(&mut self);
    /// Tells for how many steps the energy lasts from now on.
    fn energy(&mut self, left: u32);
    fn status(&self) -> Status<Voxel>;
    fn hear(&mut self, id: RobotId, status: Status<Voxel>);
    fn transmit(&mut self, buffer: &mut [u8; MAX_LEN]) -> Option<usize>;
    fn receive(&mut self, frame: &[u8]) -> Result<u32, FrameError>;
    fn merge(&mut self, patch: &VoxelPatch);
    fn patch(&self, tile: TileIndex, z: u8) -> VoxelPatch;
    fn after(&self, tile: TileIndex, z: u8) -> (TileIndex, u8);
    fn known_voxels(&self) -> u32;
    fn content(&self, voxel: Voxel) -> Content;
    /// Lets a step pass without a decision.
    fn pass(&mut self);
    /// Takes a centre's order, which cost `work` to find.
    fn obey(&mut self, _to: Option<Voxel>, _work: u32) {}
    fn extent(&self) -> Extent;
    fn levels(&self) -> u8;
}

impl<const TW: usize, const TH: usize, const L: usize> Pilot for VoxelSurvey<TW, TH, L> {
    fn observe(&mut self, at: Voxel, heading: Heading, seen: &[(Voxel, bool)]) {
        self.observe_towards(at, heading, seen);
    }

    fn heading(&self) -> Heading {
        self.heading()
    }

    fn tick(&mut self) -> Action<Voxel, Voxel> {
        self.tick()
    }

    fn work(&self) -> u32 {
        self.work()
    }

    fn resume(&mut self) {
        self.resume();
    }

    fn energy(&mut self, left: u32) {
        self.energy(left);
    }

    fn status(&self) -> Status<Voxel> {
        self.status()
    }

    fn hear(&mut self, id: RobotId, status: Status<Voxel>) {
        self.hear(id, status);
    }

    fn transmit(&mut self, buffer: &mut [u8; MAX_LEN]) -> Option<usize> {
        self.transmit(buffer)
    }

    fn receive(&mut self, frame: &[u8]) -> Result<u32, FrameError> {
        self.receive(frame)
    }

    fn merge(&mut self, patch: &VoxelPatch) {
        self.merge(patch);
    }

    fn patch(&self, tile: TileIndex, z: u8) -> VoxelPatch {
        self.volume().patch(tile, z)
    }

    fn after(&self, tile: TileIndex, z: u8) -> (TileIndex, u8) {
        self.volume().after(tile, z)
    }

    fn known_voxels(&self) -> u32 {
        self.volume().known_voxels()
    }

    fn content(&self, voxel: Voxel) -> Content {
        self.volume().content(voxel)
    }

    fn pass(&mut self) {
        self.pass();
    }

    fn extent(&self) -> Extent {
        self.volume().extent()
    }

    fn levels(&self) -> u8 {
        self.volume().levels()
    }
}

/// A robot in `scene` that decides as `planner` does.
///
/// # Errors
/// The scene is larger than the largest.
pub(super) fn pilot(
    host: &impl Host,
    scene: &Scene,
    config: Config,
    planner: Planner,
    id: RobotId,
) -> Result<Box<dyn Pilot>, ExtentError> {
    let pilot = host.pilot(config, id, scene.extent(), scene.levels())?;
    Ok(match planner {
        Planner::VoxelSurvey => pilot,
        Planner::ClosestFrontier | Planner::Greedy => {
            let Config {
                range, clearance, ..
            } = config;
            Box::new(Follower::new(pilot, id, Body { range, clearance }))
        }
    })
}

/// The planner of the core: of the smallest of a few sizes that fits.
///
/// # Errors
/// The box is larger than the largest.
#[cfg(not(target_arch = "wasm32"))]
fn of_core(
    config: Config,
    id: RobotId,
    extent: Extent,
    levels: u8,
) -> Result<Box<dyn Pilot>, ExtentError> {
    match (extent.width.max(extent.height), levels) {
        (0..=64, 0..=24) => survey::<8, 8, 24>(config, id, extent, levels),
        (0..=256, 0..=64) => survey::<32, 32, 64>(config, id, extent, levels),
        _ => survey::<{ LARGEST as usize / 8 }, { LARGEST as usize / 8 }, { LEVELS as usize }>(
            config, id, extent, levels,
        ),
    }
}

/// The same in the browser, whose stack holds the smallest alone.
///
/// # Errors
/// The box is larger.
#[cfg(target_arch = "wasm32")]
fn of_core(
    config: Config,
    id: RobotId,
    extent: Extent,
    levels: u8,
) -> Result<Box<dyn Pilot>, ExtentError> {
    survey::<8, 8, 24>(config, id, extent, levels)
}

fn survey<const TW: usize, const TH: usize, const L: usize>(
    config: Config,
    id: RobotId,
    extent: Extent,
    levels: u8,
) -> Result<Box<dyn Pilot>, ExtentError> {
    let mut survey = boxed(VoxelSurvey::<TW, TH, L>::vacant);
    survey.reset(config, id, extent, levels)?;
    Ok(survey)
}

/// What `make` makes, on the heap. It may be larger than the stack, over which it comes
/// there: then a thread lends its own.
#[cfg(not(target_arch = "wasm32"))]
fn boxed<T: Send>(make: fn() -> T) -> Box<T> {
    let size = size_of::<T>();
    if size <= MOST_ON_STACK {
        return Box::new(make());
    }
    std::thread::scope(|scope| {
        let builder = std::thread::Builder::new().stack_size(8 * size);
        let maker = builder.spawn_scoped(scope, || Box::new(make()));
        let maker = maker.expect("there is memory for the planner's stack");
        maker.join().expect("nothing panics in it")
    })
}

/// The same in the browser.
#[cfg(target_arch = "wasm32")]
fn boxed<T>(make: fn() -> T) -> Box<T> {
    Box::new(make())
}
