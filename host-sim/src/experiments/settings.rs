//! What a comparison follows from, and the file that says so beside its results.

use std::fs;
use std::hash::{DefaultHasher, Hasher};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use planner_core::Extent;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use sha2::{Digest, Sha256};
use thiserror::Error;

use super::journal::PARTS;
use super::order::Order;
use super::plan::{Place, Plan, Site};
use super::row::Metric;
use super::statistics::{Axes, Conditions, in_order};
use crate::files;
use crate::planners::PlannerKind;
use crate::scenario::{MediumKind, Preset, Trouble};
use crate::world::{Family, Recipe, World};

/// The plan file's name in an output folder.
const FILE: &str = "plan.json";
/// Longest value that a message quotes, in characters.
const QUOTE: usize = 60;

/// The settings of a comparison under the names of the options that make them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub struct Settings {
    /// Worlds that were read from files.
    pub maps: Vec<GivenMap>,
    /// Families of worlds that are generated.
    pub families: Vec<Family>,
    /// Worlds of each family.
    pub worlds: u64,
    /// Width and height of generated worlds in cells.
    pub size: (u16, u16),
    /// Planners, the reference among them.
    pub planners: Vec<PlannerKind>,
    /// The planner that the others are measured by.
    pub reference: PlannerKind,
    /// Numbers of robots.
    pub robots: Vec<u8>,
    /// How robots are placed.
    pub place: Place,
    /// Placings in each world.
    pub starts: u32,
    /// What carries messages.
    pub medium: MediumKind,
    /// Ticks between two exchanges.
    pub sync: Vec<u32>,
    /// Shares of messages lost.
    pub loss: Vec<f64>,
    /// Sensor ranges in cells.
    pub range: Vec<u8>,
    /// How the worlds mislead robots.
    pub trouble: Trouble,
    /// What the explorer takes its sensors for.
    pub preset: Preset,
    /// First seed of the worlds, and seed of placings, losses and trouble.
    pub seed: u64,
    /// What is compared.
    pub metric: Metric,
    /// Whether no row is kept.
    pub summary_only: bool,
    /// Which program does the runs: another one may decide otherwise.
    pub program: String,
}

/// A world that was read from a file, by what it is rather than by where it lay.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct GivenMap {
    /// Its name in tables.
    pub name: String,
    /// Columns.
    pub width: u16,
    /// Rows.
    pub height: u16,
    /// SHA-256 of its cells and starts.
    pub sha256: String,
}

/// An output folder that is not for these settings.
#[derive(Debug, Error)]
pub enum PlanError {
    /// See the message.
    #[error("{}: {problem}", path.display())]
    Io {
        /// Which file.
        path: PathBuf,
        /// What went wrong.
        problem: io::Error,
    },
    /// See the message.
    #[error("{}: {problem}; it was written by another version, or is no plan", path.display())]
    Format {
        /// Which file.
        path: PathBuf,
        /// What went wrong.
        problem: serde_json::Error,
    },
    /// See the message.
    #[error(
        "{}: {setting} is {found} there and {wanted} here; take the folder's settings, or \
         another folder (--out)",
        path.display()
    )]
    Differs {
        /// Which file.
        path: PathBuf,
        /// Which setting, as an option.
        setting: String,
        /// Its value in the file, cut short if it is long.
        found: String,
        /// Its value now.
        wanted: String,
    },
    /// See the message.
    #[error("{} is missing: {problem}", path.display())]
    Missing {
        /// Which file.
        path: PathBuf,
        /// What that means.
        problem: &'static str,
    },
}

impl GivenMap {
    /// That of a world.
    pub fn of(world: &World) -> Self {
        let Extent { width, height } = world.extent();
        let text = format!("{}{:?}", world.to_text(), world.starts());
        Self {
            name: world.name().into(),
            width,
            height,
            sha256: hex(&Sha256::digest(text)),
        }
    }
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Tells this program from others, older and newer ones too.
///
/// # Errors
/// Its file cannot be read.
pub fn this_program() -> io::Result<String> {
    let mut hasher = DefaultHasher::new();
    hasher.write(&fs::read(std::env::current_exe()?)?);
    Ok(format!("{:016x}", hasher.finish()))
}

impl Settings {
    /// The runs, in `maps` and in generated worlds.
    pub fn plan(&self, maps: impl IntoIterator<Item = Arc<World>>) -> Plan {
        let given = maps.into_iter().map(Site::Given);
        Plan {
            sites: given.chain(self.recipes().map(Site::Generated)).collect(),
            planners: self.planners.clone(),
            robots: self.robots.clone(),
            place: self.place,
            starts: self.starts,
            medium: self.medium,
            syncs: self.sync.clone(),
            losses: self.loss.clone(),
            ranges: self.range.clone(),
            trouble: self.trouble,
            preset: self.preset,
            seed: self.seed,
        }
    }

    /// World by world rather than family by family: an interrupted comparison has some runs
    /// of every family.
    fn recipes(&self) -> impl Iterator<Item = Recipe> {
        let (width, height) = self.size;
        let seeds = self.seed..self.seed + self.worlds;
        seeds.flat_map(move |seed| {
            let families = self.families.iter();
            families.map(move |&family| Recipe::new(family, Extent::new(width, height), seed))
        })
    }

    /// The places of the runs, without the worlds.
    pub fn order(&self) -> Order {
        let maps = self.maps.iter();
        let given = maps.map(|map| (map.name.clone(), Extent::new(map.width, map.height)));
        let generated = self.recipes().map(Site::Generated);
        let generated = generated.map(|site| (site.name(), site.extent()));
        Order::new(given.chain(generated), &self.plan([]).setups())
    }

    /// What the tables have.
    pub fn axes(&self) -> Axes {
        let families = self.families.iter().map(ToString::to_string);
        let generated = families.filter(|_| self.worlds > 0);
        Axes {
            conditions: in_order(&self.plan([]).setups(), Conditions::of_setup),
            planners: self.planners.clone(),
            families: self
                .maps
                .iter()
                .map(|map| map.name.clone())
                .chain(generated)
                .collect(),
            robots: self.robots.clone(),
        }
        .sorted()
    }

    /// Makes an output folder that of these settings, with a plan file, unless it is so
    /// already.
    ///
    /// # Errors
    /// A folder of other settings, of which the error names the first that differs; one
    /// with runs and without a plan file; one that cannot be written to.
    pub fn claim(&self, out: &Path) -> Result<(), PlanError> {
        let path = out.join(FILE);
        if !path.exists() {
            if out.join(PARTS).exists() {
                return Err(PlanError::Missing {
                    path,
                    problem: "the folder holds runs of unknown settings; choose another with --out",
                });
            }
            let text = serde_json::to_string_pretty(self).expect("settings are plain");
            let written = fs::create_dir_all(out)
                .and_then(|()| files::write_new(&path, format!("{text}\n").as_bytes()));
            if let Err(problem) = written {
                return Err(PlanError::Io { path, problem });
            }
        }
        // Somebody else may have been quicker.
        self.must_be_those_of(out)
    }

    /// The settings in the plan file of a folder.
    ///
    /// # Errors
    /// No such file, or one that cannot be read.
    pub fn read(out: &Path) -> Result<Self, PlanError> {
        let path = out.join(FILE);
        let text = match fs::read_to_string(&path) {
            Ok(text) => text,
            Err(problem) if problem.kind() == io::ErrorKind::NotFound => {
                return Err(PlanError::Missing {
                    path,
                    problem: "that is no folder of a comparison",
                });
            }
            Err(problem) => return Err(PlanError::Io { path, problem }),
        };
        serde_json::from_str(&text).map_err(|problem| PlanError::Format { path, problem })
    }

    /// Whether a folder's plan file has these settings.
    ///
    /// # Errors
    /// The first setting that differs; a file that cannot be read.
    pub fn must_be_those_of(&self, out: &Path) -> Result<(), PlanError> {
        let value = |settings: &Self| serde_json::to_value(settings).expect("settings are plain");
        match difference("", &value(&Self::read(out)?), &value(self)) {
            None => Ok(()),
            Some((setting, found, wanted)) => Err(PlanError::Differs {
                path: out.join(FILE),
                setting,
                found: quote(&found),
                wanted: quote(&wanted),
            }),
        }
    }
}

/// The first field in which two values differ, as an option.
fn difference(name: &str, found: &Value, wanted: &Value) -> Option<(String, Value, Value)> {
    match (found, wanted) {
        (Value::Object(found), Value::Object(wanted)) => wanted
            .iter()
            .find_map(|(key, value)| difference(key, found.get(key)?, value)),
        _ if found == wanted => None,
        _ => {
            let option = match name {
                "maps" | "program" => format!("the {}", name.trim_end_matches('s')),
                name => format!("--{}", name.replace('_', "-")),
            };
            Some((option, found.clone(), wanted.clone()))
        }
    }
}

fn quote(value: &Value) -> String {
    let text = value.to_string();
    match text.char_indices().nth(QUOTE) {
        None => text,
        Some((end, _)) => format!("{}…", &text[..end]),
    }
}
