//! A run: sense, share, decide in turn, fly; until every robot has stopped.

use std::collections::{BTreeSet, HashSet};

use planner_core::radio::{LinkConfig, MAX_LEN};
use planner_core::tile::TileIndex;
use planner_core::volume::{Voxel, VoxelPatch, in_sight};
use planner_core::voxel_survey::{Config, MAX_RANGE, VoxelSurvey};
use planner_core::{Action, Point, RobotId, Stop};

use super::file::Record;
use super::scene::{LARGEST, LEVELS, Scene};
use crate::dice::Dice;
use crate::draw::{Block, oblique};
use crate::fleet::Sent;
use crate::medium::MediumKind;
use crate::record::Deed;
use crate::survey::DEFAULT_BYTE_BUDGET;
use crate::survey::error::{SurveyError, check_robots, check_share};
use crate::survey::octree::OcTree;

type Robot = VoxelSurvey<{ LARGEST as usize / 8 }, { LARGEST as usize / 8 }, { LEVELS as usize }>;

/// Words of its map that a robot repeats in each step, in turn.
const IN_TURN: usize = 16;

/// What a run is a function of, beside the scene.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Scenario {
    /// Number of robots, 1 to 255.
    pub robots: usize,
    /// Sensor range in voxels, 2 to 12: robots keep a voxel away from everything.
    pub range: u8,
    /// What carries what robots tell each other.
    pub medium: MediumKind,
    /// Bytes that a robot may send by radio in a step on average.
    pub byte_budget: u16,
    /// Share of messages lost, 0 to 1.
    pub loss: f64,
    /// Seed of the losses.
    pub seed: u64,
    /// Steps after which the run is given up.
    pub max_ticks: u32,
}

impl Scenario {
    /// Range 8, no losses, and robots that share everything at once.
    pub fn new(robots: usize, seed: u64) -> Self {
        Self {
            robots,
            range: 8,
            medium: MediumKind::Ideal,
            byte_budget: DEFAULT_BYTE_BUDGET,
            loss: 0.0,
            seed,
            max_ticks: 20_000,
        }
    }

    /// Whether the scenario can be flown in `scene`.
    ///
    /// # Errors
    /// The first setting that is out of its range, and the range.
    pub fn check(&self, scene: &Scene) -> Result<(), SurveyError> {
        check_robots(self.robots)?;
        check_share("loss", self.loss)?;
        if !(2..=MAX_RANGE).contains(&self.range) {
            let expected = format!("2 to {MAX_RANGE} voxels");
            return Err(SurveyError::setting("range", self.range, expected));
        }
        let (extent, levels) = (scene.extent(), scene.levels());
        let sides = 1..=LARGEST;
        let fits = sides.contains(&extent.width)
            && sides.contains(&extent.height)
            && (1..=LEVELS).contains(&levels);
        match fits {
            true => Ok(()),
            false => Err(SurveyError::Scene {
                extent,
                levels,
                side: LARGEST,
                most: LEVELS,
            }),
        }
    }
}

/// A whole run.
#[derive(Clone, Debug)]
pub struct VoxelTrace {
    /// What was run.
    pub scenario: Scenario,
    /// Where.
    pub scene: Scene,
    /// Where each robot was, step by step from its start.
    pub ways: Vec<Vec<Voxel>>,
    /// Every decision, in order.
    pub records: Vec<Record>,
    /// Voxels in the order in which they were seen, each with the step and with whether
    /// it is occupied.
    pub found: Vec<(u32, Voxel, bool)>,
    /// Occupied voxels that can be seen from any place that can be reached: all that
    /// there is to see.
    pub visible: u32,
    /// Those that somebody had seen after each number of steps, from 0.
    pub seen: Vec<u32>,
    /// Whether every robot had stopped.
    pub all_stopped: bool,
    /// Why each robot had stopped at the end, if it had.
    pub stops: Vec<Option<Stop<Voxel>>>,
    /// Flights into or beside something, or longer than a voxel.
    pub violations: u32,
}

/// What `eye` sees within `range` voxels, each with whether it is occupied.
pub fn look(scene: &Scene, eye: Voxel, range: u8) -> Vec<(Voxel, bool)> {
    look_for(scene, eye, range, |_, _| true)
}

/// What `eye` sees of what is wanted.
fn look_for(
    scene: &Scene,
    eye: Voxel,
    range: u8,
    is_wanted: impl Fn(Voxel, bool) -> bool,
) -> Vec<(Voxel, bool)> {
    let reach = i16::from(range);
    let mut seen = Vec::new();
    for z in eye.z - reach..=eye.z + reach {
        for y in eye.y - reach..=eye.y + reach {
            for x in eye.x - reach..=eye.x + reach {
                let voxel = Voxel::new(x, y, z);
                if let Some(occupied) = scene.is_occupied(voxel)
                    && eye.distance_squared(voxel) <= u32::from(range).pow(2)
                    && is_wanted(voxel, occupied)
                    && in_sight(eye, voxel, |at| scene.is_occupied(at) != Some(true))
                {
                    seen.push((voxel, occupied));
                }
            }
        }
    }
    seen
}

/// Runs `scenario` in `scene`.
///
/// # Errors
/// As [`Simulation::new`].
pub fn run(scene: &Scene, scenario: &Scenario) -> Result<VoxelTrace, SurveyError> {
    let mut run = Simulation::new(scene, scenario)?;
    while run.step() {}
    Ok(run.finish())
}

/// A run that goes on step by step, for whoever wants to watch.
pub struct Simulation {
    scene: Scene,
    robots: Vec<Box<Robot>>,
    trace: VoxelTrace,
    medium: Medium,
    visible: HashSet<Voxel>,
    known: HashSet<Voxel>,
    /// Occupied voxels seen.
    seen: u32,
    now: u32,
}

impl Simulation {
    /// A run before its first step. Robots start above the ground near the north-west
    /// corner, or wherever there is room first.
    ///
    /// # Errors
    /// A setting is out of its range, there is no room for a robot, or nothing to see.
    pub fn new(scene: &Scene, scenario: &Scenario) -> Result<Self, SurveyError> {
        scenario.check(scene)?;
        let start = scene
            .voxels()
            .filter(|voxel| voxel.z >= 2 && scene.is_pose(*voxel))
            .min_by_key(|voxel| voxel.distance_squared(Voxel::new(2, 2, 2)))
            .ok_or(SurveyError::NoPose)?;
        let config = Config {
            range: scenario.range,
            link: LinkConfig {
                bytes_per_tick: scenario.byte_budget,
                ..LinkConfig::new()
            },
        };
        let mut robots = Vec::new();
        for id in 0..scenario.robots {
            let robot = Robot::new(config, RobotId(id as u8), scene.extent(), scene.levels());
            robots.push(Box::new(robot?));
        }
        let visible = visible(scene, start, scenario.range);
        if visible.is_empty() {
            return Err(SurveyError::NothingToSee);
        }
        let trace = VoxelTrace {
            scenario: scenario.clone(),
            scene: scene.clone(),
            ways: vec![vec![start]; scenario.robots],
            records: Vec::new(),
            found: Vec::new(),
            visible: visible.len() as u32,
            seen: Vec::new(),
            all_stopped: false,
            stops: vec![None; scenario.robots],
            violations: 0,
        };
        Ok(Self {
            scene: scene.clone(),
            robots,
            trace,
            medium: Medium {
                loss: scenario.loss,
                dice: Dice::new(scenario.seed),
                turns: vec![(TileIndex { x: 0, y: 0 }, 0); scenario.robots],
            },
            visible,
            known: HashSet::new(),
            seen: 0,
            now: 0,
        })
    }

    /// What has happened so far.
    pub fn trace(&self) -> &VoxelTrace {
        &self.trace
    }

    /// What happened.
    pub fn finish(self) -> VoxelTrace {
        self.trace
    }

    /// One step of the fleet; false if the run is over, and then nothing changes any more.
    pub fn step(&mut self) -> bool {
        let Self {
            scene,
            robots,
            trace,
            medium,
            visible,
            known,
            seen,
            now,
        } = self;
        // In the last step robots look, and nobody flies on.
        if trace.seen.len() > *now as usize {
            return false;
        }
        let scenario = trace.scenario.clone();
        let mut views = Vec::new();
        for (robot, way) in robots.iter_mut().zip(&trace.ways) {
            let at = *way.last().expect("it starts somewhere");
            let view = look(scene, at, scenario.range);
            for &(voxel, occupied) in &view {
                if known.insert(voxel) {
                    trace.found.push((*now, voxel, occupied));
                    *seen += u32::from(visible.contains(&voxel));
                }
            }
            robot.observe(at, &view);
            views.push(view);
        }
        let mut sent = vec![Sent::default(); robots.len()];
        match scenario.medium {
            MediumKind::Ideal => medium.share_maps(robots, &views),
            MediumKind::Radio => {
                let frames = usize::from(scenario.byte_budget) / MAX_LEN;
                // One is left for after the flight.
                for (i, sent) in sent.iter_mut().enumerate() {
                    medium.transmit(robots, i, frames.saturating_sub(1).max(1), sent);
                }
            }
        }
        trace.seen.push(*seen);
        let mut going = false;
        let mut next = Vec::new();
        for (i, sent) in sent.iter_mut().enumerate() {
            let at = *trace.ways[i].last().expect("as above");
            let action = robots[i].tick();
            let work = robots[i].work();
            let (to, deed, stop) = match action {
                // The run is given up before it flies.
                Action::Move(_) if *now >= scenario.max_ticks => (at, Deed::Hovered, None),
                Action::Move(to) => (to, Deed::Flew, None),
                Action::Wait => (at, Deed::Hovered, None),
                Action::Stop(stop) => (at, Deed::Stopped(stop.into()), Some(stop)),
            };
            going |= stop.is_none();
            trace.stops[i] = stop;
            let is_allowed = scene.is_pose(to) && at.distance_squared(to) <= 1;
            trace.violations += u32::from(!is_allowed);
            next.push(to);
            match scenario.medium {
                MediumKind::Ideal => medium.share_status(robots, i),
                MediumKind::Radio => medium.transmit(robots, i, 1, sent),
            }
            trace.records.push(Record {
                tick: *now,
                robot: i as u8,
                at: to,
                deed,
                goal: robots[i].status().goal,
                known: robots[i].volume().known_voxels(),
                work,
                sent: *sent,
            });
        }
        trace.all_stopped = !going;
        if !going || *now >= scenario.max_ticks {
            return false;
        }
        for (way, to) in trace.ways.iter_mut().zip(next) {
            way.push(to);
        }
        *now += 1;
        true
    }
}

/// What carries what robots tell each other.
struct Medium {
    loss: f64,
    dice: Dice,
    /// Where each robot stands that tells its map word by word.
    turns: Vec<(TileIndex, u8)>,
}

impl Medium {
    fn arrives(&mut self) -> bool {
        !self.dice.happens(self.loss)
    }

    /// Everything that each robot sees to everybody, however much it is, and a few words
    /// of its map.
    fn share_maps(&mut self, robots: &mut [Box<Robot>], views: &[Vec<(Voxel, bool)>]) {
        let mut messages: Vec<Vec<VoxelPatch>> = Vec::new();
        for ((robot, view), turn) in robots.iter().zip(views).zip(&mut self.turns) {
            let tile = |voxel: Voxel| TileIndex::of(voxel.cell()).expect("inside").0;
            let mut touched: BTreeSet<(TileIndex, u8)> = view
                .iter()
                .map(|&(voxel, _)| (tile(voxel), voxel.z as u8))
                .collect();
            for _ in 0..IN_TURN {
                touched.insert(*turn);
                *turn = robot.volume().after(turn.0, turn.1);
            }
            let patches = touched
                .into_iter()
                .map(|(tile, z)| robot.volume().patch(tile, z));
            messages.push(patches.collect());
        }
        for (from, message) in messages.iter().enumerate() {
            for (to, robot) in robots.iter_mut().enumerate() {
                if to != from && self.arrives() {
                    for patch in message {
                        robot.merge(patch);
                    }
                }
            }
        }
    }

    /// Where robot `from` is and goes, to everybody.
    fn share_status(&mut self, robots: &mut [Box<Robot>], from: usize) {
        let status = robots[from].status();
        for (to, robot) in robots.iter_mut().enumerate() {
            if to != from && self.arrives() {
                robot.hear(RobotId(from as u8), status);
            }
        }
    }

    /// Robot `from` sends as many frames as its budget allows, at most `most`.
    fn transmit(&mut self, robots: &mut [Box<Robot>], from: usize, most: usize, sent: &mut Sent) {
        let mut frame = [0; MAX_LEN];
        for _ in 0..most {
            let Some(length) = robots[from].transmit(&mut frame) else {
                break;
            };
            sent.frames += 1;
            sent.bytes += length as u32;
            for (to, robot) in robots.iter_mut().enumerate() {
                if to != from && self.arrives() {
                    let heard = robot.receive(&frame[..length]);
                    heard.expect("robots understand each other");
                }
            }
        }
    }
}

/// The occupied voxels that can be seen from any place that can be reached from `start`.
pub(super) fn visible(scene: &Scene, start: Voxel, range: u8) -> HashSet<Voxel> {
    let mut reached = vec![start];
    let mut is_reached: HashSet<Voxel> = reached.iter().copied().collect();
    let mut visible: HashSet<Voxel> = HashSet::new();
    let mut next = 0;
    while let Some(&at) = reached.get(next) {
        next += 1;
        let is_new = |voxel, occupied| occupied && !visible.contains(&voxel);
        let new = look_for(scene, at, range, is_new);
        visible.extend(new.into_iter().map(|(voxel, _)| voxel));
        for beside in at.beside() {
            if scene.is_pose(beside) && is_reached.insert(beside) {
                reached.push(beside);
            }
        }
    }
    visible
}

impl VoxelTrace {
    /// Steps until `share` of all that there is to see had been seen.
    pub fn ticks_to(&self, share: f64) -> Option<u32> {
        let wanted = (share * f64::from(self.visible)).ceil() as u32;
        let tick = self.seen.iter().position(|&seen| seen >= wanted);
        tick.map(|tick| tick as u32)
    }

    /// Whether everything that can be seen was seen, without a violation.
    pub fn complete(&self) -> bool {
        let all = Some(&self.visible).filter(|&&all| all > 0);
        all.is_some() && self.seen.last() == all && self.violations == 0
    }

    /// What had been seen after `tick` steps as an octree, free voxels included.
    pub fn octree(&self, tick: u32) -> OcTree {
        let mut tree = OcTree::new(1.0);
        let known = self.found.iter().take_while(|found| found.0 <= tick);
        for (_, voxel, occupied) in known {
            tree.insert([voxel.x, voxel.y, voxel.z].map(i32::from), *occupied);
        }
        tree
    }

    /// What had been seen after `tick` steps, with the ways flown.
    pub fn oblique_view(&self, tick: u32) -> image::RgbImage {
        let known = self.found.iter().take_while(|found| found.0 <= tick);
        let blocks = known.filter(|found| found.2).map(|(_, voxel, _)| Block {
            cell: voxel.cell(),
            bottom: f32::from(voxel.z),
            top: f32::from(voxel.z) + 1.0,
        });
        let point = |voxel: &Voxel| Point::over(voxel.cell(), f32::from(voxel.z) + 0.5);
        let ways: Vec<Vec<Point>> = self
            .ways
            .iter()
            .map(|way| way.iter().take(tick as usize + 1).map(point).collect())
            .collect();
        let highest = f32::from(self.scene.levels());
        oblique(self.scene.extent(), highest, blocks.collect(), &ways)
    }
}
