//! Scenes out of files: OctoMap trees, point clouds and meshes, told apart by their content.

use std::path::Path;

use planner_core::Extent;
use planner_core::volume::{Content, Voxel};

use super::error::MOST_BYTES;
use super::octree::{Cube, OcTree};
use super::pcd::{from_pcd, is_pcd};
use super::ply::{from_ply, is_ply};
use super::stl::{from_stl, is_stl};
use super::{Frame, Free, LARGEST, LEVELS, Scene, SceneError};
use crate::bytes;
use crate::options::{OptionError, none_given};

/// How far from a whole number of the file's voxels a side may be, as a share of one.
const SLACK: f64 = 1e-6;

/// How the voxels of a file are made.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SceneOptions {
    /// Their side in metres; of a tree its own unless something else is said.
    pub voxel_size: Option<f64>,
    /// What of a cloud or a mesh is free; [`Free::Rest`] if nothing is said.
    pub free: Option<Free>,
    /// Free metres about the bounding box of a cloud or a mesh, but beneath it.
    pub margin: Option<f64>,
}

impl Scene {
    /// Reads a scene from a file, called like the file.
    ///
    /// # Errors
    /// [`SceneError`] says what is wrong and what to do.
    pub fn read(path: &Path, options: &SceneOptions) -> Result<Self, SceneError> {
        let bytes = bytes::read(path, MOST_BYTES)?;
        let ending = path.extension().unwrap_or_default().to_string_lossy();
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        Ok(Self::from_bytes(&bytes, &ending, options)?.named(name))
    }

    /// A scene out of what a file holds; the `ending` of its name, without the dot, tells
    /// what it is if its content does not.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn from_bytes(
        bytes: &[u8],
        ending: &str,
        options: &SceneOptions,
    ) -> Result<Self, SceneError> {
        if OcTree::is_tree(bytes) {
            check_for_tree(options)?;
            let tree = OcTree::read(bytes).map_err(SceneError::BrokenTree)?;
            return Self::of_tree(&tree, options.voxel_size);
        }
        let shape = match () {
            () if is_pcd(bytes) => from_pcd(bytes)?,
            () if is_ply(bytes) => from_ply(bytes)?,
            () if is_stl(bytes, ending) => from_stl(bytes)?,
            () => return Err(SceneError::Unknown),
        };
        shape.scene(options)
    }

    /// What a tree knows, and a rim of the unknown about it. A voxel of several of the
    /// tree's is occupied if any of them is, else free if any is, as OctoMap has it.
    ///
    /// # Errors
    /// Nothing is known, the voxels do not fit into the tree's, or are too many.
    pub fn of_tree(tree: &OcTree, voxel_size: Option<f64>) -> Result<Self, SceneError> {
        let resolution = tree.resolution();
        let factor = match voxel_size {
            None => 1,
            Some(asked) => factor(asked, resolution)?,
        };
        let voxel_size = voxel_size.unwrap_or(resolution);
        let low = |cube: &Cube| cube.corner.map(|at| at.div_euclid(factor));
        let high = |cube: &Cube| (cube.corner).map(|at| (at + cube.side - 1).div_euclid(factor));
        let cubes = tree.cubes();
        let mut bounds: Option<Bounds> = None;
        for cube in &cubes {
            let of_cube = [low(cube), high(cube)];
            bounds = Some(bounds.map_or(of_cube, |bounds| joined(bounds, of_cube)));
        }
        let bounds = bounds.ok_or(SceneError::Empty)?;
        let mut scene = Self::within(bounds, voxel_size)?;
        let corner = bounds[0].map(|at| at - RIM);
        for cube in &cubes {
            let from = |at: [i32; 3]| [0, 1, 2].map(|axis| (at[axis] - corner[axis]) as i16);
            let content = match cube.occupied {
                true => Content::Occupied,
                false => Content::Free,
            };
            scene.add(from(low(cube)), from(high(cube)), content);
        }
        Ok(scene)
    }

    /// A scene of which nothing is known, about so many voxels and a rim.
    ///
    /// # Errors
    /// It would be too large.
    pub(super) fn within([low, high]: Bounds, voxel_size: f64) -> Result<Self, SceneError> {
        let side =
            |axis: usize| i64::from(high[axis]) - i64::from(low[axis]) + 1 + 2 * i64::from(RIM);
        let [width, height, levels] = [0, 1, 2].map(side);
        let times = |side: i64, most: i64| (side + most - 1) / most;
        let most = i64::from(LARGEST);
        let coarser = times(width, most)
            .max(times(height, most))
            .max(times(levels, LEVELS.into()));
        if coarser > 1 {
            return Err(SceneError::Size {
                width,
                height,
                levels,
                voxel_size,
                suggested: voxel_size * coarser as f64,
            });
        }
        let extent = Extent::new(width as u16, height as u16);
        let scene = Self::from_contents("scene", extent, levels as u8, |_| Content::Unknown);
        Ok(scene.framed(Some(Frame {
            voxel_size,
            corner: low.map(|at| at - RIM),
        })))
    }

    /// Adds to what is known of the cuboid between two corners, both included; something
    /// occupied stays.
    pub(super) fn add(&mut self, low: [i16; 3], high: [i16; 3], content: Content) {
        for z in low[2]..=high[2] {
            for y in low[1]..=high[1] {
                for x in low[0]..=high[0] {
                    if let Some(index) = self.index(Voxel::new(x, y, z))
                        && self.contents[index] != Content::Occupied
                    {
                        self.contents[index] = content;
                    }
                }
            }
        }
    }
}

/// # Errors
/// An option that a tree leaves no room for: it says itself what is free.
fn check_for_tree(options: &SceneOptions) -> Result<(), OptionError> {
    let given = [
        ("--free", options.free.is_some()),
        ("--margin", options.margin.is_some()),
    ];
    none_given(given, "an OctoMap tree, which says itself what is free")
}

/// Voxels of the unknown about all that is known: nobody flies along the end of a scan.
const RIM: i32 = 1;

/// Lowest and highest coordinates.
type Bounds = [[i32; 3]; 2];

fn joined(a: Bounds, b: Bounds) -> Bounds {
    [
        [0, 1, 2].map(|axis| a[0][axis].min(b[0][axis])),
        [0, 1, 2].map(|axis| a[1][axis].max(b[1][axis])),
    ]
}

/// How many voxels of `resolution` metres are along one of `asked` metres.
fn factor(asked: f64, resolution: f64) -> Result<i32, SceneError> {
    let times = asked / resolution;
    let whole = times.round().clamp(1.0, f64::from(1 << 16));
    match (times - whole).abs() <= SLACK * whole {
        true => Ok(whole as i32),
        false => Err(SceneError::VoxelSize {
            asked,
            resolution,
            suggested: rounded(whole * resolution),
        }),
    }
}

/// Without the last digits of a product.
fn rounded(metres: f64) -> f64 {
    (metres * 1e6).round() / 1e6
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tree(voxels: &[([i32; 3], bool)]) -> OcTree {
        let mut tree = OcTree::new(0.1);
        for &(voxel, occupied) in voxels {
            tree.insert(voxel, occupied);
        }
        tree
    }

    #[test]
    fn what_is_known_lies_where_it_lay_with_a_rim_about_it() {
        let tree = tree(&[([-3, 2, 0], true), ([-1, 2, 1], false)]);
        let scene = Scene::of_tree(&tree, None).unwrap();
        assert_eq!((scene.extent(), scene.levels()), (Extent::new(5, 3), 4));
        let frame = scene.frame().unwrap();
        assert_eq!((frame.voxel_size, frame.corner), (0.1, [-4, 1, -1]));
        for voxel in scene.voxels() {
            let content = match frame.key(voxel) {
                [-3, 2, 0] => Content::Occupied,
                [-1, 2, 1] => Content::Free,
                _ => Content::Unknown,
            };
            assert_eq!(scene.content(voxel), Some(content), "{voxel}");
            assert_eq!(frame.voxel(frame.middle(voxel)), Some(voxel));
        }
    }

    /// Where the lower ends of the file's voxels are negative, too.
    #[test]
    fn coarser_voxels_are_occupied_if_any_of_theirs_is_else_free_if_any_is() {
        let tree = tree(&[
            ([-2, 0, 0], true),
            ([-1, 1, 0], false),
            ([0, 0, 0], false),
            ([3, 0, 0], true),
            ([6, 0, 0], false),
        ]);
        let scene = Scene::of_tree(&tree, Some(0.2)).unwrap();
        let row: Vec<_> = (0..7).map(|x| scene.content(Voxel::new(x, 1, 1))).collect();
        use Content::{Free, Occupied, Unknown};
        let expected = [Unknown, Occupied, Free, Occupied, Unknown, Free, Unknown];
        assert_eq!(row, expected.map(Some));
        assert_eq!(scene.frame().unwrap().corner, [-2, -1, -1]);
    }

    #[test]
    fn what_does_not_fit_is_refused_with_what_would() {
        let error = |tree: &OcTree, size| Scene::of_tree(tree, size).unwrap_err().to_string();
        assert!(error(&tree(&[]), None).contains("nothing in it is known"));
        let small = tree(&[([0, 0, 0], false)]);
        for (size, words) in [
            (0.16, "such as 0.2"),
            (0.05, "such as 0.1"),
            (1e9, "such as"),
        ] {
            assert!(error(&small, Some(size)).contains(words), "{size}");
        }
        let wide = tree(&[([0, 0, 0], false), ([0, 600, 0], true)]);
        assert!(error(&wide, None).contains("3×603×3 voxels"));
        assert!(error(&wide, None).contains("--voxel-size 0.2"));
        assert!(Scene::of_tree(&wide, Some(0.2)).is_ok());
        let options = SceneOptions::default();
        let error = Scene::from_bytes(b"LASF", "las", &options).unwrap_err();
        assert!(
            error.to_string().contains("an OctoMap .bt or .ot tree"),
            "{error}"
        );
    }
}
