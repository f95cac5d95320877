//! What the robots of a run are shown, tick by tick: by which way each is turned, by what
//! fails, by what stands in the way, and by what errs.

mod bodies;
mod errors;

use std::borrow::Cow;
use std::sync::Arc;

use planner_core::{Cell, Direction, Sighting, sight};

use crate::scenario::grid::Scenario;
use crate::scenario::{Conditions, Faults, Trouble};
use crate::sensor::{FarTile, Sensor, View};

use bodies::Bodies;
use errors::Errors;
pub use errors::Look;
pub(crate) use errors::laid;

/// Where the pose of a robot lies that has lost it: one column off the grid.
const ASTRAY: i16 = -1;

/// The senses of all robots of a run. Whoever follows a run by its deeds or by its trace
/// sees what they saw: [`begin`](Self::begin) each tick, then [`follow`](Self::follow)
/// each robot.
#[derive(Debug)]
pub struct Senses {
    sensor: Arc<Sensor>,
    faults: Faults,
    headings: Vec<Direction>,
    bodies: Bodies,
    errors: Errors,
    tick: u32,
}

impl Senses {
    /// Of the robots of a scenario, which all begin turned to the east; `sensor` is the
    /// scenario's.
    pub fn of(scenario: &Scenario, sensor: Arc<Sensor>) -> Self {
        let Conditions {
            faults,
            trouble,
            seed,
            ..
        } = &scenario.conditions;
        let starts = &scenario.starts;
        Self::new(sensor, faults, *trouble, *seed, starts, scenario.clearance)
    }

    pub(crate) fn new(
        sensor: Arc<Sensor>,
        faults: &Faults,
        trouble: Trouble,
        seed: u64,
        starts: &[Cell],
        clearance: u8,
    ) -> Self {
        let world = sensor.world();
        let extent = world.extent();
        Self {
            bodies: Bodies::new(&trouble, seed, faults, world, starts, clearance),
            errors: Errors::new(trouble, seed, sensor.range(), extent, starts.len()),
            faults: faults.clone(),
            headings: vec![Direction::East; starts.len()],
            sensor,
            tick: 0,
        }
    }

    /// The sensor that all robots carry.
    pub fn sensor(&self) -> &Arc<Sensor> {
        &self.sensor
    }

    /// Which way a robot is turned.
    pub fn heading(&self, robot: usize) -> Direction {
        self.headings.get(robot).copied().unwrap_or(Direction::East)
    }

    /// What goes by itself goes on until `tick`, which is not before the last one begun.
    pub fn begin(&mut self, tick: u32) {
        while self.tick < tick {
            self.tick += 1;
            self.bodies.begin(self.tick, self.sensor.world());
            self.errors.begin(self.tick);
        }
    }

    /// What a robot did: which way it turned, if it did, and where it is after the tick.
    pub fn follow(&mut self, robot: usize, turned: Option<Direction>, after: Cell) {
        if let (Some(to), Some(heading)) = (turned, self.headings.get_mut(robot)) {
            *heading = to;
        }
        self.bodies.follow(robot, after);
    }

    /// Where people are in this tick.
    pub fn people(&self) -> impl Iterator<Item = Cell> + '_ {
        self.bodies.people()
    }

    /// The doors, and whether each is shut in this tick.
    pub fn doors(&self) -> impl Iterator<Item = (Cell, bool)> + '_ {
        self.bodies.doors()
    }

    /// Whether a person or a shut door keeps robots out of a cell in this tick.
    pub(crate) fn is_taken(&self, cell: Cell) -> bool {
        self.bodies.block(cell)
    }

    /// Whether what is seen from a cell never changes.
    pub(crate) fn is_steady(&self) -> bool {
        let Faults {
            blind,
            sensor_failures,
            lost_poses,
            ..
        } = &self.faults;
        let nothing_fails = blind.is_empty() && sensor_failures.is_empty() && lost_poses.is_empty();
        nothing_fails && self.bodies.are_none()
    }

    /// Whether a robot knows where it is, or believes to.
    pub fn has_pose(&self, robot: usize) -> bool {
        !self.faults.is_lost(robot, self.tick)
    }

    /// What is in view of a robot at `at` in this tick, whatever its planner is told of
    /// it; `None` if it does not know where it is.
    ///
    /// # Panics
    /// If the cell lies outside of the world.
    pub fn view(&self, robot: usize, at: Cell) -> Option<Cow<'_, View>> {
        self.has_pose(robot).then(|| self.shown(robot, at))
    }

    /// What the sensor of a robot at `at` tells its planner by the look of this number in
    /// this tick: with errors, and around a pose that lies off the grid if the robot has
    /// lost its own.
    ///
    /// # Panics
    /// If the cell lies outside of the world.
    pub fn sighting(&self, robot: usize, number: u8, at: Cell) -> Cow<'_, Sighting> {
        let seen = match self.shown(robot, at) {
            Cow::Borrowed(view) => Cow::Borrowed(&view.sighting),
            Cow::Owned(view) => Cow::Owned(view.sighting),
        };
        if !self.has_pose(robot) {
            return Cow::Owned(laid(&seen, Cell::new(ASTRAY, at.y)));
        }
        let look = Look {
            tick: self.tick,
            number,
            robot,
        };
        self.errors.told(look, seen)
    }

    /// What the sensor of a robot at `at` tells its planner of what lies beyond a
    /// [`sighting`](Self::sighting), by the first look of this tick.
    ///
    /// # Panics
    /// If the cell lies outside of the world.
    pub fn far(&self, robot: usize, at: Cell) -> Cow<'_, [FarTile]> {
        let reaches_farther = self.sensor.range() > sight::MAX_RADIUS;
        match self.view(robot, at).filter(|_| reaches_farther) {
            None => Cow::Borrowed(&[]),
            Some(Cow::Borrowed(view)) => Cow::Borrowed(&view.far),
            Some(Cow::Owned(view)) => Cow::Owned(view.far.into()),
        }
    }

    fn shown(&self, robot: usize, at: Cell) -> Cow<'_, View> {
        let (sensor, faults) = (&self.sensor, &self.faults);
        if faults.has_failed(robot, self.tick) {
            return Cow::Owned(View::new(sensor.world(), Sighting::new(at)));
        }
        let view = self.seen(robot, at);
        if faults.blind.is_empty() {
            return view;
        }
        Cow::Owned(view.only(sensor.world(), |cell| !faults.is_blind(cell, self.tick)))
    }

    /// The world, and what stands in it.
    fn seen(&self, robot: usize, at: Cell) -> Cow<'_, View> {
        let (sensor, heading) = (&self.sensor, self.heading(robot));
        let range = u32::from(sensor.range());
        let bodies = self.bodies.seen_by(robot);
        let near: Vec<Cell> = bodies
            .filter(|cell| cell.distance_squared(at) <= range * range)
            .collect();
        match near.is_empty() {
            true => Cow::Borrowed(sensor.view(at, heading)),
            false => Cow::Owned(sensor.view_past(at, heading, &near)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use planner_core::{Extent, RobotId};

    use crate::scenario::{CellSpan, Event, RobotSpan};
    use crate::world::World;

    #[test]
    fn senses_fail_when_they_are_to_and_no_longer() {
        let world = World::from_fn("open", Extent::new(9, 9), |_| false).unwrap();
        let sensor = Arc::new(Sensor::new(Arc::new(world), 3));
        let (at, glass) = (Cell::new(4, 4), Cell::new(5, 4));
        let whole = sensor.view(at, Direction::East).sighting.clone();
        let faults = Faults {
            blind: vec![CellSpan {
                cell: glass,
                from: 2,
                until: 4,
            }],
            sensor_failures: vec![Event {
                robot: RobotId(1),
                tick: 6,
            }],
            lost_poses: vec![RobotSpan {
                robot: RobotId(0),
                from: 5,
                until: 7,
            }],
            ..Faults::default()
        };
        let mut senses = Senses::new(sensor, &faults, Trouble::default(), 1, &[at; 2], 0);
        for tick in 0..10 {
            senses.begin(tick);
            for robot in 0..2 {
                let told = senses.sighting(robot, 0, at);
                let view = senses.view(robot, at);
                match (tick, robot) {
                    (2 | 3, _) => {
                        assert!(!told.is_free(glass) && !told.is_blocked(glass));
                        let seen = told.free_cells().count() + told.blocked_cells().count();
                        assert_eq!(seen, whole.free_cells().count() - 1);
                    }
                    (5 | 6, 0) => {
                        assert_eq!(told.centre(), Cell::new(-1, 4));
                        assert_eq!(told.free_cells().count(), whole.free_cells().count());
                        assert!(view.is_none());
                        continue;
                    }
                    (6.., 1) => assert_eq!(*told, Sighting::new(at)),
                    _ => assert_eq!(*told, whole),
                }
                assert_eq!(view.unwrap().sighting, *told);
            }
        }
    }
}
