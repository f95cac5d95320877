//! A run in a grid of cells, in one JSON object.

use planner_core::radio::Hearsay;
use serde::Serialize;

use super::Head;
use crate::measured::Measured;
use crate::planners::PlannerKind;
use crate::robot::Touches;
use crate::run::{Outcome, RobotOutcome};
use crate::scenario::grid::Scenario;
use crate::scenario::{Conditions, MediumKind, Motion, Reach};

/// What a run came to, in the field names of the JSON summary.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// What every summary says.
    #[serde(flatten)]
    pub head: Head,
    /// Free cells that cannot be reached.
    pub unreachable_cells: u32,
    /// Share of the seen cells that more than one robot saw with its own
    /// sensor, 0 to 1.
    pub overlap: f64,
    /// Whether all living robots know the same cells in the end.
    pub maps_agree: bool,
    /// Why they do not.
    pub maps_differ_because: Option<&'static str>,
    /// Robots that say in the end that all that they can reach is known, while something
    /// is not.
    pub false_claims: usize,
    /// Steps that ended at a person, a shut door, or an obstacle that a look may have hidden.
    pub bumps: u32,
    /// Moves into obstacles that no look had hidden; anything but 0 is a bug of the planner.
    pub violations: usize,
    /// What decided.
    pub planner: PlannerKind,
    /// Sensor range in cells.
    pub range: u8,
    /// Field of view in degrees.
    pub fov: u16,
    /// Whether a cell held at most one robot.
    pub solid: bool,
    /// What came of their bodies, if they are wider than a cell.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub body: Option<BodySummary>,
    /// What came of bodies that move in metres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub motion: Option<MotionSummary>,
    /// Robot by robot.
    pub robots: Vec<RobotSummary>,
    /// What the planners took, if they ran on chips.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub firmware: Option<Measured>,
}

/// What came of bodies that are wider than a cell.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct BodySummary {
    /// Cells that each reaches beyond the one of its centre.
    pub clearance: u8,
    /// Steps in which they would have touched.
    pub touches: Touches,
    /// Free cells that robots know, at most, and that no body fits into.
    pub narrow_cells: u32,
}

/// What came of bodies that move in metres and seconds.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct MotionSummary {
    /// How they move.
    #[serde(flatten)]
    pub motion: Motion,
    /// Seconds until all was seen.
    pub seconds_to_seen: Option<f64>,
    /// Seconds until every living robot had stopped.
    pub seconds_to_stopped: Option<f64>,
    /// The length of all ways.
    pub metres: f64,
    /// Full turns to either side of all robots.
    pub turns: f64,
    /// How often one ran into something.
    pub touches: Touches,
}

/// What one robot came to.
#[derive(Clone, Debug, Serialize)]
pub struct RobotSummary {
    /// Where it started.
    pub start: (i16, i16),
    /// Cells walked.
    pub steps: u32,
    /// The length of its way, if it moves in metres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub metres: Option<f64>,
    /// The full turns that it made to either side.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub turns: Option<f64>,
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
    /// Those of them that no shut place leads to that it names.
    pub cells_unnamed: u32,
    /// Cells that it could reach and that are obstacles on its own map.
    pub cells_closed: u32,
    /// Obstacles that are free on its own map.
    pub cells_opened: u32,
    /// Cells that another living robot's map holds and its own lacks.
    pub cells_unheard: u32,
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
    /// Whether it says that all that it can reach is known, while something is not.
    pub claims_falsely: bool,
    /// Whether it stands where it started; where bodies exchange roles, where any robot did.
    pub is_home: bool,
    /// Whether it lived to the end of the run.
    pub alive: bool,
    /// Whether what it sees contradicts its map in the end, as far as its planner tells.
    pub is_lost: bool,
    /// What it had from others, and what spoke against them.
    pub hearsay: Hearsay,
}

impl Summary {
    /// The summary of a run and of the digest of its trace.
    pub fn new(scenario: &Scenario, outcome: &Outcome, trace_digest: String) -> Self {
        let free = scenario.world.free_cells().count() as u32;
        Self {
            head: Head {
                complete: outcome.is_complete(),
                ticks_to_seen: outcome.ticks_to_seen,
                ticks_to_stopped: outcome.ticks_to_stopped,
                ticks: outcome.ticks,
                reachable_cells: outcome.reachable_cells,
                seen_cells: outcome.seen_cells,
                max_work_per_tick: outcome.max_work_per_tick,
                trace_digest,
                map: scenario.world.name().into(),
                keyed: scenario.conditions.key.is_some(),
                conditions: scenario.conditions.clone(),
            },
            unreachable_cells: free - outcome.reachable_cells,
            overlap: outcome.overlap(),
            maps_agree: outcome.maps_agree(),
            maps_differ_because: (!outcome.maps_agree())
                .then(|| why_maps_differ(scenario, outcome)),
            false_claims: outcome.false_claims(),
            bumps: outcome.bumps,
            violations: outcome.violations.len(),
            planner: scenario.planner,
            range: scenario.range,
            fov: scenario.fov,
            solid: scenario.solid,
            body: (scenario.clearance > 0).then(|| BodySummary {
                clearance: scenario.clearance,
                touches: outcome.touches,
                narrow_cells: { outcome.robots.iter() }
                    .map(|robot| robot.cells_narrow)
                    .max()
                    .unwrap_or(0),
            }),
            motion: scenario
                .motion
                .map(|motion| MotionSummary::new(motion, outcome)),
            robots: scenario
                .starts
                .iter()
                .zip(&outcome.robots)
                .map(|(start, robot)| {
                    RobotSummary::new((start.x, start.y), robot, scenario.motion.is_some())
                })
                .collect(),
            firmware: None,
        }
    }
}

impl MotionSummary {
    fn new(motion: Motion, outcome: &Outcome) -> Self {
        let seconds = |ticks: u32| f64::from(ticks) * f64::from(motion.tick_ms) / 1e3;
        let sum = |of: fn(&RobotOutcome) -> u32| outcome.robots.iter().map(of).sum::<u32>();
        Self {
            motion,
            seconds_to_seen: outcome.ticks_to_seen.map(seconds),
            seconds_to_stopped: outcome.ticks_to_stopped.map(seconds),
            metres: f64::from(sum(|robot| robot.driven.millimetres)) / 1e3,
            turns: f64::from(sum(|robot| robot.driven.milliturns)) / 1e3,
            touches: Touches {
                walls: sum(|robot| robot.driven.touches.walls),
                bodies: sum(|robot| robot.driven.touches.bodies),
            },
        }
    }
}

impl RobotSummary {
    fn new(start: (i16, i16), robot: &RobotOutcome, in_metres: bool) -> Self {
        let thousandths = |of: u32| in_metres.then_some(f64::from(of) / 1e3);
        Self {
            start,
            steps: robot.steps,
            metres: thousandths(robot.driven.millimetres),
            turns: thousandths(robot.driven.milliturns),
            active_ticks: robot.active_ticks,
            waited_ticks: robot.waited_ticks,
            blocked_steps: robot.blocked_steps,
            cells_known: robot.cells_known,
            cells_missed: robot.cells_missed,
            cells_unnamed: robot.cells_unnamed,
            cells_closed: robot.cells_closed,
            cells_opened: robot.cells_opened,
            cells_unheard: robot.cells_unheard,
            work: robot.work,
            frames_sent: robot.sent.frames,
            bytes_sent: robot.sent.bytes,
            stop: robot.stop.map(|stop| stop.reason().name()),
            stop_reason: robot.stop.map(|stop| stop.to_string()),
            claims_falsely: robot.claims_falsely(),
            is_home: robot.is_home,
            alive: robot.alive,
            is_lost: robot.is_lost,
            hearsay: robot.hearsay,
        }
    }
}

fn why_maps_differ(scenario: &Scenario, outcome: &Outcome) -> &'static str {
    let Conditions { air, faults, .. } = &scenario.conditions;
    if scenario.conditions.sync == 0
        || scenario.conditions.medium == MediumKind::Radio && scenario.conditions.byte_budget == 0
    {
        "the robots never spoke"
    } else if air.reach != Reach::Everywhere || !air.partitions.is_empty() {
        "robots were out of each other's reach when the last one stopped"
    } else if scenario.conditions.loss > 0.0 || air.corruption > 0.0 {
        "messages were lost, and had not been repeated when the last robot stopped"
    } else if outcome.ticks_to_stopped.is_none() {
        "the run ended before every robot had stopped"
    } else if air.delay > 0 || scenario.conditions.sync > 1 {
        "the last messages were still to come when the last robot stopped"
    } else if !faults.deaths.is_empty() || !faults.restarts.is_empty() {
        "a robot had died, or had not been told everything again after its restart"
    } else {
        "what was seen last was still waiting for its turn when the last robot stopped"
    }
}
