//! Range scans in worlds of whole cells, against geometry in doubles.

use core::f32::consts::TAU;

use super::*;
use crate::cell::Direction;
use crate::explorer::{Config, Explorer};
use crate::{Action, Motion, Planner, RobotId};

/// What a beam meets: the cell, the distance to it, and where on its face that is, from 0
/// at one corner to 1 at the other, with the slope of the beam against the face.
struct Hit {
    cell: Cell,
    range: f64,
    front: Cell,
    place: f64,
    slope: f64,
}

/// The first blocked cell on a beam from `(x, y)`, in doubles; `None` beyond `reach`.
fn cast(
    (x, y): (f64, f64),
    angle: f64,
    reach: f64,
    is_blocked: &impl Fn(Cell) -> bool,
) -> Option<Hit> {
    let direction = [angle.cos(), angle.sin()];
    let from = [x, y];
    let mut at = from.map(|v| v.floor() as i16);
    let next = |axis: usize, at: [i16; 2]| {
        if direction[axis] == 0.0 {
            return f64::INFINITY;
        }
        let border = f64::from(at[axis]) + if direction[axis] > 0.0 { 1.0 } else { 0.0 };
        (border - from[axis]) / direction[axis]
    };
    loop {
        let axis = usize::from(next(0, at) > next(1, at));
        let range = next(axis, at);
        if range > reach {
            return None;
        }
        let front = Cell::new(at[0], at[1]);
        at[axis] += direction[axis].signum() as i16;
        let cell = Cell::new(at[0], at[1]);
        if is_blocked(cell) {
            let across = from[1 - axis] + range * direction[1 - axis];
            let (place, slope) = (across - across.floor(), direction[axis].abs());
            return Some(Hit {
                cell,
                range,
                front,
                place,
                slope,
            });
        }
    }
}

/// A sensor's errors, each from -1 to 1 of what its tolerance leaves for it.
#[derive(Clone, Debug)]
struct Errors {
    ranges: Vec<f64>,
    position: (f64, f64),
    heading: f64,
    /// How the tolerance is shared among ranges, position and heading.
    shares: (f64, f64),
}

fn errors() -> impl Strategy<Value = Errors> {
    let error = || prop_oneof![Just(-1.0), Just(1.0), -1.0..1.0f64];
    (
        proptest::collection::vec(error(), 1..200),
        (0.0..std::f64::consts::TAU, 0.0..=1.0f64),
        error(),
        (0.0..=1.0f64, 0.0..=1.0f64),
    )
        .prop_map(|(ranges, (angle, size), heading, shares)| Errors {
            ranges,
            position: (size * angle.cos(), size * angle.sin()),
            heading,
            shares,
        })
}

/// No free cell is told blocked, no blocked one free, and what the beams hit in front of
/// them, corners aside, is seen.
fn assert_no_lie<R: Row, const SPAN: usize>(
    look: &Look<R, SPAN>,
    tolerance: f32,
    blocked: impl Fn(Cell) -> bool,
    hits: &[Hit],
) -> Result<(), TestCaseError> {
    let centre = look.centre();
    for cell in look.free_cells().filter(|&cell| cell != centre) {
        prop_assert!(!blocked(cell), "{} free", cell);
    }
    for cell in look.blocked_cells() {
        prop_assert!(blocked(cell), "{} blocked", cell);
        prop_assert!(!look.is_free(cell));
    }
    let well_inside = 2.0 * f64::from(tolerance) + 0.001;
    let middle = well_inside..1.0 - well_inside;
    let far = (SPAN / 2) as f64 - 0.5;
    for hit in hits
        .iter()
        .filter(|hit| hit.range < far && hit.cell != centre)
    {
        if middle.contains(&hit.place) && hit.slope > 0.25 {
            prop_assert!(look.is_blocked(hit.cell), "{} not blocked", hit.cell);
            prop_assert!(look.is_free(hit.front), "{} not free", hit.front);
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 4 * ProptestConfig::default().cases,
        ..ProptestConfig::default()
    })]

    /// With ranges in whole millimetres and every error within the tolerance no scan
    /// tells a lie, and walls in front of a beam are seen, their corners aside.
    #[test]
    fn a_scan_within_its_tolerance_tells_no_lie(
        walls in walls(), own in cell(), inside in (0.0..1.0f64, 0.0..1.0f64),
        heading in -7.0..7.0f64, is_long in any::<bool>(), range in 1.0f32..34.0,
        side in 50.0..250.0f64,
        tolerance in prop_oneof![Just(RangeSensor::TOLERANCE), 0.03..=RangeSensor::MAX_TOLERANCE],
        errors in errors(),
    ) {
        let blocked = |cell: Cell| cell != own && blocked_in(&walls)(cell);
        let (x, y) = (f64::from(own.x) + inside.0, f64::from(own.y) + inside.1);
        // What rounding to millimetres leaves of the tolerance, and beams no longer than
        // a sighting is.
        let left = f64::from(tolerance) - 0.5 / side;
        let (of_range, of_position) = (errors.shares.0, (1.0 - errors.shares.0) * errors.shares.1);
        let of_heading = 1.0 - of_range - of_position;
        let max_range = if is_long { range } else { range / 2.0 };
        let longest = if is_long { 31.0 } else { 15.0 };
        let reach = f64::from(max_range.min(longest)) + 1.0;
        let pose = Pose {
            x: (x + left * of_position * errors.position.0) as f32,
            y: (y + left * of_position * errors.position.1) as f32,
            heading: (heading + left * of_heading * errors.heading / reach) as f32,
        };
        let count = errors.ranges.len();
        let (mut beams, mut hits) = (Vec::new(), Vec::new());
        for (i, error) in errors.ranges.iter().enumerate() {
            let bearing = TAU * i as f32 / count as f32;
            let hit = cast((x, y), heading + f64::from(bearing), f64::from(max_range), &blocked);
            let range = hit.as_ref().map_or(f64::INFINITY, |hit| {
                ((hit.range + left * of_range * error) * side).round().max(0.0) / side
            });
            beams.push(Beam { bearing: Bearing::from_radians(bearing), range: range as f32 });
            hits.extend(hit.filter(|_| range < f64::from(max_range)));
        }
        let sensor = RangeSensor { max_range, tolerance };
        let scan = RangeScan { pose, sensor, beams };
        if is_long {
            assert_no_lie(&scan.long_sighting().unwrap(), tolerance, blocked, &hits)?;
        } else {
            assert_no_lie(&scan.sighting().unwrap(), tolerance, blocked, &hits)?;
        }
    }

    /// What all around is looked at is seen: at least the four neighbours, from anywhere
    /// in the cell.
    #[test]
    fn a_dense_scan_shows_the_neighbours(
        walls in walls(), centre in cell(), inside in (0.05..0.95f64, 0.05..0.95f64),
        heading in -7.0..7.0f32, max_range in 2.0f32..14.0,
    ) {
        let blocked = blocked_in(&walls);
        let (x, y) = (f64::from(centre.x) + inside.0, f64::from(centre.y) + inside.1);
        let pose = Pose { x: x as f32, y: y as f32, heading };
        let beams = (0..720u16).map(|i| {
            let angle = TAU * f32::from(i) / 720.0;
            let hit = cast((x, y), f64::from(heading + angle), f64::from(max_range), &blocked);
            Beam {
                bearing: Bearing::from_radians(angle),
                range: hit.map_or(f32::INFINITY, |hit| hit.range as f32),
            }
        });
        let sighting = RangeScan { pose, sensor: RangeSensor::new(max_range), beams }.sighting().unwrap();
        for direction in Direction::ALL {
            let next = centre.step(direction);
            prop_assert_eq!(sighting.is_free(next), !blocked(next), "{}", next);
            prop_assert_eq!(sighting.is_blocked(next), blocked(next), "{}", next);
        }
    }

    #[test]
    fn no_scan_panics(
        pose in (any::<f32>(), any::<f32>(), any::<f32>()), sensor in (any::<f32>(), any::<f32>()),
        inside in (0.0..1.0f32, 0.0..1.0f32), fine in (0.0..20.0f32, 0.0..=0.25f32),
        beams in proptest::collection::vec((any::<f32>(), any::<f32>()), 0..20),
        vectors in proptest::collection::vec((any::<f32>(), any::<f32>(), 0.0..20.0f32), 0..20),
    ) {
        let mut beams: Vec<Beam> = beams
            .into_iter()
            .map(|(angle, range)| Beam { bearing: Bearing::from_radians(angle), range })
            .collect();
        beams.extend(vectors.into_iter().filter_map(|(ahead, right, range)| {
            Some(Beam { bearing: Bearing::from_unit(ahead, right)?, range })
        }));
        let scan = |(x, y, heading), (max_range, tolerance)| RangeScan {
            pose: Pose { x, y, heading },
            sensor: RangeSensor { max_range, tolerance },
            beams: beams.iter().copied(),
        }
        .sighting();
        let _ = scan(pose, sensor);
        let sighting = scan((3.0 + inside.0, 3.0 + inside.1, 0.0), fine).unwrap();
        prop_assert!(sighting.is_free(Cell::new(3, 3)));
        prop_assert_eq!(sighting.free_cells().filter(|&c| sighting.is_blocked(c)).count(), 0);
    }
}

/// Cells of 100 mm, 64 beams in whole millimetres with an error of up to 2 mm, a robot
/// up to 30 mm off the middle of its cell: it ends complete, with everything seen.
#[test]
fn ranges_in_millimetres_leave_no_cell_unseen() {
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    for world in 0..24 {
        let walls = Strategy::new_tree(&(walls(), cell()), &mut runner).unwrap();
        let (walls, start) = proptest::strategy::ValueTree::current(&walls);
        let blocked = |cell: Cell| cell != start && blocked_in(&walls)(cell);
        let mut robot = Explorer::<3, 3>::new(Config::new(), RobotId(1), EXTENT, start).unwrap();
        let (mut at, mut state) = (start, world);
        let mut dice = || {
            state = u64::wrapping_mul(state, 6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 33) as f64 / 2f64.powi(31)
        };
        for tick in 0.. {
            assert!(tick < 5000, "world {world} does not end");
            let (x, y) = (
                f64::from(at.x) + 0.2 + 0.6 * dice(),
                f64::from(at.y) + 0.2 + 0.6 * dice(),
            );
            let beams = (0..64u8).map(|i| {
                let angle = TAU * f32::from(i) / 64.0;
                let hit = cast((x, y), angle.into(), 8.0, &blocked);
                let noisy = hit.map(|hit| (hit.range * 100.0 + 4.0 * dice() - 2.0).round() / 100.0);
                Beam {
                    bearing: Bearing::from_radians(angle),
                    range: noisy.unwrap_or(f64::INFINITY) as f32,
                }
            });
            let pose = Pose {
                x: x as f32,
                y: y as f32,
                heading: 0.0,
            };
            let scan = RangeScan {
                pose,
                sensor: RangeSensor::new(8.0),
                beams,
            };
            robot.observe(&scan.sighting().unwrap());
            match robot.tick() {
                Action::Move(direction) => {
                    assert!(
                        !blocked(at.step(direction)),
                        "world {world}: into a wall at {at}"
                    );
                    at = at.step(direction);
                    robot.report(Motion::Moved);
                }
                Action::Wait => {}
                Action::Stop(stop) => {
                    assert!(stop.is_complete(), "world {world}: {stop}");
                    break;
                }
            }
        }
        let mut reached = std::vec![start];
        let mut next = 0;
        while let Some(&cell) = reached.get(next) {
            assert!(
                robot.map().is_free(cell),
                "world {world}: {cell} is not free"
            );
            for beside in Direction::ALL.map(|direction| cell.step(direction)) {
                if !blocked(beside) && !reached.contains(&beside) {
                    reached.push(beside);
                }
            }
            next += 1;
        }
    }
}

const MIDDLE: Pose = Pose {
    x: 10.5,
    y: 10.5,
    heading: 0.0,
};

/// What beams show from the middle of the cell (10, 10): free and blocked cells as text.
fn shown(max_range: f32, beams: &[(Bearing, f32)]) -> [std::string::String; 2] {
    let beams = beams
        .iter()
        .map(|&(bearing, range)| Beam { bearing, range });
    let sensor = RangeSensor::new(max_range);
    let scan = RangeScan {
        pose: MIDDLE,
        sensor,
        beams,
    };
    let sighting = scan.sighting().unwrap();
    let text = |cells: Vec<Cell>| {
        let cells: Vec<_> = cells.iter().map(|cell| std::format!("{cell}")).collect();
        cells.join(" ")
    };
    [
        text(sighting.free_cells().collect()),
        text(sighting.blocked_cells().collect()),
    ]
}

#[test]
fn a_multi_ranger_sees_four_lines() {
    let [free, blocked] = shown(
        4.0,
        &[
            (Bearing::AHEAD, 2.5),
            (Bearing::RIGHT, f32::INFINITY),
            (Bearing::BACK, 0.5),
            (Bearing::LEFT, f32::NAN),
        ],
    );
    assert_eq!(free, "10,10 11,10 12,10 10,11 10,12 10,13 10,14");
    assert_eq!(blocked, "9,10 13,10");
}

/// An obstacle, nothing within reach, and no measurement.
#[test]
fn three_answers_of_a_sensor_are_three_things() {
    let ahead = |range| shown(3.0, &[(Bearing::AHEAD, range)]);
    for obstacle in [1.5, 1.42, 1.58, 2.2] {
        assert_eq!(ahead(obstacle), ["10,10 11,10", "12,10"], "{obstacle}");
    }
    for nothing in [3.0, 3.2, 1e9, f32::INFINITY] {
        assert_eq!(ahead(nothing), ["10,10 11,10 12,10 13,10", ""]);
    }
    for none in [f32::NAN, -0.001, -1.0, f32::NEG_INFINITY] {
        assert_eq!(ahead(none), ["10,10", ""]);
    }
    let nowhere = Bearing::from_radians(f32::INFINITY);
    assert_eq!(shown(3.0, &[(nowhere, 1.5)]), ["10,10", ""]);
}

#[test]
fn a_cell_that_two_beams_hit_is_firm() {
    let hit = |angle| Beam {
        bearing: Bearing::from_radians(angle),
        range: 3.52,
    };
    let scan = |beams: &[Beam]| {
        let sensor = RangeSensor::new(8.0);
        let beams = beams.iter().copied();
        let scan = RangeScan {
            pose: MIDDLE,
            sensor,
            beams,
        };
        scan.sighting().unwrap()
    };
    let wall = Cell::new(14, 10);
    let one = scan(&[hit(0.0)]);
    assert!(one.is_blocked(wall) && !one.is_firm(wall));
    let two = scan(&[hit(0.0), hit(0.05)]);
    assert!(two.is_blocked(wall) && two.is_firm(wall));
}

#[test]
fn bearings_are_unit_vectors() {
    for (bearing, quarters) in [Bearing::AHEAD, Bearing::RIGHT, Bearing::BACK, Bearing::LEFT]
        .into_iter()
        .zip(0u8..)
    {
        let turned = Bearing::from_radians(f32::from(quarters) * TAU / 4.0);
        assert!((turned.ahead() - bearing.ahead()).abs() < 1e-6);
        assert!((turned.right() - bearing.right()).abs() < 1e-6);
        assert_eq!(
            Bearing::from_unit(bearing.ahead(), bearing.right()),
            Some(bearing)
        );
    }
    for (ahead, right) in [
        (0.0, 0.0),
        (0.8, 0.7),
        (f32::NAN, 0.0),
        (1.0, f32::INFINITY),
    ] {
        assert_eq!(Bearing::from_unit(ahead, right), None);
    }
}

#[test]
fn a_scan_that_says_nothing_is_refused() {
    let usual = RangeSensor::new(3.0);
    let scan = |pose, sensor| {
        RangeScan {
            pose,
            sensor,
            beams: [],
        }
        .sighting()
        .unwrap_err()
    };
    for max_range in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        let sensor = RangeSensor { max_range, ..usual };
        assert_eq!(scan(MIDDLE, sensor), ScanError::MaxRange);
    }
    for tolerance in [-0.1, 0.26, f32::NAN, f32::INFINITY] {
        let sensor = RangeSensor { tolerance, ..usual };
        assert_eq!(scan(MIDDLE, sensor), ScanError::Tolerance);
    }
    for pose in [
        Pose {
            x: f32::INFINITY,
            ..MIDDLE
        },
        Pose { y: 1e9, ..MIDDLE },
        Pose {
            heading: f32::NAN,
            ..MIDDLE
        },
    ] {
        assert_eq!(scan(pose, usual), ScanError::Pose);
    }
}
