//! A fleet that surveys a box of voxels completely: streets, undersides, rooms.
//!
//! A robot flies from voxel to voxel through faces, over *poses*: voxels where its body is
//! known to be free, the ball of all within its [`clearance`](Config::clearance) c. With a
//! clearance of 1 it is a free voxel with its neighbours. A pose is *done* once the robot has looked
//! from it, or once no unknown voxel is in sight of it, where unknown voxels do not
//! block sight. The robot flies to poses that are not done; when none is left that it
//! can reach, it stops.
//!
//! # Why this is complete
//! Claim: when the robot stops, every voxel that can be seen from any place that can be
//! reached is known, or it says what kept it from that. Let P be the voxels about which a body
//! is free, reached
//! from the start over others of P. Each pose that the robot reaches is done. From a
//! done pose q everything in sight is known: it was looked at, or nothing unknown was in
//! sight, and sight only shrinks as more becomes known. The body about a neighbour p of q in P
//! is in sight of q if the range is at least c + 1: none of it is farther, and the rays to it
//! pass no voxel but those of the bodies about q and p, which are free (all of them are tried
//! by a test). So p is a pose, and by
//! induction all of P are. Each look or check makes one more pose done, and there are
//! finitely many, so the robot stops. What it leaves to rivals changes only which pose
//! comes first: a search ends without a pose only if none of those that it reached shows
//! anything, whoever is nearer.
//!
//! A sensor that does not show all round ([`Field`]) looks in several directions, wherever it
//! is turned: what can be seen is then what is in its field in some heading, and a pose is done
//! once each heading was looked at, or shows nothing unknown. The robot turns while it flies
//! and in place, there only to see more. The next body is in sight as before if it
//! feels what is within c + 1 voxels ([`Field::near`]); else P is smaller.
//!
//! That rests on what a look shows: every voxel within range that is in the field and in sight
//! over free ones. One that a look should have shown and did not is noted, and looked for from every
//! pose that has it in sight; if it stays unknown, the stop is [`Stop::Unseen`] and names
//! it. A voxel into which a step was not followed is *closed*, and poses beyond it are
//! not those of the claim any more. When nothing else is left the closed ones are opened,
//! and whatever shows something is tried again, `ROUNDS` times and after longer and
//! longer rests, and anew whenever something was learnt; then the stop is
//! [`Stop::Blocked`].
//!
//! # Why it ends
//! Let N be the voxels of the box. Voxels become known at most N times and poses done at
//! most N times, anew whenever a voxel becomes free again: *progress*. Claim: between two of
//! these there are boundedly many steps with good poses, whatever others say.
//! 1. *A sensor that shows nothing*: the robot hovers, and after `SILENCE` such looks
//!    in a row it stops, as complete if no unknown voxel is beside a free one. The voxel that it
//!    is in is free from its first pose on: where nothing was seen, those beside it are unknown.
//! 2. *Searching near* makes a pose done, or gives a way; where a slice is too short for that,
//!    5 holds.
//! 3. *Searching far*: the wave reaches each pose once, passes over each pose left to a
//!    rival once, and begins anew only after progress; the way back gets shorter.
//! 4. *On the way* each step that is followed uses it up. One that is not closes a
//!    voxel, at most N in a round.
//! 5. *At the end of a way* the robot is at its goal and looks: progress, or with a sensor that
//!    turns or errs it stays, and turns, until one of its looks shows something or the pose is
//!    done: at most 16 for each of eight headings, and four times as many with one that errs. Or
//!    the way was longer than is remembered, or did not hold. After `PATIENCE` steps without
//!    progress no rival counts and only the far search decides, for the nearest pose that
//!    shows something: it gets nearer by a whole way each time, so it is reached.
//! 6. *Nothing is left*: a round begins, at most `ROUNDS` of them without anything
//!    learnt, or the robot stops, and stays stopped until more is known.
//!
//! Steps without a good pose are outside of all counts: nothing is decided in them.
//!
//! # Wind
//! A robot that is neither where it was nor where it was sent was *pushed*: nothing is closed, and
//! the way is dropped. Where that leaves it off all poses it flies back to one over free voxels.
//! Pushes without progress are counted; after `PUSHES` of them it stops, as blocked where it is.
//! The claim is then of the poses that can be reached from where it stops: a push may take it to
//! others than those before, which it surveys too.
//!
//! # A sensor that errs
//! With [`Sensor::Errs`] a known voxel changes when three looks in a row contradict it: free
//! becomes occupied, and occupied becomes *free again*, for good, which others are told of. Sight
//! grows then: poses within range are not done any more, whoever brought it. Each voxel rises
//! over three levels at most, so that happens at most N times, and poses become done at most N
//! times in between: progress stays bounded. That is long where looks err often. So after 32
//! changes of known voxels by own looks without anything unknown learnt, nothing free becomes
//! occupied, and what looks should have shown and did not is not looked for any more; after 255
//! no look changes what is known. A robot that has stopped does not change it either. A pose is
//! done only once nothing unknown is in sight, or it was looked from four times in a row: a look
//! that something hides a part of is made again. Claim: what it leaves out, looks have shown wrong
//! three times in a row, or each time that they could, unless the map was held before.
//!
//! Nobody flies into what the last look has shown, whatever the map says: the step waits, and
//! after four ticks its end is closed, as if it were not followed. Rounds in which closed voxels
//! are opened begin anew only once something unknown was learnt.
//!
//! Robots do not stand in each other's way: several may share a voxel. What others tell only saves
//! looks; nothing waits for it.
//!
//! Energy, and the way home, are in `mission`.
//!
//! One step of a robot is [`observe`](VoxelSurvey::observe); then
//! [`transmit`](VoxelSurvey::transmit) and [`receive`](VoxelSurvey::receive); then
//! [`tick`](VoxelSurvey::tick), which says where to fly, and `transmit` and `receive`
//! again. Where a medium carries more than frames, robots [`hear`](VoxelSurvey::hear)
//! each other and [`merge`](VoxelSurvey::merge) pieces of maps.

mod config;
mod doubt;
mod far;
mod fleet;
mod gain;
mod mission;
mod near;
mod news;
mod rounds;
mod turn;
mod wind;

use core::borrow::Borrow;

use heapless::Vec;

use crate::cell::{Extent, ExtentError};
use crate::radio::{GridId, LinkConfig, Roster, Sender};
use crate::robot::{Action, RobotId, Stop, Wait};
use crate::tile::TileIndex;
use crate::volume::{Field, Heading, Layer, MAX_CLEARANCE, MAX_REACH, Volume, Voxel};
use crate::zeroed::Maybe;
pub use config::Config;
use doubt::Doubts;
pub use doubt::Sensor;
use far::Far;
use mission::Mission;
use news::News;
use turn::Turn;

/// Steps of a way that are remembered.
const WAY: usize = 64;

/// Work after which a step begins no further view.
const SLICE: u32 = 43_008;

/// Looks in a row that show nothing at all after which the sensor is taken to have failed.
const SILENCE: u8 = 100;

/// Steps without progress after which no rival counts any more.
const PATIENCE: u16 = 512;

/// Own frames that are remembered, to know their echo: those of three steps.
const ECHOES: usize = 32;

/// Largest sensor range in voxels.
pub const MAX_RANGE: u8 = MAX_REACH;

/// The planner of one robot over a box of at most 8·`TW` × 8·`TH` × `L` voxels.
///
/// Takes 57 bytes for each tile of a level: 22.8 KB for 40×40×16 voxels, and 1.6 KB.
#[derive(Clone, Debug)]
pub struct VoxelSurvey<const TW: usize, const TH: usize, const L: usize> {
    range: u8,
    clearance: u8,
    field: Field,
    sensor: Sensor,
    volume: Volume<TW, TH, L>,
    done: Layer<TW, TH, L>,
    position: Voxel,
    turn_to: Turn,
    /// The way to the goal, the next step last.
    way: Vec<Voxel, WAY>,
    goal: Voxel,
    far: Far<TW, TH, L>,
    peers: Roster<Voxel>,
    sender: Sender<ECHOES>,
    news: News<TW, TH, L>,
    /// Where the look at all poses in turn stands, and those of its word that were
    /// looked at.
    turn: (TileIndex, u8),
    passed: u64,
    /// Voxels that a look should have shown and did not, known by now or not.
    missed: Layer<TW, TH, L>,
    has_missed: bool,
    /// Voxels into which a step was not followed, since the last round began.
    closed: Layer<TW, TH, L>,
    is_closed: bool,
    doubts: Doubts,
    /// The last that was closed.
    refused: Voxel,
    /// Rounds since anything was learnt, and the number of known voxels then.
    round: u8,
    round_known: u32,
    rest: u8,
    /// Where the last tick sent the robot.
    sent_to: Option<Voxel>,
    /// Pushes since the last progress, and whether one has left the robot where no pose is.
    pushes: u16,
    is_adrift: bool,
    /// Whether the last pose was one that nothing can be decided from.
    lost: bool,
    /// Looks in a row that showed nothing, and whether there was one since the last tick.
    silent: u8,
    looked: bool,
    /// Steps since the last progress, and the number of known voxels in the last one.
    fruitless: u16,
    last_known: u32,
    stopped: bool,
    /// Why, and the number of known voxels then.
    reason: (Stop<Voxel>, u32),
    waiting: Maybe<Wait>,
    mission: Mission,
    work: u32,
}

impl<const TW: usize, const TH: usize, const L: usize> VoxelSurvey<TW, TH, L> {
    /// A robot without a map; a `static` of it costs no flash. Call
    /// [`reset`](Self::reset) before use.
    pub const fn vacant() -> Self {
        Self {
            range: 0,
            clearance: 0,
            field: Field::NONE,
            sensor: Sensor::Truthful,
            volume: Volume::vacant(),
            done: Layer::EMPTY,
            position: Voxel::new(0, 0, 0),
            turn_to: Turn::NONE,
            way: Vec::new(),
            goal: Voxel::new(0, 0, 0),
            far: Far::vacant(),
            peers: Roster::new(),
            sender: Sender::vacant(),
            news: News::new(),
            turn: (TileIndex { x: 0, y: 0 }, 0),
            passed: 0,
            missed: Layer::EMPTY,
            has_missed: false,
            closed: Layer::EMPTY,
            is_closed: false,
            doubts: Doubts::new(),
            refused: Voxel::new(0, 0, 0),
            round: 0,
            round_known: 0,
            rest: 0,
            sent_to: None,
            pushes: 0,
            is_adrift: false,
            lost: false,
            silent: 0,
            looked: false,
            fruitless: 0,
            last_known: 0,
            stopped: false,
            reason: (Stop::Complete, 0),
            waiting: Maybe::Nothing,
            mission: Mission::vacant(),
            work: 0,
        }
    }

    /// A robot that knows nothing of a box of `extent` columns and `levels` levels; `id`
    /// is its name on the radio.
    ///
    /// # Errors
    /// The box is empty or larger than the map.
    pub fn new(
        config: Config,
        id: RobotId,
        extent: Extent,
        levels: u8,
    ) -> Result<Self, ExtentError> {
        let mut robot = Self::vacant();
        robot.reset(config, id, extent, levels)?;
        Ok(robot)
    }

    /// Starts anew, in place.
    ///
    /// # Errors
    /// As [`new`](Self::new); nothing has changed then.
    pub fn reset(
        &mut self,
        config: Config,
        id: RobotId,
        extent: Extent,
        levels: u8,
    ) -> Result<(), ExtentError> {
        self.volume.reset(extent, levels)?;
        let LinkConfig {
            origin_mm, cell_mm, ..
        } = config.link;
        let grid = GridId::of_box(extent, levels, origin_mm, cell_mm);
        self.clearance = config.clearance.min(MAX_CLEARANCE);
        self.range = config.range.clamp(2.max(self.clearance + 1), MAX_RANGE);
        self.field = config.field;
        self.sensor = config.sensor;
        self.doubts = Doubts::new();
        self.position = Voxel::new(0, 0, 0);
        self.turn_to = Turn::NONE;
        self.goal = Voxel::new(0, 0, 0);
        self.peers = Roster::new();
        self.sender = Sender::new(config.link, grid, id);
        self.news.reset();
        self.turn = (TileIndex { x: 0, y: 0 }, 0);
        self.passed = 0;
        self.refused = Voxel::new(0, 0, 0);
        self.round_known = 0;
        self.sent_to = None;
        self.is_adrift = false;
        self.lost = false;
        self.looked = false;
        self.last_known = 0;
        self.waiting = Maybe::Nothing;
        self.mission = Mission::of(&config);
        self.work = 0;
        self.resume();
        log!(
            info,
            "robot {}: starts in {} columns of {} voxels",
            id.0,
            extent,
            levels
        );
        Ok(())
    }

    /// The map.
    pub const fn volume(&self) -> &Volume<TW, TH, L> {
        &self.volume
    }

    /// Where the robot was last.
    pub const fn position(&self) -> Voxel {
        self.position
    }

    /// Work of the last [`tick`](Self::tick): words and rows of voxels looked at, 3 for each
    /// ray, and 3 for each row in sight where the sensor does not show all round. At most some 180
    /// instructions each on a Cortex-M4, mostly 150.
    pub const fn work(&self) -> u32 {
        self.work
    }

    /// Why the last [`tick`](Self::tick) was [`Action::Wait`]. `None`: it was not, or the
    /// robot chooses where to fly next.
    pub const fn waiting(&self) -> Option<Wait> {
        self.waiting.get()
    }

    /// Begins a step: where the robot is, and every voxel in sight within the range and the
    /// field of a sensor that is turned to [`heading`](Self::heading), each with whether it is
    /// occupied. A voxel is in sight if
    /// [`in_sight`](crate::volume::in_sight) over free voxels: at least the robot's own. So a
    /// look that shows no voxel of the box is one of a sensor that failed: the robot hovers, for
    /// [`Wait::Sight`], and after 100 of them in a row, or ticks without a look, the stop is
    /// [`Stop::Unseen`]. Before the first look it waits for as long as there is none.
    ///
    /// A robot that is where it was, and not where the last [`Action::Move`] sent it, was kept
    /// from there; one that is elsewhere was pushed.
    /// From a place off the box nothing is learnt and nothing decided: the robot hovers, and
    /// [`waiting`](Self::waiting) is [`Wait::Pose`], until a pose is good again. The voxel that
    /// the robot is in is free, seen or not, whatever the map said of it.
    ///
    /// Where distances are measured, [`VoxelLook`](crate::volume::VoxelLook) makes looks of them.
    ///
    /// Cost: the voxels seen; and at most a ray for each voxel within range.
    pub fn observe(&mut self, at: Voxel, seen: &[(Voxel, bool)]) {
        self.observe_towards(at, self.heading(), seen);
    }

    /// The same where the sensor is turned elsewhere, as long as it has not come round. One
    /// that is turned elsewhere in 16 looks in a row from one place shows nothing there.
    pub fn observe_towards(
        &mut self,
        at: Voxel,
        heading: Heading,
        seen: impl IntoIterator<Item = impl Borrow<(Voxel, bool)>>,
    ) {
        let sent_to = self.sent_to.take();
        self.looked = true;
        self.lost = !self.volume.contains(at);
        if self.lost {
            return;
        }
        self.stand(at);
        let is_at_rest = at == self.position;
        if let Some(to) = sent_to.filter(|&to| to != at) {
            if is_at_rest {
                self.close(to);
            }
            self.way.clear();
        }
        if !is_at_rest && sent_to != Some(at) && self.mission.has_home() {
            self.pushes = self.pushes.saturating_add(1);
            self.is_adrift = true;
            self.far.lose_robot();
            self.mission.reopen_survey();
        }
        self.arrive(at);
        self.closed.clear(at);
        self.doubts.look();
        let mut is_silent = true;
        for seen in seen {
            let &(voxel, occupied) = seen.borrow();
            is_silent = is_silent && !self.volume.contains(voxel);
            // Where the robot is nothing else is.
            let occupied = occupied && voxel != at;
            if self.take_in(voxel, occupied)
                && let Some((tile, z, _)) = voxel.place()
            {
                self.news.add(tile, z);
            }
        }
        if is_silent {
            self.silent = self.silent.saturating_add(1);
            return;
        }
        if self.silent >= SILENCE {
            self.stopped = false;
        }
        self.silent = 0;
        if let Some(stands_for) = self.look_towards(heading) {
            self.note_missed(stands_for, stands_for != heading);
        }
    }

    /// Goes on after a stop with the map at hand: what was given up is tried again.
    /// Without a stop it does only the latter.
    pub fn resume(&mut self) {
        if self.stopped {
            self.mission.end_errand();
        }
        self.stopped = false;
        self.silent = 0;
        self.turn_to = Turn::NONE;
        self.doubts.renew();
        self.done.reset();
        self.missed.reset();
        self.has_missed = false;
        self.open_all();
        self.round = 0;
        self.rest = 0;
        self.fruitless = 0;
        self.pushes = 0;
        self.way.clear();
        self.far.reset();
    }

    /// Nothing more is to be seen from `pose`.
    fn finish(&mut self, pose: Voxel) {
        if !self.done.get(pose) {
            self.done.set(pose);
            self.fruitless = 0;
        }
    }

    /// Decides. Call it once per step. The move is to a voxel that shares a face with the
    /// robot's; the stop says why nothing is left that the robot could reach a view of.
    /// Every later tick returns the same, until the robot hears of more, or
    /// [`resume`](Self::resume).
    ///
    /// Cost: [`work`](Self::work) is at most 43,008, and a view that was begun before; of a
    /// sensor that is turned, another view. A view looks at eight octants in rows, and walks at
    /// most one ray for each voxel in range.
    pub fn tick(&mut self) -> Action<Voxel, Voxel> {
        self.work = 0;
        self.waiting = Maybe::Nothing;
        self.peers.age();
        self.sender.tick();
        let action = self.decide();
        let action = self.heed(action);
        self.sent_to = match action {
            Action::Move(to) => Some(to),
            Action::Wait | Action::Stop(_) => None,
        };
        if !matches!(action, Action::Stop(_)) {
            self.mission.spend();
            self.turn(self.sent_to.unwrap_or(self.position));
        }
        action
    }

    /// Lets a step pass in which somebody else decides where the robot flies, in place of
    /// [`tick`](Self::tick).
    pub fn pass(&mut self) {
        self.work = 0;
        self.waiting = Maybe::Nothing;
        self.peers.age();
        self.sender.tick();
        self.stopped = false;
        self.way.clear();
        self.mission.spend();
    }

    fn decide(&mut self) -> Action<Voxel, Voxel> {
        let known = self.volume.age();
        let has_looked = core::mem::take(&mut self.looked);
        if self.lost {
            return self.wait(Wait::Pose);
        }
        if !self.mission.has_home() {
            // Nothing seen yet is not the same as nothing left.
            return self.wait(Wait::Sight);
        }
        if !has_looked {
            self.silent = self.silent.saturating_add(1);
        }
        let (reason, known_then) = self.reason;
        if self.stopped && known_then == known {
            return Action::Stop(reason);
        }
        self.stopped = false;
        if let Some(action) = self.mind_wind() {
            return action;
        }
        if let Some(action) = self.mind_mission() {
            return action;
        }
        if self.silent >= SILENCE {
            return self.end(match self.unknown_place() {
                Some(at) => self.unseen(at),
                None => Stop::Complete,
            });
        }
        if self.silent > 0 {
            return self.wait(Wait::Sight);
        }
        if self.rest > 0 {
            self.rest = self.rest.saturating_sub(1);
            return self.wait(Wait::Closed);
        }
        self.fruitless = if known == self.last_known {
            self.fruitless.saturating_add(1)
        } else {
            0
        };
        self.last_known = known;
        if !self.way.is_empty() && !self.done.get(self.goal) {
            // What was seen on the way may have left nothing to see at its end.
            self.gain(self.goal, 1);
        }
        if let Some(action) = self.follow() {
            self.look_ahead();
            return action;
        }
        if let Some(action) = self.look_round() {
            return action;
        }
        let action = if self.far.is_idle() && self.fruitless <= PATIENCE {
            self.look_near()
        } else {
            None
        };
        if let Some(action) = action {
            return action;
        }
        // Each time it does some work.
        loop {
            return match self.look_far() {
                far::Found::Searching if self.work < SLICE => continue,
                far::Found::Searching => self.wait(Wait::Search),
                far::Found::Way => self.follow().unwrap_or(Action::Wait),
                far::Found::Nothing => self.end_round(),
            };
        }
    }

    fn wait(&mut self, reason: Wait) -> Action<Voxel, Voxel> {
        self.waiting = Maybe::Just(reason);
        Action::Wait
    }

    /// The next step of the way, unless there is none or the goal is done.
    fn follow(&mut self) -> Option<Action<Voxel, Voxel>> {
        if self.done.get(self.goal) {
            self.way.clear();
        }
        let next = self.way.pop()?;
        let is_beside = self.position.distance_squared(next) == 1;
        if is_beside && self.volume.is_pose(next, self.clearance) && !self.closed.get(next) {
            return Some(Action::Move(next));
        }
        self.way.clear();
        None
    }
}

#[cfg(test)]
mod tests;
