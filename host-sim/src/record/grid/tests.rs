use std::sync::Arc;

use planner_core::{Cell, Direction, Extent, RobotId};

use sha2::{Digest, Sha256};

use super::*;
use crate::planners::PlannerKind;
use crate::robot::Sent;
use crate::run::{Options, run};
use crate::scenario::{AirFaults, MediumKind, Reach};
use crate::scenario::{CellSpan, Event, Faults, RobotSpan};
use crate::world::{Family, Starts, World, generate};

fn trace() -> Trace {
    let world = Arc::new(generate(Family::Rooms, 40, 30, 7).unwrap());
    let starts = world.place(3, &Starts::Center, false).unwrap();
    let mut scenario = Scenario::new(world, starts, PlannerKind::Closest);
    scenario.conditions.loss = 0.3;
    scenario.conditions.medium = MediumKind::Radio;
    scenario.conditions.air = AirFaults {
        reach: Reach::Cells(20),
        delay: 3,
        corruption: 0.1,
        ..AirFaults::default()
    };
    scenario.conditions.seed = u64::MAX;
    scenario.conditions.max_ticks = 400;
    scenario.conditions.faults = Faults {
        deaths: vec![Event {
            robot: RobotId(1),
            tick: 40,
        }],
        closures: vec![CellSpan {
            cell: Cell::new(9, 9),
            from: 3,
            until: 50,
        }],
        arrivals: vec![Event {
            robot: RobotId(2),
            tick: 7,
        }],
        restarts: vec![Event {
            robot: RobotId(1),
            tick: 90,
        }],
        resumes: vec![Event {
            robot: RobotId(0),
            tick: 60,
        }],
        shut: vec!["2,2@4-6".parse().unwrap()],
        blind: vec![CellSpan {
            cell: Cell::new(0, 3),
            from: 0,
            until: u32::MAX,
        }],
        sensor_failures: vec![Event {
            robot: RobotId(2),
            tick: 200,
        }],
        lost_poses: vec![RobotSpan {
            robot: RobotId(0),
            from: 30,
            until: 35,
        }],
    };
    let options = Options {
        trace: true,
        ..Options::default()
    };
    run(&scenario, options).unwrap().1.unwrap()
}

fn text(trace: &Trace) -> String {
    let mut file = Vec::new();
    trace.write(&mut file).unwrap();
    String::from_utf8(file).unwrap()
}

#[test]
fn a_trace_survives_its_file_and_runs_again() {
    let trace = trace();
    let read = Trace::read(text(&trace).as_bytes()).unwrap();
    assert_eq!(read.records, trace.records);
    assert_eq!(text(&read), text(&trace));
    let options = Options {
        trace: true,
        ..Options::default()
    };
    let (_, again) = run(&read.scenario, options).unwrap();
    assert_eq!(again.unwrap().digest(), trace.digest());
}

#[test]
fn a_header_names_a_field_of_view_and_faults_of_senses_only_where_there_are_any() {
    let mut trace = trace();
    let names = ["fov", "resumes", "blind", "sensor_failures", "lost_poses"];
    let has = |text: &str, name: &str| text.contains(&format!("\"{name}\":"));
    for name in &names[1..] {
        assert!(has(&text(&trace), name), "{name}");
    }
    trace.scenario.conditions.faults = Faults::default();
    for name in names {
        assert!(!has(&text(&trace), name), "{name}");
    }
    let usual = text(&trace);
    assert_eq!(Trace::read(usual.as_bytes()).unwrap().scenario.fov, 360);
    let narrow = usual.replacen("\"range\":5", "\"range\":5,\"fov\":62", 1);
    let narrow = |planner: &str| narrow.replacen("\"closest\"", planner, 1);
    let read = Trace::read(narrow("\"explorer\"").as_bytes()).unwrap();
    assert_eq!(read.scenario.fov, 62);
    assert!(text(&read).contains("\"fov\":62"));
    let error = Trace::read(narrow("\"closest\"").as_bytes()).unwrap_err();
    assert!(error.to_string().contains("closest never turns"), "{error}");
    assert!(!has(&usual, "clearance"));
    let wide = usual.replacen("\"solid\":", "\"clearance\":1,\"solid\":", 1);
    let error = Trace::read(wide.as_bytes()).unwrap_err();
    assert!(error.to_string().contains("--clearance 1"), "{error}");
}

#[test]
fn an_action_is_read_as_it_was_written() {
    let first = trace().records[0];
    for action in 0..=u8::MAX {
        let deed = Deed::try_from(action);
        assert_eq!(
            deed.is_ok(),
            (0..23).contains(&action) || (32..44).contains(&action)
        );
        let Ok(deed) = deed else { continue };
        assert_eq!(u8::from(deed), action);
        let to = |first: u8| Direction::from_index(action - first);
        assert_eq!(
            deed.turns_to(),
            match action {
                0..16 => Some(to(action / 4 * 4)),
                18..22 => Some(to(18)),
                _ => None,
            }
        );
        let record = Record { deed, ..first };
        assert_eq!(record.after() != record.at, action < 4);
    }
}

#[test]
fn a_damaged_file_is_an_error_that_says_where() {
    let text = text(&trace());
    let error = |text: &str| Trace::read(text.as_bytes()).unwrap_err().to_string();
    assert!(error("").contains("line 1"));
    assert!(error("tick,robot").contains("line 1"));
    let cut = &text[..text[..text.len() - 1].rfind('\n').unwrap()];
    assert!(error(cut).contains("cut off"), "{}", error(cut));
    let broken = text.replacen("\n0,1,", "\n0,one,", 1);
    assert!(error(&broken).starts_with("line 4"), "{}", error(&broken));
    let action = |line: &str| {
        let mut fields: Vec<&str> = line.split(',').collect();
        fields[4] = "23";
        fields.join(",")
    };
    let line = text.lines().nth(3).unwrap();
    let wrong = error(&text.replacen(line, &action(line), 1));
    assert!(
        wrong.contains("line 4: expected an action, 0 to 22 or 32 to 43"),
        "{wrong}"
    );
    let edited = text.replacen("\n0,1,", "\n0,2,", 1);
    assert!(error(&edited).contains("digest"), "{}", error(&edited));
    let newer = text.replacen("\"version\":2", "\"version\":3", 1);
    assert!(error(&newer).contains("version 3"), "{}", error(&newer));
    let world = text.replacen("[\"#", "[\"##", 1);
    assert!(error(&world).contains("row 2"), "{}", error(&world));
}

#[test]
fn the_bytes_of_a_record_are_as_documented() {
    let record = Record {
        tick: 0x0102_0304,
        robot: 5,
        at: Cell::new(6, -2),
        deed: Deed::Moved(Direction::North),
        goal: None,
        gain: Nothing {},
        known: 7,
        work: 256,
        sent: Sent {
            frames: 1,
            bytes: 55,
        },
    };
    let bytes = [
        4, 3, 2, 1, 5, 6, 0, 254, 255, 3, 255, 255, 255, 255, 7, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0,
        55, 0, 0, 0,
    ];
    let digest = Sha256::digest(bytes);
    let digits = digest.iter().take(8).map(|byte| format!("{byte:02x}"));
    assert_eq!(record::digest(&[record]), digits.collect::<String>());
    assert_eq!(record.after(), Cell::new(6, -3));
}

/// The message on reading the trace with some records changed and its digest mended.
fn message(change: impl FnOnce(&mut Trace)) -> String {
    let mut trace = trace();
    change(&mut trace);
    Trace::read(text(&trace).as_bytes())
        .unwrap_err()
        .to_string()
}

#[test]
fn records_that_no_run_leaves_are_refused_with_their_line() {
    let says = |message: String, words: &[&str]| {
        for word in words {
            assert!(message.contains(word), "no {word:?} in {message}");
        }
    };
    // The third record stands in line 5: robot 0 in tick 1, as robot 2 comes late.
    let on = |change: &dyn Fn(&mut Record)| message(|trace| change(&mut trace.records[2]));
    says(
        on(&|it| it.at.x = 40),
        &["line 5", "inside the world of 40×30 cells", "40,"],
    );
    says(
        on(&|it| it.at = Cell::new(-7, -7)),
        &["line 5", "inside", "-7,-7"],
    );
    says(
        on(&|it| it.at = Cell::new(0, 0)),
        &["line 5", "where it was", "0,0"],
    );
    says(
        on(&|it| it.robot = 3),
        &["line 5", "a robot from 0 to 2", "\"3\""],
    );
    says(
        on(&|it| it.goal = Some(Cell::new(3, 30))),
        &["line 5", "a goal inside", "3,30"],
    );
    says(
        on(&|it| it.goal = Some(Cell::new(-1, 5))),
        &["line 5", "a goal", "-1,5"],
    );
    says(
        on(&|it| it.known = 1201),
        &["line 5", "1200 known cells", "1201"],
    );
    says(on(&|it| it.tick = 0), &["line 5", "once a tick", "robot 0"]);
    says(
        on(&|it| it.tick = u32::MAX),
        &["line 5", "a tick before 400"],
    );
    says(
        on(&|it| it.tick = 2),
        &["line 5", "tick 1, as no robot arrives"],
    );
    let back = message(|trace| trace.records[4].tick = 0);
    says(back, &["line 7", "ticks in order", "tick 0"]);
    let out = message(|trace| {
        let start = Cell::new(0, 3);
        trace.scenario.world =
            Arc::new(World::from_fn("open", Extent::new(10, 10), |_| false).unwrap());
        trace.scenario.starts = vec![start; 3];
        trace.records.truncate(1);
        trace.records[0].at = start;
        trace.records[0].goal = None;
        trace.records[0].known = 0;
        trace.records[0].deed = Deed::Moved(Direction::West);
    });
    says(out, &["line 3", "a step that ends inside", "-1,3"]);
}

#[test]
fn a_gap_ends_where_somebody_comes_and_is_not_endless() {
    let late = |tick: u32| {
        let mut trace = trace();
        trace.records.truncate(1);
        let mut last = trace.records[0];
        last.at = last.after();
        last.tick = tick;
        trace.records.push(last);
        trace.scenario.conditions.max_ticks = u32::MAX;
        trace.scenario.conditions.faults.restarts = vec![Event {
            robot: RobotId(0),
            tick,
        }];
        Trace::read(text(&trace).as_bytes()).map_err(|error| error.to_string())
    };
    assert_eq!(late(900_000).unwrap().ticks(), 900_001);
    let error = late(4_000_000_000).unwrap_err();
    assert!(error.contains("line 4"), "{error}");
    assert!(error.contains("ticks without a record"), "{error}");
}

#[test]
fn hostile_words_are_quoted_in_short() {
    let text = text(&trace());
    let long = "\u{1b}[2J".to_owned() + &"9".repeat(100_000);
    for hostile in [
        text.replacen("\n0,1,", &format!("\n{long},1,"), 1),
        text.replacen("tick,robot", &long, 1),
        text.replacen(
            "host-sim trace",
            &format!("\\u001b{}", "9".repeat(9_000)),
            1,
        ),
        text.replacen(
            "\"closest\"",
            &format!("\"\\u001b{}\"", "9".repeat(9_000)),
            1,
        ),
        long,
    ] {
        let error = Trace::read(hostile.as_bytes()).unwrap_err().to_string();
        assert!(error.chars().count() < 300, "{error}");
        assert!(!error.contains('\u{1b}'), "{error:?}");
    }
}
