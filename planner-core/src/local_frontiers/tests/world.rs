//! A small grid world: walls from text, ideal sensors, ideal sharing every tick.

use std::collections::HashSet;
use std::vec::Vec;

use crate::local_frontiers::{Config, LocalFrontiers};
use crate::sight::look;
use crate::{Action, Cell, Contact, Direction, Extent, Inspect, Motion, Planner, RobotId, Stop};

pub(super) type Robot = LocalFrontiers<3, 3>;

#[derive(Clone, Debug)]
pub(super) struct World {
    extent: Extent,
    walls: HashSet<(i16, i16)>,
    pub(super) start: Cell,
}

impl World {
    /// `#` obstacle, `1` start, anything else free.
    pub(super) fn new(rows: &[&str]) -> Self {
        let mut world = Self {
            extent: Extent::new(rows[0].len() as u16, rows.len() as u16),
            walls: HashSet::new(),
            start: Cell::new(0, 0),
        };
        for (row, y) in rows.iter().zip(0..) {
            for (sign, x) in row.chars().zip(0..) {
                match sign {
                    '#' => drop(world.walls.insert((x, y))),
                    '1' => world.start = Cell::new(x, y),
                    _ => {}
                }
            }
        }
        world
    }

    /// Every cell an obstacle for which `wall` says so, but for the start.
    pub(super) fn from_fn(extent: Extent, start: Cell, wall: impl Fn(usize) -> bool) -> Self {
        let cells = (0..extent.cells() as usize).map(|i| {
            let width = usize::from(extent.width);
            (i, Cell::new((i % width) as i16, (i / width) as i16))
        });
        let walls = cells.filter(|&(i, cell)| cell != start && wall(i));
        Self {
            extent,
            walls: walls.map(|(_, cell)| (cell.x, cell.y)).collect(),
            start,
        }
    }

    pub(super) fn is_wall(&self, cell: Cell) -> bool {
        !self.extent.contains(cell) || self.walls.contains(&(cell.x, cell.y))
    }

    pub(super) fn robot(&self, config: Config, id: u8) -> Robot {
        Robot::new(config, RobotId(id), self.extent, self.start).unwrap()
    }

    /// The cells that can be reached from the start.
    pub(super) fn reachable(&self) -> Vec<Cell> {
        let mut cells = std::vec![self.start];
        let mut next = 0;
        while let Some(&cell) = cells.get(next) {
            next += 1;
            for direction in Direction::ALL {
                let neighbour = cell.step(direction);
                if !self.is_wall(neighbour) && !cells.contains(&neighbour) {
                    cells.push(neighbour);
                }
            }
        }
        cells
    }
}

/// Robots in a world.
#[derive(Clone)]
pub(super) struct Fleet<'a> {
    world: &'a World,
    radius: u8,
    pub(super) robots: Vec<Robot>,
    /// Cells that no robot can enter for now.
    pub(super) barred: Vec<Cell>,
    /// The most work that a tick took so far.
    pub(super) work: u32,
}

impl<'a> Fleet<'a> {
    /// `count` robots on the start.
    pub(super) fn new(world: &'a World, radius: u8, config: Config, count: u8) -> Self {
        Self {
            world,
            radius,
            robots: (0..count).map(|id| world.robot(config, id)).collect(),
            barred: Vec::new(),
            work: 0,
        }
    }

    /// One tick of every robot: all look, all share, all decide, all move.
    pub(super) fn tick(&mut self) -> Vec<Action> {
        for robot in &mut self.robots {
            let sighting = look(robot.position, self.radius, |cell| self.world.is_wall(cell));
            robot.observe(&sighting);
        }
        self.share();
        let mut actions = Vec::new();
        for robot in &mut self.robots {
            let action = robot.tick();
            self.work = self.work.max(robot.work());
            if let Action::Move(direction) = action {
                let next = robot.position.step(direction);
                assert!(!self.world.is_wall(next), "a step into the wall at {next}");
                let barred = self.barred.contains(&next);
                robot.report(if barred {
                    Motion::Blocked
                } else {
                    Motion::Moved
                });
            }
            actions.push(action);
        }
        actions
    }

    fn share(&mut self) {
        let changed: Vec<_> = self.robots.iter_mut().map(Contact::take_changed).collect();
        let told = self.robots.clone();
        for robot in &mut self.robots {
            for (sender, tiles) in told.iter().zip(&changed) {
                if sender.id() != robot.id() {
                    robot.join(sender.map(), tiles);
                    robot.hear(sender.id(), sender.status());
                }
            }
        }
        // What came from others is no news to them: sharing is complete.
        for robot in &mut self.robots {
            robot.take_changed();
        }
    }

    /// Ticks until every robot has stopped, at most `ticks` times.
    pub(super) fn run(&mut self, ticks: u32) -> Option<Vec<Stop>> {
        (0..ticks).find_map(|_| {
            let stops = self.tick().into_iter().map(|action| match action {
                Action::Stop(stop) => Some(stop),
                _ => None,
            });
            stops.collect()
        })
    }

    /// Reachable cells that nobody has seen.
    pub(super) fn unseen(&self) -> Vec<Cell> {
        let mut cells = self.world.reachable();
        cells.retain(|&cell| !self.robots.iter().any(|robot| robot.map().is_known(cell)));
        cells
    }

    /// Whether the fleet comes back to a state that it was in before: from then
    /// on, being deterministic, it repeats itself for ever. The hare and the
    /// tortoise. `None`: it stops within `ticks`.
    pub(super) fn period(&mut self, ticks: u32) -> Option<u32> {
        let mut tortoise = self.robots.clone();
        let (mut age, mut limit) = (0, 1);
        for _ in 0..ticks {
            let stopped = self
                .tick()
                .iter()
                .all(|action| matches!(action, Action::Stop(_)));
            if stopped {
                return None;
            }
            age += 1;
            if self.robots == tortoise {
                return Some(age);
            }
            if age == limit {
                (tortoise, age, limit) = (self.robots.clone(), 0, 2 * limit);
            }
        }
        panic!("neither stopped nor repeated within {ticks} ticks");
    }
}
