//! Sensors of robots among voxels: their fields of view, by name.

use std::fmt;
use std::ops::RangeInclusive;
use std::str::FromStr;

use clap::ValueEnum;
use planner_core::volume::{Field, Heading, MAX_CLEARANCE, Voxel};

/// What kind of sensor robots carry. Whatever it is, they feel what is within two voxels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Sensor {
    /// Shows everything within range and in sight.
    #[default]
    AllRound,
    /// A depth camera: shows a flat image ahead, and is turned to one of eight sides.
    Camera,
    /// Half a sphere: shows what is no higher than the robot.
    Downward,
    /// Turns in a plane: shows the robot's own level.
    Lidar,
}

/// The image of a camera in degrees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fov {
    width: u16,
    height: u16,
}

impl Fov {
    /// Degrees that an image can be wide: eight headings go round with the least.
    pub const WIDTHS: RangeInclusive<u16> = 45..=170;
    /// The same high.
    pub const HEIGHTS: RangeInclusive<u16> = 1..=170;

    /// An image so many degrees wide and high, if it can be.
    pub fn new(width: u16, height: u16) -> Option<Self> {
        let fits = Self::WIDTHS.contains(&width) && Self::HEIGHTS.contains(&height);
        fits.then_some(Self { width, height })
    }

    /// Degrees that it is wide and high.
    pub const fn degrees(self) -> (u16, u16) {
        (self.width, self.height)
    }
}

impl Default for Fov {
    fn default() -> Self {
        Self {
            width: 90,
            height: 60,
        }
    }
}

impl FromStr for Fov {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('x');
        let numbers = numbers
            .and_then(|(width, height)| Self::new(width.parse().ok()?, height.parse().ok()?));
        numbers.ok_or_else(|| {
            format!(
                "expected WIDTHxHEIGHT in whole degrees, {} to {} and {} to {}",
                Self::WIDTHS.start(),
                Self::WIDTHS.end(),
                Self::HEIGHTS.start(),
                Self::HEIGHTS.end()
            )
        })
    }
}

impl fmt::Display for Fov {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}x{}", self.width, self.height)
    }
}

impl Sensor {
    /// Its field of view; `fov` is that of a camera.
    pub fn field(self, fov: Fov) -> Field {
        // Half an angle's tangent, in 256ths.
        let half = |degrees: u16| {
            let tangent = libm::tan(f64::from(degrees).to_radians() / 2.0);
            (256.0 * tangent).round() as u16
        };
        match self {
            Self::AllRound => Field::ALL_ROUND,
            Self::Downward => Field::DOWNWARD,
            Self::Lidar => Field::LIDAR,
            Self::Camera => Field {
                up: half(fov.height),
                down: half(fov.height),
                side: Some(half(fov.width)),
                ..Field::CAMERA
            },
        }
    }

    /// Its field on robots whose bodies reach so many voxels beyond the one of their middle: they
    /// feel where that comes to next.
    pub fn field_for(self, fov: Fov, clearance: u8) -> Field {
        self.field(fov).for_body(clearance)
    }

    /// The sensor with this field, as far as bodies need to feel, and a camera's image; `None`: none of
    /// these has it.
    pub fn of(field: Field) -> Option<(Self, Fov)> {
        let usual = Field::ALL_ROUND.near;
        let near = match (usual..=MAX_CLEARANCE + 1).contains(&field.near) {
            true => usual,
            false => field.near,
        };
        let field = Field { near, ..field };
        let degrees = |half: u16| (f64::from(half) / 256.0).atan().to_degrees() * 2.0;
        let fov = field.side.and_then(|side| {
            Fov::new(
                degrees(side).round() as u16,
                degrees(field.up).round() as u16,
            )
        });
        let fov = fov.unwrap_or_default();
        let all = Self::value_variants().iter();
        let sensor = all.copied().find(|sensor| sensor.field(fov) == field)?;
        Some((sensor, fov))
    }

    /// What a summary says of a field.
    pub(crate) fn name_of(field: Field) -> String {
        match Self::of(field) {
            Some((Self::Camera, fov)) => format!("camera {fov}"),
            Some((sensor, _)) => sensor.to_string(),
            None => "other".into(),
        }
    }
}

impl fmt::Display for Sensor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let value = self.to_possible_value().expect("no value is skipped");
        f.write_str(value.get_name())
    }
}

/// Farthest that a part of a voxel is from its middle: half a diagonal.
const HALF_DIAGONAL: f64 = 0.8661;

/// Whether a sensor at `eye` that is turned to `heading` has a part of `voxel` in its field,
/// or nearly: what it does when the middle is in the field, and about a voxel more. A sensor
/// that showed middles alone would leave holes along its rim, through which more seems to be
/// in sight.
pub(crate) fn shows_part(field: Field, eye: Voxel, heading: Heading, voxel: Voxel) -> bool {
    if field.shows(eye, heading, voxel) {
        return true;
    }
    let [x, y, z] = [voxel.x - eye.x, voxel.y - eye.y, voxel.z - eye.z].map(f64::from);
    // Whether a point, so far along and across, is nearly within a slope.
    let is_within = |slope: u16, along: f64, across: f64| {
        let slope = f64::from(slope) / 256.0;
        across - slope * along <= HALF_DIAGONAL * (1.0 + slope * slope).sqrt()
    };
    let slope = if z > 0.0 { field.up } else { field.down };
    let depth = match field.side {
        None => (x * x + y * y).sqrt(),
        Some(side) => {
            let yaw = std::f64::consts::FRAC_PI_4 * f64::from(heading.eighths());
            let (sin, cos) = (libm::sin(yaw), libm::cos(yaw));
            let (ahead, aside) = (x * cos + y * sin, (x * sin - y * cos).abs());
            if ahead < -HALF_DIAGONAL || !is_within(side, ahead, aside) {
                return false;
            }
            ahead
        }
    };
    slope == Field::STEEP || is_within(slope, depth, z.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is shown beyond the field is less than a voxel beyond it.
    #[test]
    fn rims_are_a_voxel_wide() {
        let eye = Voxel::new(0, 0, 0);
        let reach = || -9..=9i16;
        let voxels = || {
            reach().flat_map(move |z| {
                reach().flat_map(move |y| reach().map(move |x| Voxel::new(x, y, z)))
            })
        };
        for field in [Field::CAMERA, Field::DOWNWARD, Field::LIDAR] {
            for heading in Heading::all() {
                let shows = |at: &Voxel| field.shows(eye, heading, *at);
                let rim = |at: &Voxel| !shows(at) && shows_part(field, eye, heading, *at);
                // One that looks along a level has none.
                assert_eq!(voxels().any(|at| rim(&at)), field.side.is_some());
                for at in voxels().filter(rim) {
                    let about = voxels().filter(|it| it.distance_squared(at) <= 4);
                    assert!(about.into_iter().any(|it| shows(&it)), "{field:?} {at}");
                }
            }
        }
    }

    #[test]
    fn fields_of_view_have_names() {
        let camera = |text: &str| Sensor::Camera.field(text.parse().unwrap());
        assert_eq!(camera("90x60"), Field::CAMERA);
        assert_eq!(Fov::default().to_string(), "90x60");
        for (width, height) in Fov::WIDTHS.zip(Fov::HEIGHTS.cycle()).chain([(90, 170)]) {
            let fov = Fov::new(width, height).unwrap();
            let field = Sensor::Camera.field(fov);
            assert_eq!(Sensor::of(field), Some((Sensor::Camera, fov)));
            assert_eq!(Sensor::name_of(field), format!("camera {width}x{height}"));
        }
        for sensor in [Sensor::AllRound, Sensor::Downward, Sensor::Lidar] {
            let fov = Fov::default();
            assert_eq!(Sensor::of(sensor.field(fov)), Some((sensor, fov)));
        }
        let wide = Field {
            near: MAX_CLEARANCE + 1,
            ..Field::CAMERA
        };
        assert_eq!(Sensor::name_of(wide), "camera 90x60");
        let blind = Field {
            near: 9,
            ..Field::LIDAR
        };
        assert_eq!(Sensor::of(blind), None);
        for text in [
            "", "90", "90x", "44x60", "90x0", "171x60", "90x171", "90x60x2",
        ] {
            let error = Fov::from_str(text).unwrap_err();
            assert!(error.contains("45 to 170"), "{error}");
        }
    }
}
