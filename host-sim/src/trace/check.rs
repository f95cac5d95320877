//! Whether records can be those of a run, before anything is drawn from them.

use std::fmt::Display;

use planner_core::{Cell, Stop};

use super::{LOOKED, Record, STOPPED, TraceError};
use crate::run::Scenario;

/// The line of the first record.
const FIRST_LINE: usize = 3;
/// Most ticks without a record, all together: every robot is dead or still to come.
const MOST_EMPTY_TICKS: u32 = 1_000_000;
/// The last action of a robot that has not stopped: a look to the north.
const LAST_ACT: u8 = LOOKED + 3;
/// The newest reason to stop.
const LAST_STOP: u8 = Stop::Held {
    frontiers: 0,
    at: Cell::new(0, 0),
}
.code();

/// Checks all records against their scenario: robots that there are, by tick and then by
/// robot, each where its last step has led it, inside the world.
///
/// # Errors
/// The line of the first record that cannot be.
pub(super) fn check(scenario: &Scenario, records: &[Record]) -> Result<(), TraceError> {
    let mut checked = Checked {
        scenario,
        positions: scenario.starts.clone(),
        last: None,
        empty_ticks: 0,
    };
    for (record, line) in records.iter().zip(FIRST_LINE..) {
        checked.take(record).map_err(|wrong| TraceError::Line {
            line,
            expected: wrong.expected,
            found: wrong.found,
        })?;
    }
    Ok(())
}

/// The records up to here.
struct Checked<'a> {
    scenario: &'a Scenario,
    /// Where each robot is.
    positions: Vec<Cell>,
    /// Tick and robot of the last record.
    last: Option<(u32, u8)>,
    empty_ticks: u32,
}

struct Wrong {
    expected: String,
    found: String,
}

fn wrong<T>(expected: impl Into<String>, found: impl Display) -> Result<T, Wrong> {
    Err(Wrong {
        expected: expected.into(),
        found: found.to_string(),
    })
}

impl Checked<'_> {
    fn take(&mut self, record: &Record) -> Result<(), Wrong> {
        let extent = self.scenario.world.extent();
        let inside = || format!("inside the world of {extent} cells");
        let Record { tick, robot, .. } = *record;
        self.check_tick(tick)?;
        let robots = self.positions.len();
        let Some(position) = self.positions.get_mut(usize::from(robot)) else {
            return wrong(format!("a robot from 0 to {}", robots - 1), robot);
        };
        if self.last.is_some_and(|last| last >= (tick, robot)) {
            return wrong("each robot once a tick, in order", format!("robot {robot}"));
        }
        self.last = Some((tick, robot));
        if !extent.contains(record.at) {
            return wrong(format!("a robot {}", inside()), record.at);
        }
        if record.at != *position {
            let expected = format!("robot {robot} at {position}, where it was");
            return wrong(expected, record.at);
        }
        let last = STOPPED + LAST_STOP;
        if !(0..=LAST_ACT)
            .chain(STOPPED..=last)
            .any(|action| action == record.action)
        {
            let expected = format!("an action, 0 to {LAST_ACT} or {STOPPED} to {last}");
            return wrong(expected, record.action);
        }
        if !extent.contains(record.after()) {
            return wrong(format!("a step that ends {}", inside()), record.after());
        }
        *position = record.after();
        if let Some(goal) = record.goal.filter(|&goal| !extent.contains(goal)) {
            return wrong(format!("a goal {}, or -1,-1 for none", inside()), goal);
        }
        if record.known > extent.cells() {
            let expected = format!("at most {} known cells", extent.cells());
            return wrong(expected, record.known);
        }
        Ok(())
    }

    fn check_tick(&mut self, tick: u32) -> Result<(), Wrong> {
        let next = self.last.map_or(0, |(last, _)| last.saturating_add(1));
        if self.last.is_some_and(|(last, _)| tick < last) {
            return wrong("ticks in order", format!("tick {tick}"));
        }
        if tick >= self.scenario.max_ticks {
            let expected = format!("at most {} ticks, by the header", self.scenario.max_ticks);
            return wrong(expected, format!("tick {tick}"));
        }
        let empty = tick.saturating_sub(next);
        self.empty_ticks = self.empty_ticks.saturating_add(empty);
        let faults = &self.scenario.faults;
        let arrivals = faults.arrivals.iter().map(|arrival| arrival.tick);
        let mut births = arrivals.chain(faults.restarts.iter().map(|restart| restart.tick));
        if empty > 0 && births.all(|birth| birth != tick) {
            let expected = format!("tick {next}, as no robot arrives or restarts in {tick}");
            return wrong(expected, format!("tick {tick}"));
        }
        if self.empty_ticks > MOST_EMPTY_TICKS {
            let expected = format!("at most {MOST_EMPTY_TICKS} ticks without a record");
            return wrong(expected, format!("tick {tick}"));
        }
        Ok(())
    }
}
