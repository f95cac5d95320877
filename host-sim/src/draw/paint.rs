//! Colours and text.

use std::ops::RangeInclusive;
#[cfg(not(target_arch = "wasm32"))]
use std::sync::Once;

use image::{Rgb, RgbImage};
use plotters::style::RGBColor;
#[cfg(not(target_arch = "wasm32"))]
use plotters::style::{FontStyle, IntoFont, TextStyle, register_font};

/// What a cell is to whoever looks at a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ground {
    Free,
    Obstacle,
    /// Could be reached, and nobody has seen it.
    Unseen,
    /// Neither seen nor reachable.
    Unknown,
    /// Shown otherwise than it is by the last look at it.
    Mistaken,
    Person,
    ShutDoor,
    OpenDoor,
}

impl Ground {
    #[cfg(not(target_arch = "wasm32"))]
    pub(super) const ALL: [Self; 8] = [
        Self::Free,
        Self::Obstacle,
        Self::Unseen,
        Self::Unknown,
        Self::Mistaken,
        Self::Person,
        Self::ShutDoor,
        Self::OpenDoor,
    ];

    pub(super) fn color(self) -> RGBColor {
        match self {
            Self::Free => RGBColor(255, 255, 255),
            Self::Obstacle => RGBColor(64, 70, 80),
            Self::Unseen => RGBColor(250, 200, 205),
            Self::Unknown => RGBColor(205, 208, 214),
            Self::Mistaken => RGBColor(255, 214, 102),
            Self::Person => RGBColor(200, 30, 90),
            Self::ShutDoor => RGBColor(122, 72, 30),
            Self::OpenDoor => RGBColor(222, 190, 150),
        }
    }

    #[cfg(not(target_arch = "wasm32"))]
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Free => "seen free",
            Self::Obstacle => "seen obstacle",
            Self::Unseen => "reachable, not seen",
            Self::Unknown => "not known",
            Self::Mistaken => "last shown wrongly",
            Self::Person => "person",
            Self::ShutDoor => "shut door",
            Self::OpenDoor => "open door",
        }
    }
}

/// Colours that colour-blind readers can tell apart [Okabe & Ito 2008], without
/// the yellow that vanishes on white.
const ROBOTS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(0, 0, 0),
];

/// The colour of a robot; from the eighth on they come again.
pub(super) fn robot_color(robot: usize) -> RGBColor {
    ROBOTS[robot % ROBOTS.len()]
}

/// The colour of a line in a chart: those of robots, and a gray.
#[cfg(not(target_arch = "wasm32"))]
pub(super) fn series_color(series: usize) -> RGBColor {
    const GRAY: RGBColor = RGBColor(136, 136, 136);
    let colors = ROBOTS.iter().chain([&GRAY]);
    { colors }
        .nth(series % (ROBOTS.len() + 1))
        .copied()
        .unwrap_or(GRAY)
}

/// The colour of what belongs to something of that colour, and is less.
pub(super) fn pale(RGBColor(red, green, blue): RGBColor) -> Rgb<u8> {
    Rgb([red, green, blue].map(|of| 255 - (255 - of) / 2))
}

/// Robots with a colour of their own.
#[cfg(not(target_arch = "wasm32"))]
pub(super) const ROBOT_COLORS: usize = ROBOTS.len();

/// The same on dark ground, with the yellow and without the black.
pub(super) fn way_color(robot: usize) -> Rgb<u8> {
    WAYS[robot % WAYS.len()]
}

/// Robots with a way of their own colour.
#[cfg(not(target_arch = "wasm32"))]
pub(super) const WAY_COLORS: usize = WAYS.len();

const WAYS: [Rgb<u8>; 8] = [
    Rgb([230, 159, 0]),
    Rgb([86, 180, 233]),
    Rgb([0, 158, 115]),
    Rgb([240, 228, 66]),
    Rgb([0, 114, 178]),
    Rgb([213, 94, 0]),
    Rgb([204, 121, 167]),
    Rgb([120, 120, 120]),
];

/// What nobody has seen, in views of heights and voxels.
pub(super) const DARK: Rgb<u8> = Rgb([24, 26, 30]);

/// Colour of ground at height `ground` where the highest is `highest`.
pub(super) fn shade(ground: f32, highest: f32) -> Rgb<u8> {
    let share = ground / highest.max(1.0);
    Rgb([70.0, 78.0, 84.0].map(|dark| (dark + share * 165.0) as u8))
}

/// Sets a pixel, if it is one of the picture.
pub(super) fn put(picture: &mut RgbImage, x: f32, y: f32, color: Rgb<u8>) {
    if x >= 0.0 && y >= 0.0 && (x as u32) < picture.width() && (y as u32) < picture.height() {
        picture.put_pixel(x as u32, y as u32, color);
    }
}

/// Sets the pixels of a square with this upper left corner.
pub(super) fn square(picture: &mut RgbImage, (x, y): (f32, f32), side: u32, color: Rgb<u8>) {
    for dy in 0..side {
        for dx in 0..side {
            put(picture, x + dx as f32, y + dy as f32, color);
        }
    }
}

/// Sets the pixels around `(x, y)` whose distance from it, in pixels, is in `radii`.
pub(super) fn disc(
    picture: &mut RgbImage,
    (x, y): (f32, f32),
    radii: RangeInclusive<f32>,
    color: Rgb<u8>,
) {
    let reach = radii.end().ceil() as i32;
    for dy in -reach..=reach {
        for dx in -reach..=reach {
            if radii.contains(&((dx * dx + dy * dy) as f32).sqrt()) {
                put(picture, x + dx as f32, y + dy as f32, color);
            }
        }
    }
}

/// Sets the pixels from one place to another, and those beside them by `pen`.
pub(super) fn line(
    picture: &mut RgbImage,
    (x0, y0): (f32, f32),
    (x1, y1): (f32, f32),
    pen: &[(f32, f32)],
    color: Rgb<u8>,
) {
    let length = (x1 - x0).abs().max((y1 - y0).abs()).ceil().max(1.0);
    for i in 0..=length as u32 {
        let share = i as f32 / length;
        let (x, y) = (x0 + (x1 - x0) * share, y0 + (y1 - y0) * share);
        for (dx, dy) in pen {
            put(picture, x + dx, y + dy, color);
        }
    }
}

/// A colour of the charts in a picture.
pub(super) fn rgb(RGBColor(red, green, blue): RGBColor) -> Rgb<u8> {
    Rgb([red, green, blue])
}

pub(super) const INK: RGBColor = RGBColor(40, 44, 52);

#[cfg(not(target_arch = "wasm32"))]
/// Text of `size` pixels, in a font that comes with the program.
pub(super) fn text(size: u32) -> TextStyle<'static> {
    static FONT: Once = Once::new();
    FONT.call_once(|| {
        let font = epaint_default_fonts::HACK_REGULAR;
        if register_font("sans-serif", FontStyle::Normal, font).is_err() {
            unreachable!("the font that comes with the program is well-formed");
        }
    });
    use plotters::style::Color;
    ("sans-serif", size).into_font().color(&INK.to_rgba())
}
