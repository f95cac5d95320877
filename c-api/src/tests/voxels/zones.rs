//! Looks from zones and rays, and places in metres.

use planner_core::sight::{Distances, RangeSensor, Zone, ZoneSensor};
use planner_core::volume::{Ray, Vector, VoxelLook, VoxelPose};

use super::*;

const FRONT: PlannerZoneSensor = PlannerZoneSensor {
    is_radial: 0,
    field_of_view: core::f32::consts::FRAC_PI_4,
    max_range_mm: 2000,
    yaw: 0.0,
    pitch: 0.0,
    ahead_mm: 30,
    height_mm: 0,
    floor_mm: 0,
    top_mm: 0,
    cell_mm: 0,
};

const POSE: PlannerVoxelPose = PlannerVoxelPose {
    x: 1.5,
    y: 1.5,
    z: 1.5,
    heading: 0.0,
};

const NOTHING: PlannerVoxelSeen = PlannerVoxelSeen {
    voxel: PlannerVoxel { x: 9, y: 9, z: 9 },
    occupied: 9,
};

fn told(seen: &[PlannerVoxelSeen]) -> Vec<(Voxel, bool)> {
    let each = |seen: &PlannerVoxelSeen| (seen.voxel.into(), seen.occupied != 0);
    seen.iter().map(each).collect()
}

#[test]
fn zones_and_rays_show_what_they_do_in_rust() {
    let pose = VoxelPose::from(POSE);
    let up = PlannerVector {
        ahead: 0.0,
        right: 0.0,
        up: 1.0,
    };
    let from = PlannerVector { up: 0.0, ..up };
    let ranger = PlannerRay {
        from,
        direction: up,
        range: 1.5,
    };
    let mut zones = [PlannerZone {
        status: 5,
        distance_mm: 1250,
    }; PLANNER_ZONES];
    zones[3].status = 255;
    zones[40].status = 4;

    let rays = ZoneSensor {
        distances: Distances::Perpendicular,
        field_of_view: FRONT.field_of_view,
        max_range_mm: FRONT.max_range_mm,
        yaw: 0.0,
        pitch: 0.0,
        ahead_mm: FRONT.ahead_mm,
        height_mm: 0,
        floor_mm: 0,
        top_mm: 0,
        cell_mm: BOX.cell_mm,
    };
    let rays = rays.rays().unwrap();
    let read = zones.map(|zone| Zone::from_vl53(zone.status, zone.distance_mm));
    let mut wanted = VoxelLook::vacant();
    wanted.begin(pose, BOX.range).unwrap();
    wanted.see(rays.sensor(0.1), rays.read(&read)).unwrap();
    let front = wanted.seen().count();
    let ray = Ray {
        from: Vector::ZERO,
        direction: Vector::UP,
        range: 1.5,
    };
    let sensor = RangeSensor {
        max_range: 4.0,
        tolerance: 0.1,
    };
    wanted.see(sensor, [ray]).unwrap();
    let wanted: Vec<_> = wanted.seen().collect();

    let mut seen = [NOTHING; PLANNER_VOXEL_ZONES_SEEN];
    let mut look = PlannerVoxelLook {
        seen: seen.as_mut_ptr(),
        room: front - 1,
        count: 0,
    };
    let add = |look: &mut _| planner_voxel_zones(&BOX, &POSE, &FRONT, 0.1, zones.as_ptr(), look);
    let measure = |look: &mut _| planner_voxel_rays(&BOX, &POSE, 4.0, 0.1, &ranger, 1, look);
    // Without room nothing is written.
    assert_eq!(add(&mut look), PlannerResult::TooMany);
    assert_eq!(look.count, 0);
    look.room = front;
    assert_eq!(add(&mut look), OK);
    assert_eq!(look.count, front);
    assert_eq!(measure(&mut look), PlannerResult::TooMany);
    assert_eq!(look.count, front);
    look.room = wanted.len();
    assert_eq!(measure(&mut look), OK);
    assert_eq!(add(&mut look), OK);
    assert_eq!(look.count, wanted.len());
    assert!(wanted.len() > front && front > 10);
    assert_eq!(told(&seen[..look.count]), wanted);
    assert_eq!(seen[look.count].occupied, 9);

    // What cannot be is refused, and the look is as it was.
    let bad = PlannerVoxelPose {
        z: f32::NAN,
        ..POSE
    };
    let steep = PlannerZoneSensor {
        pitch: 1.6,
        ..FRONT
    };
    let flat = PlannerVoxelConfig { cell_mm: 0, ..BOX };
    let first = zones.as_ptr();
    let look = &mut look;
    for (result, wanted) in [
        (
            planner_voxel_zones(&BOX, &bad, &FRONT, 0.1, first, look),
            PlannerResult::Scan,
        ),
        (
            planner_voxel_zones(&BOX, &POSE, &FRONT, 0.3, first, look),
            PlannerResult::Scan,
        ),
        (
            planner_voxel_zones(&BOX, &POSE, &steep, 0.1, first, look),
            PlannerResult::ZonePitch,
        ),
        (
            planner_voxel_zones(&flat, &POSE, &FRONT, 0.1, first, look),
            PlannerResult::CellSize,
        ),
        (
            planner_voxel_zones(&BOX, &POSE, &FRONT, 0.1, null(), look),
            PlannerResult::Null,
        ),
        (
            planner_voxel_zones(&BOX, null(), &FRONT, 0.1, first, look),
            PlannerResult::Null,
        ),
        (
            planner_voxel_zones(&BOX, &POSE, &FRONT, 0.1, first, null_mut()),
            PlannerResult::Null,
        ),
        (
            planner_voxel_rays(&BOX, &POSE, 0.0, 0.1, &ranger, 1, look),
            PlannerResult::Scan,
        ),
        (
            planner_voxel_rays(&BOX, &POSE, 4.0, 0.1, null(), 1, look),
            PlannerResult::Null,
        ),
    ] {
        assert_eq!(result, wanted);
    }
    assert_eq!(told(&seen[..look.count]), wanted);
    let nowhere = &mut PlannerVoxelLook {
        seen: null_mut(),
        ..*look
    };
    assert_eq!(add(nowhere), PlannerResult::Null);
    nowhere.count = nowhere.room + 1;
    assert_eq!(add(nowhere), PlannerResult::TooMany);
}

#[test]
fn places_are_told_in_metres() {
    let config = PlannerVoxelConfig {
        origin_x_mm: -1500,
        origin_y_mm: 1250,
        ..BOX
    };
    let mut pose = POSE;
    let (mut at, mut heading) = (NOTHING.voxel, 9);
    let mut place = |x: f32, y: f32, z: f32, yaw: f32| {
        assert_eq!(
            planner_voxel_pose_from_metres(&config, x, y, z, yaw, &mut pose),
            OK
        );
        planner_voxel_at(&config, &pose, &mut at, &mut heading)
    };
    for (x, y, z, yaw) in [
        (-1.6, 0.0, 0.5, 0.0),
        (0.0, 0.0, 2.1, 0.0),
        (0.0, f32::NAN, 0.5, 0.0),
        (0.0, 0.0, 0.5, f32::INFINITY),
    ] {
        assert_eq!(place(x, y, z, yaw), PlannerResult::OffGrid);
    }
    assert_eq!(place(0.1, -0.1, 0.6, -1.5), OK);
    assert_eq!((at, heading), (PlannerVoxel { x: 3, y: 2, z: 1 }, 2));
    assert!((planner_voxel_yaw(heading) + core::f32::consts::FRAC_PI_2).abs() < 1e-6);
    let (mut x, mut y, mut z) = (9.0, 9.0, 9.0);
    let middle = planner_voxel_middle_in_metres(&config, at, &mut x, &mut y, &mut z);
    assert_eq!((middle, x, y, z), (OK, 0.25, 0.0, 0.75));
    let flat = PlannerVoxelConfig { cell_mm: 0, ..BOX };
    let made = planner_voxel_pose_from_metres(&flat, 0.0, 0.0, 0.0, 0.0, &mut pose);
    assert_eq!(made, PlannerResult::CellSize);
}

#[test]
fn fields_are_told_in_angles() {
    let mut config = PlannerVoxelConfig { near: 2, ..BOX };
    let eighth = core::f32::consts::FRAC_PI_8;
    let mut set = |up, side| planner_voxel_set_field(&mut config, up, eighth, side);
    assert_eq!(set(f32::NAN, eighth), PlannerResult::Sensor);
    assert_eq!(set(-0.1, eighth), PlannerResult::Sensor);
    assert_eq!(set(eighth, 1.6), PlannerResult::Sensor);
    assert_eq!(set(core::f32::consts::FRAC_PI_2, eighth), OK);
    assert_eq!((config.up, config.down, config.side), (65535, 106, 106));
    assert_eq!(
        (config.near, config.field),
        (2, PlannerVoxelField::Custom as u8)
    );
}
