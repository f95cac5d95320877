//! A run that goes on tick by tick.

use std::sync::Arc;

use planner_core::map::Tile;
use planner_core::tile::TileIndex;
use planner_core::{Cell, Direction, RobotId, Wait};

use super::book::{Book, joined};
use super::grid::fleet_on;
use super::{Host, Outcome, Progress};
use crate::fleet::Fleet;
use crate::medium::Message;
use crate::record::grid::{Record, Trace};
use crate::robot::{Robot, Step};
use crate::saves::Save;
use crate::scenario::grid::Scenario;
use crate::sensor::Sensor;
use crate::world::KnownMap;

/// A run between two ticks, on maps of `TW`×`TH` tiles.
pub struct Running<const TW: usize, const TH: usize> {
    scenario: Scenario,
    fleet: Fleet<TW, TH>,
    book: Book,
}

impl<const TW: usize, const TH: usize> Running<TW, TH> {
    /// A checked scenario before its first tick.
    ///
    /// # Panics
    /// If the world does not fit maps of this size.
    pub(super) fn new(
        host: &impl Host,
        scenario: &Scenario,
        sensor: Option<Arc<Sensor>>,
        trace: bool,
    ) -> Self {
        let sensor = sensor.unwrap_or_else(|| scenario.sensor());
        Self {
            fleet: fleet_on(host, scenario, sensor.clone()),
            book: Book::new(scenario, sensor, trace),
            scenario: scenario.clone(),
        }
    }

    /// Runs one tick; false if the run was over before it.
    pub fn tick(&mut self) -> bool {
        if self.is_over() {
            return false;
        }
        self.fleet.tick();
        self.book.note(&self.fleet);
        true
    }

    /// Whether every living robot has stopped, or time is up.
    pub fn is_over(&self) -> bool {
        self.fleet.ticks() >= self.scenario.conditions.max_ticks || self.fleet.has_stopped()
    }

    /// How far the run has come.
    pub fn progress(&self) -> Progress {
        self.book.progress()
    }

    /// What happened.
    pub fn end(self) -> (Outcome, Option<Trace>) {
        self.book.close(&self.scenario, &self.fleet)
    }

    fn of(&self, robot: usize) -> &Robot<TW, TH> {
        &self.fleet.robots()[robot]
    }
}

/// What can be seen of a robot from outside; its map apart.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    /// Its number.
    pub id: RobotId,
    /// Where its body is.
    pub position: Cell,
    /// Which way it is turned.
    pub heading: Direction,
    /// Whether it lives.
    pub alive: bool,
    /// Whether its body is in the world.
    pub is_there: bool,
    /// What it did in the last tick.
    pub step: Option<Step>,
    /// Why it waits; `None`: it does not, or its planner does not tell.
    pub waiting: Option<Wait>,
    /// Where it is going.
    pub goal: Option<Cell>,
    /// Steps to the goal at most, and changes to a longer plan since it last
    /// learnt anything; `None`: its planner does not tell.
    pub plan: Option<(u32, u8)>,
    /// Cells on its map, obstacles included.
    pub known_cells: u32,
    /// Frontier cells on its map.
    pub frontiers: u32,
    /// Cells that were free on its map and became walls.
    pub shut_cells: u32,
    /// Whether its looks contradict its map.
    pub is_lost: bool,
}

/// A [`Running`] of any size. Robots are named by index, which is their id.
pub trait Stepping {
    /// As [`Running::tick`].
    fn tick(&mut self) -> bool;
    /// As [`Running::is_over`].
    fn is_over(&self) -> bool;
    /// As [`Running::progress`].
    fn progress(&self) -> Progress;
    /// What is run.
    fn scenario(&self) -> &Scenario;
    /// What can be seen of a robot.
    fn robot(&self, robot: usize) -> Seen;
    /// One tile of a robot's map.
    fn tile(&self, robot: usize, at: TileIndex) -> Tile;
    /// The frontier cells of one tile of a robot's map.
    fn frontier(&self, robot: usize, at: TileIndex) -> u64;
    /// By how many more looks a robot saw a cell near it blocked than free, -3 to 3.
    fn votes(&self, robot: usize, cell: Cell) -> i8;
    /// The cells of one tile that a robot's search over the whole map has reached.
    fn searched(&self, robot: usize, at: TileIndex) -> u64;
    /// The next steps of a robot's plan.
    fn way(&self, robot: usize) -> Vec<Direction>;
    /// The records of all ticks done.
    fn records(&self) -> &[Record];
    /// From now on, remember the messages of each tick.
    fn listen(&mut self);
    /// What was said in the last tick, heard, lost or under way. Empty without
    /// [`listen`](Self::listen).
    fn messages(&self) -> &[Message];
    /// What happened up to now.
    fn outcome(&self) -> Outcome;
    /// What the living robots know together, except of cells that they keep out of.
    fn known(&self) -> KnownMap;
    /// What the planners know, to go on from; `None` where they cannot be saved.
    fn save(&self) -> Option<Save>;
}

impl<const TW: usize, const TH: usize> Stepping for Running<TW, TH> {
    fn tick(&mut self) -> bool {
        Running::tick(self)
    }

    fn is_over(&self) -> bool {
        Running::is_over(self)
    }

    fn progress(&self) -> Progress {
        Running::progress(self)
    }

    fn scenario(&self) -> &Scenario {
        &self.scenario
    }

    fn robot(&self, robot: usize) -> Seen {
        let heading = self.fleet.heading(robot);
        let robot = self.of(robot);
        let map = robot.planner.map();
        let role = robot.planner.role();
        Seen {
            id: robot.id,
            position: robot.position,
            heading,
            waiting: robot.planner.waiting(),
            alive: robot.alive,
            is_there: robot.is_there(),
            step: robot.step,
            goal: robot.planner.status().goal,
            plan: role.map(|role| (role.remaining(), role.changes())),
            known_cells: map.known_cells(),
            frontiers: map.frontiers(),
            shut_cells: map.shut().cells(),
            is_lost: robot.planner.is_lost(),
        }
    }

    fn tile(&self, robot: usize, at: TileIndex) -> Tile {
        self.of(robot).planner.map().tile(at)
    }

    fn frontier(&self, robot: usize, at: TileIndex) -> u64 {
        self.of(robot).planner.map().frontier(at)
    }

    fn votes(&self, robot: usize, cell: Cell) -> i8 {
        self.of(robot).planner.votes(cell)
    }

    fn searched(&self, robot: usize, at: TileIndex) -> u64 {
        self.of(robot).planner.searched(at)
    }

    fn way(&self, robot: usize) -> Vec<Direction> {
        let role = self.of(robot).planner.role();
        role.into_iter().flat_map(|role| role.way()).collect()
    }

    fn records(&self) -> &[Record] {
        self.book.records()
    }

    fn listen(&mut self) {
        self.fleet.listen();
    }

    fn messages(&self) -> &[Message] {
        self.fleet.messages()
    }

    fn outcome(&self) -> Outcome {
        self.book.outcome(&self.scenario, &self.fleet)
    }

    fn known(&self) -> KnownMap {
        let all = joined(&self.fleet);
        KnownMap::from_fn(self.scenario.world.extent(), |cell| {
            let (at, bit) = TileIndex::of(cell)?;
            let tile = all.as_ref()?.tile_inside(at);
            (tile.known() & bit != 0).then(|| tile.free() & bit != 0)
        })
    }

    fn save(&self) -> Option<Save> {
        let robots = self.fleet.robots().iter().zip(self.scenario.homes());
        let robots = robots.map(|(robot, home)| (robot.position, home, &*robot.planner));
        Save::of(&self.scenario.world, robots)
    }
}
