//! A run in one JSON object: one head for all worlds, and the rest for each.

mod grid;
pub mod heights;
pub mod voxels;

use planner_core::RobotId;
use serde::Serialize;

use crate::record::Deed;
use crate::scenario::{Conditions, Faults};

pub use grid::{BodySummary, MotionSummary, RobotSummary, Summary};

/// What every summary says of a run, in any kind of world.
#[derive(Clone, Debug, Serialize)]
pub struct Head {
    /// Whether everything that can be seen was seen by somebody, without a violation.
    pub complete: bool,
    /// Ticks until it was.
    pub ticks_to_seen: Option<u32>,
    /// Ticks until every living robot had stopped.
    pub ticks_to_stopped: Option<u32>,
    /// Ticks that were run.
    pub ticks: u32,
    /// Places to see: free cells that can be reached from any start; columns; occupied
    /// voxels that can be seen.
    pub reachable_cells: u32,
    /// Those that somebody has seen.
    pub seen_cells: u32,
    /// Largest work of one planner in one tick.
    pub max_work_per_tick: u32,
    /// Digest of the trace.
    pub trace_digest: String,
    /// Name of the world.
    pub map: String,
    /// Whether frames were signed.
    pub keyed: bool,
    /// What the fleet worked under.
    #[serde(flatten)]
    pub conditions: Conditions,
}

/// The steps of energy that `robot`, which did `deeds`, had left when it had least: below 0 it
/// was in the air for longer than its energy lasts. `None`: nothing limits its energy.
fn energy_left(
    conditions: &Conditions,
    robot: RobotId,
    deeds: impl Iterator<Item = (u32, Deed)>,
) -> Option<i64> {
    let energy = Some(i64::from(conditions.mission.energy)).filter(|&energy| energy > 0)?;
    let (mut left, mut least) = (energy, energy);
    for (tick, deed) in deeds {
        if Faults::befalls(&conditions.faults.resumes, robot, tick) {
            left = energy;
        }
        left -= i64::from(!matches!(deed, Deed::Stopped(_)));
        least = least.min(left);
    }
    Some(least)
}

#[cfg(test)]
mod tests {
    use planner_core::Reason;

    use super::*;
    use crate::scenario::Event;

    #[test]
    fn energy_is_spent_in_the_air_and_is_as_much_again_after_a_rest() {
        let mut conditions = Conditions::flown(0);
        let robot = RobotId(1);
        let home = Deed::Stopped(Reason::Home);
        let deeds = [Deed::Flew, Deed::Hovered, home, Deed::Refused, Deed::Flew];
        let left = |conditions: &Conditions| energy_left(conditions, robot, (0..).zip(deeds));
        assert_eq!(left(&conditions), None);
        conditions.mission.energy = 3;
        assert_eq!(left(&conditions), Some(-1));
        conditions.faults.resumes = vec![Event { robot, tick: 3 }];
        assert_eq!(left(&conditions), Some(1));
    }
}
