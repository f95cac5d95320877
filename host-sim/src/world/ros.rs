//! ROS map_server maps: a YAML file that describes an image.
//!
//! <https://wiki.ros.org/map_server>, "Map format". Mode `trinary`; the pose
//! of the map in the world (`origin`) is checked and otherwise of no use here.

use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::World;
use super::error::Problem;
use super::raster::{Ground, Image};
use super::read::Scale;

/// The file as it stands: every key may be missing, and is asked for by name.
#[derive(Deserialize)]
struct Yaml {
    image: Option<PathBuf>,
    resolution: Option<f64>,
    origin: Option<Vec<f64>>,
    occupied_thresh: Option<f64>,
    free_thresh: Option<f64>,
    negate: Option<Negate>,
    mode: Option<String>,
}

#[derive(Deserialize)]
#[serde(untagged, expecting = "expected 0, 1, true or false")]
enum Negate {
    Number(u8),
    Flag(bool),
}

/// A description that holds together.
struct Description {
    image: PathBuf,
    resolution: f64,
    occupied_thresh: f64,
    free_thresh: f64,
    negate: bool,
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
    let image_path = path.with_file_name("").join(&description.image);
    let in_image = |problem| Problem::RosImage {
        path: image_path.clone(),
        problem: Box::new(problem),
    };
    let image = open(&image_path)
        .and_then(|bytes| Image::decode(&bytes))
        .map_err(in_image)?;
    let grid = image.cut(pixels, |gray| description.ground(gray))?;
    let mut world = World::from_grid(name, grid)?;
    world.metres_per_cell = Some(f64::from(pixels) * description.resolution);
    world.notes.extend(note);
    Ok(world)
}

impl Description {
    fn parse(yaml: &str) -> Result<Self, Problem> {
        let yaml: Yaml = serde_saphyr::from_str(yaml).map_err(|error| {
            // The line itself shows the key, which the parser does not name.
            let line = error.location().map_or(1, |location| location.line());
            let text = yaml
                .lines()
                .nth((line as usize).saturating_sub(1))
                .unwrap_or_default();
            Problem::Yaml {
                text: text.into(),
                found: error.without_snippet().to_string(),
            }
        })?;

        const METRES: &str = "metres per pixel above 0, for example `resolution: 0.05`";
        let resolution = required("resolution", METRES, yaml.resolution)?;
        if !(resolution.is_finite() && resolution > 0.0) {
            return Err(wrong("resolution", METRES, resolution));
        }
        const ORIGIN: &str = "x, y and yaw in metres and radians, for example `origin: [0, 0, 0]`";
        let origin = required("origin", ORIGIN, yaml.origin)?;
        if origin.len() != 3 {
            return Err(wrong("origin", ORIGIN, format!("{origin:?}")));
        }
        const OCCUPIED: &str = "a share from 0 to 1, for example `occupied_thresh: 0.65`";
        let occupied_thresh = required("occupied_thresh", OCCUPIED, yaml.occupied_thresh)?;
        if !(0.0..=1.0).contains(&occupied_thresh) {
            return Err(wrong("occupied_thresh", OCCUPIED, occupied_thresh));
        }
        const FREE: &str = "a share from 0 to `occupied_thresh`, for example `free_thresh: 0.196`";
        let free_thresh = required("free_thresh", FREE, yaml.free_thresh)?;
        if !(0.0..=occupied_thresh).contains(&free_thresh) {
            return Err(wrong("free_thresh", FREE, free_thresh));
        }
        const NEGATE: &str = "0 or 1, for example `negate: 0`";
        let negate = match required("negate", NEGATE, yaml.negate)? {
            Negate::Flag(flag) => flag,
            Negate::Number(0) => false,
            Negate::Number(1) => true,
            Negate::Number(other) => return Err(wrong("negate", NEGATE, other)),
        };
        if let Some(mode) = yaml.mode.filter(|mode| mode != "trinary") {
            const MODE: &str =
                "`trinary`, the only mode that is free or blocked (others hold costs)";
            return Err(wrong("mode", MODE, format!("`{mode}`")));
        }
        const IMAGE: &str = "the image file beside the YAML file, for example `image: house.pgm`";
        let image = required("image", IMAGE, yaml.image)?;
        Ok(Self {
            image,
            resolution,
            occupied_thresh,
            free_thresh,
            negate,
        })
    }

    /// Trinary reading of a pixel; the comparisons are strict as in map_server.
    fn ground(&self, gray: u8) -> Ground {
        let light = f64::from(gray) / 255.0;
        let occupied = if self.negate { light } else { 1.0 - light };
        if occupied > self.occupied_thresh {
            Ground::Obstacle
        } else if occupied < self.free_thresh {
            Ground::Free
        } else {
            Ground::Unknown
        }
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

fn required<T>(key: &'static str, expected: &'static str, value: Option<T>) -> Result<T, Problem> {
    value.ok_or_else(|| wrong(key, expected, "nothing"))
}

fn wrong(key: &'static str, expected: &'static str, found: impl ToString) -> Problem {
    Problem::Key {
        key,
        expected,
        found: found.to_string(),
    }
}
