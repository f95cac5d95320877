//! Terrains by name: `gaussian:SEED`, `urban:SEED`, `town:SEED`, or a file.

use std::fs::File;
use std::io::BufReader;
use std::path::PathBuf;
use std::str::FromStr;

use planner_core::Extent;
use planner_core::surface::Height;

use super::octree::OcTree;
use super::terrain::Terrain;
use super::voxels::Scene;

/// Where a terrain comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TerrainSource {
    /// Gaussian hills drawn by a seed.
    Gaussian(u64),
    /// A town drawn by a seed.
    Urban(u64),
    /// A town of voxels drawn by a seed: see [`TerrainSource::scene`].
    Town(u64),
    /// An image whose grey values are heights in quarters of a cell, or an OctoMap
    /// `.bt` file, of which the highest occupied voxel of each column counts.
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
    pub fn load(&self, side: u16) -> Result<Terrain, String> {
        match self {
            Self::Gaussian(seed) => Ok(Terrain::gaussian(*seed, side)),
            Self::Town(_) => Err("a town has several voxels in a column".into()),
            Self::Urban(seed) => Ok(Terrain::urban(*seed, side)),
            Self::File(path) => {
                let read = if path.extension().is_some_and(|extension| extension == "bt") {
                    from_octree(path)
                } else {
                    from_image(path)
                };
                let name = path.file_stem().unwrap_or_default().to_string_lossy();
                read.map(|terrain| terrain.named(name))
                    .map_err(|reason| format!("{}: {reason}", path.display()))
            }
        }
    }
}

/// Columns along the longest side of a map.
pub(super) const LARGEST: u32 = 512;

fn from_image(path: &PathBuf) -> Result<Terrain, String> {
    let image = image::open(path)
        .map_err(|error| error.to_string())?
        .into_luma8();
    let extent = fitting(image.width(), image.height())?;
    Ok(Terrain::from_fn(extent, |cell| {
        Height(image.get_pixel(cell.x as u32, cell.y as u32).0[0])
    }))
}

fn from_octree(path: &PathBuf) -> Result<Terrain, String> {
    let file = File::open(path).map_err(|error| error.to_string())?;
    let tree = OcTree::read(BufReader::new(file)).map_err(|error| error.to_string())?;
    let cubes: Vec<_> = tree
        .cubes()
        .into_iter()
        .filter(|cube| cube.occupied)
        .collect();
    let low = |axis: usize| cubes.iter().map(|cube| cube.corner[axis]).min();
    let high = |axis: usize| cubes.iter().map(|cube| cube.corner[axis] + cube.side).max();
    let (Some(west), Some(east), Some(north), Some(south), Some(floor)) =
        (low(0), high(0), low(1), high(1), low(2))
    else {
        return Err("no voxel is occupied".into());
    };
    let extent = fitting(west.abs_diff(east), north.abs_diff(south))?;
    let mut heights = vec![Height(0); extent.cells() as usize];
    for cube in cubes {
        let top = Height::from_cells((cube.corner[2] + cube.side - floor) as f32);
        for y in cube.corner[1]..cube.corner[1] + cube.side {
            for x in cube.corner[0]..cube.corner[0] + cube.side {
                let index = (y - north) as usize * usize::from(extent.width) + (x - west) as usize;
                heights[index] = heights[index].max(top);
            }
        }
    }
    Ok(Terrain::from_fn(extent, |cell| {
        heights[cell.y as usize * usize::from(extent.width) + cell.x as usize]
    }))
}

fn fitting(width: u32, height: u32) -> Result<Extent, String> {
    if width == 0 || height == 0 || width > LARGEST || height > LARGEST {
        return Err(format!(
            "{width}×{height} columns; 1 to {LARGEST} on a side are possible"
        ));
    }
    Ok(Extent::new(width as u16, height as u16))
}
