//! A survey in one JSON object.

use planner_core::surface::Height;
use planner_core::{Point, RobotId, Stop};
use serde::Serialize;

use super::{End, Flown, Head};
use crate::record::Deed;
use crate::record::heights::{Safety, Trace};
use crate::scenario::heights::Planner;

/// What a survey came to; the keys are those of `explore` where they mean the same.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// What every summary says; a place is a column.
    #[serde(flatten)]
    pub head: Head,
    /// Steps until 95 % of all columns had been seen.
    pub ticks_to_95: Option<u32>,
    /// Steps until 99 % of them had been.
    pub ticks_to_99: Option<u32>,
    /// Mean work of a planner in a step.
    pub mean_work_per_tick: f64,
    /// Length of all ways, in cells.
    pub distance: f64,
    /// Whatever should never happen; anything but 0 is a bug of the planner.
    pub violations: u32,
    /// The same by kind.
    pub safety: Safety,
    /// Steps that the wind ended on the ground or too near to another robot.
    pub contacts: u32,
    /// How the robots decided.
    pub planner: Planner,
    /// Sensor range in cells.
    pub range: f32,
    /// Longest flight in a step, in cells.
    pub step: f32,
    /// Radius of the robots, in columns.
    pub clearance: u8,
    /// The steepest slope that wide robots see all of, rise a column.
    pub slope: Option<f32>,
    /// Side of a column in metres, where the terrain says so.
    pub cell_size: Option<f64>,
    /// How fast robots fly, in metres a second, if that was said.
    pub speed: Option<f64>,
    /// How long the run took at that speed, each step as long as the longest flight that it may
    /// have.
    pub seconds: Option<f64>,
    /// Share of steps slept through, 0 to 1.
    pub skip: f64,
    /// Robot by robot.
    pub robots: Vec<RobotSummary>,
}

/// What one robot came to.
#[derive(Clone, Debug, Serialize)]
pub struct RobotSummary {
    /// Where it started, in cells.
    pub start: (f32, f32, f32),
    /// Flights.
    pub steps: u32,
    /// Flights that were refused for another robot's sake.
    pub blocked_steps: u32,
    /// Length of its way, in cells.
    pub distance: f64,
    /// Its reward over the run [Renzaglia2019 eq. 1].
    pub reward: f64,
    /// What every summary says of a robot in the air.
    #[serde(flatten)]
    pub flown: Flown,
}

impl Summary {
    /// The summary of a run.
    pub fn new(trace: &Trace) -> Self {
        let work = || trace.records.iter().map(|record| record.work);
        let robots: Vec<_> = (0..trace.robots)
            .map(|robot| RobotSummary::new(trace, robot))
            .collect();
        let scenario = &trace.scenario;
        let violations = trace.safety.violations();
        Self {
            head: Head {
                complete: trace.complete() && violations == 0,
                ticks_to_seen: trace.ticks_to(1.0),
                ticks_to_stopped: trace.ticks_to_stopped(),
                ticks: trace.seen.len() as u32 - 1,
                reachable_cells: trace.extent.cells(),
                seen_cells: trace.seen.last().copied().unwrap_or(0),
                max_work_per_tick: work().max().unwrap_or(0),
                trace_digest: trace.digest(),
                map: trace.terrain.name().into(),
                keyed: scenario.conditions.key.is_some(),
                conditions: scenario.conditions.clone(),
            },
            ticks_to_95: trace.ticks_to(0.95),
            ticks_to_99: trace.ticks_to(0.99),
            mean_work_per_tick: work().map(f64::from).sum::<f64>()
                / trace.records.len().max(1) as f64,
            distance: robots.iter().map(|robot| robot.distance).sum(),
            violations,
            safety: trace.safety,
            contacts: trace.contacts,
            planner: scenario.planner,
            range: scenario.limits.range,
            step: scenario.limits.step,
            clearance: scenario.limits.clearance,
            slope: scenario.slope(),
            cell_size: trace.terrain.scale().map(|scale| scale.cell),
            speed: None,
            seconds: None,
            skip: scenario.skip,
            robots,
        }
    }

    /// The same with the seconds that steps take at `speed`, in metres a second.
    pub fn at_speed(self, speed: Option<f64>) -> Self {
        let step = self.cell_size.zip(speed);
        let step = step.map(|(cell, speed)| f64::from(self.step) * cell / speed);
        Self {
            speed,
            seconds: step.map(|seconds| seconds * f64::from(self.head.ticks)),
            ..self
        }
    }
}

impl RobotSummary {
    fn new(trace: &Trace, robot: usize) -> Self {
        let count = |deed| trace.of(robot).filter(|r| r.deed == deed).count() as u32;
        let way = trace.way(robot, u32::MAX);
        let legs = way.windows(2).map(|leg| f64::from(leg[0].distance(leg[1])));
        let distance = legs.sum();
        let start = trace.starts[robot];
        let end = End {
            metres: trace.terrain.scale().map(|scale| distance * scale.cell),
            stop: trace.stops[robot].map(|stop| (stop.reason(), reason(trace, stop))),
            is_home: way.last().is_none_or(|at| at.distance(start) <= 1.0),
        };
        let ticks = trace.seen.len() as u32 - 1;
        let conditions = &trace.scenario.conditions;
        let id = RobotId(robot as u8);
        Self {
            start: (start.x, start.y, start.z),
            steps: count(Deed::Flew),
            blocked_steps: count(Deed::Refused),
            distance,
            reward: trace.of(robot).map(|record| f64::from(record.gain)).sum(),
            flown: Flown::new(id, trace.of(robot), conditions, ticks, end),
        }
    }
}

/// The reason of a stop in words; with the ceiling, where that keeps the ground from being seen.
fn reason(trace: &Trace, stop: Stop) -> String {
    let ceiling = trace.scenario.limits.ceiling;
    let ground = |at| trace.terrain.height(at).map(Height::cells);
    let (Stop::Unseen { at, .. } | Stop::Held { at, .. }) = stop else {
        return stop.to_string();
    };
    let Some(ground) = ground(at).filter(|&ground| ground > ceiling) else {
        return stop.to_string();
    };
    let metres = trace.terrain.scale().map_or(String::new(), |scale| {
        let [x, y, z] = scale.metres(Point::over(at, ground));
        format!(" ({x:.1},{y:.1},{z:.1} in metres)")
    });
    format!("{stop}; the ground there{metres} is {ground} cells high, above --ceiling {ceiling}")
}
