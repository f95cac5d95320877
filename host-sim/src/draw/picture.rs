//! The final picture: what was seen, and every robot's way.

use std::io;

use image::{Rgb, RgbImage};
use planner_core::Cell;
use plotters::prelude::*;

use super::legend::{self, Area, LINE, Legend, MARGIN, write_lines};
use super::paint::{Ground, INK, ROBOT_COLORS, robot_color};
use super::replay::Replay;
use super::{DrawError, write_png};
use crate::record::grid::Trace;
use crate::scenario::MediumKind;
use crate::world::cells;

/// Sides of the drawn map in pixels, about.
const SIDE: u32 = 1200;
/// Least width, so that the caption has room.
const LEAST_WIDTH: u32 = 720;

/// Writes the final picture of a trace as PNG.
///
/// # Errors
/// Those of `to`.
pub fn picture(trace: &Trace, to: impl io::Write) -> Result<(), DrawError> {
    let mut replay = Replay::new(trace);
    let mut last_news = 0;
    for tick in 0.. {
        let before = replay.seen_cells();
        if !replay.tick() {
            break;
        }
        if replay.seen_cells() > before {
            last_news = tick;
        }
    }
    let frame = Frame::of(trace);
    let legend = legend(trace, &replay, frame.width);
    let lines = caption(trace, &replay, last_news);
    let footer = MARGIN + LINE * (lines.len() as i32 + legend.rows()) + MARGIN / 2;
    let size = (frame.width, frame.bottom() as u32 + footer as u32);
    let mut picture = RgbImage::from_pixel(size.0, size.1, Rgb([255; 3]));
    {
        let area = BitMapBackend::with_buffer(&mut picture, size).into_drawing_area();
        frame.draw_ground(&area, &replay)?;
        frame.draw_ways(&area, trace)?;
        frame.draw_robots(&area, trace, &replay)?;
        let y = write_lines(&area, (MARGIN, frame.bottom() + MARGIN), &lines)?;
        legend.draw(&area, y, Sign::draw)?;
        area.present()?;
    }
    write_png(&picture, to)
}

/// Where the map lies in the picture.
struct Frame {
    width: u32,
    left: i32,
    /// Side of a cell in pixels.
    scale: i32,
    columns: i32,
    rows: i32,
    robots: usize,
}

impl Frame {
    fn of(trace: &Trace) -> Self {
        let extent = trace.scenario.world.extent();
        let longest = u32::from(extent.width.max(extent.height));
        let scale = (SIDE / longest).clamp(2, 24);
        let map = u32::from(extent.width) * scale;
        let width = LEAST_WIDTH.max(map + 2 * MARGIN as u32);
        Self {
            width,
            left: (width - map) as i32 / 2,
            scale: scale as i32,
            columns: extent.width.into(),
            rows: extent.height.into(),
            robots: trace.scenario.starts.len(),
        }
    }

    fn bottom(&self) -> i32 {
        MARGIN + self.rows * self.scale
    }

    fn corner(&self, cell: Cell) -> (i32, i32) {
        (
            self.left + i32::from(cell.x) * self.scale,
            MARGIN + i32::from(cell.y) * self.scale,
        )
    }

    fn middle(&self, cell: Cell) -> (i32, i32) {
        let (x, y) = self.corner(cell);
        (x + self.scale / 2, y + self.scale / 2)
    }

    /// The middle of a cell, a little aside, so that the ways of several robots
    /// through one corridor stay apart.
    fn lane(&self, robot: usize, cell: Cell) -> (i32, i32) {
        let (x, y) = self.middle(cell);
        let lanes = self.robots.min(ROBOT_COLORS) as i32;
        let lane = robot as i32 % lanes;
        let aside = (2 * lane - (lanes - 1)) * self.scale / (3 * lanes);
        (x + aside, y + aside)
    }

    fn draw_ground(&self, area: &Area<'_>, replay: &Replay<'_>) -> Result<(), DrawError> {
        for cell in cells(replay.extent()) {
            let ground = replay.ground(cell);
            let (x, y) = self.corner(cell);
            let (right, bottom) = (x + self.scale, y + self.scale);
            // plotters' rectangles leave out their last row and column.
            area.draw(&Rectangle::new(
                [(x, y), (right, bottom)],
                ground.color().filled(),
            ))?;
            if ground == Ground::Unseen && self.scale >= 6 {
                let cross = RGBColor(170, 30, 60).stroke_width(1);
                let (near, far) = (self.scale / 4, self.scale - self.scale / 4);
                for (from, to) in [((near, near), (far, far)), ((near, far), (far, near))] {
                    let ends = [(x + from.0, y + from.1), (x + to.0, y + to.1)];
                    area.draw(&PathElement::new(ends, cross))?;
                }
            }
        }
        let outline = [
            (self.left - 1, MARGIN - 1),
            (self.left + self.columns * self.scale, self.bottom()),
        ];
        Ok(area.draw(&Rectangle::new(outline, INK.stroke_width(1)))?)
    }

    fn draw_ways(&self, area: &Area<'_>, trace: &Trace) -> Result<(), DrawError> {
        for record in &trace.records {
            let robot = usize::from(record.robot);
            let (from, to) = (
                self.lane(robot, record.at),
                self.lane(robot, record.after()),
            );
            if from != to {
                let before = self.thickness() / 2;
                let after = self.thickness() - before;
                let bar = [
                    (from.0.min(to.0) - before, from.1.min(to.1) - before),
                    (from.0.max(to.0) + after, from.1.max(to.1) + after),
                ];
                area.draw(&Rectangle::new(bar, robot_color(robot).filled()))?;
            }
        }
        Ok(())
    }

    /// Thickness of a way in pixels.
    fn thickness(&self) -> i32 {
        ((self.scale + 1) / 3).clamp(1, 3)
    }

    fn draw_robots(
        &self,
        area: &Area<'_>,
        trace: &Trace,
        replay: &Replay<'_>,
    ) -> Result<(), DrawError> {
        let radius = (self.scale * 2 / 5).clamp(3, 7);
        let clearance = i32::from(trace.scenario.clearance);
        if clearance > 0 {
            let reach = self.scale * (2 * clearance + 1) / 2;
            for (robot, &end) in replay.positions().iter().enumerate() {
                let color = robot_color(robot);
                let body = self.middle(end);
                area.draw(&Circle::new(body, reach, color.mix(0.25).filled()))?;
                area.draw(&Circle::new(body, reach, color.stroke_width(1)))?;
            }
        }
        for (robot, (&start, &end)) in trace
            .scenario
            .starts
            .iter()
            .zip(replay.positions())
            .enumerate()
        {
            legend::start(area, self.lane(robot, start), radius, robot_color(robot))?;
            legend::end(area, self.lane(robot, end), radius, robot_color(robot))?;
        }
        Ok(())
    }
}

/// The scenario in a line.
pub(super) fn title(trace: &Trace) -> String {
    let scenario = &trace.scenario;
    let news = match scenario.conditions.medium {
        MediumKind::Ideal => "maps shared",
        MediumKind::Radio => "frames sent",
    };
    let lost = match 100.0 * scenario.conditions.loss {
        0.0 => String::new(),
        loss => format!(", {loss:.0} % lost"),
    };
    let radio = match scenario.conditions.sync {
        0 => "no radio".into(),
        1 => format!("{news} every tick{lost}"),
        sync => format!("{news} every {sync} ticks{lost}"),
    };
    let trouble = match scenario.conditions.trouble {
        trouble if trouble.is_none() => String::new(),
        trouble => format!(", {trouble}"),
    };
    let body = match scenario.clearance {
        0 => String::new(),
        clearance => format!(", clearance {clearance}"),
    };
    format!(
        "{} ({} cells), {} × {}, range {} cells{body}, {radio}{trouble}",
        scenario.world.name(),
        scenario.world.extent(),
        scenario.starts.len(),
        scenario.planner,
        scenario.range
    )
}

fn caption(trace: &Trace, replay: &Replay<'_>, last_news: u32) -> [String; 2] {
    let (seen, reachable) = (replay.seen_cells(), replay.reachable_cells());
    let ticks = trace.ticks();
    [
        title(trace),
        format!(
            "{seen} of {reachable} reachable cells seen, the last in tick {last_news} of {ticks}"
        ),
    ]
}

enum Sign {
    Ground(Ground),
    Start,
    End,
    Robot(usize),
}

impl Sign {
    /// Draws the sign from `x` on, around the height `middle`.
    fn draw(&self, area: &Area<'_>, (x, middle): (i32, i32)) -> Result<(), DrawError> {
        match *self {
            Self::Ground(ground) => legend::square(area, (x, middle), ground.color()),
            Self::Start => legend::start(area, (x + 7, middle), 5, INK),
            Self::End => legend::end(area, (x + 7, middle), 5, INK),
            Self::Robot(robot) => legend::dash(area, (x, middle), robot_color(robot)),
        }
    }
}

fn legend(trace: &Trace, replay: &Replay<'_>, width: u32) -> Legend<Sign> {
    let is_there =
        |ground: &Ground| cells(replay.extent()).any(|cell| replay.ground(cell) == *ground);
    let grounds = Ground::ALL.into_iter().filter(is_there);
    let mut entries: Vec<(String, Sign)> = grounds
        .map(|ground| (ground.name().into(), Sign::Ground(ground)))
        .collect();
    entries.push(("start".into(), Sign::Start));
    entries.push(("end".into(), Sign::End));
    let robots = trace.scenario.starts.len();
    entries.extend(
        legend::robots(robots, ROBOT_COLORS).map(|(numbers, robot)| (numbers, Sign::Robot(robot))),
    );
    Legend::of(entries, width)
}
