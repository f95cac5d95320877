//! The tick of bodies that move in metres: one after another decides and steers, then all go
//! on at once.

use planner_core::{Action, Cell, Direction, Motion, Wait};

use super::{Fleet, Meeting};
use crate::motion::{Aim, Drivers, Steered};
use crate::robot::{Deed, Step};

/// What a robot is about.
#[derive(Clone, Copy)]
struct Doing {
    at: Cell,
    work: u32,
    /// What comes of the tick if the body does not get into another cell.
    deed: Deed,
    /// The cell that the planner has asked for.
    next: Option<Cell>,
    /// What kept it from going there.
    report: Option<Motion>,
}

impl<const TW: usize, const TH: usize> Fleet<TW, TH> {
    pub(super) fn drive(&mut self, drivers: &mut Drivers) {
        let robots = 0..self.robots.len();
        let doing: Vec<Option<Doing>> = robots.map(|index| self.decide(index, drivers)).collect();
        let world = self.senses.sensor().world().clone();
        drivers.drive(self.tick, |cell| world.is_free(cell));
        for (index, doing) in doing.into_iter().enumerate() {
            let after = drivers.cell(index);
            let robot = &mut self.robots[index];
            let way = robot.position.direction_to(after);
            robot.position = after;
            let Some(doing) = doing else { continue };
            let has_arrived = doing.next == Some(drivers.believed_cell(index));
            match doing.report {
                _ if has_arrived => robot.planner.report(Motion::Moved),
                Some(motion) => robot.planner.report(motion),
                None => {}
            }
            let deed = way.map_or(doing.deed, Deed::Moved);
            self.senses.follow(index, deed.turns_to(), after);
            self.robots[index].step = Some(Step {
                at: doing.at,
                deed,
                work: doing.work,
                sent: self.robots[index].sent,
            });
        }
    }

    /// One robot decides, and its driver steers. `None`: it is dead.
    fn decide(&mut self, index: usize, drivers: &mut Drivers) -> Option<Doing> {
        let robot = &mut self.robots[index];
        if !robot.alive {
            drivers.stop(index);
            return None;
        }
        let mut doing = Doing {
            at: robot.position,
            work: 0,
            deed: Deed::Yielded,
            next: None,
            report: None,
        };
        if robot.has_exchanged {
            drivers.stop(index);
            return Some(doing);
        }
        // A planner decides when its last step is done, as in unit steps.
        let action = match drivers.order(index) {
            Some(step) => Action::Move(step),
            None => {
                let action = robot.planner.tick();
                doing.work = robot.planner.work();
                action
            }
        };
        let here = drivers.believed_cell(index);
        let aim = match action {
            Action::Move(to) => Aim::Go {
                next: here.step(to),
                waypoint: robot.planner.waypoint(),
            },
            Action::Wait | Action::Stop(_) => Aim::Stay,
        };
        let steered = drivers.steer(index, aim, |cell| robot.planner.map().is_free(cell));
        doing.deed = match action {
            Action::Stop(stop) => Deed::Stopped(stop),
            Action::Wait => match robot.planner.waiting() {
                Some(Wait::Look(to)) => Deed::Looked(to),
                _ => Deed::Waited,
            },
            Action::Move(to) => {
                doing.next = Some(here.step(to));
                let (deed, report) = match steered {
                    Steered::Held(ticks) => self.hold(index, to, ticks),
                    _ if drivers.gives_up(index) => (Deed::Blocked(to), Some(Motion::Blocked)),
                    Steered::Going | Steered::Elsewhere => (Deed::Driving, None),
                };
                doing.report = report;
                deed
            }
        };
        Some(doing)
    }

    /// Another body is in the way: roles may pass through each other, or the planner is told.
    /// One that knows no roles is told after the time of a step, as of any obstacle.
    fn hold(&mut self, index: usize, to: Direction, ticks: u32) -> (Deed, Option<Motion>) {
        let cell = self.robots[index].position.step(to);
        if self.rules.clearance == 0
            && let Some(holder) = self.holder(cell)
            && let Meeting::Exchanged = self.exchange_roles(index, holder)
        {
            return (Deed::Exchanged(to), None);
        }
        let step = self.rules.motion.map_or(0, |motion| motion.ticks_a_step());
        match self.robots[index].planner.role() {
            None if ticks < step => (Deed::Held(to), None),
            None => (Deed::Blocked(to), Some(Motion::Blocked)),
            Some(_) => (Deed::Held(to), Some(Motion::Held)),
        }
    }
}
