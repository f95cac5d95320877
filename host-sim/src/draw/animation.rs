//! The run as an animation.

use std::io;

use gif::{DisposalMethod, Encoder, Frame, Repeat};
use planner_core::{Cell, Extent};
use plotters::style::RGBColor;

use super::DrawError;
use super::paint::{Ground, INK, ROBOT_COLORS, robot_color};
use super::replay::{Replay, cells};
use crate::trace::Trace;

/// Largest side of the map in pixels.
const SIDE: u32 = 512;
/// Largest number of frames, about; of longer runs, ticks are left out.
const FRAMES: u32 = 200;
/// How long a frame is shown, in hundredths of a second.
const DELAY: u16 = 6;
/// The same for the last frame.
const LAST_DELAY: u16 = 200;
/// Height of the bar that shows how much has been seen, in pixels.
const BAR: usize = 6;

const INK_INDEX: u8 = Ground::ALL.len() as u8;
const ROBOT_INDEX: u8 = INK_INDEX + 1;

/// Writes a GIF of the run: what the team has seen, where the robots are, and as
/// a bar at the bottom the share of reachable cells seen.
///
/// # Errors
/// Those of `to`.
pub fn animation(trace: &Trace, to: impl io::Write) -> Result<(), DrawError> {
    let mut replay = Replay::new(trace);
    let mut screen = Screen::new(replay.extent());
    let (width, height) = (screen.width as u16, screen.height() as u16);
    let mut encoder = Encoder::new(to, width, height, &palette())?;
    encoder.set_repeat(Repeat::Infinite)?;
    let every = trace.ticks().div_ceil(FRAMES).max(1);
    let last = trace.ticks().saturating_sub(1);
    let mut tick = 0;
    while replay.tick() {
        if tick % every == 0 || tick == last {
            let delay = if tick == last { LAST_DELAY } else { DELAY };
            if let Some(mut frame) = screen.show(&replay) {
                frame.delay = delay;
                encoder.write_frame(&frame)?;
            }
        }
        tick += 1;
    }
    Ok(())
}

fn palette() -> Vec<u8> {
    let grounds = Ground::ALL.into_iter().map(Ground::color);
    let robots = (0..ROBOT_COLORS).map(robot_color);
    let colors = grounds.chain([INK]).chain(robots);
    colors
        .flat_map(|RGBColor(red, green, blue)| [red, green, blue])
        .collect()
}

/// What is on the screen, as indices into the palette.
struct Screen {
    width: usize,
    scale: usize,
    pixels: Vec<u8>,
    is_blank: bool,
}

impl Screen {
    fn new(extent: Extent) -> Self {
        let longest = u32::from(extent.width.max(extent.height));
        let scale = (SIDE / longest).clamp(1, 12) as usize;
        let (columns, rows) = (usize::from(extent.width), usize::from(extent.height));
        Self {
            width: columns * scale,
            scale,
            pixels: vec![0; columns * scale * (rows * scale + BAR)],
            is_blank: true,
        }
    }

    fn height(&self) -> usize {
        self.pixels.len() / self.width
    }

    /// The frame that changes the screen to what is now, or `None` if it is
    /// what was shown last.
    fn show(&mut self, replay: &Replay<'_>) -> Option<Frame<'static>> {
        let mut next = Self {
            pixels: vec![0; self.pixels.len()],
            ..*self
        };
        next.draw(replay);
        let (left, top, right, bottom) = if self.is_blank {
            (0, 0, self.width, self.height())
        } else {
            self.changes(&next)?
        };
        let rows = next.pixels.chunks_exact(self.width).take(bottom).skip(top);
        let pixels: Vec<u8> = rows
            .flat_map(|row| row[left..right].iter().copied())
            .collect();
        self.pixels = next.pixels;
        self.is_blank = false;
        Some(Frame {
            left: left as u16,
            top: top as u16,
            width: (right - left) as u16,
            height: (bottom - top) as u16,
            dispose: DisposalMethod::Keep,
            buffer: pixels.into(),
            ..Frame::default()
        })
    }

    /// The box around all pixels that differ: left, top, right, bottom.
    fn changes(&self, next: &Self) -> Option<(usize, usize, usize, usize)> {
        let mut around: Option<(usize, usize, usize, usize)> = None;
        let old = self.pixels.chunks_exact(self.width);
        for (y, (old, new)) in old.zip(next.pixels.chunks_exact(self.width)).enumerate() {
            let differs = |x: &usize| old[*x] != new[*x];
            if let Some(first) = (0..self.width).find(differs) {
                let last = (0..self.width).rev().find(differs).unwrap_or(first);
                let (left, top, right, _) = around.unwrap_or((first, y, last + 1, y + 1));
                around = Some((left.min(first), top, right.max(last + 1), y + 1));
            }
        }
        around
    }

    fn draw(&mut self, replay: &Replay<'_>) {
        for cell in cells(replay.extent()) {
            let ground = Ground::ALL.into_iter().zip(0..);
            let index = ground
                .clone()
                .find(|(ground, _)| *ground == replay.ground(cell));
            self.fill(cell, 0, index.map_or(0, |(_, index)| index));
        }
        // Robots at least five pixels wide, so that they can be seen on large maps.
        let grow = 5usize.saturating_sub(self.scale).div_ceil(2);
        for (robot, &cell) in replay.positions().iter().enumerate() {
            self.fill(cell, grow, ROBOT_INDEX + (robot % ROBOT_COLORS) as u8);
        }
        let seen = self.width * replay.seen_cells() as usize;
        let seen = seen / (replay.reachable_cells() as usize).max(1);
        let top = self.height() - BAR;
        for row in self.pixels.chunks_exact_mut(self.width).skip(top) {
            row.fill(0);
            row[..seen].fill(INK_INDEX);
        }
    }

    /// Fills a cell, and `grow` pixels around it.
    fn fill(&mut self, cell: Cell, grow: usize, index: u8) {
        let span = |at: i16, end: usize| {
            let first = at as usize * self.scale;
            first.saturating_sub(grow)..(first + self.scale + grow).min(end)
        };
        let (columns, rows) = (span(cell.x, self.width), span(cell.y, self.height() - BAR));
        for y in rows {
            self.pixels[y * self.width..][columns.clone()].fill(index);
        }
    }
}
