//! Outputs that fail or are interrupted.

use std::os::unix::process::ExitStatusExt;
use std::process::{Child, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use super::*;

/// The command for a shell, in a folder.
fn shell(folder: &Path, script: &str) -> Command {
    let mut command = Command::new("sh");
    let program = env!("CARGO_BIN_EXE_host-sim");
    command
        .current_dir(folder)
        .env("SIM", program)
        .args(["-c", script]);
    command
}

/// Every subcommand that is over soon, with its arguments.
const COMMANDS: [&str; 7] = [
    "explore rooms.txt",
    "explore rooms.txt --json",
    "explore rooms.txt --max-ticks 2 --range 1",
    "generate cave -o cave.txt",
    "compare rooms.txt --planners closest --reference greedy --robots 1,2",
    "survey --size 10 --robots 2 --max-ticks 5",
    "--help",
];

#[test]
fn a_reader_that_has_read_enough_is_no_error() {
    for command in COMMANDS {
        let folder = folder();
        let run = |reader: &str| {
            let script = format!("($SIM {command}; echo $? >&2) {reader}");
            let output = shell(folder.path(), &script).assert().success();
            let _ = fs::remove_dir_all(folder.path().join("out"));
            String::from_utf8_lossy(&output.get_output().stderr).into_owned()
        };
        let read = run(">/dev/null");
        // The reader is gone before the first line.
        let gone = run("| exec true");
        assert_eq!(gone, read, "{command}");
        let closed = run(">&-");
        assert_eq!(closed, read, "{command}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_behind_standard_output_is_an_error() {
    for command in COMMANDS {
        let folder = folder();
        let output = shell(folder.path(), &format!("$SIM {command} >/dev/full")).assert();
        let output = output.code(2);
        let message = String::from_utf8_lossy(&output.get_output().stderr);
        let words = "error: standard output cannot be written: No space left on device";
        assert!(message.contains(words), "{command}: {message}");
        assert!(!message.contains("panicked"), "{command}: {message}");
        let _ = fs::remove_dir_all(folder.path().join("out"));
        // Nor do messages that nobody can read.
        let script = format!("$SIM {command} >/dev/full 2>/dev/full");
        shell(folder.path(), &script).assert().code(2);
        shell(folder.path(), "$SIM explore no.txt 2>/dev/full")
            .assert()
            .code(2);
    }
}

/// Files in a folder, hidden ones too.
fn files(folder: &Path) -> Vec<String> {
    let Ok(entries) = fs::read_dir(folder) else {
        return Vec::new();
    };
    let name = |entry: std::io::Result<fs::DirEntry>| entry.unwrap().file_name();
    let mut names: Vec<_> = entries
        .map(|entry| name(entry).into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn no_half_file_is_left_where_there_is_no_room() {
    let folder = folder();
    fs::write(folder.path().join("old.png"), "old").unwrap();
    // A file of at most 512 bytes; the signal that tells so is ignored.
    let limited = "trap '' XFSZ; ulimit -f 1; exec $SIM";
    for file in ["new.txt", "new.map", "new.pgm", "old.png"] {
        let script =
            format!("{limited} generate cave --size 500x400 --pixels-per-cell 4 -o {file}");
        let output = shell(folder.path(), &script).assert().code(2);
        let message = String::from_utf8_lossy(&output.get_output().stderr);
        assert!(message.contains("cannot be written"), "{message}");
    }
    shell(folder.path(), &format!("{limited} explore rooms.txt"))
        .assert()
        .code(2);
    assert_eq!(files(folder.path()), ["old.png", "out", "rooms.txt"]);
    assert_eq!(files(&folder.path().join("out/rooms")), [""; 0]);
    assert_eq!(
        fs::read_to_string(folder.path().join("old.png")).unwrap(),
        "old"
    );
}

fn interrupt(child: &Child) {
    let kill = format!("kill -INT {}", child.id());
    Command::new("sh").args(["-c", &kill]).assert().success();
}

#[test]
fn an_interrupted_command_leaves_no_half_file() {
    let folder = folder();
    let out = folder.path().join("out/figures");
    let mut child = std::process::Command::new(env!("CARGO_BIN_EXE_host-sim"))
        .current_dir(folder.path())
        .args(["figures", "--quick"])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    // The first figure is written while the next ones are measured.
    let begin = Instant::now();
    while files(&out).is_empty() && begin.elapsed() < Duration::from_secs(120) {
        sleep(Duration::from_millis(20));
    }
    assert!(!files(&out).is_empty());
    interrupt(&child);
    // As if there were no handler: by the signal, so that a shell ends its loop.
    assert_eq!(child.wait().unwrap().signal(), Some(2));
    assert_eq!(files(&out), [""; 0]);
}

#[test]
fn an_interrupted_exploration_is_saved_if_asked() {
    let folder = folder();
    let large = [
        "generate",
        "perfect-maze",
        "--size=300x300",
        "--output=large.png",
    ];
    host_sim(folder.path(), &large).assert().success();
    let arguments = ["explore", "large.png", "--robots=1", "--save=half"];
    let mut child = std::process::Command::new(env!("CARGO_BIN_EXE_host-sim"))
        .current_dir(folder.path())
        .args(arguments)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    // It listens before it makes the folder.
    let begin = Instant::now();
    while !folder.path().join("out/large").exists() {
        assert!(begin.elapsed() < Duration::from_secs(60));
        sleep(Duration::from_millis(20));
    }
    interrupt(&child);
    assert_eq!(child.wait().unwrap().code(), Some(1));
    let picture = fs::read(folder.path().join("out/large/explored.png"));
    assert!(picture.unwrap().starts_with(b"\x89PNG"));
    let rest = ["explore", "large.png", "--robots=1", "--restore=half"];
    host_sim(folder.path(), &rest).assert().success();
}

#[test]
fn a_file_without_an_end_is_refused() {
    let folder = folder();
    std::os::unix::fs::symlink("/dev/zero", folder.path().join("a.txt")).unwrap();
    assert_bad_input(
        folder.path(),
        &["explore", "a.txt"],
        &["a.txt", "more than"],
    );
}
