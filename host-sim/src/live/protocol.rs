//! What robots and the world say to each other: one JSON value a line.

use std::time::Duration;

use planner_core::{Cell, Direction, Sighting};
use serde::{Deserialize, Serialize};

use super::line::Line;

/// From a robot.
#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum FromRobot {
    /// First, once: who it is.
    Hello { robot: u8 },
    /// In each tick, after it has looked: the number of a direction, below 4.
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
    /// Nothing happens for a while; the world is there.
    Waiting,
    /// A tick begins: this is seen.
    Look(Look),
    /// Whether the robot has moved.
    Went(bool),
    /// The run has ended.
    Over,
    /// Whoever hears this takes part no longer, for this reason.
    Refused { reason: String },
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

/// Says why, if that can be heard, and hangs up.
pub(super) fn refuse(mut line: Line, reason: &str) {
    let reason = reason.into();
    let _ = line.say(&FromWorld::Refused { reason }, Duration::from_millis(100));
}
