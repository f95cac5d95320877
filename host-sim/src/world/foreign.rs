//! Files that are no maps, or maps of a kind that is not read here: what they are, and
//! what to do with them.

/// What a file is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Foreign {
    /// With its article.
    pub what: &'static str,
    /// What to do.
    pub advice: &'static str,
}

const PICTURE: &str = "PNG and PGM pictures are read: convert it without loss, for example \
                       with `magick FILE map.png`";
const VOXELS: &str = "`host-sim survey --terrain FILE.bt` flies over it (octomap's \
                      `convert_octree` makes .bt of .ot); to explore a floor of it, let \
                      octomap_server project it and map_saver save it";
const POINTS: &str = "a map of cells is read: let octomap_server make one of the points and \
                      map_saver save it";
const DRAWING: &str = "PNG and PGM pictures are read: export the drawing as PNG, black walls \
                       on white ground";
const RECORDING: &str = "play it to a mapping node and let map_saver save the map";
const UNPACK: &str = "unpack it first";

/// Kinds by their first bytes.
const BEGINNINGS: [(&[u8], Foreign); 31] = {
    const fn of(what: &'static str, advice: &'static str) -> Foreign {
        Foreign { what, advice }
    }
    [
        (b"BM", of("a BMP picture", PICTURE)),
        (b"\xff\xd8\xff", of("a JPEG picture", PICTURE)),
        (b"II*\0", of("a TIFF picture", PICTURE)),
        (b"MM\0*", of("a TIFF picture", PICTURE)),
        (b"GIF8", of("a GIF picture", PICTURE)),
        (b"RIFF", of("a WebP picture", PICTURE)),
        (b"\0\0\x01\0", of("an ICO picture", PICTURE)),
        (b"qoif", of("a QOI picture", PICTURE)),
        (b"gimp xcf", of("a GIMP picture (XCF)", DRAWING)),
        (b"8BPS", of("a Photoshop picture", DRAWING)),
        (b"%PDF", of("a PDF document", DRAWING)),
        (b"<svg", of("an SVG drawing", DRAWING)),
        (b"<?xml", of("an XML file", DRAWING)),
        (
            b"# Octomap OcTree binary",
            of("an OctoMap tree of voxels (.bt)", VOXELS),
        ),
        (
            b"# Octomap OcTree",
            of("an OctoMap tree of voxels (.ot)", VOXELS),
        ),
        (b"# .PCD", of("a point cloud (PCD)", POINTS)),
        (b"VERSION .7", of("a point cloud (PCD)", POINTS)),
        (b"VERSION 0.7", of("a point cloud (PCD)", POINTS)),
        (b"ply\n", of("a point cloud or mesh (PLY)", POINTS)),
        (b"ply\r", of("a point cloud or mesh (PLY)", POINTS)),
        (b"LASF", of("a point cloud (LAS)", POINTS)),
        (b"#ROSBAG", of("a ROS bag", RECORDING)),
        (
            b"SQLite format 3",
            of("a database, perhaps a ROS 2 bag", RECORDING),
        ),
        (b"PK\x03\x04", of("a ZIP archive", UNPACK)),
        (b"\x1f\x8b", of("a gzip archive", UNPACK)),
        (
            b"version https://git-lfs",
            of(
                "a Git LFS pointer, not the file itself",
                "run `git lfs pull`",
            ),
        ),
        (
            b"<!DOCTYPE html",
            of(
                "a web page",
                "download the file itself (on GitHub: \"Raw\")",
            ),
        ),
        (
            b"<html",
            of(
                "a web page",
                "download the file itself (on GitHub: \"Raw\")",
            ),
        ),
        (
            b"{\"format\":\"host-sim",
            of("the trace of a run", "open it in the lab, or name the map"),
        ),
        (b"o---", MICROMOUSE),
        (b"+---", MICROMOUSE),
    ]
};

const MICROMOUSE: Foreign = Foreign {
    what: "a micromouse maze, with walls between its cells",
    advice: "in a text map a wall takes cells of its own: draw each post and wall as `#`, \
             each cell and opening as `.`, one character each",
};

/// Kinds by the ending of the file's name, for files whose bytes do not tell.
const ENDINGS: [(&[&str], Foreign); 9] = {
    const fn of(what: &'static str, advice: &'static str) -> Foreign {
        Foreign { what, advice }
    }
    [
        (&["bmp"], of("a BMP picture", PICTURE)),
        (&["jpg", "jpeg"], of("a JPEG picture", PICTURE)),
        (&["tif", "tiff"], of("a TIFF picture", PICTURE)),
        (&["gif"], of("a GIF picture", PICTURE)),
        (&["webp"], of("a WebP picture", PICTURE)),
        (&["bt", "ot"], of("an OctoMap tree of voxels", VOXELS)),
        (
            &["pcd", "ply", "las", "laz", "xyz", "e57", "pts"],
            of("a point cloud", POINTS),
        ),
        (&["bag", "db3", "mcap"], of("a ROS bag", RECORDING)),
        (&["svg", "dxf", "pdf"], of("a drawing", DRAWING)),
    ]
};

impl Foreign {
    /// What a file is by its first bytes, if that is known and not read here.
    pub(crate) fn of_bytes(bytes: &[u8]) -> Option<Self> {
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        let begins = |begin: &[u8]| match begin {
            b"RIFF" => bytes.starts_with(begin) && bytes.get(8..12) == Some(b"WEBP"),
            _ => bytes.starts_with(begin),
        };
        let found = BEGINNINGS.iter().find(|(begin, _)| begins(begin));
        found.map(|&(_, foreign)| foreign)
    }

    /// What a file is by its ending, in lower case and without the dot.
    pub(crate) fn of_ending(ending: &str) -> Option<Self> {
        let found = ENDINGS.iter().find(|(names, _)| names.contains(&ending));
        found.map(|&(_, foreign)| foreign)
    }
}

/// The picture that a file holds, if it is one that is read.
pub(super) fn picture(bytes: &[u8]) -> Option<&'static str> {
    match bytes {
        [0x89, b'P', b'N', b'G', ..] => Some("PNG"),
        // A blank after the digit: a text may begin with P and a digit.
        [b'P', b'1'..=b'7', b'\n' | b'\r' | b' ' | b'\t' | b'#', ..] => Some("PGM"),
        _ => None,
    }
}
