use core::f32::consts::{FRAC_PI_2, PI};

use crate::cell::{Cell, Direction, Extent};
use crate::explorer::{Config, Explorer};
use crate::math;
use crate::planner::Planner;
use crate::radio::MAX_LEN;
use crate::robot::{Action, Motion, RobotId};
use crate::sight::{Beam, Bearing, Pose, RangeScan, RangeSensor};

const ORIGIN_MM: (i32, i32) = (-1200, 900);
const CELL_MM: u16 = 100;

/// Not its own mirror image, nor turned.
const ROOM: [&str; 18] = [
    "########################",
    "#.........#............#",
    "#.........#............#",
    "#.........#....#####...#",
    "#..............#.......#",
    "#.........#....#.......#",
    "#.........#....#.......#",
    "####..#####....#.......#",
    "#......................#",
    "#......................#",
    "#..######..............#",
    "#..#........######..####",
    "#..#........#..........#",
    "#..#........#..........#",
    "#..#...................#",
    "#..#........#..........#",
    "#...........#..........#",
    "########################",
];

fn is_wall(x: f32, y: f32) -> bool {
    let column = math::floor((x * 1000.0 - ORIGIN_MM.0 as f32) / f32::from(CELL_MM));
    let row = math::floor((ORIGIN_MM.1 as f32 - y * 1000.0) / f32::from(CELL_MM));
    let row = ROOM.get(row as usize).filter(|_| row >= 0.0);
    let sign = row.and_then(|row| row.as_bytes().get(column as usize));
    column < 0.0 || sign.is_none_or(|&sign| sign == b'#')
}

/// Metres to the next wall, by small steps.
fn range(x: f32, y: f32, yaw: f32) -> f32 {
    let (sin, cos) = math::direction(yaw);
    let steps = (1..400u16).map(|step| f32::from(step) * 0.005);
    let hit = steps
        .into_iter()
        .find(|far| is_wall(x + far * cos, y + far * sin));
    hit.unwrap_or(f32::INFINITY)
}

/// A robot in the frame of ROS, with four rangers that point to where it counts from
/// `forward` on, counter-clockwise.
struct Robot {
    planner: Explorer<3, 3>,
    at: (f32, f32),
    /// Takes y to grow to the right and angles clockwise.
    is_mirrored: bool,
}

impl Robot {
    fn new(id: u8, start: Cell, is_mirrored: bool) -> Self {
        let mut config = Config::new();
        config.link.origin_mm = ORIGIN_MM;
        config.link.cell_mm = CELL_MM;
        let extent = Extent::new(24, 18);
        Self {
            planner: Explorer::new(config, RobotId(id), extent, start).unwrap(),
            at: start.middle_in_metres(ORIGIN_MM, CELL_MM),
            is_mirrored,
        }
    }

    fn look(&mut self) {
        let (x, y) = self.at;
        let sign = if self.is_mirrored { -1.0 } else { 1.0 };
        let beams = [0.0, FRAC_PI_2, PI, -FRAC_PI_2].map(|left| Beam {
            bearing: Bearing::from_radians(-left * sign),
            range: range(x, y, left) * 1000.0 / f32::from(CELL_MM),
        });
        let pose = Pose::from_metres(x, y * sign, 0.0, ORIGIN_MM, CELL_MM);
        let sensor = RangeSensor::new(5.0);
        let sighting = RangeScan {
            pose,
            sensor,
            beams,
        }
        .sighting()
        .unwrap();
        self.planner.observe(&sighting);
    }

    /// One tick; whether it has stopped. A mirrored robot goes to its own left where it
    /// is sent to the right.
    fn go(&mut self) -> bool {
        self.look();
        match self.planner.tick() {
            Action::Wait => false,
            Action::Stop(_) => true,
            Action::Move(direction) => {
                let sign = if self.is_mirrored { -1.0 } else { 1.0 };
                let (sin, cos) = math::direction(direction.yaw() * sign);
                let to = (self.at.0 + 0.1 * cos, self.at.1 + 0.1 * sin);
                let is_free = !is_wall(to.0, to.1);
                if is_free {
                    self.at = to;
                }
                self.planner.report(if is_free {
                    Motion::Moved
                } else {
                    Motion::Blocked
                });
                false
            }
        }
    }
}

/// Lets two robots explore; returns what each has against the other.
fn two_explore(is_mirrored: bool) -> [Robot; 2] {
    let mut robots = [
        Robot::new(0, Cell::new(5, 8), false),
        Robot::new(1, Cell::new(8, 9), is_mirrored),
    ];
    for _ in 0..1500 {
        let stopped = robots.each_mut().map(Robot::go);
        let mut frame = [0; MAX_LEN];
        for (from, to) in [(0, 1), (1, 0)] {
            while let Some(length) = robots[from].planner.transmit(&mut frame) {
                robots[to].planner.receive(&frame[..length]).unwrap();
            }
        }
        if stopped == [true; 2] {
            break;
        }
    }
    robots
}

#[test]
fn a_robot_in_metres_maps_the_room_as_it_is() {
    for robot in two_explore(false) {
        assert_eq!(robot.planner.hearsay().contradictions, 0);
        let map = robot.planner.map();
        let mut known = 0;
        for (row, y) in ROOM.iter().zip(0..) {
            for (sign, x) in row.bytes().zip(0..) {
                let cell = Cell::new(x, y);
                if map.is_known(cell) {
                    known += 1;
                    assert_eq!(map.is_obstacle(cell), sign == b'#', "{cell}");
                }
            }
        }
        assert!(known > 350, "{known} cells");
    }
}

#[test]
fn a_mirrored_robot_is_noticed_by_the_others() {
    let [right, _] = two_explore(true);
    let hearsay = right.planner.hearsay();
    assert!(hearsay.contradictions >= 8, "{hearsay:?}");
    assert_eq!(hearsay.contradicted_by, Some(RobotId(1)));
}

#[test]
fn middles_of_cells_are_where_poses_say() {
    for (x, y) in [(0, 0), (23, 17), (-4, 9)] {
        let cell = Cell::new(x, y);
        let (east, north) = cell.middle_in_metres(ORIGIN_MM, CELL_MM);
        let pose = Pose::from_metres(east, north, 0.0, ORIGIN_MM, CELL_MM);
        let off = (pose.x - f32::from(x) - 0.5, pose.y - f32::from(y) - 0.5);
        assert!(off.0.abs() < 1e-4 && off.1.abs() < 1e-4, "{cell}: {pose:?}");
        for direction in Direction::ALL {
            let (sin, cos) = math::direction(direction.yaw());
            let next = cell.step(direction).middle_in_metres(ORIGIN_MM, CELL_MM);
            assert!((east + 0.1 * cos - next.0).abs() < 1e-5, "{direction:?}");
            assert!((north + 0.1 * sin - next.1).abs() < 1e-5, "{direction:?}");
        }
    }
}

#[test]
fn no_scan_is_taken_from_what_is_no_pose() {
    for pose in [
        Pose::from_metres(f32::NAN, 0.0, 0.0, ORIGIN_MM, CELL_MM),
        Pose::from_metres(0.0, f32::INFINITY, 0.0, ORIGIN_MM, CELL_MM),
        Pose::from_metres(0.0, 0.0, f32::NAN, ORIGIN_MM, CELL_MM),
        Pose::from_metres(0.0, 0.0, 0.0, ORIGIN_MM, 0),
    ] {
        let sensor = RangeSensor::new(5.0);
        let scan = RangeScan {
            pose,
            sensor,
            beams: [],
        };
        assert!(scan.sighting().is_err(), "{pose:?}");
    }
}
