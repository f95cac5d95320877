//! What one robot knows, senses and says: the part that all planners share.

use core::fmt;

use super::news::{MAX_RANGE, News, REPEATS};
use super::peers::{Peer, Peers};
use super::{Limits, Motion, Status};
use crate::cell::{Cell, Extent};
use crate::point::Point;
use crate::surface::{Column, Patch, Surface, Tile, TooLarge};

/// A planner cannot be set up like this.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum SetupError {
    /// The map is larger than the planner's type allows.
    TooLarge(TooLarge),
    /// The sensor range is not above 0 and at most [`MAX_RANGE`].
    Range,
    /// Another limit is negative, not finite, or a step is not above 0.
    Limits,
}

impl fmt::Display for SetupError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooLarge(error) => write!(f, "{error}"),
            Self::Range => write!(
                f,
                "the sensor range must be above 0 and at most {MAX_RANGE}"
            ),
            Self::Limits => write!(
                f,
                "step, altitudes and separation must be finite and not negative"
            ),
        }
    }
}

impl core::error::Error for SetupError {}

impl From<TooLarge> for SetupError {
    fn from(error: TooLarge) -> Self {
        Self::TooLarge(error)
    }
}

/// The state of one robot that does not depend on how it decides.
#[derive(Clone, Debug)]
pub struct Knowledge<const TW: usize, const TH: usize> {
    pub(super) limits: Limits,
    pub(super) surface: Surface<TW, TH>,
    pub(super) position: Point,
    news: News,
    pub(super) peers: Peers,
    /// The tile of the own map that is told next.
    turn: Tile,
    gain: f32,
    reward: f32,
    idle: u16,
    blocked: bool,
}

impl<const TW: usize, const TH: usize> Knowledge<TW, TH> {
    /// A robot without a map; a `static` of it costs no flash.
    pub const fn vacant() -> Self {
        Self {
            limits: Limits::NONE,
            surface: Surface::vacant(),
            position: Point::new(0.0, 0.0, 0.0),
            news: News::new(),
            peers: Peers::new(),
            turn: Tile { x: 0, y: 0 },
            gain: 0.0,
            reward: 0.0,
            idle: 0,
            blocked: false,
        }
    }

    /// A robot that knows nothing of a surface of `extent` columns.
    pub fn new(extent: Extent, limits: Limits) -> Result<Self, SetupError> {
        let mut knowledge = Self::vacant();
        knowledge.reset(extent, limits)?;
        Ok(knowledge)
    }

    /// Starts anew, in place; unchanged after an error.
    pub fn reset(&mut self, extent: Extent, limits: Limits) -> Result<(), SetupError> {
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
        self.surface.reset(extent)?;
        self.limits = limits;
        self.position = Point::new(0.0, 0.0, 0.0);
        self.news = News::new();
        self.peers = Peers::new();
        self.turn = Tile { x: 0, y: 0 };
        self.gain = 0.0;
        self.reward = 0.0;
        self.idle = 0;
        self.blocked = false;
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

    /// The other robots as last heard.
    pub fn peers(&self) -> impl Iterator<Item = &Peer> {
        self.peers.iter()
    }

    /// The heard robots that still explore.
    pub(crate) fn rivals(&self) -> impl Iterator<Item = &Peer> {
        self.peers().filter(|peer| !peer.status.stopped)
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

    pub(super) fn observe(&mut self, at: Point, columns: &[Column]) {
        if at.is_finite() {
            self.position = at;
        }
        self.news.begin(self.position);
        for &column in columns {
            if self.surface.learn(column) {
                self.news.add(column.cell);
            }
        }
    }

    pub(super) fn hear(&mut self, id: u8, status: Status) {
        if status.position.is_finite() {
            self.peers.hear(id, status);
        }
    }

    pub(super) fn merge(&mut self, patch: &Patch) {
        if patch.fresh {
            self.news.share(patch.tile, patch.cells);
        }
        self.surface.merge(patch);
    }

    pub(super) fn report(&mut self, motion: Motion) {
        self.blocked = motion == Motion::Blocked;
    }

    /// Whether the last flight was refused; asking clears it.
    pub(crate) fn take_blocked(&mut self) -> bool {
        core::mem::take(&mut self.blocked)
    }

    /// Counts the step's gain. Call it once, at the head of every tick.
    ///
    /// Cost: the columns seen first in this step, and the tiles of the map.
    pub fn settle(&mut self) -> f32 {
        self.gain = self.news.reward();
        self.reward += self.gain;
        self.idle = if self.gain > 0.0 {
            0
        } else {
            self.idle.saturating_add(1)
        };
        self.peers.age();
        self.turn = self
            .surface
            .tiles()
            .skip_while(|&tile| tile != self.turn)
            .skip(1)
            .chain(self.surface.tiles())
            .find(|&tile| self.surface.known(tile) != 0)
            .unwrap_or(self.turn);
        self.gain
    }

    /// The frontier nearest to `from` on the ground plan for which `wanted` holds,
    /// and the number of tiles and cells looked at.
    ///
    /// Cost: every tile once, and the frontiers of the tiles that may hold a nearer
    /// one than found so far.
    // [Renzaglia2019 Algorithm 1, ClosestFrontier]
    pub fn closest_frontier(
        &self,
        from: Point,
        mut wanted: impl FnMut(Cell) -> bool,
    ) -> (Option<Cell>, u32) {
        let mut best: Option<(f32, Cell)> = None;
        let mut work = 0u32;
        for tile in self.surface.tiles() {
            work = work.saturating_add(1);
            if self.surface.frontiers_in(tile) == 0
                || best.is_some_and(|(distance, _)| distance_to_tile(from, tile) >= distance)
            {
                continue;
            }
            for bit in crate::surface::Bits(self.surface.frontier_cells(tile)) {
                work = work.saturating_add(1);
                let cell = tile.cell(bit);
                let distance = from.plan_distance(Point::over(cell, 0.0));
                if best.is_none_or(|(least, _)| distance < least) && wanted(cell) {
                    best = Some((distance, cell));
                }
            }
        }
        (best.map(|(_, cell)| cell), work)
    }
}

/// Distance on the plan from `from` to the nearest cell centre that `tile` can have.
pub(crate) fn distance_to_tile(from: Point, tile: Tile) -> f32 {
    let (north_west, south_east) = (tile.cell(0), tile.cell(63));
    let beside = |at: f32, low: i16, high: i16| {
        (f32::from(low) + 0.5 - at)
            .max(at - f32::from(high) - 0.5)
            .max(0.0)
    };
    crate::math::length(
        beside(from.x, north_west.x, south_east.x),
        beside(from.y, north_west.y, south_east.y),
    )
}
