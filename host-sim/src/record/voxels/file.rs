//! Traces of runs among voxels as files.
//!
//! They are as [`record`](crate::record) says; the header holds the scenario, the scene as
//! rows of `#` occupied, `.` free and `?` unknown, level by level from below, where the robots started,
//! where their sensors were turned step by step (a digit each, in eighths of a turn from east
//! over south), whether every one had stopped and why each had, and what looks that err have
//! mistaken; the columns are the fields of a
//! [`Record`].

use std::collections::HashMap;
use std::io::{self, BufRead};

use planner_core::volume::{Content, Heading, Voxel};
use planner_core::{Extent, Stop};
use serde::{Deserialize, Serialize};

use super::{VoxelTrace, Wrong};
use crate::record::{self, Deed, Format, Kind, Nothing, Objection, Order, TraceError, wrong};
use crate::scenario::ScenarioError;
use crate::scenario::voxels::Scenario;
use crate::scene::{Frame, Free, LARGEST, LEVELS, Marks, Scene, look_towards, visible};

/// Most steps without a record, all together.
const MOST_EMPTY_STEPS: u32 = 10_000;

#[derive(Serialize, Deserialize)]
struct Header {
    scenario: Scenario,
    starts: Vec<[i16; 3]>,
    /// Of each robot, unless they show all round.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    headings: Vec<String>,
    all_stopped: bool,
    /// Of each robot at the end.
    stops: Vec<Option<Stop<Voxel>>>,
    /// Of looks that err: what was found otherwise than it is, and what changed later.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    mistaken: Vec<(u32, [i16; 3], bool)>,
    /// What each robot's map had wrong in the end.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    wrong: Vec<Wrong>,
    world: Levels,
}

#[derive(Serialize, Deserialize)]
struct Levels {
    name: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    frame: Option<Frame>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    free: Option<Free>,
    levels: Vec<Vec<String>>,
}

/// One decision of one robot: `at` is where it was after it, `goal` the pose that it
/// announced.
pub type Record = record::Record<Voxels>;

/// Records of robots among voxels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Voxels;

impl Kind for Voxels {
    const FORMAT: Format = Format {
        name: "host-sim voxel trace",
        version: 3,
        oldest: 2,
    };
    type Place = Voxel;
    type Deed = Deed;
    type Goal = Voxel;
    type Gain = Nothing;
}

/// # Errors
/// A place outside of `scene`.
fn check(record: &Record, scene: &Scene) -> Result<(), Objection> {
    let places = [("a position", Some(record.at)), ("a goal", record.goal)];
    for (name, place) in places {
        if let Some(voxel @ Voxel { x, y, z }) = place
            && scene.content(voxel).is_none()
        {
            let expected = format!("{name} in the scene");
            return Err(wrong(expected, format!("{x},{y},{z}")));
        }
    }
    Ok(())
}

impl VoxelTrace {
    /// Writes the trace in the format that this module documents.
    ///
    /// # Errors
    /// Those of `to`.
    pub fn write(&self, to: impl io::Write) -> io::Result<()> {
        let starts = self.ways.iter().map(|way| way[0]);
        let header = Header {
            scenario: self.scenario.clone(),
            starts: starts.map(|Voxel { x, y, z }| [x, y, z]).collect(),
            headings: self.headings.iter().map(|it| digits(it)).collect(),
            all_stopped: self.all_stopped,
            stops: self.stops.clone(),
            mistaken: self.mistaken(),
            wrong: self.wrong.clone(),
            world: Levels::of(&self.scene),
        };
        record::write(to, &header, &self.records)
    }

    /// Reads a trace, and checks that it is whole.
    ///
    /// Cost: a look for each place where a robot was, and for each that can be reached.
    ///
    /// # Errors
    /// What is wrong, and in which line.
    pub fn read(from: impl BufRead) -> Result<Self, TraceError> {
        let (_, header, records) = record::read::<Header, Voxels>(from)?;
        let (scene, scenario) = (header.world.scene()?, header.scenario);
        scenario.check(&scene)?;
        let robots = scenario.robots;
        let of_robots = |what, count| match count == robots {
            true => Ok(()),
            false => Err(TraceError::Survey(format!(
                "{robots} robots do not have {count} {what}"
            ))),
        };
        of_robots("starts", header.starts.len())?;
        of_robots("ends", header.stops.len())?;
        if !header.wrong.is_empty() {
            of_robots("maps", header.wrong.len())?;
        }
        let headings = header.headings.iter().map(|text| headings(text));
        let headings = headings
            .collect::<Option<Vec<_>>>()
            .ok_or_else(|| TraceError::Survey("a heading is none of the digits 0 to 7".into()))?;
        if !scenario.field.is_round() {
            of_robots("rows of headings", headings.len())?;
        }
        let starts = header.starts.into_iter();
        let starts: Vec<_> = starts.map(|[x, y, z]| Voxel::new(x, y, z)).collect();
        if starts.iter().any(|&at| scene.content(at).is_none()) {
            return Err(TraceError::Survey(
                "a robot starts outside of the scene".into(),
            ));
        }
        let mut order = Order {
            robots,
            end: scenario.conditions.max_ticks.saturating_add(1),
            last: None,
        };
        let mut empty_steps = 0u32;
        record::check(&records, |record| {
            let next = order.last.map_or(0, |(last, _)| last.saturating_add(1));
            order.take(record)?;
            empty_steps = empty_steps.saturating_add(record.tick.saturating_sub(next));
            if empty_steps > MOST_EMPTY_STEPS {
                let expected = format!("at most {MOST_EMPTY_STEPS} steps without a record");
                return Err(wrong(expected, format!("tick {}", record.tick)));
            }
            check(record, &scene)
        })?;
        let mut trace = Self {
            ways: starts.into_iter().map(|start| vec![start]).collect(),
            headings,
            records,
            found: Vec::new(),
            visible: 0,
            seen: Vec::new(),
            all_stopped: header.all_stopped,
            stops: header.stops,
            violations: 0,
            contacts: 0,
            bumps: 0,
            false_claims: 0,
            wrong: header.wrong,
            scenario,
            scene,
        };
        if trace.records.is_empty() {
            return Err(TraceError::Survey("there is no record".into()));
        }
        let steps = trace
            .records
            .last()
            .map_or(0, |last| last.tick as usize + 1);
        if trace
            .headings
            .iter()
            .any(|of_robot| of_robot.len() != steps)
        {
            let reason = format!("the sensors were not turned in each of {steps} steps");
            return Err(TraceError::Survey(reason));
        }
        trace.look_again();
        trace.mistake(&header.mistaken)?;
        match trace.visible {
            0 => Err(ScenarioError::NothingToSee.into()),
            _ => Ok(trace),
        }
    }

    /// The ways, what was seen, and what should not have been flown, follow from the
    /// records.
    fn look_again(&mut self) {
        let scene = &self.scene;
        let Scenario {
            range,
            clearance,
            field,
            ..
        } = self.scenario;
        let visible = visible(scene, self.ways[0][0], clearance, range, field);
        let mut known = Marks::of(scene);
        let mut looked = Marks::of(scene);
        let mut seen = 0;
        let mut at: Vec<Voxel> = self.ways.iter().map(|way| way[0]).collect();
        let steps = self.records.last().map_or(0, |last| last.tick + 1);
        let mut rest = &self.records[..];
        for tick in 0..steps {
            let of_step = rest.iter().take_while(|record| record.tick == tick).count();
            let (records, later) = rest.split_at(of_step);
            rest = later;
            for record in records {
                let robot = usize::from(record.robot);
                let at = at[robot];
                let turns = self.headings.get(robot);
                let heading = turns.map_or(Heading::EAST, |it| it[tick as usize]);
                // Who looks from the same place all round sees the same.
                let is_new = looked.insert(scene, at) || !field.is_round();
                let view = is_new.then(|| look_towards(scene, at, range, field, heading));
                for (voxel, occupied) in view.into_iter().flatten() {
                    if scene.is_known(voxel) && known.insert(scene, voxel) {
                        self.found.push((tick, voxel, occupied));
                        seen += u32::from(visible.contains(scene, voxel));
                    }
                }
            }
            self.seen.push(seen);
            for record in records {
                at[usize::from(record.robot)] = record.at;
            }
            // In the last step nobody flies on.
            if tick + 1 < steps {
                for (way, &at) in self.ways.iter_mut().zip(&at) {
                    way.push(at);
                }
            }
        }
        let legs = self.ways.iter().flat_map(|way| way.windows(2));
        let is_allowed = |leg: &&[Voxel]| {
            scene.is_pose(leg[1], clearance) && leg[0].distance_squared(leg[1]) <= 1
        };
        let (violations, contacts) = match self.scenario.conditions.wind.is_none() {
            true => (legs.filter(|leg| !is_allowed(leg)).count(), 0),
            false => {
                let touches = |leg: &&[Voxel]| !scene.is_pose(leg[1], clearance.max(1));
                (0, legs.filter(touches).count())
            }
        };
        (self.violations, self.contacts) = (violations as u32, contacts as u32);
        self.visible = visible.count();
    }

    /// What was found otherwise than it is, and what changed later: all that does not follow from
    /// the records.
    fn mistaken(&self) -> Vec<(u32, [i16; 3], bool)> {
        let scene = &self.scene;
        let mut known = Marks::of(scene);
        let is_true = |voxel, occupied| {
            let is_occupied = scene.content(voxel) == Some(Content::Occupied);
            is_occupied == occupied
        };
        let found = self.found.iter();
        let others =
            found.filter(|found| !known.insert(scene, found.1) || !is_true(found.1, found.2));
        let entry = |&(tick, Voxel { x, y, z }, occupied)| (tick, [x, y, z], occupied);
        others.map(entry).collect()
    }

    /// Takes that in, where all that was found is as it is.
    ///
    /// # Errors
    /// Something that was not seen until then.
    fn mistake(&mut self, mistaken: &[(u32, [i16; 3], bool)]) -> Result<(), TraceError> {
        let found = self.found.iter().zip(0..);
        let places: HashMap<Voxel, (u32, usize)> =
            found.map(|(found, i)| (found.1, (found.0, i))).collect();
        for &(tick, [x, y, z], occupied) in mistaken {
            let voxel = Voxel::new(x, y, z);
            match places.get(&voxel) {
                Some(&(first, i)) if first == tick => self.found[i].2 = occupied,
                Some(&(first, _)) if first < tick => self.found.push((tick, voxel, occupied)),
                _ => {
                    let reason = format!("{voxel} was mistaken in step {tick} and not seen");
                    return Err(TraceError::Survey(reason));
                }
            }
        }
        self.found.sort_by_key(|found| found.0);
        Ok(())
    }

    /// 16 hex digits that differ if any record does.
    pub fn digest(&self) -> String {
        record::digest(&self.records)
    }
}

fn digits(headings: &[Heading]) -> String {
    let digits = headings.iter();
    digits.map(|it| char::from(b'0' + it.eighths())).collect()
}

fn headings(digits: &str) -> Option<Vec<Heading>> {
    let heading = |digit: char| digit.to_digit(8).map(|eighths| Heading::new(eighths as u8));
    digits.chars().map(heading).collect()
}

impl Levels {
    fn of(scene: &Scene) -> Self {
        let Extent { width, height } = scene.extent();
        let sign = |voxel| match scene.content(voxel) {
            Some(Content::Occupied) => '#',
            Some(Content::Unknown) => '?',
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
            frame: scene.frame(),
            free: scene.free(),
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
            if signs.any(|sign| !b"#.?".contains(&sign)) {
                let reason = "the scene has signs that are neither `#`, `.` nor `?`".into();
                return Err(TraceError::Survey(reason));
            }
        }
        let content =
            |Voxel { x, y, z }| match levels[z as usize][y as usize].as_bytes()[x as usize] {
                b'#' => Content::Occupied,
                b'.' => Content::Free,
                _ => Content::Unknown,
            };
        if let Some(frame) = self.frame.filter(|frame| !frame.is_good()) {
            let reason = format!("the scene lies nowhere: {frame:?}");
            return Err(TraceError::Survey(reason));
        }
        let extent = Extent::new(width as u16, height as u16);
        let scene = Scene::from_contents(&self.name, extent, levels.len() as u8, content);
        Ok(scene.framed(self.frame).freed(self.free))
    }
}

#[cfg(test)]
mod tests {
    use planner_core::volume::Field;

    use super::*;
    use crate::damage::assert_refused;
    use crate::run::voxels::{Simulation, run};
    use crate::scenario::Preset;

    fn trace(max_ticks: u32) -> VoxelTrace {
        let mut scenario = Scenario::new(2, 4);
        scenario.range = 6;
        scenario.conditions.loss = 0.3;
        scenario.conditions.max_ticks = max_ticks;
        run(&Scene::town(1, 28), &scenario).unwrap()
    }

    #[test]
    fn headings_survive_too() {
        let mut scenario = Scenario::new(2, 4);
        scenario.field = Field::CAMERA;
        scenario.conditions.max_ticks = 80;
        let trace = run(&Scene::town(1, 24), &scenario).unwrap();
        let text = file(&trace);
        let read = VoxelTrace::read(text.as_bytes()).unwrap();
        assert_eq!(
            (&read.headings, &read.found),
            (&trace.headings, &trace.found)
        );
        assert_eq!(read.scenario, scenario);
        let error = |bytes: &[u8]| VoxelTrace::read(bytes).unwrap_err().to_string();
        assert_refused(
            &text,
            error,
            &[
                ("\"headings\":[\"0", "\"headings\":[\"8", "digits 0 to 7"),
                ("\"headings\":[\"0", "\"headings\":[\"", "each of 81 steps"),
                (
                    "\"headings\":[\"0",
                    "\"headings\":[\"0\",\"0",
                    "3 rows of headings",
                ),
            ],
        );
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
    fn what_was_mistaken_survives_too() {
        let mut scenario = Scenario::new(2, 4);
        scenario.conditions.max_ticks = 150;
        scenario.conditions.trouble.false_walls = 0.05;
        scenario.conditions.trouble.false_frees = 0.02;
        for preset in [Preset::Truthful, Preset::Rangers] {
            scenario.conditions.preset = preset;
            let trace = run(&Scene::town(1, 24), &scenario).unwrap();
            let read = VoxelTrace::read(file(&trace).as_bytes()).unwrap();
            assert_eq!((&read.found, &read.wrong), (&trace.found, &trace.wrong));
            assert_eq!(
                (read.seen.last(), read.octree(150)),
                (trace.seen.last(), trace.octree(150))
            );
            let is_solid = |voxel| trace.scene.is_solid(voxel);
            let map = trace.map(150);
            let closed = map
                .iter()
                .filter(|(at, occupied)| *occupied && !is_solid(*at))
                .count();
            assert!(closed > 0);
            assert!(trace.wrong.iter().all(|wrong| wrong.closed > 0));
            let damaged = file(&trace).replacen("\"mistaken\":[[0,", "\"mistaken\":[[-1,", 1);
            assert!(VoxelTrace::read(damaged.as_bytes()).is_err());
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
        let error = |bytes: &[u8]| VoxelTrace::read(bytes).unwrap_err().to_string();
        let cut = &text.as_bytes()[..text[..text.len() - 1].rfind('\n').unwrap()];
        assert!(error(cut).contains("cut off"), "{}", error(cut));
        assert_refused(
            &text,
            error,
            &[
                ("\n0,1,", "\n0,one,", "line 4"),
                ("\n0,1,", "\n0,2,", "digest"),
                ("\"version\":3", "\"version\":9", "version 9"),
                ("\"robots\":2", "\"robots\":0", "--robots 0"),
                ("\"robots\":2", "\"robots\":4000000000", "1 to 255"),
                ("\"loss\":0.3", "\"loss\":3.0", "--loss 3"),
                ("\"range\":6", "\"range\":1", "2 to 12"),
                ("\"levels\":[[\"#", "\"levels\":[[\"!", "neither"),
                ("\"robots\":2", "\"robots\":5", "5 robots"),
                ("\"starts\":[[2,", "\"starts\":[[-2,", "starts outside"),
                ("\"range\":6", "\"range\":200", "range"),
                ("\"levels\":[[\"", "\"levels\":[[\"#", "levels of the scene"),
            ],
        );
    }
}
