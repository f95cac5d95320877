//! Traces out of their files. What was seen is not in a file: it follows from where the
//! robots were, so they look once more.

use std::io::BufRead;

use planner_core::surface::Height;
use planner_core::{Cell, Extent, Point, Reason, RobotId};

use super::{Ground, Header, Heights, Record, Safety, Trace};
use crate::record::{self, Deed, Objection, Order, TraceError, wrong};
use crate::scenario::heights::Scenario;
use crate::terrain::{LARGEST, Terrain, look};

/// Steps of the longest run that is read: a step without a record is one in which all
/// robots slept, and a file may claim any number of them.
const MOST_STEPS: u32 = 10_000_000;

/// Rounding that a position may be beyond the box by.
const TOLERANCE: f32 = 1e-3;

/// How far wind may have lifted a robot above the ceiling, in cells: more than it ever does.
const BLOWN: f32 = 100.0;

impl Trace {
    /// Reads a trace, and checks that it is whole and that each record can be: robots
    /// that there are and that live, in their order, in the box. In the last step of a
    /// run that was given up, robots that slept are taken to look too.
    ///
    /// Cost: a look for each record, and for each flight the columns crossed.
    ///
    /// # Errors
    /// What is wrong, and in which line.
    pub fn read(from: impl BufRead) -> Result<Self, TraceError> {
        let (version, mut header, mut records) = record::read::<Header, Heights>(from)?;
        if version == 1 {
            records.iter_mut().for_each(rename);
        }
        let stops = std::mem::take(&mut header.stops);
        let mut replay = Replay::new(header)?;
        let mut order = Order {
            robots: replay.at.len(),
            end: replay.trace.scenario.conditions.max_ticks.min(MOST_STEPS),
            last: None,
        };
        record::check(&records, |record| {
            order.take(record)?;
            replay.check(record)
        })?;
        for step in records.chunk_by(|a, b| a.tick == b.tick) {
            replay.step(step);
        }
        let mut trace = replay.finish(records.last().map_or(0, |last| last.tick + 1));
        for (robot, stop) in (0..).zip(&mut trace.stops) {
            let last = records.iter().rev().find(|record| record.robot == robot);
            let Some(Deed::Stopped(reason)) = last.map(|record| record.deed) else {
                continue;
            };
            let named = stops.get(usize::from(robot)).copied().flatten();
            *stop = named.filter(|&stop| stop.reason() == reason);
        }
        trace.records = records;
        Ok(trace)
    }
}

/// Version 1 had two reasons the other way round.
fn rename(record: &mut Record) {
    record.deed = match record.deed {
        Deed::Stopped(Reason::Unseen) => Deed::Stopped(Reason::Enclosed),
        Deed::Stopped(Reason::Enclosed) => Deed::Stopped(Reason::Unseen),
        deed => deed,
    };
}

/// A run whose decisions are known.
struct Replay {
    trace: Trace,
    /// Columns that anybody has seen, row by row.
    known: Vec<bool>,
    at: Vec<Point>,
    has_stopped: Vec<bool>,
    /// Who has come: from the beginning, or by a record.
    is_there: Vec<bool>,
}

impl Replay {
    fn new(header: Header) -> Result<Self, TraceError> {
        let robots = header.starts.len();
        let starts = header.starts.into_iter();
        let starts: Vec<_> = starts.map(|[x, y, z]| Point { x, y, z }).collect();
        let scenario = Scenario {
            planner: header.planner,
            robots,
            limits: header.limits,
            skip: header.skip,
            conditions: header.conditions,
        };
        scenario.check()?;
        let terrain = header.world.terrain()?;
        let replay = Self {
            known: vec![false; terrain.extent().cells() as usize],
            at: starts.clone(),
            has_stopped: vec![false; robots],
            is_there: (0..=u8::MAX)
                .take(robots)
                .map(|id| !scenario.conditions.faults.comes_late(RobotId(id)))
                .collect(),
            trace: Trace::new(&terrain, &scenario, starts),
        };
        match replay.at.iter().position(|at| !replay.is_in_box(*at)) {
            Some(robot) => {
                let Point { x, y, z } = replay.at[robot];
                let inside = replay.the_box();
                let reason = format!("robot {robot} starts at {x},{y},{z}, not in {inside}");
                Err(TraceError::Survey(reason))
            }
            None => Ok(replay),
        }
    }

    fn is_in_box(&self, at: Point) -> bool {
        let Extent { width, height } = self.trace.extent;
        let within = |v: f32, end: f32| (-TOLERANCE..=end + TOLERANCE).contains(&v);
        within(at.x, width.into()) && within(at.y, height.into()) && within(at.z, self.ceiling())
    }

    /// Where no robot is above.
    fn ceiling(&self) -> f32 {
        let scenario = &self.trace.scenario;
        let blown = match scenario.conditions.wind.is_none() {
            true => 0.0,
            false => BLOWN,
        };
        scenario.limits.ceiling + blown
    }

    fn the_box(&self) -> String {
        let Extent { width, height } = self.trace.extent;
        let ceiling = self.ceiling();
        format!("the box from 0,0,0 to {width},{height},{ceiling}")
    }

    /// # Errors
    /// What no run leaves.
    fn check(&self, record: &Record) -> Result<(), Objection> {
        let Trace {
            scenario, extent, ..
        } = &self.trace;
        let faults = &scenario.conditions.faults;
        if !faults.is_alive(RobotId(record.robot), record.tick) {
            let expected = format!("a robot that lives; robot {} does not", record.robot);
            return Err(wrong(expected, format!("tick {}", record.tick)));
        }
        if !self.is_in_box(record.at) {
            let Point { x, y, z } = record.at;
            let expected = format!("a position in {}", self.the_box());
            return Err(wrong(expected, format!("{x},{y},{z}")));
        }
        if let Some(goal) = record.goal.filter(|&goal| !extent.contains(goal)) {
            let expected = format!("a goal in the {extent} columns, or -1,-1 for none");
            return Err(wrong(expected, goal));
        }
        if !record.gain.is_finite() {
            return Err(wrong("a finite gain", record.gain));
        }
        if record.known > extent.cells() {
            let expected = format!("at most {} known columns", extent.cells());
            return Err(wrong(expected, record.known));
        }
        Ok(())
    }

    /// One step of the fleet.
    fn step(&mut self, records: &[Record]) {
        let tick = records[0].tick;
        // In a step without a record, every robot slept.
        while self.trace.seen.len() < tick as usize {
            self.trace.seen.push(self.trace.found.len() as u32);
        }
        self.look(tick, records.iter().map(|it| usize::from(it.robot)));
        let is_calm = self.trace.scenario.conditions.wind.is_none();
        for record in records {
            let robot = usize::from(record.robot);
            self.is_there[robot] = true;
            let from = std::mem::replace(&mut self.at[robot], record.at);
            if is_calm && record.deed == Deed::Flew {
                let Trace {
                    terrain,
                    scenario,
                    safety,
                    ..
                } = &mut self.trace;
                safety.check_flight(terrain, &scenario.limits, from, record.at);
            }
            self.has_stopped[robot] = matches!(record.deed, Deed::Stopped(_));
        }
        let alive: Vec<_> = self.alive(tick).map(|robot| self.at[robot]).collect();
        let Trace {
            terrain,
            scenario,
            safety,
            contacts,
            ..
        } = &mut self.trace;
        match is_calm {
            true => safety.check_separation(&scenario.limits, &alive),
            false => *contacts += Safety::contacts(terrain, &scenario.limits, &alive),
        }
    }

    /// The look after the last flight.
    fn finish(mut self, tick: u32) -> Trace {
        let alive: Vec<_> = self.alive(tick).collect();
        self.trace.all_stopped = alive.iter().all(|&robot| self.has_stopped[robot]);
        self.look(tick, alive);
        self.trace
    }

    fn look(&mut self, tick: u32, robots: impl IntoIterator<Item = usize>) {
        let trace = &mut self.trace;
        let width = usize::from(trace.extent.width);
        let faults = &trace.scenario.conditions.faults;
        for robot in robots {
            if faults.is_lost(robot, tick) || faults.has_failed(robot, tick) {
                continue;
            }
            for column in look(&trace.terrain, self.at[robot], trace.scenario.limits.range) {
                if faults.is_blind(column.cell, tick) {
                    continue;
                }
                let index = column.cell.y as usize * width + column.cell.x as usize;
                if !std::mem::replace(&mut self.known[index], true) {
                    trace.found.push((tick, column));
                }
            }
        }
        trace.seen.push(trace.found.len() as u32);
    }

    /// The robots that live in this step.
    fn alive(&self, tick: u32) -> impl Iterator<Item = usize> + '_ {
        let faults = &self.trace.scenario.conditions.faults;
        let lives = move |&robot: &usize| {
            self.is_there[robot] && faults.is_alive(RobotId(robot as u8), tick)
        };
        (0..self.at.len()).filter(lives)
    }
}

impl Ground {
    fn terrain(self) -> Result<Terrain, TraceError> {
        let rows = &self.heights;
        let (width, height) = (rows.first().map_or(0, Vec::len), rows.len());
        if let Some(row) = rows.iter().position(|row| row.len() != width) {
            return Err(TraceError::Ragged {
                row: row + 1,
                expected: width,
                found: rows[row].len(),
            });
        }
        let sides = 1..=LARGEST as usize;
        if !sides.contains(&width) || !sides.contains(&height) {
            let reason = format!("the terrain has {width}×{height} columns");
            return Err(TraceError::Survey(reason));
        }
        let height_at = |cell: Cell| Height(rows[cell.y as usize][cell.x as usize]);
        let extent = Extent::new(width as u16, height as u16);
        Ok(Terrain::from_fn(extent, height_at)
            .named(self.name)
            .scaled(self.scale))
    }
}

#[cfg(test)]
mod tests {
    use planner_core::Stop;

    use super::*;
    use crate::damage::assert_refused;
    use crate::run::heights::run;
    use crate::scenario::heights::Planner;
    use crate::scenario::{Event, MediumKind};

    /// The first version had two reasons the other way round.
    #[test]
    fn the_reasons_of_version_1_are_read_as_they_were_meant() {
        let mut trace = trace(Planner::Fcao);
        for (old, reason) in [(33, Reason::Unseen), (39, Reason::Enclosed)] {
            let last = trace.records.last_mut().unwrap();
            last.deed = Deed::try_from(old).unwrap();
            let file = text(&trace).replacen("\"version\":2", "\"version\":1", 1);
            let read = Trace::read(file.as_bytes()).unwrap();
            let last = read.records.last().unwrap();
            assert_eq!(last.deed, Deed::Stopped(reason));
        }
    }

    /// What a stop names is in the header, and comes back from there.
    #[test]
    fn a_stop_keeps_what_it_names() {
        let mut trace = trace(Planner::Fcao);
        let stop = Stop::Blocked {
            frontiers: 7,
            at: Cell::new(2, 3),
        };
        for record in trace.records.iter_mut().rev().take(3) {
            record.deed = Deed::Stopped(stop.reason());
            trace.stops[usize::from(record.robot)] = Some(stop);
        }
        let read = Trace::read(text(&trace).as_bytes()).unwrap();
        assert_eq!(read.stops, trace.stops);
        assert_eq!(text(&read), text(&trace));
        // As older traces are.
        let start = text(&trace).find("\"stops\"").unwrap();
        let end = start + text(&trace)[start..].find("]").unwrap() + 2;
        let old = text(&trace).replacen(&text(&trace)[start..end], "", 1);
        let read = Trace::read(old.as_bytes()).unwrap();
        assert_eq!(read.digest(), trace.digest());
    }

    /// A run in which robots die and sleep, and messages are lost.
    fn trace(planner: Planner) -> Trace {
        let terrain = Terrain::urban(3, 24);
        let mut scenario = Scenario::new(planner, 3, 5);
        scenario.skip = 0.2;
        scenario.conditions.medium = MediumKind::Radio;
        scenario.conditions.loss = 0.3;
        scenario.conditions.faults.deaths = vec![Event::from((1, 9))];
        run(&terrain, &scenario).unwrap()
    }

    fn text(trace: &Trace) -> String {
        let mut file = Vec::new();
        trace.write(&mut file).unwrap();
        String::from_utf8(file).unwrap()
    }

    #[test]
    fn a_trace_survives_its_file_with_all_that_was_seen() {
        for planner in [Planner::CoordinatedSurvey, Planner::Fcao, Planner::Greedy] {
            let trace = trace(planner);
            let read = Trace::read(text(&trace).as_bytes()).unwrap();
            assert_eq!(read.scenario, trace.scenario);
            assert_eq!(read.terrain, trace.terrain);
            assert_eq!(read.starts, trace.starts);
            assert_eq!(text(&read), text(&trace));
            assert_eq!(read.found, trace.found);
            assert_eq!(read.seen, trace.seen);
            assert_eq!(read.safety, trace.safety);
            assert_eq!(read.all_stopped, trace.all_stopped, "{planner}");
        }
    }

    #[test]
    fn a_trace_in_wind_survives_its_file() {
        let mut scenario = Scenario::new(Planner::CoordinatedSurvey, 3, 5);
        // So that robots are pushed above the ceiling, and near to each other.
        scenario.limits.ceiling = 4.0;
        scenario.limits.separation = 2.0;
        scenario.conditions.wind.deviation = 1.0;
        scenario.conditions.max_ticks = 400;
        let plain = Terrain::from_fn(Extent::new(16, 16), |_| Height(4));
        let trace = run(&plain, &scenario).unwrap();
        assert!(trace.contacts > 0);
        let read = Trace::read(text(&trace).as_bytes()).unwrap();
        assert_eq!(text(&read), text(&trace));
        assert_eq!(read.found, trace.found);
        assert_eq!(read.contacts, trace.contacts);
        assert_eq!(read.safety, Safety::default());
    }

    #[test]
    fn a_damaged_file_is_an_error_that_says_where() {
        let text = text(&trace(Planner::Fcao));
        let error = |bytes: &[u8]| Trace::read(bytes).unwrap_err().to_string();
        let cut = &text.as_bytes()[..text[..text.len() - 1].rfind('\n').unwrap()];
        assert!(error(cut).contains("cut off"), "{}", error(cut));
        assert_refused(
            &text,
            error,
            &[
                ("\n0,1,", "\n0,one,", "line 4"),
                ("\n0,1,", "\n0,2,", "digest"),
                ("\"version\":2", "\"version\":9", "version 9"),
                ("\"starts\":[[", "\"starts\":[[],[", "line 1"),
                ("\"range\":8.0", "\"range\":1e9", "range"),
                ("\"step\":2.0", "\"step\":0.0", "step"),
                ("\"deaths\":[[1,", "\"deaths\":[[7,", "no robot 7"),
                ("\"starts\":[[2.5,", "\"starts\":[[99.5,", "robot 0 starts"),
                ("\"heights\":[[", "\"heights\":[[7,", "row 2"),
            ],
        );
    }

    /// Each with a digest that fits, as somebody would write it who means harm.
    #[test]
    fn records_that_cannot_be_are_refused_by_their_line() {
        let good = trace(Planner::Fcao);
        let refused = |change: &dyn Fn(&mut Record), reason: &str| {
            let mut bad = good.clone();
            change(&mut bad.records[5]);
            let error = Trace::read(text(&bad).as_bytes()).unwrap_err().to_string();
            assert!(error.contains("line 8"), "{error}");
            assert!(error.contains(reason), "{error}");
        };
        for far in [4_294_967_296.0, 24.5, -1.0, 1e30, f32::MIN] {
            refused(
                &|it| it.at.x = far,
                "a position in the box from 0,0,0 to 24,24,40",
            );
            refused(&|it| it.at.y = far, "a position");
        }
        refused(&|it| it.at.z = 41.0, "a position");
        refused(&|it| it.at.z = -1.0, "a position");
        refused(&|it| it.at.z = f32::NAN, "a position");
        refused(&|it| it.robot = 3, "a robot from 0 to 2");
        refused(&|it| it.tick = u32::MAX, "a tick before 20000");
        refused(&|it| it.tick = 0, "ticks in order");
        let before = good.records[4];
        refused(
            &|it| (it.tick, it.robot) = (before.tick, before.robot),
            "once a tick, in order",
        );
        refused(&|it| it.goal = Some(Cell::new(24, 0)), "a goal in");
        refused(&|it| it.gain = f32::INFINITY, "a finite gain");
        refused(&|it| it.known = 577, "at most 576 known columns");

        let mut dead = good.clone();
        let last = dead.records.iter().rposition(|it| it.robot == 1).unwrap();
        dead.scenario.conditions.faults.deaths[0].tick = dead.records[last].tick;
        let error = Trace::read(text(&dead).as_bytes()).unwrap_err().to_string();
        assert!(error.contains(&format!("line {}", last + 3)), "{error}");
        assert!(error.contains("robot 1 does not"), "{error}");
    }

    #[test]
    fn a_run_of_ever_so_many_steps_is_not_believed() {
        let mut long = trace(Planner::Fcao);
        long.scenario.conditions.max_ticks = u32::MAX;
        long.records.last_mut().unwrap().tick = u32::MAX - 1;
        let error = Trace::read(text(&long).as_bytes()).unwrap_err().to_string();
        assert!(error.contains("a tick before 10000000"), "{error}");
    }
}
