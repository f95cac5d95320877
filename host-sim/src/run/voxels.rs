//! Runs in a scene of voxels: sense, share, decide in turn, fly; until every robot has stopped.

use std::collections::{BTreeSet, HashSet};

use planner_core::radio::MAX_LEN;
use planner_core::tile::TileIndex;
use planner_core::volume::{Voxel, VoxelPatch};
use planner_core::voxel_survey::{Config, VoxelSurvey};
use planner_core::{Action, RobotId};

use crate::dice::Dice;
use crate::fleet::Sent;
use crate::record::Deed;
use crate::scenario::voxels::Scenario;
use crate::scenario::{MediumKind, ScenarioError};
use crate::scene::{LARGEST, LEVELS, Scene, look, visible};
use crate::survey::voxels::{Record, VoxelTrace};

type Robot = VoxelSurvey<{ LARGEST as usize / 8 }, { LARGEST as usize / 8 }, { LEVELS as usize }>;

/// Words of its map that a robot repeats in each step, in turn.
const IN_TURN: usize = 16;

/// Runs `scenario` in `scene`.
///
/// # Errors
/// As [`Simulation::new`].
pub fn run(scene: &Scene, scenario: &Scenario) -> Result<VoxelTrace, ScenarioError> {
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
    pub fn new(scene: &Scene, scenario: &Scenario) -> Result<Self, ScenarioError> {
        scenario.check(scene)?;
        let start = scene
            .voxels()
            .filter(|voxel| voxel.z >= 2 && scene.is_pose(*voxel))
            .min_by_key(|voxel| voxel.distance_squared(Voxel::new(2, 2, 2)))
            .ok_or(ScenarioError::NoPose)?;
        let config = Config {
            range: scenario.range,
            link: scenario.conditions.link(),
        };
        let mut robots = Vec::new();
        for id in 0..scenario.robots {
            let robot = Robot::new(config, RobotId(id as u8), scene.extent(), scene.levels());
            robots.push(Box::new(robot?));
        }
        let visible = visible(scene, start, scenario.range);
        if visible.is_empty() {
            return Err(ScenarioError::NothingToSee);
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
                loss: scenario.conditions.loss,
                dice: Dice::new(scenario.conditions.seed),
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
        match scenario.conditions.medium {
            MediumKind::Ideal => medium.share_maps(robots, &views),
            MediumKind::Radio => {
                let frames = usize::from(scenario.conditions.byte_budget) / MAX_LEN;
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
                Action::Move(_) if *now >= scenario.conditions.max_ticks => {
                    (at, Deed::Hovered, None)
                }
                Action::Move(to) => (to, Deed::Flew, None),
                Action::Wait => (at, Deed::Hovered, None),
                Action::Stop(stop) => (at, Deed::Stopped(stop.into()), Some(stop)),
            };
            going |= stop.is_none();
            trace.stops[i] = stop;
            let is_allowed = scene.is_pose(to) && at.distance_squared(to) <= 1;
            trace.violations += u32::from(!is_allowed);
            next.push(to);
            match scenario.conditions.medium {
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
        if !going || *now >= scenario.conditions.max_ticks {
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
