//! A survey of voxels in one JSON object.

use planner_core::RobotId;
use serde::Serialize;

use super::{End, Flown, Head};
use crate::record::voxels::VoxelTrace;
use crate::scenario::voxels::Planner;
use crate::scene::{Free, Sensor};

/// What a survey of voxels came to; the keys are those of the others where they mean the
/// same.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// What every summary says; a place is an occupied voxel that can be seen.
    #[serde(flatten)]
    pub head: Head,
    /// Steps until 95 % of all that can be seen had been.
    pub ticks_to_95: Option<u32>,
    /// Steps until 99 % of it had been.
    pub ticks_to_99: Option<u32>,
    /// Mean work of a planner in a step.
    pub mean_work_per_tick: f64,
    /// Flights that should not have been; anything but 0 is a bug of the planner.
    pub violations: u32,
    /// Steps that the wind ended beside or in something.
    pub contacts: u32,
    /// Robots that say in the end that all that they could see is known, while something is
    /// not known to them.
    pub false_claims: u32,
    /// Steps that ended at an obstacle that a look may have hidden.
    pub bumps: u32,
    /// How the robots decided.
    pub planner: Planner,
    /// Sensor range in voxels.
    pub range: u8,
    /// Voxels that they reach beyond the one of their middle.
    pub clearance: u8,
    /// What of that range their sensors show.
    pub sensor: String,
    /// Side of a voxel in metres, where the scene says so.
    pub voxel_size: Option<f64>,
    /// What counts as free where the file says only what is occupied.
    pub free_space: Option<Free>,
    /// How fast robots fly, in metres a second, if that was said.
    pub speed: Option<f64>,
    /// How long the run took at that speed.
    pub seconds: Option<f64>,
    /// Voxels that the scene itself does not know, beside free ones that were seen.
    pub edge_cells: u32,
    /// Robot by robot.
    pub robots: Vec<RobotSummary>,
}

/// What one robot came to.
#[derive(Clone, Debug, Serialize)]
pub struct RobotSummary {
    /// Where it started.
    pub start: (i16, i16, i16),
    /// Flights.
    pub steps: usize,
    /// Free voxels that are occupied on its own map.
    pub cells_closed: u32,
    /// Occupied voxels that are free on it.
    pub cells_opened: u32,
    /// What every summary says of a robot in the air.
    #[serde(flatten)]
    pub flown: Flown,
}

impl Summary {
    /// The summary of a run.
    pub fn new(trace: &VoxelTrace) -> Self {
        let work = || trace.records.iter().map(|record| record.work);
        let ticks = trace.seen.len() as u32 - 1;
        let scenario = &trace.scenario;
        let robots = (0..scenario.robots).map(|robot| RobotSummary::new(trace, robot));
        Self {
            head: Head {
                complete: trace.complete(),
                ticks_to_seen: trace.ticks_to(1.0),
                ticks_to_stopped: trace.all_stopped.then_some(ticks),
                ticks,
                reachable_cells: trace.visible,
                seen_cells: trace.seen.last().copied().unwrap_or(0),
                max_work_per_tick: work().max().unwrap_or(0),
                trace_digest: trace.digest(),
                map: trace.scene.name().into(),
                keyed: scenario.conditions.key.is_some(),
                conditions: scenario.conditions.clone(),
            },
            ticks_to_95: trace.ticks_to(0.95),
            ticks_to_99: trace.ticks_to(0.99),
            mean_work_per_tick: work().map(f64::from).sum::<f64>() / work().len().max(1) as f64,
            violations: trace.violations,
            contacts: trace.contacts,
            false_claims: trace.false_claims,
            bumps: trace.bumps,
            planner: scenario.planner,
            range: scenario.range,
            clearance: scenario.clearance,
            sensor: Sensor::name_of(scenario.field),
            voxel_size: trace.scene.frame().map(|frame| frame.voxel_size),
            free_space: trace.scene.free(),
            speed: None,
            seconds: None,
            edge_cells: trace.edge(),
            robots: robots.collect(),
        }
    }

    /// The same with the seconds that steps of a voxel take at `speed`, in metres a second.
    pub fn at_speed(self, speed: Option<f64>) -> Self {
        let step = self.voxel_size.zip(speed).map(|(size, speed)| size / speed);
        Self {
            speed,
            seconds: step.map(|seconds| seconds * f64::from(self.head.ticks)),
            ..self
        }
    }
}

impl RobotSummary {
    fn new(trace: &VoxelTrace, robot: usize) -> Self {
        let way = &trace.ways[robot];
        let records = trace.records.iter();
        let own = records.filter(|record| usize::from(record.robot) == robot);
        let ticks = trace.seen.len() as u32 - 1;
        let steps = way.windows(2).filter(|leg| leg[0] != leg[1]).count();
        let wrong = trace.wrong.get(robot).copied().unwrap_or_default();
        let frame = trace.scene.frame();
        let end = End {
            metres: frame.map(|frame| steps as f64 * frame.voxel_size),
            stop: trace.stops[robot].map(|stop| (stop.reason(), stop.to_string())),
            is_home: way[way.len() - 1].distance_squared(way[0]) <= 1,
        };
        let (id, conditions) = (RobotId(robot as u8), &trace.scenario.conditions);
        Self {
            start: (way[0].x, way[0].y, way[0].z),
            steps,
            cells_closed: wrong.closed,
            cells_opened: wrong.opened,
            flown: Flown::new(id, own, conditions, ticks, end),
        }
    }
}
