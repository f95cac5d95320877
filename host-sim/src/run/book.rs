//! What is written down of a run.

use std::sync::Arc;

use planner_core::radio::Hearsay;
use planner_core::{Cell, Direction, Map};

use super::claims::wrong;
use super::{Assignments, Outcome, Progress, RobotOutcome};
use crate::coverage::Coverage;
use crate::fleet::Fleet;
use crate::record::grid::{Record, Trace};
use crate::robot::{Deed, Driven, Robot, Sent, Touches};
use crate::scenario::grid::Scenario;
use crate::senses::Senses;
use crate::sensor::Sensor;
use crate::world::Reachable;

/// What is written down while a run goes on.
pub(super) struct Book {
    senses: Senses,
    reachable: Reachable,
    coverage: Coverage,
    looked_from: Vec<Option<(Cell, Direction)>>,
    outcome: Outcome,
    records: Option<Vec<Record>>,
}

impl Book {
    pub(super) fn new(scenario: &Scenario, sensor: Arc<Sensor>, trace: bool) -> Self {
        let robots = scenario.starts.len();
        let reachable = scenario.reachable();
        let outcome = Outcome {
            ticks: 0,
            ticks_to_seen: None,
            ticks_to_stopped: None,
            reachable_cells: reachable.count(),
            seen_cells: 0,
            shared_cells: 0,
            max_work_per_tick: 0,
            coverage: Vec::new(),
            assignments: Assignments::default(),
            robots: vec![
                RobotOutcome {
                    steps: 0,
                    active_ticks: 0,
                    waited_ticks: 0,
                    blocked_steps: 0,
                    cells_known: 0,
                    cells_missed: 0,
                    cells_unnamed: 0,
                    cells_closed: 0,
                    cells_opened: 0,
                    cells_narrow: 0,
                    cells_unheard: 0,
                    work: 0,
                    sent: Sent::default(),
                    driven: Driven::default(),
                    stop: None,
                    is_home: false,
                    alive: true,
                    is_lost: false,
                    hearsay: Hearsay::default(),
                };
                robots
            ],
            bumps: 0,
            violations: Vec::new(),
            touches: Touches::default(),
        };
        Self {
            coverage: Coverage::of(scenario, &reachable),
            senses: Senses::of(scenario, sensor),
            reachable,
            looked_from: vec![None; robots],
            outcome,
            records: trace.then(Vec::new),
        }
    }

    /// Takes down the last tick.
    pub(super) fn note<const TW: usize, const TH: usize>(&mut self, fleet: &Fleet<TW, TH>) {
        let tick = fleet.ticks() - 1;
        self.senses.begin(tick);
        for (index, robot) in fleet.robots().iter().enumerate() {
            let Some(step) = robot.step else { continue };
            let from = (step.at, self.senses.heading(index));
            if self.looked_from[index] != Some(from) || !self.senses.is_steady() {
                self.looked_from[index] = Some(from);
                if let Some(view) = self.senses.view(index, step.at) {
                    self.coverage.look(index, &view);
                }
            }
            self.senses
                .follow(index, step.deed.turns_to(), robot.position);
            let noted = &mut self.outcome.robots[index];
            noted.work += u64::from(step.work);
            noted.sent.frames += step.sent.frames;
            noted.sent.bytes += step.sent.bytes;
            noted.stop = None;
            noted.active_ticks += 1;
            match step.deed {
                Deed::Moved(_) => noted.steps += 1,
                Deed::Blocked(_) => noted.blocked_steps += 1,
                Deed::Held(_) | Deed::Exchanged(_) | Deed::Yielded => {}
                Deed::Looked(_) | Deed::Driving => {}
                Deed::Waited => noted.waited_ticks += 1,
                Deed::Stopped(stop) => {
                    noted.active_ticks -= 1;
                    noted.stop = Some(stop);
                }
            }
            let most = &mut self.outcome.max_work_per_tick;
            *most = step.work.max(*most);
            if let Some(records) = &mut self.records {
                records.push(Record::new(tick, robot, step));
            }
        }
        let living = fleet.robots().iter().filter(|robot| robot.alive);
        let outcome = &mut self.outcome;
        outcome
            .assignments
            .add(living.filter_map(|robot| robot.planner.assignment()));
        outcome.ticks = fleet.ticks();
        outcome.seen_cells = self.coverage.seen_cells();
        outcome.coverage.push(outcome.seen_cells);
        if outcome.seen_cells == outcome.reachable_cells {
            outcome.ticks_to_seen.get_or_insert(tick);
        }
        if fleet.has_stopped() {
            outcome.ticks_to_stopped.get_or_insert(tick);
        }
    }

    /// The records so far, if any are kept.
    pub(super) fn records(&self) -> &[Record] {
        self.records.as_deref().unwrap_or_default()
    }

    pub(super) fn progress(&self) -> Progress {
        Progress {
            ticks: self.outcome.ticks,
            seen_cells: self.outcome.seen_cells,
            reachable_cells: self.outcome.reachable_cells,
        }
    }

    /// What happened up to now.
    pub(super) fn outcome<const TW: usize, const TH: usize>(
        &self,
        scenario: &Scenario,
        fleet: &Fleet<TW, TH>,
    ) -> Outcome {
        let mut outcome = self.outcome.clone();
        outcome.shared_cells = self.coverage.shared_cells();
        outcome.bumps = fleet.bumps();
        outcome.violations = fleet.violations().to_vec();
        outcome.touches = fleet.touches();
        let unheard = unheard(fleet);
        let homes = scenario.homes();
        for (robot, &start) in fleet.robots().iter().zip(&scenario.starts) {
            let noted = &mut outcome.robots[usize::from(robot.id.0)];
            noted.alive = robot.alive;
            noted.driven = fleet.driven(robot.id.0.into());
            // Where bodies exchange roles, those that come home may have started elsewhere.
            noted.is_home = robot.position == homes[usize::from(robot.id.0)]
                || scenario.solid && homes.contains(&robot.position);
            noted.is_lost = robot.planner.is_lost();
            noted.hearsay = robot.planner.hearsay();
            noted.cells_known = robot.planner.map().known_cells();
            noted.cells_unheard = unheard[usize::from(robot.id.0)];
            noted.cells_narrow = robot.planner.narrow_cells();
            let own = || scenario.reachable_from(&[start]);
            let wrong = wrong(&scenario.world, &self.reachable, robot, own);
            noted.cells_missed = wrong.missed;
            noted.cells_unnamed = wrong.unnamed;
            noted.cells_closed = wrong.closed;
            noted.cells_opened = wrong.opened;
        }
        outcome
    }

    pub(super) fn close<const TW: usize, const TH: usize>(
        self,
        scenario: &Scenario,
        fleet: &Fleet<TW, TH>,
    ) -> (Outcome, Option<Trace>) {
        let outcome = self.outcome(scenario, fleet);
        let trace = self.records.map(|records| Trace::new(scenario, records));
        (outcome, trace)
    }
}

/// Robot by robot, the cells that it lacks and another one alive knows.
fn unheard<const TW: usize, const TH: usize>(fleet: &Fleet<TW, TH>) -> Vec<u32> {
    let known = joined(fleet).map_or(0, |all| all.known_cells());
    let lacks = |robot: &Robot<TW, TH>| known - robot.planner.map().known_cells();
    let robots = fleet.robots().iter();
    robots
        .map(|robot| if robot.alive { lacks(robot) } else { 0 })
        .collect()
}

/// What all living robots know together; `None`: none lives.
pub(super) fn joined<const TW: usize, const TH: usize>(
    fleet: &Fleet<TW, TH>,
) -> Option<Box<Map<TW, TH>>> {
    let mut all: Option<Box<Map<TW, TH>>> = None;
    for robot in fleet.robots().iter().filter(|robot| robot.alive) {
        match &mut all {
            None => all = Some(Box::new(robot.planner.map().clone())),
            Some(all) => {
                all.join(robot.planner.map());
            }
        }
    }
    all
}
