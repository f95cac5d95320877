//! Traces out of their files. What was seen is not in a file: it follows from where the
//! robots were, so they look once more.

use std::io::BufRead;

use planner_core::surface::Height;
use planner_core::survey::Limits;
use planner_core::{Cell, Extent, Point, Stop};
use serde::Deserialize;

use super::{Deed, KIND, Record, Trace, digest};
use crate::fleet::Sent;
use crate::medium::MediumKind;
use crate::survey::terrain_file::LARGEST;
use crate::survey::{Kill, Planner, Scenario, Terrain, look};
use crate::trace::TraceError;

/// Steps of the longest run that is read: a step without a record is one in which all
/// robots slept, and a file may claim any number of them.
const MOST_STEPS: u32 = 10_000_000;

/// Rounding that a position may be beyond the box by.
const TOLERANCE: f32 = 1e-3;

#[derive(Deserialize)]
struct Header {
    planner: Planner,
    range: f32,
    step: f32,
    min_altitude: f32,
    ceiling: f32,
    separation: f32,
    medium: MediumKind,
    byte_budget: u16,
    loss: f64,
    skip: f64,
    seed: u64,
    max_ticks: u32,
    starts: Vec<[f32; 3]>,
    /// (robot, step)
    deaths: Vec<(usize, u32)>,
    /// Of each robot at the end; older traces have none.
    #[serde(default)]
    stops: Vec<Option<Stop>>,
    world: Heights,
}

#[derive(Deserialize)]
struct Heights {
    name: String,
    /// In quarters of a cell, row by row.
    heights: Vec<Vec<u8>>,
}

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
        let (mut header, mut records) = KIND.read::<Header, _>(from, parse_record, digest)?;
        complete_stops(&mut records, &std::mem::take(&mut header.stops));
        let mut replay = Replay::new(header)?;
        let mut last = None;
        for (record, line) in records.iter().zip(3..) {
            if let Some(expected) = replay.objection(record, last) {
                return Err(TraceError::Line {
                    line,
                    expected,
                    found: record.to_string(),
                });
            }
            last = Some(record);
        }
        for step in records.chunk_by(|a, b| a.tick == b.tick) {
            replay.step(step);
        }
        let mut trace = replay.finish(records.last().map_or(0, |last| last.tick + 1));
        trace.records = records;
        Ok(trace)
    }
}

/// A record has only the number of a reason; the header has what each robot's last one
/// names.
fn complete_stops(records: &mut [Record], stops: &[Option<Stop>]) {
    for (robot, stop) in (0u8..).zip(stops) {
        let mut last = records
            .iter_mut()
            .rev()
            .filter(|record| record.robot == robot);
        if let (Some(stop), Some(last)) = (stop, last.next()) {
            let whole = Record {
                deed: Deed::Stopped(*stop),
                ..*last
            };
            if whole.action() == last.action() {
                *last = whole;
            }
        }
    }
}

/// A run whose decisions are known.
struct Replay {
    trace: Trace,
    /// Columns that anybody has seen, row by row.
    known: Vec<bool>,
    at: Vec<Point>,
    has_stopped: Vec<bool>,
}

impl Replay {
    fn new(header: Header) -> Result<Self, TraceError> {
        let robots = header.starts.len();
        let starts = header.starts.into_iter();
        let starts: Vec<_> = starts.map(|[x, y, z]| Point { x, y, z }).collect();
        let deaths = header.deaths.into_iter();
        let scenario = Scenario {
            planner: header.planner,
            robots,
            limits: Limits {
                range: header.range,
                step: header.step,
                min_altitude: header.min_altitude,
                ceiling: header.ceiling,
                separation: header.separation,
            },
            seed: header.seed,
            medium: header.medium,
            byte_budget: header.byte_budget,
            loss: header.loss,
            skip: header.skip,
            kills: deaths.map(|(robot, step)| Kill { robot, step }).collect(),
            max_ticks: header.max_ticks,
        };
        let checked = scenario.check();
        checked.map_err(|error| TraceError::Survey(error.to_string()))?;
        let terrain = header.world.terrain()?;
        let replay = Self {
            known: vec![false; terrain.extent().cells() as usize],
            at: starts.clone(),
            has_stopped: vec![false; robots],
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
        within(at.x, width.into())
            && within(at.y, height.into())
            && within(at.z, self.trace.scenario.limits.ceiling)
    }

    fn the_box(&self) -> String {
        let Extent { width, height } = self.trace.extent;
        let ceiling = self.trace.scenario.limits.ceiling;
        format!("the box from 0,0,0 to {width},{height},{ceiling}")
    }

    /// What should stand in a record, if something else does.
    fn objection(&self, record: &Record, last: Option<&Record>) -> Option<String> {
        let Trace {
            scenario, extent, ..
        } = &self.trace;
        let (robot, robots) = (usize::from(record.robot), self.at.len());
        let steps = scenario.max_ticks.min(MOST_STEPS);
        let place = |record: &Record| (record.tick, record.robot);
        let dies = |kill: &&Kill| kill.robot == robot && kill.step <= record.tick;
        if robot >= robots {
            return Some(format!("a robot from 0 to {}", robots - 1));
        }
        if record.tick >= steps {
            return Some(format!("a step before {steps}"));
        }
        if last.is_some_and(|last| place(last) >= place(record)) {
            return Some(
                "a later step, or a later robot of the same, than in the line before".into(),
            );
        }
        if let Some(kill) = scenario.kills.iter().find(dies) {
            return Some(format!(
                "a robot that lives; robot {robot} dies before step {}",
                kill.step
            ));
        }
        if !self.is_in_box(record.at) {
            return Some(format!("a position in {}", self.the_box()));
        }
        if record.target.is_some_and(|target| !extent.contains(target)) {
            return Some(format!("a goal in the {extent} columns, or -1,-1 for none"));
        }
        if !record.gain.is_finite() {
            return Some("a finite gain".into());
        }
        let all = extent.cells();
        (record.known > all).then(|| format!("at most {all} known columns"))
    }

    /// One step of the fleet.
    fn step(&mut self, records: &[Record]) {
        let tick = records[0].tick;
        // In a step without a record, every robot slept.
        while self.trace.seen.len() < tick as usize {
            self.trace.seen.push(self.trace.found.len() as u32);
        }
        self.look(tick, records.iter().map(|it| usize::from(it.robot)));
        for record in records {
            let robot = usize::from(record.robot);
            let from = std::mem::replace(&mut self.at[robot], record.at);
            if record.deed == Deed::Flew {
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
            scenario, safety, ..
        } = &mut self.trace;
        safety.check_separation(&scenario.limits, &alive);
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
        for robot in robots {
            for column in look(&trace.terrain, self.at[robot], trace.scenario.limits.range) {
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
        let kills = &self.trace.scenario.kills;
        let lives = move |robot: &usize| {
            !kills
                .iter()
                .any(|kill| kill.robot == *robot && kill.step <= tick)
        };
        (0..self.at.len()).filter(lives)
    }
}

impl Heights {
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
        Ok(Terrain::from_fn(extent, height_at).named(self.name))
    }
}

fn parse_record(line: &str) -> Option<Record> {
    let mut numbers = line.split(',');
    let mut next = || numbers.next();
    let tick = next()?.parse().ok()?;
    let robot = next()?.parse().ok()?;
    let mut coordinate = || next()?.parse().ok().filter(|at: &f32| at.is_finite());
    let at = Point {
        x: coordinate()?,
        y: coordinate()?,
        z: coordinate()?,
    };
    let deed = match next()? {
        "0" => Deed::Flew,
        "1" => Deed::Refused,
        "2" => Deed::Hovered,
        number => Deed::Stopped(stop_of(number, at.cell())?),
    };
    let target = Cell::new(next()?.parse().ok()?, next()?.parse().ok()?);
    let record = Record {
        tick,
        robot,
        at,
        deed,
        target: (target != Cell::new(-1, -1)).then_some(target),
        gain: next()?.parse().ok()?,
        known: next()?.parse().ok()?,
        work: next()?.parse().ok()?,
        sent: Sent {
            frames: next()?.parse().ok()?,
            bytes: next()?.parse().ok()?,
        },
    };
    next().is_none().then_some(record)
}

/// The reason with this number. How many frontiers were left, and where, is not in a
/// record.
fn stop_of(number: &str, at: Cell) -> Option<Stop> {
    let frontiers = 0;
    Some(match number {
        "32" => Stop::Complete,
        "33" => Stop::Unseen { frontiers, at },
        "34" => Stop::Blocked { frontiers, at },
        "37" => Stop::AtEdge { cells: 0 },
        "38" => Stop::OutOfReach { frontiers },
        "39" => Stop::Enclosed { frontiers },
        "40" => Stop::Held { frontiers, at },
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::survey::run;

    /// Every reason has one number, and keeps it.
    #[test]
    fn a_stop_is_read_as_it_was_written() {
        let (frontiers, at) = (0, Cell::new(3, 4));
        for stop in [
            Stop::Complete,
            Stop::Unseen { frontiers, at },
            Stop::Blocked { frontiers, at },
            Stop::AtEdge { cells: 0 },
            Stop::OutOfReach { frontiers },
            Stop::Enclosed { frontiers },
            Stop::Held { frontiers, at },
        ] {
            let record = Record {
                tick: 0,
                robot: 0,
                at: Point::over(at, 5.0),
                deed: Deed::Stopped(stop),
                target: None,
                gain: 0.0,
                known: 0,
                work: 0,
                sent: Sent::default(),
            };
            let number = record.action().to_string();
            assert_eq!(stop_of(&number, at), Some(stop), "{number}");
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
            record.deed = Deed::Stopped(stop);
        }
        let read = Trace::read(text(&trace).as_bytes()).unwrap();
        for robot in 0..3 {
            assert_eq!(read.stop(robot), trace.stop(robot));
        }
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
        let scenario = Scenario {
            medium: MediumKind::Radio,
            loss: 0.3,
            skip: 0.2,
            kills: vec![Kill { robot: 1, step: 9 }],
            ..Scenario::new(planner, 3, 5)
        };
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
    fn a_damaged_file_is_an_error_that_says_where() {
        let text = text(&trace(Planner::Fcao));
        let error = |text: &str| Trace::read(text.as_bytes()).unwrap_err().to_string();
        let cut = &text[..text[..text.len() - 1].rfind('\n').unwrap()];
        assert!(error(cut).contains("cut off"), "{}", error(cut));
        for (from, to, reason) in [
            ("\n0,1,", "\n0,one,", "line 4"),
            ("\n0,1,", "\n0,2,", "digest"),
            ("\"version\":1", "\"version\":9", "version 9"),
            ("\"starts\":[[", "\"starts\":[[],[", "line 1"),
            ("\"range\":8.0", "\"range\":1e9", "range"),
            ("\"step\":2.0", "\"step\":0.0", "step"),
            ("\"deaths\":[[1,", "\"deaths\":[[7,", "no robot 7"),
            ("\"starts\":[[2.5,", "\"starts\":[[99.5,", "robot 0 starts"),
            ("\"heights\":[[", "\"heights\":[[7,", "row 2"),
        ] {
            let error = error(&text.replacen(from, to, 1));
            assert!(error.contains(reason), "{error}");
        }
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
        refused(&|it| it.at.z = f32::NAN, "13 numbers");
        refused(&|it| it.robot = 3, "a robot from 0 to 2");
        refused(&|it| it.tick = u32::MAX, "a step before 20000");
        refused(&|it| it.tick = 0, "a later step");
        refused(&|it| it.target = Some(Cell::new(24, 0)), "a goal in");
        refused(&|it| it.gain = f32::INFINITY, "a finite gain");
        refused(&|it| it.known = 577, "at most 576 known columns");

        let mut dead = good.clone();
        let last = dead.records.iter().rposition(|it| it.robot == 1).unwrap();
        dead.scenario.kills[0].step = dead.records[last].tick;
        let error = Trace::read(text(&dead).as_bytes()).unwrap_err().to_string();
        assert!(error.contains(&format!("line {}", last + 3)), "{error}");
        assert!(error.contains("robot 1 dies"), "{error}");
    }

    #[test]
    fn a_run_of_ever_so_many_steps_is_not_believed() {
        let mut long = trace(Planner::Fcao);
        long.scenario.max_ticks = u32::MAX;
        long.records.last_mut().unwrap().tick = u32::MAX - 1;
        let error = Trace::read(text(&long).as_bytes()).unwrap_err().to_string();
        assert!(error.contains("a step before 10000000"), "{error}");
    }
}
