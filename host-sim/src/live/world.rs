//! The world as a process: it knows where the robots are, what they see, and who
//! has not answered yet.

use std::io;
use std::net::{SocketAddr, TcpListener};
use std::sync::Arc;
use std::time::{Duration, Instant};

use planner_core::{Cell, Direction};
use serde::{Deserialize, Serialize};

use super::protocol::{FromRobot, FromWorld, Line, Look};
use crate::coverage::Coverage;
use crate::sensor::Sensor;
use crate::world::World;

/// Longest time that a robot may think; then it counts as gone.
const PATIENCE: Duration = Duration::from_secs(10);

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

/// A world that waits for its robots.
pub struct Server {
    options: WorldOptions,
    sensor: Sensor,
    coverage: Coverage,
    listener: TcpListener,
    bodies: Vec<Body>,
    reachable_cells: u32,
    tick: u32,
}

/// What the world knows of a robot.
struct Body {
    at: Cell,
    line: Option<Line>,
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
    pub fn open(options: WorldOptions) -> io::Result<Self> {
        let listener = TcpListener::bind(options.listen)?;
        listener.set_nonblocking(true)?;
        let reachable = options.world.reachable(&options.starts);
        let body = |&at| Body {
            at,
            line: None,
            stop: None,
            gone_since: Instant::now(),
        };
        Ok(Self {
            sensor: Sensor::new(options.world.clone(), options.range),
            coverage: Coverage::new(&options.world, &reachable, options.starts.len()),
            listener,
            bodies: options.starts.iter().map(body).collect(),
            reachable_cells: reachable.count(),
            options,
            tick: 0,
        })
    }

    /// Where it is served.
    ///
    /// # Errors
    /// Those of the socket.
    pub fn address(&self) -> io::Result<SocketAddr> {
        self.listener.local_addr()
    }

    /// Serves until all robots have stopped, or those that have not are gone for
    /// too long, or time is up. Calls `progress` after every tick, with the number
    /// of reachable cells seen.
    ///
    /// # Errors
    /// Those of the listening socket; a robot that fails is gone, no error.
    pub fn run(mut self, mut progress: impl FnMut(u32, u32)) -> io::Result<WorldReport> {
        while !self.is_present() && !self.is_given_up() {
            self.let_in()?;
            std::thread::sleep(Duration::from_millis(5));
        }
        while self.tick < self.options.max_ticks && !self.is_over() {
            let began = Instant::now();
            self.let_in()?;
            self.step();
            self.tick += 1;
            progress(self.tick, self.coverage.seen_cells());
            std::thread::sleep(self.options.pace.saturating_sub(began.elapsed()));
        }
        for line in self.bodies.iter_mut().filter_map(|body| body.line.as_mut()) {
            let _ = line.say(&FromWorld::Over);
        }
        Ok(WorldReport {
            ticks: self.tick,
            reachable_cells: self.reachable_cells,
            seen_cells: self.coverage.seen_cells(),
            stops: self.bodies.into_iter().map(|body| body.stop).collect(),
        })
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

    /// Lets in whoever is at the door. Who comes again takes over its body.
    fn let_in(&mut self) -> io::Result<()> {
        loop {
            let stream = match self.listener.accept() {
                Ok((stream, _)) => stream,
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => return Ok(()),
                Err(error) => return Err(error),
            };
            let Ok(mut line) = Line::new(stream, PATIENCE) else {
                continue;
            };
            if let Ok(FromRobot::Hello { robot }) = line.hear()
                && let Some(at) = self.bodies.get(usize::from(robot)).map(|body| body.at)
                && line.say(&self.welcome(at)).is_ok()
            {
                let body = &mut self.bodies[usize::from(robot)];
                body.line = Some(line);
                body.stop = None;
            }
        }
    }

    fn welcome(&self, at: Cell) -> FromWorld {
        let extent = self.options.world.extent();
        FromWorld::Welcome {
            width: extent.width,
            height: extent.height,
            robots: self.bodies.len() as u8,
            at: (at.x, at.y),
        }
    }

    /// All look, all answer, then one after another moves.
    fn step(&mut self) {
        for (index, body) in self.bodies.iter_mut().enumerate() {
            if let Some(line) = &mut body.line {
                let view = self.sensor.view(body.at, Direction::East);
                self.coverage.look(index, view);
                if line
                    .say(&FromWorld::Look(Look::of(&view.sighting)))
                    .is_err()
                {
                    body.leave();
                }
            }
        }
        for body in &mut self.bodies {
            let Some(line) = &mut body.line else { continue };
            let done = match line.hear() {
                Ok(FromRobot::Go(direction)) => {
                    let to = body.at.step(Direction::from_index(direction));
                    let is_free = self.options.world.is_free(to);
                    if is_free {
                        body.at = to;
                    }
                    line.say(&FromWorld::Went(is_free))
                }
                Ok(FromRobot::Wait) => Ok(()),
                Ok(FromRobot::Stop { reason }) => {
                    body.stop = Some(reason);
                    Ok(())
                }
                Ok(FromRobot::Hello { .. }) => Err(io::ErrorKind::InvalidData.into()),
                Err(error) => Err(error),
            };
            if done.is_err() {
                body.leave();
            }
        }
    }
}
