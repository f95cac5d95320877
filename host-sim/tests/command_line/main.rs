//! The command as a stranger calls it: files, exit statuses, messages.

mod explore;
mod generate;
mod maps;
#[cfg(unix)]
mod outputs;
mod replay_scans;

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use serde_json::Value;
use tempfile::TempDir;

const ROOMS: &str = "\
############
#1....#....#
#..........#
#.....#....#
############
";

/// A folder with a small map in it.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("rooms.txt"), ROOMS).unwrap();
    folder
}

fn host_sim(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("host-sim").unwrap();
    command.current_dir(folder).args(arguments);
    command
}

/// Exit status 2, a message with all of `words`, and no output folder.
fn assert_bad_input(folder: &Path, arguments: &[&str], words: &[&str]) {
    let assert = host_sim(folder, arguments).assert().code(2);
    let output = assert.get_output();
    let message = String::from_utf8_lossy(&output.stderr);
    for word in words {
        assert!(message.contains(word), "{word:?} is not in: {message}");
    }
    assert!(output.stdout.is_empty());
    assert!(!folder.join("out").exists());
}
