//! What comes out: summaries, maps, pictures, missions.

use std::collections::BTreeMap;
use std::fs;

use host_sim::scene::octree::OcTree;
use serde_json::Value;

use super::{assert_refused, picture, rooms, survey};

#[test]
fn robots_that_do_not_fit_are_refused_with_what_would() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    picture(&path.join("small.png"), 3, 3, 4);
    assert_refused(
        path,
        "--terrain small.png --robots 2",
        &["2 robots", "3×3", "--robots 1"],
    );
    picture(&path.join("tiny.png"), 1, 1, 4);
    assert_refused(path, "--terrain tiny.png --robots 1", &["1×1", "3×3"]);
    assert_refused(
        path,
        "--terrain gaussian:0 --size 8 --robots 16",
        &["16 robots", "--robots 9"],
    );
    picture(&path.join("high.png"), 16, 16, 255);
    assert_refused(
        path,
        "--terrain high.png --robots 2",
        &["66.75", "ceiling of 40", "--ceiling 66.75"],
    );
    // And what would does.
    let arguments = "--terrain high.png --robots 2 --ceiling 66.75 --json";
    let assert = survey(path, arguments).assert().success();
    let summary: Value = serde_json::from_slice(&assert.get_output().stdout).unwrap();
    assert_eq!(summary["complete"], true);
    assert_eq!(summary["violations"], 0);
}

#[test]
fn a_scan_is_surveyed_voxel_by_voxel_and_its_map_lies_where_it_does() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    rooms()
        .write(fs::File::create(path.join("rooms.bt")).unwrap())
        .unwrap();
    let arguments = "--scene rooms.bt --robots 2 --range 4 --start -1.55,0.45,0.35 --speed 0.5 \
                     --home 60,-1 --json --out out";
    let assert = survey(path, arguments).assert().success();
    let summary: Value = serde_json::from_slice(&assert.get_output().stdout).unwrap();
    let said = String::from_utf8_lossy(&assert.get_output().stderr);
    assert!(said.contains("satellites do not reach"), "{said}");
    assert_eq!(summary["map"], "rooms");
    assert_eq!(summary["complete"], true);
    assert_eq!(summary["voxel_size"], 0.1);
    assert_eq!(summary["robots"][0]["start"], serde_json::json!([5, 4, 4]));
    let (ticks, steps) = (&summary["ticks"], &summary["robots"][1]["steps"]);
    let times = |value: &Value, factor: f64| value.as_f64().unwrap() * factor;
    assert!((times(&summary["seconds"], 1.0) - times(ticks, 0.2)).abs() < 1e-9);
    assert!((times(&summary["robots"][1]["metres"], 1.0) - times(steps, 0.1)).abs() < 1e-9);
    let plan: Value =
        serde_json::from_slice(&fs::read(path.join("out/mission-1.plan")).unwrap()).unwrap();
    assert_eq!(plan["mission"]["hoverSpeed"], 0.5);
    let way = fs::read_to_string(path.join("out/mission-1.waypoints")).unwrap();
    let items = plan["mission"]["items"].as_array().unwrap().len();
    assert_eq!(way.lines().count(), items + 2);
    let cloud = fs::read_to_string(path.join("out/map.ply")).unwrap();
    let seen = format!("element vertex {}\n", cloud.lines().count() - 8);
    assert!(cloud.contains(&seen), "{seen}");
    // Of both rooms two ends are not in the scan.
    let ends = 2 * 7 * (9 + 11);
    assert_eq!(summary["edge_cells"], ends);
    let map = fs::read(path.join("out/map.bt")).unwrap();
    let map = OcTree::read(&map[..]).unwrap();
    assert_eq!(map.resolution(), 0.1);
    let known = |tree: &OcTree| -> BTreeMap<[i32; 3], bool> {
        let cubes = tree.cubes().into_iter();
        let voxels = cubes.flat_map(|cube| {
            let [x, y, z] = cube.corner;
            let side = 0..cube.side;
            let corners = side.clone().flat_map(move |i| {
                let side = side.clone();
                side.clone()
                    .flat_map(move |j| side.clone().map(move |k| [x + i, y + j, z + k]))
            });
            corners.map(move |voxel| (voxel, cube.occupied))
        });
        voxels.collect()
    };
    let (all, seen) = (known(&rooms()), known(&map));
    for (voxel, occupied) in &seen {
        assert_eq!(all.get(voxel), Some(occupied), "{voxel:?}");
    }
    let is_of_two_rooms = |voxel: &&[i32; 3]| voxel[0] < 2;
    let free = all.iter().filter(|(_, occupied)| !**occupied);
    for (voxel, _) in free.filter(|(voxel, _)| is_of_two_rooms(voxel)) {
        assert!(seen.contains_key(voxel), "{voxel:?}");
    }
    assert!(seen.keys().all(|voxel| voxel[0] <= 2));
}

/// A room of 2 m as the triangles of its six walls, the room's lower corner at 0.
fn mesh_of_a_room() -> String {
    let mut text = "solid room\n".to_string();
    for axis in 0..3 {
        for at in [0.0, 2.0] {
            let corner = |u: f64, v: f64| {
                let mut corner = [at; 3];
                (corner[(axis + 1) % 3], corner[(axis + 2) % 3]) = (u, v);
                format!("vertex {} {} {}\n", corner[0], corner[1], corner[2])
            };
            for [u, v] in [[2.0, 0.0], [0.0, 2.0]] {
                let corners = [corner(0.0, 0.0), corner(u, v), corner(2.0, 2.0)].concat();
                let facet = format!("outer loop\n{corners}endloop\nendfacet\n");
                text += &format!("facet normal 0 0 0\n{facet}");
            }
        }
    }
    text + "endsolid room\n"
}

#[test]
fn a_mesh_is_surveyed_from_inside_and_a_cloud_along_its_rays() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    fs::write(path.join("room.stl"), mesh_of_a_room()).unwrap();
    let arguments = "--scene room.stl --voxel-size 0.2 --robots 1 --range 4 --json --out mesh";
    let assert = survey(path, arguments).assert().success();
    let summary: Value = serde_json::from_slice(&assert.get_output().stdout).unwrap();
    assert_eq!(summary["complete"], true);
    assert_eq!(summary["free_space"], "rest");
    // The walls of a room of 9 voxels; their edges are seen or not.
    let walls = summary["reachable_cells"].as_u64().unwrap();
    assert!(
        (6 * 9 * 9..=11 * 11 * 11 - 9 * 9 * 9).contains(&walls),
        "{walls}"
    );

    // What is seen of the same room from its middle.
    let walls = fs::read_to_string(path.join("mesh/map.ply")).unwrap();
    let points: Vec<&str> = walls.lines().skip(8).collect();
    let header = format!(
        "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH {0}\nHEIGHT 1\n\
         VIEWPOINT 1 1 1 1 0 0 0\nPOINTS {0}\nDATA ascii\n",
        points.len()
    );
    fs::write(path.join("room.pcd"), header + &points.join("\n")).unwrap();
    for (free, complete) in [("rest", true), ("rays", true)] {
        let arguments = format!(
            "--scene room.pcd --voxel-size 0.2 --free {free} --start 1.1,1.1,1.1 --robots 1 \
             --range 4 --json --out {free}"
        );
        let assert = survey(path, &arguments).assert().success();
        let summary: Value = serde_json::from_slice(&assert.get_output().stdout).unwrap();
        assert_eq!(summary["complete"], complete);
        assert_eq!(summary["free_space"], free);
    }
    for (arguments, words) in [
        ("--scene room.stl", ["--voxel-size 0.02", "2.0×2.0×2.0 m"]),
        (
            "--scene room.stl --voxel-size 0.2 --free rays",
            ["--free rays", "a mesh"],
        ),
        (
            "--scene room.pcd --voxel-size 0.001",
            ["2002×2002×2002", "--voxel-size 0.008 or more"],
        ),
        (
            "--scene mesh/map.ply --voxel-size 0.2 --free rays",
            ["map.ply", "VIEWPOINT"],
        ),
        (
            "--scene mesh/map.bt --margin 1",
            ["--margin", "OctoMap tree"],
        ),
        ("--free rest", ["--free", "--scene"]),
    ] {
        assert_refused(path, arguments, &words);
    }
}

/// Over heights and in a town; and what one run writes, the next one does not leave.
#[test]
fn metres_and_seconds_are_told_wherever_a_cell_has_metres() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let run = |arguments: &str| -> Value {
        let arguments = format!("{arguments} --robots 1 --json --out out");
        let assert = survey(path, &arguments).assert().success();
        serde_json::from_slice(&assert.get_output().stdout).unwrap()
    };
    let number = |value: &Value| value.as_f64().unwrap();
    let near = |a: f64, b: f64| (a - b).abs() < 1e-9 * b;
    let names = ["mission-0.plan", "mission-0.waypoints", "trajectory-0.csv"];
    let are_there = || names.map(|name| path.join("out").join(name).exists());
    let metric = "--metres-per-cell 2.5 --speed 0.5 --home 60,-1 --crazyflie";

    let plain = run("--terrain gaussian:3 --size 16");
    assert_eq!(plain["cell_size"], Value::Null);
    assert_eq!(plain["seconds"], Value::Null);
    let heights = run(&format!("--terrain gaussian:3 --size 16 {metric}"));
    assert_eq!(heights["trace_digest"], plain["trace_digest"]);
    assert!(near(
        number(&heights["seconds"]),
        10.0 * number(&heights["ticks"])
    ));
    let robot = &heights["robots"][0];
    assert!(near(
        number(&robot["metres"]),
        2.5 * number(&robot["distance"])
    ));
    assert_eq!(are_there(), [true; 3]);
    // Rows lead south, and the robot starts in the middle of a column near the corner.
    let way = fs::read_to_string(path.join("out/trajectory-0.csv")).unwrap();
    let first: Vec<f64> = way
        .lines()
        .nth(1)
        .unwrap()
        .split(',')
        .map(|it| it.parse().unwrap())
        .collect();
    assert_eq!((first[1], first[9]), (2.5 * 2.5, -2.5 * 2.5));

    let plain = run("--terrain town:1 --size 8 --range 4");
    assert_eq!(are_there(), [false; 3]);
    assert_eq!(plain["planner"], "voxel-survey");
    let greedy = run("--terrain town:1 --size 8 --range 4 --planner greedy");
    assert_eq!(greedy["planner"], "greedy");
    let town = run(&format!("--terrain town:1 --size 8 --range 4 {metric}"));
    assert_eq!(town["trace_digest"], plain["trace_digest"]);
    assert_eq!(
        (&town["voxel_size"], &plain["voxel_size"]),
        (&2.5.into(), &Value::Null)
    );
    assert!(near(number(&town["seconds"]), 5.0 * number(&town["ticks"])));
    assert_eq!(are_there(), [true; 3]);
}

/// In both worlds, with what is left of the energy; and a mission for each charge.
#[test]
fn summaries_say_whether_robots_are_home_and_with_what_energy() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    for place in ["gaussian:1", "town:1"] {
        let place = format!("--terrain {place} --size 16 --robots 1 --metres-per-cell 1 --json");
        let robot = |arguments: &str| -> Value {
            let assert = survey(path, &format!("{place} --out out {arguments}")).assert();
            let mut summary: Value = serde_json::from_slice(&assert.get_output().stdout).unwrap();
            summary["robots"][0].take()
        };
        assert_eq!(robot("")["energy_left"], Value::Null);
        let out = |name: &str| path.join("out").join(name).exists();
        let flown = robot("--energy 60 --resume 0@100 --home 60,20 --speed 1 --crazyflie");
        assert_eq!(flown["is_home"], true, "{place}");
        let left = flown["energy_left"].as_i64().unwrap();
        assert!((0..60).contains(&left), "{place}: {left}");
        assert!(out("mission-0.plan") && out("mission-0-2.plan") && out("trajectory-0-2.csv"));
        assert!(!out("mission-0-3.plan"));
        let cut = robot("--energy 60 --max-ticks 9");
        assert_eq!(cut["is_home"], false, "{place}");
        // A run that is cut off counts the last decision, or does not.
        let left = cut["energy_left"].as_i64().unwrap();
        assert!((50..=51).contains(&left), "{place}: {left}");
        let arguments = format!("{place} --max-ticks 9 --energy 60 --resume 0@20 --out out");
        let assert = survey(path, &arguments).assert().code(1);
        let message = String::from_utf8_lossy(&assert.get_output().stderr).into_owned();
        assert!(
            message.contains("--resume 0@20 was not carried out"),
            "{message}"
        );
    }
}

#[test]
fn what_wind_and_width_come_to_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let said = |arguments: &str| {
        let output = survey(folder.path(), arguments).output().unwrap();
        String::from_utf8(output.stdout).unwrap()
    };
    let heights = said("--size 16 --robots 1 --wind 0.2 --clearance 1 --range 12");
    assert!(heights.contains("steps that the wind ended"), "{heights}");
    assert!(heights.contains("for slopes of at most 2."), "{heights}");
    let voxels = said("--terrain town:1 --size 16 --robots 1 --wind 0.3");
    assert!(voxels.contains("beside or in something"), "{voxels}");
    let calm = said("--size 16 --robots 1");
    assert!(!calm.contains("wind") && !calm.contains("slopes"), "{calm}");
}

#[test]
fn a_survey_that_is_given_up_says_what_is_left() {
    let folder = tempfile::tempdir().unwrap();
    for place in ["gaussian:1", "town:1"] {
        let arguments = format!("--terrain {place} --size 24 --robots 1 --max-ticks 2 --json");
        let assert = survey(folder.path(), &arguments).assert().code(1);
        let output = assert.get_output();
        let summary: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(summary["complete"], false);
        let message = String::from_utf8_lossy(&output.stderr);
        assert!(message.contains("not complete"), "{message}");
        assert!(message.contains("unseen after 2 steps"), "{message}");
    }
}

/// The rooms have a ceiling, so that both pictures are cut.
#[test]
fn pictures_of_a_building_are_cut_where_one_says() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    rooms()
        .write(fs::File::create(path.join("rooms.bt")).unwrap())
        .unwrap();
    let pictures = |cut: &str| {
        let arguments = format!("--scene rooms.bt --robots 1 --range 4 --json --out out {cut}");
        survey(path, &arguments).assert().success();
        ["explored.png", "oblique.png"].map(|name| fs::read(path.join("out").join(name)).unwrap())
    };
    let usual = pictures("");
    // In the middle of the rooms, whose inside reaches from 0.1 to 0.8 m.
    assert!(pictures("--cut 0.45") == usual);
    let [plan, aside] = pictures("--cut 0.65");
    assert!(plan != usual[0] && aside != usual[1]);
}
