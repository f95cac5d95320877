//! A log of scans, replayed: what the map believes beside the vote of all beams.

use std::io;

use image::{Rgb, RgbImage};
use planner_core::{Cell, Extent};
use plotters::prelude::*;

use super::legend::{self, Area, LINE, Legend, MARGIN, write_lines};
use super::paint::{Ground, disc, line, rgb, square};
use super::{DrawError, write_png};
use crate::scans::{Belief, Replayed, Score, Verdict};
use crate::world::cells;

/// Width of both maps together in pixels, about.
const SIDE: u32 = 1440;
/// Least width, so that the caption has room.
const LEAST_WIDTH: u32 = 900;

const DOUBTFUL: RGBColor = RGBColor(204, 121, 167);
const WAY: RGBColor = RGBColor(0, 158, 115);
/// Open floor that the map calls a wall.
const CLOSED: RGBColor = RGBColor(213, 94, 0);
/// Walls that the map calls free.
const OPENED: RGBColor = RGBColor(86, 180, 233);
/// Cells that some beams hit and more crossed.
const UNCLEAR: RGBColor = RGBColor(150, 154, 162);

/// What a pixel of either map means.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Sign {
    Free,
    Wall,
    Doubtful,
    Unknown,
    Closed,
    Opened,
    Unclear,
    Way,
}

impl Sign {
    const ALL: [Self; 8] = [
        Self::Free,
        Self::Wall,
        Self::Doubtful,
        Self::Unknown,
        Self::Closed,
        Self::Opened,
        Self::Unclear,
        Self::Way,
    ];

    fn color(self) -> RGBColor {
        match self {
            Self::Free => Ground::Free.color(),
            Self::Wall => Ground::Obstacle.color(),
            Self::Doubtful => DOUBTFUL,
            Self::Unknown => Ground::Unknown.color(),
            Self::Closed => CLOSED,
            Self::Opened => OPENED,
            Self::Unclear => UNCLEAR,
            Self::Way => WAY,
        }
    }

    fn label(self) -> &'static str {
        match self {
            Self::Free => "free",
            Self::Wall => "wall",
            Self::Doubtful => "doubtful",
            Self::Unknown => "not known",
            Self::Closed => "open floor taken for wall",
            Self::Opened => "wall taken for free",
            Self::Unclear => "hit by some beams, crossed by more",
            Self::Way => "the robot's way",
        }
    }

    fn believed(belief: Belief, verdict: Verdict) -> Self {
        match (belief, verdict) {
            (Belief::Unknown, _) => Self::Unknown,
            (Belief::Wall, Verdict::Open) => Self::Closed,
            (Belief::Free, Verdict::Wall) => Self::Opened,
            (Belief::Doubtful, _) => Self::Doubtful,
            (Belief::Wall, _) => Self::Wall,
            (Belief::Free, _) => Self::Free,
        }
    }

    fn voted(verdict: Verdict) -> Self {
        match verdict {
            Verdict::Unknown => Self::Unknown,
            Verdict::Open => Self::Free,
            Verdict::Unclear => Self::Unclear,
            Verdict::Wall => Self::Wall,
        }
    }

    fn draw(&self, area: &Area<'_>, at: (i32, i32)) -> Result<(), DrawError> {
        match self {
            Self::Way => legend::dash(area, at, WAY),
            _ => legend::square(area, at, self.color()),
        }
    }
}

/// Writes the map's belief and the vote of all beams, side by side or, if they are wide,
/// one above the other, as PNG.
///
/// # Errors
/// Those of `to`.
pub fn scans(replayed: &Replayed, score: &Score, to: impl io::Write) -> Result<(), DrawError> {
    let part = Part::seen(replayed);
    let (columns, rows) = (part.columns, part.rows);
    let beside = columns <= 2 * rows;
    let across = columns * if beside { 2 } else { 1 };
    let scale = (SIDE / across).clamp(1, 12);
    let margin = MARGIN as u32;
    let (map_width, map_height) = (columns * scale, rows * scale);
    let head = margin + LINE as u32;
    let second = match beside {
        true => (2 * margin + map_width, head),
        false => (margin, head + map_height + head),
    };
    let width = LEAST_WIDTH.max(second.0 + map_width + margin);
    let bottom = (second.1 + map_height) as i32;
    let legend = Legend::of(Sign::ALL.map(|sign| (sign.label().into(), sign)), width);
    let lines = caption(score);
    let footer = MARGIN + LINE * (lines.len() as i32 + legend.rows()) + MARGIN / 2;
    let size = (width, (bottom + footer) as u32);
    let mut picture = RgbImage::from_pixel(size.0, size.1, Rgb([255; 3]));
    let first = (margin, head);
    for (corner, sign) in [
        (first, Sign::believed as fn(Belief, Verdict) -> Sign),
        (second, |_, verdict| Sign::voted(verdict)),
    ] {
        draw_map(&mut picture, corner, scale, replayed, &part, sign);
    }
    {
        let area = BitMapBackend::with_buffer(&mut picture, size).into_drawing_area();
        for (corner, title) in [
            (first, "what the planner's map believes"),
            (second, "the vote of all beams"),
        ] {
            let at = (corner.0 as i32, corner.1 as i32 - LINE + 2);
            legend::write(&area, at, title)?;
        }
        let y = write_lines(&area, (MARGIN, bottom + MARGIN), &lines)?;
        legend.draw(&area, y, Sign::draw)?;
        area.present()?;
    }
    write_png(&picture, to)
}

/// The part of the grid of which anything is known, and a cell around it.
struct Part {
    west: i16,
    north: i16,
    columns: u32,
    rows: u32,
}

impl Part {
    fn seen(replayed: &Replayed) -> Self {
        let is_seen = |at: &Cell| {
            replayed.belief(*at) != Belief::Unknown || replayed.verdict(*at) != Verdict::Unknown
        };
        let (mut low, mut high) = ((i16::MAX, i16::MAX), (i16::MIN, i16::MIN));
        for at in cells(replayed.extent()).filter(is_seen) {
            low = (low.0.min(at.x), low.1.min(at.y));
            high = (high.0.max(at.x), high.1.max(at.y));
        }
        // The robot's own cell is seen.
        Self {
            west: low.0 - 1,
            north: low.1 - 1,
            columns: 3 + (high.0 - low.0) as u32,
            rows: 3 + (high.1 - low.1) as u32,
        }
    }

    fn cells(&self) -> impl Iterator<Item = Cell> {
        let (west, north) = (self.west, self.north);
        cells(Extent::new(self.columns as u16, self.rows as u16))
            .map(move |at| Cell::new(at.x + west, at.y + north))
    }
}

fn draw_map(
    picture: &mut RgbImage,
    corner: (u32, u32),
    scale: u32,
    replayed: &Replayed,
    part: &Part,
    sign: fn(Belief, Verdict) -> Sign,
) {
    let corner = (
        corner.0 as f32 - f32::from(part.west) * scale as f32,
        corner.1 as f32 - f32::from(part.north) * scale as f32,
    );
    for at in part.cells().filter(|at| replayed.extent().contains(*at)) {
        let color = rgb(sign(replayed.belief(at), replayed.verdict(at)).color());
        let (x, y) = (
            f32::from(at.x) * scale as f32,
            f32::from(at.y) * scale as f32,
        );
        square(picture, (corner.0 + x, corner.1 + y), scale, color);
    }
    let pixel = |(x, y): (f64, f64)| {
        let scale = f64::from(scale);
        (corner.0 + (x * scale) as f32, corner.1 + (y * scale) as f32)
    };
    for way in replayed.ways() {
        for leg in way.windows(2) {
            line(
                picture,
                pixel(leg[0]),
                pixel(leg[1]),
                &[(0.0, 0.0)],
                rgb(WAY),
            );
        }
    }
    if let Some(start) = replayed.ways().first().and_then(|way| way.first()) {
        disc(picture, pixel(*start), 0.0..=4.0, rgb(WAY));
    }
}

/// The score in words.
fn caption(score: &Score) -> [String; 2] {
    [
        format!(
            "{}: {} scans, cells of {} m, range {} cells",
            score.log, score.looks, score.cell_size, score.range
        ),
        format!(
            "{:.1} % of {} cells of open floor closed, {:.1} % cut off, {:.1} % of {} walls opened",
            score.closed_percent,
            score.open_floor,
            score.cut_off_percent,
            score.opened_percent,
            score.walls
        ),
    ]
}
