//! Robots in a world, and the tick that moves them all.

mod drive;

use std::sync::Arc;

use planner_core::explorer::{bodies_touch, body_cells};
use planner_core::tile::TileIndex;
use planner_core::{Action, AnyPlanner, Cell, Direction, Motion, RobotId, TileSet, Wait, role};

use crate::medium::{Medium, Message};
use crate::motion::Drivers;
use crate::robot::{Deed, Driven, Robot, Sent, Step, Touches, Violation};
use crate::scenario::{Event, Faults, Motion as InMetres, Trouble};
use crate::senses::{Senses, laid};
use crate::sensor::Sensor;

/// How the robots of a fleet share the world.
#[derive(Clone, Debug, Default)]
pub struct Rules {
    /// Whether a cell holds at most one robot.
    pub solid: bool,
    /// Cells that bodies reach beyond the one of their centre.
    pub clearance: u8,
    /// How bodies move; `None`: a cell a tick.
    pub motion: Option<InMetres>,
    /// What goes wrong.
    pub faults: Faults,
    /// How the world misleads robots.
    pub trouble: Trouble,
    /// Seed of that.
    pub seed: u64,
    /// Steps that the energy of a robot lasts for that goes on after a stop; 0: no limit.
    pub energy: u32,
}

/// Makes the planner of a robot that stands on a cell and knows nothing.
pub type Build<const TW: usize, const TH: usize> =
    Box<dyn Fn(RobotId, Cell) -> Box<dyn AnyPlanner<TW, TH>>>;

/// All robots of a run, in one world.
pub struct Fleet<const TW: usize, const TH: usize> {
    senses: Senses,
    medium: Box<dyn Medium<TW, TH>>,
    rules: Rules,
    build: Build<TW, TH>,
    robots: Vec<Robot<TW, TH>>,
    violations: Vec<Violation>,
    bumps: u32,
    touches: Touches,
    /// What drives bodies that move in metres.
    drivers: Option<Drivers>,
    all_tiles: TileSet<TH>,
    tick: u32,
}

impl<const TW: usize, const TH: usize> Fleet<TW, TH> {
    /// A fleet of one robot for each start, in this order.
    pub fn new(
        sensor: Arc<Sensor>,
        medium: Box<dyn Medium<TW, TH>>,
        rules: Rules,
        build: Build<TW, TH>,
        starts: &[Cell],
    ) -> Self {
        let mut all_tiles = TileSet::new();
        for (y, x) in (0..TH as u8).flat_map(|y| (0..TW as u8).map(move |x| (y, x))) {
            all_tiles.insert(TileIndex::new(x, y));
        }
        let robot = |(&start, id)| {
            let id = RobotId(id);
            let is_there = !rules.faults.comes_late(id);
            Robot {
                id,
                planner: build(id, start),
                position: start,
                alive: is_there,
                step: None,
                sent: Sent::default(),
                is_there,
                has_exchanged: false,
            }
        };
        let robots = starts.iter().zip(0..).map(robot).collect();
        let are_solid = rules.solid || rules.clearance > 0;
        let drivers = rules
            .motion
            .map(|motion| Drivers::new(motion, rules.clearance, are_solid, rules.seed, starts));
        Self {
            senses: Senses::new(
                sensor,
                &rules.faults,
                rules.trouble,
                rules.seed,
                starts,
                rules.clearance,
            ),
            medium,
            rules,
            build,
            robots,
            violations: Vec::new(),
            bumps: 0,
            touches: Touches::default(),
            drivers,
            all_tiles,
            tick: 0,
        }
    }

    /// The robots, by id.
    pub fn robots(&self) -> &[Robot<TW, TH>] {
        &self.robots
    }

    /// From now on, remember the messages of each tick.
    pub fn listen(&mut self) {
        self.medium.listen();
    }

    /// The messages of the last tick, heard, lost or under way. Empty without
    /// [`listen`](Self::listen).
    pub fn messages(&self) -> &[Message] {
        self.medium.messages()
    }

    /// Which way a robot is turned; a sensor that does not look all around looks there.
    pub fn heading(&self, robot: usize) -> Direction {
        self.senses.heading(robot)
    }

    /// Number of ticks done.
    pub fn ticks(&self) -> u32 {
        self.tick
    }

    /// What is seen, and what stands in the way, in the last tick.
    pub fn senses(&self) -> &Senses {
        &self.senses
    }

    /// Moves so far into obstacles that no look had hidden. Anything but none is a bug of a
    /// planner.
    pub fn violations(&self) -> &[Violation] {
        &self.violations
    }

    /// Steps so far that ended at a person, a shut door, or an obstacle that a look may have
    /// hidden.
    pub fn bumps(&self) -> u32 {
        self.bumps
    }

    /// Steps so far in which bodies would have touched.
    pub fn touches(&self) -> Touches {
        self.touches
    }

    /// How far a body went that moves in metres; otherwise nowhere.
    pub fn driven(&self, robot: usize) -> Driven {
        let drivers = self.drivers.as_ref();
        drivers.map_or(Driven::default(), |of| of.driven(robot))
    }

    /// Whether every living robot has stopped, and none is still to come or to go on.
    pub fn has_stopped(&self) -> bool {
        !self.rules.faults.still_to_come(self.tick)
            && self.robots.iter().all(|robot| {
                let stopped = |step: Step| matches!(step.deed, Deed::Stopped(_));
                !robot.alive || robot.step.is_some_and(stopped)
            })
    }

    /// One tick: all look, then all talk if it is time, then one after another
    /// decides and moves; bodies that move in metres then go on all at once.
    pub fn tick(&mut self) {
        self.meet_fate();
        self.look();
        self.medium.exchange(self.tick, &mut self.robots);
        if let Some(mut drivers) = self.drivers.take() {
            self.drive(&mut drivers);
            self.drivers = Some(drivers);
            self.tick += 1;
            return;
        }
        for index in 0..self.robots.len() {
            let robot = &self.robots[index];
            if robot.alive {
                let (at, sent) = (robot.position, robot.sent);
                let (deed, work) = match robot.has_exchanged {
                    true => (Deed::Yielded, 0),
                    false => (self.act(index), self.robots[index].planner.work()),
                };
                let after = self.robots[index].position;
                self.senses.follow(index, deed.turns_to(), after);
                self.robots[index].step = Some(Step {
                    at,
                    deed,
                    work,
                    sent,
                });
            }
        }
        self.tick += 1;
    }

    fn look(&mut self) {
        self.senses.begin(self.tick);
        for (index, robot) in self.robots.iter_mut().enumerate() {
            if !robot.alive {
                continue;
            }
            let drivers = self.drivers.as_ref();
            let believed = drivers.map_or(robot.position, |of| of.believed_cell(index));
            for look in 0..self.rules.trouble.looks {
                let sighting = self.senses.sighting(index, look, robot.position);
                match believed == robot.position {
                    true => robot.planner.observe(&sighting),
                    false => robot.planner.observe(&laid(&sighting, believed)),
                };
            }
            if believed == robot.position {
                for &(at, free, blocked) in &*self.senses.far(index, robot.position) {
                    robot.planner.observe_far(at, free, blocked);
                }
            }
            robot.has_exchanged = false;
            robot.sent = Sent::default();
        }
    }

    /// A robot goes on after a stop, with the map that it has and with new energy.
    pub fn resume(&mut self, robot: usize) {
        if let Some(robot) = self.robots.get_mut(robot).filter(|robot| robot.alive) {
            if self.rules.energy > 0 {
                robot.planner.energy(self.rules.energy);
            }
            robot.planner.resume();
            robot.step = None;
        }
    }

    /// A robot is told to go home. False where it is not there, or knows no way home.
    pub fn go_home(&mut self, robot: usize) -> bool {
        let robot = self.robots.get_mut(robot).filter(|robot| robot.alive);
        robot.is_some_and(|robot| robot.planner.go_home())
    }

    /// Deaths, arrivals and restarts of this tick, and who goes on.
    fn meet_fate(&mut self) {
        let faults = &self.rules.faults;
        for robot in &mut self.robots {
            let now = |events: &[Event]| Faults::befalls(events, robot.id, self.tick);
            if now(&faults.deaths) {
                robot.alive = false;
                robot.step = None;
            }
            if now(&faults.arrivals) {
                robot.alive = true;
                robot.is_there = true;
            }
            if now(&faults.restarts) && robot.is_there {
                robot.alive = true;
                robot.planner = (self.build)(robot.id, robot.position);
                if let Some(drivers) = &mut self.drivers {
                    drivers.realign(usize::from(robot.id.0));
                }
            }
        }
        let resumes = faults.resumes.iter().filter(|of| of.tick == self.tick);
        let resumed: Vec<usize> = resumes.map(|of| usize::from(of.robot.0)).collect();
        resumed.into_iter().for_each(|robot| self.resume(robot));
    }

    fn act(&mut self, index: usize) -> Deed {
        let robot = &mut self.robots[index];
        match robot.planner.tick() {
            Action::Move(direction) => self.go(index, direction),
            Action::Wait => match robot.planner.waiting() {
                Some(Wait::Look(to)) => Deed::Looked(to),
                _ => Deed::Waited,
            },
            Action::Stop(stop) => Deed::Stopped(stop),
        }
    }

    /// A body steps, unless it would touch something.
    fn go_wide(&mut self, index: usize, to: Cell) -> Motion {
        let clearance = self.rules.clearance;
        let cells = body_cells(clearance, to);
        let world = self.senses.sensor().world();
        let wall = { cells }.find(|cell| !world.is_free(*cell) || self.senses.is_taken(*cell));
        if let Some(cell) = wall {
            self.touches.walls += 1;
            self.can_be_entered(index, cell);
            return Motion::Blocked;
        }
        let others = self.robots.iter().filter(|other| other.is_there);
        let touches = |other: &Robot<TW, TH>| bodies_touch(clearance, to, other.position);
        if { others }.any(|other| usize::from(other.id.0) != index && touches(other)) {
            self.touches.bodies += 1;
            return Motion::Held;
        }
        match self.can_be_entered(index, to) {
            true => Motion::Moved,
            false => Motion::Blocked,
        }
    }

    fn go(&mut self, index: usize, direction: Direction) -> Deed {
        let to = self.robots[index].position.step(direction);
        let is_wide = self.rules.clearance > 0;
        let holder = (self.rules.solid && !is_wide)
            .then(|| self.holder(to))
            .flatten();
        let motion = match holder {
            _ if is_wide => self.go_wide(index, to),
            _ if !self.can_be_entered(index, to) => Motion::Blocked,
            None => Motion::Moved,
            Some(holder) => match self.exchange_roles(index, holder) {
                Meeting::Exchanged => return Deed::Exchanged(direction),
                Meeting::Refused(motion) => motion,
            },
        };
        let robot = &mut self.robots[index];
        robot.planner.report(motion);
        match motion {
            Motion::Moved => {
                robot.position = to;
                Deed::Moved(direction)
            }
            Motion::Blocked => Deed::Blocked(direction),
            Motion::Held => Deed::Held(direction),
        }
    }

    fn holder(&self, cell: Cell) -> Option<usize> {
        let stands_there = |robot: &Robot<TW, TH>| robot.is_there && robot.position == cell;
        self.robots.iter().position(stands_there)
    }

    fn can_be_entered(&mut self, index: usize, cell: Cell) -> bool {
        let is_obstacle = !self.senses.sensor().world().is_free(cell);
        if self.senses.is_taken(cell) || is_obstacle && self.rules.trouble.can_open_walls() {
            self.bumps += 1;
            return false;
        }
        if is_obstacle {
            self.violations.push(Violation {
                tick: self.tick,
                robot: self.robots[index].id,
                into: cell,
            });
            return false;
        }
        !self.rules.faults.is_closed(cell, self.tick)
    }

    /// A robot wants the cell that another one holds: roles walk, bodies stay.
    /// A robot takes part in one exchange a tick at most.
    fn exchange_roles(&mut self, index: usize, holder: usize) -> Meeting {
        let Ok([robot, other]) = self.robots.get_disjoint_mut([index, holder]) else {
            return Meeting::Refused(Motion::Blocked);
        };
        let (Some(mine), Some(theirs)) = (robot.planner.role(), other.planner.role()) else {
            return Meeting::Refused(Motion::Blocked);
        };
        if !other.alive {
            return Meeting::Refused(Motion::Blocked);
        }
        // Who does not know where it is takes over no way from there.
        if [index, holder].iter().any(|&of| !self.senses.has_pose(of)) {
            return Meeting::Refused(Motion::Held);
        }
        if other.has_exchanged {
            return Meeting::Refused(Motion::Held);
        }
        let exchanged = role::exchange(&mine, robot.position, &theirs, other.position);
        robot.planner.join(other.planner.map(), &self.all_tiles);
        other.planner.join(robot.planner.map(), &self.all_tiles);
        match exchanged {
            None => Meeting::Refused(Motion::Held),
            Some((for_robot, for_other)) => {
                robot.planner.adopt(for_robot);
                other.planner.adopt(for_other);
                robot.has_exchanged = true;
                other.has_exchanged = true;
                Meeting::Exchanged
            }
        }
    }
}

/// What comes of it when a robot wants the cell of another.
enum Meeting {
    Exchanged,
    Refused(Motion),
}
