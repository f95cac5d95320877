//! A run in one JSON object: one head for all worlds, and the rest for each.

mod grid;
pub mod heights;
pub mod voxels;

use planner_core::{Reason, RobotId};
use serde::Serialize;

use crate::record::{Deed, Kind, Record};
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

/// What every summary says of a robot in the air.
#[derive(Clone, Debug, Serialize)]
pub struct Flown {
    /// Length of its way in metres, where the place has metres.
    pub metres: Option<f64>,
    /// Columns or voxels on its own map.
    pub cells_known: u32,
    /// Work of its planner over the run.
    pub work: u64,
    /// Frames sent by radio.
    pub frames_sent: u32,
    /// Their bytes.
    pub bytes_sent: u32,
    /// [`Reason::name`](planner_core::Reason::name) of the stop; `null` if it had not
    /// stopped.
    pub stop: Option<&'static str>,
    /// The reason in words.
    pub stop_reason: Option<String>,
    /// Whether it is where it started, or within a cell of it.
    pub is_home: bool,
    /// Steps of energy left when it had least; below 0 it flew for longer than its energy lasts.
    /// `null`: nothing limits it.
    pub energy_left: Option<i64>,
    /// Whether it lived to the end of the run.
    pub alive: bool,
}

/// Where a robot in the air came to.
struct End {
    metres: Option<f64>,
    stop: Option<(Reason, String)>,
    is_home: bool,
}

impl Flown {
    /// Of a robot with these records, in a run of so many ticks.
    fn new<'a, K: Kind<Deed = Deed> + 'a>(
        robot: RobotId,
        own: impl Iterator<Item = &'a Record<K>> + Clone,
        conditions: &Conditions,
        ticks: u32,
        end: End,
    ) -> Self {
        let deeds = own.clone().map(|record| (record.tick, record.deed));
        let sent = || own.clone().map(|record| record.sent);
        let (stop, stop_reason) = end.stop.map(|(stop, words)| (stop.name(), words)).unzip();
        Self {
            metres: end.metres,
            cells_known: own.clone().last().map_or(0, |record| record.known),
            work: own.clone().map(|record| u64::from(record.work)).sum(),
            frames_sent: sent().map(|sent| sent.frames).sum(),
            bytes_sent: sent().map(|sent| sent.bytes).sum(),
            stop,
            stop_reason,
            is_home: end.is_home,
            energy_left: energy_left(conditions, robot, deeds),
            alive: conditions.faults.is_alive(robot, ticks),
        }
    }
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
