//! Maps to explore: those that come with the lab, generated, or given by the user.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use host_sim::world::{Family, Problem, ReadOptions, Recipe, World};
use planner_core::{Cell, Extent};

/// An entry of [`BUILT_IN`].
macro_rules! built_in {
    ($name:literal, $file:literal) => {
        (
            $name,
            concat!("fixtures/maps/", $file),
            include_bytes!(concat!("../maps/", $file)),
        )
    };
}
/// Maps that come with the lab: name, file, content.
const BUILT_IN: [(&str, &str, &[u8]); 8] = [
    built_in!("office", "office.png"),
    built_in!("cave", "cave.map"),
    built_in!("circle", "circle.txt"),
    built_in!("blocks", "blocks.txt"),
    built_in!("labyrinth1", "labyrinth1.txt"),
    built_in!("labyrinth2", "labyrinth2.txt"),
    built_in!("maze", "maze.txt"),
    built_in!("ward", "ward.txt"),
];

/// Where a map comes from.
#[derive(Clone, Debug, PartialEq)]
pub enum Map {
    /// By its name; see [`Map::built_in`].
    BuiltIn(&'static str),
    /// Drawn by a seed.
    Generated {
        /// Kind of world.
        family: Family,
        /// Its size in cells.
        extent: Extent,
        /// Same seed, same world.
        seed: u64,
    },
    /// Opened, dropped, drawn by hand, or out of a trace or an address.
    Given(Arc<World>),
}

impl Map {
    /// Names of the maps that come with the lab.
    pub fn built_in() -> impl Iterator<Item = &'static str> {
        BUILT_IN.iter().map(|(name, ..)| *name)
    }

    /// The map of this name among those that come with the lab.
    pub fn named(name: &str) -> Option<Self> {
        let known = BUILT_IN.iter().find(|(known, ..)| *known == name);
        known.map(|(name, ..)| Self::BuiltIn(name))
    }

    /// A file of any format that host-sim reads.
    ///
    /// # Errors
    /// What is wrong with the file, in a sentence for the user.
    pub fn from_bytes(name: &str, bytes: &[u8]) -> Result<Self, String> {
        read(name, bytes).map(|world| Self::Given(Arc::new(world)))
    }

    /// The world.
    ///
    /// # Errors
    /// What is wrong, in a sentence for the user.
    pub fn world(&self) -> Result<Arc<World>, String> {
        match self {
            Self::BuiltIn(name) => {
                let (_, file, bytes) = entry(name);
                read(file, bytes).map(Arc::new)
            }
            Self::Generated {
                family,
                extent,
                seed,
            } => Recipe::new(*family, *extent, *seed)
                .generate()
                .map(Arc::new)
                .map_err(|error| error.to_string()),
            Self::Given(world) => Ok(world.clone()),
        }
    }

    /// The path of the map's file on the command line.
    pub fn file(&self) -> PathBuf {
        match self {
            Self::BuiltIn(name) => entry(name).1.into(),
            Self::Generated { family, seed, .. } => format!("{family}-{seed}.txt").into(),
            Self::Given(world) => format!("{}.txt", file_name(world.name())).into(),
        }
    }
}

/// A name without what a shell or a file system takes amiss.
pub(crate) fn file_name(name: &str) -> String {
    let fits = |c: char| c.is_ascii_alphanumeric() || "-_.".contains(c);
    name.chars()
        .map(|c| if fits(c) { c } else { '-' })
        .collect()
}

/// The world with these cells blocked or freed; one without a free cell stays as it is.
pub(crate) fn with_cell(world: &World, cell: Cell, blocked: bool) -> Option<World> {
    let name = world.name().trim_end_matches("-drawn");
    let is_blocked = |at: Cell| {
        if at == cell {
            blocked
        } else {
            !world.is_free(at)
        }
    };
    World::from_fn(format!("{name}-drawn"), world.extent(), is_blocked).ok()
}

fn entry(name: &str) -> &'static (&'static str, &'static str, &'static [u8]) {
    let found = BUILT_IN.iter().find(|(known, ..)| *known == name);
    found.unwrap_or(&BUILT_IN[0])
}

fn read(name: &str, bytes: &[u8]) -> Result<World, String> {
    let open = |path: &Path| match path == Path::new(name) {
        true => Ok(bytes.to_vec()),
        // The image that a map_server file names: a browser hands over one file.
        false => Err(Problem::Missing),
    };
    World::read_with(name, &ReadOptions::default(), open).map_err(|error| error.to_string())
}
