//! Runs over a terrain of heights: sense, share, decide in turn, fly; until every living robot has stopped.

mod pilot;

use std::sync::Arc;
#[cfg(not(target_arch = "wasm32"))]
use std::time::Instant;

use planner_core::radio::{Key, MAX_LEN, SurfaceFrame};
use planner_core::surface::{Columns, Height, Surface, body_columns, clearance, reaches_over};
use planner_core::survey::SetupError;
use planner_core::{Action, Cell, Extent, Motion, Point, RobotId};

use crate::baselines::surveys::{Order, Rounds, assign};
use crate::dice::Dice;
use crate::medium::{Claim, Radio, Station, any_point, surface_frame};
use crate::record::Deed;
use crate::record::heights::{Record, Safety, Trace};
use crate::robot::Sent;
use crate::run::Here;
use crate::scenario::heights::{Planner, Scenario};
use crate::scenario::{Conditions, Event, Faults, MediumKind, ScenarioError};
use crate::terrain::{Terrain, look};
pub use pilot::Host;
use pilot::{Pilot, pilot};

/// Takes the chance of sleep apart from that of the air: "sleep".
const SLEEP: u64 = 0x73_6c65_6570;

/// How near to the edge of the map the wind blows robots, in cells.
const EDGE: f32 = 0.01;

/// The pose of a robot that does not know where it is.
const NOWHERE: Point = Point::new(f32::NAN, f32::NAN, f32::NAN);

/// Runs `scenario` over `terrain`.
///
/// # Errors
/// A setting is out of its range, or the robots do not fit over the terrain.
pub fn run(terrain: &Terrain, scenario: &Scenario) -> Result<Trace, ScenarioError> {
    run_on(&Here, terrain, scenario)
}

/// As [`run`], with the planners of planner-core elsewhere.
///
/// # Errors
/// As [`run`].
pub fn run_on(
    host: &impl Host,
    terrain: &Terrain,
    scenario: &Scenario,
) -> Result<Trace, ScenarioError> {
    let mut run = open_on(host, Arc::new(terrain.clone()), scenario)?;
    while !host.has_failed() && run.step() {}
    Ok(run.finish())
}

/// A run before its first step, for whoever wants to watch.
///
/// # Errors
/// As [`run`].
pub fn open(
    terrain: Arc<Terrain>,
    scenario: &Scenario,
) -> Result<Box<dyn Stepping>, ScenarioError> {
    open_on(&Here, terrain, scenario)
}

fn open_on(
    host: &impl Host,
    terrain: Arc<Terrain>,
    scenario: &Scenario,
) -> Result<Box<dyn Stepping>, ScenarioError> {
    scenario.check()?;
    let Extent { width, height } = terrain.extent();
    Ok(match width.max(height).div_ceil(8) {
        0..=13 => Box::new(Simulation::<13>::new(host, terrain, scenario)?),
        14..=25 => Box::new(Simulation::<25>::new(host, terrain, scenario)?),
        _ => Box::new(Simulation::<64>::new(host, terrain, scenario)?),
    })
}

/// A run that goes on step by step.
pub trait Stepping {
    /// One step of the fleet; false if the run is over.
    fn step(&mut self) -> bool;
    /// What has happened so far.
    fn trace(&self) -> &Trace;
    /// What happened.
    fn finish(self: Box<Self>) -> Trace;
}

struct Robot<const T: usize> {
    id: RobotId,
    pilot: Pilot<T>,
    at: Point,
    /// Whether its body is in the air.
    is_there: bool,
    alive: bool,
    awake: bool,
    stopped: bool,
    /// Frames and bytes sent in this step.
    sent: Sent,
}

impl<const T: usize> Station for Robot<T> {
    type Place = Point;
    type Frame = SurfaceFrame;
    type Read = ();

    fn id(&self) -> RobotId {
        self.id
    }

    fn place(&self) -> Point {
        self.at
    }

    fn is_awake(&self) -> bool {
        self.awake
    }

    fn transmit(&mut self, buffer: &mut [u8; MAX_LEN]) -> Option<usize> {
        let length = self.pilot.get_mut().transmit(buffer)?;
        self.sent.count(length);
        Some(length)
    }

    fn read(&self, _: &[u8]) {}

    fn receive(&mut self, frame: &[u8], (): &()) {
        let _ = self.pilot.get_mut().receive(frame);
    }

    fn goal(&self) -> Option<Point> {
        let goal = self.pilot.get().status().goal;
        goal.map(|cell| Point::over(cell, self.at.z))
    }

    fn corner(&self) -> Point {
        Point::over(Cell::new(0, 0), self.at.z)
    }

    fn anywhere(&self, dice: &mut Dice) -> Point {
        let knowledge = self.pilot.get().knowledge();
        any_point(
            knowledge.surface().extent(),
            knowledge.limits().ceiling,
            dice,
        )
    }

    fn around(&self) -> Vec<Point> {
        let beside =
            (-1i8..=1).flat_map(|dy| (-1i8..=1).map(move |dx| (f32::from(dx), f32::from(dy))));
        let beside = beside.filter(|beside| *beside != (0.0, 0.0));
        let step = |(dx, dy)| self.at.offset(dx, dy, 0.0);
        std::iter::once(self.at).chain(beside.map(step)).collect()
    }

    fn forged(&self, claim: Claim<Point>, pieces: u32, dice: &mut Dice) -> SurfaceFrame {
        let extent = self.pilot.get().knowledge().surface().extent();
        surface_frame(extent, claim, pieces, dice)
    }

    fn encode(frame: &SurfaceFrame, key: Option<&Key>, buffer: &mut [u8; MAX_LEN]) -> usize {
        frame.encode(key, buffer)
    }
}

/// Makes a robot's planner.
type Build<const T: usize> = Box<dyn Fn(RobotId) -> Result<Pilot<T>, SetupError>>;

struct Simulation<const T: usize> {
    terrain: Arc<Terrain>,
    scenario: Scenario,
    build: Build<T>,
    robots: Vec<Robot<T>>,
    /// What anybody has seen.
    union: Box<Surface<T, T>>,
    radio: Radio<Terrain>,
    /// For who sleeps.
    dice: Dice,
    now: u32,
    trace: Trace,
}

impl<const T: usize> Stepping for Simulation<T> {
    fn step(&mut self) -> bool {
        self.advance()
    }

    fn trace(&self) -> &Trace {
        &self.trace
    }

    fn finish(self: Box<Self>) -> Trace {
        self.trace
    }
}

impl<const T: usize> Simulation<T> {
    fn new(
        host: &impl Host,
        terrain: Arc<Terrain>,
        scenario: &Scenario,
    ) -> Result<Self, ScenarioError> {
        let extent = terrain.extent();
        let starts = scenario.starts(&terrain)?;
        let build = {
            let (host, scenario) = (host.clone(), scenario.clone());
            Box::new(move |id| pilot(&host, extent, &scenario, id))
        };
        let robot = |(&at, id)| {
            let id = RobotId(id);
            Ok(Robot {
                id,
                pilot: build(id)?,
                at,
                is_there: false,
                alive: false,
                awake: false,
                stopped: false,
                sent: Sent::default(),
            })
        };
        let robots = starts.iter().zip(0..).map(robot);
        Ok(Self {
            robots: robots.collect::<Result<_, SetupError>>()?,
            build,
            trace: Trace::new(&terrain, scenario, starts),
            radio: Radio::new(&scenario.conditions, terrain.clone()),
            terrain,
            scenario: scenario.clone(),
            union: Box::new(Surface::new(extent).map_err(SetupError::from)?),
            dice: Dice::new(scenario.conditions.seed ^ SLEEP),
            now: 0,
        })
    }

    /// One step of the fleet; says whether there is another.
    fn advance(&mut self) -> bool {
        self.meet_fate();
        for i in 0..self.robots.len() {
            self.robots[i].awake = self.robots[i].alive && !self.dice.happens(self.scenario.skip);
            self.robots[i].sent = Sent::default();
        }
        self.sense();
        self.share();
        self.trace.seen.push(self.union.known_columns());
        let Conditions {
            faults, max_ticks, ..
        } = &self.scenario.conditions;
        let lives = |robot: &Robot<T>| faults.is_alive(robot.id, self.now);
        let going = faults.still_to_come(self.now + 1)
            || (self.robots.iter()).any(|robot| lives(robot) && !robot.stopped);
        self.trace.all_stopped = !going;
        if !going || self.now >= *max_ticks {
            return false;
        }
        let orders = self.orders();
        for i in 0..self.robots.len() {
            if self.robots[i].awake {
                self.act(i, &orders);
            }
        }
        self.check_safety();
        self.now += 1;
        true
    }

    /// Deaths, arrivals and restarts of this step, and who goes on. Who comes late waits
    /// until nobody is near its start.
    fn meet_fate(&mut self) {
        let faults = &self.scenario.conditions.faults;
        for i in 0..self.robots.len() {
            let robot = &self.robots[i];
            let lives = faults.is_alive(robot.id, self.now);
            let is_there = robot.is_there || lives && !self.collides(i, robot.at);
            let robot = &mut self.robots[i];
            let befalls = |events: &[Event]| Faults::befalls(events, robot.id, self.now);
            let (restarts, resumes) = (befalls(&faults.restarts), befalls(&faults.resumes));
            robot.is_there = is_there;
            robot.alive = lives && is_there;
            if robot.alive && restarts {
                robot.pilot = (self.build)(robot.id).expect("it was set up like this before");
            }
            if robot.alive && resumes {
                robot.pilot.get_mut().resume();
            }
            robot.stopped &= !(restarts || resumes);
        }
    }

    fn sense(&mut self) {
        let faults = &self.scenario.conditions.faults;
        for (number, robot) in self.robots.iter_mut().enumerate() {
            if !robot.awake {
                continue;
            }
            let mut columns = look(&self.terrain, robot.at, self.scenario.limits.range);
            columns.retain(|column| {
                !faults.is_blind(column.cell, self.now) && !faults.has_failed(number, self.now)
            });
            if faults.is_lost(number, self.now) {
                robot.pilot.get_mut().observe(NOWHERE, &columns);
                continue;
            }
            for &column in &columns {
                if self.union.learn(column) {
                    self.trace.found.push((self.now, column));
                }
            }
            robot.pilot.get_mut().observe(robot.at, &columns);
        }
    }

    /// What everybody has to say to everybody, before anybody decides.
    fn share(&mut self) {
        let conditions = &self.scenario.conditions;
        match conditions.medium {
            MediumKind::Ideal => self.share_maps(),
            MediumKind::Radio => {
                let budget = conditions.byte_budget;
                self.radio.share(self.now, &mut self.robots, budget);
            }
        }
    }

    /// Everybody's position and news to everybody, however much it is.
    fn share_maps(&mut self) {
        let messages: Vec<_> = self
            .robots
            .iter()
            .map(|robot| {
                let pilot = robot.pilot.get();
                let patches = || pilot.knowledge().patches().collect::<Vec<_>>();
                robot.awake.then(|| (pilot.status(), patches()))
            })
            .collect();
        for (from, message) in messages.iter().enumerate() {
            let Some((status, patches)) = message else {
                continue;
            };
            for to in self.radio.listeners(self.now, &self.robots, from) {
                let pilot = self.robots[to].pilot.get_mut();
                pilot.hear(RobotId(from as u8), *status);
                for patch in patches {
                    pilot.merge(patch);
                }
            }
        }
    }

    /// The centre's targets, if there is a centre.
    fn orders(&self) -> (Vec<Option<Cell>>, u32) {
        let (order, rounds) = match self.scenario.planner {
            Planner::Greedy => (Order::NearestPair, Rounds::Many),
            Planner::GreedyUnique => (Order::NearestPair, Rounds::One),
            Planner::GreedyInOrder => (Order::Robots, Rounds::One),
            _ => return (Vec::new(), 0),
        };
        let positions: Vec<Point> = self.robots.iter().map(|robot| robot.at).collect();
        let range = self.scenario.limits.range;
        assign(&self.union, &positions, range, order, rounds)
    }

    /// Robot `i` decides, flies and tells the others where it is and goes.
    fn act(&mut self, i: usize, (orders, cost): &(Vec<Option<Cell>>, u32)) {
        #[cfg(not(target_arch = "wasm32"))]
        let began = Instant::now();
        if let Pilot::Follower(follower) = &mut self.robots[i].pilot
            && let Some(&target) = orders.get(i)
        {
            follower.send_to(target, *cost);
        }
        let pilot = self.robots[i].pilot.get_mut();
        let action = pilot.tick();
        #[cfg(not(target_arch = "wasm32"))]
        self.trace
            .decision_nanoseconds
            .push(began.elapsed().as_nanos() as u64);
        let from = self.robots[i].at;
        let mut deed = match action {
            Action::Move(_) => Deed::Flew,
            Action::Wait => Deed::Hovered,
            Action::Stop(reason) => Deed::Stopped(reason.reason()),
        };
        let mut motion = None;
        if let Action::Move(to) = action {
            if self.collides(i, to) || self.is_closed(from, to) {
                deed = Deed::Refused;
            } else {
                self.trace
                    .safety
                    .check_flight(&self.terrain, &self.scenario.limits, from, to);
                self.robots[i].at = to;
            }
            motion = Some(match deed {
                Deed::Refused => Motion::Blocked,
                _ => Motion::Moved,
            });
        }
        if !matches!(action, Action::Stop(_)) {
            self.blow(i);
        }
        if let Some(motion) = motion {
            let at = self.robots[i].at;
            self.robots[i].pilot.get_mut().report(motion, at);
        }
        self.trace.stops[i] = match action {
            Action::Stop(reason) => Some(reason),
            Action::Move(_) | Action::Wait => None,
        };
        self.robots[i].stopped = self.trace.stops[i].is_some();
        let status = self.robots[i].pilot.get().status();
        match self.scenario.conditions.medium {
            MediumKind::Radio => self.radio.speak(self.now, &mut self.robots, i, 1),
            MediumKind::Ideal => {
                for to in self.radio.listeners(self.now, &self.robots, i) {
                    let pilot = self.robots[to].pilot.get_mut();
                    pilot.hear(RobotId(i as u8), status);
                }
            }
        }
        let robot = &self.robots[i];
        let knowledge = robot.pilot.get().knowledge();
        self.trace.records.push(Record {
            tick: self.now,
            robot: i as u8,
            at: robot.at,
            deed,
            goal: status.goal,
            gain: knowledge.gain(),
            known: knowledge.surface().known_columns(),
            work: robot.pilot.get().work(),
            sent: robot.sent,
        });
    }

    /// The wind pushes robot `i` from where it has flown to, or hovers: along level ground and
    /// up and down, but its body not off the map, nor through the ground.
    fn blow(&mut self, i: usize) {
        let conditions = &self.scenario.conditions;
        if conditions.wind.is_none() {
            return;
        }
        let gust = (conditions.wind).gust(conditions.seed, self.now, self.robots[i].id);
        let [x, y, z] = gust.map(|off| off as f32);
        let Extent { width, height } = self.terrain.extent();
        let inside = |at: f32, side: u16| at.clamp(EDGE, f32::from(side) - EDGE);
        let from = self.robots[i].at;
        let mut at = Point::new(
            inside(from.x + x, width),
            inside(from.y + y, height),
            from.z + z,
        );
        let wide = self.scenario.limits.clearance;
        let radius = f32::from(wide);
        let ground = |cell| self.terrain.under(cell, wide);
        if clearance(from, at, ground).is_none_or(|least| least < radius) {
            (at.x, at.y) = (from.x, from.y);
        }
        let least = ground(at.cell()).map_or(0.0, Height::cells);
        at.z = at.z.max(least + radius);
        self.robots[i].at = at;
    }

    /// The flight controller's own sense of nearness: without radio a planner cannot
    /// know where the others are, and such a flight is refused.
    fn collides(&self, i: usize, to: Point) -> bool {
        self.robots.iter().enumerate().any(|(other, robot)| {
            other != i && robot.alive && robot.at.distance(to) < self.scenario.limits.separation
        })
    }

    /// Whether the body enters a column that nothing can.
    fn is_closed(&self, from: Point, to: Point) -> bool {
        let faults = &self.scenario.conditions.faults;
        let wide = self.scenario.limits.clearance;
        !faults.closures.is_empty()
            && Columns::new(from, to)
                .flat_map(|crossing| body_columns(wide, crossing.cell))
                .filter(|&cell| !reaches_over(wide, from.cell(), cell))
                .any(|cell| faults.is_closed(cell, self.now))
    }

    fn check_safety(&mut self) {
        let alive: Vec<Point> = self
            .robots
            .iter()
            .filter(|robot| robot.alive)
            .map(|robot| robot.at)
            .collect();
        let limits = &self.scenario.limits;
        match self.scenario.conditions.wind.is_none() {
            true => self.trace.safety.check_separation(limits, &alive),
            false => self.trace.contacts += Safety::contacts(&self.terrain, limits, &alive),
        }
    }
}
