//! Local frontiers, as published: the planner that decides by what is in view
//! [Gauville2019 §3.2], with second chance [Gauville2019 §6.1].
//!
//! F. Gauville, F. Charpillet, "Exploration et couverture par stigmergie d'un
//! environnement inconnu avec une flotte de robots autonomes réactifs", 2019.
//! The robot walks to the frontier in view that is farthest from anybody's trace;
//! with no frontier in view it goes back along its own trace, and stops at its
//! start.
//!
//! **It is not complete**, whatever the paper says: it can be back at its start
//! with cells left, and it can walk in circles for ever (the tests beside this
//! module hold worlds of a dozen cells where it does). It is here to be studied
//! and measured against. It never claims more than it knows: see
//! [`LocalFrontiers::tick`](Planner::tick).
//!
//! Added to the text, which is silent there:
//! - **Ties** between frontiers go by the length of the way, then by rows, and
//!   from the equals robot i takes number i: robots in one place that know the same
//!   would otherwise never part.
//! - **A blocked step** drops the goal and closes that cell for 4 ticks, doubling
//!   to 64 with each further blocked step. With no frontier in view the robot waits
//!   for it to open; from the fourth blocked step on it makes room and goes back by
//!   the trace, which may cost it the frontier. While a cell is closed it does not
//!   stop. After 12 blocked steps without a cell learnt in between it gives up with
//!   [`Stop::Blocked`].
//! - **Nothing left**: where the text stops and the robot's map holds no frontier
//!   at all, the reason is [`Stop::Complete`]: then every neighbour of the known
//!   free cells around the robot is known, so they are all that it can reach.
//! - **Second chance** keeps up the trace 𝒢, so that the robot prefers cells new
//!   to it and finds home; among equals it turns left before straight on, right
//!   and back, or it would swing between two cells. When nobody explores any more
//!   it goes home by the trace as in step 2c, still in that mode, and stops there.

mod closed;
mod config;
mod others;
mod rules;
mod trace;
mod view;

use crate::cell::ExtentError;
use crate::cell::{Cell, Direction, Extent};
use crate::map::{Learnt, Map};
use crate::planner::{Contact, Errands, Inspect, LongSight, Persist, Planner};
use crate::radio::{FrameError, Heard, Hearsay, Link, MAX_LEN};
use crate::robot::{Action, Activity, Motion, RobotId, Status, Stop, Wait};
use crate::sight::{MAX_RADIUS, Sighting};
use crate::tile::{TileIndex, TileSet};

use closed::Closed;
pub use config::{Config, Distance, Neighbourhood};
use others::Others;
use trace::Trace;
use view::{REACH, View};

/// A cell to go to, and the moves made since it was chosen.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Goal {
    cell: Cell,
    moves: u16,
}

/// What the robot has come to. The explicit representation makes the first one
/// all zero bits, and with it the whole vacant planner.
#[derive(Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
enum Phase {
    /// Without a grid.
    Vacant,
    /// Has not looked yet.
    Blind,
    Exploring,
    SecondChance,
    Stopped(Stop),
}

/// The local-frontiers planner of one robot, on a grid of at most `8·TW` × `8·TH`
/// cells.
///
/// Memory: 153 bytes a tile (the map's 25 and 128 for the trace), and less than
/// one KiB.
#[derive(Clone, PartialEq, Eq)]
pub struct LocalFrontiers<const TW: usize, const TH: usize> {
    config: Config,
    id: RobotId,
    map: Map<TW, TH>,
    link: Link<TH>,
    trace: Trace<TW, TH>,
    view: View,
    start: Cell,
    position: Cell,
    /// Direction of the last move.
    heading: Direction,
    /// Whether the last action was a move that has not been reported on.
    moving: bool,
    goal: Option<Goal>,
    phase: Phase,
    others: Others,
    closed: Closed,
    /// Whether the last pose lay off the grid.
    is_astray: bool,
    work: u32,
}

impl<const TW: usize, const TH: usize> LocalFrontiers<TW, TH> {
    /// A planner without a grid: all zero, so a `static` of it lies in `.bss`.
    /// Call [`reset`](Self::reset) before use; until then it waits.
    pub const fn vacant() -> Self {
        Self {
            config: Config::VACANT,
            id: RobotId(0),
            map: Map::vacant(),
            link: Link::vacant(),
            trace: Trace::new(),
            view: View::vacant(),
            start: Cell::new(0, 0),
            position: Cell::new(0, 0),
            heading: Direction::East,
            moving: false,
            goal: None,
            phase: Phase::Vacant,
            others: Others::new(),
            closed: Closed::new(),
            is_astray: false,
            work: 0,
        }
    }

    /// A planner for robot `id`, which stands on `start` and knows nothing of a
    /// grid of `extent` yet. Where the stack is small use [`vacant`](Self::vacant)
    /// and [`reset`](Self::reset).
    ///
    /// # Errors
    /// The extent is empty or larger than [`Map::CAPACITY`], or the start lies outside.
    pub fn new(
        config: Config,
        id: RobotId,
        extent: Extent,
        start: Cell,
    ) -> Result<Self, ExtentError> {
        let mut planner = Self::vacant();
        planner.reset(config, id, extent, start)?;
        Ok(planner)
    }

    /// Forgets everything and begins anew, in place. Work: every tile once.
    ///
    /// # Errors
    /// As [`new`](Self::new); the planner is then unchanged.
    pub fn reset(
        &mut self,
        config: Config,
        id: RobotId,
        extent: Extent,
        start: Cell,
    ) -> Result<(), ExtentError> {
        self.map.reset_with(extent, start)?;
        self.trace.clear();
        self.link.reset(config.link, id, extent);
        self.config = config;
        self.id = id;
        self.view = View::vacant();
        self.start = start;
        self.position = start;
        self.heading = Direction::East;
        self.moving = false;
        self.goal = None;
        self.phase = Phase::Blind;
        self.others = Others::new();
        self.closed = Closed::new();
        self.is_astray = false;
        self.work = 0;
        log!(
            info,
            "robot {}: starts at {} of {} cells",
            id.0,
            start,
            extent
        );
        Ok(())
    }

    /// The robot's identity.
    pub const fn id(&self) -> RobotId {
        self.id
    }

    /// The most work that a tick can take with sightings of `radius` cells (more
    /// than [`MAX_RADIUS`] counts as that), in rows of the window. Neither the
    /// map's size nor the number of robots matters.
    ///
    /// The window has w = 2·radius + 1 rows. Laying out what is open, unknown and
    /// visited takes 3·w + 34 rows. At most five waves run, each of at most w²
    /// layers and one that finds nothing, of w rows. At most w² frontier cells
    /// look for the nearest visited cell, in 33 rows each. A wave of w² layers
    /// needs a sensor that sees round corners: with [`look`](crate::sight::look)
    /// at radius 5 no tick of the tests takes more than a fifth of the bound.
    pub const fn work_bound(radius: u8) -> u32 {
        let radius = if radius < MAX_RADIUS {
            radius
        } else {
            MAX_RADIUS
        };
        let w = 2 * radius as u32 + 1;
        let margins = 2 + 2 * REACH as u32;
        3 * w + margins + 5 * (w * w + 1) * w + (2 * REACH as u32 + 1) * w * w
    }

    fn note(&mut self, learnt: Learnt) -> Learnt {
        if learnt.anything() {
            self.closed.renew();
        }
        learnt
    }
}

impl<const TW: usize, const TH: usize> Planner<TW, TH> for LocalFrontiers<TW, TH> {
    /// [Gauville2019 §3.2 step 1]. Work: as [`Map::observe`].
    fn observe(&mut self, sighting: &Sighting) -> Learnt {
        match self.phase {
            Phase::Vacant => return Learnt::default(),
            Phase::Blind if self.map.extent().contains(sighting.centre()) => {
                self.phase = Phase::Exploring;
            }
            _ => {}
        }
        self.is_astray = !self.map.extent().contains(sighting.centre());
        if self.is_astray {
            return Learnt::default();
        }
        self.position = sighting.centre();
        self.view = View::of(sighting);
        let learnt = self.map.observe(sighting);
        if let Some((at, _)) = TileIndex::of(self.position) {
            self.link.look(sighting, at, 0);
        }
        self.link.announce(&mut self.map);
        self.note(learnt)
    }

    /// One round of steps 2 and 3: one move. Work: at most
    /// [`work_bound`](Self::work_bound) rows.
    ///
    /// Stops with [`Stop::BackAtStart`] or [`Stop::NoTrace`] while the map has
    /// frontiers, [`Stop::Blocked`] when trying became pointless, and
    /// [`Stop::Complete`] only when the map has no frontier. Waits before the
    /// first sighting, and while the only step left is closed.
    fn tick(&mut self) -> Action {
        self.work = 0;
        self.link.tick();
        let action = match self.phase {
            Phase::Stopped(stop) => Action::Stop(stop),
            Phase::Vacant | Phase::Blind => Action::Wait,
            Phase::Exploring | Phase::SecondChance if self.is_astray => Action::Wait,
            Phase::Exploring | Phase::SecondChance => self.decide(),
        };
        self.moving = false;
        if let Action::Move(direction) = action {
            self.heading = direction;
            self.moving = true;
        }
        self.closed.age();
        self.others.age(self.config.silence);
        action
    }

    fn waiting(&self) -> Option<Wait> {
        match self.phase {
            _ if self.is_astray => Some(Wait::Pose),
            Phase::Blind => Some(Wait::Sight),
            _ => None,
        }
    }

    fn resume(&mut self) {
        self.closed = Closed::new();
        if let Phase::Stopped(_) = self.phase {
            self.phase = Phase::Exploring;
            self.trace.clear();
            self.start = self.position;
        }
    }

    /// A blocked step closes the cell for a while. Without a move to report on it
    /// does nothing.
    fn report(&mut self, motion: Motion) {
        if !core::mem::take(&mut self.moving) {
            return;
        }
        let next = self.position.step(self.heading);
        match motion {
            Motion::Moved => {
                self.position = next;
                if let Some(goal) = &mut self.goal {
                    goal.moves = goal.moves.saturating_add(1);
                }
            }
            Motion::Held => {}
            Motion::Blocked => {
                log!(debug, "robot {}: is blocked at {}", self.id.0, next);
                self.goal = None;
                self.closed.close(next);
                if self.closed.is_hopeless() {
                    let frontiers = self.map.frontiers();
                    self.stop(Stop::Blocked {
                        frontiers,
                        at: next,
                    });
                }
            }
        }
    }

    fn map(&self) -> &Map<TW, TH> {
        &self.map
    }

    fn status(&self) -> Status {
        Status {
            position: self.position,
            goal: self.goal.map(|goal| goal.cell),
            activity: match self.phase {
                Phase::Stopped(_) => Activity::Stopped,
                Phase::SecondChance => Activity::SecondChance,
                Phase::Vacant | Phase::Blind | Phase::Exploring => Activity::Exploring,
            },
        }
    }

    fn transmit(&mut self, buffer: &mut [u8; MAX_LEN]) -> Option<usize> {
        let status = self.status();
        self.link.transmit(&self.map, status, buffer)
    }

    fn receive(&mut self, bytes: &[u8]) -> Result<Heard, FrameError> {
        let heard = self.link.receive(bytes, &mut self.map)?;
        self.note(heard.learnt);
        if let Some(status) = heard.status {
            self.hear(heard.from, status);
        }
        Ok(heard)
    }

    fn hearsay(&self) -> Hearsay {
        self.link.hearsay()
    }
}

impl<const TW: usize, const TH: usize> Contact<TW, TH> for LocalFrontiers<TW, TH> {
    fn take_changed(&mut self) -> TileSet<TH> {
        self.link.take_changed(&mut self.map)
    }

    fn join(&mut self, other: &Map<TW, TH>, tiles: &TileSet<TH>) -> Learnt {
        let learnt = self.map.join_tiles(other, tiles);
        self.link.joined(learnt);
        self.note(learnt)
    }

    /// Keeps only whether that robot explores; a second chance asks for no more.
    fn hear(&mut self, id: RobotId, status: Status) {
        if id != self.id {
            self.others.hear(id, status.activity);
        }
    }
}

impl<const TW: usize, const TH: usize> Errands<TW, TH> for LocalFrontiers<TW, TH> {}

impl<const TW: usize, const TH: usize> Persist<TW, TH> for LocalFrontiers<TW, TH> {}

impl<const TW: usize, const TH: usize> LongSight<TW, TH> for LocalFrontiers<TW, TH> {}

impl<const TW: usize, const TH: usize> Inspect<TW, TH> for LocalFrontiers<TW, TH> {
    /// Rows of the window.
    fn work(&self) -> u32 {
        self.work
    }
}

#[cfg(test)]
mod tests;
