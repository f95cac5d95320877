//! `replay-scans`.

use super::*;

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
