use std::collections::BTreeSet;
use std::vec::Vec;

use proptest::prelude::*;

use super::*;
use crate::cell::Extent;
use crate::robot::{Action, RobotId, Stop};
use crate::sight::{Distances, Zone, ZoneError, ZoneSensor};
use crate::volume::{Content, Field, ZoneRays};

/// Sides of the room, whose walls are within.
const ROOM: [i16; 3] = [12, 10, 8];
const CELL_MM: u16 = 250;
const RANGE: u8 = 8;

const SENSOR: ZoneSensor = ZoneSensor {
    distances: Distances::Perpendicular,
    field_of_view: core::f32::consts::FRAC_PI_4,
    max_range_mm: 2_000,
    yaw: 0.0,
    pitch: 0.0,
    ahead_mm: 0,
    height_mm: 0,
    floor_mm: 0,
    top_mm: 0,
    cell_mm: CELL_MM,
};

/// A room with walls, and more in it.
fn room(within: impl IntoIterator<Item = Voxel>) -> BTreeSet<Voxel> {
    let [width, depth, levels] = ROOM;
    let mut walls: BTreeSet<Voxel> = within.into_iter().collect();
    for z in 0..levels {
        for y in 0..depth {
            for x in 0..width {
                let is_wall = |at: i16, side: i16| at == 0 || at == side - 1;
                if is_wall(x, width) || is_wall(y, depth) || is_wall(z, levels) {
                    walls.insert(Voxel::new(x, y, z));
                }
            }
        }
    }
    walls
}

/// How far the walls are, by brute force: where a ray enters the first of them.
fn distance(walls: &BTreeSet<Voxel>, from: [f64; 3], along: [f64; 3]) -> f64 {
    let enters = |voxel: &Voxel| {
        let corner = [voxel.x, voxel.y, voxel.z].map(f64::from);
        let (mut enter, mut leave) = (0.0f64, f64::INFINITY);
        for axis in 0..3 {
            let to = [corner[axis], corner[axis] + 1.0].map(|it| (it - from[axis]) / along[axis]);
            enter = enter.max(to[0].min(to[1]));
            leave = leave.min(to[0].max(to[1]));
        }
        (enter < leave).then_some(enter)
    };
    walls
        .iter()
        .filter_map(enters)
        .fold(f64::INFINITY, f64::min)
}

/// The angles of a sensor's zones in doubles, not as they are computed for it.
fn measure(walls: &BTreeSet<Voxel>, pose: &VoxelPose, sensor: &ZoneSensor) -> [Zone; 64] {
    let [heading, yaw, pitch, side] = [
        pose.heading,
        sensor.yaw,
        sensor.pitch,
        sensor.field_of_view / 8.0,
    ]
    .map(f64::from);
    let yaw = heading + yaw;
    let axis = [
        yaw.cos() * pitch.cos(),
        yaw.sin() * pitch.cos(),
        pitch.sin(),
    ];
    let right = [-yaw.sin(), yaw.cos(), 0.0];
    let up = [
        -yaw.cos() * pitch.sin(),
        -yaw.sin() * pitch.sin(),
        pitch.cos(),
    ];
    let ahead = f64::from(sensor.ahead_mm) / f64::from(CELL_MM);
    let middle = [pose.x, pose.y, pose.z].map(f64::from);
    let from = core::array::from_fn(|i| middle[i] + ahead * axis[i]);
    core::array::from_fn(|zone| {
        let tangent = |number: usize| ((number as f64 - 3.5) * side).tan();
        let (down, aside) = (tangent(zone / 8), tangent(zone % 8));
        let norm = (1.0 + down * down + aside * aside).sqrt();
        let along = core::array::from_fn(|i| (axis[i] + aside * right[i] - down * up[i]) / norm);
        let far = distance(walls, from, along) * f64::from(CELL_MM);
        let told = match sensor.distances {
            Distances::Perpendicular => far / norm,
            Distances::Radial => far,
        };
        match told <= f64::from(sensor.max_range_mm) {
            true => Zone::At(told.round() as u16),
            false => Zone::Nothing,
        }
    })
}

fn begun(pose: VoxelPose, range: u8) -> VoxelLook {
    let mut look = VoxelLook::vacant();
    look.begin(pose, range).unwrap();
    look
}

fn look(pose: VoxelPose, sensors: &[(ZoneRays, [Zone; 64])]) -> VoxelLook {
    let mut look = begun(pose, RANGE);
    for (rays, zones) in sensors {
        look.see(rays.sensor(0.1), rays.read(zones)).unwrap();
    }
    look
}

fn inside() -> impl Strategy<Value = Voxel> {
    (1i16..11, 1i16..9, 1i16..7).prop_map(|(x, y, z)| Voxel::new(x, y, z))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    /// From anywhere, however sensors point and distances are told, and with errors within the
    /// tolerance, nothing is told wrongly; and much is told.
    #[test]
    fn zones_tell_no_lies(
        within in prop::collection::btree_set(inside(), 0..40),
        at in inside(),
        part in prop::array::uniform3(prop_oneof![Just(0.5f32), 0.1f32..0.9]),
        error in prop::array::uniform3(-0.05f32..0.05),
        heading in prop_oneof![(0i8..8).prop_map(|it| f32::from(it) * core::f32::consts::FRAC_PI_4), -7.0f32..7.0],
        mounts in prop::collection::vec((-4.0f32..4.0, -1.57f32..1.57, -20i16..20, any::<bool>(), 0.2f32..1.57), 1..4),
    ) {
        let mut walls = room(within);
        walls.remove(&at);
        let [x, y, z] = core::array::from_fn(|i| f32::from([at.x, at.y, at.z][i]) + part[i]);
        let pose = VoxelPose { x, y, z, heading };
        let sensors: Vec<_> = mounts.into_iter().map(|(yaw, pitch, ahead_mm, is_radial, field_of_view)| {
            let distances = if is_radial { Distances::Radial } else { Distances::Perpendicular };
            let sensor = ZoneSensor { yaw, pitch, ahead_mm, distances, field_of_view, ..SENSOR };
            (sensor.rays().unwrap(), measure(&walls, &pose, &sensor))
        }).collect();
        let [dx, dy, dz] = error;
        let told = VoxelPose { x: x + dx, y: y + dy, z: z + dz, heading };
        let look = look(told, &sensors);
        prop_assert_eq!(look.eye(), at);
        let mut seen = BTreeSet::new();
        for (voxel, occupied) in look.seen() {
            prop_assert_eq!(occupied, walls.contains(&voxel), "{}", voxel);
            prop_assert!(seen.insert(voxel), "{} twice", voxel);
        }
        prop_assert!(seen.len() > 1);
    }
}

/// A drone with one sensor ahead, no wider than a voxel, surveys a room with a cupboard and a
/// pillar: nothing of its map is wrong, and it knows all but a few voxels.
#[test]
fn a_drone_with_zones_surveys_a_room() {
    let cupboard = (3..=7).flat_map(|y| (1..=4).map(move |z| Voxel::new(6, y, z)));
    let walls = room(cupboard.chain((1..7).map(|z| Voxel::new(9, 4, z))));
    let half = core::f32::consts::FRAC_PI_8;
    let config = crate::voxel_survey::Config {
        clearance: 0,
        range: RANGE,
        field: Field::of_angles(half, half, Some(half), 0),
        ..crate::voxel_survey::Config::new()
    };
    let mut robot = std::boxed::Box::new(crate::voxel_survey::VoxelSurvey::<2, 2, 8>::vacant());
    robot
        .reset(config, RobotId(1), Extent::new(12, 10), 8)
        .unwrap();
    let rays = SENSOR.rays().unwrap();
    let mut at = Voxel::new(2, 2, 3);
    let (mut steps, mut most) = (0, 0);
    let stop = loop {
        let (x, y, z) = at.middle_in_metres((0, 0), CELL_MM);
        let yaw = robot.heading().yaw();
        let pose = VoxelPose::from_metres(x, y, z, yaw, (0, 0), CELL_MM);
        let look = look(pose, &[(rays, measure(&walls, &pose, &SENSOR))]);
        most = most.max(look.seen().count());
        robot.observe_towards(look.eye(), pose.heading().unwrap(), look.seen());
        match robot.tick() {
            Action::Move(to) => {
                assert!(!walls.contains(&to));
                at = to;
            }
            Action::Wait => {}
            Action::Stop(stop) => break stop,
        }
        steps += 1;
        assert!(steps < 5_000);
    };
    let [width, depth, levels] = ROOM;
    let all = (0..levels)
        .flat_map(|z| (0..depth).flat_map(move |y| (0..width).map(move |x| Voxel::new(x, y, z))));
    let (mut unknown, mut free) = (0, 0);
    for voxel in all {
        match robot.volume().content(voxel) {
            Content::Unknown => unknown += u32::from(!walls.contains(&voxel)),
            content => assert_eq!(
                content == Content::Occupied,
                walls.contains(&voxel),
                "{voxel}"
            ),
        }
        free += u32::from(!walls.contains(&voxel));
    }
    std::eprintln!("{stop} after {steps} steps: {unknown} of {free} unknown; {most} seen at most");
    assert!(
        stop.is_complete() || matches!(stop, Stop::Unseen { .. }),
        "{stop}"
    );
    assert!(unknown * 50 < free, "{unknown} of {free}");
}

/// What a voxel is that one ray hits and another passes, and what is no measurement.
#[test]
fn hits_outweigh_what_passed() {
    let pose = VoxelPose {
        x: 3.5,
        y: 3.5,
        z: 3.5,
        heading: 0.0,
    };
    let sensor = RangeSensor {
        max_range: 6.0,
        tolerance: 0.1,
    };
    let ray = |range| Ray {
        from: Vector::ZERO,
        direction: Vector::AHEAD,
        range,
    };
    for order in [[2.5, 4.5], [4.5, 2.5]] {
        let mut look = begun(pose, RANGE);
        look.see(sensor, order.map(ray)).unwrap();
        let seen: Vec<_> = look.seen().map(|(at, it)| (at.x, it)).collect();
        assert_eq!(
            seen,
            [
                (3, false),
                (4, false),
                (5, false),
                (6, true),
                (7, false),
                (8, true)
            ]
        );
    }
    for (range, last) in [(f32::NAN, 3), (-1.0, 3), (f32::INFINITY, 9), (6.5, 9)] {
        let mut look = begun(pose, RANGE);
        look.see(sensor, [ray(range)]).unwrap();
        let seen: Vec<_> = look.seen().collect();
        let wanted: Vec<_> = (3..=last).map(|x| (Voxel::new(x, 3, 3), false)).collect();
        assert_eq!(seen, wanted, "{range}");
    }
    // What is farther than the configuration's range is left out.
    let mut look = begun(pose, 2);
    look.see(sensor, [ray(2.5)]).unwrap();
    assert_eq!(look.seen().count(), 3);
}

#[test]
fn what_cannot_be_is_refused() {
    let pose = VoxelPose {
        x: 3.5,
        y: 3.5,
        z: 3.5,
        heading: 0.0,
    };
    for bad in [
        VoxelPose {
            x: f32::NAN,
            ..pose
        },
        VoxelPose { z: 1e9, ..pose },
        VoxelPose {
            heading: f32::INFINITY,
            ..pose
        },
    ] {
        assert_eq!(VoxelLook::vacant().begin(bad, 8), Err(ScanError::Pose));
    }
    let mut look = begun(pose, 8);
    let ray = Ray {
        from: Vector::ZERO,
        direction: Vector::UP,
        range: 2.5,
    };
    for (max_range, tolerance, error) in [
        (0.0, 0.1, ScanError::MaxRange),
        (f32::INFINITY, 0.1, ScanError::MaxRange),
        (4.0, 0.3, ScanError::Tolerance),
        (4.0, f32::NAN, ScanError::Tolerance),
    ] {
        let sensor = RangeSensor {
            max_range,
            tolerance,
        };
        assert_eq!(look.see(sensor, [ray]), Err(error));
    }
    for bad in [
        Ray {
            direction: Vector::new(1.0, 1.0, 0.0),
            ..ray
        },
        Ray {
            direction: Vector::new(f32::NAN, 0.0, 0.0),
            ..ray
        },
        Ray {
            from: Vector::UP,
            ..ray
        },
    ] {
        look.see(RangeSensor::new(4.0), [bad]).unwrap();
    }
    assert_eq!(look.seen().count(), 1);
    for (sensor, error) in [
        (
            ZoneSensor {
                field_of_view: 1.6,
                ..SENSOR
            },
            ZoneError::FieldOfView,
        ),
        (
            ZoneSensor {
                pitch: 1.6,
                ..SENSOR
            },
            ZoneError::Pitch,
        ),
        (
            ZoneSensor {
                yaw: f32::NAN,
                ..SENSOR
            },
            ZoneError::Yaw,
        ),
        (
            ZoneSensor {
                cell_mm: 0,
                ..SENSOR
            },
            ZoneError::Zero,
        ),
    ] {
        assert_eq!(sensor.rays().unwrap_err(), error);
    }
}

proptest! {
    /// Any numbers: no voxel is seen twice, none farther than the look holds, the robot's own is
    /// free.
    #[test]
    fn any_numbers_are_taken(
        pose in prop::array::uniform4(any::<f32>()),
        rays in prop::collection::vec((prop::array::uniform3(any::<f32>()), prop::array::uniform3(-1.1f32..1.1), any::<f32>()), 0..8),
        max_range in any::<f32>(),
    ) {
        let [x, y, z, heading] = pose;
        let wrapped = |at: f32| at % 40_000.0;
        let pose = VoxelPose { x: wrapped(x), y: wrapped(y), z: wrapped(z), heading };
        let mut look = VoxelLook::vacant();
        if look.begin(pose, u8::MAX).is_ok() {
            let vector = |[x, y, z]: [f32; 3]| Vector::new(x, y, z);
            let rays = rays.into_iter().map(|(from, direction, range)| {
                Ray { from: vector(from), direction: vector(direction), range }
            });
            let _ = look.see(RangeSensor { max_range, tolerance: 0.0 }, rays);
            prop_assert!(look.seen().any(|it| it == (look.eye(), false)));
        }
    }
}
