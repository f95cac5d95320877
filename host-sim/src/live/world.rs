//! The world as a process: it knows where the robots are, what they see, and who
//! has not answered yet.

use std::fmt;
use std::net::SocketAddr;
use std::sync::Arc;
use std::time::{Duration, Instant};

use planner_core::{Cell, Direction};
use serde::{Deserialize, Serialize};

use super::door::{Door, Newcomer};
use super::error::LiveError;
use super::line::{Line, LineError};
use super::protocol::{FromRobot, FromWorld, Look, refuse};
use crate::coverage::Coverage;
use crate::excerpt::excerpt;
use crate::sensor::Sensor;
use crate::world::World;

/// Longest time that a robot may think; then it counts as gone.
const PATIENCE: Duration = Duration::from_secs(10);
/// Longest time that a robot may take to hear what it is told.
const HEARING: Duration = Duration::from_secs(2);
/// Robots hear something at least as often, while they wait.
const HEARTBEAT: Duration = Duration::from_secs(1);
/// Answers of a robot after which one that has come as the same robot is sent away. The
/// first may have been given before its process ended.
const PROOFS: u8 = 2;

/// How a world is served.
#[derive(Clone, Debug)]
pub struct WorldOptions {
    /// What is explored.
    pub world: Arc<World>,
    /// Where each robot starts.
    pub starts: Vec<Cell>,
    /// Sensor range in cells.
    pub range: u8,
    /// Where robots find it; port 0 takes a free one.
    pub listen: SocketAddr,
    /// Least time of a tick: 0 is lock step as fast as the robots answer.
    pub pace: Duration,
    /// How long the world waits for robots that have not come, or are gone.
    pub absence: Duration,
    /// The run ends after this many ticks.
    pub max_ticks: u32,
}

/// What a run came to.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct WorldReport {
    /// Ticks that were run.
    pub ticks: u32,
    /// Free cells that can be reached from any start.
    pub reachable_cells: u32,
    /// Reachable cells that somebody has seen.
    pub seen_cells: u32,
    /// Why each robot stopped; `None` if it did not, or was gone in the end.
    pub stops: Vec<Option<String>>,
}

impl WorldReport {
    /// Whether every reachable cell was seen and every robot has stopped.
    pub fn is_complete(&self) -> bool {
        self.seen_cells == self.reachable_cells && self.stops.iter().all(Option::is_some)
    }
}

/// Something that happens in a served world.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Event {
    /// A tick has ended.
    Ticked {
        /// How many have.
        tick: u32,
        /// Reachable cells that somebody has seen.
        seen: u32,
    },
    /// A robot is gone, for now.
    Left {
        /// Its number.
        robot: usize,
        /// What became of it.
        why: String,
    },
    /// A robot is not waited for any longer.
    Missed {
        /// Its number.
        robot: usize,
    },
    /// Somebody was not let in as this robot.
    Refused {
        /// The number.
        robot: u8,
        /// Why.
        why: String,
    },
}

impl fmt::Display for Event {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Ticked { tick, seen } => write!(f, "tick {tick}: {seen} cells seen"),
            Self::Left { robot, why } => write!(
                f,
                "robot {robot} {why}; its place is kept for a while, start it again"
            ),
            Self::Missed { robot } => write!(f, "robot {robot} is not there; going on without it"),
            Self::Refused { robot, why } => write!(f, "nobody was let in as robot {robot}: {why}"),
        }
    }
}

/// A world that waits for its robots.
pub struct Server {
    options: WorldOptions,
    sensor: Sensor,
    coverage: Coverage,
    door: Door,
    bodies: Vec<Body>,
    reachable_cells: u32,
    tick: u32,
    /// What has happened and was not told yet.
    events: Vec<Event>,
}

/// What the world knows of a robot.
struct Body {
    at: Cell,
    line: Option<Line>,
    /// Who takes over if the one that moves it is gone, and how often that one has
    /// answered meanwhile.
    heir: Option<(Line, u8)>,
    stop: Option<String>,
    /// Since when nobody moves it.
    gone_since: Instant,
}

impl Body {
    fn leave(&mut self) {
        self.line = None;
        self.stop = None;
        self.gone_since = Instant::now();
    }
}

impl Server {
    /// Opens the door.
    ///
    /// # Errors
    /// The address is taken.
    pub fn open(options: WorldOptions) -> Result<Self, LiveError> {
        let address = options.listen;
        let door = Door::open(address);
        let door = door.map_err(|problem| LiveError::Serve { address, problem })?;
        let reachable = options.world.reachable(&options.starts);
        let body = |&at| Body {
            at,
            line: None,
            heir: None,
            stop: None,
            gone_since: Instant::now(),
        };
        Ok(Self {
            sensor: Sensor::new(options.world.clone(), options.range),
            coverage: Coverage::new(&options.world, &reachable, options.starts.len()),
            door,
            bodies: options.starts.iter().map(body).collect(),
            reachable_cells: reachable.count(),
            options,
            tick: 0,
            events: Vec::new(),
        })
    }

    /// Where it is served.
    pub fn address(&self) -> SocketAddr {
        self.door.address()
    }

    /// Serves until all robots have stopped, or those that have not are gone for
    /// too long, or time is up. Calls `tell` with what happens. A tick waits for an
    /// answer of each robot that is there, at most 10 s for all together; strangers do
    /// not hold it up.
    pub fn run(mut self, mut tell: impl FnMut(Event)) -> WorldReport {
        let mut beat = Instant::now();
        while !self.is_present() && !self.is_given_up() {
            self.let_in();
            self.events.drain(..).for_each(&mut tell);
            if beat.elapsed() > HEARTBEAT {
                self.say_to_all(&FromWorld::Waiting);
                beat = Instant::now();
            }
            std::thread::sleep(Duration::from_millis(5));
        }
        let missed = self.bodies.iter().enumerate();
        for (robot, _) in missed.filter(|(_, body)| body.line.is_none()) {
            tell(Event::Missed { robot });
        }
        while self.tick < self.options.max_ticks && !self.is_over() {
            let began = Instant::now();
            self.let_in();
            // Ticks are for those that are there; nobody's would be over in no time.
            if self.bodies.iter().all(|body| body.line.is_none()) {
                self.events.drain(..).for_each(&mut tell);
                std::thread::sleep(Duration::from_millis(5));
                continue;
            }
            self.step();
            self.tick += 1;
            self.events.drain(..).for_each(&mut tell);
            tell(Event::Ticked {
                tick: self.tick,
                seen: self.coverage.seen_cells(),
            });
            self.rest(self.options.pace.saturating_sub(began.elapsed()));
        }
        self.close()
    }

    fn close(mut self) -> WorldReport {
        self.say_to_all(&FromWorld::Over);
        for (line, _) in self.bodies.iter_mut().filter_map(|body| body.heir.take()) {
            refuse(line, "the run is over");
        }
        WorldReport {
            ticks: self.tick,
            reachable_cells: self.reachable_cells,
            seen_cells: self.coverage.seen_cells(),
            stops: self.bodies.into_iter().map(|body| body.stop).collect(),
        }
    }

    fn is_present(&self) -> bool {
        self.bodies.iter().all(|body| body.line.is_some())
    }

    /// Whether a robot has been gone for too long.
    fn is_given_up(&self) -> bool {
        self.bodies
            .iter()
            .any(|body| body.line.is_none() && body.gone_since.elapsed() > self.options.absence)
    }

    fn is_over(&self) -> bool {
        self.bodies.iter().all(|body| {
            let is_lost = || body.gone_since.elapsed() > self.options.absence;
            body.stop.is_some() || body.line.is_none() && is_lost()
        })
    }

    fn say_to_all(&mut self, message: &FromWorld) {
        for body in &mut self.bodies {
            let lines = body.line.iter_mut();
            // Who does not hear it does not answer either, in the next tick.
            for line in lines.chain(body.heir.as_mut().map(|(line, _)| line)) {
                let _ = line.say(message, HEARING);
            }
        }
    }

    fn rest(&mut self, mut left: Duration) {
        while left > HEARTBEAT {
            std::thread::sleep(HEARTBEAT);
            left -= HEARTBEAT;
            self.say_to_all(&FromWorld::Waiting);
        }
        std::thread::sleep(left);
    }

    /// Lets in who has come. Who comes as a robot whose process is gone takes over its
    /// body; while it is there, it keeps it.
    fn let_in(&mut self) {
        let newcomers: Vec<Newcomer> = self.door.newcomers().collect();
        for Newcomer { robot, line } in newcomers {
            let last = self.bodies.len() - 1;
            let why = match self.bodies.get_mut(usize::from(robot)) {
                None => {
                    format!("there is no robot {robot} here; robots are numbered 0 to {last}")
                }
                Some(body) if body.heir.is_some() => is_taken(robot),
                Some(body) => {
                    body.heir = Some((line, 0));
                    continue;
                }
            };
            refuse(line, &why);
            self.events.push(Event::Refused { robot, why });
        }
        for index in 0..self.bodies.len() {
            self.inherit(index);
        }
    }

    fn inherit(&mut self, index: usize) {
        let extent = self.options.world.extent();
        let robots = self.bodies.len() as u8;
        let body = &mut self.bodies[index];
        if body.line.as_ref().is_some_and(Line::is_closed) {
            body.leave();
            let why = LineError::Gone.to_string();
            self.events.push(Event::Left { robot: index, why });
        }
        let is_taken_now = body.line.is_some();
        let Some((mut line, proofs)) = body.heir.take() else {
            return;
        };
        if is_taken_now && proofs < PROOFS {
            body.heir = Some((line, proofs));
        } else if is_taken_now {
            let (robot, why) = (index as u8, is_taken(index as u8));
            refuse(line, &why);
            self.events.push(Event::Refused { robot, why });
        } else {
            let welcome = FromWorld::Welcome {
                width: extent.width,
                height: extent.height,
                robots,
                at: (body.at.x, body.at.y),
            };
            if line.say(&welcome, HEARING).is_ok() {
                body.line = Some(line);
                body.stop = None;
            }
        }
    }

    /// All look, all answer, then one after another moves.
    fn step(&mut self) {
        for index in 0..self.bodies.len() {
            let body = &mut self.bodies[index];
            if let Some(line) = &mut body.line {
                let view = self.sensor.view(body.at, Direction::East);
                self.coverage.look(index, view);
                let look = FromWorld::Look(Look::of(&view.sighting));
                if let Err(error) = line.say(&look, HEARING) {
                    self.leave(index, &error);
                }
            }
        }
        let since = Instant::now();
        for index in 0..self.bodies.len() {
            if let Err(error) = self.answer(index, since) {
                self.leave(index, &error);
            }
        }
    }

    /// What a robot does in this tick.
    fn answer(&mut self, index: usize, since: Instant) -> Result<(), LineError> {
        let body = &mut self.bodies[index];
        let Some(line) = &mut body.line else {
            return Ok(());
        };
        let answer = line.hear(since, PATIENCE)?;
        body.stop = None;
        match answer {
            FromRobot::Go(direction) if direction < 4 => {
                let to = body.at.step(Direction::from_index(direction));
                let is_free = self.options.world.is_free(to);
                if is_free {
                    body.at = to;
                }
                line.say(&FromWorld::Went(is_free), HEARING)?;
            }
            FromRobot::Wait => {}
            FromRobot::Stop { reason } => body.stop = Some(excerpt(&reason)),
            FromRobot::Go(_) | FromRobot::Hello { .. } => {
                return Err(LineError::Nonsense(excerpt(&format!("{answer:?}"))));
            }
        }
        if let Some((_, proofs)) = &mut body.heir {
            *proofs = proofs.saturating_add(1);
        }
        Ok(())
    }

    fn leave(&mut self, index: usize, error: &LineError) {
        let why = error.to_string();
        let body = &mut self.bodies[index];
        if let Some(line) = body.line.take() {
            refuse(line, &format!("it {why}"));
        }
        body.leave();
        self.events.push(Event::Left { robot: index, why });
    }
}

fn is_taken(robot: u8) -> String {
    format!(
        "robot {robot} is there already; give another --id, or end the process that is robot \
         {robot}"
    )
}
