//! `host-sim survey` as a stranger calls it: what it refuses, and in which words; what comes out.

mod refused;
mod results;

use std::path::Path;
use std::time::Duration;

use assert_cmd::Command;
use host_sim::scene::octree::OcTree;
use image::{GrayImage, Luma};

/// No refusal takes longer.
const PATIENCE: Duration = Duration::from_secs(60);

fn survey(folder: &Path, arguments: &str) -> Command {
    let mut command = Command::cargo_bin("host-sim").unwrap();
    command
        .current_dir(folder)
        .timeout(PATIENCE)
        .arg("survey")
        .args(arguments.split_whitespace());
    command
}

/// Exit status 2, a message with all of `words`, and no output folder.
fn assert_refused(folder: &Path, arguments: &str, words: &[&str]) {
    let assert = survey(folder, arguments).assert().code(2);
    let output = assert.get_output();
    let message = String::from_utf8_lossy(&output.stderr);
    for word in words {
        assert!(
            message.contains(word),
            "{arguments}: {word:?} is not in: {message}"
        );
    }
    assert!(output.stdout.is_empty());
    assert!(!folder.join("out").exists());
}

fn picture(path: &Path, width: u32, height: u32, shade: u8) {
    let picture = GrayImage::from_pixel(width, height, Luma([shade]));
    picture.save(path).unwrap();
}

/// A scan of two rooms with a door between them, and a third that no way leads to.
fn rooms() -> OcTree {
    let mut tree = OcTree::new(0.1);
    for (x, y, z) in
        (-20..13).flat_map(|x| (0..11).flat_map(move |y| (0..9).map(move |z| (x, y, z))))
    {
        let is_wall = [-20, -10, 2, 12].contains(&x) || z == 0 || z == 8;
        let is_door = x == -10 && (3..8).contains(&y) && z > 0 && z < 8;
        // Nobody scanned the ends of the rooms.
        if y > 0 && y < 10 {
            tree.insert([x, y, z], is_wall && !is_door);
        }
    }
    tree
}
