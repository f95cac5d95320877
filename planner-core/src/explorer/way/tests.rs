//! Waypoints and poses off the next cell against plain geometry, in random places.

use std::vec::Vec;

use proptest::prelude::*;

use super::*;
use crate::cell::Extent;
use crate::explorer::Config;
use crate::planner::Planner;
use crate::robot::{Action, Motion, RobotId};
use crate::sight::{Sighting, look};

type Small = Explorer<3, 3>;

const SIDE: i16 = 24;

/// A place, and where the robot starts.
#[derive(Clone, Debug)]
struct Place {
    walls: Vec<bool>,
    start: Cell,
    radius: u8,
}

impl Place {
    fn is_blocked(&self, cell: Cell) -> bool {
        let is_inside = (0..SIDE).contains(&cell.x) && (0..SIDE).contains(&cell.y);
        !is_inside || self.walls[(cell.y * SIDE + cell.x) as usize]
    }

    fn robot(&self) -> Small {
        let extent = Extent::new(SIDE as u16, SIDE as u16);
        Small::new(Config::new(), RobotId(0), extent, self.start).unwrap()
    }

    fn look(&self, from: Cell) -> Sighting {
        look(from, self.radius, |cell| self.is_blocked(cell))
    }
}

fn place() -> impl Strategy<Value = Place> {
    let cells = (SIDE * SIDE) as usize;
    (0.0..0.4f64, 0..SIDE, 0..SIDE, 2u8..9).prop_flat_map(move |(share, x, y, radius)| {
        proptest::collection::vec(proptest::bool::weighted(share), cells).prop_map(
            move |mut walls| {
                walls[(y * SIDE + x) as usize] = false;
                let start = Cell::new(x, y);
                Place {
                    walls,
                    start,
                    radius,
                }
            },
        )
    })
}

/// The cells that the segment between two centres touches, by trying all: a square touches
/// a line if its corners are not all on one side.
fn touched(from: Cell, to: Cell) -> Vec<Cell> {
    let (dx, dy) = (i32::from(to.x - from.x), i32::from(to.y - from.y));
    let columns = from.x.min(to.x)..=from.x.max(to.x);
    let rows = from.y.min(to.y)..=from.y.max(to.y);
    let cells = rows.flat_map(|y| columns.clone().map(move |x| Cell::new(x, y)));
    let touches = |cell: &Cell| {
        let sides = [(-1, -1), (-1, 1), (1, -1), (1, 1)].map(|(a, b)| {
            let x = 2 * i32::from(cell.x - from.x) + a;
            let y = 2 * i32::from(cell.y - from.y) + b;
            (x * dy - y * dx).signum()
        });
        sides.iter().any(|of| *of >= 0) && sides.iter().any(|of| *of <= 0)
    };
    cells.filter(touches).collect()
}

/// Walks step by step, `ticks` long at most, and calls `at` where there is a plan.
fn walk(
    place: &Place,
    ticks: u32,
    mut at: impl FnMut(&mut Small) -> Result<(), TestCaseError>,
) -> Result<(), TestCaseError> {
    let mut robot = place.robot();
    for _ in 0..ticks {
        robot.observe(&place.look(robot.status().position));
        match robot.tick() {
            Action::Move(_) => {
                at(&mut robot)?;
                robot.report(Motion::Moved);
            }
            Action::Wait => {}
            Action::Stop(_) => break,
        }
    }
    Ok(())
}

/// The plan, and another robot with the same.
fn copy(place: &Place, of: &Small) -> Small {
    let mut robot = place.robot();
    robot.around.map.join(&of.around.map);
    robot.around.position = of.around.position;
    robot.role = of.role;
    robot
}

proptest! {
    #[test]
    fn the_waypoint_is_the_farthest_cell_in_a_straight_line(place in place()) {
        walk(&place, 60, |robot| {
            let here = robot.status().position;
            let is_seen = |cell: &Cell| {
                touched(here, *cell).into_iter().all(|of| robot.around.is_open(of))
            };
            let window = Window::around(here);
            let way = robot.way().take(LONGEST as usize);
            let way = way.take_while(|cell| window.place(*cell).is_some());
            prop_assert_eq!(robot.waypoint(), way.filter(is_seen).last());
            Ok(())
        })?;
    }

    #[test]
    fn poses_on_the_line_on_the_way_and_beside_it_keep_the_plan(place in place()) {
        walk(&place, 40, |robot| {
            let here = robot.status().position;
            let (goal, left) = (robot.role.goal(), robot.role.remaining());
            let waypoint = robot.waypoint().expect("it makes a step");
            for pose in touched(here, waypoint).into_iter().chain(robot.way()) {
                let mut other = copy(&place, robot);
                other.observe(&Sighting::new(pose));
                prop_assert_eq!(other.role.goal(), goal);
                prop_assert_eq!(other.status().position, pose);
                prop_assert!(other.role.remaining() <= left, "{} from {}", pose, here);
                prop_assert!(Some(pose) == goal || other.way().next().is_some());
            }
            for beside in robot.way().flat_map(|cell| Direction::ALL.map(|side| cell.step(side))) {
                if place.is_blocked(beside) || beside.chebyshev(here) > 3 {
                    continue;
                }
                let mut other = copy(&place, robot);
                other.observe(&Sighting::new(beside));
                prop_assert_eq!(other.role.goal(), goal);
                prop_assert!(other.role.remaining() <= left + 2);
                // The way leads on from there, over cells that are beside each other.
                let cells: Vec<_> = [beside].into_iter().chain(other.way()).collect();
                let are_beside = |pair: &[Cell]| pair[0].direction_to(pair[1]).is_some();
                prop_assert!(cells.windows(2).all(are_beside));
                if other.role.remaining() < 200 {
                    prop_assert_eq!(cells.last().copied(), goal);
                }
            }
            Ok(())
        })?;
    }

    /// The robot goes so many cells along the line, sometimes one aside, and looks.
    #[test]
    fn a_robot_that_goes_straight_explores_everything(
        place in place(), hop in 1usize..9, slip in any::<u64>(),
    ) {
        let mut robot = place.robot();
        let mut stop = None;
        let mut slips = slip;
        for _ in 0..20_000 {
            let here = robot.status().position;
            prop_assert!(!place.is_blocked(here));
            match robot.tick() {
                Action::Move(_) => {
                    let waypoint = robot.waypoint().expect("it makes a step");
                    let mut line = [here].into_iter().chain(
                        along_line(here, waypoint).scan(here, |at, step| {
                            *at = at.step(step);
                            Some(*at)
                        }),
                    );
                    let mut pose = line.by_ref().take(hop + 1).last().unwrap_or(here);
                    slips = slips.rotate_left(1);
                    let aside = pose.step(Direction::from_index(slips as u8));
                    if slips & 8 != 0 && !place.is_blocked(aside) {
                        pose = aside;
                    }
                    robot.observe(&place.look(pose));
                }
                Action::Wait => {
                    robot.observe(&place.look(here));
                }
                Action::Stop(reason) => {
                    stop = Some(reason);
                    break;
                }
            }
        }
        prop_assert!(stop.is_some_and(|stop| stop.is_complete()), "{stop:?} {:?}", robot.map());
        let mut reached = std::vec![place.start];
        let mut next = 0;
        while let Some(&cell) = reached.get(next) {
            for beside in Direction::ALL.map(|side| cell.step(side)) {
                prop_assert!(robot.map().is_known(beside), "{beside} {:?}", robot.map());
                if !place.is_blocked(beside) && !reached.contains(&beside) {
                    reached.push(beside);
                }
            }
            next += 1;
        }
    }
}

#[test]
fn a_pose_elsewhere_drops_the_plan() {
    let mut place = Place {
        walls: std::vec![false; (SIDE * SIDE) as usize],
        start: Cell::new(2, 2),
        radius: 4,
    };
    // A wall between two corridors.
    for x in 0..20 {
        place.walls[(4 * SIDE + x) as usize] = true;
    }
    let mut robot = place.robot();
    robot.observe(&place.look(place.start));
    assert!(matches!(robot.tick(), Action::Move(_)));
    assert!(robot.role.goal().is_some());
    robot.observe(&Sighting::new(Cell::new(12, 20)));
    assert_eq!((robot.role.goal(), robot.waypoint()), (None, None));
}

/// A hall of 22×22 cells, and a body of 3×3 at its northern wall: it leaves the wall at once,
/// comes to another one as late as it can, and goes no farther.
#[test]
fn of_ways_of_equal_length_the_one_farther_from_walls_is_taken() {
    use Direction::{East, South, West};
    let extent = Extent::new(SIDE as u16, SIDE as u16);
    let config = Config {
        clearance: 1,
        ..Config::new()
    };
    let start = Cell::new(3, 2);
    let mut robot = Small::new(config, RobotId(0), extent, start).unwrap();
    let is_wall = |cell: Cell| !(1..SIDE - 1).contains(&cell.x) || !(1..SIDE - 1).contains(&cell.y);
    for at in [Cell::new(12, 12), Cell::new(3, 12), Cell::new(12, 2), start] {
        robot.observe(&look(at, 15, is_wall));
    }
    let kept = |steps: &[Direction]| {
        let mut path = Path::new();
        steps.iter().for_each(|step| assert!(path.push_back(*step)));
        robot.keep_clear(&mut path);
        path.steps().collect::<Vec<_>>()
    };
    assert_eq!(kept(&[East, East, East, South]), [South, East, East, East]);
    // Along the western wall it goes last, though it goes there first.
    assert_eq!(
        kept(&[West, South, South, South]),
        [South, South, South, West]
    );
    // Nothing is gained in the middle, nor where there is no other way.
    for steps in [[South, South, East, South], [East, East, East, East]] {
        assert_eq!(kept(&steps), steps);
    }
}
