//! Traces as files.

use std::io::{self, BufRead, Write};
use std::sync::Arc;

use planner_core::{Cell, Extent, RobotId};
use serde::{Deserialize, Serialize};

use super::check::Checked;
use super::{Record, Row, Trace};
use crate::fleet::{
    Arrival, Blind, Closure, Death, Faults, LostPose, Restart, Resume, SensorFailure,
};
use crate::medium::{AirFaults, MediumKind};
use crate::planners::PlannerKind;
use crate::record::{self, Format, TraceError};
use crate::run::Scenario;
use crate::sensor::ALL_AROUND;
use crate::world::World;

const FORMAT: Format = Format {
    name: "host-sim trace",
    version: 2,
    oldest: 2,
};

#[derive(Serialize, Deserialize)]
struct Header {
    planner: PlannerKind,
    range: u8,
    /// Absent where sensors look all around.
    #[serde(default = "all_around", skip_serializing_if = "is_all_around")]
    fov: u16,
    medium: MediumKind,
    sync: u32,
    byte_budget: u16,
    loss: f64,
    air: AirFaults,
    seed: u64,
    solid: bool,
    max_ticks: u32,
    starts: Vec<(i16, i16)>,
    /// (robot, tick)
    deaths: Vec<(u8, u32)>,
    /// (robot, tick)
    arrivals: Vec<(u8, u32)>,
    /// (robot, tick)
    restarts: Vec<(u8, u32)>,
    /// (x, y, from, until)
    closures: Vec<(i16, i16, u32, u32)>,
    // Absent where they do not happen: older traces have none of them.
    /// (robot, tick)
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    resumes: Vec<(u8, u32)>,
    /// (x, y, from, until)
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    blind: Vec<(i16, i16, u32, u32)>,
    /// (robot, tick)
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    sensor_failures: Vec<(u8, u32)>,
    /// (robot, from, until)
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    lost_poses: Vec<(u8, u32, u32)>,
    world: WorldRows,
}

fn all_around() -> u16 {
    ALL_AROUND
}

fn is_all_around(fov: &u16) -> bool {
    *fov == ALL_AROUND
}

#[derive(Serialize, Deserialize)]
struct WorldRows {
    name: String,
    rows: Vec<String>,
}

impl Trace {
    /// Writes the trace in the format that this module documents.
    ///
    /// # Errors
    /// Those of `to`.
    pub fn write(&self, to: impl Write) -> io::Result<()> {
        let rows = self.records.iter().map(Record::row);
        record::write(to, FORMAT, &Header::of(self), rows)
    }

    /// Reads a trace, and checks that it is whole and that a run can have left it:
    /// pictures need not check again.
    ///
    /// # Errors
    /// What is wrong, and in which line.
    pub fn read(from: impl BufRead) -> Result<Self, TraceError> {
        let (header, lines) = record::read::<Header, Row>(from, FORMAT)?;
        let scenario = header.scenario()?;
        let mut checked = Checked::new(&scenario);
        let records = lines.records(|row| checked.take(row))?;
        Ok(Self { scenario, records })
    }
}

impl Header {
    fn of(trace: &Trace) -> Self {
        let scenario = &trace.scenario;
        let faults = &scenario.faults;
        let closure = |closure: &Closure| {
            let Cell { x, y } = closure.cell;
            (x, y, closure.from, closure.until)
        };
        Self {
            planner: scenario.planner,
            range: scenario.range,
            fov: scenario.fov,
            medium: scenario.medium,
            sync: scenario.sync,
            byte_budget: scenario.byte_budget,
            loss: scenario.loss,
            air: scenario.air.clone(),
            seed: scenario.seed,
            solid: scenario.solid,
            max_ticks: scenario.max_ticks,
            starts: scenario
                .starts
                .iter()
                .map(|cell| (cell.x, cell.y))
                .collect(),
            deaths: faults
                .deaths
                .iter()
                .map(|death| (death.robot.0, death.tick))
                .collect(),
            arrivals: faults
                .arrivals
                .iter()
                .map(|arrival| (arrival.robot.0, arrival.tick))
                .collect(),
            restarts: faults
                .restarts
                .iter()
                .map(|restart| (restart.robot.0, restart.tick))
                .collect(),
            closures: faults.closures.iter().map(closure).collect(),
            resumes: (faults.resumes.iter())
                .map(|resume| (resume.robot.0, resume.tick))
                .collect(),
            blind: (faults.blind.iter())
                .map(|blind| (blind.cell.x, blind.cell.y, blind.from, blind.until))
                .collect(),
            sensor_failures: (faults.sensor_failures.iter())
                .map(|failure| (failure.robot.0, failure.tick))
                .collect(),
            lost_poses: (faults.lost_poses.iter())
                .map(|lost| (lost.robot.0, lost.from, lost.until))
                .collect(),
            world: WorldRows::of(&scenario.world),
        }
    }

    fn scenario(self) -> Result<Scenario, TraceError> {
        let death = |(robot, tick)| Death {
            robot: RobotId(robot),
            tick,
        };
        let arrival = |(robot, tick)| Arrival {
            robot: RobotId(robot),
            tick,
        };
        let restart = |(robot, tick)| Restart {
            robot: RobotId(robot),
            tick,
        };
        let closure = |(x, y, from, until)| Closure {
            cell: Cell::new(x, y),
            from,
            until,
        };
        let resume = |(robot, tick)| Resume {
            robot: RobotId(robot),
            tick,
        };
        let blind = |(x, y, from, until)| Blind {
            cell: Cell::new(x, y),
            from,
            until,
        };
        let sensor_failure = |(robot, tick)| SensorFailure {
            robot: RobotId(robot),
            tick,
        };
        let lost_pose = |(robot, from, until)| LostPose {
            robot: RobotId(robot),
            from,
            until,
        };
        let scenario = Scenario {
            world: Arc::new(self.world.world()?),
            starts: self
                .starts
                .into_iter()
                .map(|(x, y)| Cell::new(x, y))
                .collect(),
            planner: self.planner,
            range: self.range,
            fov: self.fov,
            medium: self.medium,
            sync: self.sync,
            byte_budget: self.byte_budget,
            loss: self.loss,
            air: self.air,
            key: None,
            seed: self.seed,
            solid: self.solid,
            max_ticks: self.max_ticks,
            faults: Faults {
                deaths: self.deaths.into_iter().map(death).collect(),
                arrivals: self.arrivals.into_iter().map(arrival).collect(),
                restarts: self.restarts.into_iter().map(restart).collect(),
                closures: self.closures.into_iter().map(closure).collect(),
                resumes: self.resumes.into_iter().map(resume).collect(),
                blind: self.blind.into_iter().map(blind).collect(),
                sensor_failures: (self.sensor_failures.into_iter())
                    .map(sensor_failure)
                    .collect(),
                lost_poses: self.lost_poses.into_iter().map(lost_pose).collect(),
            },
        };
        scenario.check()?;
        Ok(scenario)
    }
}

impl WorldRows {
    fn of(world: &World) -> Self {
        let Extent { width, height } = world.extent();
        let sign = |x, y| match world.is_free(Cell::new(x, y)) {
            true => '.',
            false => '#',
        };
        Self {
            name: world.name().into(),
            rows: (0..height as i16)
                .map(|y| (0..width as i16).map(|x| sign(x, y)).collect())
                .collect(),
        }
    }

    fn world(self) -> Result<World, TraceError> {
        let width = self.rows.first().map_or(0, String::len);
        for (row, text) in self.rows.iter().zip(1..).map(|(text, row)| (row, text)) {
            if text.len() != width {
                return Err(TraceError::Ragged {
                    row,
                    expected: width,
                    found: text.len(),
                });
            }
        }
        let side = |length| u16::try_from(length).unwrap_or(u16::MAX);
        let extent = Extent::new(side(width), side(self.rows.len()));
        let blocked = |cell: Cell| self.rows[cell.y as usize].as_bytes()[cell.x as usize] != b'.';
        Ok(World::from_fn(&self.name, extent, blocked)?)
    }
}
