//! Robots in a world, and the tick that moves them all.

use std::sync::Arc;

use planner_core::explorer::exchange;
use planner_core::{Action, Cell, Motion, Planner, RobotId, TileSet};

use crate::medium::Medium;
use crate::sensor::Sensor;

/// A robot: a planner and the body that it moves.
pub struct Robot<const TW: usize, const TH: usize> {
    /// Its number, which is also its index in the fleet.
    pub id: RobotId,
    /// What decides.
    pub planner: Box<dyn Planner<TW, TH>>,
    /// Where the body is.
    pub position: Cell,
    /// Whether it still sees, decides, speaks and hears. The body of a dead
    /// robot stays where it is.
    pub alive: bool,
    /// What it did in the last tick; `None` before the first and after death.
    pub step: Option<Step>,
}

/// What one robot did in one tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Step {
    /// Where it stood, looked and decided.
    pub at: Cell,
    /// What it decided.
    pub action: Action,
    /// How a move went; `None` if it did not try to move.
    pub motion: Option<Motion>,
}

/// What goes wrong, and when.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Faults {
    /// Robots that die.
    pub deaths: Vec<Death>,
    /// Cells that nobody can enter for a while, and that no sensor shows.
    pub closures: Vec<Closure>,
}

/// A robot dies before it acts in a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Death {
    /// Which one.
    pub robot: RobotId,
    /// The first tick in which it does nothing.
    pub tick: u32,
}

/// A free cell that cannot be entered in the ticks `from..until`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Closure {
    /// Which cell.
    pub cell: Cell,
    /// First tick.
    pub from: u32,
    /// First tick in which it is open again.
    pub until: u32,
}

/// A planner sent its robot into an obstacle: a bug of the planner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Violation {
    /// When.
    pub tick: u32,
    /// Which robot.
    pub robot: RobotId,
    /// Into which cell.
    pub into: Cell,
}

/// How the robots of a fleet share the world and talk.
#[derive(Clone, Debug, Default)]
pub struct Rules {
    /// Ticks between two exchanges; 0: never.
    pub sync: u32,
    /// Whether a cell holds at most one robot.
    pub solid: bool,
    /// What goes wrong.
    pub faults: Faults,
}

/// All robots of a run, in one world.
pub struct Fleet<const TW: usize, const TH: usize> {
    sensor: Arc<Sensor>,
    medium: Box<dyn Medium<TW, TH>>,
    rules: Rules,
    robots: Vec<Robot<TW, TH>>,
    violations: Vec<Violation>,
    /// Roles that changed bodies in this tick: they have acted.
    exchanged: Vec<RobotId>,
    tick: u32,
}

impl<const TW: usize, const TH: usize> Fleet<TW, TH> {
    /// A fleet of one robot for each planner and start, in this order.
    pub fn new(
        sensor: Arc<Sensor>,
        medium: Box<dyn Medium<TW, TH>>,
        rules: Rules,
        planners: impl IntoIterator<Item = (Box<dyn Planner<TW, TH>>, Cell)>,
    ) -> Self {
        let robots = planners
            .into_iter()
            .zip(0..)
            .map(|((planner, start), id)| Robot {
                id: RobotId(id),
                planner,
                position: start,
                alive: true,
                step: None,
            })
            .collect();
        Self {
            sensor,
            medium,
            rules,
            robots,
            violations: Vec::new(),
            exchanged: Vec::new(),
            tick: 0,
        }
    }

    /// The robots, by id.
    pub fn robots(&self) -> &[Robot<TW, TH>] {
        &self.robots
    }

    /// Number of ticks done.
    pub fn ticks(&self) -> u32 {
        self.tick
    }

    /// Moves into obstacles so far. Anything but none is a bug of a planner.
    pub fn violations(&self) -> &[Violation] {
        &self.violations
    }

    /// Whether every living robot has stopped.
    pub fn has_stopped(&self) -> bool {
        self.robots.iter().all(|robot| {
            !robot.alive
                || robot
                    .step
                    .is_some_and(|step| matches!(step.action, Action::Stop(_)))
        })
    }

    /// One tick: all look, then all talk if it is time, then one after another
    /// decides and moves.
    pub fn tick(&mut self) {
        for death in &self.rules.faults.deaths {
            if death.tick == self.tick
                && let Some(robot) = self.robots.get_mut(usize::from(death.robot.0))
            {
                robot.alive = false;
                robot.step = None;
            }
        }
        for robot in self.robots.iter_mut().filter(|robot| robot.alive) {
            robot
                .planner
                .observe(&self.sensor.view(robot.position).sighting);
        }
        if self.rules.sync != 0 && self.tick.is_multiple_of(self.rules.sync) {
            self.medium.exchange(&mut self.robots);
        }
        self.exchanged.clear();
        for index in 0..self.robots.len() {
            if self.robots[index].alive {
                self.act(index);
            }
        }
        self.tick += 1;
    }

    fn act(&mut self, index: usize) {
        let robot = &mut self.robots[index];
        let at = robot.position;
        let role = robot.planner.role();
        let has_acted = role.is_some_and(|role| self.exchanged.contains(&role.rank()));
        let action = if has_acted {
            Action::Wait
        } else {
            robot.planner.tick()
        };
        let mut step = Step {
            at,
            action,
            motion: None,
        };
        if let Action::Move(direction) = action {
            let to = at.step(direction);
            let motion = self.motion(index, to);
            let robot = &mut self.robots[index];
            if motion == Motion::Moved {
                robot.position = to;
            }
            robot.planner.report(motion);
            step.motion = Some(motion);
        }
        self.robots[index].step = Some(step);
    }

    /// How the step of a robot into the neighbouring cell `to` goes.
    fn motion(&mut self, index: usize, to: Cell) -> Motion {
        if !self.sensor.world().is_free(to) {
            self.violations.push(Violation {
                tick: self.tick,
                robot: self.robots[index].id,
                into: to,
            });
            return Motion::Blocked;
        }
        let closed = self.rules.faults.closures.iter().any(|closure| {
            closure.cell == to && (closure.from..closure.until).contains(&self.tick)
        });
        if closed {
            return Motion::Blocked;
        }
        if self.rules.solid
            && let Some(holder) = self.robots.iter().position(|robot| robot.position == to)
        {
            return self.meet(index, holder);
        }
        Motion::Moved
    }

    /// A robot wants the cell that another one holds: they exchange roles, or it
    /// waits. Both bodies stay where they are.
    fn meet(&mut self, index: usize, holder: usize) -> Motion {
        let Ok([robot, other]) = self.robots.get_disjoint_mut([index, holder]) else {
            return Motion::Blocked;
        };
        let (true, Some(mine), Some(theirs)) =
            (other.alive, robot.planner.role(), other.planner.role())
        else {
            return Motion::Blocked;
        };
        if self.exchanged.contains(&theirs.rank()) {
            return Motion::Held;
        }
        let Some((here, there)) = exchange(&mine, robot.position, &theirs, other.position) else {
            return Motion::Held;
        };
        let everything = TileSet::full();
        robot.planner.join(other.planner.map(), &everything);
        other.planner.join(robot.planner.map(), &everything);
        robot.planner.adopt(here);
        other.planner.adopt(there);
        self.exchanged.extend([mine.rank(), theirs.rank()]);
        Motion::Held
    }
}
