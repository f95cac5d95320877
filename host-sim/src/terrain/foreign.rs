//! Files of formats that are not read, by what they begin with or by their ending: a
//! name for the reader, and a way to what is read.

/// A format that is not read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Foreign {
    /// What it is, with its article.
    pub(super) name: &'static str,
    /// How to come to a file that is read.
    pub(super) advice: &'static str,
}

const SCENE: &str = "survey it voxel by voxel: `--scene FILE --voxel-size M`, in metres";
const GREYS: &str = "save it as a PNG of 8-bit greys, for example `magick IN -colorspace gray \
                     -depth 8 OUT.png`";
const CLOUD: &str = "make an octree of it, for example with ROS's octomap_server and \
                     octomap_saver, and give its .bt file";
const MESH: &str = "make voxels of it and an octree of these: `binvox IN`, then `binvox2bt \
                    IN.binvox`, and give the .bt file";
const RASTER: &str = "make an ASCII grid of its heights in metres, of at most 512×512 cells: \
                      `gdal_translate -of AAIGrid -outsize 512 0 IN OUT.asc`";
const MAP: &str = "`host-sim explore` reads it; a survey needs heights";
const PACKED: &str = "unpack it and give the file in it";

/// What files begin with.
const BEGINNINGS: [(&[u8], &str, &str); 21] = [
    (b"# .PCD", "a PCD point cloud", SCENE),
    (b"VERSION .7", "a PCD point cloud", SCENE),
    (b"VERSION 0.7", "a PCD point cloud", SCENE),
    (b"LASF", "a LAS point cloud", CLOUD),
    (b"ASTM-E57", "an E57 point cloud", CLOUD),
    (b"ply\n", "a PLY mesh or point cloud", SCENE),
    (b"ply\r", "a PLY mesh or point cloud", SCENE),
    (b"solid ", "an STL mesh", SCENE),
    (b"glTF", "a glTF mesh", MESH),
    (b"#VRML", "a VRML mesh", MESH),
    (b"#binvox", "a binvox volume", MESH),
    (b"OFF\n", "an OFF mesh", MESH),
    (b"\xff\xd8\xff", "a JPEG picture", GREYS),
    (b"BM", "a BMP picture", GREYS),
    (b"GIF8", "a GIF picture", GREYS),
    (b"RIFF", "a WebP picture", GREYS),
    (b"%PDF", "a PDF document", GREYS),
    (
        b"{",
        "a JSON file or a trace",
        "give the terrain that was flown over",
    ),
    (b"\x1f\x8b", "a compressed file", PACKED),
    (b"PK\x03\x04", "a compressed file", PACKED),
    (b"SQLite format 3\0", "a bag or a database", CLOUD),
];

/// Endings of what cannot be told by its beginning.
const ENDINGS: [(&str, &str, &str); 12] = [
    ("pcd", "a PCD point cloud", SCENE),
    ("xyz", "a point cloud", CLOUD),
    ("laz", "a LAS point cloud", CLOUD),
    ("bag", "a ROS bag", CLOUD),
    ("stl", "an STL mesh", SCENE),
    ("obj", "an OBJ mesh", MESH),
    ("dae", "a COLLADA mesh", MESH),
    ("hgt", "a raster of heights", RASTER),
    ("yaml", "a flat map", MAP),
    ("yml", "a flat map", MAP),
    ("map", "a flat map", MAP),
    ("txt", "a flat map", MAP),
];

/// What a file is that is not read, if that can be told. `ending` without its dot.
pub(super) fn foreign(bytes: &[u8], ending: &str) -> Option<Foreign> {
    let begins = BEGINNINGS.iter().find(|(it, ..)| bytes.starts_with(it));
    let ends = || {
        ENDINGS
            .iter()
            .find(|(it, ..)| ending.eq_ignore_ascii_case(it))
    };
    let of = |name, advice| Foreign { name, advice };
    begins
        .map(|&(_, name, advice)| of(name, advice))
        .or_else(|| ends().map(|&(_, name, advice)| of(name, advice)))
}
