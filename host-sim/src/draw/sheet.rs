//! Pictures of surveys on a sheet: beneath each what was flown, how long a metre is and which way
//! is which, and what the colours mean.

use std::io;

use image::{Rgb, RgbImage, imageops};
use planner_core::volume::Voxel;
use plotters::prelude::*;

use super::compass::{Drawn, Sides};
use super::legend::{self, Area, LINE, Legend, MARGIN, write, write_lines};
use super::oblique::{self, rooms};
use super::paint::{
    DARK, Ground, INK, ROBOT_COLORS, WAY_COLORS, pale, robot_color, shade, way_color,
};
use super::plan::{DEPTHS, plan};
use super::top::top;
use super::{DrawError, write_png};
use crate::record::heights::Trace;
use crate::record::voxels::VoxelTrace;
use crate::scene::Frame;

/// Least width, so that the words have room.
const LEAST_WIDTH: u32 = 720;
/// Length of the arms of the scale in pixels, at most.
const ARM: f32 = 64.0;

/// Writes [`top_view`](super::top_view) of a whole survey as PNG, on a sheet.
///
/// # Errors
/// Those of `to`.
pub fn top_sheet(trace: &Trace, to: impl io::Write) -> Result<(), DrawError> {
    Sheet::of_heights(trace, top(trace, u32::MAX)).write(to)
}

/// The same of [`oblique_view`](super::oblique_view).
///
/// # Errors
/// Those of `to`.
pub fn oblique_sheet(trace: &Trace, to: impl io::Write) -> Result<(), DrawError> {
    Sheet::of_heights(trace, oblique::heights(trace, u32::MAX)).write(to)
}

/// Writes the floor plan of a whole survey among voxels as PNG, on a sheet: what is at the level
/// `cut` and beneath it. Without a level it is that at which most is free under a ceiling; if nothing
/// is, that of the first start.
///
/// # Errors
/// Those of `to`.
pub fn plan_sheet(
    trace: &VoxelTrace,
    cut: Option<i16>,
    to: impl io::Write,
) -> Result<(), DrawError> {
    let start = || trace.start().map_or(0, |start| start.z);
    let level = cut.or_else(|| rooms(trace)).unwrap_or_else(start);
    let [near, deep] = DEPTHS.map(color);
    let mut sheet = Sheet::of_voxels(trace, plan(trace, level), Some(level));
    sheet.explain("cut through", Sign::Plain(Ground::Obstacle.color()));
    sheet.explain("free, light if deep beneath", Sign::Shades(near, deep));
    sheet.explain(Ground::Unknown.name(), Sign::Plain(Ground::Unknown.color()));
    sheet.explain_ways(trace.ways.len(), ROBOT_COLORS, robot_color);
    let higher = color(pale(robot_color(0)));
    sheet.explain("flown higher", Sign::Plain(higher));
    sheet.write(to)
}

/// The same of [`oblique_voxels`](super::oblique_voxels).
///
/// # Errors
/// Those of `to`.
pub fn oblique_voxels_sheet(
    trace: &VoxelTrace,
    cut: Option<i16>,
    to: impl io::Write,
) -> Result<(), DrawError> {
    let drawn = oblique::voxels(trace, u32::MAX, cut);
    let mut sheet = Sheet::of_voxels(trace, drawn, cut);
    let [low, high] = [0.0, 1.0].map(|share| color(shade(share, 1.0)));
    sheet.explain("occupied, light if high", Sign::Shades(low, high));
    sheet.explain("free or not known", Sign::Plain(color(DARK)));
    sheet.explain_ways(trace.ways.len(), WAY_COLORS, |robot| {
        color(way_color(robot))
    });
    sheet.write(to)
}

/// What a sign of the legend looks like.
enum Sign {
    Plain(RGBColor),
    Shades(RGBColor, RGBColor),
    Start,
    End,
}

impl Sign {
    /// Draws the sign from `x` on, around the height `middle`.
    fn draw(&self, area: &Area<'_>, (x, middle): (i32, i32)) -> Result<(), DrawError> {
        match *self {
            Self::Plain(color) => legend::square(area, (x, middle), color),
            Self::Shades(from, to) => {
                legend::square(area, (x, middle), from)?;
                let half = [(x + 7, middle - 5), (x + 14, middle + 7)];
                Ok(area.draw(&Rectangle::new(half, to.filled()))?)
            }
            Self::Start => legend::start(area, (x + 7, middle), 5, INK),
            Self::End => legend::end(area, (x + 7, middle), 5, INK),
        }
    }
}

/// A picture with what is said of it.
struct Sheet {
    drawn: Drawn,
    /// What leads to the east, to the north and up.
    axes: [&'static str; 3],
    /// Side of a cell in metres.
    cell: Option<f64>,
    /// What cells are called.
    cells: &'static str,
    lines: Vec<String>,
    keys: Vec<(String, Sign)>,
}

impl Sheet {
    fn of_heights(trace: &Trace, drawn: Drawn) -> Self {
        let scale = trace.terrain.scale();
        let (seen, steps) = (trace.seen.last().unwrap_or(&0), trace.seen.len());
        let mut sheet = Self {
            drawn,
            axes: ["E", "N", "up"],
            cell: scale.map(|scale| scale.cell),
            cells: "columns",
            lines: vec![
                title(trace),
                format!(
                    "{seen} of {} columns seen after {} steps",
                    trace.extent.cells(),
                    steps.saturating_sub(1)
                ),
            ],
            keys: Vec::new(),
        };
        let highest = trace.terrain.highest().cells();
        let ground = format!("ground, 0 to {} high", sheet.length(f64::from(highest)));
        let [low, high] = [0.0, highest].map(|at| color(shade(at, highest)));
        sheet.explain(&ground, Sign::Shades(low, high));
        sheet.explain("not known", Sign::Plain(color(DARK)));
        sheet.explain_ways(trace.robots, WAY_COLORS, |robot| color(way_color(robot)));
        sheet
    }

    fn of_voxels(trace: &VoxelTrace, drawn: Drawn, cut: Option<i16>) -> Self {
        let (scene, extent) = (&trace.scene, trace.scene.extent());
        let (seen, steps) = (trace.seen.last().unwrap_or(&0), trace.seen.len());
        let frame = scene.frame().unwrap_or(Frame::PLAIN);
        let beyond = [extent.width, extent.height].map(|side| side as i16);
        let low = frame.middle(Voxel::new(0, 0, 0));
        let high = frame.middle(Voxel::new(beyond[0], beyond[1], 0));
        let half = frame.voxel_size / 2.0;
        let range = |axis: usize| format!("{:.1} to {:.1}", low[axis] - half, high[axis] - half);
        let mut place = format!("x {}, y {}", range(0), range(1));
        if let Some(cut) = cut {
            let z = frame.middle(Voxel::new(0, 0, cut))[2];
            place += &format!(", cut at z = {z:.2}");
        }
        if scene.frame().is_some() {
            place += " m";
        }
        Self {
            drawn,
            axes: ["x", "y", "z"],
            cell: scene.frame().map(|frame| frame.voxel_size),
            cells: "voxels",
            lines: vec![
                voxel_title(trace),
                format!(
                    "{seen} of {} visible voxels seen after {} steps",
                    trace.visible,
                    steps.saturating_sub(1)
                ),
                place,
            ],
            keys: Vec::new(),
        }
    }

    /// So many cells in words, in metres if they have any.
    fn length(&self, cells: f64) -> String {
        match self.cell {
            Some(metres) => format!("{} m", short(cells * metres)),
            None => format!("{} {}", short(cells), self.cells),
        }
    }

    fn explain(&mut self, words: &str, sign: Sign) {
        self.keys.push((words.into(), sign));
    }

    /// The signs of ways whose colours come again after `colors` robots.
    fn explain_ways(&mut self, robots: usize, colors: usize, color: impl Fn(usize) -> RGBColor) {
        self.explain("start", Sign::Start);
        self.explain("end", Sign::End);
        for (words, robot) in legend::robots(robots, colors) {
            self.explain(&words, Sign::Plain(color(robot)));
        }
    }

    fn write(mut self, to: impl io::Write) -> Result<(), DrawError> {
        let arm = Arm::of(self.drawn.sides, self.cell);
        let unit = self.length(arm.cells);
        self.lines.push(format!("each arm of the scale: {unit}"));
        let (above, below) = arm.reach();
        let (map_width, map_height) = self.drawn.image.dimensions();
        let width = LEAST_WIDTH.max(map_width + 2 * MARGIN as u32);
        let bottom = MARGIN + map_height as i32;
        let words = LINE * self.lines.len() as i32;
        let strip = words.max(above + below + LINE);
        let legend = Legend::of(self.keys, width);
        let height = bottom + MARGIN + strip + MARGIN / 2 + LINE * legend.rows() + MARGIN / 2;
        let size = (width, height as u32);
        let mut sheet = RgbImage::from_pixel(size.0, size.1, Rgb([255; 3]));
        let left = i64::from((width - map_width) / 2);
        imageops::replace(&mut sheet, &self.drawn.image, left, MARGIN.into());
        {
            let area = BitMapBackend::with_buffer(&mut sheet, size).into_drawing_area();
            let (left, right) = (left as i32 - 1, left as i32 + map_width as i32);
            let outline = [(left, MARGIN - 1), (right, bottom)];
            area.draw(&Rectangle::new(outline, INK.stroke_width(1)))?;
            let y = bottom + MARGIN;
            arm.draw(&area, (2 * MARGIN, y + above + LINE / 2), self.axes)?;
            let beside = 5 * MARGIN + ARM as i32;
            write_lines(&area, (beside, y), &self.lines)?;
            legend.draw(&area, y + strip + MARGIN / 2, Sign::draw)?;
            area.present()?;
        }
        write_png(&sheet, to)
    }
}

/// The scale: an arm of so many cells along each axis.
struct Arm {
    cells: f64,
    /// In pixels.
    ends: [Option<(f32, f32)>; 3],
}

impl Arm {
    /// As long as there is room for, of 1, 2 or 5 metres, tens or tenths of them.
    fn of(sides: Sides, cell: Option<f64>) -> Self {
        let cell = cell.unwrap_or(1.0);
        let most = f64::from(ARM / sides.east.0) * cell;
        let decade = 10_f64.powf(most.log10().floor());
        let rounds = [5.0, 2.0, 1.0].map(|round| round * decade);
        let length = rounds.into_iter().find(|round| *round <= most);
        let cells = length.unwrap_or(most) / cell;
        let long = |(x, y): (f32, f32)| (x * cells as f32, y * cells as f32);
        let sides = [Some(sides.east), Some(sides.north), sides.up];
        Self {
            cells,
            ends: sides.map(|side| side.map(long)),
        }
    }

    /// Pixels that it takes above and below its corner.
    fn reach(&self) -> (i32, i32) {
        let ends = self.ends.iter().flatten().map(|end| end.1 as i32);
        ends.fold((0, 0), |(above, below), y| (above.max(-y), below.max(y)))
    }

    fn draw(&self, area: &Area<'_>, corner: (i32, i32), names: [&str; 3]) -> Result<(), DrawError> {
        for (end, name) in self.ends.iter().zip(names) {
            let Some((dx, dy)) = *end else { continue };
            let end = (corner.0 + dx as i32, corner.1 + dy as i32);
            area.draw(&PathElement::new([corner, end], INK.stroke_width(3)))?;
            // The name's middle lies a little beyond the end.
            let length = dx.hypot(dy).max(1.0);
            let beyond = (
                end.0 + (dx / length * 12.0) as i32,
                end.1 + (dy / length * 12.0) as i32,
            );
            let half = name.len() as i32 * 5;
            write(area, (beyond.0 - half, beyond.1 - 8), name)?;
        }
        Ok(())
    }
}

/// A survey over heights in a line.
pub(super) fn title(trace: &Trace) -> String {
    let (name, planner) = (trace.terrain.name(), trace.scenario.planner);
    format!("{name}: {} robots, {planner}", trace.robots)
}

/// The same among voxels.
pub(super) fn voxel_title(trace: &VoxelTrace) -> String {
    let (name, planner) = (trace.scene.name(), trace.scenario.planner);
    format!("{name}: {} robots, {planner}", trace.ways.len())
}

/// A length with at most two decimals.
fn short(length: f64) -> String {
    let text = format!("{length:.2}");
    text.trim_end_matches('0').trim_end_matches('.').into()
}

fn color(Rgb([red, green, blue]): Rgb<u8>) -> RGBColor {
    RGBColor(red, green, blue)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_arm_is_a_round_length_that_fits() {
        for (pixels, cell, metres) in [
            (6, 1.0, 10.0),
            (6, 0.25, 2.0),
            (22, 0.07, 0.2),
            (2, 30.0, 500.0),
            (12, 0.3, 1.0),
        ] {
            let arm = Arm::of(Sides::from_above(pixels), Some(cell));
            assert!((arm.cells * cell - metres).abs() < 1e-9, "{}", arm.cells);
            let (above, below) = arm.reach();
            assert!(above <= ARM as i32 && above > ARM as i32 / 3 && below == 0);
        }
    }
}
