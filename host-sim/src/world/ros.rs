//! ROS map_server maps: a YAML file that describes an image.
//!
//! <https://wiki.ros.org/map_server>, "Map format", and nav2_map_server, which reads the
//! same. Modes `trinary`, `scale` and `raw`; the pose of the map in the world (`origin`) is
//! what places in metres count from.

use std::fmt;
use std::path::{Path, PathBuf};

use granit_parser::{Event, Parser, ScalarStyle, StrInput};

use super::World;
use super::error::Problem;
use super::raster::{self, Ground, Pixel};
use super::read::Scale;
use crate::excerpt::{excerpt, printable};

/// Why pixels are unknown.
const BETWEEN: &str = "neither occupied nor free by the keys of the file";

/// The file as it stands: keys in lower case, with their values.
struct Yaml(Vec<(String, Value)>);

/// A value as it stands.
enum Value {
    /// In quotation marks or not: what it means, its key tells.
    Text(String),
    List(Vec<Value>),
    Nothing,
    Map,
}

/// What the parser sees, one after the other.
struct Events<'a> {
    parser: Parser<'a, StrInput<'a>>,
    text: &'a str,
}

impl<'a> Events<'a> {
    fn next(&mut self) -> Result<(Event<'a>, usize), Problem> {
        match self.parser.next_event() {
            Some(Ok((event, span))) => Ok((event, span.start.line())),
            Some(Err(error)) => Err(self.wrong(error.marker().line(), error.info())),
            None => Ok((Event::StreamEnd, 1)),
        }
    }

    /// The value that begins with `event`. The parser bounds how deep values may nest.
    fn value(&mut self, event: Event<'a>, line: usize) -> Result<Value, Problem> {
        Ok(match event {
            Event::Scalar(text, ScalarStyle::Plain, ..)
                if matches!(&*text, "" | "~" | "null" | "Null" | "NULL") =>
            {
                Value::Nothing
            }
            Event::Scalar(text, ..) => Value::Text(text.into_owned()),
            Event::SequenceStart(..) => {
                let mut values = Vec::new();
                loop {
                    match self.next()? {
                        (Event::SequenceEnd, _) => break Value::List(values),
                        (event, line) => values.push(self.value(event, line)?),
                    }
                }
            }
            Event::MappingStart(..) => loop {
                match self.next()? {
                    (Event::MappingEnd, _) => break Value::Map,
                    (event, line) => drop(self.value(event, line)?),
                }
            },
            _ => return Err(self.wrong(line, "expected a value, and no alias".into())),
        })
    }

    /// Keys with their values, to the end of their map.
    fn keys(&mut self, keys: &mut Vec<(String, Value)>) -> Result<(), Problem> {
        loop {
            let (event, line) = self.next()?;
            if matches!(event, Event::MappingEnd) {
                return Ok(());
            }
            let Value::Text(key) = self.value(event, line)? else {
                return Err(self.wrong(line, "a key that is no word".into()));
            };
            let key = key.trim().to_ascii_lowercase();
            if keys.iter().any(|(other, _)| *other == key) {
                let found = format!("key `{}` stands twice", excerpt(&key));
                return Err(self.wrong(line, found));
            }
            let (event, line) = self.next()?;
            keys.push((key, self.value(event, line)?));
        }
    }

    fn wrong(&self, line: usize, found: String) -> Problem {
        // The line itself shows the key, which the parser does not name.
        let text = self.text.lines().nth(line.saturating_sub(1));
        Problem::Yaml {
            text: excerpt(text.unwrap_or_default()),
            found: excerpt(&found),
        }
    }
}

/// As an error quotes it.
impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Text(text) => match self.number() {
                Some(number) => write!(f, "{number}"),
                None => write!(f, "`{}`", excerpt(text)),
            },
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
    /// A number; `nan` and `inf` count as YAML and as C++ write them.
    fn number(&self) -> Option<f64> {
        let Self::Text(text) = self else { return None };
        let text = text.trim().to_ascii_lowercase();
        let special = text.ends_with(".nan") || text.ends_with(".inf");
        match special {
            true => text.replacen('.', "", 1).parse().ok(),
            false => text.parse().ok(),
        }
    }

    fn flag(&self) -> Option<bool> {
        let Self::Text(text) = self else { return None };
        match text.trim().to_ascii_lowercase().as_str() {
            "false" | "no" | "off" => Some(false),
            "true" | "yes" | "on" => Some(true),
            _ => match self.number() {
                Some(0.0) => Some(false),
                Some(1.0) => Some(true),
                _ => None,
            },
        }
    }
}

impl Yaml {
    /// One document of keys with values, or nothing at all.
    fn parse(text: &str) -> Result<Self, Problem> {
        let options = granit_parser::options! { emit_comments: false };
        let mut events = Events {
            parser: Parser::new_from_str_with_options(text, options),
            text,
        };
        let mut keys: Vec<(String, Value)> = Vec::new();
        let mut documents = 0;
        loop {
            match events.next()? {
                (Event::StreamEnd, _) => return Ok(Self(keys)),
                (Event::DocumentStart(..), line) => {
                    documents += 1;
                    if documents > 1 {
                        return Err(events.wrong(line, "a second document".into()));
                    }
                }
                (Event::MappingStart(..), _) => events.keys(&mut keys)?,
                (Event::StreamStart | Event::DocumentEnd, _) => {}
                (event, line) => match events.value(event, line)? {
                    Value::Nothing => {}
                    _ => return Err(events.wrong(line, "no keys".into())),
                },
            }
        }
    }

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
    origin: [f64; 3],
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
    let (tally, lacking) = (cut.tally, cut.lacking);
    let mut world = cut.world(name, BETWEEN)?;
    world.metres_per_cell = Some(f64::from(pixels) * description.resolution);
    let [x, y, yaw] = description.origin;
    let below = f64::from(lacking) * description.resolution;
    let (sin, cos) = libm::sincos(yaw);
    world.origin = [x + below * sin, y - below * cos, yaw];
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
        let mut yaml = Yaml::parse(text)?;
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
            .and_then(|pose| <[f64; 3]>::try_from(pose).ok())
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
            Value::Text(_) => return Err(wrong("image", IMAGE, &Value::Nothing)),
            other => return Err(wrong("image", IMAGE, &other)),
        };
        Ok(Self {
            image,
            resolution,
            origin: pose,
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
