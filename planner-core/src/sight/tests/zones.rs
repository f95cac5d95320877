//! A sensor with zones before walls and above the floor, against geometry in doubles.

use core::f32::consts::{FRAC_PI_3, FRAC_PI_4};

use super::*;

const SENSOR: ZoneSensor = ZoneSensor {
    distances: Distances::Perpendicular,
    field_of_view: FRAC_PI_4,
    max_range_mm: 2000,
    yaw: 0.0,
    pitch: 0.0,
    ahead_mm: 0,
    height_mm: 100,
    floor_mm: 40,
    top_mm: 160,
    cell_mm: 100,
};

/// What stands across the sensor's way, in millimetres: from `bottom` to `top` above the floor.
#[derive(Clone, Copy, Debug)]
struct Wall {
    at: f64,
    bottom: f64,
    top: f64,
}

/// What the zones measure over a floor, before a wall. Each looks along one line that lies
/// somewhere in it, from its lower edge (0) to its upper one (1).
fn measure(sensor: &ZoneSensor, wall: Option<Wall>, places: &[f64; 64]) -> [Zone; 64] {
    let side = f64::from(sensor.field_of_view) / 8.0;
    let (sin, cos) = f64::from(sensor.pitch).sin_cos();
    core::array::from_fn(|zone| {
        let (row, column) = ((zone / 8) as f64, (zone % 8) as f64);
        let across = ((column - 3.5) * side).tan();
        let up = ((3.0 - row + places[zone]) * side).tan();
        // For each unit along the axis.
        let (forward, rise) = (cos - sin * up, sin + cos * up);
        let height = f64::from(sensor.height_mm);
        let hits = wall.map(|wall| (wall, wall.at / forward));
        let hits = hits
            .filter(|(wall, along)| (wall.bottom..=wall.top).contains(&(height + along * rise)));
        let floor = if rise < 0.0 {
            height / -rise
        } else {
            f64::INFINITY
        };
        let along = hits.map_or(floor, |(_, along)| along.min(floor));
        let length = (1.0 + across * across + up * up).sqrt();
        let measured = match sensor.distances {
            Distances::Perpendicular => along,
            Distances::Radial => along * length,
        };
        match measured <= f64::from(sensor.max_range_mm) {
            true => Zone::At(measured.round() as u16),
            false => Zone::Nothing,
        }
    })
}

fn sensor() -> impl Strategy<Value = ZoneSensor> {
    (
        (any::<bool>(), prop_oneof![Just(FRAC_PI_4), Just(FRAC_PI_3)]),
        (-0.3f32..0.3, -3.2f32..3.2, -60i16..60),
        (60u16..300, 500u16..4000),
    )
        .prop_map(
            |((is_radial, field_of_view), (pitch, yaw, ahead_mm), (height_mm, max_range_mm))| {
                ZoneSensor {
                    distances: if is_radial {
                        Distances::Radial
                    } else {
                        Distances::Perpendicular
                    },
                    field_of_view,
                    max_range_mm,
                    yaw,
                    pitch,
                    ahead_mm,
                    height_mm,
                    floor_mm: height_mm / 3,
                    top_mm: height_mm + height_mm / 3,
                    cell_mm: 100,
                }
            },
        )
}

fn places() -> impl Strategy<Value = [f64; 64]> {
    proptest::collection::vec(0.0..1.0f64, 64).prop_map(|all| all.try_into().unwrap())
}

/// Where a beam ends from the robot's middle, ahead and to the right in the sensor's frame.
fn end(sensor: &ZoneSensor, beam: &Beam) -> (f32, f32) {
    let (sin, cos) = crate::math::direction(sensor.yaw);
    let (ahead, right) = (beam.bearing.ahead(), beam.bearing.right());
    let length = beam.range * f32::from(sensor.cell_mm);
    let turned = (ahead * cos + right * sin, right * cos - ahead * sin);
    (turned.0 * length, turned.1 * length)
}

proptest! {
    #[test]
    fn a_flat_wall_gives_a_flat_wall(sensor in sensor(), at in 100.0..4000.0f64, places in places()) {
        let wall = Wall { at, bottom: 0.0, top: 10_000.0 };
        let beams = sensor.beams().unwrap();
        let reach = beams.sensor(0.1).max_range;
        let ahead = f32::from(sensor.ahead_mm);
        // The line that a zone looked along is not known: half a zone of a tilted sensor.
        let radial = if sensor.distances == Distances::Radial { 0.05 } else { 0.0 };
        let error = 2.0 + at as f32 * (0.01 + 0.25 * sensor.pitch.abs() + radial);
        let mut last = f32::NEG_INFINITY;
        for beam in beams.read(&measure(&sensor, Some(wall), &places)) {
            prop_assert!(!beam.range.is_nan());
            if beam.range.is_finite() {
                let (there, right) = end(&sensor, &beam);
                prop_assert!((there - ahead - at as f32).abs() < error, "{there} {at} {error}");
                prop_assert!(right > last, "columns lie from left to right");
                last = right;
            } else {
                prop_assert!(at as f32 + ahead + error > reach * 100.0, "{at} {reach}");
            }
        }
    }

    #[test]
    fn a_floor_alone_is_no_wall(sensor in sensor(), places in places()) {
        let beams = sensor.beams().unwrap();
        let reach = beams.sensor(0.1).max_range;
        for beam in beams.read(&measure(&sensor, None, &places)) {
            prop_assert!(beam.range.is_nan() || beam.range >= reach, "{}", beam.range);
        }
    }

    #[test]
    fn whatever_the_zones_say_beams_are_usable(
        sensor in sensor(),
        zones in proptest::collection::vec((any::<u8>(), any::<i16>()), 64),
    ) {
        let zones: Vec<_> = zones.iter().map(|&(status, mm)| Zone::from_vl53(status, mm)).collect();
        let beams = sensor.beams().unwrap().read(zones[..].try_into().unwrap());
        for beam in beams {
            let unit = Bearing::from_unit(beam.bearing.ahead(), beam.bearing.right());
            prop_assert!(unit.is_some() && (beam.range.is_nan() || beam.range >= 0.0));
        }
    }
}

fn ranges(sensor: &ZoneSensor, zones: &[Zone; 64]) -> [f32; 8] {
    sensor.beams().unwrap().read(zones).map(|beam| beam.range)
}

#[test]
fn nothing_within_reach_is_free_and_no_measurement_is_not() {
    assert_eq!(ranges(&SENSOR, &[Zone::Nothing; 64]), [f32::INFINITY; 8]);
    assert!(
        ranges(&SENSOR, &[Zone::Invalid; 64])
            .iter()
            .all(|range| range.is_nan())
    );
    // The row above the middle alone sees that far: in its third column it says nothing.
    let mut zones = [Zone::Nothing; 64];
    zones[3 * 8 + 2] = Zone::Invalid;
    let found = ranges(&SENSOR, &zones);
    assert!(found[2].is_nan());
    assert_eq!(found.iter().filter(|range| range.is_infinite()).count(), 7);
}

#[test]
fn what_hangs_above_the_robot_is_not_in_its_way() {
    let places = [0.5; 64];
    let lintel = Wall {
        at: 600.0,
        bottom: 200.0,
        top: 400.0,
    };
    let found = ranges(&SENSOR, &measure(&SENSOR, Some(lintel), &places));
    assert!(found.iter().all(|range| range.is_infinite()), "{found:?}");
    let table = Wall {
        bottom: 110.0,
        ..lintel
    };
    let found = ranges(&SENSOR, &measure(&SENSOR, Some(table), &places));
    assert!(found.iter().all(|range| *range < 7.0), "{found:?}");
}

#[test]
fn radial_distances_are_converted() {
    let radial = ZoneSensor {
        distances: Distances::Radial,
        ..SENSOR
    };
    let wall = Wall {
        at: 500.0,
        bottom: 0.0,
        top: 1000.0,
    };
    let beams = radial.beams().unwrap();
    for beam in beams.read(&measure(&radial, Some(wall), &[0.5; 64])) {
        assert!((end(&radial, &beam).0 - 500.0).abs() < 1.0);
    }
    // Read as if they were perpendicular, the outer columns would lie too far.
    let wrong = SENSOR
        .beams()
        .unwrap()
        .read(&measure(&radial, Some(wall), &[0.5; 64]));
    assert!(end(&SENSOR, &wrong[0]).0 > 530.0);
}

#[test]
fn its_geometry_takes_as_much_as_it_says() {
    assert_eq!(size_of::<ZoneBeams>(), 200);
}

#[test]
fn statuses_are_told_apart() {
    assert_eq!(Zone::from_vl53(5, 300), Zone::At(300));
    assert_eq!(Zone::from_vl53(9, 300), Zone::At(300));
    assert_eq!(Zone::from_vl53(5, 0), Zone::Invalid);
    assert_eq!(Zone::from_vl53(6, 300), Zone::Invalid);
    assert_eq!(Zone::from_vl53(255, 300), Zone::Nothing);
}

#[test]
fn a_sensor_that_cannot_be_is_refused() {
    let refused = |change: fn(&mut ZoneSensor)| {
        let mut sensor = SENSOR;
        change(&mut sensor);
        sensor.beams().unwrap_err()
    };
    assert_eq!(refused(|of| of.field_of_view = 0.0), ZoneError::FieldOfView);
    assert_eq!(
        refused(|of| of.field_of_view = f32::NAN),
        ZoneError::FieldOfView
    );
    assert_eq!(refused(|of| of.pitch = 0.8), ZoneError::Pitch);
    assert_eq!(refused(|of| of.yaw = f32::INFINITY), ZoneError::Yaw);
    assert_eq!(refused(|of| of.floor_mm = 100), ZoneError::Heights);
    assert_eq!(refused(|of| of.top_mm = 100), ZoneError::Heights);
    assert_eq!(refused(|of| of.max_range_mm = 0), ZoneError::Zero);
    assert_eq!(refused(|of| of.cell_mm = 0), ZoneError::Zero);
}
