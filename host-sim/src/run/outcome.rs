//! What happened in a run, in numbers.

use planner_core::Stop;
use planner_core::radio::Hearsay;

use crate::robot::{Driven, Sent, Touches, Violation};

/// What happened in a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Outcome {
    /// Ticks that were run.
    pub ticks: u32,
    /// Moves that anybody could have made when somebody had seen every
    /// reachable cell; `None` if nobody ever did.
    pub ticks_to_seen: Option<u32>,
    /// Moves that anybody could have made when the last living robot had
    /// stopped; `None` if the run ended before.
    pub ticks_to_stopped: Option<u32>,
    /// Free cells that can be reached from any start.
    pub reachable_cells: u32,
    /// Reachable cells that somebody has seen.
    pub seen_cells: u32,
    /// Reachable cells that more than one robot has seen with its own sensor.
    pub shared_cells: u32,
    /// Largest work of one planner in one tick.
    pub max_work_per_tick: u32,
    /// Reachable cells seen by somebody, tick by tick.
    pub coverage: Vec<u32>,
    /// Costs of the ways that were assigned.
    pub assignments: Assignments,
    /// Robot by robot.
    pub robots: Vec<RobotOutcome>,
    /// Steps that ended at a person, a shut door, or an obstacle that a look may have hidden.
    pub bumps: u32,
    /// Moves into obstacles that no look had hidden. Anything but none is a bug of a planner.
    pub violations: Vec<Violation>,
    /// Steps in which bodies would have touched.
    pub touches: Touches,
}

/// What happened to one robot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RobotOutcome {
    /// Cells walked.
    pub steps: u32,
    /// Ticks in which it had not stopped.
    pub active_ticks: u32,
    /// Those of them in which it waited: it neither tried a step nor turned to look.
    pub waited_ticks: u32,
    /// Steps that something stood in the way of.
    pub blocked_steps: u32,
    /// Cells on its own map, obstacles included.
    pub cells_known: u32,
    /// Cells that it could reach and that its own map lacks.
    pub cells_missed: u32,
    /// Those of them that none of the [shut places](planner_core::map::Shut::places) that
    /// the robot names leads to: by its map it can get neither to them nor to any cell
    /// through which they could be reached from such a place.
    pub cells_unnamed: u32,
    /// Cells that it could reach and that are obstacles on its own map.
    pub cells_closed: u32,
    /// Obstacles that are free on its own map.
    pub cells_opened: u32,
    /// Known free cells that its body covers from nowhere.
    pub cells_narrow: u32,
    /// Cells that another living robot's map holds and its own lacks, if it lives.
    pub cells_unheard: u32,
    /// Work of its planner over the run.
    pub work: u64,
    /// What it sent by radio over the run.
    pub sent: Sent,
    /// How far it went, if it moves in metres.
    pub driven: Driven,
    /// Why it stopped; `None` if it did not.
    pub stop: Option<Stop>,
    /// Whether it stands where it started; where bodies exchange roles, where any robot did.
    pub is_home: bool,
    /// Whether it lived to the end of the run.
    pub alive: bool,
    /// Whether what it sees contradicts its map in the end, as far as its planner tells.
    pub is_lost: bool,
    /// What it had from others, and what spoke against them.
    pub hearsay: Hearsay,
}

impl RobotOutcome {
    /// Whether it lives and says in the end that everything that it can reach is known,
    /// while a cell that it could reach, with every door open and nobody about, is not, and
    /// no shut place that it names leads there.
    pub fn claims_falsely(&self) -> bool {
        let says_complete = self.stop.is_some_and(|stop| stop.is_complete());
        self.alive && says_complete && self.cells_unnamed > 0
    }
}

/// The costs of assignments by both criteria of \[Bautin2011\]. The robots that get
/// a way in the same tick make up one assignment; a cost is the length of a way
/// in steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Assignments {
    /// Ticks in which a robot was assigned a way.
    pub count: u32,
    /// Criterion 1, summed over assignments: the sum of costs.
    pub sum: u64,
    /// Criterion 2, summed over assignments: the largest cost.
    pub largest: u64,
}

impl Assignments {
    pub(super) fn add(&mut self, costs: impl Iterator<Item = u32> + Clone) {
        if let Some(largest) = costs.clone().max() {
            self.count += 1;
            self.sum += costs.map(u64::from).sum::<u64>();
            self.largest += u64::from(largest);
        }
    }

    /// Mean of criterion 1; `None` if nothing was assigned.
    pub fn mean_sum(&self) -> Option<f64> {
        (self.count > 0).then(|| self.sum as f64 / f64::from(self.count))
    }

    /// Mean of criterion 2; `None` if nothing was assigned.
    pub fn mean_largest(&self) -> Option<f64> {
        (self.count > 0).then(|| self.largest as f64 / f64::from(self.count))
    }
}

impl Outcome {
    /// Moves that anybody could have made when the share `share` (0 to 1) of
    /// the reachable cells had been seen; `None` if that never was.
    pub fn ticks_to_share(&self, share: f64) -> Option<u32> {
        let enough = share * f64::from(self.reachable_cells);
        let reached = |&seen: &u32| f64::from(seen) >= enough;
        Some(self.coverage.iter().position(reached)? as u32)
    }

    /// Whether every reachable cell was seen by somebody, without a violation or a touch.
    pub fn is_complete(&self) -> bool {
        let is_clean = self.violations.is_empty() && self.touches == Touches::default();
        self.ticks_to_seen.is_some() && is_clean
    }

    /// Whether all living robots know the same cells in the end.
    pub fn maps_agree(&self) -> bool {
        self.robots.iter().all(|robot| robot.cells_unheard == 0)
    }

    /// Robots that claim falsely, see [`RobotOutcome::claims_falsely`].
    pub fn false_claims(&self) -> usize {
        let robots = self.robots.iter();
        robots.filter(|robot| robot.claims_falsely()).count()
    }

    /// Share of the seen cells that more than one robot saw with its own
    /// sensor, 0 to 1.
    pub fn overlap(&self) -> f64 {
        f64::from(self.shared_cells) / f64::from(self.seen_cells.max(1))
    }
}

/// A run as far as it has come.
#[derive(Clone, Copy, Debug)]
pub struct Progress {
    /// Ticks done.
    pub ticks: u32,
    /// Reachable cells that somebody has seen.
    pub seen_cells: u32,
    /// Cells that can be reached.
    pub reachable_cells: u32,
}
