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
    /// Seen blocked, and not believed yet.
    pub doubtful: Color32,
    /// Free, and taken for an obstacle before.
    pub changed: Color32,
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

/// [Okabe & Ito 2008], without the yellow that vanishes on white, and with violet for the
/// black that is hard to follow along dark walls.
const ON_LIGHT: [Color32; 7] = [
    rgb(0, 114, 178),
    rgb(213, 94, 0),
    rgb(0, 158, 115),
    rgb(204, 121, 167),
    rgb(230, 159, 0),
    rgb(86, 180, 233),
    rgb(150, 0, 255),
];

/// The same, lighter where they would vanish on dark ground; pale green for violet.
const ON_DARK: [Color32; 7] = [
    rgb(86, 180, 233),
    rgb(240, 130, 50),
    rgb(30, 190, 145),
    rgb(224, 150, 190),
    rgb(240, 228, 66),
    rgb(90, 140, 240),
    rgb(165, 255, 135),
];

impl Colors {
    /// On light ground.
    pub const LIGHT: Self = Self {
        free: rgb(255, 255, 255),
        obstacle: rgb(64, 70, 80),
        doubtful: rgb(176, 150, 204),
        changed: rgb(150, 205, 240),
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
        doubtful: rgb(120, 92, 150),
        changed: rgb(60, 120, 170),
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

#[cfg(test)]
mod tests {
    use super::*;

    /// What reaches the eye without one kind of cone, in linear light: none is missing,
    /// long, middle, short waves [Machado et al. 2009, table 1, severity 1].
    const VISIONS: [[[f64; 3]; 3]; 4] = [
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        [
            [0.152286, 1.052583, -0.204868],
            [0.114503, 0.786281, 0.099216],
            [-0.003882, -0.048116, 1.051998],
        ],
        [
            [0.367322, 0.860646, -0.227968],
            [0.280085, 0.672501, 0.047413],
            [-0.011820, 0.042940, 0.968881],
        ],
        [
            [1.255528, -0.076749, -0.178779],
            [-0.078411, 0.930809, 0.147602],
            [0.004733, 0.691367, 0.303900],
        ],
    ];

    fn times(matrix: [[f64; 3]; 3], vector: [f64; 3]) -> [f64; 3] {
        matrix.map(|row| row.iter().zip(vector).map(|(a, b)| a * b).sum())
    }

    /// Lightness, and place between green and red, blue and yellow: CIE 1976 L*a*b*.
    fn seen(color: Color32, vision: [[f64; 3]; 3]) -> [f64; 3] {
        let linear = [color.r(), color.g(), color.b()].map(|channel| {
            let share = f64::from(channel) / 255.0;
            match share {
                0.0..0.04045 => share / 12.92,
                _ => ((share + 0.055) / 1.055).powf(2.4),
            }
        });
        let xyz = [
            [0.4124 / 0.9505, 0.3576 / 0.9505, 0.1805 / 0.9505],
            [0.2126, 0.7152, 0.0722],
            [0.0193 / 1.089, 0.1192 / 1.089, 0.9505 / 1.089],
        ];
        let [x, y, z] = times(
            xyz,
            times(vision, linear).map(|share| share.clamp(0.0, 1.0)),
        )
        .map(|share| match share {
            0.008856.. => share.cbrt(),
            _ => 7.787 * share + 16.0 / 116.0,
        });
        [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
    }

    fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
        a.iter()
            .zip(b)
            .map(|(a, b)| (a - b).powi(2))
            .sum::<f64>()
            .sqrt()
    }

    /// Whatever cones a reader has: robots differ from each other, from the ground and
    /// from walls, and none is grey as these are.
    #[test]
    fn robots_stand_off() {
        for colors in [Colors::LIGHT, Colors::DARK] {
            for vision in VISIONS {
                let seen = |color| seen(color, vision);
                for (robot, &color) in colors.robots.iter().enumerate() {
                    let [_, red, yellow] = seen(color);
                    assert!(red.hypot(yellow) >= 5.0, "{color:?} is grey");
                    let others = colors.robots[..robot].iter();
                    for (&other, least) in others
                        .map(|other| (other, 10.0))
                        .chain([(&colors.free, 20.0), (&colors.obstacle, 12.0)])
                    {
                        let distance = distance(seen(color), seen(other));
                        assert!(distance >= least, "{color:?} {other:?}: {distance}");
                    }
                }
            }
        }
    }
}
