//! What can be wrong with a file of a scene.

use std::io;

use thiserror::Error;

use super::{LARGEST, LEVELS};
use crate::bytes::Unread;
use crate::options::OptionError;

/// Most bytes of a file that is read.
pub(super) const MOST_BYTES: u64 = 256 << 20;

/// Most points or corners of a file that are read: half a gigabyte at worst.
pub(super) const MOST_POINTS: usize = 1 << 24;

/// How far from the origin of its file a scene may lie, in voxels: as far as an octree
/// reaches.
pub(super) const FARTHEST: i64 = 1 << 15;

/// What is read.
const READ: &str = "an OctoMap .bt or .ot tree, a PCD or PLY point cloud, or a PLY or STL mesh";

/// A scene that cannot be had from a file, said so that the reader can mend it.
#[derive(Debug, Error)]
#[allow(missing_docs)] // each variant's message is its documentation
pub enum SceneError {
    #[error("no such file; expected {READ}")]
    Missing,
    #[error("cannot be read: {0}; check that it is a file that you may read")]
    Unreadable(#[from] io::Error),
    #[error("is no file but a folder or a device; expected {READ}")]
    NoFile,
    #[error("has more than {} MiB; expected {READ} of fewer", MOST_BYTES >> 20)]
    TooLong,
    #[error("is of no format that is known here; expected {READ}")]
    Unknown,
    #[error(
        "is not a complete OctoMap tree: {0}; expected {READ}: copy it again or export it again"
    )]
    BrokenTree(io::Error),
    #[error("{place} of the {format} file: {what}; copy it again or export it again")]
    Broken {
        format: &'static str,
        place: String,
        what: String,
    },
    #[error(
        "{found} {things} by its header; at most {MOST_POINTS} are read: thin it out, for example \
         with `pcl_voxel_grid`"
    )]
    TooMany { found: u64, things: &'static str },
    #[error("nothing in it is known; expected free and occupied voxels")]
    Empty,
    #[error("has no {0}; expected at least one")]
    Nothing(&'static str),
    #[error(
        "has no voxels of its own; give their side in metres, for example --voxel-size \
         {suggested}: it spans {:.1}×{:.1}×{:.1} m, its coordinates taken as metres", spans[0], spans[1], spans[2]
    )]
    NoVoxelSize { spans: [f64; 3], suggested: f64 },
    #[error(transparent)]
    Option(#[from] OptionError),
    #[error(
        "--free rays: the file does not say where its points were seen from; expected a PCD \
         file with a VIEWPOINT; or give --free rest"
    )]
    NoViewpoint,
    #[error(
        "lies {metres:.0} m from the origin of its coordinates, farther than {FARTHEST} voxels \
         of {voxel_size} m; give a larger --voxel-size, or move it there"
    )]
    FarAway { metres: f64, voxel_size: f64 },
    #[error(
        "its triangles are too many and too large for voxels of {voxel_size} m; give a larger \
         --voxel-size, or a simpler mesh"
    )]
    TooMuchWork { voxel_size: f64 },
    #[error(
        "--voxel-size {asked}: the voxels of the file are {resolution} m wide; expected a whole \
         number of these, such as {suggested}"
    )]
    VoxelSize {
        asked: f64,
        resolution: f64,
        suggested: f64,
    },
    #[error(
        "{width}×{height}×{levels} voxels of {voxel_size} m; expected at most \
         {LARGEST}×{LARGEST}×{LEVELS}: give --voxel-size {suggested} or more; coordinates of \
         files are taken as metres"
    )]
    Size {
        width: i64,
        height: i64,
        levels: i64,
        voxel_size: f64,
        suggested: f64,
    },
}

impl SceneError {
    /// A file that is not as its format has it, at some place.
    pub(super) fn broken(
        format: &'static str,
        place: impl Into<String>,
        what: impl Into<String>,
    ) -> Self {
        Self::Broken {
            format,
            place: place.into(),
            what: what.into(),
        }
    }
}

impl From<Unread> for SceneError {
    fn from(unread: Unread) -> Self {
        match unread {
            Unread::Missing => Self::Missing,
            Unread::NoFile => Self::NoFile,
            Unread::TooLong => Self::TooLong,
            Unread::Io(error) => Self::Unreadable(error),
        }
    }
}
