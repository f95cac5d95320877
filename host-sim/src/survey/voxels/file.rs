//! Traces of runs among voxels as files.
//!
//! A trace file is text. Line 1 is a JSON object, the *header*: the scenario, the scene
//! as rows of `#` occupied and `.` free, level by level from below, whether every robot
//! had stopped and why each had, the number of records and their digest. Line 2 names the columns; every
//! further line is one record: where a robot decided, and the work of that.
//!
//! The digest is the first 16 hex digits of the SHA-256 of the file without its header.

use std::collections::HashSet;
use std::fmt::{self, Write as _};
use std::io::{self, BufRead};

use planner_core::volume::Voxel;
use planner_core::{Extent, Stop};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::run::{Scenario, VoxelTrace, look, visible};
use super::scene::{LARGEST, LEVELS, Scene};
use crate::fleet::Sent;
use crate::survey::error::SurveyError;
use crate::trace::{Kind, TraceError, hex_digits};

const KIND: Kind = Kind {
    format: "host-sim voxel trace",
    version: 1,
    columns: &["tick", "robot", "x", "y", "z", "work"],
};

#[derive(Serialize, Deserialize)]
struct Header {
    format: String,
    version: u32,
    digest: String,
    records: usize,
    scenario: Scenario,
    all_stopped: bool,
    /// Of each robot at the end; older traces have none.
    #[serde(default)]
    stops: Vec<Option<Stop<Voxel>>>,
    world: Levels,
}

#[derive(Serialize, Deserialize)]
struct Levels {
    name: String,
    levels: Vec<Vec<String>>,
}

/// One decision of one robot.
#[derive(Clone, Copy)]
struct Record {
    tick: usize,
    robot: usize,
    at: Voxel,
    work: u32,
}

impl fmt::Display for Record {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Voxel { x, y, z } = self.at;
        write!(f, "{},{},{x},{y},{z},{}", self.tick, self.robot, self.work)
    }
}

impl VoxelTrace {
    /// Writes the trace in the format that this module documents.
    ///
    /// # Errors
    /// Those of `to`.
    pub fn write(&self, mut to: impl io::Write) -> io::Result<()> {
        let header = Header {
            format: KIND.format.into(),
            version: KIND.version,
            digest: self.digest(),
            records: self.work.len(),
            scenario: self.scenario.clone(),
            all_stopped: self.all_stopped,
            stops: self.stops.clone(),
            world: Levels::of(&self.scene),
        };
        serde_json::to_writer(&mut to, &header)?;
        write!(to, "\n{}", text(self.records()))
    }

    /// Reads a trace, and checks that it is whole.
    ///
    /// Cost: a look for each place where a robot was, and for each that can be reached.
    ///
    /// # Errors
    /// What is wrong, and in which line.
    pub fn read(from: impl BufRead) -> Result<Self, TraceError> {
        let digest = |records: &[Record]| digest(records.iter().copied());
        let (header, records) = KIND.read::<Header, _>(from, Record::parse, digest)?;
        let (scene, scenario) = (header.world.scene()?, header.scenario);
        let checked = scenario.check(&scene);
        checked.map_err(|error| TraceError::Survey(error.to_string()))?;
        let robots = scenario.robots;
        let in_order = |(i, record): (usize, &Record)| {
            (record.tick, record.robot) == (i / robots, i % robots)
                && scene.is_occupied(record.at).is_some()
        };
        if records.len() < robots || !records.len().is_multiple_of(robots) {
            let reason = format!("{robots} robots do not have {} records", records.len());
            return Err(TraceError::Survey(reason));
        }
        if let Some(i) = records.iter().enumerate().position(|it| !in_order(it)) {
            return Err(TraceError::Line {
                line: i + 3,
                expected: format!("robot {} in tick {}, in the scene", i % robots, i / robots),
                found: records[i].to_string(),
            });
        }
        let mut trace = Self {
            ways: vec![Vec::new(); robots],
            work: records.iter().map(|record| record.work).collect(),
            // What was sent is not in the file.
            sent: vec![Sent::default(); records.len()],
            found: Vec::new(),
            visible: 0,
            seen: Vec::new(),
            all_stopped: header.all_stopped,
            stops: {
                let mut stops = header.stops;
                stops.resize(robots, None);
                stops
            },
            violations: 0,
            scenario,
            scene,
        };
        for record in records {
            trace.ways[record.robot].push(record.at);
        }
        trace.look_again();
        match trace.visible {
            0 => Err(TraceError::Survey(SurveyError::NothingToSee.to_string())),
            _ => Ok(trace),
        }
    }

    /// What was seen, and what should not have been flown, follows from the ways.
    fn look_again(&mut self) {
        let (scene, range) = (&self.scene, self.scenario.range);
        let visible = visible(scene, self.ways[0][0], range);
        let mut known = HashSet::new();
        let mut looked = HashSet::new();
        let mut seen = 0;
        for tick in 0..self.ways[0].len() {
            for at in self.ways.iter().map(|way| way[tick]) {
                // Who looks from the same place sees the same.
                let view = looked.insert(at).then(|| look(scene, at, range));
                for (voxel, occupied) in view.into_iter().flatten() {
                    if known.insert(voxel) {
                        self.found.push((tick as u32, voxel, occupied));
                        seen += u32::from(visible.contains(&voxel));
                    }
                }
            }
            self.seen.push(seen);
        }
        let legs = self.ways.iter().flat_map(|way| way.windows(2));
        let is_allowed =
            |leg: &&[Voxel]| scene.is_pose(leg[1]) && leg[0].distance_squared(leg[1]) <= 1;
        self.violations = legs.filter(|leg| !is_allowed(leg)).count() as u32;
        self.visible = visible.len() as u32;
    }

    fn records(&self) -> impl Iterator<Item = Record> + '_ {
        let robots = self.ways.len();
        self.work.iter().enumerate().map(move |(i, &work)| {
            let (tick, robot) = (i / robots, i % robots);
            Record {
                tick,
                robot,
                at: self.ways[robot][tick],
                work,
            }
        })
    }

    /// 16 hex digits that differ if any record does.
    pub fn digest(&self) -> String {
        digest(self.records())
    }
}

/// The file without its header.
fn text(records: impl Iterator<Item = Record>) -> String {
    let mut text = format!("{}\n", KIND.columns.join(","));
    for record in records {
        writeln!(text, "{record}").expect("a String takes everything");
    }
    text
}

fn digest(records: impl Iterator<Item = Record>) -> String {
    hex_digits(Sha256::new_with_prefix(text(records)))
}

impl Record {
    fn parse(line: &str) -> Option<Self> {
        let mut numbers = line.split(',');
        let mut next = || numbers.next();
        let record = Self {
            tick: next()?.parse().ok()?,
            robot: next()?.parse().ok()?,
            at: Voxel::new(
                next()?.parse().ok()?,
                next()?.parse().ok()?,
                next()?.parse().ok()?,
            ),
            work: next()?.parse().ok()?,
        };
        next().is_none().then_some(record)
    }
}

impl Levels {
    fn of(scene: &Scene) -> Self {
        let Extent { width, height } = scene.extent();
        let sign = |voxel| match scene.is_occupied(voxel) {
            Some(true) => '#',
            _ => '.',
        };
        let row = |y, z| {
            (0..width as i16)
                .map(|x| sign(Voxel::new(x, y, z)))
                .collect()
        };
        let level = |z| (0..height as i16).map(|y| row(y, z)).collect();
        Self {
            name: scene.name().into(),
            levels: (0..i16::from(scene.levels())).map(level).collect(),
        }
    }

    fn scene(self) -> Result<Scene, TraceError> {
        let levels = &self.levels;
        let height = levels.first().map_or(0, Vec::len);
        let width = levels
            .first()
            .and_then(|level| level.first())
            .map_or(0, String::len);
        let sides = 1..=usize::from(LARGEST);
        if !sides.contains(&width) || !sides.contains(&height) || levels.len() > LEVELS.into() {
            let reason = format!("the scene has {width}×{height}×{} voxels", levels.len());
            return Err(TraceError::Survey(reason));
        }
        for level in levels {
            if level.len() != height || level.iter().any(|row| row.len() != width) {
                let reason = format!("the levels of the scene are not all {width}×{height}");
                return Err(TraceError::Survey(reason));
            }
            let mut signs = level.iter().flat_map(|row| row.bytes());
            if signs.any(|sign| sign != b'#' && sign != b'.') {
                let reason = "the scene has signs that are neither `#` nor `.`".into();
                return Err(TraceError::Survey(reason));
            }
        }
        let is_occupied =
            |Voxel { x, y, z }| levels[z as usize][y as usize].as_bytes()[x as usize] != b'.';
        let extent = Extent::new(width as u16, height as u16);
        Ok(Scene::from_fn(
            &self.name,
            extent,
            levels.len() as u8,
            is_occupied,
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::survey::voxels::{Simulation, run};

    fn trace(max_ticks: u32) -> VoxelTrace {
        let scenario = Scenario {
            range: 6,
            loss: 0.3,
            max_ticks,
            ..Scenario::new(2, 4)
        };
        run(&Scene::town(1, 28), &scenario).unwrap()
    }

    fn file(trace: &VoxelTrace) -> String {
        let mut file = Vec::new();
        trace.write(&mut file).unwrap();
        String::from_utf8(file).unwrap()
    }

    #[test]
    fn a_trace_survives_its_file_with_all_that_was_seen() {
        for max_ticks in [60, 20_000] {
            let trace = trace(max_ticks);
            let read = VoxelTrace::read(file(&trace).as_bytes()).unwrap();
            assert_eq!(read.scenario, trace.scenario);
            assert_eq!(read.scene, trace.scene);
            assert_eq!(file(&read), file(&trace));
            assert_eq!(read.ways, trace.ways);
            assert_eq!(read.found, trace.found);
            assert_eq!(read.seen, trace.seen);
            assert_eq!(read.stops, trace.stops);
            let has_stopped = trace.stops.iter().all(Option::is_some);
            assert_eq!(has_stopped, trace.all_stopped);
            assert_eq!(
                (read.visible, read.violations, read.all_stopped),
                (trace.visible, 0, max_ticks > 60)
            );
        }
    }

    #[test]
    fn a_run_that_is_over_stays_as_it_is() {
        let trace = trace(20);
        let mut run = Simulation::new(&trace.scene, &trace.scenario).unwrap();
        while run.step() {}
        assert!(!run.step() && !run.step());
        assert_eq!(run.trace().seen, trace.seen);
        assert_eq!(file(run.trace()), file(&trace));
    }

    #[test]
    fn a_damaged_file_is_an_error_that_says_where() {
        let text = file(&trace(20));
        let error = |text: &str| VoxelTrace::read(text.as_bytes()).unwrap_err().to_string();
        let cut = &text[..text[..text.len() - 1].rfind('\n').unwrap()];
        assert!(error(cut).contains("cut off"), "{}", error(cut));
        for (from, to, reason) in [
            ("\n0,1,", "\n0,one,", "line 4"),
            ("\n0,1,", "\n0,2,", "digest"),
            ("\"version\":1", "\"version\":9", "version 9"),
            ("\"robots\":2", "\"robots\":0", "--robots 0"),
            ("\"robots\":2", "\"robots\":4000000000", "1 to 255"),
            ("\"loss\":0.3", "\"loss\":3.0", "--loss 3"),
            ("\"range\":6", "\"range\":1", "2 to 12"),
            ("\"levels\":[[\"#", "\"levels\":[[\"?", "neither"),
            ("\"robots\":2", "\"robots\":5", "5 robots"),
            ("\"robots\":2", "\"robots\":3", "line 5"),
            ("\"robots\":2", "\"robots\":1", "line 4"),
            ("\"range\":6", "\"range\":200", "range"),
            ("\"levels\":[[\"", "\"levels\":[[\"#", "levels of the scene"),
        ] {
            let error = error(&text.replacen(from, to, 1));
            assert!(error.contains(reason), "{error}");
        }
    }
}
