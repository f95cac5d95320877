//! Beams of sensors with zones.

use core::f32::consts::{FRAC_PI_2, FRAC_PI_4};

use planner_core::sight::{Distances, Zone, ZoneSensor};

use super::*;

const FRONT: PlannerZoneSensor = PlannerZoneSensor {
    is_radial: 0,
    field_of_view: FRAC_PI_4,
    max_range_mm: 1000,
    yaw: 0.0,
    pitch: 0.0,
    ahead_mm: 0,
    height_mm: 80,
    floor_mm: 30,
    top_mm: 120,
    cell_mm: 100,
};

/// A wall at 550 mm, but below the floor is nearer.
fn wall() -> [PlannerZone; PLANNER_ZONES] {
    core::array::from_fn(|zone| PlannerZone {
        status: 5,
        distance_mm: if zone < 56 { 550 } else { 200 },
    })
}

/// Beams and a range to be overwritten.
fn unwritten() -> ([PlannerBeam; PLANNER_ZONE_BEAMS], f32) {
    ([beam(0.0, 77.0); PLANNER_ZONE_BEAMS], 77.0)
}

fn bits(beams: &[PlannerBeam]) -> Vec<[u32; 3]> {
    let bits = |it: &PlannerBeam| [it.bearing.ahead, it.bearing.right, it.range].map(f32::to_bits);
    beams.iter().map(bits).collect()
}

/// Also odd ones, of which some cannot be.
fn sensor() -> impl Strategy<Value = PlannerZoneSensor> {
    let angle = |most: f32| prop_oneof![9 => -most..most, 1 => any::<f32>()];
    (
        (0u8..3, angle(FRAC_PI_2), angle(0.9), angle(3.2)),
        (0u16..5000, any::<i16>(), 0u16..200),
        (0u16..200, 50u16..400, 0u16..300),
    )
        .prop_map(
            |(
                (is_radial, field_of_view, pitch, yaw),
                (max_range_mm, ahead_mm, height_mm),
                (floor_mm, top_mm, cell_mm),
            )| PlannerZoneSensor {
                is_radial,
                field_of_view: field_of_view.abs(),
                max_range_mm,
                yaw,
                pitch,
                ahead_mm,
                height_mm,
                floor_mm: floor_mm / 3,
                top_mm,
                cell_mm,
            },
        )
}

proptest! {
    #[test]
    fn zones_make_the_beams_of_rust(
        sensor in sensor(),
        zones in proptest::collection::vec(
            (prop_oneof![Just(5), Just(9), Just(255), any::<u8>()], any::<i16>()),
            PLANNER_ZONES,
        ),
    ) {
        let ours = ZoneSensor {
            distances: match sensor.is_radial {
                0 => Distances::Perpendicular,
                _ => Distances::Radial,
            },
            field_of_view: sensor.field_of_view,
            max_range_mm: sensor.max_range_mm,
            yaw: sensor.yaw,
            pitch: sensor.pitch,
            ahead_mm: sensor.ahead_mm,
            height_mm: sensor.height_mm,
            floor_mm: sensor.floor_mm,
            top_mm: sensor.top_mm,
            cell_mm: sensor.cell_mm,
        };
        let given: Vec<_> = zones
            .iter()
            .map(|&(status, distance_mm)| PlannerZone { status, distance_mm })
            .collect();
        let (mut beams, mut max_range) = unwritten();
        let result =
            planner_zone_beams(&sensor, given.as_ptr(), beams.as_mut_ptr(), &mut max_range);
        let (wanted, wanted_range) = match ours.beams() {
            Ok(made) => {
                prop_assert_eq!(result, PlannerResult::Ok);
                let zones = core::array::from_fn(|i| Zone::from_vl53(zones[i].0, zones[i].1));
                let wanted = made.read(&zones).map(PlannerBeam::from);
                (wanted, made.sensor(0.25).max_range)
            }
            Err(error) => {
                prop_assert_eq!(result, PlannerResult::from(error));
                unwritten()
            }
        };
        prop_assert_eq!(bits(&beams), bits(&wanted));
        prop_assert_eq!(max_range.to_bits(), wanted_range.to_bits());
    }
}

#[test]
fn a_wall_is_seen_above_the_floor() {
    let mut memory = memory();
    let ready = created(&mut memory, CONFIG);
    let (mut beams, mut max_range) = unwritten();
    let zones = wall();
    let result = planner_zone_beams(&FRONT, zones.as_ptr(), beams.as_mut_ptr(), &mut max_range);
    assert_eq!(result, PlannerResult::Ok);
    let pose = PlannerPose {
        x: 1.5,
        y: 1.5,
        heading: 0.0,
    };
    let result = planner_observe_scan(ready, &pose, max_range, 0.1, beams.as_ptr(), beams.len());
    assert_eq!(result, PlannerResult::Ok);
    let state = |x| {
        let mut state = 9;
        let result = planner_cell(ready, PlannerCell { x, y: 1 }, &mut state);
        assert_eq!(result, PlannerResult::Ok);
        state
    };
    assert_ne!(state(6), PlannerState::Unknown as u8);
    assert_eq!(state(7), PlannerState::Obstacle as u8);
}

#[test]
fn a_sensor_that_cannot_be_writes_nothing() {
    let (mut beams, mut max_range) = unwritten();
    let zones = wall();
    let mut make =
        |sensor| planner_zone_beams(&sensor, zones.as_ptr(), beams.as_mut_ptr(), &mut max_range);
    for field_of_view in [0.0, -1.0, 1.6, f32::NAN] {
        let sensor = PlannerZoneSensor {
            field_of_view,
            ..FRONT
        };
        assert_eq!(make(sensor), PlannerResult::ZoneFieldOfView);
    }
    for pitch in [-0.8, 0.8, f32::NAN] {
        assert_eq!(
            make(PlannerZoneSensor { pitch, ..FRONT }),
            PlannerResult::ZonePitch
        );
    }
    for yaw in [f32::INFINITY, f32::NAN] {
        assert_eq!(
            make(PlannerZoneSensor { yaw, ..FRONT }),
            PlannerResult::ZoneYaw
        );
    }
    for height_mm in [30, 120] {
        assert_eq!(
            make(PlannerZoneSensor { height_mm, ..FRONT }),
            PlannerResult::ZoneHeights
        );
    }
    for (max_range_mm, cell_mm) in [(0, 100), (1000, 0)] {
        let sensor = PlannerZoneSensor {
            max_range_mm,
            cell_mm,
            ..FRONT
        };
        assert_eq!(make(sensor), PlannerResult::ZoneZero);
    }
    let zones = zones.as_ptr();
    let all = beams.as_mut_ptr();
    let range = &raw mut max_range;
    for result in [
        planner_zone_beams(null(), zones, all, range),
        planner_zone_beams(&FRONT, null(), all, range),
        planner_zone_beams(&FRONT, zones, null_mut(), range),
        planner_zone_beams(&FRONT, zones, all, null_mut()),
    ] {
        assert_eq!(result, PlannerResult::Null);
    }
    assert_eq!((bits(&beams), max_range), (bits(&unwritten().0), 77.0));
}
