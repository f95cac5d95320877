//! Runs in a scene of voxels: sense, share, decide in turn, fly; until every living robot
//! has stopped.

mod errors;
mod follower;
mod pilot;

use std::collections::BTreeSet;
use std::sync::Arc;

use planner_core::radio::{Key, MAX_LEN, VoxelFrame};
use planner_core::tile::TileIndex;
use planner_core::volume::{Content, Heading, Voxel, VoxelPatch, in_sight};
use planner_core::voxel_survey::Config;
use planner_core::{Action, ExtentError, RobotId, Stop};

use crate::baselines::voxels::{Body, Chart, assign};
use crate::dice::{Dice, Lot};
use crate::medium::{Claim, Radio, Station, any_voxel, voxel_frame};
use crate::record::voxels::{Record, VoxelTrace, Wrong};
use crate::record::{Deed, Nothing};
use crate::robot::Sent;
use crate::run::Here;
use crate::scenario::voxels::{Planner, Scenario};
use crate::scenario::{Faults, MediumKind, ScenarioError};
use crate::scene::{Marks, Scene, look_towards, visible};
use errors::told;
use pilot::pilot;

pub use pilot::{Host, Pilot};

/// Words of its map that a robot repeats in each step, in turn.
const IN_TURN: usize = 16;

/// How far a sensor turns in a step, in place or on the way, in eighths of a turn.
const TURN: u8 = 2;

/// A planner and the body that it moves.
struct Robot {
    id: RobotId,
    planner: Box<dyn Pilot>,
    at: Voxel,
    heading: Heading,
    alive: bool,
    stopped: bool,
    /// What it sees in this step.
    view: Vec<(Voxel, bool)>,
    /// The word that it repeats next.
    turn: (TileIndex, u8),
    /// Frames and bytes sent in this step.
    sent: Sent,
}

impl Robot {
    fn new(id: RobotId, at: Voxel, planner: Box<dyn Pilot>) -> Self {
        Self {
            id,
            planner,
            at,
            heading: Heading::EAST,
            alive: false,
            stopped: false,
            view: Vec::new(),
            turn: (TileIndex { x: 0, y: 0 }, 0),
            sent: Sent::default(),
        }
    }

    /// What it sees, and a few words of its map.
    fn news(&mut self) -> Vec<VoxelPatch> {
        let tile = |voxel: Voxel| TileIndex::of(voxel.cell()).expect("inside").0;
        let seen = self.view.iter();
        let mut touched: BTreeSet<(TileIndex, u8)> = seen
            .map(|&(voxel, _)| (tile(voxel), voxel.z as u8))
            .collect();
        for _ in 0..IN_TURN {
            touched.insert(self.turn);
            self.turn = self.planner.after(self.turn.0, self.turn.1);
        }
        let patches = touched.into_iter();
        let patches = patches.map(|(tile, z)| self.planner.patch(tile, z));
        patches.collect()
    }
}

impl Station for Robot {
    type Place = Voxel;
    type Frame = VoxelFrame;
    type Read = ();

    fn id(&self) -> RobotId {
        self.id
    }

    fn place(&self) -> Voxel {
        self.at
    }

    fn is_awake(&self) -> bool {
        self.alive
    }

    fn transmit(&mut self, buffer: &mut [u8; MAX_LEN]) -> Option<usize> {
        let length = self.planner.transmit(buffer)?;
        self.sent.count(length);
        Some(length)
    }

    fn read(&self, _: &[u8]) {}

    fn receive(&mut self, frame: &[u8], (): &()) {
        let _ = self.planner.receive(frame);
    }

    fn goal(&self) -> Option<Voxel> {
        self.planner.status().goal
    }

    fn corner(&self) -> Voxel {
        Voxel::new(0, 0, 0)
    }

    fn anywhere(&self, dice: &mut Dice) -> Voxel {
        any_voxel(self.planner.extent(), self.planner.levels(), dice)
    }

    fn around(&self) -> Vec<Voxel> {
        std::iter::once(self.at).chain(self.at.beside()).collect()
    }

    fn forged(&self, claim: Claim<Voxel>, pieces: u32, dice: &mut Dice) -> VoxelFrame {
        let (extent, levels) = (self.planner.extent(), self.planner.levels());
        voxel_frame(extent, levels, claim, pieces, dice)
    }

    fn encode(frame: &VoxelFrame, key: Option<&Key>, buffer: &mut [u8; MAX_LEN]) -> usize {
        frame.encode(key, buffer)
    }
}

/// Whether `voxel` is occupied on the joined map of `robots`.
fn is_taken_for_occupied(robots: &[Robot], voxel: Voxel) -> bool {
    let (tile, bit) = TileIndex::of(voxel.cell()).expect("inside");
    let (mut known, mut withdrawn) = (0, 0);
    for robot in robots {
        let patch = robot.planner.patch(tile, voxel.z as u8);
        known |= patch.known & patch.occupied;
        withdrawn |= patch.withdrawn();
    }
    known & !withdrawn & bit != 0
}

/// Runs `scenario` in `scene`.
///
/// # Errors
/// As [`Simulation::new`].
pub fn run(scene: &Scene, scenario: &Scenario) -> Result<VoxelTrace, ScenarioError> {
    run_on(&Here, scene, scenario)
}

/// As [`run`], with the planners elsewhere.
///
/// # Errors
/// As [`Simulation::new`].
pub fn run_on(
    host: &impl Host,
    scene: &Scene,
    scenario: &Scenario,
) -> Result<VoxelTrace, ScenarioError> {
    let mut run = Simulation::new_on(host, scene, scenario)?;
    while !host.has_failed() && run.step() {}
    Ok(run.finish())
}

/// Makes a robot's planner.
type Build = Box<dyn Fn(RobotId) -> Result<Box<dyn Pilot>, ExtentError>>;

/// A run that goes on step by step, for whoever wants to watch.
pub struct Simulation {
    scene: Arc<Scene>,
    config: Config,
    build: Build,
    robots: Vec<Robot>,
    trace: VoxelTrace,
    radio: Radio<Scene>,
    visible: Marks,
    known: Marks,
    /// Voxels that the robots take for occupied, where looks may err.
    occupied: Marks,
    /// What a centre knows that sends the robots.
    centre: Option<Chart>,
    /// Occupied voxels seen.
    seen: u32,
    now: u32,
}

impl Simulation {
    /// A run before its first step. Robots start where the scenario says, or at
    /// [`Scene::start`].
    ///
    /// # Errors
    /// A setting is out of its range, there is no room for a robot, or nothing to see.
    pub fn new(scene: &Scene, scenario: &Scenario) -> Result<Self, ScenarioError> {
        Self::new_on(&Here, scene, scenario)
    }

    fn new_on(host: &impl Host, scene: &Scene, scenario: &Scenario) -> Result<Self, ScenarioError> {
        scenario.check(scene)?;
        let start = scenario.start_in(scene)?;
        let config = Config {
            range: scenario.range,
            clearance: scenario.clearance,
            field: scenario.field,
            sensor: scenario.sensor(),
            come_home: scenario.conditions.mission.come_home,
            energy: scenario.conditions.mission.energy,
            link: scenario.conditions.link(),
        };
        let scene = Arc::new(scene.clone());
        let build: Build = {
            let (host, scene, how) = (host.clone(), scene.clone(), scenario.planner);
            Box::new(move |id| pilot(&host, &scene, config, how, id))
        };
        let robot = |id| {
            let id = RobotId(id as u8);
            Ok(Robot::new(id, start, build(id)?))
        };
        let robots = (0..scenario.robots).map(robot);
        let robots = robots.collect::<Result<_, ExtentError>>()?;
        let Scenario {
            range,
            clearance,
            field,
            ..
        } = *scenario;
        let visible = visible(&scene, start, clearance, range, field);
        let body = Body { range, clearance };
        if visible.count() == 0 {
            return Err(ScenarioError::NothingToSee);
        }
        Ok(Self {
            config,
            build,
            robots,
            trace: VoxelTrace {
                scenario: scenario.clone(),
                scene: (*scene).clone(),
                ways: vec![vec![start]; scenario.robots],
                headings: match scenario.field.is_round() {
                    true => Vec::new(),
                    false => vec![vec![Heading::EAST]; scenario.robots],
                },
                records: Vec::new(),
                found: Vec::new(),
                visible: visible.count(),
                seen: Vec::new(),
                all_stopped: false,
                stops: vec![None; scenario.robots],
                violations: 0,
                contacts: 0,
                bumps: 0,
                false_claims: 0,
                wrong: Vec::new(),
            },
            radio: Radio::new(&scenario.conditions, scene.clone()),
            known: Marks::of(&scene),
            occupied: Marks::of(&scene),
            centre: (scenario.planner == Planner::Greedy)
                .then(|| Chart::new(scene.extent(), scene.levels(), body)),
            scene,
            visible,
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

    /// See [`VoxelTrace::false_claims`].
    fn false_claims(&self) -> u32 {
        let claims = |robot: &&Robot, stop: &Option<Stop<Voxel>>| {
            robot.alive && stop.is_some_and(|stop| stop.is_complete())
        };
        let is_left = |robot: &Robot, voxel| {
            let content = robot.planner.content(voxel);
            self.visible.contains(&self.scene, voxel) && content == Content::Unknown
        };
        let robots = self.robots.iter().zip(&self.trace.stops);
        let claiming = robots.filter(|(robot, stop)| claims(robot, stop));
        let wrong = claiming.filter(|(robot, _)| {
            let mut voxels = self.scene.voxels();
            voxels.any(|voxel| is_left(robot, voxel))
        });
        wrong.count() as u32
    }

    /// What each robot's map says otherwise than it is.
    fn wrong(&self) -> Vec<Wrong> {
        if !self.trace.scenario.conditions.trouble.mistakes_places() {
            return Vec::new();
        }
        let of = |robot: &Robot| {
            let mut wrong = Wrong::default();
            for voxel in self.scene.voxels() {
                match (self.scene.content(voxel), robot.planner.content(voxel)) {
                    (Some(Content::Free), Content::Occupied) => wrong.closed += 1,
                    (Some(Content::Occupied), Content::Free) => wrong.opened += 1,
                    _ => {}
                }
            }
            wrong
        };
        self.robots.iter().map(of).collect()
    }

    /// One step of the fleet; false if the run is over, and then nothing changes any more.
    pub fn step(&mut self) -> bool {
        // In the last step robots look, and nobody flies on.
        if self.trace.seen.len() > self.now as usize {
            return false;
        }
        self.meet_fate();
        self.sense();
        self.share();
        self.trace.seen.push(self.seen);
        self.send();
        for i in 0..self.robots.len() {
            if self.robots[i].alive {
                self.act(i);
            }
        }
        let faults = &self.trace.scenario.conditions.faults;
        let going = faults.still_to_come(self.now + 1)
            || (self.robots.iter()).any(|robot| robot.alive && !robot.stopped);
        self.trace.all_stopped = !going;
        if !going || self.is_last() {
            self.trace.false_claims = self.false_claims();
            self.trace.wrong = self.wrong();
            return false;
        }
        for (robot, way) in self.robots.iter().zip(&mut self.trace.ways) {
            way.push(robot.at);
        }
        for (robot, headings) in self.robots.iter().zip(&mut self.trace.headings) {
            headings.push(robot.heading);
        }
        self.now += 1;
        true
    }

    /// Whether the run is given up before anybody flies on.
    fn is_last(&self) -> bool {
        self.now >= self.trace.scenario.conditions.max_ticks
    }

    /// Deaths, arrivals and restarts of this step, and who goes on.
    fn meet_fate(&mut self) {
        let faults = &self.trace.scenario.conditions.faults;
        for robot in &mut self.robots {
            robot.alive = faults.is_alive(robot.id, self.now);
            robot.sent = Sent::default();
            if robot.alive && Faults::befalls(&faults.restarts, robot.id, self.now) {
                robot.planner = (self.build)(robot.id).expect("it was set up like this before");
                robot.stopped = false;
            }
            if robot.alive && Faults::befalls(&faults.resumes, robot.id, self.now) {
                robot.planner.resume();
                if self.config.energy > 0 {
                    robot.planner.energy(self.config.energy);
                }
                robot.stopped = false;
            }
        }
    }

    fn sense(&mut self) {
        let first = self.trace.found.len();
        for robot in self.robots.iter_mut().filter(|robot| robot.alive) {
            let Config { range, field, .. } = self.config;
            robot.view = look_towards(&self.scene, robot.at, range, field, robot.heading);
            for &(voxel, occupied) in &robot.view {
                // Where the scan ends robots see a wall; the map leaves it unknown.
                if self.scene.is_known(voxel) && self.known.insert(&self.scene, voxel) {
                    self.trace.found.push((self.now, voxel, occupied));
                    self.seen += u32::from(self.visible.contains(&self.scene, voxel));
                }
            }
            let Robot {
                id, at, heading, ..
            } = *robot;
            let conditions = &self.trace.scenario.conditions;
            let lot = Lot::new(conditions.seed)
                .of(self.now.into())
                .of(id.0.into());
            let told = told(&conditions.trouble, lot, at, &robot.view);
            robot.planner.observe(at, heading, &told);
            if let Some(centre) = &mut self.centre {
                centre.learn(&robot.view);
            }
        }
        if self.trace.scenario.conditions.trouble.mistakes_places() {
            self.believe(first);
        }
    }

    /// What was found in this step, from number `first` on, is as the robots take it for, and so is
    /// all that they look at.
    fn believe(&mut self, first: usize) {
        let (scene, robots) = (&self.scene, &self.robots);
        for (_, voxel, occupied) in &mut self.trace.found[first..] {
            *occupied = is_taken_for_occupied(robots, *voxel);
            self.occupied.put(scene, *voxel, *occupied);
        }
        let looking = robots.iter().filter(|robot| robot.alive);
        let views = looking.flat_map(|robot| &robot.view);
        for &(voxel, _) in views.filter(|(voxel, _)| scene.is_known(*voxel)) {
            let occupied = is_taken_for_occupied(robots, voxel);
            if self.occupied.put(scene, voxel, occupied) {
                self.trace.found.push((self.now, voxel, occupied));
            }
        }
    }

    /// The centre, where there is one, tells every robot where to fly.
    fn send(&mut self) {
        let Some(centre) = &mut self.centre else {
            return;
        };
        let alive = || self.robots.iter().filter(|robot| robot.alive);
        let places: Vec<Voxel> = alive().map(|robot| robot.at).collect();
        let (steps, work) = assign(centre, &places);
        let alive = self.robots.iter_mut().filter(|robot| robot.alive);
        for (robot, to) in alive.zip(steps) {
            robot.planner.obey(to, work);
        }
    }

    /// What everybody has to say to everybody, before anybody decides.
    fn share(&mut self) {
        let conditions = &self.trace.scenario.conditions;
        match conditions.medium {
            MediumKind::Ideal => self.share_maps(),
            MediumKind::Radio => {
                let budget = conditions.byte_budget;
                self.radio.share(self.now, &mut self.robots, budget);
            }
        }
    }

    /// Everything that each robot sees to everybody, however much it is, and a few words
    /// of its map.
    fn share_maps(&mut self) {
        let news = |robot: &mut Robot| robot.alive.then(|| robot.news());
        let messages: Vec<_> = self.robots.iter_mut().map(news).collect();
        for (from, message) in messages.iter().enumerate() {
            let Some(patches) = message else { continue };
            for to in self.radio.listeners(self.now, &self.robots, from) {
                for patch in patches {
                    self.robots[to].planner.merge(patch);
                }
            }
        }
    }

    /// Whether a robot may fly from `at` to `to`. One that was pushed off all places for it may
    /// fly over what is free.
    fn is_allowed(&self, at: Voxel, to: Voxel) -> bool {
        let is_pose = |at| self.scene.is_pose(at, self.config.clearance);
        let was_pushed = !self.trace.scenario.conditions.wind.is_none() && !is_pose(at);
        let has_room = is_pose(to) || was_pushed && !self.scene.is_solid(to);
        has_room && at.distance_squared(to) <= 1
    }

    /// Where a robot comes to in the wind that flies to `to`: to the nearest voxel, on a straight
    /// way that ends before what is solid.
    fn blow(&mut self, robot: RobotId, to: Voxel) -> Voxel {
        let conditions = &self.trace.scenario.conditions;
        if conditions.wind.is_none() {
            return to;
        }
        let off = conditions.wind.gust(conditions.seed, self.now, robot);
        let off = off.map(|off| off.round() as i16);
        let steps = off.iter().map(|off| off.abs()).max().unwrap_or(0);
        let scene = &self.scene;
        let is_open = |at| scene.content(at) == Some(Content::Free);
        let mut at = to;
        for step in 1..=steps {
            let [x, y, z] = off.map(|off| (off * step).div_euclid(steps));
            let next = Voxel::new(to.x + x, to.y + y, to.z + z);
            if !is_open(next) || !in_sight(at, next, is_open) {
                break;
            }
            at = next;
        }
        let is_clear = scene.is_pose(at, self.config.clearance.max(1));
        self.trace.contacts += u32::from(!is_clear);
        at
    }

    /// Robot `i` decides, flies and tells the others where it is and goes.
    fn act(&mut self, i: usize) {
        let at = self.robots[i].at;
        let (mut to, deed, stop) = match self.robots[i].planner.tick() {
            Action::Move(_) if self.is_last() => (at, Deed::Hovered, None),
            Action::Move(to) => (to, Deed::Flew, None),
            Action::Wait => (at, Deed::Hovered, None),
            Action::Stop(stop) => (at, Deed::Stopped(stop.reason()), Some(stop)),
        };
        let work = self.robots[i].planner.work();
        if !self.is_allowed(at, to) {
            // A look may have hidden what is there.
            match self.trace.scenario.conditions.trouble.can_open_walls() {
                true => {
                    self.trace.bumps += 1;
                    to = at;
                }
                false => self.trace.violations += 1,
            }
        }
        self.trace.stops[i] = stop;
        self.robots[i].stopped = stop.is_some();
        let status = self.robots[i].planner.status();
        match self.trace.scenario.conditions.medium {
            MediumKind::Radio => self.radio.speak(self.now, &mut self.robots, i, 1),
            MediumKind::Ideal => {
                let id = self.robots[i].id;
                for to in self.radio.listeners(self.now, &self.robots, i) {
                    self.robots[to].planner.hear(id, status);
                }
            }
        }
        if stop.is_none() && !self.is_last() {
            to = self.blow(self.robots[i].id, to);
        }
        let robot = &mut self.robots[i];
        robot.at = to;
        robot.heading = robot.heading.turned(robot.planner.heading(), TURN);
        self.trace.records.push(Record {
            tick: self.now,
            robot: robot.id.0,
            at: to,
            deed,
            goal: status.goal,
            gain: Nothing {},
            known: robot.planner.known_voxels(),
            work,
            sent: robot.sent,
        });
    }
}
