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
use crate::playback::{Playback, Verdict};
use crate::setup::Setup;
use crate::survey::{SurveyScene, SurveySetup};
use crate::view::{Camera, Deed, Tool, View};
use crate::watch::Watch;

/// Time for ticks in a frame, in seconds: the rest of it is for drawing.
const FRAME_BUDGET: f64 = 0.012;
/// A frame after which time is not made up for, in seconds.
const LONGEST_FRAME: f32 = 0.25;
/// What a newcomer is told.
const WELCOME: &str = "Click a robot to see what it knows and why it goes where it goes; \
                       Space pauses, and Examples has more to start from.";
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
    /// The tick to run to without showing the ones before.
    target: Option<u32>,
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
            target: None,
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
        let mut app = Self::new(Setup::default());
        if !address.trim_start_matches('#').is_empty() {
            app.load(address);
        }
        app
    }

    /// The lab as a newcomer finds it, with the scenario of an address if there is one.
    pub fn welcome(address: &str) -> Self {
        let mut app = Self::from_address(address);
        if address.trim_start_matches('#').is_empty() {
            app.say(Ok(WELCOME.into()));
        }
        app
    }

    /// Runs the scenario of an address; a wrong one changes nothing but the notice.
    pub fn load(&mut self, address: &str) {
        if SurveySetup::is_meant(address) {
            return match SurveySetup::from_address(address) {
                Ok(setup) => self.fly(setup),
                Err(error) => self.fail(error),
            };
        }
        self.rival = None;
        match Setup::from_address(address) {
            Ok(setup) => self.playing |= self.set(setup),
            Err(error) => self.fail(error),
        }
    }

    /// The part of an address behind `#` that shows what is looked at.
    pub fn address(&self) -> String {
        match &self.survey {
            Some(survey) => survey.setup.address(),
            None => self.setup.address(),
        }
    }

    /// Starts a survey; one that cannot be flown changes nothing but the notice.
    pub fn fly(&mut self, setup: SurveySetup) {
        self.fly_to(setup, None);
    }

    /// As [`fly`](Self::fly), and goes on from a step.
    fn fly_to(&mut self, setup: SurveySetup, step: Option<u32>) {
        match SurveyScene::new(setup) {
            Ok(mut scene) => {
                if let Some(old) = &self.survey {
                    scene.look_as(old);
                }
                self.watch(scene);
                self.target = step;
            }
            Err(error) => self.fail(error),
        }
    }

    fn watch(&mut self, scene: SurveyScene) {
        let drones = usize::from(scene.setup.robots);
        self.selected = self.selected.filter(|&drone| drone < drones);
        self.survey = Some(scene);
        self.playing = true;
        self.notice = None;
        self.target = None;
        self.due = 0.0;
    }

    /// Shows the explorations on the grid again.
    pub fn land(&mut self) {
        self.survey = None;
        self.target = None;
        self.selected = None;
    }

    /// What is played: a survey, or one or two runs on a grid in step.
    pub fn players(&self) -> Vec<&dyn Playback> {
        match &self.survey {
            Some(survey) => vec![survey],
            None => self.runs.iter().map(|run| &run.watch as _).collect(),
        }
    }

    fn players_mut(&mut self) -> Vec<&mut dyn Playback> {
        match &mut self.survey {
            Some(survey) => vec![survey],
            None => self
                .runs
                .iter_mut()
                .map(|run| &mut run.watch as _)
                .collect(),
        }
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
                Ok(watch) => runs.push(self.shown(setup, watch)),
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
        self.target = tick;
        self.due = 0.0;
        true
    }

    fn shown(&mut self, setup: Setup, watch: Watch) -> Shown {
        self.next_run += 1;
        Shown {
            id: self.next_run,
            setup,
            watch,
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
        self.runs = vec![self.shown(setup.clone(), watch)];
        self.setup = setup;
        self.rival = None;
        self.land();
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
        while let Some(target) = self.target {
            if self.shown_tick() >= target || !self.tick() {
                self.target = None;
            } else if !has_time() {
                break;
            }
        }
        if self.playing && self.target.is_none() {
            self.due += self.speed * seconds.min(LONGEST_FRAME);
            while self.due >= 1.0 {
                self.due -= 1.0;
                if !self.tick() {
                    self.due = 0.0;
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

    /// One tick of all that is played; false if there is none any more.
    pub fn tick(&mut self) -> bool {
        let (mut went_on, shown) = (false, self.shown_tick());
        for player in self.players_mut() {
            if player.shown() <= shown {
                went_on |= player.tick();
            }
        }
        went_on
    }

    /// The latest tick that is shown.
    pub fn shown_tick(&self) -> u32 {
        let shown = self.players().into_iter().map(|player| player.shown());
        shown.max().unwrap_or(0)
    }

    /// The last tick that was done.
    pub fn last_tick(&self) -> u32 {
        let ticks = self.players().into_iter().map(|player| player.ticks());
        ticks.max().unwrap_or(0)
    }

    /// Shows the state after so many ticks.
    pub fn show(&mut self, tick: u32) {
        for player in self.players_mut() {
            player.show(tick);
        }
    }

    /// Plays or pauses; at the end, plays from the start.
    pub fn play_or_pause(&mut self) {
        self.playing = !self.playing;
        let is_over = |player: &dyn Playback| player.verdict() != Verdict::Running;
        let is_over = self.players().into_iter().all(is_over);
        if self.playing && is_over && self.shown_tick() == self.last_tick() {
            self.show(0);
        }
    }

    /// Begins anew, or shows a trace that was opened from its start.
    pub fn restart(&mut self) {
        match self.players().into_iter().any(|player| player.is_replay()) {
            true => self.show(0),
            false => self.run_again(),
        }
        self.playing = true;
    }

    /// Runs what is set, from its first tick.
    pub fn run_again(&mut self) {
        match &self.survey {
            Some(survey) => self.fly(survey.setup.clone()),
            None => {
                self.set(self.setup.clone());
            }
        }
    }

    /// Whether something moves without the user.
    pub fn is_busy(&self) -> bool {
        let waits = |run: &Shown| run.watch.state().is_none() && run.watch.differs().is_none();
        let waits = self.survey.is_none() && self.runs.iter().any(waits);
        self.playing || self.target.is_some() || waits
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
        if let Some(survey) = &self.survey {
            let (mut setup, playing) = (survey.setup.clone(), self.playing);
            change(&mut setup.conditions.faults, tick);
            self.fly_to(setup, Some(tick));
            self.playing = playing;
            return self.target.is_some();
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
        let robots = match &self.survey {
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

    /// Reads what the page around the lab should know.
    pub fn report(&self) -> Report {
        let error = self.notice.as_ref().filter(|notice| notice.is_error);
        let error = error.map_or_else(String::new, |notice| notice.text.clone());
        let players = self.players();
        let verdicts: Vec<_> = players.iter().map(|player| player.verdict()).collect();
        let state = match () {
            () if verdicts.contains(&Verdict::Running) => match self.playing {
                true => "running",
                false => "paused",
            },
            () if verdicts.contains(&Verdict::Incomplete) => "incomplete",
            () => "complete",
        };
        let first = players.first();
        Report {
            state,
            digest: first.and_then(|first| first.digest()).unwrap_or_default(),
            ticks: first.map_or(0, |first| first.ticks()),
            map: first.map_or_else(String::new, |first| first.name().into()),
            error,
        }
    }
}

#[cfg(test)]
mod tests;
