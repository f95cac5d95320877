//! A run that is watched: what happened in every tick so far, and the state of all
//! robots at the tick that is shown.

use std::ops::Range;
use std::sync::Arc;

use host_sim::run::{self, Outcome, Stepping};

use host_sim::record::grid::{Record, Trace};
use host_sim::scenario::grid::Scenario;
use host_sim::senses::Senses;
use host_sim::sensor::Sensor;
use host_sim::world::Reachable;
use planner_core::Cell;

use crate::export;
use crate::playback::{Export, Playback, Series, Verdict};

/// What nobody has seen.
pub const NEVER: u32 = u32::MAX;

/// One run, from its first tick to the last one done.
pub struct Watch {
    scenario: Scenario,
    sensor: Arc<Sensor>,
    /// Those of the robots at the last tick done.
    senses: Senses,
    reachable: Reachable,
    source: Source,
    /// The run once more, up to the tick that is shown, if that is not the last.
    past: Option<Box<dyn Stepping>>,
    /// The first tick whose records the run does not repeat.
    differs: Option<u32>,
    history: History,
    shown: u32,
}

/// Where the ticks come from.
enum Source {
    /// A run that goes on.
    Running(Box<dyn Stepping>),
    /// A run that has ended.
    Ended(Box<Ended>),
    /// A trace that was opened.
    Opened(Box<Trace>),
}

struct Ended {
    outcome: Outcome,
    trace: Trace,
    digest: String,
}

/// What happened, tick by tick.
#[derive(Default)]
struct History {
    /// Index of the first record of each tick; of one tick more than were done.
    first: Vec<usize>,
    /// When each cell was first seen by anybody, row by row.
    seen_since: Vec<u32>,
    /// Every cell that was seen, in the order of the ticks.
    news: Vec<Cell>,
    /// When a robot first stood on each cell, row by row.
    visited_since: Vec<u32>,
    series: Vec<Point>,
    /// What stood in the way in each tick; shorter, if nothing ever does.
    obstructions: Vec<Vec<Obstruction>>,
    seen_cells: u32,
    bytes: u64,
}

/// What the plots show of one tick.
#[derive(Clone, Copy, Debug, Default)]
pub struct Point {
    /// Reachable cells that somebody has seen.
    pub seen: u32,
    /// Largest work of one planner.
    pub work: u32,
    /// Bytes that all robots have sent since the start.
    pub bytes: u64,
}

/// What stands in the way for a while.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Obstruction {
    /// Somebody who walks about.
    Person(Cell),
    /// A door that is shut.
    Shut(Cell),
    /// A door that is open.
    Open(Cell),
}

impl Obstruction {
    /// All of them, as they are for these senses.
    fn all(senses: &Senses) -> Vec<Self> {
        let people = senses.people().map(Self::Person);
        let door = |(at, is_shut)| match is_shut {
            true => Self::Shut(at),
            false => Self::Open(at),
        };
        people.chain(senses.doors().map(door)).collect()
    }
}

impl Watch {
    /// A scenario before its first tick.
    ///
    /// # Errors
    /// A scenario that cannot be run, in a sentence for the user.
    pub fn new(scenario: Scenario) -> Result<Self, String> {
        let sensor = scenario.sensor();
        let mut running = run::open(&scenario, Some(sensor.clone())).map_err(|e| e.to_string())?;
        running.listen();
        Ok(Self::with(scenario, sensor, Source::Running(running)))
    }

    /// A trace that was opened, at its first tick.
    pub fn replay(trace: Trace) -> Self {
        let scenario = trace.scenario.clone();
        let sensor = scenario.sensor();
        let mut watch = Self::with(scenario, sensor, Source::Opened(Box::new(trace)));
        let Source::Opened(trace) = &watch.source else {
            unreachable!("it was just set");
        };
        watch
            .history
            .note(&trace.records, &mut watch.senses, &watch.reachable);
        watch
    }

    fn with(scenario: Scenario, sensor: Arc<Sensor>, source: Source) -> Self {
        let cells = scenario.world.extent().cells() as usize;
        Self {
            reachable: scenario.reachable(),
            history: History {
                first: vec![0],
                seen_since: vec![NEVER; cells],
                visited_since: vec![NEVER; cells],
                ..History::default()
            },
            senses: Senses::of(&scenario, sensor.clone()),
            scenario,
            sensor,
            source,
            past: None,
            differs: None,
            shown: 0,
        }
    }

    fn end(&mut self) {
        let Source::Running(running) = &self.source else {
            return;
        };
        let scenario = running.scenario().clone();
        let trace = Trace {
            records: running.records().to_vec(),
            scenario,
        };
        let digest = trace.digest();
        let ended = |outcome| {
            Source::Ended(Box::new(Ended {
                outcome,
                trace,
                digest,
            }))
        };
        // The state at the last tick stays at hand.
        let outcome = running.outcome();
        let Source::Running(running) = std::mem::replace(&mut self.source, ended(outcome)) else {
            unreachable!("checked above");
        };
        self.past = Some(running);
    }

    /// What is run.
    pub fn scenario(&self) -> &Scenario {
        &self.scenario
    }

    /// The first tick in which the planners of this program decide otherwise than
    /// those of the opened trace, as far as that was noticed.
    pub fn differs(&self) -> Option<u32> {
        self.differs
    }

    /// All robots' states at the shown tick, or `None` as long as
    /// [`catch_up`](Self::catch_up) has not got there.
    pub fn state(&self) -> Option<&dyn Stepping> {
        let at_shown = |run: &&dyn Stepping| run.progress().ticks == self.shown;
        let running = match &self.source {
            Source::Running(running) => Some(running.as_ref()),
            Source::Ended(_) | Source::Opened(_) => None,
        };
        let past = self.past.as_deref().filter(|_| self.differs.is_none());
        running.filter(at_shown).or(past.filter(at_shown))
    }

    /// Runs the scenario again towards the shown tick as long as `go_on` says so.
    pub fn catch_up(&mut self, mut go_on: impl FnMut() -> bool) {
        if self.state().is_some() || self.differs.is_some() {
            return;
        }
        let past = self.past.as_deref();
        if past.is_none_or(|run| run.progress().ticks > self.shown) {
            let mut past = run::open(&self.scenario, Some(self.sensor.clone()))
                .expect("the scenario has been run before");
            past.listen();
            self.past = Some(past);
        }
        let Some(mut past) = self.past.take() else {
            return;
        };
        while past.progress().ticks < self.shown && go_on() {
            let (begin, tick) = (past.records().len(), past.progress().ticks);
            let went_on = past.tick();
            if !went_on || past.records().get(begin..) != Some(self.records_of(tick)) {
                self.differs = Some(tick);
                break;
            }
        }
        self.past = Some(past);
    }

    /// All records up to the shown tick.
    pub fn records(&self) -> &[Record] {
        &self.all_records()[..self.history.first[self.shown as usize]]
    }

    /// The records of one tick.
    pub fn records_of(&self, tick: u32) -> &[Record] {
        let first = &self.history.first;
        match (first.get(tick as usize), first.get(tick as usize + 1)) {
            (Some(&begin), Some(&end)) => &self.all_records()[begin..end],
            _ => &[],
        }
    }

    /// The records of the tick before the shown state.
    pub fn last_records(&self) -> &[Record] {
        self.shown
            .checked_sub(1)
            .map_or(&[], |tick| self.records_of(tick))
    }

    fn all_records(&self) -> &[Record] {
        match &self.source {
            Source::Running(running) => running.records(),
            Source::Ended(ended) => &ended.trace.records,
            Source::Opened(trace) => &trace.records,
        }
    }

    /// Where the robots are at the shown tick, by id; those not yet there at their starts.
    pub fn positions(&self) -> Vec<Cell> {
        let mut positions = self.scenario.starts.clone();
        let mut left = positions.len();
        let mut placed = vec![false; left];
        // From the end: almost always the last tick has them all.
        for record in self.records().iter().rev() {
            let robot = usize::from(record.robot);
            if let Some(done) = placed.get_mut(robot)
                && !std::mem::replace(done, true)
            {
                positions[robot] = record.after();
                left -= 1;
                if left == 0 {
                    break;
                }
            }
        }
        positions
    }

    /// What stood in the way when the robots last looked.
    pub fn obstructions(&self) -> &[Obstruction] {
        let last = self.shown.saturating_sub(1) as usize;
        self.history
            .obstructions
            .get(last)
            .map_or(&[], Vec::as_slice)
    }

    /// Whether somebody had seen the cell by the shown tick.
    pub fn is_seen(&self, cell: Cell) -> bool {
        self.history.seen_since[self.index(cell)] < self.shown
    }

    /// The cells that were first seen in these ticks.
    pub fn news(&self, ticks: Range<u32>) -> &[Cell] {
        let news = &self.history.news;
        let before = |tick: u32| news.partition_point(|&cell| self.seen_since(cell) < tick);
        &news[before(ticks.start)..before(ticks.end)]
    }

    /// The tick in which the cell was first seen; [`NEVER`] if it was not.
    pub fn seen_since(&self, cell: Cell) -> u32 {
        self.history.seen_since[self.index(cell)]
    }

    /// Whether a robot had stood on the cell by the shown tick.
    pub fn is_visited(&self, cell: Cell) -> bool {
        self.history.visited_since[self.index(cell)] < self.shown
    }

    fn index(&self, cell: Cell) -> usize {
        cell.y as usize * usize::from(self.scenario.world.extent().width) + cell.x as usize
    }

    /// What can be reached.
    pub fn reachable(&self) -> &Reachable {
        &self.reachable
    }

    /// The curves, tick by tick.
    pub fn series(&self) -> &[Point] {
        &self.history.series
    }

    /// Reachable cells that somebody had seen by the shown tick.
    pub fn seen_cells(&self) -> u32 {
        let done = self.shown.checked_sub(1);
        done.map_or(0, |tick| self.history.series[tick as usize].seen)
    }

    /// What happened, when it is over.
    pub fn outcome(&self) -> Option<&Outcome> {
        match &self.source {
            Source::Ended(ended) => Some(&ended.outcome),
            Source::Running(_) | Source::Opened(_) => None,
        }
    }

    /// The trace up to the last tick done.
    pub fn trace(&self) -> Trace {
        Trace {
            scenario: self.scenario.clone(),
            records: self.all_records().to_vec(),
        }
    }
}

impl Playback for Watch {
    fn name(&self) -> &str {
        self.scenario.world.name()
    }

    fn title(&self) -> String {
        self.scenario.planner.to_string()
    }

    fn tick(&mut self) -> bool {
        if self.shown < self.ticks() {
            self.shown += 1;
            return true;
        }
        let Source::Running(running) = &mut self.source else {
            return false;
        };
        let begin = running.records().len();
        if running.tick() {
            let news = &running.records()[begin..];
            self.history.note(news, &mut self.senses, &self.reachable);
            // A tick in which nobody lives has no record.
            self.history.fill(running.progress().ticks);
            self.shown = running.progress().ticks;
        }
        if running.is_over() {
            self.end();
        }
        true
    }

    fn ticks(&self) -> u32 {
        self.history.series.len() as u32
    }

    fn shown(&self) -> u32 {
        self.shown
    }

    fn show(&mut self, tick: u32) {
        self.shown = tick.min(self.ticks());
    }

    fn is_replay(&self) -> bool {
        matches!(self.source, Source::Opened(_))
    }

    fn verdict(&self) -> Verdict {
        let seen = self.history.seen_cells == self.reachable.count();
        let complete = match &self.source {
            Source::Running(_) => return Verdict::Running,
            Source::Ended(ended) => ended.outcome.is_complete(),
            Source::Opened(_) => seen,
        };
        if complete {
            Verdict::Complete
        } else {
            Verdict::Incomplete
        }
    }

    fn digest(&self) -> Option<String> {
        match &self.source {
            Source::Running(_) => None,
            Source::Ended(ended) => Some(ended.digest.clone()),
            Source::Opened(trace) => Some(trace.digest()),
        }
    }

    fn seen_percent(&self) -> f64 {
        let all = self.reachable.count().max(1);
        100.0 * f64::from(self.seen_cells()) / f64::from(all)
    }

    fn curve(&self, of: Series) -> Vec<[f64; 2]> {
        let all = f64::from(self.reachable.count().max(1));
        let value = |point: &Point| match of {
            Series::Seen => 100.0 * f64::from(point.seen) / all,
            Series::Work => point.work.into(),
            Series::Bytes => point.bytes as f64,
        };
        let ticks = (1..).map(f64::from);
        let values = self.history.series.iter().map(value);
        ticks.zip(values).map(Into::into).collect()
    }

    fn export(&self, what: Export) -> Result<(&'static str, Vec<u8>), String> {
        match what {
            Export::Picture => export::png(self).map(|png| (".png", png)),
            Export::Animation => export::gif(&self.trace()).map(|gif| (".gif", gif)),
            Export::Trace => export::trace(&self.trace()).map(|trace| ("-trace.csv", trace)),
            Export::Map => Ok((".txt", self.scenario.world.to_text().into_bytes())),
        }
    }
}

impl History {
    /// Takes in the records of whole ticks.
    fn note(&mut self, records: &[Record], senses: &mut Senses, reachable: &Reachable) {
        let extent = senses.sensor().world().extent();
        let index = |cell: Cell| cell.y as usize * usize::from(extent.width) + cell.x as usize;
        for records in records.chunk_by(|a, b| a.tick == b.tick) {
            let tick = records[0].tick;
            self.fill(tick);
            senses.begin(tick);
            let obstructions = Obstruction::all(senses);
            if !(self.obstructions.is_empty() && obstructions.is_empty()) {
                self.obstructions.resize(tick as usize + 1, obstructions);
            }
            let mut work = 0;
            for record in records {
                work = work.max(record.work);
                self.bytes += u64::from(record.sent.bytes);
                let stood = index(record.at);
                if self.visited_since[stood] == NEVER {
                    self.visited_since[stood] = tick;
                }
                let robot = usize::from(record.robot);
                let view = senses.view(robot, record.at);
                let world = senses.sensor().world();
                let seen = view.iter().flat_map(|view| view.cells(world));
                for cell in seen {
                    if extent.contains(cell) && self.seen_since[index(cell)] == NEVER {
                        self.seen_since[index(cell)] = tick;
                        self.news.push(cell);
                        self.seen_cells += u32::from(reachable.contains(cell));
                    }
                }
                senses.follow(robot, record.deed.turns_to(), record.after());
            }
            let begin = self.first.last().copied().unwrap_or(0);
            self.first.push(begin + records.len());
            self.series.push(Point {
                seen: self.seen_cells,
                work,
                bytes: self.bytes,
            });
        }
    }

    /// Adds empty ticks until there are `ticks`.
    fn fill(&mut self, ticks: u32) {
        while self.series.len() < ticks as usize {
            self.first.push(self.first.last().copied().unwrap_or(0));
            self.series.push(Point {
                seen: self.seen_cells,
                work: 0,
                bytes: self.bytes,
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use host_sim::run::Options;

    use super::*;
    use crate::setup::Setup;

    fn scenario() -> Scenario {
        let address = "map=generate:rooms:32x24:3&robots=3&start=corner&loss=0.2&kill=1@30";
        Setup::from_address(address).unwrap().scenario().unwrap()
    }

    fn played() -> Watch {
        let mut watch = Watch::new(scenario()).unwrap();
        while watch.tick() {}
        watch
    }

    #[test]
    fn a_watched_run_is_the_run_of_host_sim() {
        let (outcome, trace) = run::run(
            &scenario(),
            Options {
                trace: true,
                ..Options::default()
            },
        )
        .unwrap();
        let watch = played();
        assert_eq!(watch.digest(), trace.map(|trace| trace.digest()));
        assert_eq!(watch.outcome(), Some(&outcome));
        let seen: Vec<u32> = watch.series().iter().map(|point| point.seen).collect();
        assert_eq!(seen, outcome.coverage);
    }

    #[test]
    fn every_tick_can_be_gone_back_to() {
        let mut ahead = Watch::new(scenario()).unwrap();
        let mut watch = played();
        for tick in (0..watch.ticks()).step_by(17) {
            while ahead.shown() < tick {
                ahead.tick();
            }
            watch.show(tick);
            assert_eq!(watch.positions(), ahead.positions());
            assert_eq!(watch.seen_cells(), ahead.seen_cells());
            watch.catch_up(|| true);
            let (then, now) = (watch.state().unwrap(), ahead.state().unwrap());
            assert_eq!(then.way(0), now.way(0));
            assert_eq!(then.robot(2).known_cells, now.robot(2).known_cells);
        }
    }

    #[test]
    fn a_trace_is_replayed_and_compared_with_the_planners_here() {
        let trace = played().trace();
        let mut replay = Watch::replay(trace.clone());
        replay.show(20);
        replay.catch_up(|| true);
        assert!(replay.state().is_some());

        let mut other = trace;
        let moved = other.records.iter_mut().find(|record| record.tick == 11);
        moved.unwrap().work += 1;
        let mut replay = Watch::replay(other);
        replay.show(20);
        replay.catch_up(|| true);
        assert!(replay.state().is_none());
        assert_eq!(replay.differs(), Some(11));
    }
}
