//! Traces as files.

use std::io::{self, BufRead, Write};
use std::sync::Arc;

use planner_core::{Cell, Extent, RobotId};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::check::check;
use super::{COLUMNS, NOWHERE, Record, Trace};
use crate::excerpt::excerpt;
use crate::fleet::{
    Arrival, Blind, Closure, Death, Faults, LostPose, Restart, Resume, SensorFailure, Sent,
};
use crate::medium::{AirFaults, MediumKind};
use crate::planners::PlannerKind;
use crate::run::{Scenario, ScenarioError};
use crate::sensor::ALL_AROUND;
use crate::world::{World, WorldError};

const KIND: Kind = Kind {
    format: "host-sim trace",
    version: 2,
    columns: &COLUMNS,
};

/// A trace that cannot be read.
#[derive(Debug, Error)]
pub enum TraceError {
    /// See the message.
    #[error("cannot be read: {0}")]
    Io(#[from] io::Error),
    /// See the message.
    #[error(
        "line 1: expected the JSON header of a trace: {}; is this a trace file?",
        excerpt(&.0.to_string())
    )]
    Header(#[from] serde_json::Error),
    /// See the message.
    #[error(
        "is `{format}` version {version}, this program reads `{}` version {}; \
         run the scenario again to have a trace of that version", .reads.format, .reads.version
    )]
    Format {
        /// What can be read.
        reads: Kind,
        /// What the header says.
        format: String,
        /// What the header says.
        version: u32,
    },
    /// See the message.
    #[error("the header's world: {0}")]
    World(#[from] WorldError),
    /// See the message.
    #[error("the header's world: row {row} has {found} cells, the first has {expected}")]
    Ragged {
        /// Which row, from 1.
        row: usize,
        /// Length of the first row.
        expected: usize,
        /// Length of this one.
        found: usize,
    },
    /// See the message.
    #[error("the header's scenario: {0}")]
    Scenario(#[from] ScenarioError),
    /// See the message.
    #[error("the header's survey: {0}; it was edited or damaged")]
    Survey(String),
    /// See the message.
    #[error("line {line}: expected {expected}, found \"{found}\"")]
    Line {
        /// Which line, from 1.
        line: usize,
        /// What should be there.
        expected: String,
        /// What is there.
        found: String,
    },
    /// See the message.
    #[error(
        "has {found} records, its header says {expected}; it was cut off or edited: \
         copy it again from where it was written"
    )]
    Records {
        /// By the header.
        expected: usize,
        /// In the file.
        found: usize,
    },
    /// See the message.
    #[error(
        "has digest {found}, its header says {expected}; it was edited or damaged: \
         copy it again from where it was written"
    )]
    Digest {
        /// By the header.
        expected: String,
        /// Of the records.
        found: String,
    },
}

/// What traces of one kind have in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kind {
    /// What the header says.
    pub format: &'static str,
    /// What the header says.
    pub version: u32,
    /// The columns of a record.
    pub columns: &'static [&'static str],
}

/// What every header says of the file itself.
#[derive(Deserialize)]
struct Label {
    format: String,
    version: u32,
    digest: String,
    records: usize,
}

impl Kind {
    /// Takes a trace file of this kind apart, and checks that it is whole; `parse` reads
    /// a record.
    pub(crate) fn read<H: DeserializeOwned, R>(
        self,
        from: impl BufRead,
        parse: impl Fn(&str) -> Option<R>,
        digest: impl Fn(&[R]) -> String,
    ) -> Result<(H, Vec<R>), TraceError> {
        let mut lines = from.lines();
        let header = lines.next().transpose()?.unwrap_or_default();
        let label: Label = serde_json::from_str(&header)?;
        if (&*label.format, label.version) != (self.format, self.version) {
            return Err(TraceError::Format {
                reads: self,
                format: excerpt(&label.format),
                version: label.version,
            });
        }
        let header = serde_json::from_str(&header)?;
        let columns = lines.next().transpose()?.unwrap_or_default();
        if columns != self.columns.join(",") {
            return Err(TraceError::Line {
                line: 2,
                expected: format!("the columns {}", self.columns.join(",")),
                found: excerpt(&columns),
            });
        }
        let records = lines
            .zip(3..)
            .map(|(text, line)| {
                let text = text?;
                parse(&text).ok_or_else(|| TraceError::Line {
                    line,
                    expected: format!("{} numbers with commas between", self.columns.len()),
                    found: excerpt(&text),
                })
            })
            .collect::<Result<Vec<_>, _>>()?;
        if records.len() != label.records {
            return Err(TraceError::Records {
                expected: label.records,
                found: records.len(),
            });
        }
        let found = digest(&records);
        if found != label.digest {
            let expected = excerpt(&label.digest);
            return Err(TraceError::Digest { expected, found });
        }
        Ok((header, records))
    }
}

#[derive(Serialize, Deserialize)]
struct Header {
    format: String,
    version: u32,
    digest: String,
    records: usize,
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
    pub fn write(&self, mut to: impl Write) -> io::Result<()> {
        serde_json::to_writer(&mut to, &Header::of(self))?;
        writeln!(to, "\n{}", COLUMNS.join(","))?;
        for record in &self.records {
            let goal = record.goal.unwrap_or(NOWHERE);
            writeln!(
                to,
                "{},{},{},{},{},{},{},{},{},{},{}",
                record.tick,
                record.robot,
                record.at.x,
                record.at.y,
                record.action,
                goal.x,
                goal.y,
                record.known,
                record.work,
                record.sent.frames,
                record.sent.bytes
            )?;
        }
        Ok(())
    }

    /// Reads a trace, and checks that it is whole and that a run can have left it:
    /// pictures need not check again.
    ///
    /// # Errors
    /// What is wrong, and in which line.
    pub fn read(from: impl BufRead) -> Result<Self, TraceError> {
        let (header, records) = KIND.read::<Header, _>(from, parse_record, super::digest)?;
        let scenario = header.scenario()?;
        check(&scenario, &records)?;
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
            format: KIND.format.into(),
            version: KIND.version,
            digest: trace.digest(),
            records: trace.records.len(),
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

fn parse_record(line: &str) -> Option<Record> {
    let mut numbers = line.split(',');
    let mut next = || numbers.next();
    let tick = next()?.parse().ok()?;
    let robot = next()?.parse().ok()?;
    let at = Cell::new(next()?.parse().ok()?, next()?.parse().ok()?);
    let action = next()?.parse().ok()?;
    let goal = Cell::new(next()?.parse().ok()?, next()?.parse().ok()?);
    let known = next()?.parse().ok()?;
    let work = next()?.parse().ok()?;
    let sent = Sent {
        frames: next()?.parse().ok()?,
        bytes: next()?.parse().ok()?,
    };
    next().is_none().then_some(Record {
        tick,
        robot,
        at,
        action,
        goal: (goal != NOWHERE).then_some(goal),
        known,
        work,
        sent,
    })
}
