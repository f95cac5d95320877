//! A fleet that surveys a box of voxels completely: streets, undersides, rooms.
//!
//! A robot flies from voxel to voxel through faces, over *poses*: known free voxels all
//! of whose neighbours are known and free. A pose is *done* once the robot has looked
//! from it, or once no unknown voxel is in sight of it, where unknown voxels do not
//! block sight. The robot flies to poses that are not done; when none is left that it
//! can reach, it stops.
//!
//! # Why this is complete
//! Claim: when the robot stops, every voxel that can be seen from any place that can be
//! reached is known. Let P be the voxels that are free with free neighbours, reached
//! from the start over others of P. Each pose that the robot reaches is done. From a
//! done pose q everything in sight is known: it was looked at, or nothing unknown was in
//! sight, and sight only shrinks as more becomes known. A neighbour p of q in P and p's
//! neighbours are in sight of q if the range is at least 2: straight through p, or over
//! the edge between p and another neighbour of q, which is free. So p is a pose, and by
//! induction all of P are. Each look or check makes one more pose done, and there are
//! finitely many, so the robot stops.
//!
//! Robots are smaller than a voxel: several may share one. What others tell only saves
//! looks; nothing waits for it.

mod far;
mod gain;
mod near;

use heapless::Vec;

use crate::cell::Extent;
use crate::volume::{DoesNotFit, Layer, Volume, Voxel, VoxelPatch};
use far::Far;

/// Steps of a way that are remembered.
const WAY: usize = 64;

/// Number of other robots that are remembered.
const RIVALS: usize = 15;

/// Largest sensor range in voxels.
pub const MAX_RANGE: u8 = 12;

/// What a fleet agrees on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Config {
    /// Sensor range in voxels, 2 to [`MAX_RANGE`]; others are brought into these bounds.
    pub range: u8,
}

/// What the robot shall do now.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// Fly to this voxel, which shares a face with the robot's.
    Fly(Voxel),
    /// Stay for this step: the robot is searching.
    Hover,
    /// Nothing is left that the robot could reach a view of. A robot that then hears
    /// of more goes on.
    Stop,
}

/// The planner of one robot over a box of at most 8·`TW` × 8·`TH` × `L` voxels.
///
/// Takes 48 bytes for each tile of a level: 19.2 KB for 40×40×16 voxels, and 1.2 KB.
#[derive(Clone, Debug)]
pub struct VoxelSurvey<const TW: usize, const TH: usize, const L: usize> {
    range: u8,
    volume: Volume<TW, TH, L>,
    done: Layer<TW, TH, L>,
    position: Voxel,
    /// The way to the goal, the next step last.
    way: Vec<Voxel, WAY>,
    goal: Voxel,
    far: Far<TW, TH, L>,
    /// Who, where, and on the way where to.
    rivals: Vec<(u8, Voxel, Voxel), RIVALS>,
    /// Known voxels when nothing was left.
    stopped_at: Option<u32>,
    work: u32,
}

impl<const TW: usize, const TH: usize, const L: usize> VoxelSurvey<TW, TH, L> {
    /// A robot that knows nothing of a box of `extent` columns and `levels` levels.
    ///
    /// # Errors
    /// The box is larger than the map.
    pub fn new(extent: Extent, levels: u8, config: Config) -> Result<Self, DoesNotFit> {
        Ok(Self {
            range: config.range.clamp(2, MAX_RANGE),
            volume: Volume::new(extent, levels)?,
            done: Layer::EMPTY,
            position: Voxel::new(0, 0, 0),
            way: Vec::new(),
            goal: Voxel::new(0, 0, 0),
            far: Far::new(),
            rivals: Vec::new(),
            stopped_at: None,
            work: 0,
        })
    }

    /// The map.
    pub const fn volume(&self) -> &Volume<TW, TH, L> {
        &self.volume
    }

    /// Where the robot was last.
    pub const fn position(&self) -> Voxel {
        self.position
    }

    /// Voxels, words and rays looked at by the last [`tick`](Self::tick).
    pub const fn work(&self) -> u32 {
        self.work
    }

    /// Begins a step: where the robot is, and every voxel in sight within the range,
    /// each with whether it is occupied. A voxel is in sight if
    /// [`in_sight`](crate::volume::in_sight) over free voxels.
    pub fn observe(&mut self, at: Voxel, seen: &[(Voxel, bool)]) {
        self.position = at;
        for &(voxel, occupied) in seen {
            self.volume.learn(voxel, occupied);
        }
        self.done.set(at);
    }

    /// Where the robot is on its way to, or was last.
    pub const fn goal(&self) -> Voxel {
        self.goal
    }

    /// Takes in where robot `id` is, and its [`goal`](Self::goal): hints.
    pub fn hear(&mut self, id: u8, at: Voxel, goal: Voxel) {
        if let Some(rival) = self.rivals.iter_mut().find(|rival| rival.0 == id) {
            *rival = (id, at, goal);
        } else {
            // A sixteenth robot is nobody's rival, which costs time only.
            let _ = self.rivals.push((id, at, goal));
        }
    }

    /// Takes in a piece of another robot's map; says whether it brought anything.
    pub fn merge(&mut self, patch: &VoxelPatch) -> bool {
        self.volume.merge(patch)
    }

    /// Decides. Call it once per step.
    ///
    /// Cost: 512 voxels near by and the views from 24 of them, or 1024 words of the
    /// search for a pose far away and the views from 8; a view is at most one ray for
    /// each voxel within range.
    pub fn tick(&mut self) -> Action {
        self.work = 0;
        if self.stopped_at == Some(self.volume.known_voxels()) {
            return Action::Stop;
        }
        self.stopped_at = None;
        if let Some(action) = self.follow() {
            return action;
        }
        let action = if self.far.is_idle() {
            self.look_near()
        } else {
            None
        };
        if let Some(action) = action {
            return action;
        }
        match self.look_far() {
            far::Found::Way => self.follow().unwrap_or(Action::Hover),
            far::Found::Searching => Action::Hover,
            far::Found::Nothing => {
                self.stopped_at = Some(self.volume.known_voxels());
                Action::Stop
            }
        }
    }

    /// The next step of the way, unless there is none or the goal is done.
    fn follow(&mut self) -> Option<Action> {
        if self.done.get(self.goal) {
            self.way.clear();
        }
        let next = self.way.pop()?;
        let is_beside = self.position.distance_squared(next) == 1;
        if is_beside && self.volume.is_pose(next) {
            return Some(Action::Fly(next));
        }
        self.way.clear();
        None
    }
}

#[cfg(test)]
mod tests;
