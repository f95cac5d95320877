//! ROS map_server maps: a YAML file that describes an image.
//!
//! <https://wiki.ros.org/map_server>, "Map format", and nav2_map_server, which reads the
//! same. Modes `trinary`, `scale` and `raw`; the pose of the map in the world (`origin`)
//! is checked and otherwise of no use here.

use std::fmt;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use serde::de::{Deserializer, Error as _, IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde_saphyr::NonFiniteFloatPolicy;

use super::World;
use super::error::Problem;
use super::raster::{self, Ground, Pixel};
use super::read::Scale;
use crate::excerpt::{excerpt, printable};

/// Why pixels are unknown.
const BETWEEN: &str = "neither occupied nor free by the keys of the file";

/// The file as it stands: keys in lower case, with their values.
struct Yaml(Vec<(String, Value)>);

/// A value as it stands, whether in quotation marks or not.
enum Value {
    Text(String),
    Number(f64),
    Flag(bool),
    List(Vec<Value>),
    Nothing,
    Map,
}

impl<'de> Deserialize<'de> for Yaml {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        struct Keys;
        impl<'de> Visitor<'de> for Keys {
            type Value = Yaml;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("keys with values")
            }

            fn visit_unit<E>(self) -> Result<Yaml, E> {
                Ok(Yaml(Vec::new()))
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Yaml, A::Error> {
                let mut entries: Vec<(String, Value)> = Vec::new();
                while let Some(key) = map.next_key::<String>()? {
                    let key = key.trim().to_ascii_lowercase();
                    if entries.iter().any(|(other, _)| *other == key) {
                        let key = excerpt(&key);
                        return Err(A::Error::custom(format!("key `{key}` stands twice")));
                    }
                    entries.push((key, map.next_value()?));
                }
                Ok(Yaml(entries))
            }
        }
        from.deserialize_any(Keys)
    }
}

impl<'de> Deserialize<'de> for Value {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        struct Any;
        impl<'de> Visitor<'de> for Any {
            type Value = Value;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a value")
            }

            fn visit_bool<E>(self, flag: bool) -> Result<Value, E> {
                Ok(Value::Flag(flag))
            }

            fn visit_i64<E>(self, number: i64) -> Result<Value, E> {
                Ok(Value::Number(number as f64))
            }

            fn visit_u64<E>(self, number: u64) -> Result<Value, E> {
                Ok(Value::Number(number as f64))
            }

            fn visit_i128<E>(self, number: i128) -> Result<Value, E> {
                Ok(Value::Number(number as f64))
            }

            fn visit_u128<E>(self, number: u128) -> Result<Value, E> {
                Ok(Value::Number(number as f64))
            }

            fn visit_f64<E>(self, number: f64) -> Result<Value, E> {
                Ok(Value::Number(number))
            }

            fn visit_str<E>(self, text: &str) -> Result<Value, E> {
                Ok(Value::Text(text.into()))
            }

            fn visit_unit<E>(self) -> Result<Value, E> {
                Ok(Value::Nothing)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Value, A::Error> {
                let mut values = Vec::new();
                while let Some(value) = list.next_element()? {
                    values.push(value);
                }
                Ok(Value::List(values))
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Value, A::Error> {
                while map.next_entry::<IgnoredAny, IgnoredAny>()?.is_some() {}
                Ok(Value::Map)
            }
        }
        from.deserialize_any(Any)
    }
}

/// As an error quotes it.
impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Text(text) => write!(f, "`{}`", excerpt(text)),
            Self::Number(number) => write!(f, "{number}"),
            Self::Flag(flag) => write!(f, "{flag}"),
            Self::List(values) => {
                let values: Vec<_> = values.iter().take(9).map(Value::to_string).collect();
                write!(f, "[{}]", excerpt(&values.join(", ")))
            }
            Self::Nothing => write!(f, "nothing"),
            Self::Map => write!(f, "keys of its own"),
        }
    }
}

impl Value {
    /// A number, in quotation marks too; `nan` as C++ prints it counts.
    fn number(&self) -> Option<f64> {
        match self {
            Self::Number(number) => Some(*number),
            Self::Text(text) => text.trim().parse().ok(),
            _ => None,
        }
    }

    fn flag(&self) -> Option<bool> {
        match self {
            Self::Flag(flag) => Some(*flag),
            Self::Number(0.0) => Some(false),
            Self::Number(1.0) => Some(true),
            Self::Text(text) => match text.trim().to_ascii_lowercase().as_str() {
                "0" | "false" | "no" | "off" => Some(false),
                "1" | "true" | "yes" | "on" => Some(true),
                _ => None,
            },
            _ => None,
        }
    }
}

impl Yaml {
    fn take(&mut self, key: &str) -> Value {
        let place = self.0.iter().position(|(other, _)| other == key);
        place.map_or(Value::Nothing, |place| self.0.swap_remove(place).1)
    }
}

/// How pixels are read: map_server's modes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mode {
    Trinary,
    Scale,
    Raw,
}

/// A description that holds together.
struct Description {
    image: String,
    resolution: f64,
    occupied_thresh: f64,
    free_thresh: f64,
    negate: bool,
    mode: Mode,
    notes: Vec<String>,
}

/// Reads the map that `yaml`, the text of the file `path`, describes.
pub(super) fn read(
    name: &str,
    path: &Path,
    yaml: &str,
    scale: Scale,
    open: &dyn Fn(&Path) -> Result<Vec<u8>, Problem>,
) -> Result<World, Problem> {
    let description = Description::parse(yaml)?;
    let (pixels, note) = pixels_per_cell(scale, description.resolution)?;
    let in_image = |problem| {
        let path = path.with_file_name("").join(excerpt(&description.image));
        Problem::RosImage {
            path: printable(&path.to_string_lossy()),
            problem: Box::new(problem),
        }
    };
    let (bytes, moved) = open_image(path, &description.image, open).map_err(in_image)?;
    let cut = raster::cut(&bytes, pixels, |pixel| description.ground(pixel)).map_err(in_image)?;
    let tally = cut.tally;
    let mut world = cut.world(name, BETWEEN)?;
    world.metres_per_cell = Some(f64::from(pixels) * description.resolution);
    world.notes.extend(description.notes);
    world.notes.extend(moved);
    world.notes.extend(note);
    world.notes.extend((tally.unknown > 0).then(|| {
        let unknown = tally.unknown_in_words(BETWEEN);
        format!("{unknown}: taken as obstacles, which no robot enters")
    }));
    world.notes.extend((tally.costly > 0).then(|| {
        format!(
            "{} of {} pixels are occupied in part (mode `{}`): taken as free, as a costmap \
             takes what is not occupied for certain",
            tally.costly,
            tally.pixels,
            description.mode.name()
        )
    }));
    Ok(world)
}

/// The bytes of the image; if it is not where the file says, of one of its name beside
/// the file, with a note.
fn open_image(
    yaml: &Path,
    image: &str,
    open: &dyn Fn(&Path) -> Result<Vec<u8>, Problem>,
) -> Result<(Vec<u8>, Option<String>), Problem> {
    let named: PathBuf = yaml.with_file_name("").join(image);
    let missing = match open(&named) {
        Err(missing @ Problem::Missing) => missing,
        other => return Ok((other?, None)),
    };
    // Windows' separators too, wherever this runs.
    let file = image.rsplit(['/', '\\']).next().unwrap_or(image);
    let beside = yaml.with_file_name(file);
    if file.is_empty() || beside == named {
        return Err(missing);
    }
    match open(&beside) {
        Err(_) => Err(missing),
        Ok(bytes) => {
            let (image, file) = (excerpt(image), excerpt(file));
            let note = format!(
                "key `image` names {image}, which is not there; {file} lies beside the YAML \
                 file and is read in its place: write `image: {file}`"
            );
            Ok((bytes, Some(note)))
        }
    }
}

impl Description {
    fn parse(text: &str) -> Result<Self, Problem> {
        let options = serde_saphyr::options! {
            non_finite_float_policy: NonFiniteFloatPolicy::PassThrough,
        };
        let yaml = serde_saphyr::from_str_with_options(text, options);
        let mut yaml: Yaml = yaml.map_err(|error| {
            // The line itself shows the key, which the parser does not name.
            let line = error.location().map_or(1, |location| location.line());
            let line = text.lines().nth((line as usize).saturating_sub(1));
            Problem::Yaml {
                text: excerpt(line.unwrap_or_default()),
                found: excerpt(&error.without_snippet().to_string()),
            }
        })?;
        let mut notes = Vec::new();

        const METRES: &str = "metres per pixel above 0, for example `resolution: 0.05`";
        let resolution = yaml.take("resolution");
        let resolution = resolution
            .number()
            .filter(|metres| metres.is_finite() && *metres > 0.0)
            .ok_or_else(|| wrong("resolution", METRES, &resolution))?;
        const ORIGIN: &str = "x, y and yaw in metres and radians, for example `origin: [0, 0, 0]`";
        let origin = yaml.take("origin");
        let pose: Option<Vec<f64>> = match &origin {
            Value::List(values) => values.iter().map(Value::number).collect(),
            _ => None,
        };
        let pose = pose
            .filter(|pose| pose.len() == 3)
            .ok_or_else(|| wrong("origin", ORIGIN, &origin))?;
        if pose.iter().any(|number| !number.is_finite()) {
            notes.push(format!(
                "key `origin` is {origin}, which is no pose; it is not needed here, but a \
                 map_server may refuse it: write 0 there"
            ));
        }
        const OCCUPIED: &str = "a share from 0 to 1, for example `occupied_thresh: 0.65`";
        let occupied_thresh = yaml.take("occupied_thresh");
        let occupied_thresh = occupied_thresh
            .number()
            .filter(|share| (0.0..=1.0).contains(share))
            .ok_or_else(|| wrong("occupied_thresh", OCCUPIED, &occupied_thresh))?;
        const FREE: &str = "a share from 0 to `occupied_thresh`, for example `free_thresh: 0.196`";
        let free_thresh = yaml.take("free_thresh");
        let free_thresh = free_thresh
            .number()
            .filter(|share| (0.0..=occupied_thresh).contains(share))
            .ok_or_else(|| wrong("free_thresh", FREE, &free_thresh))?;
        const NEGATE: &str = "0 or 1, for example `negate: 0`";
        let negate = yaml.take("negate");
        let negate = negate
            .flag()
            .ok_or_else(|| wrong("negate", NEGATE, &negate))?;
        const MODE: &str = "`trinary` (the default), `scale` or `raw`";
        let mode = match yaml.take("mode") {
            Value::Nothing => Mode::Trinary,
            Value::Text(text) => {
                Mode::named(&text).ok_or_else(|| wrong("mode", MODE, &Value::Text(text)))?
            }
            other => return Err(wrong("mode", MODE, &other)),
        };
        const IMAGE: &str = "the image file beside the YAML file, for example `image: house.pgm`";
        let image = match yaml.take("image") {
            Value::Text(image) if !image.trim().is_empty() => image,
            Value::Number(number) => number.to_string(),
            Value::Text(_) => return Err(wrong("image", IMAGE, &Value::Nothing)),
            other => return Err(wrong("image", IMAGE, &other)),
        };
        Ok(Self {
            image,
            resolution,
            occupied_thresh,
            free_thresh,
            negate,
            mode,
            notes,
        })
    }

    /// What a pixel says, by the formulas of map_server's image_loader.cpp and
    /// nav2_map_server's map_io.cpp: the comparisons are strict, and in trinary mode
    /// transparency counts as a fourth colour. What is wholly transparent has no
    /// colour, and is unknown in every mode.
    fn ground(&self, pixel: Pixel) -> Ground {
        if pixel.alpha == Some(0) {
            return Ground::Unknown;
        }
        let mean = match (self.mode, pixel.alpha) {
            (Mode::Trinary, Some(alpha)) => (3.0 * pixel.mean + f64::from(alpha)) / 4.0,
            _ => pixel.mean,
        };
        let light = if self.negate { 255.0 - mean } else { mean };
        if self.mode == Mode::Raw {
            // Per cent occupied; whatever else is unknown.
            return match light.round() as u8 {
                0 => Ground::Free,
                1..100 => Ground::Costly,
                100 => Ground::Obstacle,
                _ => Ground::Unknown,
            };
        }
        let occupied = (255.0 - light) / 255.0;
        if self.mode == Mode::Scale && pixel.is_transparent() {
            Ground::Unknown
        } else if occupied > self.occupied_thresh {
            Ground::Obstacle
        } else if occupied < self.free_thresh {
            Ground::Free
        } else if self.mode == Mode::Scale {
            Ground::Costly
        } else {
            Ground::Unknown
        }
    }
}

impl Mode {
    const ALL: [Self; 3] = [Self::Trinary, Self::Scale, Self::Raw];

    fn name(self) -> &'static str {
        match self {
            Self::Trinary => "trinary",
            Self::Scale => "scale",
            Self::Raw => "raw",
        }
    }

    fn named(name: &str) -> Option<Self> {
        let name = name.trim();
        Self::ALL
            .into_iter()
            .find(|mode| mode.name().eq_ignore_ascii_case(name))
    }
}

/// Pixels along a cell's side, and a note if that is not what was asked for.
fn pixels_per_cell(scale: Scale, resolution: f64) -> Result<(u32, Option<String>), Problem> {
    let metres = match scale {
        Scale::Pixel => return Ok((1, None)),
        Scale::Pixels(pixels) => return Ok((pixels, None)),
        Scale::Metres(metres) => metres,
    };
    let exact = metres / resolution;
    let pixels = exact.round();
    if !(1.0 - 1e-9..f64::from(u32::MAX)).contains(&exact) {
        return Err(Problem::CellSize { metres, resolution });
    }
    let note = ((exact - pixels).abs() > 1e-6 * exact).then(|| {
        format!(
            "--cell-size {metres} is {exact:.2} pixels of {resolution} m; \
             cells of {pixels} pixels, {:.4} m, are used",
            pixels * resolution
        )
    });
    Ok((pixels as u32, note))
}

fn wrong(key: &'static str, expected: &'static str, found: &Value) -> Problem {
    Problem::Key {
        key,
        expected,
        found: found.to_string(),
    }
}
