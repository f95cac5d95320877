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
//! finitely many, so the robot stops. What it leaves to rivals changes only which pose
//! comes first: a search ends without a pose only if none of those that it reached shows
//! anything, whoever is nearer.
//!
//! Robots are smaller than a voxel: several may share one. What others tell only saves
//! looks; nothing waits for it.
//!
//! One step of a robot is [`observe`](VoxelSurvey::observe); then
//! [`transmit`](VoxelSurvey::transmit) and [`receive`](VoxelSurvey::receive); then
//! [`tick`](VoxelSurvey::tick), which says where to fly, and `transmit` and `receive`
//! again. Where a medium carries more than frames, robots [`hear`](VoxelSurvey::hear)
//! each other and [`merge`](VoxelSurvey::merge) pieces of maps.

mod far;
mod gain;
mod near;
mod news;

use heapless::Vec;

use crate::cell::Extent;
use crate::radio::{FrameError, Hearsay, GridId, LinkConfig, MAX_LEN, VoxelFrame};
use crate::robot::RobotId;
use crate::surface::Tile;
use crate::survey::{Peer, Peers, Sender};
use crate::volume::{DoesNotFit, Layer, Volume, Voxel, VoxelPatch};
use far::Far;
use news::News;

/// Steps of a way that are remembered.
const WAY: usize = 64;

/// Words looked at after which a step begins no further view.
const SLICE: u32 = 65_536;

/// Largest sensor range in voxels.
pub const MAX_RANGE: u8 = 12;

/// What a fleet agrees on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Config {
    /// Sensor range in voxels, 2 to [`MAX_RANGE`]; others are brought into these bounds.
    pub range: u8,
    /// How the robots use the radio. Its origin is that of the lowest level.
    pub link: LinkConfig,
}

/// What a robot says about itself: hints, never needed for completeness.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Status {
    /// Where it is.
    pub position: Voxel,
    /// The pose that it is on its way to.
    pub goal: Option<Voxel>,
    /// Whether it has stopped.
    pub stopped: bool,
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
/// Takes 49 bytes for each tile of a level: 19.6 KB for 40×40×16 voxels, and 1.3 KB.
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
    peers: Peers<Status>,
    sender: Sender,
    news: News<TW, TH, L>,
    /// Where the look at all poses in turn stands, and those of its word that were
    /// looked at.
    turn: (Tile, u8),
    passed: u64,
    /// Known voxels when nothing was left.
    stopped_at: Option<u32>,
    work: u32,
}

impl<const TW: usize, const TH: usize, const L: usize> VoxelSurvey<TW, TH, L> {
    /// A robot that knows nothing of a box of `extent` columns and `levels` levels; `id`
    /// is its name on the radio.
    ///
    /// # Errors
    /// The box is larger than the map.
    pub fn new(extent: Extent, levels: u8, config: Config, id: u8) -> Result<Self, DoesNotFit> {
        let LinkConfig {
            origin_mm, cell_mm, ..
        } = config.link;
        let grid = GridId::of_box(extent, levels, origin_mm, cell_mm);
        Ok(Self {
            range: config.range.clamp(2, MAX_RANGE),
            volume: Volume::new(extent, levels)?,
            done: Layer::EMPTY,
            position: Voxel::new(0, 0, 0),
            way: Vec::new(),
            goal: Voxel::new(0, 0, 0),
            far: Far::new(),
            peers: Peers::new(),
            sender: Sender::new(config.link, grid, RobotId(id)),
            news: News::new(),
            turn: (Tile { x: 0, y: 0 }, 0),
            passed: 0,
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

    /// Words looked at by the last [`tick`](Self::tick), 16 for a ray.
    pub const fn work(&self) -> u32 {
        self.work
    }

    /// Begins a step: where the robot is, and every voxel in sight within the range,
    /// each with whether it is occupied. A voxel is in sight if
    /// [`in_sight`](crate::volume::in_sight) over free voxels.
    pub fn observe(&mut self, at: Voxel, seen: &[(Voxel, bool)]) {
        self.position = at;
        for &(voxel, occupied) in seen {
            if self.volume.learn(voxel, occupied)
                && let (Some(tile), Ok(z)) = (Tile::of(voxel.cell()), u8::try_from(voxel.z))
            {
                self.news.add(tile, z);
            }
        }
        self.done.set(at);
    }

    /// What the robot tells the others about itself.
    pub fn status(&self) -> Status {
        Status {
            position: self.position,
            goal: (!self.way.is_empty()).then_some(self.goal),
            stopped: self.stopped_at.is_some(),
        }
    }

    /// Takes in what robot `id` told about itself.
    pub fn hear(&mut self, id: u8, status: Status) {
        self.peers.hear(id, status);
    }

    /// The heard robots that still explore.
    fn rivals(&self) -> impl Iterator<Item = &Status> {
        let statuses = self.peers.iter().map(|peer: &Peer<Status>| &peer.status);
        statuses.filter(|status| !status.stopped)
    }

    /// Whether a rival, or where it goes, is nearer to `pose`.
    fn is_a_rivals(&self, pose: Voxel) -> bool {
        let own = pose.distance_squared(self.position);
        let is_nearer = |voxel: Voxel| pose.distance_squared(voxel) < own;
        self.rivals()
            .any(|rival| is_nearer(rival.position) || rival.goal.is_some_and(is_nearer))
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
        let length = frame.encode(self.sender.key(), buffer);
        self.sender.sent(buffer.get(..length).unwrap_or(&[]));
        Some(length)
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
            self.volume.merge(patch);
            if self.volume.patch(patch.tile, patch.z) == *patch {
                self.news.forget(patch.tile, patch.z);
            }
        }
        self.peers
            .hear_frame(frame.sender.0, frame.status, frame.sequence);
        let learnt = self.volume.known_voxels() - before;
        self.sender.hearsay.told(learnt);
        Ok(learnt)
    }

    /// Takes in a piece of another robot's map; says whether it brought anything.
    pub fn merge(&mut self, patch: &VoxelPatch) -> bool {
        let before = self.volume.known_voxels();
        let brought = self.volume.merge(patch);
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

    /// Decides. Call it once per step.
    ///
    /// Cost: 512 poses near by and the views from 24 of them; beside these, views and
    /// searches begin until 65,536 words were looked at. A view is at most one ray for
    /// each voxel within range.
    pub fn tick(&mut self) -> Action {
        self.work = 0;
        self.peers.age();
        self.sender.tick();
        if self.stopped_at == Some(self.volume.known_voxels()) {
            return Action::Stop;
        }
        self.stopped_at = None;
        if let Some(action) = self.follow() {
            self.look_ahead();
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

    /// Spends what a step on the way leaves over on poses anywhere that show nothing any
    /// more: searches then pass over them.
    fn look_ahead(&mut self) {
        while self.work < SLICE {
            self.work = self.work.saturating_add(1);
            let (tile, z) = self.turn;
            let open = self.volume.poses(tile, z) & !self.done.word(tile, z) & !self.passed;
            if open == 0 {
                self.passed = 0;
                self.turn = self.volume.after(tile, z);
                continue;
            }
            let bit = open.trailing_zeros();
            self.passed |= 1 << bit;
            let cell = tile.cell(bit);
            self.gain(Voxel::new(cell.x, cell.y, z.into()), 1);
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
