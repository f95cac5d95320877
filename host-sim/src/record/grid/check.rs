//! Whether records can be those of a run, before anything is drawn from them.

use planner_core::Cell;

use super::Record;
use crate::record::{Objection, Order, wrong};
use crate::scenario::grid::Scenario;

/// Most ticks without a record, all together: every robot is dead or still to come.
const MOST_EMPTY_TICKS: u32 = 1_000_000;

/// The records up to here: robots that there are, by tick and then by robot, each where
/// its last step has led it, inside the world.
pub(super) struct Checked<'a> {
    scenario: &'a Scenario,
    /// Where each robot is.
    positions: Vec<Cell>,
    order: Order,
    empty_ticks: u32,
}

impl<'a> Checked<'a> {
    pub(super) fn new(scenario: &'a Scenario) -> Self {
        Self {
            scenario,
            positions: scenario.starts.clone(),
            order: Order {
                robots: scenario.starts.len(),
                end: scenario.conditions.max_ticks,
                last: None,
            },
            empty_ticks: 0,
        }
    }

    /// The next record.
    ///
    /// # Errors
    /// What no run leaves.
    pub(super) fn take(&mut self, record: &Record) -> Result<(), Objection> {
        let extent = self.scenario.world.extent();
        let inside = || format!("inside the world of {extent} cells");
        let next = self
            .order
            .last
            .map_or(0, |(last, _)| last.saturating_add(1));
        self.order.take(record)?;
        self.check_gap(next, record.tick)?;
        if !extent.contains(record.at) {
            return Err(wrong(format!("a robot {}", inside()), record.at));
        }
        let position = &mut self.positions[usize::from(record.robot)];
        if record.at != *position {
            let expected = format!("robot {} at {position}, where it was", record.robot);
            return Err(wrong(expected, record.at));
        }
        if !extent.contains(record.after()) {
            let expected = format!("a step that ends {}", inside());
            return Err(wrong(expected, record.after()));
        }
        *position = record.after();
        if let Some(goal) = record.goal.filter(|&goal| !extent.contains(goal)) {
            let expected = format!("a goal {}, or -1,-1 for none", inside());
            return Err(wrong(expected, goal));
        }
        if record.known > extent.cells() {
            let expected = format!("at most {} known cells", extent.cells());
            return Err(wrong(expected, record.known));
        }
        Ok(())
    }

    /// Ticks without a record, from `next` on, end where somebody comes.
    fn check_gap(&mut self, next: u32, tick: u32) -> Result<(), Objection> {
        let empty = tick.saturating_sub(next);
        self.empty_ticks = self.empty_ticks.saturating_add(empty);
        let faults = &self.scenario.conditions.faults;
        let arrivals = faults.arrivals.iter().map(|arrival| arrival.tick);
        let mut births = arrivals.chain(faults.restarts.iter().map(|restart| restart.tick));
        if empty > 0 && births.all(|birth| birth != tick) {
            let expected = format!("tick {next}, as no robot arrives or restarts in {tick}");
            return Err(wrong(expected, format!("tick {tick}")));
        }
        if self.empty_ticks > MOST_EMPTY_TICKS {
            let expected = format!("at most {MOST_EMPTY_TICKS} ticks without a record");
            return Err(wrong(expected, format!("tick {tick}")));
        }
        Ok(())
    }
}
