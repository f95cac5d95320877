//! What is refused, and in which words.

use std::fs;

use super::{assert_refused, picture, rooms};

#[test]
fn what_does_not_apply_is_refused_by_its_name() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    for option in [
        "--planner fcao",
        "--planner coordinated-survey",
        "--step 9",
        "--min-altitude 2",
        "--ceiling 40",
        "--skip 0.9",
        "--skip 0",
    ] {
        let name = option.split(' ').next().unwrap();
        let arguments = format!("--terrain town:1 --size 24 {option}");
        assert_refused(path, &arguments, &[name, "does not apply", "town"]);
    }
    for option in [
        "close 3,4",
        "blind 3,4",
        "sensor-fails 0@1",
        "pose-lost 0@1-2",
    ] {
        let arguments = format!("--terrain town:1 --size 24 --{option}");
        let (name, _) = option.split_once(' ').unwrap();
        assert_refused(path, &arguments, &[name, "does not apply"]);
    }
    assert_refused(path, "--size 24 --shut 3,4", &["shut", "does not apply"]);
    for preset in ["rangers", "lidar"] {
        let arguments = format!("--size 24 --preset {preset}");
        let words = [&arguments[10..], "over a terrain of heights", "town:SEED"];
        assert_refused(path, &arguments, &words);
    }
    assert_refused(path, "--size 24 --close 30,4", &["--close 30,4", "24×24"]);
    for option in ["delay 2", "duplicate 0.5", "corrupt 0.5", "forge 2"] {
        let arguments = format!("--size 16 --medium ideal --{option}");
        let (name, _) = option.split_once(' ').unwrap();
        assert_refused(path, &arguments, &[name, "--medium radio"]);
    }
    assert_refused(
        path,
        "--terrain town:1 --size 200",
        &["--size 200", "8 to 64"],
    );
    picture(&path.join("flat.png"), 16, 16, 0);
    assert_refused(
        path,
        "--terrain flat.png --size 16",
        &["--size", "does not apply"],
    );
    assert_refused(
        path,
        "--medium ideal --byte-budget 55",
        &["--byte-budget", "--medium radio"],
    );
}

#[test]
fn settings_out_of_their_ranges_are_refused_over_every_terrain() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    picture(&path.join("flat.png"), 16, 16, 0);
    let places = [
        "--terrain gaussian:1 --size 16",
        "--terrain urban:1 --size 16",
        "--terrain flat.png",
        "--terrain town:1 --size 16",
    ];
    for place in places {
        for range in ["0", "nan", "inf", "-1", "12.5", "40", "1e30"] {
            let arguments = format!("{place} --range={range}");
            assert_refused(path, &arguments, &["--range", "12"]);
        }
        for share in ["nan", "-0.1", "1.5", "inf"] {
            assert_refused(path, &format!("{place} --loss={share}"), &["--loss", "0 "]);
        }
        for robots in ["0", "65", "-1"] {
            let arguments = format!("{place} --robots={robots}");
            assert_refused(path, &arguments, &["--robots", "1..=64"]);
        }
    }
    for place in &places[..3] {
        for number in ["0", "nan", "inf", "-1", "1e9"] {
            let arguments = format!("{place} --step={number}");
            assert_refused(path, &arguments, &["--step", "0.1 to 100"]);
        }
        for number in ["nan", "inf", "-1", "8"] {
            let arguments = format!("{place} --min-altitude={number}");
            assert_refused(path, &arguments, &["--min-altitude", "range of 8"]);
        }
        for number in ["nan", "inf", "-1", "1e9"] {
            let arguments = format!("{place} --ceiling={number}");
            assert_refused(path, &arguments, &["--ceiling", "at most 500"]);
        }
        let arguments = format!("{place} --robots 2 --kill 7@3");
        assert_refused(path, &arguments, &["--kill", "no robot 7", "0 to 1"]);
    }
    assert_refused(path, "--terrain town:1 --range 2.5", &["--range", "whole"]);
    assert_refused(path, "--terrain town:1 --range 1", &["--range", "from 2"]);
}

#[test]
fn files_that_are_no_terrains_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    for (file, content, words) in [
        (
            "tree.ot",
            "# Octomap OcTree file\n",
            ["complete OctoMap tree", ".ot"],
        ),
        ("cloud.pcd", "# .PCD v0.7\n", ["PCD", "--scene"]),
        (
            "mesh.ply",
            "ply\nformat ascii 1.0\n",
            ["PLY mesh", "--scene"],
        ),
        ("photo.png", "\u{42}\u{4d}", ["a BMP picture", "magick"]),
        (
            "flat.yaml",
            "image: a.pgm",
            ["a flat map", "host-sim explore"],
        ),
        ("empty.png", "", ["is empty", "grey PNG"]),
        (
            "cut.bt",
            "# Octomap OcTree binary file\nsize 9\nres 1\ndata\n",
            ["cut off", ".bt"],
        ),
    ] {
        fs::write(path.join(file), content).unwrap();
        let arguments = format!("--terrain {file}");
        assert_refused(path, &arguments, &[&[file][..], &words].concat());
    }
    assert_refused(path, "--terrain moon:1", &["moon:1", "gaussian:SEED"]);
    assert_refused(path, "--terrain .", &["folder", "grey PNG"]);
    #[cfg(unix)]
    assert_refused(path, "--terrain /dev/zero", &["/dev/zero", "device"]);
    picture(&path.join("wide.png"), 513, 1, 0);
    assert_refused(path, "--terrain wide.png", &["513×1", "1 to 512"]);
}

#[test]
fn scenes_and_places_that_do_not_fit_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    rooms()
        .write(fs::File::create(path.join("rooms.bt")).unwrap())
        .unwrap();
    fs::write(path.join("cloud.las"), "LASF").unwrap();
    fs::write(path.join("hill.asc"), "ncols 1\nnrows 1\ncellsize 1\n5\n").unwrap();
    for (arguments, words) in [
        ("--scene rooms.bt --start 0,0.5", ["X,Y,Z", "three"]),
        (
            "--scene rooms.bt --start 9,0.5,0.5",
            ["--start 9,0.5,0.5", "outside"],
        ),
        (
            "--scene rooms.bt --start -0.95,0.15,0.15",
            ["-0.95,0.15,0.15", "-1.15,0.25,0.25"],
        ),
        (
            "--scene rooms.bt --voxel-size 0.15",
            ["rooms.bt", "--voxel-size 0.15"],
        ),
        (
            "--scene rooms.bt --planner fcao",
            ["--planner", "does not apply"],
        ),
        (
            "--scene rooms.bt --terrain town:1",
            ["--scene", "--terrain"],
        ),
        ("--scene none.bt", ["none.bt", "no such file"]),
        ("--scene cloud.las", ["cloud.las", "expected an OctoMap"]),
        ("--start 1,1,1", ["--start", "--scene"]),
        ("--voxel-size 2", ["--voxel-size", "--scene"]),
        (
            "--terrain town:1 --voxel-size 2",
            ["--voxel-size", "--scene"],
        ),
        ("--terrain gaussian:1 --margin 1", ["--margin", "--scene"]),
        ("--terrain town:1 --free rest", ["--free", "--scene"]),
        ("--scene town:1", ["--scene town:1", "--terrain town:1"]),
        ("--scene hill.asc", ["hill.asc", "give --terrain hill.asc"]),
        ("--terrain none.asc", ["no such file", "ESRI ASCII grid"]),
        ("--energy -5", ["--energy", "expected 1 to"]),
        (
            "--scene rooms.bt --radius 0.07m",
            ["0.07m", "a number of metres"],
        ),
        (
            "--terrain town:1 --metres-per-cell 1 --speed -1",
            ["--speed -1", "metres a second"],
        ),
        (
            "--scene rooms.bt --start 0,0,50",
            ["--start 0,0,50", "from -2."],
        ),
        (
            "--scene rooms.bt --voxel-size 1.5 --clearance 3",
            ["no room", "smaller --clearance"],
        ),
        (
            "--scene rooms.bt --speed 0",
            ["--speed 0", "metres a second"],
        ),
        (
            "--scene rooms.bt --home 91,0",
            ["--home", "LATITUDE,LONGITUDE"],
        ),
        ("--home 1,1", ["--home", "--metres-per-cell"]),
        (
            "--terrain town:1 --speed 1",
            ["--speed", "--metres-per-cell"],
        ),
        ("--crazyflie", ["--crazyflie", "--speed"]),
        (
            "--terrain town:1 --metres-per-cell 0",
            ["--metres-per-cell 0", "0.001"],
        ),
        (
            "--terrain town:1 --metres-per-cell 1 --metres-per-level 1",
            ["--metres-per-level", "town"],
        ),
        (
            "--metres-per-level 1",
            ["--metres-per-level", "drawn by a seed"],
        ),
        (
            "--scene rooms.bt --metres-per-cell 1",
            ["--metres-per-cell", "--scene"],
        ),
        ("--sensor camera", ["--sensor camera", "among voxels"]),
        ("--radius 0.1", ["wide a column is", "--metres-per-cell"]),
        (
            "--metres-per-cell 0.1 --radius 0.5",
            ["with columns of 0.1 m at most 0.30 m", "0.17 m or more"],
        ),
        (
            "--clearance 3 --min-altitude 2",
            ["--min-altitude 2: expected 3 or more", "--clearance 3"],
        ),
        (
            "--terrain town:1 --radius 0.1",
            ["--radius", "--metres-per-cell"],
        ),
        (
            "--scene rooms.bt --radius 0.3",
            ["with voxels of 0.1 m at most 0.25 m", "0.12 m or more"],
        ),
        (
            "--scene rooms.bt --radius 0.1 --clearance 1",
            ["--radius", "--clearance"],
        ),
        ("--cut 1", ["--cut", "among voxels"]),
        (
            "--scene rooms.bt --cut 1",
            ["--cut 1: lies outside", "from -0.10 to 1.00"],
        ),
        ("--fov 90x60", ["--fov", "among voxels"]),
        ("--scene rooms.bt --fov 90x60", ["--fov", "--sensor camera"]),
        (
            "--scene rooms.bt --sensor camera --fov 30x60",
            ["--fov", "45 to 170"],
        ),
    ] {
        assert_refused(path, arguments, &words);
    }
}

#[test]
fn a_folder_that_cannot_be_written_to_stops_the_survey_before_it_starts() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    fs::write(path.join("taken"), "a file").unwrap();
    for place in ["gaussian:1", "town:1"] {
        let arguments = format!("--terrain {place} --size 16 --robots 1 --out taken");
        assert_refused(path, &arguments, &["taken", "--out"]);
    }
}
