//! Words beneath a picture: lines of text, and what its signs mean.

use plotters::coord::Shift;
use plotters::prelude::*;

use super::DrawError;
use super::paint::{INK, text};

/// Pixels around the parts of a picture.
pub(super) const MARGIN: i32 = 16;
/// Height of a line of text.
pub(super) const LINE: i32 = 22;
const TEXT: u32 = 15;

pub(super) type Area<'a> = DrawingArea<BitMapBackend<'a>, Shift>;

/// Writes lines from a place downwards, and tells how high the next one would stand.
pub(super) fn write_lines(
    area: &Area<'_>,
    (x, y): (i32, i32),
    lines: &[impl AsRef<str>],
) -> Result<i32, DrawError> {
    lines.iter().try_fold(y, |y, line| {
        write(area, (x, y), line.as_ref())?;
        Ok(y + LINE)
    })
}

/// Writes a few words.
pub(super) fn write(area: &Area<'_>, at: (i32, i32), words: &str) -> Result<(), DrawError> {
    Ok(area.draw(&Text::new(words, at, text(TEXT)))?)
}

/// What the signs of a picture mean, in rows that fit its width.
pub(super) struct Legend<S>(Vec<Key<S>>);

struct Key<S> {
    x: i32,
    row: i32,
    label: String,
    sign: S,
}

impl<S> Legend<S> {
    /// The signs with what they mean, for a picture of `width` pixels.
    pub(super) fn of(entries: impl IntoIterator<Item = (String, S)>, width: u32) -> Self {
        let (mut x, mut row) = (MARGIN, 0);
        let key = |(label, sign): (String, S)| {
            // The font is fixed-width: 0.6 of its size a character.
            let wide = 20 + (label.chars().count() as i32 * TEXT as i32 * 62) / 100 + 18;
            if x > MARGIN && x + wide > width as i32 {
                (x, row) = (MARGIN, row + 1);
            }
            let key = Key {
                x,
                row,
                label,
                sign,
            };
            x += wide;
            key
        };
        Self(entries.into_iter().map(key).collect())
    }

    /// Lines that it takes.
    pub(super) fn rows(&self) -> i32 {
        self.0.last().map_or(0, |key| key.row + 1)
    }

    /// Draws it from the height `y` on; `draw` draws a sign, 14 pixels wide, to the right
    /// of a place.
    pub(super) fn draw(
        &self,
        area: &Area<'_>,
        y: i32,
        draw: impl Fn(&S, &Area<'_>, (i32, i32)) -> Result<(), DrawError>,
    ) -> Result<(), DrawError> {
        for Key {
            x,
            row,
            label,
            sign,
        } in &self.0
        {
            let y = y + row * LINE;
            draw(sign, area, (*x, y + TEXT as i32 / 2))?;
            write(area, (x + 20, y), label)?;
        }
        Ok(())
    }
}

/// A square of a colour as a sign.
pub(super) fn square(
    area: &Area<'_>,
    (x, middle): (i32, i32),
    color: RGBColor,
) -> Result<(), DrawError> {
    let square = [(x, middle - 6), (x + 14, middle + 7)];
    area.draw(&Rectangle::new(square, color.filled()))?;
    Ok(area.draw(&Rectangle::new(square, INK.stroke_width(1)))?)
}

/// A line of a colour as a sign.
pub(super) fn dash(
    area: &Area<'_>,
    (x, middle): (i32, i32),
    color: RGBColor,
) -> Result<(), DrawError> {
    let line = [(x, middle), (x + 14, middle)];
    Ok(area.draw(&PathElement::new(line, color.stroke_width(3)))?)
}

/// Where a robot started.
pub(super) fn start(
    area: &Area<'_>,
    at: (i32, i32),
    radius: i32,
    color: RGBColor,
) -> Result<(), DrawError> {
    area.draw(&Circle::new(at, radius, WHITE.filled()))?;
    Ok(area.draw(&Circle::new(at, radius, color.stroke_width(2)))?)
}

/// Where it ended.
pub(super) fn end(
    area: &Area<'_>,
    at: (i32, i32),
    radius: i32,
    color: RGBColor,
) -> Result<(), DrawError> {
    area.draw(&Circle::new(at, radius + 1, WHITE.filled()))?;
    Ok(area.draw(&Circle::new(at, radius, color.filled()))?)
}

/// The robots by their colours, which come again after `colors`: their numbers, and the first of
/// them.
pub(super) fn robots(robots: usize, colors: usize) -> impl Iterator<Item = (String, usize)> {
    let more = if robots > 4 * colors { ", …" } else { "" };
    (0..robots.min(colors)).map(move |robot| {
        let same = (robot..robots).step_by(colors).take(4);
        let same: Vec<String> = same.map(|robot| robot.to_string()).collect();
        (format!("robot {}{more}", same.join(", ")), robot)
    })
}
