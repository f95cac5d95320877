//! The verbs of a robot that follows the marks.

use std::sync::{Arc, Mutex, MutexGuard};

use planner_core::ExtentError;
use planner_core::radio::{FrameError, Heard, Link, LinkConfig, MAX_LEN};
use planner_core::{
    Action, Activity, Cell, Contact, Errands, Extent, Inspect, Learnt, LongSight, Map, Motion,
    Persist, Planner, RobotId, Sighting, Status, Stop, TileSet,
};

use super::board::Board;
use super::robot::{Decision, Robot};

/// Blocked steps in a row until the robot gives up.
const PATIENCE: u32 = 1000;

/// The board on which a team leaves its marks.
#[derive(Clone, Debug)]
pub struct Marks(Arc<Mutex<Board>>);

impl Marks {
    /// A board without marks, for robots that are to meet at `rendezvous`.
    pub fn new(extent: Extent, rendezvous: Cell) -> Self {
        Self(Arc::new(Mutex::new(Board::new(extent, rendezvous))))
    }

    pub(super) fn lock(&self) -> MutexGuard<'_, Board> {
        self.0.lock().expect("no robot panics at the board")
    }
}

/// Brick & Mortar Improved Long Range Vision [Andries2015; Gauville2019 §2.2;
/// after Ferranti2007]: robots close the cells that nobody needs any more, until
/// all that is left is the rendezvous.
///
/// The robots decide by [`Marks`] that all of them read and write at any time:
/// no decentralised version has been published [Gauville2019 §7.1]. So what the
/// medium loses or delays changes nothing but the robots' maps.
pub struct Bmilrv<const TW: usize, const TH: usize> {
    marks: Marks,
    robot: Robot,
    map: Box<Map<TW, TH>>,
    link: Link<TH>,
    heading: Option<Cell>,
    blocked_steps: u32,
    stopped: Option<Stop>,
    /// Whether the last pose lay off the grid.
    is_astray: bool,
}

impl<const TW: usize, const TH: usize> Bmilrv<TW, TH> {
    /// Robot `id` at `start` on a grid of `extent`, among the robots that share
    /// `marks`.
    ///
    /// # Errors
    /// A grid that a map of this size does not hold.
    pub fn new(
        marks: Marks,
        id: RobotId,
        extent: Extent,
        start: Cell,
        config: LinkConfig,
    ) -> Result<Self, ExtentError> {
        let mut map = Box::new(Map::vacant());
        map.reset_with(extent, start)?;
        let mut link = Link::vacant();
        link.reset(config, id, extent);
        let now = marks.lock().enter(id, start);
        Ok(Self {
            marks,
            robot: Robot::new(id, start, extent.cells() as usize, now),
            map,
            link,
            heading: None,
            blocked_steps: 0,
            stopped: None,
            is_astray: false,
        })
    }
}

impl<const TW: usize, const TH: usize> Planner<TW, TH> for Bmilrv<TW, TH> {
    fn observe(&mut self, sighting: &Sighting) -> Learnt {
        self.is_astray = !self.map.extent().contains(sighting.centre());
        if self.is_astray {
            return Learnt::default();
        }
        let mut board = self.marks.lock();
        board.observe(sighting);
        self.robot.look(&mut board, sighting);
        self.map.stand(sighting.centre());
        let learnt = self.map.observe(sighting);
        self.link.announce(&mut self.map);
        learnt
    }

    fn tick(&mut self) -> Action {
        self.robot.work = 0;
        self.link.tick();
        if let Some(stop) = self.stopped {
            return Action::Stop(stop);
        }
        self.heading = None;
        if self.is_astray {
            return Action::Wait;
        }
        match self.robot.decide(&mut self.marks.lock()) {
            Decision::Go(direction) => {
                self.heading = Some(self.robot.position().step(direction));
                Action::Move(direction)
            }
            Decision::Wait => Action::Wait,
            Decision::Stop => {
                let stop = match self.map.frontiers() {
                    0 => Stop::nothing_left(self.map.free_edge_cells()),
                    frontiers => Stop::Enclosed { frontiers },
                };
                self.stopped = Some(stop);
                Action::Stop(stop)
            }
        }
    }

    fn resume(&mut self) {
        self.stopped = None;
        self.blocked_steps = 0;
    }

    fn report(&mut self, motion: Motion) {
        let Some(to) = self.heading else { return };
        match motion {
            Motion::Moved => {
                self.blocked_steps = 0;
                self.robot.step(&mut self.marks.lock(), to);
            }
            Motion::Blocked => {
                self.blocked_steps += 1;
                if self.blocked_steps > PATIENCE {
                    let frontiers = self.map.frontiers();
                    self.stopped = Some(Stop::Blocked { frontiers, at: to });
                }
            }
            Motion::Held => {}
        }
    }

    fn transmit(&mut self, buffer: &mut [u8; MAX_LEN]) -> Option<usize> {
        let status = self.status();
        self.link.transmit(&self.map, status, buffer)
    }

    fn receive(&mut self, bytes: &[u8]) -> Result<Heard, FrameError> {
        self.link.receive(bytes, &mut self.map)
    }

    fn map(&self) -> &Map<TW, TH> {
        &self.map
    }

    fn status(&self) -> Status {
        let activity = match self.stopped {
            Some(_) => Activity::Stopped,
            None => Activity::Exploring,
        };
        Status {
            position: self.robot.position(),
            goal: self.heading,
            activity,
        }
    }
}

impl<const TW: usize, const TH: usize> Contact<TW, TH> for Bmilrv<TW, TH> {
    fn take_changed(&mut self) -> TileSet<TH> {
        self.link.take_changed(&mut self.map)
    }

    fn join(&mut self, other: &Map<TW, TH>, tiles: &TileSet<TH>) -> Learnt {
        self.map.join_tiles(other, tiles)
    }

    /// The board tells where the others are.
    fn hear(&mut self, _id: RobotId, _status: Status) {}
}

impl<const TW: usize, const TH: usize> Errands<TW, TH> for Bmilrv<TW, TH> {}

impl<const TW: usize, const TH: usize> Persist<TW, TH> for Bmilrv<TW, TH> {}

impl<const TW: usize, const TH: usize> LongSight<TW, TH> for Bmilrv<TW, TH> {}

impl<const TW: usize, const TH: usize> Inspect<TW, TH> for Bmilrv<TW, TH> {
    fn work(&self) -> u32 {
        self.robot.work
    }
}
