//! What the pointer does to a world, and what befalls robots on their way.

use host_sim::scenario::{CellSpan, Event, Faults};
use host_sim::world::Starts;
use planner_core::{Cell, RobotId};

use super::App;
use crate::maps;
use crate::setup::Setup;
use crate::view::{Deed, Tool};

impl App {
    /// Does what the pointer did in a view.
    pub fn apply(&mut self, deed: Deed) {
        match deed {
            Deed::Selected(robot) => self.selected = robot,
            Deed::Painted(cell) => self.paint(cell),
            Deed::Placed(cell) => self.place(cell),
            Deed::Dragged(robot, cell) => {
                let mut starts = self.starts();
                if let Some(start) = starts.get_mut(robot) {
                    *start = cell;
                }
                self.set(Setup {
                    starts: Some(Starts::At(starts)),
                    ..self.setup.clone()
                });
            }
            Deed::Killed(robot) => self.kill(robot),
            Deed::Shut(cell) => self.shut(cell),
        }
    }

    pub(super) fn starts(&self) -> Vec<Cell> {
        let run = self.runs.first();
        run.map(|run| run.watch.scenario().starts.clone())
            .unwrap_or_default()
    }

    /// Draws or erases a cell of wall; the runs begin anew.
    fn paint(&mut self, cell: Cell) {
        let Some(run) = self.runs.first() else { return };
        let (world, blocked) = (run.watch.scenario().world.clone(), self.tool == Tool::Wall);
        if world.is_free(cell) != blocked {
            return;
        }
        let starts = self.starts();
        if blocked && starts.contains(&cell) {
            self.fail(format!("a robot starts at {cell}; move it first"));
        } else if let Some(world) = maps::with_cell(&world, cell, blocked) {
            let (camera, setup) = (self.camera, self.setup.with_world(world));
            self.set(Setup {
                starts: Some(Starts::At(starts)),
                ..setup
            });
            self.camera = camera;
        }
    }

    /// Adds a robot: before the first tick at its start, else from the shown tick on.
    fn place(&mut self, cell: Cell) {
        let tick = self.shown_tick();
        let Some(robots) = self.setup.robots.checked_add(1) else {
            return self.fail("there are 255 robots already, the most that there can be".into());
        };
        let mut starts = self.starts();
        starts.push(cell);
        let mut setup = Setup {
            robots,
            starts: Some(Starts::At(starts)),
            ..self.setup.clone()
        };
        if tick > 0 {
            let robot = RobotId(robots - 1);
            setup.conditions.faults.arrivals.push(Event { robot, tick });
        }
        self.set_at(setup, (tick > 0).then_some(tick));
    }

    /// From the shown tick on, the robot is dead.
    pub fn kill(&mut self, robot: usize) {
        let Ok(id) = u8::try_from(robot) else { return };
        self.befall(|faults, tick| {
            let deaths = &mut faults.deaths;
            deaths.retain(|death| death.robot.0 != id);
            deaths.push(Event {
                robot: RobotId(id),
                tick,
            });
        });
    }

    /// Changes the faults from the shown tick on, whatever the world is, and goes on from
    /// there; says whether it does.
    fn befall(&mut self, change: impl FnOnce(&mut Faults, u32)) -> bool {
        let tick = self.shown_tick();
        if let Some(survey) = self.survey() {
            let (mut setup, playing) = (survey.setup.clone(), self.playing);
            change(&mut setup.conditions.faults, tick);
            let flies = self.fly_to(setup, Some(tick));
            self.playing = playing;
            return flies;
        }
        let mut setup = self.setup.clone();
        change(&mut setup.conditions.faults, tick);
        self.set_at(setup, Some(tick))
    }

    /// From the shown tick on, the cell is shut; if it is shut, open again.
    fn shut(&mut self, cell: Cell) {
        self.befall(|faults, tick| {
            let spans = &mut faults.shut;
            let holds = |of: &CellSpan| of.cell == cell && (of.from..of.until).contains(&tick);
            match spans.iter().position(holds) {
                Some(index) if spans[index].from == tick => drop(spans.remove(index)),
                Some(index) => spans[index].until = tick,
                None => spans.push(CellSpan {
                    cell,
                    from: tick,
                    until: u32::MAX,
                }),
            }
        });
    }

    /// From the shown tick on, the robot, or every one, goes on after its stop.
    pub fn go_on(&mut self, robot: Option<usize>) {
        let robots = match self.survey() {
            Some(survey) => survey.setup.robots,
            None => self.setup.robots,
        };
        let is_meant = |id: u8| robot.is_none_or(|robot| usize::from(id) == robot);
        let goes_on = self.befall(|faults, tick| {
            let resumes = &mut faults.resumes;
            resumes.retain(|of| of.tick < tick || !is_meant(of.robot.0));
            let meant = (0..robots).filter(|&id| is_meant(id)).map(RobotId);
            resumes.extend(meant.map(|robot| Event { robot, tick }));
        });
        self.playing |= goes_on;
    }
}
