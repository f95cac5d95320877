//! `explore`: what it answers, by option.

use super::*;

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
