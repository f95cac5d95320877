//! One robot as a process.

use std::io;
use std::net::{SocketAddr, TcpStream, UdpSocket};
use std::time::{Duration, Instant};

use planner_core::radio::{LinkConfig, MAX_LEN};
use planner_core::{Action, AnyPlanner, Cell, Extent, Motion, RobotId};
use serde::{Deserialize, Serialize};

use super::error::LiveError;
use super::line::{Line, LineError};
use super::protocol::{FromRobot, FromWorld, go};
use crate::excerpt::excerpt;
use crate::planners::{PlannerKind, Setup};
use crate::scenario::{Mission, Preset};

/// Longest silence of the world.
const PATIENCE: Duration = Duration::from_secs(30);
/// Longest time that the world may take to hear what it is told.
const HEARING: Duration = Duration::from_secs(10);

/// How a robot takes part.
#[derive(Clone, Debug)]
pub struct RobotOptions {
    /// Its number, less than the world's number of robots.
    pub robot: u8,
    /// What decides.
    pub planner: PlannerKind,
    /// Where the world is served.
    pub world: SocketAddr,
    /// Where it hears frames.
    pub listen: SocketAddr,
    /// Where the others hear frames.
    pub peers: Vec<SocketAddr>,
    /// How it uses the radio.
    pub link: LinkConfig,
    /// What it takes its sensor for, if its planner weighs looks.
    pub preset: Preset,
}

/// What a robot came to.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RobotReport {
    /// Its number.
    pub robot: u8,
    /// Why it stopped; `None` if the run ended before.
    pub stop: Option<String>,
    /// Cells walked.
    pub steps: u32,
    /// Free cells on its map.
    pub free_cells_known: u32,
    /// Frames sent, to all peers at once.
    pub frames_sent: u32,
    /// Their bytes.
    pub bytes_sent: u32,
    /// Frames heard and taken.
    pub frames_heard: u32,
    /// Datagrams that were not.
    pub frames_refused: u32,
}

/// Takes part in a run until the world ends it.
///
/// # Errors
/// The world or the socket fails, the world does not take the robot, or the grid is
/// larger than any planner's map.
pub fn explore(options: &RobotOptions) -> Result<RobotReport, LiveError> {
    let socket = frames(options.listen).map_err(|problem| LiveError::Frames {
        address: options.listen,
        problem,
    })?;
    let mut world = World::at(options.world)?;
    world.say(&FromRobot::Hello {
        robot: options.robot,
    })?;
    let (extent, start) = loop {
        match world.hear()? {
            FromWorld::Welcome {
                width,
                height,
                at: (x, y),
                ..
            } => break (Extent::new(width, height), Cell::new(x, y)),
            FromWorld::Waiting => {}
            other => return Err(world.nonsense(&other)),
        }
    };
    let place = Place { extent, start };
    match extent.width.max(extent.height) {
        0..=64 => Body::<8, 8>::new(options, &place, socket)?.run(world),
        65..=256 => Body::<32, 32>::new(options, &place, socket)?.run(world),
        _ => Body::<64, 64>::new(options, &place, socket)?.run(world),
    }
}

fn frames(at: SocketAddr) -> io::Result<UdpSocket> {
    let socket = UdpSocket::bind(at)?;
    socket.set_nonblocking(true)?;
    Ok(socket)
}

/// The world, as a robot has it.
struct World {
    address: SocketAddr,
    line: Line,
}

impl World {
    fn at(address: SocketAddr) -> Result<Self, LiveError> {
        let line = TcpStream::connect_timeout(&address, HEARING).and_then(Line::new);
        let line = line.map_err(|problem| LiveError::NoWorld { address, problem })?;
        Ok(Self { address, line })
    }

    fn say(&mut self, message: &FromRobot) -> Result<(), LiveError> {
        let said = self.line.say(message, HEARING);
        said.map_err(|problem| {
            // A world that hangs up may have said why.
            match self.line.poll() {
                Ok(Some(FromWorld::Refused { reason })) => self.refused(&reason),
                _ => self.wrong(problem),
            }
        })
    }

    fn hear(&mut self) -> Result<FromWorld, LiveError> {
        match self.line.hear(Instant::now(), PATIENCE) {
            Ok(FromWorld::Refused { reason }) => Err(self.refused(&reason)),
            Ok(message) => Ok(message),
            Err(problem) => Err(self.wrong(problem)),
        }
    }

    fn wrong(&self, problem: LineError) -> LiveError {
        let address = self.address;
        LiveError::World { address, problem }
    }

    fn refused(&self, reason: &str) -> LiveError {
        LiveError::Refused {
            address: self.address,
            reason: excerpt(reason),
        }
    }

    /// A message that does not belong here.
    fn nonsense(&self, message: &FromWorld) -> LiveError {
        self.wrong(LineError::Nonsense(excerpt(&format!("{message:?}"))))
    }
}

/// Where a robot finds itself.
struct Place {
    extent: Extent,
    start: Cell,
}

struct Body<const TW: usize, const TH: usize> {
    planner: Box<dyn AnyPlanner<TW, TH>>,
    socket: UdpSocket,
    peers: Vec<SocketAddr>,
    report: RobotReport,
}

impl<const TW: usize, const TH: usize> Body<TW, TH> {
    fn new(options: &RobotOptions, place: &Place, socket: UdpSocket) -> Result<Self, LiveError> {
        let id = RobotId(options.robot);
        let planner = options
            .planner
            .build(Setup {
                id,
                extent: place.extent,
                start: place.start,
                link: options.link,
                sensor: options.preset.model(),
                clearance: 0,
                mission: Mission::default(),
            })
            .map_err(|error| LiveError::Place {
                address: options.world,
                reason: error.to_string(),
            })?;
        Ok(Self {
            planner,
            socket,
            peers: options.peers.clone(),
            report: RobotReport {
                robot: options.robot,
                stop: None,
                steps: 0,
                free_cells_known: 0,
                frames_sent: 0,
                bytes_sent: 0,
                frames_heard: 0,
                frames_refused: 0,
            },
        })
    }

    fn run(mut self, mut world: World) -> Result<RobotReport, LiveError> {
        // Whether the robot has said where it goes, and not heard whether it went.
        let mut goes = false;
        loop {
            match world.hear()? {
                FromWorld::Look(look) if !goes => {
                    self.planner.observe(&look.sighting());
                    self.speak();
                    self.listen();
                    self.report.stop = None;
                    let act = match self.planner.tick() {
                        Action::Move(direction) => {
                            goes = true;
                            go(direction)
                        }
                        Action::Wait => FromRobot::Wait,
                        Action::Stop(stop) => {
                            self.report.stop = Some(stop.to_string());
                            FromRobot::Stop {
                                reason: stop.to_string(),
                            }
                        }
                    };
                    world.say(&act)?;
                }
                FromWorld::Went(moved) if goes => {
                    goes = false;
                    self.report.steps += u32::from(moved);
                    self.planner.report(match moved {
                        true => Motion::Moved,
                        false => Motion::Blocked,
                    });
                }
                FromWorld::Waiting => {}
                FromWorld::Over => return Ok(self.close()),
                other => return Err(world.nonsense(&other)),
            }
        }
    }

    /// Sends what the budget allows. A peer that is not there does not matter.
    fn speak(&mut self) {
        let mut buffer = [0; MAX_LEN];
        while let Some(length) = self.planner.transmit(&mut buffer) {
            self.report.frames_sent += 1;
            self.report.bytes_sent += length as u32;
            for peer in &self.peers {
                let _ = self.socket.send_to(&buffer[..length], peer);
            }
        }
    }

    /// Takes in what has arrived; no more than a thousand datagrams a tick, so
    /// that nobody can keep it from deciding.
    fn listen(&mut self) {
        // One byte more than a frame, to notice those that are too long.
        let mut buffer = [0; MAX_LEN + 1];
        for _ in 0..1000 {
            match self.socket.recv_from(&mut buffer) {
                Ok((length, _)) => match self.planner.receive(&buffer[..length]) {
                    Ok(_) => self.report.frames_heard += 1,
                    Err(_) => self.report.frames_refused += 1,
                },
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => return,
                // On some systems an absent peer comes back as an error.
                Err(_) => {}
            }
        }
    }

    fn close(mut self) -> RobotReport {
        let map = self.planner.map();
        let Extent { width, height } = map.extent();
        let cells = (0..height as i16).flat_map(|y| (0..width as i16).map(move |x| (x, y)));
        let free = cells.filter(|&(x, y)| map.is_free(Cell::new(x, y)));
        self.report.free_cells_known = free.count() as u32;
        self.report
    }
}
