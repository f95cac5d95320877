//! What was seen over time.

use std::io;

use crate::draw::DrawError;
use crate::draw::chart::{Axis, Chart, Panel, Point, Series, Style};
use crate::survey::Trace;

/// Writes the curve of columns seen over time as PNG.
///
/// # Errors
/// Those of `to`.
pub fn coverage_plot(trace: &Trace, to: impl io::Write) -> Result<(), DrawError> {
    let all = f64::from(trace.extent.cells());
    let point = |(tick, &seen): (usize, &u32)| Point {
        x: tick as f64,
        y: 100.0 * f64::from(seen) / all,
        low: f64::NAN,
        high: f64::NAN,
    };
    let planner = trace.scenario.planner;
    let chart = Chart {
        title: format!(
            "{}: {} robots, {planner}",
            trace.terrain.name(),
            trace.robots
        ),
        panels: vec![Panel {
            title: String::new(),
            x: Axis::Numbers("time (ticks)".into()),
            y: "columns seen (%)".into(),
            series: vec![Series {
                name: "seen by anybody".into(),
                color: 0,
                style: Style::Curve,
                points: trace.seen.iter().enumerate().map(point).collect(),
            }],
        }],
    };
    chart.write_png(to)
}
