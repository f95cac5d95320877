//! What the team had seen, and where it was, tick by tick.

use planner_core::{Cell, Extent};

use super::paint::Ground;
use crate::record::grid::{Record, Trace};
use crate::scenario::grid::Scenario;
use crate::senses::Senses;
use crate::world::{Reachable, index};

/// A trace played forward.
pub struct Replay<'a> {
    trace: &'a Trace,
    senses: Senses,
    reachable: Reachable,
    /// Cells that somebody has seen, row by row.
    seen: Vec<bool>,
    seen_cells: u32,
    /// Cells that the last look at them showed otherwise than the world is.
    mistaken: Vec<bool>,
    positions: Vec<Cell>,
    /// The next record.
    next: usize,
    /// The next tick.
    now: u32,
}

impl<'a> Replay<'a> {
    /// The trace before its first tick.
    pub fn new(trace: &'a Trace) -> Self {
        let scenario = &trace.scenario;
        let world = &scenario.world;
        let reachable = scenario.reachable();
        let mut seen = vec![false; world.extent().cells() as usize];
        let mut seen_cells = 0;
        for cell in scenario.known().into_iter().flatten() {
            let seen = &mut seen[index(world.extent(), cell)];
            seen_cells += u32::from(!*seen && reachable.contains(cell));
            *seen = true;
        }
        Self {
            trace,
            senses: Senses::of(scenario, scenario.sensor()),
            reachable,
            seen,
            seen_cells,
            mistaken: vec![false; world.extent().cells() as usize],
            positions: scenario.starts.clone(),
            next: 0,
            now: 0,
        }
    }

    /// Plays the next tick, in which perhaps nobody lived; false if there is none.
    pub fn tick(&mut self) -> bool {
        let rest = &self.trace.records[self.next..];
        if rest.is_empty() {
            return false;
        }
        let now = self.now;
        self.senses.begin(now);
        for record in rest.iter().take_while(|record| record.tick <= now) {
            self.play(record);
            self.next += 1;
        }
        self.now += 1;
        true
    }

    fn play(&mut self, record: &Record) {
        let robot = usize::from(record.robot);
        let extent = self.trace.scenario.world.extent();
        if let Some(view) = self.senses.view(robot, record.at) {
            for cell in view.cells(&self.trace.scenario.world) {
                if extent.contains(cell) {
                    let seen = &mut self.seen[index(extent, cell)];
                    self.seen_cells += u32::from(!*seen && self.reachable.contains(cell));
                    *seen = true;
                }
            }
        }
        self.note_mistakes(robot, record.at);
        self.senses
            .follow(robot, record.deed.turns_to(), record.after());
        if let Some(position) = self.positions.get_mut(robot) {
            *position = record.after();
        }
    }

    fn note_mistakes(&mut self, robot: usize, at: Cell) {
        let Scenario {
            world, conditions, ..
        } = &self.trace.scenario;
        if conditions.trouble.is_none() {
            return;
        }
        for look in 0..conditions.trouble.looks {
            let told = self.senses.sighting(robot, look, at);
            let free = told.free_cells().map(|cell| (cell, true));
            for (cell, is_free) in free.chain(told.blocked_cells().map(|cell| (cell, false))) {
                if world.extent().contains(cell) {
                    self.mistaken[index(world.extent(), cell)] = is_free != world.is_free(cell);
                }
            }
        }
    }

    /// Ticks played.
    pub(super) fn ticks(&self) -> u32 {
        self.now
    }

    /// Where the robots are after the last tick played.
    pub fn positions(&self) -> &[Cell] {
        &self.positions
    }

    /// Reachable cells that somebody has seen.
    pub fn seen_cells(&self) -> u32 {
        self.seen_cells
    }

    /// Cells that can be reached.
    pub fn reachable_cells(&self) -> u32 {
        self.reachable.count()
    }

    /// Cells that bodies reach beyond the one of their centre.
    pub(super) fn clearance(&self) -> u8 {
        self.trace.scenario.clearance
    }

    pub(super) fn extent(&self) -> Extent {
        self.trace.scenario.world.extent()
    }

    pub(super) fn ground(&self, cell: Cell) -> Ground {
        let world = &self.trace.scenario.world;
        let index = index(world.extent(), cell);
        if self.senses.people().any(|at| at == cell) {
            return Ground::Person;
        }
        if let Some((_, is_shut)) = self.senses.doors().find(|(at, _)| *at == cell) {
            return match is_shut {
                true => Ground::ShutDoor,
                false => Ground::OpenDoor,
            };
        }
        if self.mistaken[index] {
            return Ground::Mistaken;
        }
        match (self.seen[index], world.is_free(cell)) {
            (true, true) => Ground::Free,
            (true, false) => Ground::Obstacle,
            (false, _) if self.reachable.contains(cell) => Ground::Unseen,
            (false, _) => Ground::Unknown,
        }
    }
}
