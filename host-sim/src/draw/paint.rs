//! Colours and text.

#[cfg(not(target_arch = "wasm32"))]
use std::sync::Once;

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
}

impl Ground {
    pub(super) const ALL: [Self; 4] = [Self::Free, Self::Obstacle, Self::Unseen, Self::Unknown];

    pub(super) fn color(self) -> RGBColor {
        match self {
            Self::Free => RGBColor(255, 255, 255),
            Self::Obstacle => RGBColor(64, 70, 80),
            Self::Unseen => RGBColor(250, 200, 205),
            Self::Unknown => RGBColor(205, 208, 214),
        }
    }

    #[cfg(not(target_arch = "wasm32"))]
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Free => "seen free",
            Self::Obstacle => "seen obstacle",
            Self::Unseen => "reachable, not seen",
            Self::Unknown => "not known",
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

/// Robots with a colour of their own.
pub(super) const ROBOT_COLORS: usize = ROBOTS.len();

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
