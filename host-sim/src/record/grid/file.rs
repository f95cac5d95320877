//! Traces as files.

use std::io::{self, BufRead, Write};
use std::sync::Arc;

use planner_core::{Cell, Extent};
use serde::{Deserialize, Serialize};

use super::check::Checked;
use super::{Grid, Trace};
use crate::planners::PlannerKind;
use crate::record::{self, TraceError};
use crate::scenario::grid::Scenario;
use crate::scenario::{Conditions, Motion, Save};
use crate::sensor::ALL_AROUND;
use crate::world::World;

#[derive(Serialize, Deserialize)]
struct Header {
    planner: PlannerKind,
    range: u8,
    /// Absent where sensors look all around.
    #[serde(default = "all_around", skip_serializing_if = "is_all_around")]
    fov: u16,
    solid: bool,
    /// Absent where robots are no wider than a cell.
    #[serde(default, skip_serializing_if = "is_none")]
    clearance: u8,
    /// Absent where robots make a step a tick.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    motion: Option<Motion>,
    /// Absent where robots start without a map.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    restored: Option<Save>,
    starts: Vec<(i16, i16)>,
    #[serde(flatten)]
    conditions: Conditions,
    world: WorldRows,
}

fn all_around() -> u16 {
    ALL_AROUND
}

fn is_all_around(fov: &u16) -> bool {
    *fov == ALL_AROUND
}

fn is_none(clearance: &u8) -> bool {
    *clearance == 0
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
        record::write(to, &Header::of(self), &self.records)
    }

    /// Reads a trace, and checks that it is whole and that a run can have left it:
    /// pictures need not check again.
    ///
    /// # Errors
    /// What is wrong, and in which line.
    pub fn read(from: impl BufRead) -> Result<Self, TraceError> {
        let (_, header, records) = record::read::<Header, Grid>(from)?;
        let scenario = header.scenario()?;
        let mut checked = Checked::new(&scenario);
        record::check(&records, |record| checked.take(record))?;
        Ok(Self { scenario, records })
    }
}

impl Header {
    fn of(trace: &Trace) -> Self {
        let scenario = &trace.scenario;
        Self {
            planner: scenario.planner,
            range: scenario.range,
            fov: scenario.fov,
            solid: scenario.solid,
            clearance: scenario.clearance,
            motion: scenario.motion,
            restored: scenario.restored.as_deref().cloned(),
            starts: scenario
                .starts
                .iter()
                .map(|cell| (cell.x, cell.y))
                .collect(),
            conditions: scenario.conditions.clone(),
            world: WorldRows::of(&scenario.world),
        }
    }

    fn scenario(self) -> Result<Scenario, TraceError> {
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
            solid: self.solid,
            clearance: self.clearance,
            motion: self.motion,
            restored: self.restored.map(Arc::new),
            conditions: self.conditions,
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
