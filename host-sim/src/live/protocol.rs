//! What robots and the world say to each other: one JSON value a line.

use std::io::{self, BufRead, BufReader, Write};
use std::net::{TcpStream, ToSocketAddrs};
use std::time::Duration;

use planner_core::{Cell, Direction, Sighting};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

/// From a robot.
#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum FromRobot {
    /// First, once: who it is.
    Hello { robot: u8 },
    /// In each tick, after it has looked.
    Go(u8),
    /// Stands still in this tick.
    Wait,
    /// Has stopped, for this reason, and says so in every tick.
    Stop { reason: String },
}

/// From the world.
#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum FromWorld {
    /// First, once.
    Welcome {
        width: u16,
        height: u16,
        robots: u8,
        at: (i16, i16),
    },
    /// A tick begins: this is seen.
    Look(Look),
    /// Whether the robot has moved.
    Went(bool),
    /// The run has ended.
    Over,
}

/// What a robot sees, and from where.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Look {
    pub(super) at: (i16, i16),
    pub(super) free: Vec<(i16, i16)>,
    pub(super) blocked: Vec<(i16, i16)>,
}

impl Look {
    pub(super) fn of(sighting: &Sighting) -> Self {
        let pair = |cell: Cell| (cell.x, cell.y);
        Self {
            at: pair(sighting.centre()),
            free: sighting.free_cells().map(pair).collect(),
            blocked: sighting.blocked_cells().map(pair).collect(),
        }
    }

    pub(super) fn sighting(&self) -> Sighting {
        let mut sighting = Sighting::new(Cell::new(self.at.0, self.at.1));
        for &(x, y) in &self.free {
            sighting.see_free(Cell::new(x, y));
        }
        for &(x, y) in &self.blocked {
            sighting.see_blocked(Cell::new(x, y));
        }
        sighting
    }
}

pub(super) fn go(direction: Direction) -> FromRobot {
    FromRobot::Go(direction as u8)
}

/// One end of a conversation. Nobody waits longer than the limit for the other.
pub(super) struct Line {
    from: BufReader<TcpStream>,
    to: TcpStream,
}

impl Line {
    pub(super) fn connect(to: impl ToSocketAddrs, limit: Duration) -> io::Result<Self> {
        Self::new(TcpStream::connect(to)?, limit)
    }

    pub(super) fn new(stream: TcpStream, limit: Duration) -> io::Result<Self> {
        stream.set_nonblocking(false)?;
        stream.set_nodelay(true)?;
        stream.set_read_timeout(Some(limit))?;
        stream.set_write_timeout(Some(limit))?;
        Ok(Self {
            from: BufReader::new(stream.try_clone()?),
            to: stream,
        })
    }

    pub(super) fn say(&mut self, message: &impl Serialize) -> io::Result<()> {
        let mut text = serde_json::to_string(message)?;
        text.push('\n');
        self.to.write_all(text.as_bytes())
    }

    /// The next message.
    ///
    /// # Errors
    /// The other is gone, silent, or says something else.
    pub(super) fn hear<M: DeserializeOwned>(&mut self) -> io::Result<M> {
        let mut text = String::new();
        if self.from.read_line(&mut text)? == 0 {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        Ok(serde_json::from_str(&text)?)
    }
}
