//! What is asked of a planner, and the words of its codes.

use std::ffi::{CStr, c_char};

use planner_core::radio::GridId;
use planner_core::sight::ZoneError;

use super::*;

#[test]
fn a_sensor_is_one_of_the_constants_and_its_margin_three_at_most() {
    let mut memory = memory();
    let place = planner(&mut memory);
    for (sensor, margin, result) in [
        (PlannerSensor::Rangers as u8, 0, PlannerResult::Ok),
        (PlannerSensor::Lidar as u8, 3, PlannerResult::Ok),
        (PlannerSensor::Truthful as u8, 1, PlannerResult::Ok),
        (3, 0, PlannerResult::Sensor),
        (0, 4, PlannerResult::Sensor),
    ] {
        let config = PlannerConfig {
            sensor,
            margin,
            ..CONFIG
        };
        assert_eq!(
            planner_create(place, SIZE, &config),
            result,
            "{sensor}, {margin}"
        );
    }
    for (clearance, result) in [(3, PlannerResult::Ok), (4, PlannerResult::Clearance)] {
        let config = PlannerConfig {
            clearance,
            ..CONFIG
        };
        assert_eq!(planner_create(place, SIZE, &config), result);
    }
}

#[test]
fn what_was_shut_is_named() {
    let mut memory = memory();
    let ready = created(&mut memory, CONFIG);
    let seen = |blocked| PlannerSeen {
        cell: PlannerCell { x: 2, y: 1 },
        blocked,
    };
    let shut = |room| {
        let (mut cells, mut count) = (9, 9);
        let mut places = [PlannerCell { x: -1, y: -1 }; PLANNER_MAX_SHUT];
        let result = planner_shut(ready, &mut cells, places.as_mut_ptr(), room, &mut count);
        assert_eq!(result, PlannerResult::Ok);
        (cells, places[..count].to_vec())
    };
    let look = |blocked| {
        let at = PlannerCell { x: 1, y: 1 };
        let seen = [seen(blocked)];
        assert_eq!(
            planner_observe_cells(ready, at, seen.as_ptr(), 1),
            PlannerResult::Ok
        );
        tick(ready);
    };
    look(0);
    assert_eq!(shut(8), (0, vec![]));
    for _ in 0..4 {
        look(1);
    }
    assert_eq!(shut(8), (1, vec![PlannerCell { x: 2, y: 1 }]));
    assert_eq!(shut(0), (1, vec![]));
    let (mut cells, mut count) = (0, 0);
    let result = planner_shut(ready, &mut cells, null_mut(), 8, &mut count);
    assert_eq!(result, PlannerResult::Null);
}

#[test]
fn a_map_is_read_by_cells_and_by_rows() {
    let mut memory = memory();
    let ready = created(&mut memory, CONFIG);
    let read = |x, y| {
        let mut state = 9;
        let result = planner_cell(ready, PlannerCell { x, y }, &mut state);
        (result, state)
    };
    let seen = [(2, 1, 0), (3, 1, 1)].map(|(x, y, blocked)| PlannerSeen {
        cell: PlannerCell { x, y },
        blocked,
    });
    planner_observe_cells(ready, CONFIG.start, seen.as_ptr(), seen.len());
    let [unknown, frontier, obstacle] = [
        PlannerState::Unknown as u8,
        PlannerState::Frontier as u8,
        PlannerState::Obstacle as u8,
    ];
    let expected = [unknown, frontier, frontier, obstacle, unknown];
    for (x, &state) in (0..).zip(&expected) {
        assert_eq!(read(x, 1), (PlannerResult::Ok, state), "{x}");
    }
    for (x, y) in [(-1, 1), (9, 1), (1, 9)] {
        assert_eq!(read(x, y), (PlannerResult::OffGrid, 9));
    }
    let (mut row, mut count) = ([9; 12], 0);
    let result = planner_row(ready, 1, row.as_mut_ptr(), 5, &mut count);
    assert_eq!((result, count), (PlannerResult::Ok, 5));
    assert_eq!((&row[..5], row[5]), (&expected[..], 9));
    let result = planner_row(ready, 1, row.as_mut_ptr(), 12, &mut count);
    assert_eq!(
        (result, count, row[8], row[9]),
        (PlannerResult::Ok, 9, unknown, 9)
    );
    let result = planner_row(ready, 9, row.as_mut_ptr(), 12, &mut count);
    assert_eq!(result, PlannerResult::OffGrid);
}

#[test]
fn a_status_says_where_the_robot_is_and_goes() {
    let mut memory = memory();
    let ready = created(&mut memory, CONFIG);
    assert_eq!(look(ready, CONFIG.start), PlannerResult::Ok);
    assert_eq!(tick(ready).kind, PlannerActionKind::Move);
    let now = status(ready);
    assert_eq!((now.position, now.has_goal), (CONFIG.start, 1));
    assert_ne!(now.goal, now.position);
    assert!(now.frontiers > 0 && now.known >= 5, "{now:?}");
    assert_eq!(
        (now.contradictions, now.contradicted_by, now.refused),
        (0, 255, 0)
    );
}

#[test]
fn metres_are_those_of_the_core() {
    let config = PlannerConfig {
        origin_x_mm: -450,
        origin_y_mm: 450,
        ..CONFIG
    };
    let mut pose = PlannerPose {
        x: 0.0,
        y: 0.0,
        heading: 0.0,
    };
    let made = planner_pose_from_metres(&config, 0.1, 0.2, 0.5, &mut pose);
    assert_eq!(made, PlannerResult::Ok);
    assert!(
        (pose.x - 5.5).abs() < 1e-4 && (pose.y - 2.5).abs() < 1e-4,
        "{pose:?}"
    );
    assert_eq!(pose.heading, -0.5);
    let (mut x, mut y) = (0.0, 0.0);
    let cell = PlannerCell { x: 5, y: 2 };
    assert_eq!(
        planner_middle_in_metres(&config, cell, &mut x, &mut y),
        PlannerResult::Ok
    );
    assert!((x - 0.1).abs() < 1e-5 && (y - 0.2).abs() < 1e-5, "{x}, {y}");
    assert!(planner_yaw(PlannerDirection::North as u8) > 1.5);
    let none = PlannerConfig {
        cell_mm: 0,
        ..config
    };
    let made = planner_pose_from_metres(&none, 0.1, 0.2, 0.5, &mut pose);
    assert_eq!(made, PlannerResult::CellSize);
}

/// What a function of words returns.
fn read(text: *const c_char) -> &'static str {
    // SAFETY: all texts are constants that end with a zero byte.
    unsafe { CStr::from_ptr(text) }.to_str().unwrap()
}

#[test]
fn codes_have_words() {
    assert_eq!(
        read(planner_result_text(PlannerResult::Memory as u8)),
        "header and library are of different sizes"
    );
    assert_eq!(
        read(planner_stop_text(PlannerStop::Held as u8)),
        "gave up: a robot stayed in the way"
    );
    assert_eq!(
        read(planner_wait_text(PlannerWait::Doubt as u8)),
        "doubts a wall"
    );
    let header = include_str!("../../include/planner.h");
    let named = |prefix: &str| -> Vec<u8> {
        let entries = header
            .lines()
            .filter_map(|line| line.trim().strip_prefix(prefix));
        let code = |entry: &str| {
            entry
                .split_once(" = ")?
                .1
                .trim_end_matches(',')
                .parse()
                .ok()
        };
        entries.filter_map(code).collect()
    };
    let (results, waits) = (named("PLANNER_RESULT_"), named("PLANNER_WAIT_"));
    assert!(results.len() > 20 && waits.len() > 5);
    let is_told = |code: &u8| read(planner_result_text(*code)) != "unknown";
    assert_eq!(results.iter().find(|code| !is_told(code)), None);
    assert!(
        waits
            .iter()
            .all(|&wait| read(planner_wait_text(wait)) != "unknown")
    );
    for beyond in [crate::queries::RESULTS.len(), 255] {
        assert_eq!(read(planner_result_text(beyond as u8)), "unknown");
    }
    for code in 0..=u8::MAX {
        let stop = code.checked_sub(1).and_then(Reason::from_code);
        let words = read(planner_stop_text(code));
        assert_eq!(stop.is_some() || code == 0, words != "unknown", "{code}");
        if let Some(reason) = stop {
            assert_eq!(
                words.starts_with("complete"),
                reason.is_complete(),
                "{words}"
            );
        }
    }
}

#[test]
fn words_begin_as_those_of_rust() {
    let alike = |ours: &str, theirs: &str| {
        let shared = ours.bytes().zip(theirs.bytes());
        let shared = shared.take_while(|(a, b)| a == b).count();
        assert!(shared >= ours.len().min(12), "{ours}; {theirs}");
    };
    let at = Cell::new(3, 4);
    for stop in [
        Stop::Complete,
        Stop::Enclosed { frontiers: 1 },
        Stop::Blocked { frontiers: 1, at },
        Stop::BackAtStart { frontiers: 1 },
        Stop::NoTrace { frontiers: 1 },
        Stop::AtEdge { cells: 1 },
        Stop::OutOfReach { frontiers: 1 },
        Stop::Unseen { frontiers: 1, at },
        Stop::Held { frontiers: 1, at },
        Stop::Home { frontiers: 1 },
        Stop::Arrived { frontiers: 1, at },
        Stop::NoWay { frontiers: 1, at },
    ] {
        let code = PlannerStop::from(stop.reason()) as u8;
        alike(read(planner_stop_text(code)), &stop.to_string());
    }
    for error in [
        FrameError::Length(3),
        FrameError::Version(9),
        FrameError::Kind(9),
        FrameError::Check,
        FrameError::OtherGrid(GridId(1)),
        FrameError::Own,
        FrameError::SameId(RobotId(1)),
        FrameError::Field(Field::Goal),
    ] {
        let code = PlannerResult::from(error) as u8;
        alike(read(planner_result_text(code)), &error.to_string());
    }
    for error in [
        ZoneError::FieldOfView,
        ZoneError::Pitch,
        ZoneError::Yaw,
        ZoneError::Heights,
        ZoneError::Zero,
    ] {
        let code = PlannerResult::from(error) as u8;
        alike(read(planner_result_text(code)), &error.to_string());
    }
}
