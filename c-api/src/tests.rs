use std::ptr::{null, null_mut};

use planner_core::radio::{Field, FrameError};
use planner_core::{Action, Direction, Stop, Wait};
use proptest::prelude::*;

use super::*;

pub(crate) const CONFIG: PlannerConfig = PlannerConfig {
    id: 1,
    width: 9,
    height: 9,
    start: PlannerCell { x: 1, y: 1 },
    cell_mm: 100,
    origin_x_mm: 0,
    origin_y_mm: 0,
    bytes_per_tick: 55,
    is_keyed: 0,
    key: [0; 16],
    sensor: PlannerSensor::Truthful as u8,
    margin: 0,
    sure_range: 0,
    patrol_ticks: 0,
    clearance: 0,
    come_home: 0,
};

const SIZE: usize = size_of::<Planner>();

/// An action to be overwritten.
const NOTHING: PlannerAction = PlannerAction {
    kind: PlannerActionKind::Wait,
    direction: PlannerDirection::East,
    stop: PlannerStop::None,
    frontiers: 0,
    at: PlannerCell { x: 0, y: 0 },
    wait: PlannerWait::None,
    look: PlannerDirection::East,
};

/// A status to be overwritten.
const STATUS: PlannerStatus = PlannerStatus {
    position: CONFIG.start,
    goal: CONFIG.start,
    has_goal: 9,
    known: 9,
    frontiers: 9,
    heard_cells: 9,
    contradictions: 9,
    contradicted_by: 9,
    same_id: 9,
    refused: 9,
};

fn status(planner: *mut Planner) -> PlannerStatus {
    let mut status = STATUS;
    assert_eq!(planner_status(planner, &mut status), PlannerResult::Ok);
    status
}

pub(crate) fn memory() -> Box<[u64]> {
    vec![0; PLANNER_WORDS].into()
}

fn planner(memory: &mut [u64]) -> *mut Planner {
    memory.as_mut_ptr().cast()
}

pub(crate) fn created(memory: &mut [u64], config: PlannerConfig) -> *mut Planner {
    let planner = planner(memory);
    assert_eq!(planner_create(planner, SIZE, &config), PlannerResult::Ok);
    planner
}

#[test]
fn the_header_knows_the_sizes() {
    let header = include_str!("../include/planner.h");
    for cells in [32, 64, 128] {
        let words = place::words(cells);
        let tiles = cells / 8;
        let lines = format!(
            "PLANNER_MAX_CELLS {cells}\n#define PLANNER_WORDS {words}\n\
             #define PLANNER_CELL_SET_WORDS {}\n",
            tiles * tiles
        );
        assert!(header.contains(&lines), "{lines}");
    }
}

#[test]
fn a_header_of_another_size_is_answered() {
    let mut memory = memory();
    let place = planner(&mut memory);
    let smaller = planner_create(place, SIZE - 8, &CONFIG);
    assert_eq!(smaller, PlannerResult::Memory);
    assert_eq!(planner_resume(place), PlannerResult::NotCreated);
    assert_eq!(planner_go_home(place), PlannerResult::NotCreated);
    assert_eq!(planner_energy(place, 9), PlannerResult::NotCreated);
    assert_eq!(planner_create(place, SIZE + 8, &CONFIG), PlannerResult::Ok);
}

#[test]
fn null_is_answered() {
    let mut memory = memory();
    let ready = created(&mut memory, CONFIG);
    let (mut action, mut frame, mut length) = (NOTHING, [0; 55], 0);
    let pose = PlannerPose {
        x: 1.5,
        y: 1.5,
        heading: 0.0,
    };
    let centre = CONFIG.start;
    for result in [
        planner_create(null_mut(), SIZE, &CONFIG),
        planner_create(ready, SIZE, null()),
        planner_observe_scan(ready, null(), 4.0, 0.1, null(), 0),
        planner_observe_scan(ready, &pose, 4.0, 0.1, null(), 1),
        planner_observe_cells(null_mut(), centre, null(), 0),
        planner_observe_cells(ready, centre, null(), 1),
        planner_tick(null_mut(), &mut action),
        planner_tick(ready, null_mut()),
        planner_report(null_mut(), PLANNER_MOVED),
        planner_transmit(ready, null_mut(), &mut length),
        planner_transmit(ready, frame.as_mut_ptr(), null_mut()),
        planner_receive(ready, null(), 16),
        planner_status(ready, null_mut()),
        planner_status(null_mut(), &mut STATUS.clone()),
        planner_cell(ready, centre, null_mut()),
        planner_row(ready, 1, null_mut(), 1, &mut length),
        planner_row(ready, 1, frame.as_mut_ptr(), 1, null_mut()),
        planner_pose_from_metres(null(), 0.0, 0.0, 0.0, &mut pose.clone()),
        planner_pose_from_metres(&CONFIG, 0.0, 0.0, 0.0, null_mut()),
        planner_middle_in_metres(&CONFIG, centre, null_mut(), null_mut()),
        planner_resume(null_mut()),
        planner_go_home(null_mut()),
        planner_go_to(null_mut(), PlannerCell { x: 0, y: 0 }),
        planner_energy(null_mut(), 9),
        planner_is_mute(ready, null_mut()),
        planner_waypoint(ready, null_mut(), null_mut()),
        planner_way(ready, null_mut(), 0, null_mut()),
    ] {
        assert_eq!(result, PlannerResult::Null);
    }
}

#[test]
fn misaligned_is_answered() {
    let mut memory = memory();
    let crooked = planner(&mut memory).wrapping_byte_add(1);
    assert_eq!(
        planner_create(crooked, SIZE, &CONFIG),
        PlannerResult::Misaligned
    );
    assert_eq!(
        planner_report(crooked, PLANNER_MOVED),
        PlannerResult::Misaligned
    );
    let ready = created(&mut memory, CONFIG);
    // Large enough and aligned for anything, and then one byte further.
    let mut place = [0u64; 8];
    let straight = place.as_mut_ptr();
    let crooked = straight.wrapping_byte_add(1);
    let pose = PlannerPose {
        x: 1.5,
        y: 1.5,
        heading: 0.0,
    };
    let centre = CONFIG.start;
    for result in [
        planner_create(ready, SIZE, crooked.cast()),
        planner_observe_scan(ready, crooked.cast(), 4.0, 0.1, null(), 0),
        planner_observe_scan(ready, &pose, 4.0, 0.1, crooked.cast(), 1),
        planner_observe_cells(ready, centre, crooked.cast(), 1),
        planner_tick(ready, crooked.cast()),
        planner_transmit(ready, straight.cast(), crooked.cast()),
        planner_status(ready, crooked.cast()),
        planner_row(ready, 1, straight.cast(), 1, crooked.cast()),
        planner_pose_from_metres(crooked.cast(), 0.0, 0.0, 0.0, straight.cast()),
        planner_middle_in_metres(&CONFIG, centre, crooked.cast(), straight.cast()),
    ] {
        assert_eq!(result, PlannerResult::Misaligned);
    }
    // Frames are bytes: they lie anywhere.
    let frame = crooked.cast::<u8>();
    let mut length = 0;
    assert_eq!(
        planner_transmit(ready, frame, &mut length),
        PlannerResult::Ok
    );
}

#[test]
fn memory_without_a_planner_and_values_out_of_range_are_answered() {
    let mut memory = memory();
    let ready = planner(&mut memory);
    assert_eq!(
        planner_report(ready, PLANNER_MOVED),
        PlannerResult::NotCreated
    );
    let wide = PlannerConfig {
        width: 129,
        ..CONFIG
    };
    assert_eq!(planner_create(ready, SIZE, &wide), PlannerResult::Extent);
    let outside = PlannerConfig {
        start: PlannerCell { x: 9, y: 0 },
        ..CONFIG
    };
    assert_eq!(planner_create(ready, SIZE, &outside), PlannerResult::Extent);
    assert_eq!(planner_create(ready, SIZE, &CONFIG), PlannerResult::Ok);
    assert_eq!(planner_report(ready, 3), PlannerResult::Motion);
    let pose = PlannerPose {
        x: f32::NAN,
        y: 1.5,
        heading: 0.0,
    };
    assert_eq!(
        planner_observe_scan(ready, &pose, 4.0, 0.1, null(), 0),
        PlannerResult::Scan
    );
    let pose = PlannerPose { x: 1.5, ..pose };
    for (max_range, tolerance) in [(0.0, 0.1), (f32::NAN, 0.1), (4.0, -0.1), (4.0, 0.3)] {
        let scan = planner_observe_scan(ready, &pose, max_range, tolerance, null(), 0);
        assert_eq!(scan, PlannerResult::Scan);
    }
    let beam = beam(0.0, 1.0);
    let scan = planner_observe_scan(ready, &pose, 4.0, 0.1, &beam, usize::MAX);
    assert_eq!(scan, PlannerResult::TooMany);
    assert_eq!(
        planner_receive(ready, [0; 9].as_ptr(), 9),
        PlannerResult::FrameLength
    );
}

/// What the robot of [`CONFIG`] sees in the middle of an empty hall.
fn look(robot: *mut Planner, at: PlannerCell) -> PlannerResult {
    let seen: Vec<_> = (-3..=3)
        .flat_map(|y| (-3..=3).map(move |x| (at.x + x, at.y + y)))
        .map(|(x, y)| PlannerSeen {
            cell: PlannerCell { x, y },
            // Walls all around the map.
            blocked: u8::from(x <= 0 || y <= 0 || x >= 8 || y >= 8),
        })
        .collect();
    planner_observe_cells(robot, at, seen.as_ptr(), seen.len())
}

fn tick(robot: *mut Planner) -> PlannerAction {
    let mut action = NOTHING;
    assert_eq!(planner_tick(robot, &mut action), PlannerResult::Ok);
    action
}

proptest! {
    /// Whatever the configuration says, a planner is created from it or nothing has
    /// changed, in memory that never held one and in memory where one runs.
    #[test]
    fn a_failed_create_changes_nothing(
        (width, height) in (0..140u16, 0..140u16),
        (x, y) in (-3..140i16, -3..140i16),
        cell_mm in prop_oneof![Just(0), any::<u16>()],
        garbage in any::<u64>(),
    ) {
        let config = PlannerConfig {
            width,
            height,
            start: PlannerCell { x, y },
            cell_mm,
            ..CONFIG
        };
        let mut fresh: Box<[u64]> = vec![garbage; PLANNER_WORDS].into();
        let mut running = memory();
        prop_assert_eq!(look(created(&mut running, CONFIG), CONFIG.start), PlannerResult::Ok);
        tick(planner(&mut running));
        for memory in [&mut fresh, &mut running] {
            let before = memory.clone();
            match planner_create(planner(memory), SIZE, &config) {
                PlannerResult::Ok => {
                    prop_assert!((1..=128).contains(&width) && (1..=128).contains(&height));
                    prop_assert!((0..width as i16).contains(&x) && (0..height as i16).contains(&y));
                    prop_assert_ne!(cell_mm, 0);
                    prop_assert_eq!(planner_report(planner(memory), PLANNER_MOVED), PlannerResult::Ok);
                }
                PlannerResult::CellSize => {
                    prop_assert_eq!(cell_mm, 0);
                    prop_assert!(*memory == before);
                }
                result => {
                    prop_assert_eq!(result, PlannerResult::Extent);
                    prop_assert!(*memory == before);
                }
            }
        }
    }
}

#[test]
fn a_failed_create_with_a_bad_pointer_changes_nothing() {
    let mut memory = memory();
    let ready = created(&mut memory, CONFIG);
    assert_eq!(look(ready, CONFIG.start), PlannerResult::Ok);
    let before = memory.clone();
    let ready = planner(&mut memory);
    assert_eq!(planner_create(ready, SIZE, null()), PlannerResult::Null);
    let configs = [CONFIG; 2];
    let crooked = configs.as_ptr().wrapping_byte_add(1);
    assert_eq!(
        planner_create(ready, SIZE, crooked),
        PlannerResult::Misaligned
    );
    assert!(memory == before);
}

#[test]
fn a_planner_that_may_send_nothing_says_so() {
    let mut memory = memory();
    for (bytes_per_tick, mute) in [(0, true), (1, false), (55, false)] {
        let config = PlannerConfig {
            bytes_per_tick,
            ..CONFIG
        };
        let ready = created(&mut memory, config);
        let mut is_mute = !mute;
        assert_eq!(planner_is_mute(ready, &mut is_mute), PlannerResult::Ok);
        assert_eq!(is_mute, mute);
        let (mut frame, mut length, mut sent) = ([0; PLANNER_MAX_FRAME], 0, 0);
        for _ in 0..100 {
            assert_eq!(look(ready, CONFIG.start), PlannerResult::Ok);
            tick(ready);
            let result = planner_transmit(ready, frame.as_mut_ptr(), &mut length);
            assert_eq!(result, PlannerResult::Ok);
            sent += length;
        }
        assert_eq!(sent == 0, mute, "{bytes_per_tick} bytes a tick");
    }
}

fn beam(radians: f32, range: f32) -> PlannerBeam {
    PlannerBeam {
        bearing: planner_bearing(radians),
        range,
    }
}

/// A hundred beams to the east; those that point nowhere, and those without a
/// measurement, say nothing.
#[test]
fn beams_show_cells_and_bad_ones_nothing() {
    let known_after = |beams: &[PlannerBeam]| {
        let mut memory = memory();
        let ready = created(&mut memory, CONFIG);
        let pose = PlannerPose {
            x: 1.5,
            y: 1.5,
            heading: 0.0,
        };
        let length = beams.len();
        let scan = planner_observe_scan(ready, &pose, 4.0, 0.1, beams.as_ptr(), length);
        assert_eq!(scan, PlannerResult::Ok);
        status(ready).known
    };
    assert_eq!(known_after(&[beam(0.0, 1.0)]), 2);
    assert_eq!(known_after(&[beam(0.0, 2.5); 100]), 4);
    assert_eq!(known_after(&[beam(0.0, f32::INFINITY)]), 5);
    let long = PlannerBearing {
        ahead: 1.0,
        right: 0.1,
    };
    let zero = PlannerBearing {
        ahead: 0.0,
        right: 0.0,
    };
    for bearing in [long, zero, planner_bearing(f32::NAN)] {
        assert_eq!(
            known_after(&[PlannerBeam {
                bearing,
                range: 2.5
            }]),
            1
        );
    }
    for range in [f32::NAN, -1.0] {
        assert_eq!(known_after(&[beam(0.0, range)]), 1);
    }
}

/// What lies farther than 15 cells counts as well, where the sensor reaches so far.
#[test]
fn a_long_scan_shows_what_is_far() {
    let config = PlannerConfig {
        width: 32,
        start: PlannerCell { x: 1, y: 1 },
        ..CONFIG
    };
    type Observe = extern "C" fn(
        *mut Planner,
        *const PlannerPose,
        f32,
        f32,
        *const PlannerBeam,
        usize,
    ) -> PlannerResult;
    let seen = |observe: Observe| {
        let mut memory = memory();
        let ready = created(&mut memory, config);
        let pose = PlannerPose {
            x: 1.5,
            y: 1.5,
            heading: 0.0,
        };
        let beams = [beam(0.0, 25.5)];
        let result = observe(ready, &pose, 28.0, 0.1, beams.as_ptr(), beams.len());
        assert_eq!(result, PlannerResult::Ok);
        let off_grid = PlannerPose { y: 1e30, ..pose };
        let result = observe(ready, &off_grid, 28.0, 0.1, beams.as_ptr(), beams.len());
        assert_eq!(result, PlannerResult::OffGrid);
        let result = observe(ready, &pose, f32::NAN, 0.1, beams.as_ptr(), beams.len());
        assert_eq!(result, PlannerResult::Scan);
        status(ready).known
    };
    assert_eq!(seen(planner_observe_scan), 16);
    assert_eq!(seen(planner_observe_long_scan), 27);
}

#[test]
fn off_the_grid_nothing_is_decided() {
    let mut memory = memory();
    let ready = created(&mut memory, CONFIG);
    assert_eq!(look(ready, CONFIG.start), PlannerResult::Ok);
    let beam = beam(0.0, 1.0);
    let scan = |x, y| {
        let pose = PlannerPose { x, y, heading: 0.0 };
        planner_observe_scan(ready, &pose, 4.0, 0.1, &beam, 1)
    };
    let before = status(ready);
    for _ in 0..200 {
        assert_eq!(scan(-0.5, 1.5), PlannerResult::OffGrid);
        assert_eq!(tick(ready).wait, PlannerWait::Pose);
        // Also where cells have no name.
        assert_eq!(scan(1.5, 1e30), PlannerResult::OffGrid);
        assert_eq!(tick(ready).wait, PlannerWait::Pose);
        assert_eq!(
            look(ready, PlannerCell { x: 1, y: 9 }),
            PlannerResult::OffGrid
        );
        let action = tick(ready);
        assert_eq!(action.kind, PlannerActionKind::Wait);
        assert_eq!(action.wait, PlannerWait::Pose);
    }
    assert_eq!(status(ready), before);
    assert_eq!(look(ready, CONFIG.start), PlannerResult::Ok);
    assert_eq!(tick(ready).kind, PlannerActionKind::Move);
}

#[test]
fn a_wait_has_a_reason_and_a_look_a_direction() {
    let mut memory = memory();
    let ready = created(&mut memory, CONFIG);
    assert_eq!(tick(ready).wait, PlannerWait::Sight);
    let waits = [
        (None, PlannerWait::None),
        (Some(Wait::Sight), PlannerWait::Sight),
        (Some(Wait::Pose), PlannerWait::Pose),
        (Some(Wait::Search), PlannerWait::Search),
        (Some(Wait::Closed), PlannerWait::Closed),
        (Some(Wait::Obstructed), PlannerWait::Obstructed),
        (Some(Wait::Patrol), PlannerWait::Patrol),
        (Some(Wait::Doubt), PlannerWait::Doubt),
        (Some(Wait::Look(Direction::East)), PlannerWait::Look),
    ];
    for (waiting, wait) in waits {
        assert_eq!(PlannerAction::new(Action::Wait, waiting).wait, wait);
    }
    for direction in Direction::ALL {
        let looks = PlannerAction::new(Action::Wait, Some(Wait::Look(direction)));
        assert_eq!(looks.look as u8, direction as u8);
        let moves = PlannerAction::new(Action::Move(direction), None);
        assert_eq!(
            (moves.direction as u8, moves.wait),
            (direction as u8, PlannerWait::None)
        );
    }
}

#[test]
fn stops_have_the_codes_of_traces_and_one_more() {
    let (frontiers, at) = (7, Cell::new(2, 3));
    let stops = [
        Stop::Complete,
        Stop::Enclosed { frontiers },
        Stop::Blocked { frontiers, at },
        Stop::BackAtStart { frontiers },
        Stop::NoTrace { frontiers },
        Stop::AtEdge { cells: 7 },
        Stop::OutOfReach { frontiers },
        Stop::Unseen { frontiers, at },
        Stop::Held { frontiers, at },
        Stop::Home { frontiers },
        Stop::Arrived { frontiers, at },
        Stop::NoWay { frontiers, at },
    ];
    for (stop, code) in stops.into_iter().zip(1..) {
        let told = PlannerAction::new(Action::Stop(stop), None);
        assert_eq!(told.kind, PlannerActionKind::Stop);
        assert_eq!(
            (told.stop as u8, stop.reason().code() + 1),
            (code, code),
            "{stop}"
        );
        assert_eq!(
            planner_stop_is_complete(told.stop as u8),
            stop.is_complete(),
            "{stop}"
        );
        assert_eq!(told.frontiers, stop.left());
        let place = stop.place().map_or((0, 0), |at| (at.x, at.y));
        assert_eq!((told.at.x, told.at.y), place);
    }
    for none in [PlannerStop::None as u8, stops.len() as u8 + 1, 255] {
        assert!(!planner_stop_is_complete(none));
    }
}

#[test]
fn a_robot_is_sent_and_comes_home() {
    let mut memory = memory();
    let ready = created(&mut memory, CONFIG);
    let start = CONFIG.start;
    let seen: Vec<PlannerSeen> = (0..3)
        .map(|step| PlannerSeen {
            cell: PlannerCell {
                x: start.x + step,
                y: start.y,
            },
            blocked: 0,
        })
        .collect();
    let observe = |x: i16| {
        let here = PlannerCell { x, y: start.y };
        let told = planner_observe_cells(ready, here, seen.as_ptr(), seen.len());
        assert_eq!(told, PlannerResult::Ok);
    };
    let run = |mut x: i16| {
        for _ in 0..100 {
            observe(x);
            let action = tick(ready);
            match action.kind {
                PlannerActionKind::Stop => return (x, action),
                PlannerActionKind::Move => {
                    x += Direction::from_index(action.direction as u8).delta().0;
                    assert_eq!(planner_report(ready, PLANNER_MOVED), PlannerResult::Ok);
                }
                PlannerActionKind::Wait => {}
            }
        }
        panic!("still running at {x}");
    };
    let off = PlannerCell { x: -1, y: 0 };
    assert_eq!(planner_go_to(ready, off), PlannerResult::OffGrid);
    let to = PlannerCell {
        x: start.x + 2,
        y: start.y,
    };
    observe(start.x);
    assert_eq!(planner_go_to(ready, to), PlannerResult::Ok);
    let (x, arrived) = run(start.x);
    assert_eq!((x, arrived.stop), (to.x, PlannerStop::Arrived));
    assert_eq!(planner_energy(ready, 2), PlannerResult::Ok);
    assert_eq!(planner_resume(ready), PlannerResult::Ok);
    let (x, home) = run(x);
    assert_eq!((x, home.stop), (start.x, PlannerStop::Home));
    assert_eq!(planner_go_home(ready), PlannerResult::Ok);
    assert_eq!(tick(ready).stop, PlannerStop::Home);
}

#[test]
fn a_stopped_robot_goes_on_after_resume() {
    let mut memory = memory();
    let ready = created(&mut memory, CONFIG);
    let closed = [(2, 1), (1, 2), (0, 1), (1, 0)].map(|(x, y)| PlannerSeen {
        cell: PlannerCell { x, y },
        blocked: 1,
    });
    let look_at_walls = || {
        let result = planner_observe_cells(ready, CONFIG.start, closed.as_ptr(), closed.len());
        assert_eq!(result, PlannerResult::Ok);
    };
    look_at_walls();
    assert_eq!(tick(ready).kind, PlannerActionKind::Stop);
    // Told to go on where nothing has changed, it comes to the same end.
    assert_eq!(planner_resume(ready), PlannerResult::Ok);
    look_at_walls();
    assert_eq!(tick(ready).kind, PlannerActionKind::Stop);
    // Told before it is carried out of it, or carried to where it learns something.
    assert_eq!(planner_resume(ready), PlannerResult::Ok);
    assert_eq!(look(ready, PlannerCell { x: 5, y: 5 }), PlannerResult::Ok);
    assert_ne!(tick(ready).kind, PlannerActionKind::Stop);
}

#[test]
fn a_frame_that_is_not_taken_says_why() {
    let mut memories = [memory(), memory(), memory()];
    let [one, two, elsewhere] = &mut memories;
    let one = created(one, CONFIG);
    let two = created(two, PlannerConfig { id: 2, ..CONFIG });
    let elsewhere = created(
        elsewhere,
        PlannerConfig {
            id: 3,
            origin_x_mm: 1,
            ..CONFIG
        },
    );
    let frame = frame_of(one);
    let receive = |by, frame: &[u8]| planner_receive(by, frame.as_ptr(), frame.len());
    let changed = |at: usize| {
        let mut bytes = frame.clone();
        bytes[at] ^= 0x80;
        bytes
    };
    assert_eq!(receive(two, &frame), PlannerResult::Ok);
    assert_eq!(receive(two, &frame[1..]), PlannerResult::FrameLength);
    assert_eq!(receive(two, &[]), PlannerResult::FrameLength);
    assert_eq!(receive(two, &changed(0)), PlannerResult::FrameVersion);
    assert_eq!(receive(two, &changed(1)), PlannerResult::FrameKind);
    assert_eq!(receive(two, &changed(9)), PlannerResult::FrameCheck);
    assert_eq!(receive(elsewhere, &frame), PlannerResult::FrameOtherGrid);
    assert_eq!(receive(one, &frame), PlannerResult::FrameOwn);
    let field = FrameError::Field(Field::State);
    assert_eq!(PlannerResult::from(field), PlannerResult::FrameField);
}

/// What the robot sends of what it saw.
fn frame_of(robot: *mut Planner) -> Vec<u8> {
    assert_eq!(look(robot, CONFIG.start), PlannerResult::Ok);
    tick(robot);
    let (mut frame, mut length) = ([0; PLANNER_MAX_FRAME], 0);
    let result = planner_transmit(robot, frame.as_mut_ptr(), &mut length);
    assert_eq!(result, PlannerResult::Ok);
    frame[..length].to_vec()
}

#[test]
fn robots_hear_those_with_their_key_and_nobody_else() {
    let keys = [(0, [0; 16]), (1, [7; 16]), (255, [8; 16])];
    for (ours, one) in keys.into_iter().enumerate() {
        for (theirs, two) in keys.into_iter().enumerate() {
            let robot = |id, (is_keyed, key)| PlannerConfig {
                id,
                is_keyed,
                key,
                ..CONFIG
            };
            let mut memory = memory();
            let frame = frame_of(created(&mut memory, robot(1, one)));
            let listener = created(&mut memory, robot(2, two));
            let result = planner_receive(listener, frame.as_ptr(), frame.len());
            if ours == theirs {
                assert_eq!(result, PlannerResult::Ok);
            } else {
                assert_ne!(result, PlannerResult::Ok, "{ours} heard by {theirs}");
            }
        }
    }
}

#[test]
fn two_robots_explore_a_hall_and_hear_each_other() {
    let mut memories = [memory(), memory()];
    let [one, two] = &mut memories;
    let robots = [
        created(one, CONFIG),
        created(two, PlannerConfig { id: 2, ..CONFIG }),
    ];
    let mut positions = [CONFIG.start; 2];
    let mut stopped = 0;
    for _ in 0..200 {
        stopped = 0;
        for (index, &robot) in robots.iter().enumerate() {
            let at = &mut positions[index];
            assert_eq!(look(robot, *at), PlannerResult::Ok);
            let action = tick(robot);
            match action.kind {
                PlannerActionKind::Wait => {}
                PlannerActionKind::Stop => {
                    assert_eq!(action.stop, PlannerStop::Complete);
                    stopped += 1;
                }
                PlannerActionKind::Move => {
                    let (x, y) = [(1, 0), (0, 1), (-1, 0), (0, -1)][action.direction as usize];
                    *at = PlannerCell {
                        x: at.x + x,
                        y: at.y + y,
                    };
                    assert_eq!(planner_report(robot, PLANNER_MOVED), PlannerResult::Ok);
                }
            }
            let (mut frame, mut length) = ([0; PLANNER_MAX_FRAME], 0);
            assert_eq!(
                planner_transmit(robot, frame.as_mut_ptr(), &mut length),
                PlannerResult::Ok
            );
            if length > 0 {
                assert_eq!(
                    planner_receive(robots[1 - index], frame.as_ptr(), length),
                    PlannerResult::Ok
                );
            }
        }
    }
    assert_eq!(stopped, 2);
    let now = status(robots[0]);
    assert_eq!(now.frontiers, 0);
    assert!(now.known >= 7 * 9 + 2 * 7, "{now:?}");
    assert!(now.heard_cells > 0 && now.contradictions == 0, "{now:?}");
}

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

#[test]
fn codes_have_words() {
    use std::ffi::CStr;
    // SAFETY: all texts are constants that end with a zero byte.
    let read = |text| unsafe { CStr::from_ptr(text) }.to_str().unwrap();
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
    for beyond in [queries::RESULTS.len(), 255] {
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
fn the_way_is_told_and_walked_in_a_straight_line() {
    let mut memory = memory();
    let ready = created(&mut memory, CONFIG);
    let look = |x: i16| {
        let free = (1..6).map(|x| (x, 1, 0));
        let walls = (0..9).flat_map(|x| [(x, 0, 1), (x, 2, 1)]);
        let seen: Vec<_> = walls
            .chain([(0, 1, 1)])
            .chain(free)
            .map(|(x, y, blocked)| PlannerSeen {
                cell: PlannerCell { x, y },
                blocked,
            })
            .collect();
        let at = PlannerCell { x, y: 1 };
        let result = planner_observe_cells(ready, at, seen.as_ptr(), seen.len());
        assert_eq!(result, PlannerResult::Ok);
    };
    let waypoint = || {
        let (mut is_there, mut at) = (false, PlannerCell { x: -1, y: -1 });
        let result = planner_waypoint(ready, &mut is_there, &mut at);
        assert_eq!(result, PlannerResult::Ok);
        is_there.then_some((at.x, at.y))
    };
    let way = |room| {
        let (mut cells, mut count) = ([CONFIG.start; 9], 0);
        let result = planner_way(ready, cells.as_mut_ptr(), room, &mut count);
        assert_eq!(result, PlannerResult::Ok);
        let columns = cells[..count].iter().map(|cell| cell.x);
        columns.collect::<Vec<_>>()
    };
    assert_eq!((waypoint(), way(9)), (None, vec![]));
    look(1);
    assert_eq!(tick(ready).kind, PlannerActionKind::Move);
    assert_eq!(waypoint(), Some((5, 1)));
    assert_eq!((way(9), way(2)), (vec![2, 3, 4, 5], vec![2, 3]));
    look(4);
    assert_eq!((waypoint(), way(9)), (Some((5, 1)), vec![5]));
    assert_eq!(status(ready).goal, PlannerCell { x: 5, y: 1 });
}
