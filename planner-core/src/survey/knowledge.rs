//! What one robot knows, senses and says: the part that all planners share.

use core::fmt;

use super::Limits;
use super::link::Link;
use super::mission::Errand;
use super::news::{MAX_RANGE, News, REPEATS};
use crate::cell::{Cell, Direction, Extent, ExtentError};
use crate::point::Point;
use crate::radio::{FrameError, Hearsay, HeightRecord, LinkConfig, MAX_LEN, Peer, Roster};
use crate::robot::{Action, Activity, Motion, RobotId, Status, Stop, Wait};
use crate::surface::{Column, Height, MAX_CLEARANCE, Patch, Surface, distance_to_tile};
use crate::tile::{TileIndex, bits};
use crate::zeroed::Maybe;

/// Unknown tiles that the turn passes over in a step.
const TURN_STRIDE: u8 = 8;

/// Looks in a row that show nothing where they must show something, after which the
/// sensor is taken to have failed.
const SILENCE: u8 = 100;

/// Robots heard of at places beyond these are not: distances would overflow.
const FARTHEST: f32 = 65_536.0;

/// A planner cannot be set up like this.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum SetupError {
    /// The planner's map does not hold the surface.
    Extent(ExtentError),
    /// The sensor range is not above 0 and at most [`MAX_RANGE`].
    Range,
    /// Another limit is negative, not finite, or a step is not above 0.
    Limits,
    /// The clearance is above [`MAX_CLEARANCE`].
    Clearance,
}

impl fmt::Display for SetupError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Extent(error) => write!(f, "{error}"),
            Self::Range => write!(
                f,
                "the sensor range must be above 0 and at most {MAX_RANGE}"
            ),
            Self::Limits => write!(
                f,
                "step, altitudes and separation must be finite and not negative"
            ),
            Self::Clearance => write!(f, "the clearance must be at most {MAX_CLEARANCE} columns"),
        }
    }
}

impl core::error::Error for SetupError {}

impl From<ExtentError> for SetupError {
    fn from(error: ExtentError) -> Self {
        Self::Extent(error)
    }
}

/// The state of one robot that does not depend on how it decides.
#[derive(Clone, Debug)]
pub struct Knowledge<const TW: usize, const TH: usize> {
    pub(super) limits: Limits,
    pub(super) surface: Surface<TW, TH>,
    pub(super) position: Point,
    news: News,
    pub(super) peers: Roster<Point, Cell>,
    /// The tile of the own map that is told next.
    turn: TileIndex,
    gain: f32,
    reward: f32,
    idle: u16,
    /// The flight that was ordered last, and whether it was refused.
    flight: (Point, Point),
    blocked: bool,
    /// Whether the last pose was one that nothing can be decided from.
    lost: bool,
    /// Whether the body was where it must not be at the last look, and whether it ever was
    /// where it may.
    pub(super) astray: bool,
    had_room: bool,
    /// Whether there was a look since the last tick.
    looked: bool,
    /// Looks in a row that showed nothing where they must show something.
    silent: u8,
    link: Link,
    /// Where the planner said that it goes.
    pub(super) goal: Option<Cell>,
    pub(super) stopped: bool,
    /// Why, and the number of known columns then.
    reason: (Stop, u32),
    /// Whether what was given up is to be tried again.
    resumed: bool,
    waiting: Maybe<Wait>,
    work: u32,
    pub(super) errand: Errand,
}

impl<const TW: usize, const TH: usize> Knowledge<TW, TH> {
    /// A robot without a map; a `static` of it costs no flash.
    pub const fn vacant() -> Self {
        Self {
            limits: Limits::NONE,
            surface: Surface::vacant(),
            position: Point::new(0.0, 0.0, 0.0),
            news: News::new(),
            peers: Roster::new(),
            turn: TileIndex { x: 0, y: 0 },
            gain: 0.0,
            reward: 0.0,
            idle: 0,
            flight: (Point::new(0.0, 0.0, 0.0), Point::new(0.0, 0.0, 0.0)),
            blocked: false,
            lost: false,
            astray: false,
            had_room: false,
            looked: false,
            silent: 0,
            link: Link::vacant(),
            goal: None,
            stopped: false,
            reason: (Stop::Complete, 0),
            resumed: false,
            waiting: Maybe::Nothing,
            work: 0,
            errand: Errand::vacant(),
        }
    }

    /// A robot that knows nothing of a surface of `extent` columns.
    ///
    /// `id` is the robot's name on the radio.
    pub fn new(
        extent: Extent,
        limits: Limits,
        link: LinkConfig,
        id: RobotId,
    ) -> Result<Self, SetupError> {
        let mut knowledge = Self::vacant();
        knowledge.reset(extent, limits, link, id)?;
        Ok(knowledge)
    }

    /// Starts anew, in place; unchanged after an error.
    pub fn reset(
        &mut self,
        extent: Extent,
        limits: Limits,
        link: LinkConfig,
        id: RobotId,
    ) -> Result<(), SetupError> {
        if !(limits.range > 0.0 && limits.range <= MAX_RANGE) {
            return Err(SetupError::Range);
        }
        let lengths = [limits.min_altitude, limits.ceiling, limits.separation];
        if !(limits.step > 0.0 && limits.step.is_finite())
            || lengths
                .iter()
                .any(|&length| !(length >= 0.0 && length.is_finite()))
        {
            return Err(SetupError::Limits);
        }
        if limits.clearance > MAX_CLEARANCE {
            return Err(SetupError::Clearance);
        }
        self.surface.reset(extent)?;
        self.limits = limits;
        self.position = Point::new(0.0, 0.0, 0.0);
        self.news = News::new();
        self.peers = Roster::new();
        self.turn = TileIndex { x: 0, y: 0 };
        self.gain = 0.0;
        self.reward = 0.0;
        self.idle = 0;
        self.blocked = false;
        self.lost = false;
        self.astray = false;
        self.had_room = false;
        self.looked = false;
        self.silent = 0;
        self.link = Link::new(link, id, extent);
        self.goal = None;
        self.stopped = false;
        self.resumed = false;
        self.waiting = Maybe::Nothing;
        self.work = 0;
        self.errand.reset();
        log!(info, "robot {}: starts over {} columns", id.0, extent);
        Ok(())
    }

    /// The fleet's physics.
    pub const fn limits(&self) -> Limits {
        self.limits
    }

    /// The map.
    pub const fn surface(&self) -> &Surface<TW, TH> {
        &self.surface
    }

    /// Where the robot was last.
    pub const fn position(&self) -> Point {
        self.position
    }

    /// The reward J of everything up to the last tick [Renzaglia2019 eq. 1].
    pub const fn reward(&self) -> f32 {
        self.reward
    }

    /// What the last tick added to the reward.
    pub const fn gain(&self) -> f32 {
        self.gain
    }

    /// Steps in a row without any gain.
    pub const fn idle(&self) -> u16 {
        self.idle
    }

    /// Where the robot said last that it goes.
    pub const fn goal(&self) -> Option<Cell> {
        self.goal
    }

    /// Announces where the robot goes.
    pub fn set_goal(&mut self, goal: Option<Cell>) {
        self.goal = goal;
    }

    /// Cells, tiles, words, candidates and samples looked at since the tick began.
    pub const fn work(&self) -> u32 {
        self.work
    }

    /// Counts `number` more of them.
    pub fn count_work(&mut self, number: u32) {
        self.work = self.work.saturating_add(number);
    }

    /// What the robot tells the others about itself.
    pub const fn status(&self) -> Status<Point, Cell> {
        Status {
            position: self.position,
            goal: self.goal,
            activity: Activity::stopped_if(self.stopped || self.errand.returns()),
        }
    }

    /// How many columns of the map others told first, and what was refused.
    /// Contradictions are not counted over heights.
    pub const fn hearsay(&self) -> Hearsay {
        self.link.hearsay()
    }

    /// The other robots as last heard.
    pub fn peers(&self) -> impl Iterator<Item = &Peer<Point, Cell>> {
        self.peers.iter()
    }

    /// The heard robots that still explore.
    pub(crate) fn rivals(&self) -> impl Iterator<Item = &Peer<Point, Cell>> {
        self.peers.rivals()
    }

    /// What the robot tells the others of its map in this step: the columns that it
    /// saw first in its last four steps, and one tile of all that it knows, another
    /// in each step. Call it after [`observe`](super::Surveyor::observe).
    pub fn patches(&self) -> impl Iterator<Item = Patch> + '_ {
        let news = (0..REPEATS).flat_map(move |age| {
            self.news.tiles(age).map(move |(tile, cells)| Patch {
                fresh: age == 0,
                ..self.surface.patch(tile, cells)
            })
        });
        news.chain([self.surface.patch(self.turn, !0)])
    }

    /// Writes the next frame and returns its length, or `None` while the budget does
    /// not allow one: what the robot saw first in its last four steps, newest first,
    /// and every fourth time, or when there is no such thing left, half a tile of all
    /// that it knows, another one each time.
    ///
    /// Cost: five tiles.
    pub(super) fn transmit(&mut self, buffer: &mut [u8; MAX_LEN]) -> Option<usize> {
        let mut frame = self.link.begin_frame(self.status())?;
        let mut taken = 0;
        while let Some(record) = self.next_record(taken) {
            taken += record.length();
            if frame.records.push(record).is_err() {
                break;
            }
        }
        Some(self.link.send(&frame, buffer))
    }

    /// The next record that fits beside `taken` bytes of others.
    fn next_record(&mut self, taken: usize) -> Option<HeightRecord> {
        if !self.link.is_turn()
            && let Some((tile, cells, fresh)) = self.news.next_unsent()
        {
            let patch = Patch {
                fresh,
                ..self.surface.patch(tile, cells)
            };
            let south = cells & 0xffff_ffff == 0;
            let record = HeightRecord::of(&patch, south, cells, taken)?;
            self.news.mark_sent(tile, record.tile_cells());
            return Some(record);
        }
        for _ in 0..TURN_STRIDE {
            let (tile, cells) = self.link.turn();
            let patch = self.surface.patch(tile, cells);
            if patch.cells == 0 {
                self.link.pass(self.surface.tile_after(tile));
                continue;
            }
            let south = patch.cells & 0xffff_ffff == 0;
            let record = HeightRecord::of(&patch, south, cells, taken)?;
            self.link.mark_sent(record.tile_cells());
            return Some(record);
        }
        None
    }

    /// Reads a frame and joins its heights into the map; says which columns it
    /// brought.
    ///
    /// # Errors
    /// See [`FrameError`]; nothing but [`hearsay`](Self::hearsay) has changed then.
    pub(super) fn receive(&mut self, bytes: &[u8]) -> Result<u32, FrameError> {
        let frame = self.link.read(bytes, self.surface.extent())?;
        let before = self.surface.known_columns();
        for record in &frame.records {
            self.merge(&record.patch());
        }
        self.peers
            .hear_frame(frame.sender, frame.status, frame.sequence);
        Ok(self.surface.known_columns() - before)
    }

    /// Whether something can be decided at `at`: it is finite, on the map, and not
    /// below the ground, as far as heights in quarters of a cell tell.
    fn is_pose(&self, at: Point) -> bool {
        let cell = at.cell();
        let ground = self.surface.height(cell).map_or(0.0, Height::cells);
        at.is_finite() && self.surface.extent().contains(cell) && at.z >= ground - Height(1).cells()
    }

    pub(super) fn observe(&mut self, at: Point, columns: &[Column]) {
        self.lost = !self.is_pose(at);
        self.looked = true;
        if self.lost {
            self.blocked = false;
            self.news.begin(self.position);
            return;
        }
        self.position = at;
        self.news.begin(at);
        let mut is_silent = true;
        for &column in columns {
            is_silent &= !self.surface.extent().contains(column.cell);
            if self.surface.learn(column) {
                self.news.add(column.cell);
            }
        }
        self.astray = self.sky().is_astray(at);
        self.errand.begin(at, self.had_room);
        self.had_room |= !self.astray;
        if !is_silent {
            if self.silent >= SILENCE {
                self.stopped = false;
            }
            self.silent = 0;
        } else if self.is_ground_in_range() {
            self.silent = self.silent.saturating_add(1);
        }
    }

    /// Whether any look from here must show something, as far as is known: the ground
    /// beneath. Before anything is known every look must.
    fn is_ground_in_range(&self) -> bool {
        let cell = self.position.cell();
        let is_near = |height: Height| {
            let ground = Point::over(cell, height.cells());
            self.position.distance(ground) <= self.limits.range
        };
        self.surface.known_columns() == 0 || self.surface.height(cell).is_some_and(is_near)
    }

    pub(super) fn hear(&mut self, id: RobotId, status: Status<Point, Cell>) {
        let Point { x, y, z } = status.position;
        if [x, y, z].iter().all(|at| at.abs() < FARTHEST) {
            self.peers.hear(id, status);
        }
    }

    pub(super) fn merge(&mut self, patch: &Patch) {
        if patch.fresh {
            self.news.share(patch.tile, patch.cells);
        }
        let before = self.surface.known_columns();
        self.surface.merge(patch);
        self.link.told(self.surface.known_columns() - before);
    }

    pub(super) fn report(&mut self, motion: Motion, at: Point) {
        self.lost = !self.is_pose(at);
        self.blocked = motion != Motion::Moved && !self.lost;
        if !self.lost {
            self.position = at;
        }
    }

    /// Whether the last pose was a bad one.
    pub(super) const fn is_lost(&self) -> bool {
        self.lost
    }

    /// The flight that was ordered last, from where to where.
    pub(super) const fn flight(&self) -> (Point, Point) {
        self.flight
    }

    /// Why the robot stopped, if it did, and the number of known columns then.
    pub(super) const fn reason(&self) -> (Stop, u32) {
        self.reason
    }

    /// Whether the last flight was refused.
    pub(crate) const fn is_blocked(&self) -> bool {
        self.blocked
    }

    /// The last flight, from where to where, if it was refused; asking clears it.
    pub fn take_refused(&mut self) -> Option<(Point, Point)> {
        core::mem::take(&mut self.blocked).then_some(self.flight)
    }

    /// The tail of every tick: remembers the flight that is ordered.
    pub fn end_tick(&mut self, action: Action<Point>) -> Action<Point> {
        if let Action::Move(to) = action {
            self.flight = (self.position, to);
        }
        action
    }

    /// The head of every tick: counts the step's gain. It ends the tick where there is
    /// nothing to decide: without a pose, after a stop, when everything is known, or
    /// when the sensor shows nothing.
    ///
    /// Cost: the columns seen first in this step; and a
    /// [`closest_frontier`](Self::closest_frontier) for a sensor that failed.
    pub fn begin_tick(&mut self) -> Option<Action<Point>> {
        self.work = 0;
        self.waiting = Maybe::Nothing;
        // Without another look nothing was gained.
        let has_looked = core::mem::take(&mut self.looked);
        self.gain = if has_looked { self.news.reward() } else { 0.0 };
        self.reward += self.gain;
        self.peers.age();
        self.turn = self.next_turn();
        self.link.tick();
        if self.lost {
            return Some(self.wait(Wait::Pose));
        }
        if !self.errand.has_home() {
            // Nothing seen yet is not the same as nothing left.
            return Some(self.wait(Wait::Sight));
        }
        self.idle = if self.gain > 0.0 {
            0
        } else {
            self.idle.saturating_add(1)
        };
        let known_columns = self.surface.known_columns();
        let (reason, known_then) = self.reason;
        if self.stopped && known_then == known_columns {
            return Some(self.stop(reason));
        }
        self.stopped = false;
        if known_columns > 0 && self.surface.frontiers() == 0 {
            return Some(self.stop(Stop::Complete));
        }
        match self.silent {
            0 => None,
            SILENCE.. => Some(self.stop(Stop::Unseen {
                frontiers: self.surface.frontiers(),
                at: self.unseen_place(),
            })),
            _ => Some(self.wait(Wait::Sight)),
        }
    }

    /// Stops the robot for `reason`, until it knows more.
    pub fn stop(&mut self, reason: Stop) -> Action<Point> {
        self.goal = None;
        if !self.stopped {
            log!(info, "robot {}: stops: {}", self.link.id().0, reason);
        }
        self.stopped = true;
        self.reason = (reason, self.surface.known_columns());
        Action::Stop(reason)
    }

    /// Stays for this step, and says why.
    pub fn wait(&mut self, reason: Wait) -> Action<Point> {
        self.waiting = Maybe::Just(reason);
        Action::Wait
    }

    /// Why the robot hovers, where it is known.
    pub(super) const fn waiting(&self) -> Option<Wait> {
        self.waiting.get()
    }

    pub(super) fn resume(&mut self) {
        self.stopped = false;
        self.resumed = true;
        self.silent = 0;
        self.idle = 0;
        self.errand.resume();
    }

    /// Whether what was given up is to be tried again; asking clears it.
    pub(crate) fn take_resumed(&mut self) -> bool {
        core::mem::take(&mut self.resumed)
    }

    /// An unknown column beside the nearest frontier; the robot's own without any.
    ///
    /// Cost: a [`closest_frontier`](Self::closest_frontier).
    pub fn unseen_place(&self) -> Cell {
        let (nearest, _) = self.closest_frontier();
        nearest
            .and_then(|cell| {
                let beside = Direction::ALL.map(|direction| cell.step(direction));
                beside
                    .into_iter()
                    .find(|&beside| self.surface.is_unknown(beside))
            })
            .unwrap_or(self.position.cell())
    }

    /// The tile to tell next: the first of a few of which something is known.
    fn next_turn(&self) -> TileIndex {
        let mut tile = self.turn;
        for _ in 0..TURN_STRIDE {
            tile = self.surface.tile_after(tile);
            if self.surface.known(tile) != 0 {
                break;
            }
        }
        tile
    }

    /// The frontier nearest to the robot on the ground plan, and the number of words,
    /// tiles and cells looked at.
    ///
    /// It is the nearest of those in the eight nearest tiles with frontiers; one
    /// farther away can be nearer by the diagonal of a tile at most.
    ///
    /// Cost: a [`Surface::nearest_frontier_tiles`], and 512 cells at most.
    // [Renzaglia2019 Algorithm 1, ClosestFrontier]
    pub fn closest_frontier(&self) -> (Option<Cell>, u32) {
        let (tiles, mut work) = self.surface.nearest_frontier_tiles::<8>(self.position);
        let mut best: Option<(f32, Cell)> = None;
        for &tile in &tiles {
            work += 1;
            if best.is_some_and(|(least, _)| distance_to_tile(self.position, tile) >= least) {
                break;
            }
            for bit in bits(self.surface.frontier_cells(tile)) {
                work += 1;
                let cell = tile.cell(bit);
                let distance = self.position.plan_distance(Point::over(cell, 0.0));
                if best.is_none_or(|(least, _)| distance < least) {
                    best = Some((distance, cell));
                }
            }
        }
        (best.map(|(_, cell)| cell), work)
    }
}
