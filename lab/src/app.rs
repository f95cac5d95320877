//! The lab: what is set, what runs, and what is shown.

use host_sim::planners::PlannerKind;
use host_sim::record::grid::Trace;
use host_sim::scenario::{CellSpan, Conditions, Event, Faults};
use host_sim::world::Starts;
use planner_core::{Cell, RobotId};

use crate::ground::{ALL_TICKS, Layers};
use crate::maps;
use crate::opened::Opened;
use crate::platform::{Inbox, Stopwatch};
use crate::setup::Setup;
use crate::survey::{SurveyScene, SurveySetup};
use crate::view::{Camera, Deed, Tool, View};
use crate::watch::{Verdict, Watch};

/// Time for ticks in a frame, in seconds: the rest of it is for drawing.
const FRAME_BUDGET: f64 = 0.012;
/// A frame after which time is not made up for, in seconds.
const LONGEST_FRAME: f32 = 0.25;
/// Robots from which on ways are drawn only for the last ticks, unless asked for.
const CROWD: u8 = 20;

/// The whole lab.
pub struct App {
    /// What the menus show.
    pub setup: Setup,
    /// The planner of a second run in the same world, beside the first.
    pub rival: Option<PlannerKind>,
    /// One run, or two in step.
    pub runs: Vec<Shown>,
    /// The 3-D survey, if that is what is looked at.
    pub survey: Option<SurveyScene>,
    /// Whether ticks go by.
    pub playing: bool,
    /// Ticks a second.
    pub speed: f32,
    /// What is drawn.
    pub layers: Layers,
    /// What the pointer does.
    pub tool: Tool,
    /// The robot that is looked at.
    pub selected: Option<usize>,
    /// What the user should know.
    pub notice: Option<Notice>,
    pub(crate) camera: Camera,
    pub(crate) inbox: Inbox,
    pub(crate) path: String,
    pub(crate) sheet: Option<crate::panels::Sheet>,
    pub(crate) shows_world: bool,
    due: f32,
    next_run: usize,
}

/// A run on the screen.
pub struct Shown {
    /// Differs from run to run.
    pub id: usize,
    /// What was set for it; differs from the menus by the planner at most.
    pub setup: Setup,
    /// The run.
    pub watch: Watch,
    /// The tick to run to without showing the ones before.
    pub target: Option<u32>,
    pub(crate) views: [View; 2],
}

/// A sentence for the user.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Notice {
    /// The sentence.
    pub text: String,
    /// Whether something went wrong.
    pub is_error: bool,
}

/// The lab's state in a few words, for the page around it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Report {
    /// `running`, `paused`, `complete` or `incomplete`.
    pub state: &'static str,
    /// Of the first run, when it is over.
    pub digest: String,
    /// Of the first run.
    pub ticks: u32,
    /// The name of the map.
    pub map: String,
    /// What went wrong.
    pub error: String,
}

impl App {
    /// The lab with a scenario, playing.
    pub fn new(setup: Setup) -> Self {
        let mut app = Self {
            setup: Setup::default(),
            rival: None,
            runs: Vec::new(),
            survey: None,
            playing: true,
            speed: 60.0,
            layers: Layers::default(),
            tool: Tool::Look,
            selected: None,
            notice: None,
            camera: Camera::default(),
            inbox: Inbox::default(),
            path: String::new(),
            sheet: None,
            shows_world: false,
            due: 0.0,
            next_run: 0,
        };
        app.set(setup);
        if app.runs.is_empty() {
            // What is wrong stays on the screen, over something to look at.
            let notice = app.notice.take();
            app.set(Setup::default());
            app.notice = notice;
        }
        app
    }

    /// The lab with the scenario of an address.
    pub fn from_address(address: &str) -> Self {
        if SurveySetup::is_meant(address) {
            let mut app = Self::new(Setup::default());
            match SurveySetup::from_address(address) {
                Ok(setup) => app.fly(setup),
                Err(error) => app.fail(error),
            }
            return app;
        }
        match Setup::from_address(address) {
            Ok(setup) => Self::new(setup),
            Err(error) => {
                let mut app = Self::new(Setup::default());
                app.fail(error);
                app
            }
        }
    }

    /// The part of an address behind `#` that shows what is looked at.
    pub fn address(&self) -> String {
        match &self.survey {
            Some(survey) => survey.setup.address(),
            None => self.setup.address(),
        }
    }

    /// Starts a survey.
    pub fn fly(&mut self, setup: SurveySetup) {
        match SurveyScene::new(setup) {
            Ok(scene) => self.watch(scene),
            Err(error) => self.fail(error),
        }
    }

    fn watch(&mut self, scene: SurveyScene) {
        self.survey = Some(scene);
        self.playing = true;
        self.notice = None;
    }

    /// Starts over with this setup; one that cannot be run changes nothing but the
    /// notice. Says whether it runs.
    pub fn set(&mut self, setup: Setup) -> bool {
        self.set_at(setup, None)
    }

    /// As [`set`](Self::set), and goes on from a tick.
    fn set_at(&mut self, setup: Setup, tick: Option<u32>) -> bool {
        let of = |planner: Option<PlannerKind>| Setup {
            planner: planner.unwrap_or(setup.planner),
            ..setup.clone()
        };
        let wanted = [Some(of(None)), self.rival.map(|rival| of(Some(rival)))];
        let mut runs = Vec::new();
        for setup in wanted.into_iter().flatten() {
            match setup.scenario().and_then(Watch::new) {
                Ok(watch) => runs.push(self.shown(setup, watch, tick)),
                Err(error) => {
                    self.fail(error);
                    return false;
                }
            }
        }
        if self.setup.map != setup.map {
            self.camera = Camera::default();
        }
        let is_crowd = setup.robots >= CROWD;
        if self.runs.is_empty() || is_crowd != (self.setup.robots >= CROWD) {
            self.layers.trail = if is_crowd { 60 } else { ALL_TICKS };
        }
        let robots = usize::from(setup.robots);
        self.selected = self.selected.filter(|&robot| robot < robots);
        self.setup = setup;
        self.runs = runs;
        self.survey = None;
        self.notice = None;
        self.due = 0.0;
        true
    }

    fn shown(&mut self, setup: Setup, watch: Watch, target: Option<u32>) -> Shown {
        self.next_run += 1;
        Shown {
            id: self.next_run,
            setup,
            watch,
            target,
            views: Default::default(),
        }
    }

    /// Opens a map or a trace.
    pub fn open(&mut self, name: &str, bytes: &[u8]) {
        match Opened::read(name, bytes) {
            Ok(Opened::Map(map)) => {
                let starts = map
                    .world()
                    .map(|world| world.starts().to_vec())
                    .unwrap_or_default();
                self.set(Setup {
                    map,
                    starts: (!starts.is_empty()).then_some(Starts::At(starts)),
                    conditions: Conditions {
                        faults: Faults::default(),
                        ..self.setup.conditions.clone()
                    },
                    ..self.setup.clone()
                });
            }
            Ok(Opened::Exploration(trace)) => self.replay(*trace),
            Ok(Opened::Survey(trace)) => self.watch(SurveyScene::replay(*trace)),
            Ok(Opened::Voxels(trace)) => self.watch(SurveyScene::replay_voxels(*trace)),
            Err(error) => self.fail(error),
        }
    }

    /// Shows a trace that was opened.
    pub fn replay(&mut self, trace: Trace) {
        let in_metres = trace.scenario.motion.is_some();
        let setup = Setup::of(&trace.scenario);
        let watch = Watch::replay(trace);
        self.runs = vec![self.shown(setup.clone(), watch, None)];
        self.setup = setup;
        self.rival = None;
        self.survey = None;
        self.selected = None;
        self.camera = Camera::default();
        self.notice = in_metres.then(|| Notice {
            text: "These robots moved in metres; what is run from here makes a cell a tick.".into(),
            is_error: false,
        });
        self.playing = true;
    }

    /// Says what went wrong.
    pub fn fail(&mut self, text: String) {
        self.notice = Some(Notice {
            text,
            is_error: true,
        });
    }

    /// Says what was done, or what went wrong.
    pub fn say(&mut self, done: Result<String, String>) {
        match done {
            Ok(text) => {
                self.notice = Some(Notice {
                    text,
                    is_error: false,
                })
            }
            Err(text) => self.fail(text),
        }
    }

    /// Takes in files and lets time go by; `seconds` since the last time.
    pub fn advance(&mut self, seconds: f32) {
        while let Some((name, content)) = self.inbox.next() {
            match content {
                Ok(bytes) => self.open(&name, &bytes),
                Err(error) => self.fail(format!("{name}: {error}")),
            }
        }
        let clock = Stopwatch::start();
        let has_time = || clock.seconds() < FRAME_BUDGET;
        let seconds = seconds.min(LONGEST_FRAME);
        if let Some(survey) = &mut self.survey {
            self.playing = self.playing && survey.advance(seconds, self.speed, has_time);
            return;
        }
        let mut waits = false;
        for run in &mut self.runs {
            while let Some(target) = run.target {
                if run.watch.shown() >= target || !run.watch.tick() {
                    run.target = None;
                } else if !has_time() {
                    break;
                }
            }
            waits |= run.target.is_some();
        }
        if self.playing && !waits {
            self.due += self.speed * seconds;
            while self.due >= 1.0 {
                self.due -= 1.0;
                if !self.tick() {
                    self.playing = false;
                    break;
                }
                if !has_time() {
                    // What cannot be shown in time is shown later, not faster.
                    self.due = 0.0;
                }
            }
        }
        for run in &mut self.runs {
            run.watch.catch_up(has_time);
        }
    }

    /// One tick of every run; false if there is none any more.
    pub fn tick(&mut self) -> bool {
        if let Some(survey) = &mut self.survey {
            return survey.step();
        }
        let mut went_on = false;
        let shown = self.shown_tick();
        for run in &mut self.runs {
            if run.watch.shown() <= shown {
                went_on |= run.watch.tick();
            }
        }
        went_on
    }

    /// The latest tick that is shown of any run.
    pub fn shown_tick(&self) -> u32 {
        if let Some(survey) = &self.survey {
            return survey.shown() as u32;
        }
        self.runs
            .iter()
            .map(|run| run.watch.shown())
            .max()
            .unwrap_or(0)
    }

    /// The last tick that any run has done.
    pub fn last_tick(&self) -> u32 {
        if let Some(survey) = &self.survey {
            return survey.steps() as u32;
        }
        self.runs
            .iter()
            .map(|run| run.watch.ticks())
            .max()
            .unwrap_or(0)
    }

    /// Shows the state after so many ticks.
    pub fn show(&mut self, tick: u32) {
        if let Some(survey) = &mut self.survey {
            return survey.show_step(tick as usize);
        }
        for run in &mut self.runs {
            run.watch.show(tick);
        }
    }

    /// Plays or pauses; at the end, plays from the start.
    pub fn play_or_pause(&mut self) {
        self.playing = !self.playing;
        let is_over = match &self.survey {
            Some(survey) => survey.is_over(),
            None => self
                .runs
                .iter()
                .all(|run| run.watch.verdict() != Verdict::Running),
        };
        if self.playing && is_over && self.shown_tick() == self.last_tick() {
            self.show(0);
        }
    }

    /// Whether something moves without the user.
    pub fn is_busy(&self) -> bool {
        let waits = |run: &Shown| {
            run.target.is_some() || run.watch.state().is_none() && run.watch.differs().is_none()
        };
        self.playing || self.survey.is_none() && self.runs.iter().any(waits)
    }

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

    fn starts(&self) -> Vec<Cell> {
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
        let tick = self.shown_tick();
        let Ok(id) = u8::try_from(robot) else { return };
        let mut setup = self.setup.clone();
        let deaths = &mut setup.conditions.faults.deaths;
        deaths.retain(|death| death.robot.0 != id);
        deaths.push(Event {
            robot: RobotId(id),
            tick,
        });
        self.set_at(setup, Some(tick));
    }

    /// From the shown tick on, the cell is shut; if it is shut, open again.
    fn shut(&mut self, cell: Cell) {
        let tick = self.shown_tick();
        let mut setup = self.setup.clone();
        let spans = &mut setup.conditions.faults.shut;
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
        self.set_at(setup, Some(tick));
    }

    /// From the shown tick on, the robot, or every one, goes on after its stop.
    pub fn go_on(&mut self, robot: Option<usize>) {
        let tick = self.shown_tick();
        let mut setup = self.setup.clone();
        let is_meant = |id: u8| robot.is_none_or(|robot| usize::from(id) == robot);
        let resumes = &mut setup.conditions.faults.resumes;
        resumes.retain(|of| of.tick < tick || !is_meant(of.robot.0));
        resumes.extend(
            (0..setup.robots)
                .filter(|&id| is_meant(id))
                .map(|id| Event {
                    robot: RobotId(id),
                    tick,
                }),
        );
        self.playing |= self.set_at(setup, Some(tick));
    }

    /// Reads what the page around the lab should know.
    pub fn report(&self) -> Report {
        let error = self.notice.as_ref().filter(|notice| notice.is_error);
        let error = error.map_or_else(String::new, |notice| notice.text.clone());
        if let Some(survey) = &self.survey {
            return Report {
                state: match (survey.is_over(), survey.is_complete()) {
                    (true, true) => "complete",
                    (true, false) => "incomplete",
                    (false, _) if self.playing => "running",
                    (false, _) => "paused",
                },
                digest: survey.digest().unwrap_or_default().into(),
                ticks: survey.steps() as u32,
                map: survey.name().into(),
                error,
            };
        }
        let first = self.runs.first();
        let verdicts: Vec<_> = self.runs.iter().map(|run| run.watch.verdict()).collect();
        let state = match () {
            () if verdicts.contains(&Verdict::Running) => match self.playing {
                true => "running",
                false => "paused",
            },
            () if verdicts.contains(&Verdict::Incomplete) => "incomplete",
            () => "complete",
        };
        Report {
            state,
            digest: first.and_then(|run| run.watch.digest()).unwrap_or_default(),
            ticks: first.map_or(0, |run| run.watch.ticks()),
            map: first.map_or_else(String::new, |run| run.watch.scenario().world.name().into()),
            error,
        }
    }
}

#[cfg(test)]
mod tests;
