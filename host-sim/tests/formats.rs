//! `docs/formats.md` names every key and column that the programs write, and no other.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use assert_cmd::Command;
use host_sim::live::{RobotReport, WorldReport};
use host_sim::measured::{Measured, Tally};
use planner_core::Reason;
use serde_json::{Value, json};
use tempfile::TempDir;

type Keys = BTreeSet<String>;

const PAGE: &str = include_str!("../../docs/formats.md");

const MAP: &str = "\
##############
#1....#......#
#..........2.#
#.....#......#
##############
";

/// Everything that can go wrong on the ground.
const TROUBLES: &str = "--medium radio --byte-budget 60 --loss 0.1 --radio-range 9 --partition 3-9:1 \
    --duplicate 0.1 --delay 1 --corrupt 0.1 --forge 1:hints --kill 1@30 --late 1@2 --restart 0@9 \
    --resume 0@12 --close 3,3@1-4 --shut 3,2@1-4 --blind 4,1@1-9 --sensor-fails 1@25 \
    --pose-lost 0@4-6 --preset lidar --come-home --energy 200 --keep-out 12,3:12,3 --only 0,0:13,4 \
    --people 1 --see-robots --fov 180 --clearance 0 --max-ticks 60";

/// Runs the simulator; that a run is left incomplete is no failure.
fn simulate(folder: &Path, arguments: &str) -> String {
    let mut command = Command::cargo_bin("host-sim").unwrap();
    let run = command
        .current_dir(folder)
        .args(arguments.split_whitespace());
    let output = run.output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() < Some(2), "{arguments}: {said}");
    String::from_utf8(output.stdout).unwrap()
}

fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("map.txt"), MAP).unwrap();
    folder
}

fn read(folder: &Path, file: &str) -> String {
    fs::read_to_string(folder.join(file)).unwrap_or_else(|error| panic!("{file}: {error}"))
}

/// The keys of a value and of all that is in it, but for reasons of stops, which name
/// themselves.
fn add_keys(value: &Value, keys: &mut Keys) {
    match value {
        Value::Object(fields) => {
            for (key, value) in fields {
                keys.insert(key.clone());
                if key != "stops" && key != "reach" {
                    add_keys(value, keys);
                }
            }
        }
        Value::Array(values) => values.iter().for_each(|value| add_keys(value, keys)),
        _ => {}
    }
}

fn add_json(text: &str, keys: &mut Keys) {
    add_keys(&serde_json::from_str(text).unwrap(), keys);
}

fn columns(text: &str) -> Keys {
    let names = text.lines().next().unwrap_or_default().split(',');
    names.map(String::from).collect()
}

fn add_trace(text: &str, keys: &mut Keys) {
    let (header, records) = text.split_once('\n').unwrap();
    add_json(header, keys);
    keys.extend(columns(records));
}

/// The keys that a chapter of the page has in the first column of its tables.
fn documented(chapter: &str) -> Keys {
    let begin = format!("\n## {chapter}\n");
    let text = PAGE.split(&begin).nth(1).expect("the page has the chapter");
    let text = text.split("\n## ").next().unwrap_or_default();
    let first = |line: &str| {
        line.strip_prefix("| ")?
            .split(" |")
            .next()
            .map(String::from)
    };
    let cells = text.lines().filter_map(first);
    let words = cells.flat_map(|cell| {
        let words = cell.split('`').skip(1).step_by(2);
        words.map(String::from).collect::<Vec<_>>()
    });
    words.collect()
}

#[track_caller]
fn assert_same(chapter: &str, written: &Keys) {
    assert_eq!(&documented(chapter), written, "docs/formats.md, {chapter}");
}

#[test]
fn summaries_and_traces() {
    let folder = folder();
    let path = folder.path();
    let runs = [
        format!("explore map.txt --out 1 {TROUBLES}"),
        "explore map.txt --out 2 --motion omni --clearance 0 --save saved".into(),
        "explore map.txt --out 3 --clearance 1 --start spread --robots 1 --max-ticks 9".into(),
        "explore map.txt --out 4 --restore saved --max-ticks 9".into(),
        "survey --terrain urban:1 --size 24 --metres-per-cell 0.5 --max-ticks 9 --out 5".into(),
        "survey --terrain town:1 --size 24 --sensor camera --max-ticks 9 --wind 0.2 --clearance 0 --out 6".into(),
        "survey --scene 6/map.bt --max-ticks 3 --out 7 --start 2.5,2.5,2.5".into(),
        "survey --scene 6/map.ply --voxel-size 1 --max-ticks 3 --out 8".into(),
        "survey --terrain town:1 --size 24 --false-walls 0.05 --preset rangers --max-ticks 30 --out 9".into(),
    ];
    let (mut summaries, mut traces) = (Keys::new(), Keys::new());
    for (run, out) in runs.iter().zip(1..) {
        simulate(path, run);
        add_json(&read(path, &format!("{out}/summary.json")), &mut summaries);
        add_trace(&read(path, &format!("{out}/trace.csv")), &mut traces);
        let coverage = columns(&read(path, &format!("{out}/coverage.csv")));
        assert_same("Coverage", &coverage);
    }
    let on_chips = json!([Measured::default(), Tally::default(), {"firmware": null}]);
    add_keys(&on_chips, &mut summaries);
    assert_same("Summaries", &summaries);

    let mut save = Keys::new();
    // Below it stands its digest.
    add_json(read(path, "saved").lines().next().unwrap(), &mut save);
    assert_same("Saves", &save);

    for reason in Reason::ALL {
        let row = format!("\n| {} | `{}` |", 32 + reason.code(), reason.name());
        assert!(PAGE.contains(&row), "docs/formats.md, Traces: no row {row}");
    }
    // Headers have what summaries have of the scenario.
    let own = documented("Traces");
    let missing: Vec<_> = own.difference(&traces).collect();
    assert!(missing.is_empty(), "no trace has {missing:?}");
    let known: Keys = own.into_iter().chain(summaries).chain(save).collect();
    let new: Vec<_> = traces.difference(&known).collect();
    assert!(new.is_empty(), "docs/formats.md, Traces: no {new:?}");
}

#[test]
fn tables_of_comparisons() {
    let folder = folder();
    let path = folder.path();
    simulate(
        path,
        "compare map.txt --robots 2 --planners explorer,minpos --worlds 1 --out c",
    );
    assert_same("Runs", &columns(&read(path, "c/runs.csv")));
    assert_same("Comparisons", &columns(&read(path, "c/table.csv")));
    // Trouble is as in summaries.
    let mut plan: Value = serde_json::from_str(&read(path, "c/plan.json")).unwrap();
    plan["trouble"] = Value::Null;
    let mut keys = Keys::new();
    add_keys(&plan, &mut keys);
    assert_same("Plans", &keys);
}

#[test]
fn scores_and_reports() {
    let folder = folder();
    let path = folder.path();
    simulate(path, "explore map.txt --out 1 --scans log");
    let mut score = Keys::new();
    let scores = simulate(path, "replay-scans log --cell-size 0.5 --json --out 2");
    for line in scores.lines() {
        add_json(line, &mut score);
    }
    assert_same("Logs of scans", &score);

    let world = WorldReport {
        ticks: 0,
        reachable_cells: 0,
        seen_cells: 0,
        stops: Vec::new(),
    };
    let robot = RobotReport {
        robot: 0,
        stop: None,
        steps: 0,
        free_cells_known: 0,
        frames_sent: 0,
        bytes_sent: 0,
        frames_heard: 0,
        frames_refused: 0,
    };
    let mut reports = Keys::new();
    add_keys(&json!([world, robot]), &mut reports);
    assert_same("Robots as processes", &reports);
}
