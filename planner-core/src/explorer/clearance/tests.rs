//! Robots with bodies in small places: the obviously correct simulator.

use std::vec::Vec;

use proptest::prelude::*;

use super::*;
use crate::cell::Extent;
use crate::explorer::tests::scene::kept;
use crate::explorer::{Config, SensorModel};
use crate::planner::{Contact, Errands, Planner};
use crate::robot::{Action, Motion, RobotId, Stop, Wait};
use crate::sight::look;
use crate::tile::TileSet;

type Small = Explorer<3, 3>;

/// A place, and robots that have room there.
#[derive(Clone, Debug)]
struct Place {
    extent: Extent,
    walls: Vec<Cell>,
    starts: Vec<Cell>,
    kept_out: Vec<Cell>,
    clearance: u8,
    radius: u8,
    slice: u32,
    /// Whether robots see each other.
    sees_robots: bool,
}

impl Place {
    fn is_blocked(&self, cell: Cell) -> bool {
        !self.extent.contains(cell) || self.walls.contains(&cell)
    }

    fn has_room(&self, cell: Cell) -> bool {
        let is_shut = |cell| self.is_blocked(cell) || self.kept_out.contains(&cell);
        !body_cells(self.clearance, cell).any(is_shut)
    }

    /// Where a body can get to from a cell.
    fn reachable(&self, from: Cell) -> Vec<Cell> {
        let mut reached = std::vec![from];
        let mut next = 0;
        while let Some(&cell) = reached.get(next) {
            for beside in Direction::ALL.map(|side| cell.step(side)) {
                if self.has_room(beside) && !reached.contains(&beside) {
                    reached.push(beside);
                }
            }
            next += 1;
        }
        reached
    }
}

fn place() -> impl Strategy<Value = Place> {
    let sizes = (
        5u16..=24,
        5u16..=24,
        1u8..=3,
        0u8..8,
        1u32..100_000,
        any::<bool>(),
    );
    sizes.prop_flat_map(|(width, height, clearance, more, slice, sees_robots)| {
        let (width, height) = (
            width.max(2 * u16::from(clearance) + 1),
            height.max(2 * u16::from(clearance) + 1),
        );
        let middle = Cell::new(width as i16 / 2, height as i16 / 2);
        let cell = move || (0..width as i16, 0..height as i16).prop_map(|(x, y)| Cell::new(x, y));
        let most = usize::from(width) * usize::from(height) / 12;
        let walls = prop::collection::vec(cell(), 0..=most);
        let starts = prop::collection::vec(cell(), 0..=2);
        let kept_out = prop_oneof![Just(0), 0..=most];
        let kept_out = kept_out.prop_flat_map(move |most| prop::collection::vec(cell(), 0..=most));
        (walls, starts, kept_out).prop_map(move |(walls, wished, kept_out)| {
            let mut place = Place {
                extent: Extent::new(width, height),
                walls,
                starts: Vec::new(),
                kept_out,
                clearance,
                radius: clearance + 2 + more,
                slice: slice.max(400),
                sees_robots,
            };
            // There is room in the middle, if it is not taken.
            let wished = wished.into_iter().chain([middle]);
            for start in wished {
                // Room is made, and who has none does not take part.
                let room: Vec<_> = body_cells(clearance, start).collect();
                let is_inside = room.iter().all(|cell| place.extent.contains(*cell));
                let is_apart = |other: &Cell| !bodies_touch(clearance, start, *other);
                if is_inside && place.starts.iter().all(is_apart) {
                    place.walls.retain(|cell| !room.contains(cell));
                    place.kept_out.retain(|cell| !room.contains(cell));
                    place.starts.push(start);
                }
            }
            place
        })
    })
}

/// Runs until all have stopped; why each did. No body ever touches a wall or another body.
fn run(place: &Place) -> Result<(Vec<Small>, Vec<Stop>), TestCaseError> {
    let config = Config {
        clearance: place.clearance,
        sensor: SensorModel {
            sees_robots: place.sees_robots,
            ..SensorModel::truthful()
        },
        slice: place.slice,
        ..Config::new()
    };
    let mut at = place.starts.clone();
    let new = |(&start, id)| Small::new(config, RobotId(id), place.extent, start).unwrap();
    let mut robots: Vec<_> = at.iter().zip(0u8..).map(new).collect();
    for robot in &mut robots {
        robot.keep_out(Some(kept(&place.kept_out))).unwrap();
    }
    let all = TileSet::full();
    for _ in 0..60_000 {
        for (i, robot) in robots.iter_mut().enumerate() {
            let others = (0..at.len()).filter(|&j| place.sees_robots && j != i);
            let bodies = others.flat_map(|j| body_cells(place.clearance, at[j]));
            let bodies: Vec<_> = bodies.collect();
            let is_blocked = |cell| place.is_blocked(cell) || bodies.contains(&cell);
            robot.observe(&look(at[i], place.radius, is_blocked));
        }
        let told: Vec<_> = robots
            .iter()
            .map(|of| (of.map().clone(), of.status()))
            .collect();
        for (robot, i) in robots.iter_mut().zip(0..) {
            for ((map, status), j) in told.iter().zip(0u8..) {
                if i != j {
                    robot.join(map, &all);
                    robot.hear(RobotId(j), *status);
                }
            }
        }
        let mut stops = Vec::new();
        for i in 0..robots.len() {
            match robots[i].tick() {
                Action::Move(step) => {
                    let to = at[i].step(step);
                    prop_assert!(place.has_room(to), "{} touches something at {}", i, to);
                    let touched =
                        (0..at.len()).find(|&j| j != i && bodies_touch(place.clearance, to, at[j]));
                    prop_assert_eq!(touched, None, "{} at {}", i, to);
                    prop_assert!(robots[i].work <= config.work_bound());
                    at[i] = to;
                    robots[i].report(Motion::Moved);
                }
                Action::Wait => prop_assert_ne!(robots[i].waiting(), Some(Wait::Pose)),
                Action::Stop(stop) => stops.push(stop),
            }
        }
        if stops.len() == robots.len() {
            return Ok((robots, stops));
        }
    }
    Err(TestCaseError::fail(std::format!(
        "still running at {at:?}: {:?}\n{:?}",
        robots.iter().map(|of| of.waiting()).collect::<Vec<_>>(),
        robots.first().map(|of| of.map().clone()),
    )))
}

proptest! {
    #[test]
    fn bodies_touch_nothing_and_sweep_all_that_they_can(place in place()) {
        let (robots, stops) = run(&place)?;
        for ((robot, stop), &start) in robots.iter().zip(stops).zip(&place.starts) {
            if !stop.is_complete() {
                // Only another body may be in the way, which it names.
                prop_assert!(matches!(stop, Stop::Held { .. }), "{}", stop);
                let at = stop.place();
                // Where one stood when it refused; it may have gone on since.
                prop_assert!(place.starts.len() > 1);
                let stood = |other: &Small| at.is_some_and(|at| other.map().is_visited(*at));
                prop_assert!(robots.iter().any(stood), "{} names nobody", stop);
                continue;
            }
            for cell in place.reachable(start) {
                let swept = body_cells(place.clearance, cell).all(|cell| robot.map().is_free(cell));
                prop_assert!(swept, "{} of {}: {}\n{:?}", cell, robot.id.0, stop, robot.map());
                for beside in Direction::ALL.map(|side| cell.step(side)) {
                    prop_assert_ne!(robot.around.fit(beside), Fit::Doubtful, "{}", beside);
                }
            }
        }
    }
}

/// A hall, and a gap in its wall that is two cells wide, before a niche of 2×3 cells.
#[test]
fn what_is_too_narrow_is_seen_and_counted() {
    let is_wall = |x: i16, y: i16| x >= 9 && !(4..=5).contains(&y) || x >= 12;
    let extent = Extent::new(16, 10);
    let cells = (0..10).flat_map(|y| (0..16).map(move |x| Cell::new(x, y)));
    let place = Place {
        extent,
        walls: cells.filter(|cell| is_wall(cell.x, cell.y)).collect(),
        starts: std::vec![Cell::new(4, 4)],
        kept_out: Vec::new(),
        clearance: 1,
        radius: 9,
        slice: 240_000,
        sees_robots: false,
    };
    let (robots, stops) = run(&place).unwrap();
    assert_eq!(robots[0].count_narrow_cells(), 6);
    assert!(stops[0].is_complete());
    assert!((9..12).all(|x| robots[0].map().is_free(Cell::new(x, 4))));
    assert!(!robots[0].map().is_visited(Cell::new(9, 4)));
}
