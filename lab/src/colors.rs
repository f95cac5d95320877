//! Colours, for light and dark, that colour-blind readers can tell apart.

use egui::Color32;

const fn rgb(red: u8, green: u8, blue: u8) -> Color32 {
    Color32::from_rgb(red, green, blue)
}

/// The colours of cells and marks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Colors {
    /// Known and free.
    pub free: Color32,
    /// Known obstacle.
    pub obstacle: Color32,
    /// Not known.
    pub unknown: Color32,
    /// An obstacle that nobody has seen.
    pub hidden: Color32,
    /// A free cell that could be reached and that nobody has seen.
    pub unseen: Color32,
    /// Free, beside the unknown.
    pub frontier: Color32,
    /// A robot has stood there.
    pub visited: Color32,
    /// Reached by a robot's search over the whole map.
    pub searched: Color32,
    /// Lines and letters on the map.
    pub ink: Color32,
    /// What went wrong.
    pub lost: Color32,
    robots: &'static [Color32; 7],
}

/// [Okabe & Ito 2008], without the yellow that vanishes on white.
const ON_LIGHT: [Color32; 7] = [
    rgb(0, 114, 178),
    rgb(213, 94, 0),
    rgb(0, 158, 115),
    rgb(204, 121, 167),
    rgb(230, 159, 0),
    rgb(86, 180, 233),
    rgb(0, 0, 0),
];

/// The same, lighter where they would vanish on dark ground.
const ON_DARK: [Color32; 7] = [
    rgb(86, 180, 233),
    rgb(240, 130, 50),
    rgb(30, 190, 145),
    rgb(224, 150, 190),
    rgb(240, 228, 66),
    rgb(90, 140, 240),
    rgb(255, 255, 255),
];

impl Colors {
    /// On light ground.
    pub const LIGHT: Self = Self {
        free: rgb(255, 255, 255),
        obstacle: rgb(64, 70, 80),
        unknown: rgb(205, 208, 214),
        hidden: rgb(158, 163, 172),
        unseen: rgb(228, 230, 234),
        frontier: rgb(240, 190, 60),
        visited: rgb(224, 236, 246),
        searched: rgb(204, 235, 222),
        ink: rgb(40, 44, 52),
        lost: rgb(190, 50, 30),
        robots: &ON_LIGHT,
    };

    /// On dark ground.
    pub const DARK: Self = Self {
        free: rgb(72, 78, 90),
        obstacle: rgb(206, 211, 220),
        unknown: rgb(32, 34, 40),
        hidden: rgb(104, 109, 120),
        unseen: rgb(46, 50, 58),
        frontier: rgb(230, 159, 0),
        visited: rgb(66, 88, 108),
        searched: rgb(48, 98, 82),
        ink: rgb(235, 238, 243),
        lost: rgb(255, 120, 90),
        robots: &ON_DARK,
    };

    /// Those of the theme in use.
    pub fn of(ui: &egui::Ui) -> Self {
        if ui.visuals().dark_mode {
            Self::DARK
        } else {
            Self::LIGHT
        }
    }

    /// The colour of a robot; from the eighth on they come again.
    pub fn robot(&self, robot: usize) -> Color32 {
        self.robots[robot % self.robots.len()]
    }
}

/// `share` of `over` on `under`.
pub fn mix(under: Color32, over: Color32, share: f32) -> Color32 {
    let channel = |a: u8, b: u8| (f32::from(a) + (f32::from(b) - f32::from(a)) * share) as u8;
    rgb(
        channel(under.r(), over.r()),
        channel(under.g(), over.g()),
        channel(under.b(), over.b()),
    )
}
