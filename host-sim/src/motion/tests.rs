//! Bodies against closed forms and plain geometry.

use parry2d_f64::math::Vec2;
use planner_core::Cell;
use proptest::prelude::*;

use super::body::{Limits, Pose, State, Velocity};
use super::collide::{Cells, Hit};
use super::control::Course;
use super::{Aim, Drivers, Steered};
use crate::robot::Touches;
use crate::scenario::{Drive, Motion};

const DT: f64 = 0.02;
const ORIGIN: Pose = Pose {
    at: Vec2::ZERO,
    yaw: 0.0,
};

fn limits(drive: Drive) -> Limits {
    Limits::of(&Motion::new(drive, 0.5, 0))
}

fn standing() -> State {
    State {
        pose: ORIGIN,
        velocity: Velocity::NONE,
    }
}

/// Seconds until a body on this course rests, and how.
fn rest(course: Course, limits: &Limits, mut state: State) -> (f64, State) {
    for moment in 1..100_000 {
        let wished = course.wish(&state, limits, DT);
        state.accelerate(wished, limits, DT);
        let before = state.pose;
        state.pose = state.pose.moved(state.velocity, DT);
        let turned = (state.pose.yaw - before.yaw).abs();
        if (state.pose.at - before.at).length() + turned < 1e-7 && moment > 1 {
            return (f64::from(moment) * DT, state);
        }
    }
    panic!("it never rests");
}

#[test]
fn a_straight_way_takes_its_length_by_the_speed_and_the_time_to_gain_it() {
    let place = Vec2::new(3.0, 0.0);
    for (drive, seconds) in [(Drive::DiffDrive, 3.0 / 0.22 + 0.22), (Drive::Omni, 6.5)] {
        let (time, state) = rest(Course::To(place), &limits(drive), standing());
        assert!((time - seconds).abs() < 0.1, "{drive}: {time} s");
        assert!((state.pose.at - place).length() < 1e-3, "{state:?}");
    }
}

#[test]
fn a_turn_in_place_takes_its_angle_by_the_rate_and_the_time_to_gain_it() {
    let limits = limits(Drive::DiffDrive);
    let behind = Vec2::new(-1.0, 1e-9);
    let (time, state) = rest(Course::Face(behind), &limits, standing());
    let seconds = std::f64::consts::PI / 2.84 + 2.84 / limits.turn_acceleration();
    assert!((time - seconds).abs() < 0.1, "{time} s, expected {seconds}");
    assert_eq!(state.pose.at, Vec2::ZERO);
    assert!(state.pose.turn_to(behind).abs() < 1e-3);
}

/// A wall in the third column, with a gap in the second row.
fn is_free(cell: Cell) -> bool {
    cell.x != 2 || cell.y == 1
}

/// Goes east from the middle of the first cell in the row of the gap.
fn go_east(radius: f64) -> (Vec2, Option<Hit>) {
    let cells = Cells { side: 0.5 };
    let mut at = cells.middle(Cell::new(0, 1));
    let by = Vec2::new(0.01, 0.0);
    for _ in 0..200 {
        let (share, hit) = cells.advance((at, by), radius, is_free, std::iter::empty());
        at += by * share;
        if hit.is_some() {
            return (at, hit);
        }
    }
    (at, None)
}

#[test]
fn a_disc_does_not_pass_a_gap_that_is_narrower() {
    let (at, hit) = go_east(0.249);
    assert_eq!(hit, None);
    assert!((at.x - 2.25).abs() < 1e-9, "{at}");
    let (at, hit) = go_east(0.26);
    assert_eq!(hit, Some(Hit::Wall));
    // It touches both corners of the gap.
    let corner = Vec2::new(1.0, 0.5);
    assert!(((at - corner).length() - 0.26).abs() < 1e-4, "{at}");
    assert!(at.x < 1.0);
}

#[test]
fn discs_stop_where_they_meet_and_get_away_again() {
    let cells = Cells { side: 0.5 };
    let (at, other) = (Vec2::new(1.0, 1.0), Vec2::new(1.5, 1.0));
    let way = Vec2::new(0.5, 0.0);
    let others = || [other].into_iter();
    let (share, hit) = cells.advance((at, way), 0.2, |_| true, others());
    assert_eq!(hit, Some(Hit::Body));
    let met = at + way * share;
    assert!((other.x - met.x - 0.4).abs() < 1e-5, "{met}");
    for (by, goes) in [
        ((0.01, 0.0), false),
        ((-0.01, 0.0), true),
        ((0.0, 0.01), true),
    ] {
        let (share, _) = cells.advance((met, by.into()), 0.2, |_| true, others());
        assert_eq!(share > 0.9, goes, "{by:?}: {share}");
    }
}

#[test]
fn a_wheel_that_measures_too_much_bends_the_way_that_is_believed() {
    let limits = limits(Drive::DiffDrive);
    let ahead = Velocity {
        along: Vec2::new(0.2, 0.0),
        turn: 0.0,
    };
    assert_eq!(limits.scaled(ahead, [1.0; 2]), ahead);
    let measured = limits.scaled(ahead, [1.01, 1.0]);
    // The left wheel, a track of 2 · 0.22 / 2.84 m from the other: it turns to the right.
    let turn = 0.2 * 0.01 / (2.0 * 0.22 / 2.84);
    assert!((measured.turn - turn).abs() < 1e-12);
    assert!((measured.along.x - 0.201).abs() < 1e-12);
    let pose = (0..500).fold(ORIGIN, |pose, _| pose.moved(measured, DT));
    assert!((pose.yaw - turn * 10.0).abs() < 1e-9);
    let radius = measured.along.x / turn;
    let end = Vec2::new(radius * pose.yaw.sin(), radius * (1.0 - pose.yaw.cos()));
    assert!((pose.at - end).length() < 1e-4, "{pose:?}, expected {end}");
}

#[test]
fn a_pose_drifts_by_slip_and_by_an_odometry_that_errs() {
    let drift = |slip, odometry_error| {
        let motion = Motion {
            slip,
            odometry_error,
            ..Motion::new(Drive::Omni, 0.5, 0)
        };
        let mut drivers = Drivers::new(motion, 0, true, 1, &[Cell::new(0, 0)]);
        for tick in 0..300 {
            let aim = Aim::Go {
                next: drivers.believed_cell(0).step(planner_core::Direction::East),
                waypoint: None,
            };
            assert_eq!(drivers.steer(0, aim, |_| true), Steered::Going);
            drivers.drive(tick, |_| true);
        }
        let (real, believed) = (drivers.cell(0).x, drivers.believed_cell(0).x);
        (i32::from(real), i32::from(believed) - i32::from(real))
    };
    // 30 seconds at 0.5 m/s are 29 or 30 cells.
    let (cells, off) = drift(0.0, 0.0);
    assert!((28..=30).contains(&cells) && off == 0, "{cells}, {off}");
    let (cells, off) = drift(0.2, 0.0);
    assert!(
        (25..=28).contains(&cells) && (2..=4).contains(&off),
        "{cells}, {off}"
    );
    assert_ne!(drift(0.0, 0.2).1, 0);
}

#[test]
fn bodies_on_one_way_hold_each_other_and_do_not_touch() {
    let starts = [Cell::new(0, 0), Cell::new(6, 0)];
    let motion = Motion::new(Drive::DiffDrive, 0.5, 0);
    let mut drivers = Drivers::new(motion, 0, true, 1, &starts);
    let is_free = |cell: Cell| cell.y == 0 && (0..7).contains(&cell.x);
    let mut held = [false; 2];
    for tick in 0..600 {
        for (robot, held) in held.iter_mut().enumerate() {
            let (step, end) = [(1, 6), (-1, 0)][robot];
            let here = drivers.believed_cell(robot);
            let aim = Aim::Go {
                next: Cell::new(here.x + step, 0),
                waypoint: Some(Cell::new(end, 0)),
            };
            *held |= matches!(drivers.steer(robot, aim, is_free), Steered::Held(_));
        }
        drivers.drive(tick, is_free);
    }
    assert_eq!(held, [true; 2]);
    let apart = drivers.cell(1).x - drivers.cell(0).x;
    assert_eq!(apart, 1, "they wait face to face");
    for robot in 0..2 {
        let driven = drivers.driven(robot);
        assert_eq!(driven.touches, Touches::default());
        assert!(driven.millimetres > 500, "{driven:?}");
    }
}

proptest! {
    /// Whatever it was doing, a body that goes to a place does not run past it, if it could
    /// stop before it in its direction, and comes to rest there.
    #[test]
    fn a_body_rests_where_it_is_sent(
        x in -5.0..5.0f64, y in -5.0..5.0f64, speed in 0.05..3.0f64, turn in 0.1..10.0f64,
        acceleration in 0.1..5.0f64, omni in any::<bool>(),
    ) {
        let drive = if omni { Drive::Omni } else { Drive::DiffDrive };
        let motion = Motion {
            speed,
            turn_rate: turn,
            acceleration,
            ..Motion::new(drive, 0.5, 0)
        };
        let limits = Limits::of(&motion);
        let place = Vec2::new(x, y);
        let (_, faced) = rest(Course::Face(place), &limits, standing());
        prop_assert_eq!(faced.pose.at, Vec2::ZERO);
        let (_, state) = rest(Course::To(place), &limits, faced);
        prop_assert!((state.pose.at - place).length() < 2e-3, "{:?}", state);
        // From full speed it brakes as fast as it can.
        let going = State {
            velocity: Velocity { along: Vec2::new(speed, 0.0), turn: 0.0 },
            ..standing()
        };
        let places = Course::Halt.preview(going, &limits, (1, DT)).unwrap();
        let way = places.last().unwrap().x;
        prop_assert!(way <= speed * speed / (2.0 * acceleration) + 1e-9, "{}", way);
    }

    /// What a disc may go by, it does go by.
    #[test]
    fn a_way_that_is_clear_is_one_without_a_hit(
        walls in proptest::collection::vec(proptest::bool::weighted(0.15), 64),
        from in (0.5..3.5f64, 0.5..3.5f64), to in (0.0..4.0f64, 0.0..4.0f64),
        radius in 0.05..0.3f64,
    ) {
        let cells = Cells { side: 0.5 };
        let is_free = |cell: Cell| {
            let is_inside = (0..8).contains(&cell.x) && (0..8).contains(&cell.y);
            is_inside && !walls[(cell.y * 8 + cell.x) as usize]
        };
        let (from, to) = (Vec2::from(from), Vec2::from(to));
        prop_assume!(cells.are_apart(from + Vec2::splat(99.0), from, radius, is_free));
        let is_clear = cells.are_clear((from, to), radius, is_free);
        let none = std::iter::empty;
        let (share, hit) = cells.advance((from, to - from), radius, is_free, none());
        // Within a hair either may be right.
        let is_clear_of_more = cells.are_clear((from, to), radius + 1e-4, is_free);
        if is_clear == is_clear_of_more {
            prop_assert_eq!(hit.is_none(), is_clear, "{} {:?}", share, hit);
        }
    }
}
