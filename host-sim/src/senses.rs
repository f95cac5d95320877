//! What the robots of a run are shown, tick by tick: by which way each is turned, and by
//! what fails.

use std::borrow::Cow;
use std::sync::Arc;

use planner_core::{Cell, Direction, Sighting};

use crate::scenario::Faults;
use crate::scenario::grid::Scenario;
use crate::sensor::{Sensor, View, only};

/// Where the pose of a robot lies that has lost it: one column off the grid.
const ASTRAY: i16 = -1;

/// The senses of all robots of a run. Whoever follows a run by its deeds or by its
/// trace, and turns robots as they turned, sees what they saw.
#[derive(Debug)]
pub struct Senses {
    sensor: Arc<Sensor>,
    faults: Faults,
    headings: Vec<Direction>,
}

impl Senses {
    /// Of so many robots, which all begin turned to the east.
    pub fn new(sensor: Arc<Sensor>, faults: &Faults, robots: usize) -> Self {
        Self {
            sensor,
            faults: faults.clone(),
            headings: vec![Direction::East; robots],
        }
    }

    /// Of the robots of a scenario; `sensor` is the scenario's.
    pub fn of(scenario: &Scenario, sensor: Arc<Sensor>) -> Self {
        Self::new(sensor, &scenario.conditions.faults, scenario.starts.len())
    }

    /// The sensor that all robots carry.
    pub fn sensor(&self) -> &Arc<Sensor> {
        &self.sensor
    }

    /// Which way a robot is turned.
    pub fn heading(&self, robot: usize) -> Direction {
        self.headings.get(robot).copied().unwrap_or(Direction::East)
    }

    /// A robot turns.
    pub fn turn(&mut self, robot: usize, to: Direction) {
        if let Some(heading) = self.headings.get_mut(robot) {
            *heading = to;
        }
    }

    /// Whether what is seen from a cell never changes.
    pub(crate) fn is_steady(&self) -> bool {
        let Faults {
            blind,
            sensor_failures,
            lost_poses,
            ..
        } = &self.faults;
        blind.is_empty() && sensor_failures.is_empty() && lost_poses.is_empty()
    }

    /// Whether a robot knows where it is.
    pub fn has_pose(&self, tick: u32, robot: usize) -> bool {
        !self
            .faults
            .lost_poses
            .iter()
            .any(|of| of.holds(robot, tick))
    }

    /// What a robot at `at` learns by a look; `None` if it does not know where it is.
    ///
    /// # Panics
    /// If the cell lies outside of the world.
    pub fn view(&self, tick: u32, robot: usize, at: Cell) -> Option<Cow<'_, View>> {
        self.has_pose(tick, robot)
            .then(|| self.shown(tick, robot, at))
    }

    /// What the sensor of a robot at `at` tells its planner: around a pose that lies
    /// off the grid if the robot has lost its own.
    ///
    /// # Panics
    /// If the cell lies outside of the world.
    pub fn sighting(&self, tick: u32, robot: usize, at: Cell) -> Cow<'_, Sighting> {
        let shown = self.shown(tick, robot, at);
        if !self.has_pose(tick, robot) {
            return Cow::Owned(astray(&shown.sighting));
        }
        match shown {
            Cow::Borrowed(view) => Cow::Borrowed(&view.sighting),
            Cow::Owned(view) => Cow::Owned(view.sighting),
        }
    }

    fn shown(&self, tick: u32, robot: usize, at: Cell) -> Cow<'_, View> {
        let (sensor, faults) = (&self.sensor, &self.faults);
        let view = sensor.view(at, self.heading(robot));
        let fails = |robot_fails: u8, since| usize::from(robot_fails) == robot && since <= tick;
        let fell_silent = faults
            .sensor_failures
            .iter()
            .any(|of| fails(of.robot.0, of.tick));
        let is_blind = |cell: Cell| faults.blind.iter().any(|of| of.holds(cell, tick));
        if fell_silent {
            Cow::Owned(View::new(sensor.world(), Sighting::new(at)))
        } else if faults.blind.is_empty() {
            Cow::Borrowed(view)
        } else {
            let shown = only(&view.sighting, |cell| !is_blind(cell));
            Cow::Owned(View::new(sensor.world(), shown))
        }
    }
}

/// The same look, around a pose off the grid.
fn astray(sighting: &Sighting) -> Sighting {
    let Cell { x, y } = sighting.centre();
    let moved = |cell: Cell| Cell::new(cell.x - x + ASTRAY, cell.y);
    let mut shown = Sighting::new(Cell::new(ASTRAY, y));
    sighting
        .free_cells()
        .for_each(|cell| shown.see_free(moved(cell)));
    sighting
        .blocked_cells()
        .for_each(|cell| shown.see_blocked(moved(cell)));
    shown
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
        let senses = Senses::new(sensor, &faults, 2);
        for tick in 0..10 {
            for robot in 0..2 {
                let told = senses.sighting(tick, robot, at);
                let view = senses.view(tick, robot, at);
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
