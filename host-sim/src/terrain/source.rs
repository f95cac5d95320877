//! Terrains by name: `gaussian:SEED`, `urban:SEED`, `town:SEED`, or a file.

use std::path::PathBuf;
use std::str::FromStr;

use super::{Scale, Terrain, TerrainOptions};
use crate::options::OptionError;
use crate::scene::Scene;

/// Where a terrain comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TerrainSource {
    /// Gaussian hills drawn by a seed.
    Gaussian(u64),
    /// A town drawn by a seed.
    Urban(u64),
    /// A town of voxels drawn by a seed: see [`TerrainSource::scene`].
    Town(u64),
    /// A picture, an elevation model in metres, or an OctoMap tree, of which the highest
    /// occupied voxel of each column counts: see [`Terrain::read`].
    File(PathBuf),
}

impl FromStr for TerrainSource {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let seed = |digits: &str| {
            digits
                .parse()
                .map_err(|_| format!("{digits:?} is not a seed, a number from 0"))
        };
        match text.split_once(':') {
            Some(("gaussian", digits)) => seed(digits).map(Self::Gaussian),
            Some(("town", digits)) => seed(digits).map(Self::Town),
            Some(("urban", digits)) => seed(digits).map(Self::Urban),
            _ => Ok(Self::File(text.into())),
        }
    }
}

impl TerrainSource {
    /// The scene, if this is one of voxels.
    pub fn scene(&self, side: u16) -> Option<Scene> {
        match self {
            Self::Town(seed) => Some(Scene::town(*seed, side)),
            _ => None,
        }
    }

    /// The terrain; a drawn one has `side`×`side` columns.
    ///
    /// # Errors
    /// The file is no terrain, or this is one of voxels.
    pub fn load(&self, side: u16) -> Result<Terrain, String> {
        self.load_with(side, &TerrainOptions::default())
    }

    /// The same with what is said of its metres.
    ///
    /// # Errors
    /// As [`load`](Self::load); or an option that does not apply.
    pub fn load_with(&self, side: u16, options: &TerrainOptions) -> Result<Terrain, String> {
        options.check().map_err(|error| error.to_string())?;
        let drawn = |terrain: Terrain| match options.metres_per_level {
            None => Ok(terrain.scaled(options.metres_per_cell.map(Scale::picture))),
            Some(_) => Err(OptionError::DoesNotApply {
                option: "--metres-per-level",
                what: "a terrain drawn by a seed",
            }
            .to_string()),
        };
        match self {
            Self::Gaussian(seed) => drawn(Terrain::gaussian(*seed, side)),
            Self::Town(_) => Err("a town has several voxels in a column".into()),
            Self::Urban(seed) => drawn(Terrain::urban(*seed, side)),
            Self::File(path) => {
                let terrain = Terrain::read(path, options);
                terrain.map_err(|error| format!("{}: {error}", path.display()))
            }
        }
    }
}
