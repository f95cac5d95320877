//! Coverage over time, as a table and as a curve.

use std::io;

use plotters::prelude::*;

use super::paint::{INK, robot_color, text};
use super::picture::title;
use super::replay::Replay;
use super::{Canvas, DrawError};
use crate::trace::Trace;

const SIZE: (u32, u32) = (960, 540);

/// Share of the reachable cells that somebody has seen, 0 to 1.
fn share(replay: &Replay<'_>) -> f64 {
    f64::from(replay.seen_cells()) / f64::from(replay.reachable_cells().max(1))
}

/// Writes `tick,seen_cells,seen_share` line by line; the share is of the
/// reachable cells, 0 to 1.
///
/// # Errors
/// Those of `to`.
pub fn coverage_csv(trace: &Trace, mut to: impl io::Write) -> io::Result<()> {
    writeln!(to, "tick,seen_cells,seen_share")?;
    let mut replay = Replay::new(trace);
    let mut tick = 0;
    while replay.tick() {
        writeln!(to, "{tick},{},{:.6}", replay.seen_cells(), share(&replay))?;
        tick += 1;
    }
    Ok(())
}

/// Writes the curve as PNG.
///
/// # Errors
/// Those of `to`.
pub fn coverage_plot(trace: &Trace, to: impl io::Write) -> Result<(), DrawError> {
    let mut replay = Replay::new(trace);
    let mut points = Vec::new();
    while replay.tick() {
        points.push((points.len() as u32, 100.0 * share(&replay)));
    }
    let title = title(trace);
    // The font is fixed-width, 0.6 of its size a character; a long title shrinks.
    let room = (SIZE.0 - 80) * 10 / 6;
    let size = (room / title.chars().count().max(1) as u32).clamp(9, 18);
    let end = trace.ticks().max(2) - 1;
    let mut canvas = Canvas::new(SIZE.0, SIZE.1);
    {
        let area = BitMapBackend::with_buffer(&mut canvas.pixels, SIZE).into_drawing_area();
        area.fill(&WHITE)?;
        let mut chart = ChartBuilder::on(&area)
            .caption(title, text(size))
            .margin(20)
            .x_label_area_size(52)
            .y_label_area_size(72)
            .build_cartesian_2d(0..end, 0.0..100.0)?;
        chart
            .configure_mesh()
            .x_desc("time (ticks)")
            .y_desc("reachable cells seen (%)")
            .axis_desc_style(text(16))
            .label_style(text(14))
            .axis_style(INK.stroke_width(1))
            .bold_line_style(RGBColor(215, 218, 224).stroke_width(1))
            .light_line_style(TRANSPARENT)
            .y_label_formatter(&|percent| format!("{percent:.0}"))
            .draw()?;
        chart.draw_series(LineSeries::new(points, robot_color(0).stroke_width(2)))?;
        area.present()?;
    }
    canvas.write_png(to)
}
