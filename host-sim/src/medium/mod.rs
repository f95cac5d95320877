//! How robots hear of each other.

mod air;
mod flown;
mod forger;
mod grid;
mod ideal;
mod radio;
mod station;

use std::sync::Arc;

use planner_core::RobotId;

pub(crate) use flown::{any_point, any_voxel, surface_frame, voxel_frame};
pub use ideal::Ideal;
pub use radio::Radio;
pub use station::Space;
pub(crate) use station::{Claim, Station};

use crate::robot::Robot;
use crate::scenario::{Conditions, MediumKind};
use crate::world::World;

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

/// The medium of these conditions, in a world.
pub fn build<const TW: usize, const TH: usize>(
    conditions: &Conditions,
    world: Arc<World>,
) -> Box<dyn Medium<TW, TH>> {
    match conditions.medium {
        MediumKind::Ideal => Box::new(Ideal::new(conditions, world)),
        MediumKind::Radio => Box::new(Radio::new(conditions, world)),
    }
}

#[cfg(test)]
mod tests;
