//! How much had been seen over time, as a table and as a curve.

use std::io;

use super::DrawError;
use super::chart::{Axis, Chart, Panel, Point, Series, Style};
use super::picture::title;
use super::replay::Replay;
use super::sheet;
use crate::record::grid::Trace;
use crate::record::heights;
use crate::record::voxels::VoxelTrace;

/// What had been seen in a run.
#[derive(Clone, Debug)]
pub struct Coverage {
    /// What was run.
    pub title: String,
    /// What is counted, for example `reachable cells`.
    pub unit: &'static str,
    /// How many of them there are.
    pub all: u32,
    /// How many had been seen, tick by tick.
    pub seen: Vec<u32>,
}

impl Coverage {
    fn share(&self, seen: u32) -> f64 {
        f64::from(seen) / f64::from(self.all.max(1))
    }

    /// Writes `tick,seen_cells,seen_share` line by line; the share is from 0 to 1.
    ///
    /// # Errors
    /// Those of `to`.
    pub fn write_csv(&self, to: impl io::Write) -> io::Result<()> {
        let mut table = csv::Writer::from_writer(to);
        table.write_record(["tick", "seen_cells", "seen_share"])?;
        for (tick, &seen) in self.seen.iter().enumerate() {
            let share = format!("{:.6}", self.share(seen));
            table.write_record([tick.to_string(), seen.to_string(), share])?;
        }
        table.flush()
    }

    /// Writes the curve as PNG.
    ///
    /// # Errors
    /// Those of `to`.
    pub fn write_png(&self, to: impl io::Write) -> Result<(), DrawError> {
        let point =
            |(tick, &seen): (usize, &u32)| Point::certain(tick as f64, 100.0 * self.share(seen));
        let chart = Chart {
            title: self.title.clone(),
            panels: vec![Panel {
                title: String::new(),
                x: Axis::Numbers("time (ticks)".into()),
                y: format!("{} seen (%)", self.unit),
                series: vec![Series {
                    name: "seen by anybody".into(),
                    color: 0,
                    style: Style::Curve,
                    points: self.seen.iter().enumerate().map(point).collect(),
                }],
            }],
        };
        chart.write_png(to)
    }
}

impl From<&Trace> for Coverage {
    fn from(trace: &Trace) -> Self {
        let mut replay = Replay::new(trace);
        let mut seen = Vec::new();
        while replay.tick() {
            seen.push(replay.seen_cells());
        }
        Self {
            title: title(trace),
            unit: "reachable cells",
            all: replay.reachable_cells(),
            seen,
        }
    }
}

impl From<&heights::Trace> for Coverage {
    fn from(trace: &heights::Trace) -> Self {
        Self {
            title: sheet::title(trace),
            unit: "columns",
            all: trace.extent.cells(),
            seen: trace.seen.clone(),
        }
    }
}

impl From<&VoxelTrace> for Coverage {
    fn from(trace: &VoxelTrace) -> Self {
        Self {
            title: sheet::voxel_title(trace),
            unit: "visible voxels",
            all: trace.visible,
            seen: trace.seen.clone(),
        }
    }
}
