//! Creation, and misuse; the helpers of all tests.

mod missions;
mod queries;
mod radio;
mod scans;
mod voxels;
mod zones;

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
    for size in [SIZE - 8, SIZE + 8] {
        assert_eq!(planner_create(place, size, &CONFIG), PlannerResult::Memory);
    }
    assert_eq!(planner_resume(place), PlannerResult::NotCreated);
    assert_eq!(planner_go_home(place), PlannerResult::NotCreated);
    assert_eq!(planner_energy(place, 9), PlannerResult::NotCreated);
    assert_eq!(planner_create(place, SIZE, &CONFIG), PlannerResult::Ok);
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

fn beam(radians: f32, range: f32) -> PlannerBeam {
    PlannerBeam {
        bearing: planner_bearing(radians),
        range,
    }
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
