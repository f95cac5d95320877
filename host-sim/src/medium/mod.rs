//! How robots hear of each other.

mod air;
mod forger;
mod ideal;
mod radio;

use std::fmt;
use std::sync::Arc;

use clap::ValueEnum;
use planner_core::RobotId;
use serde::{Deserialize, Serialize};

pub use air::{AirFaults, Partition, Reach};
pub use forger::{Forger, Forgery};
pub use ideal::Ideal;
pub use radio::Radio;

use crate::fleet::Robot;
use crate::world::World;
use air::Air;

/// What carries maps and positions between robots.
pub trait Medium<const TW: usize, const TH: usize> {
    /// Carries what the living robots say in `tick`, and what is due in it.
    fn exchange(&mut self, tick: u32, robots: &mut [Robot<TW, TH>]);

    /// From now on, remember the messages of each tick, if this medium can.
    fn listen(&mut self) {}

    /// The messages of the last tick, if they are remembered. One that comes late is
    /// among those of every tick until it is heard.
    fn messages(&self) -> &[Message] {
        &[]
    }
}

/// One message from one robot to another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Message {
    /// Who spoke.
    pub from: RobotId,
    /// Who was to hear.
    pub to: RobotId,
    /// What became of it in this tick.
    pub fate: Fate,
}

/// What becomes of a message in a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fate {
    /// It was heard, also if it had been under way for a while.
    Heard,
    /// It is under way, and comes in a later tick.
    UnderWay,
    /// It was lost.
    Lost,
    /// It was not lost, but out of reach from the start.
    OutOfReach,
}

/// Names a medium, on the command line and in traces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MediumKind {
    /// Whole maps at once, as in the papers.
    #[default]
    Ideal,
    /// Frames of at most 55 bytes.
    Radio,
}

/// The name used on the command line, for example `radio`.
impl fmt::Display for MediumKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let value = self.to_possible_value().expect("no medium is hidden");
        f.write_str(value.get_name())
    }
}

impl MediumKind {
    /// The medium in a world in which robots speak every `sync` ticks (0: never),
    /// the share `loss` of all messages is lost, and faults are drawn by `seed`.
    pub fn build<const TW: usize, const TH: usize>(
        self,
        sync: u32,
        loss: f64,
        faults: AirFaults,
        seed: u64,
        world: Arc<World>,
    ) -> Box<dyn Medium<TW, TH>> {
        let forger = faults.forger;
        let air = Air::new(faults, loss, seed, world);
        match self {
            Self::Ideal => Box::new(Ideal::new(air, sync)),
            Self::Radio => Box::new(Radio::new(air, sync, forger, seed)),
        }
    }
}

#[cfg(test)]
mod tests;
