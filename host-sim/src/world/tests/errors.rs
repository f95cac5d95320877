//! Each error names the file, the place, what was expected and what to do.

use std::fs;

use crate::world::{Family, Recipe, Starts, WorldError};

use super::*;

/// The message on reading a file called `name` with these bytes.
fn message(name: &str, bytes: impl AsRef<[u8]>) -> String {
    message_with(name, bytes, &ReadOptions::default())
}

/// The message, with the file's folder cut away.
fn message_with(name: &str, bytes: impl AsRef<[u8]>, options: &ReadOptions) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    let message = World::read(&path, options).unwrap_err().to_string();
    let file = path.display().to_string();
    assert!(message.starts_with(&file), "{message}");
    message.replace(
        &format!("{}{}", folder.path().display(), std::path::MAIN_SEPARATOR),
        "",
    )
}

#[track_caller]
fn assert_says(message: &str, parts: &[&str]) {
    for part in parts {
        assert!(message.contains(part), "no `{part}` in: {message}");
    }
}

#[test]
fn files_that_are_not_there_or_not_files() {
    let folder = tempfile::tempdir().unwrap();
    let missing = World::read(folder.path().join("no.png"), &pixels(1)).unwrap_err();
    assert_says(
        &missing.to_string(),
        &["no.png: no such file", "check the path"],
    );
    let path = folder.path().join("folder.map");
    fs::create_dir(&path).unwrap();
    let unreadable = World::read(path, &pixels(1)).unwrap_err();
    assert_says(
        &unreadable.to_string(),
        &["folder.map: is a folder", "name a map file"],
    );
    let unwritable = world(&["."])
        .write(folder.path().join("no/a.png"), 1)
        .unwrap_err();
    assert_says(
        &unwritable.to_string(),
        &["a.png: cannot be written", "folder exists"],
    );
}

#[test]
fn endings() {
    assert_says(
        &message("a.jpg", ""),
        &["a.jpg: unknown ending `jpg`", ".png, .pgm, .yaml"],
    );
    let written = world(&["."]).write("a.yaml", 1).unwrap_err().to_string();
    assert_says(
        &written,
        &["a.yaml: unknown ending `yaml`", ".png, .pgm, .map or .txt"],
    );
}

#[test]
fn broken_images() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    world(&["..#.", "...."]).write(&path, 40).unwrap();
    let whole = fs::read(path).unwrap();
    let truncated = message("a.png", &whole[..whole.len() / 2]);
    assert_says(
        &truncated,
        &[
            "a.png: is not a complete image",
            "whole PNG",
            "export it again",
        ],
    );
    assert_says(
        &message("a.pgm", "hello"),
        &["a.pgm: is not a complete image"],
    );
    assert_says(
        &message_with("a.png", &whole, &pixels(0)),
        &["--pixels-per-cell is 0"],
    );
    let vast = world(&["...."])
        .write("a.png", 5000)
        .unwrap_err()
        .to_string();
    assert_says(&vast, &["--pixels-per-cell 5000", "4096 or less"]);
    let metric = message_with("a.png", &whole, &metres(0.5));
    assert_says(
        &metric,
        &[
            "has no resolution",
            "--cell-size 0.5",
            "use --pixels-per-cell",
        ],
    );
}

#[test]
fn maps_without_free_cells() {
    assert_says(&message("a.txt", "##\n##\n"), &["a.txt: has no free cell"]);
    assert_says(&message("a.txt", "\n"), &["a.txt: has no cell at all"]);
    assert_says(
        &message("a.pgm", b"P5\n1 1\n255\n\x00"),
        &["has no free cell", "light and dark"],
    );
}

#[test]
fn maps_that_are_too_large() {
    let image = image::GrayImage::new(1030, 20);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    image.save(&path).unwrap();
    let error = World::read(path, &pixels(1)).unwrap_err().to_string();
    assert_says(
        &error,
        &[
            "1030×20 cells",
            "512×512",
            "use --pixels-per-cell 3 or more",
        ],
    );
    let text = message("a.txt", ".".repeat(513));
    assert_says(&text, &["513×1 cells", "512×512", "use --pixels-per-cell"]);
}

#[test]
fn text_maps() {
    let ragged = message("a.txt", "...\n..\n");
    assert_says(
        &ragged,
        &[
            "a.txt: line 2: expected a row of 3 cells, found 2",
            "equally long",
        ],
    );
    let unknown = message("a.txt", "...\n.?.\n");
    assert_says(
        &unknown,
        &[
            "line 2, column 2",
            "unknown character '?'",
            "`#` (obstacle)",
        ],
    );
    assert_says(
        &message("a.txt", "1.\n.1\n"),
        &["line 2, column 2", "start 1", "second time"],
    );
    assert_says(
        &message("a.txt", b"\xff\xfe"),
        &["a.txt: is not UTF-8", "expected a text map"],
    );
    assert_says(
        &message_with("a.txt", ".", &metres(1.0)),
        &["has no resolution"],
    );
}

#[test]
fn movingai_maps() {
    let map = |header: &str| message("a.map", format!("{header}\nmap\n..\n.@\n"));
    assert_says(
        &map("octile\nheight 2\nwidth 2"),
        &["line 1", "`type octile`", "\"octile\""],
    );
    assert_says(
        &map("type octile\nheight two\nwidth 2"),
        &["line 2", "`height`", "two"],
    );
    assert_says(&map("type octile\nheight 2\nwidth"), &["line 3", "`width`"]);
    assert_says(
        &map("type octile\nheight 3\nwidth 2"),
        &["expected 3 rows", "found 2"],
    );
    assert_says(
        &map("type octile\nheight 2\nwidth 3"),
        &["line 5", "row of 3", "found 2"],
    );
    assert_says(
        &message("a.map", "type octile\nheight 1"),
        &["line 3", "found \"\""],
    );
    let unknown = message("a.map", "type octile\nheight 1\nwidth 2\nmap\n.#\n");
    assert_says(&unknown, &["line 5, column 2", "'#'", "`@`"]);
}

#[test]
fn map_server_files() {
    const YAML: &str = "image: gone.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\n\
                        occupied_thresh: 0.65\nfree_thresh: 0.196\n";
    let with = |from: &str, to: &str| {
        assert!(YAML.contains(from));
        message("a.yaml", YAML.replace(from, to))
    };
    let gone = message("a.yaml", YAML);
    assert_says(
        &gone,
        &["a.yaml: the image gone.pgm", "key `image`", "no such file"],
    );
    for key in [
        "image",
        "resolution",
        "origin",
        "negate",
        "occupied_thresh",
        "free_thresh",
    ] {
        let without = with(&format!("{key}:"), &format!("not_{key}:"));
        assert_says(
            &without,
            &[&format!("a.yaml: key `{key}`: expected"), "found nothing"],
        );
        assert_says(&without, &["for example"]);
    }
    assert_says(
        &with("0.05", "-1"),
        &["key `resolution`", "above 0", "found -1"],
    );
    assert_says(&with("0.05", ".nan"), &["key `resolution`", "found NaN"]);
    assert_says(
        &with("[0, 0, 0]", "[0, 0]"),
        &["key `origin`", "found [0, 0]"],
    );
    assert_says(
        &with("0.65", "65"),
        &["key `occupied_thresh`", "0 to 1", "found 65"],
    );
    assert_says(
        &with("0.196", "0.9"),
        &["key `free_thresh`", "`occupied_thresh`", "found 0.9"],
    );
    assert_says(
        &with("negate: 0", "negate: 2"),
        &["key `negate`", "0 or 1", "found 2"],
    );
    let mode = with("negate: 0", "negate: 0\nmode: costs");
    assert_says(&mode, &["key `mode`: expected `trinary`", "found `costs`"]);
    let twice = with("negate: 0", "negate: 0\nNegate: 1");
    assert_says(&twice, &["key `negate` stands twice"]);
    let folder = with("image: gone.pgm", "image: ''");
    assert_says(&folder, &["key `image`", "found nothing"]);
    assert_says(
        &with("0.05", "five"),
        &["key `resolution`", "above 0", "found `five`"],
    );
    assert_says(
        &message("a.yaml", "- 1\n"),
        &[
            "a.yaml: `- 1`",
            "expected the keys of a map_server YAML file",
        ],
    );
    let small = message_with("a.yaml", YAML, &metres(0.01));
    assert_says(
        &small,
        &["--cell-size 0.01 is smaller", "0.05 m", "use 0.05 or more"],
    );
    assert_says(
        &message_with("a.yaml", YAML, &metres(f64::NAN)),
        &["--cell-size NaN"],
    );
}

#[test]
fn files_of_other_kinds_are_named() {
    let named = |name: &str, bytes: &[u8], words: &[&str]| {
        let message = message(name, bytes);
        assert_says(&message, words);
        assert!(message.len() < 500, "{message}");
    };
    let magick = ["PNG and PGM pictures are read", "magick FILE map.png"];
    for (bytes, what) in [
        (&b"BM\x36\0"[..], "a BMP picture"),
        (b"\xff\xd8\xff\xe0", "a JPEG picture"),
        (b"II*\0\x08", "a TIFF picture"),
        (b"MM\0*\0", "a TIFF picture"),
        (b"GIF89a", "a GIF picture"),
        (b"RIFF\0\0\0\0WEBPVP8 ", "a WebP picture"),
    ] {
        for name in ["a.png", "a.pgm", "a.txt", "a.map", "a.yaml"] {
            named(
                name,
                bytes,
                &[&format!("{name}: is {what}"), magick[0], magick[1]],
            );
        }
        named(
            "a.img",
            bytes,
            &["unknown ending `img`, and is", what, magick[0]],
        );
    }
    for (name, what) in [
        ("a.JPG", "a JPEG picture"),
        ("a.jpeg", "a JPEG picture"),
        ("a.BMP", "a BMP picture"),
        ("a.tif", "a TIFF picture"),
        ("a.webp", "a WebP picture"),
    ] {
        named(name, b"", &["unknown ending", what, magick[0]]);
    }
    let tree = b"# Octomap OcTree file\n# (feel free)\nid ColorOcTree\n";
    named(
        "a.ot",
        tree,
        &[
            "an OctoMap tree of voxels",
            "survey --terrain",
            "convert_octree",
        ],
    );
    named(
        "a.bt",
        b"# Octomap OcTree binary file\n",
        &["(.bt)", "survey --terrain"],
    );
    named(
        "a.pcd",
        b"# .PCD v0.7\n",
        &["a point cloud", "octomap_server"],
    );
    named(
        "a.ply",
        b"ply\nformat ascii 1.0\n",
        &["a point cloud", "octomap_server"],
    );
    named("a.LAS", b"LASF", &["a point cloud", "octomap_server"]);
    named(
        "a.txt",
        b"o---o---o\n|       |\n",
        &["a micromouse maze", "`#`"],
    );
    named(
        "a.png",
        b"version https://git-lfs.github.com/spec/v1\n",
        &["git lfs pull"],
    );
    named("a.pgm", b"<!DOCTYPE html>", &["a web page", "download"]);
    named(
        "trace.csv",
        b"{\"format\":\"host-sim trace\"",
        &["the trace of a run"],
    );
    named(
        "a.txt",
        b"\x89PNG\r\n\x1a\n",
        &["holds a PNG picture", "name it .png"],
    );
    named(
        "a.yaml",
        b"P5\n1 1\n255\n\xff",
        &["holds a PGM picture", "name it .pgm"],
    );
    named(
        "a",
        b"P2\n1 1\n1\n1",
        &["holds a PGM picture", "name it .pgm"],
    );
    named("a", b"...\n", &["unknown ending ``", ".txt"]);
    named("a.txt", b"\xff\xfe.\0.\0", &["UTF-16", "save it as UTF-8"]);
    named(
        "a.txt",
        b"..\n.\t\n",
        &["line 2, column 2", "'\\t'", "in place of tabs"],
    );
    for name in ["a.png", "a.pgm"] {
        named(name, b"", &["the file is empty"]);
    }
    for name in ["a.txt", "a.map", "a.yaml"] {
        named(name, b"", &["expected"]);
    }
}

#[test]
fn an_image_of_another_kind_is_named_under_its_yaml_file() {
    let folder = tempfile::tempdir().unwrap();
    let yaml = folder.path().join("a.yaml");
    fs::write(
        &yaml,
        "image: photo.jpg\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\n\
         occupied_thresh: 0.65\nfree_thresh: 0.196\n",
    )
    .unwrap();
    fs::write(folder.path().join("photo.jpg"), b"\xff\xd8\xff\xe0").unwrap();
    let error = World::read(&yaml, &pixels(1)).unwrap_err().to_string();
    assert_says(
        &error,
        &[
            "photo.jpg that key `image` names",
            "a JPEG picture",
            "convert it",
        ],
    );
}

#[test]
fn long_and_hostile_lines_are_quoted_in_short() {
    let long = "x".repeat(100_000) + "\u{1b}[2J";
    for (name, text) in [
        ("a.map", format!("type {long}\n")),
        ("a.map", format!("\u{1b}]0;{long}\n")),
        ("a.yaml", format!("- {long}\n")),
        ("a.yaml", format!("{long}: [\n")),
        ("a.yaml", format!("resolution: {long}\n")),
        (
            "a.yaml",
            format!("resolution: 1\norigin: [0, 0, \"{long}\"]\n"),
        ),
        ("a.txt", format!("\u{1b}{long}\n")),
        (
            "a.yaml",
            format!(
                "image: {}\nresolution: 1\norigin: [0, 0, 0]\nnegate: 0\n\
                 occupied_thresh: 0.65\nfree_thresh: 0.196\n",
                "\"\\e]0;x".to_owned() + &"y".repeat(9_000) + "\""
            ),
        ),
    ] {
        let message = message(name, text);
        assert!(message.chars().count() < 400, "{message}");
        assert!(!message.contains('\u{1b}'), "{message:?}");
    }
}

#[test]
fn starts() {
    let world = world(&["..#", "###", "..."]);
    let place = |starts, robots| -> WorldError { world.place(robots, &starts, true).unwrap_err() };
    let outside = place(Starts::At(vec![cell(3, 0)]), 1).to_string();
    assert_says(
        &outside,
        &["drawn: start 3,0 is outside", "3×3 cells", "from 0"],
    );
    let blocked = place(Starts::At(vec![cell(2, 1)]), 1).to_string();
    assert_says(
        &blocked,
        &["start 2,1 is an obstacle", "nearest free cell is 2,2"],
    );
    let crowd = place(Starts::At(vec![cell(0, 0)]), 3).to_string();
    assert_says(
        &crowd,
        &["3 robots", "only 2 free cells", "leave out --solid"],
    );
}

#[test]
fn recipes() {
    let recipe = Recipe::new(Family::WideMaze, Extent::new(20, 4), 1);
    let small = recipe.generate().unwrap_err().to_string();
    assert_says(
        &small,
        &["wide-maze-1: 20×4 cells are too few", "5×5 or more"],
    );
    let large = Recipe {
        extent: Extent::new(600, 20),
        ..recipe
    };
    assert_says(
        &large.generate().unwrap_err().to_string(),
        &["600×20", "512×512", "smaller"],
    );
    let wide = Recipe {
        extent: Extent::new(20, 20),
        corridor: Some(6),
        ..recipe
    };
    assert_says(
        &wide.generate().unwrap_err().to_string(),
        &["corridor 6; expected 2 to 5"],
    );
    let dense = Recipe {
        extent: Extent::new(20, 20),
        density: Some(41),
        ..recipe
    };
    assert_says(
        &dense.generate().unwrap_err().to_string(),
        &["density 41; expected 0 to 40"],
    );
}
