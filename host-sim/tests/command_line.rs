//! The command as a stranger calls it: files, exit statuses, messages.

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

#[test]
fn faults_by_option_happen() {
    let folder = folder();
    let faults = [
        "--robots=3",
        "--delay=3",
        "--duplicate=0.3",
        "--partition=2-9:1",
        "--kill=2@4",
        "--late=1@3",
        "--restart=0@5",
    ];
    let run = |arguments: &[&str]| -> Value {
        let arguments = [&["explore", "rooms.txt", "--json"], arguments].concat();
        let output = host_sim(folder.path(), &arguments).assert().success();
        serde_json::from_slice(&output.get_output().stdout).unwrap()
    };
    let (without, with) = (run(&faults[..1]), run(&faults));
    assert_eq!(with["complete"], true);
    assert!(with["robots"][2]["steps"].as_u64() < without["robots"][2]["steps"].as_u64());
    for one in &faults[1..] {
        let alone = run(&[faults[0], one]);
        // A frame that comes twice says nothing new.
        let changes = !one.starts_with("--duplicate");
        assert_eq!(
            alone["trace_digest"] != without["trace_digest"],
            changes,
            "{one}"
        );
    }
    let empty = self::folder();
    assert_bad_input(
        empty.path(),
        &["explore", "rooms.txt", "--robots=2", "--kill=2@4"],
        &["--kill", "no robot 2", "0 to 1"],
    );
}

#[test]
fn a_world_misleads_by_option_and_is_told_so() {
    let folder = folder();
    let arguments = ["explore", "rooms.txt", "--robots=2"];
    let trouble = [
        "--false-walls=0.3",
        "--people=1",
        "--see-robots",
        "--looks=2",
    ];
    let run = |options: &[&str]| {
        let arguments = [&arguments, options].concat();
        let output = host_sim(folder.path(), &arguments).output().unwrap();
        assert!(output.status.code() < Some(2), "{output:?}");
        String::from_utf8(output.stdout).unwrap()
    };
    let told = run(&trouble);
    assert!(told.contains("bumps"), "{told}");
    assert!(!run(&[]).contains("bumps"));
    let json = run(&[&trouble[..], &["--json"]].concat());
    let summary: Value = serde_json::from_str(&json).unwrap();
    let expected = serde_json::json!({
        "false_walls": 0.3, "false_frees": 0.0, "error_kind": "transient", "misplaced": 0.0,
        "drift": 0, "people": 1, "doors": 0, "see_robots": true, "looks": 2,
    });
    assert_eq!(summary["trouble"], expected);
    for field in ["false_claims", "bumps", "violations"] {
        assert!(summary[field].is_u64(), "{field}");
    }
    let robot = &summary["robots"][0];
    assert!(robot["cells_closed"].is_u64() && robot["cells_opened"].is_u64());
    let calm: Value = serde_json::from_str(&run(&["--json"])).unwrap();
    assert!(calm.get("trouble").is_none());
    assert_eq!(calm["false_claims"], 0);
    let flown = ["survey", "--terrain=gaussian:0", "--size=16", "--doors=2"];
    let empty = self::folder();
    assert_bad_input(
        empty.path(),
        &flown,
        &["--doors does not apply over a terrain"],
    );
}

/// A corridor of eight cells, of which a robot sees two ahead.
const CORRIDOR: [&str; 4] = ["explore", "corridor.txt", "--robots=1", "--range=2"];

#[test]
fn cells_and_senses_fail_by_option() {
    let folder = folder();
    let corridor = "##########\n#1.......#\n##########\n";
    fs::write(folder.path().join("corridor.txt"), corridor).unwrap();
    let run = |code: i32, arguments: &[&str]| -> Value {
        let arguments = [&CORRIDOR[..], &["--json"], arguments].concat();
        let output = host_sim(folder.path(), &arguments).assert().code(code);
        serde_json::from_slice(&output.get_output().stdout).unwrap()
    };
    let stopped = |summary: &Value| summary["ticks_to_stopped"].as_u64().unwrap();
    let usual = run(0, &[]);
    assert_eq!(usual["fov"], 360);
    let closed = run(0, &["--close=4,1@0-30"]);
    assert!(closed["robots"][0]["blocked_steps"].as_u64() > Some(0));
    assert!(stopped(&closed) >= 30);
    // What is seen past the silent cell is seen; of itself nobody is told.
    let blind = run(0, &["--blind=4,0", "--max-ticks=200"]);
    assert_ne!(blind["trace_digest"], usual["trace_digest"]);
    assert_eq!(blind["seen_cells"], 8);
    let deaf = run(1, &["--sensor-fails=0@0", "--max-ticks=200"]);
    assert!(deaf["seen_cells"].as_u64() < Some(8));
    let resumed = run(0, &["--resume=0@50"]);
    assert_eq!(stopped(&resumed), 50);
    assert_eq!(resumed["robots"][0]["stop"], "complete");
    // Nothing is decided without a pose.
    let closest = run(0, &["--planner=closest"]);
    let lost = run(0, &["--planner=closest", "--pose-lost=0@2-12"]);
    assert_eq!(stopped(&lost), stopped(&closest) + 10);
    assert_eq!(lost["robots"][0]["steps"], closest["robots"][0]["steps"]);
}

#[test]
fn a_map_that_ends_at_free_cells_says_so_and_counts_as_complete() {
    let folder = folder();
    fs::write(folder.path().join("open.txt"), "1...\n####\n").unwrap();
    let output = host_sim(folder.path(), &["explore", "open.txt", "--robots=1"])
        .assert()
        .success();
    let text = String::from_utf8_lossy(&output.get_output().stdout).into_owned();
    assert!(text.contains("the world may go on"), "{text}");
}

#[test]
fn a_complete_run_leaves_its_files_and_exits_with_0() {
    let folder = folder();
    let assert = host_sim(folder.path(), &["explore", "rooms.txt"])
        .assert()
        .success();
    let text = String::from_utf8_lossy(&assert.get_output().stdout).into_owned();
    assert!(text.contains("out/rooms"), "{text}");
    let mut files: Vec<_> = fs::read_dir(folder.path().join("out/rooms"))
        .unwrap()
        .map(|file| file.unwrap().file_name().into_string().unwrap())
        .collect();
    files.sort();
    let expected = [
        "coverage.csv",
        "coverage.png",
        "explored.gif",
        "explored.png",
        "map.pgm",
        "map.yaml",
        "summary.json",
        "trace.csv",
    ];
    assert_eq!(files, expected);
}

#[test]
fn json_is_one_object_with_the_documented_fields() {
    let folder = folder();
    let arguments = [
        "explore",
        "rooms.txt",
        "--json",
        "--robots",
        "2",
        "--seed",
        "7",
    ];
    let run = || {
        let assert = host_sim(folder.path(), &arguments).assert().success();
        assert!(assert.get_output().stderr.is_empty());
        serde_json::from_slice::<Value>(&assert.get_output().stdout).unwrap()
    };
    let summary = run();
    assert_eq!(summary["complete"], true);
    for field in [
        "ticks_to_seen",
        "ticks_to_stopped",
        "reachable_cells",
        "seen_cells",
        "max_work_per_tick",
    ] {
        assert!(summary[field].is_u64(), "{field}: {}", summary[field]);
    }
    assert_eq!(summary["reachable_cells"], 28);
    assert_eq!(summary["seen_cells"], 28);
    assert_eq!(summary["trace_digest"].as_str().unwrap().len(), 16);
    let robots = summary["robots"].as_array().unwrap();
    assert_eq!(robots.len(), 2);
    for robot in robots {
        assert!(robot["steps"].is_u64());
        assert!(robot["cells_known"].is_u64());
        assert_eq!(robot["stop"], "complete");
        assert_eq!(robot["start"], serde_json::json!([1, 1]));
    }
    assert_eq!(run(), summary, "the same command gives the same summary");
}

#[test]
fn an_incomplete_run_says_what_was_left_and_exits_with_1() {
    let folder = folder();
    let arguments = ["explore", "rooms.txt", "--range", "1", "--max-ticks", "3"];
    let assert = host_sim(folder.path(), &arguments).assert().code(1);
    let message = String::from_utf8_lossy(&assert.get_output().stderr).into_owned();
    assert!(message.contains("not complete"), "{message}");
    assert!(
        message.contains("of 28 reachable cells unseen after 3 ticks"),
        "{message}"
    );
}

#[test]
fn every_planner_has_a_name() {
    let folder = folder();
    for planner in ["explorer", "closest", "greedy", "minpos", "minpos-strong"] {
        host_sim(
            folder.path(),
            &["explore", "rooms.txt", "--planner", planner],
        )
        .assert()
        .success();
    }
}

#[test]
fn bad_maps_are_named() {
    let folder = folder();
    let path = folder.path();
    assert_bad_input(
        path,
        &["explore", "none.png"],
        &["none.png", "no such file"],
    );
    fs::write(path.join("map.bmp"), "BM").unwrap();
    let kinds = ["map.bmp", "a BMP picture", ".png", "convert"];
    assert_bad_input(path, &["explore", "map.bmp"], &kinds);
    fs::write(path.join("full.txt"), "###\n###\n").unwrap();
    assert_bad_input(
        path,
        &["explore", "full.txt"],
        &["full.txt", "no free cell"],
    );
    fs::write(path.join("large.txt"), "#".repeat(511) + &".".repeat(500)).unwrap();
    assert_bad_input(path, &["explore", "large.txt"], &["large.txt", "512×512"]);
    fs::write(
        path.join("site.yaml"),
        "image: site.png\norigin: [0, 0, 0]\n",
    )
    .unwrap();
    assert_bad_input(
        path,
        &["explore", "site.yaml"],
        &["site.yaml", "resolution"],
    );

    host_sim(path, &["generate", "cave", "-o", "cave.png"])
        .assert()
        .success();
    let whole = fs::read(path.join("cave.png")).unwrap();
    fs::write(path.join("cut.png"), &whole[..whole.len() / 2]).unwrap();
    assert_bad_input(path, &["explore", "cut.png"], &["cut.png", "complete"]);
}

#[test]
fn bad_options_are_named() {
    let folder = folder();
    let bad = |arguments: &[&str], words: &[&str]| {
        let arguments = [&["explore", "rooms.txt"], arguments].concat();
        assert_bad_input(folder.path(), &arguments, words);
    };
    bad(&["--start", "0,0"], &["0,0", "obstacle", "nearest free"]);
    bad(&["--start", "40,2"], &["40,2", "outside"]);
    bad(&["--start", "north"], &["--start", "X,Y"]);
    bad(
        &["--start", "2,2", "--start", "center"],
        &["--start", "alone"],
    );
    bad(&["--solid", "--robots", "29"], &["29", "28", "--solid"]);
    bad(&["--robots", "0"], &["--robots"]);
    bad(&["--range", "32"], &["--range", "1..=31"]);
    bad(&["--fov", "0"], &["--fov", "1..=360"]);
    bad(
        &["--fov", "90", "--planner", "minpos"],
        &["minpos never turns", "360", "90"],
    );
    bad(&["--close", "99,1"], &["--close 99,1", "12×5"]);
    bad(&["--blind", "3"], &["--blind", "X,Y@FROM-UNTIL"]);
    bad(
        &["--pose-lost", "0@9-3"],
        &["--pose-lost", "ROBOT@FROM-UNTIL"],
    );
    bad(&["--pose-lost", "3@1-4"], &["--pose-lost", "no robot 3"]);
    bad(
        &["--sensor-fails", "7@1"],
        &["--sensor-fails", "no robot 7"],
    );
    let share = "0 (nothing) to 1";
    bad(&["--false-walls", "1.5"], &["--false-walls", share]);
    bad(&["--false-frees=-1"], &["--false-frees", share]);
    bad(&["--misplaced", "often"], &["--misplaced", share]);
    bad(&["--error-kind", "wild"], &["--error-kind", "viewpoint"]);
    bad(&["--preset", "sonar"], &["--preset", "rangers"]);
    bad(
        &["--preset=lidar", "--planner=minpos"],
        &["--preset lidar", "minpos"],
    );
    bad(&["--looks", "0"], &["--looks", "1..=16"]);
    bad(&["--people", "two"], &["--people"]);
    bad(&["--loss", "60"], &["--loss", "0 (nothing) to 1"]);
    bad(&["--corrupt", "2"], &["--corrupt", "0 (nothing) to 1"]);
    bad(&["--radio-range", "far"], &["--radio-range", "all, sight"]);
    bad(&["--medium", "wire"], &["--medium", "ideal", "radio"]);
    bad(&["--planner", "best"], &["--planner", "explorer"]);
}

#[test]
fn a_folder_that_cannot_be_written_to_stops_the_run_before_it_starts() {
    let folder = folder();
    fs::write(folder.path().join("taken"), "a file").unwrap();
    let arguments = ["explore", "rooms.txt", "--out", "taken"];
    assert_bad_input(folder.path(), &arguments, &["taken", "--out"]);
    assert_eq!(
        fs::read_to_string(folder.path().join("taken")).unwrap(),
        "a file"
    );
}

#[test]
fn generate_writes_what_explore_reads() {
    let folder = folder();
    let arguments = ["generate", "cave", "--size", "big", "-o", "cave.png"];
    assert_bad_input(folder.path(), &arguments, &["--size", "WIDTHxHEIGHT"]);
    for (family, file) in [
        ("perfect-maze", "maze.txt"),
        ("open", "open.pgm"),
        ("rooms", "r.map"),
    ] {
        let arguments = [
            "generate", family, "--size", "25x21", "--seed", "4", "-o", file,
        ];
        host_sim(folder.path(), &arguments).assert().success();
        host_sim(folder.path(), &["explore", file, "--robots", "1"])
            .assert()
            .success();
    }
}

#[test]
fn what_a_map_leaves_unknown_is_told() {
    let folder = folder();
    let mut map = b"P5\n4 1\n255\n".to_vec();
    map.extend([254, 205, 205, 0]);
    fs::write(folder.path().join("map.pgm"), map).unwrap();
    let assert = host_sim(folder.path(), &["explore", "map.pgm", "--json"]).assert();
    let output = assert.success();
    let notes = String::from_utf8_lossy(&output.get_output().stderr).into_owned();
    let note = "note: map.pgm: 2 of 4 pixels are unknown";
    assert!(notes.starts_with(note), "{notes}");
    let summary: Value = serde_json::from_slice(&output.get_output().stdout).unwrap();
    assert_eq!(summary["reachable_cells"], 1);
}

#[cfg(unix)]
mod outputs {
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
}

#[test]
fn logs_of_scans_are_scored_and_drawn() {
    let folder = folder();
    // A corridor of 4 m, driven along its middle; the last look sees somebody in it.
    let look = |x: f64| {
        format!(
            "{x} 0.5 0 0 {} 3.1416 {} 1.5708 0.6 -1.5708 0.6\n",
            4.05 - x,
            x + 0.05
        )
    };
    let mut log: String = (1..16).map(|i| look(0.25 * f64::from(i))).collect();
    log += "1 0.5 0 0 0.6\n";
    fs::write(folder.path().join("corridor.log"), &log).unwrap();
    let replay = [
        "replay-scans",
        "corridor.log",
        "--cell-size=0.1",
        "--preset=truthful",
        "--out=drawn",
    ];
    let output = host_sim(folder.path(), &[&replay[..], &["--json"]].concat())
        .assert()
        .success();
    let score: Value = serde_json::from_slice(&output.get_output().stdout).unwrap();
    assert_eq!(
        (&score["log"], &score["looks"]),
        (&"corridor".into(), &16.into())
    );
    assert!(score["open_floor"].as_u64() > Some(20) && score["driven"].as_u64() > Some(20));
    assert_eq!(score["nothing_from"], 3.8);
    let picture = fs::read(folder.path().join("drawn/corridor.png")).unwrap();
    assert!(picture.starts_with(b"\x89PNG"));
    let words = host_sim(folder.path(), &replay).assert().success();
    let words = String::from_utf8_lossy(&words.get_output().stdout).into_owned();
    assert!(words.contains("corridor") && words.contains("drawn"));
    // A run leaves such a log, too.
    let explore = ["explore", "rooms.txt", "--out=run", "--scans=rooms.scans"];
    host_sim(folder.path(), &explore).assert().success();
    let rooms = [
        "replay-scans",
        "rooms.scans",
        "--cell-size=0.25",
        "--out=drawn",
        "--json",
    ];
    let output = host_sim(folder.path(), &rooms).assert().success();
    let score: Value = serde_json::from_slice(&output.get_output().stdout).unwrap();
    assert!(score["looks"].as_u64() > Some(9) && score["open_floor"].as_u64() > Some(0));

    let bad = |arguments: &[&str], words: &[&str]| {
        let arguments = [&["replay-scans"], arguments].concat();
        assert_bad_input(folder.path(), &arguments, words);
    };
    bad(
        &["rooms.txt", "--cell-size=0.1"],
        &["rooms.txt: holds no scan"],
    );
    bad(
        &["none.log", "--cell-size=0.1"],
        &["none.log", "no such file"],
    );
    bad(
        &["corridor.log", "--cell-size=0.001"],
        &["cells of 0.001 m", "or more"],
    );
    bad(
        &["corridor.log", "--cell-size=0"],
        &["expected 0.001 to 1000"],
    );
    bad(
        &["corridor.log", "corridor.log", "--cell-size=0.1"],
        &["two logs are called corridor"],
    );
}

#[test]
fn what_robots_know_is_a_map_that_can_be_explored() {
    let folder = folder();
    // A chamber that nobody can see into, and a niche that robots keep out of.
    let map = "#########\n#.....#.#\n#.....#.#\n#.......#\n###.#####\n#.#.#...#\n#########\n";
    fs::write(folder.path().join("flat.txt"), map).unwrap();
    let run = |arguments: &[&str]| -> Value {
        let output = host_sim(folder.path(), arguments).assert().success();
        serde_json::from_slice(&output.get_output().stdout).unwrap()
    };
    let first = run(&[
        "explore",
        "flat.txt",
        "--robots=1",
        "--keep-out=3,5",
        "--json",
    ]);
    assert_eq!(first["unreachable_cells"], 5);
    let yaml = "out/flat/map.yaml";
    let again = ["explore", yaml, "--robots=1", "--out=again", "--json"];
    let second = run(&again);
    assert_eq!(second["reachable_cells"], first["reachable_cells"]);
    assert_eq!(second["complete"], true);
    assert_eq!(second["unreachable_cells"], 0);
    let read = |path: &str| fs::read(folder.path().join(path)).unwrap();
    let (picture, of_second) = (read("out/flat/map.pgm"), read("again/map.pgm"));
    let count = |gray| picture.iter().filter(|&&byte| byte == gray).count() as u64;
    assert_eq!(Some(count(254)), first["reachable_cells"].as_u64());
    assert!(count(205) >= 5);
    let free = |picture: &[u8]| -> Vec<bool> { picture.iter().map(|&of| of == 254).collect() };
    assert_eq!(free(&picture), free(&of_second));
    let yaml = String::from_utf8(read(yaml)).unwrap();
    assert!(yaml.contains("image: map.pgm\n") && yaml.contains("resolution: 0.25\n"));
}

#[test]
fn explorations_are_saved_and_restored() {
    let folder = folder();
    let explore = |arguments: &[&str]| {
        host_sim(
            folder.path(),
            &[&["explore", "rooms.txt"], arguments].concat(),
        )
    };
    let half = ["--max-ticks=3", "--save=fleet", "--out=first"];
    explore(&half).assert().code(1);
    // What is saved and restored may be one file.
    let rest = ["--restore=fleet", "--save=fleet", "--out=rest", "--json"];
    let output = explore(&rest).assert().success();
    let summary: Value = serde_json::from_slice(&output.get_output().stdout).unwrap();
    assert_eq!(summary["complete"], true);
    let bad = |arguments: &[&str], words: &[&str]| {
        let arguments = [&["explore", "rooms.txt"], arguments].concat();
        assert_bad_input(folder.path(), &arguments, words);
    };
    bad(&["--restore=none"], &["--restore none", "No such file"]);
    bad(&["--restore=rooms.txt"], &["rooms.txt: is no save"]);
    bad(
        &["--restore=fleet", "--robots=2"],
        &["fleet: is of a fleet of 3 robots", "--robots 3"],
    );
    bad(&["--save=x", "--planner=greedy"], &["--save", "greedy"]);
    bad(
        &["--restore=fleet", "--planner=minpos"],
        &["--restore", "minpos"],
    );
    bad(&["--restore=fleet", "--start=corner"], &["--start"]);
    let mut damaged = fs::read(folder.path().join("fleet")).unwrap();
    damaged[100] ^= 1;
    fs::write(folder.path().join("fleet"), damaged).unwrap();
    bad(&["--restore=fleet"], &["fleet: is damaged"]);
}

#[test]
fn robots_keep_out_of_masks_and_of_areas_in_metres() {
    let folder = folder();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    let yaml = |image: &str| {
        format!(
            "image: {image}\nresolution: 0.5\norigin: [-1, -2, 0]\nnegate: 0\n\
             occupied_thresh: 0.65\nfree_thresh: 0.196\n"
        )
    };
    // A hall of 6 × 4 cells; the mask closes the three cells in the south-east corner.
    write("hall.pgm", &format!("P2 6 4 255\n{}", "255 ".repeat(24)));
    write("hall.yaml", &yaml("hall.pgm"));
    let mask = "255 ".repeat(17) + "0 255 255 255 255 0 0";
    write("mask.pgm", &format!("P2 6 4 255\n{mask}"));
    write("mask.yaml", &yaml("mask.pgm"));
    let run = |arguments: &[&str]| -> Value {
        let usual = [
            "explore",
            "hall.yaml",
            "--robots=1",
            "--start=0,0",
            "--json",
        ];
        let arguments = [&usual, arguments].concat();
        let output = host_sim(folder.path(), &arguments).assert().success();
        serde_json::from_slice(&output.get_output().stdout).unwrap()
    };
    let masked = run(&["--keep-out-mask=mask.yaml"]);
    assert_eq!(masked["reachable_cells"], 24 - 3);
    // The same corner in metres, a cell more: 1 m by 1 m.
    let metres = run(&["--keep-out=1.1,-1.9:1.9,-1.1m"]);
    assert_eq!(metres["reachable_cells"], 24 - 4);
    assert_eq!(run(&["--only=-0.9,-1.9:0.4,-0.1m"])["reachable_cells"], 12);
    let map = fs::read_to_string(folder.path().join("out/hall/map.yaml")).unwrap();
    assert!(map.contains("origin: [-1.0, -2.0, 0.0]"), "{map}");

    let bad = |arguments: &[&str], words: &[&str]| {
        let other = self::folder();
        fs::copy(
            folder.path().join("mask.pgm"),
            other.path().join("mask.pgm"),
        )
        .unwrap();
        let arguments = [&["explore", "rooms.txt"], arguments].concat();
        assert_bad_input(other.path(), &arguments, words);
    };
    bad(
        &["--keep-out=1,1:2,2m"],
        &["--keep-out", "in metres", ".yaml"],
    );
    bad(&["--keep-out=1,1:2m"], &["expected X,Y:X,Y and m"]);
    bad(&["--keep-out-mask=mask.pgm"], &["mask.pgm", "6×4", "12×5"]);
    bad(&["--keep-out-mask=none.pgm"], &["none.pgm", "no such file"]);
}

#[cfg(feature = "mcap")]
#[test]
fn a_recording_of_a_run_is_a_log_of_scans() {
    let folder = folder();
    let explore = ["explore", "rooms.txt", "--robots=2", "--mcap=rooms.mcap"];
    host_sim(folder.path(), &explore).assert().success();
    let replay = ["replay-scans", "rooms.mcap", "--cell-size=0.25", "--json"];
    let arguments = [&replay[..], &["--preset=truthful"]].concat();
    let output = host_sim(folder.path(), &arguments).assert().success();
    let score: Value = serde_json::from_slice(&output.get_output().stdout).unwrap();
    assert_eq!(score["log"], "rooms");
    assert!(score["looks"].as_u64() > Some(9) && score["driven"].as_u64() > Some(5));
    assert_eq!(score["driven_closed"], 0);
}
