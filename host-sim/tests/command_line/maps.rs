//! `explore` with files: maps of robots, saves, masks.

use super::*;

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
