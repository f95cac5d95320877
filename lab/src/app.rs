//! The lab: what is set, what runs, and what is shown.

mod deeds;

use host_sim::planners::PlannerKind;
use host_sim::record::grid::Trace;
use host_sim::scenario::{Conditions, Faults};
use host_sim::world::Starts;

use crate::ground::{ALL_TICKS, Layers};
use crate::opened::Opened;
use crate::platform::{Inbox, Stopwatch};
use crate::playback::{Playback, Verdict};
use crate::setup::Setup;
use crate::survey::{Rival, SurveyScene, SurveySetup, Turn};
use crate::view::{Camera, Tool, View};
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
    /// One 3-D survey, or two in step; none, if runs on a grid are looked at.
    pub surveys: Vec<SurveyScene>,
    /// What the second survey has otherwise.
    pub survey_rival: Option<Rival>,
    /// Whether ticks go by.
    pub playing: bool,
    /// Ticks a second.
    pub speed: f32,
    /// What is drawn.
    pub layers: Layers,
    /// What is drawn of surveys.
    pub survey_layers: crate::survey::Layers,
    /// What the pointer does.
    pub tool: Tool,
    /// The robot that is looked at.
    pub selected: Option<usize>,
    /// What the user should know.
    pub notice: Option<Notice>,
    pub(crate) camera: Camera,
    pub(crate) turn: Turn,
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
            surveys: Vec::new(),
            survey_rival: None,
            playing: true,
            speed: 60.0,
            layers: Layers::default(),
            survey_layers: Default::default(),
            tool: Tool::Look,
            selected: None,
            notice: None,
            camera: Camera::default(),
            turn: Turn::default(),
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
            match SurveySetup::from_address(address) {
                Ok(setup) => {
                    self.survey_rival = None;
                    self.fly(setup);
                }
                Err(error) => self.fail(error),
            }
            return;
        }
        self.rival = None;
        match Setup::from_address(address) {
            Ok(setup) => self.playing |= self.set(setup),
            Err(error) => self.fail(error),
        }
    }

    /// The 3-D survey that is looked at, of two the first.
    pub fn survey(&self) -> Option<&SurveyScene> {
        self.surveys.first()
    }

    /// The part of an address behind `#` that shows what is looked at.
    pub fn address(&self) -> String {
        match self.survey() {
            Some(survey) => survey.setup.address(),
            None => self.setup.address(),
        }
    }

    /// Starts a survey, with its rival if it has one; one that cannot be flown changes
    /// nothing but the notice. Says whether it flies.
    pub fn fly(&mut self, setup: SurveySetup) -> bool {
        self.fly_to(setup, None)
    }

    /// As [`fly`](Self::fly), and goes on from a step.
    fn fly_to(&mut self, setup: SurveySetup, step: Option<u32>) -> bool {
        let fits = |rival: &Rival| setup.rivals().contains(rival);
        let rival = self.survey_rival.filter(fits);
        let other = rival.map(|rival| setup.with(rival));
        let wanted = std::iter::once(setup).chain(other);
        match wanted.map(SurveyScene::new).collect() {
            Ok(surveys) => {
                self.survey_rival = rival;
                self.watch(surveys);
                self.target = step;
                true
            }
            Err(error) => {
                self.fail(error);
                false
            }
        }
    }

    fn watch(&mut self, surveys: Vec<SurveyScene>) {
        let drones = surveys.first().map(|survey| survey.setup.robots);
        let drones = usize::from(drones.unwrap_or(0));
        self.selected = self.selected.filter(|&drone| drone < drones);
        self.surveys = surveys;
        self.playing = true;
        self.notice = None;
        self.target = None;
        self.due = 0.0;
    }

    /// Shows a trace of a survey that was opened.
    fn watch_opened(&mut self, survey: SurveyScene) {
        self.survey_rival = None;
        self.watch(vec![survey]);
    }

    /// Shows the explorations on the grid again.
    pub fn land(&mut self) {
        self.surveys.clear();
        self.target = None;
        self.selected = None;
    }

    /// What is played: one or two surveys, or one or two runs on a grid, in step.
    pub fn players(&self) -> Vec<&dyn Playback> {
        match self.surveys.is_empty() {
            false => self.surveys.iter().map(|survey| survey as _).collect(),
            true => self.runs.iter().map(|run| &run.watch as _).collect(),
        }
    }

    fn players_mut(&mut self) -> Vec<&mut dyn Playback> {
        match self.surveys.is_empty() {
            false => self.surveys.iter_mut().map(|survey| survey as _).collect(),
            true => self
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
        self.surveys.clear();
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
            Ok(Opened::Survey(trace)) => self.watch_opened(SurveyScene::replay(*trace)),
            Ok(Opened::Voxels(trace)) => self.watch_opened(SurveyScene::replay_voxels(*trace)),
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
        match self.survey() {
            Some(survey) => self.fly(survey.setup.clone()),
            None => self.set(self.setup.clone()),
        };
    }

    /// Whether something moves without the user.
    pub fn is_busy(&self) -> bool {
        let waits = |run: &Shown| run.watch.state().is_none() && run.watch.differs().is_none();
        let waits = self.surveys.is_empty() && self.runs.iter().any(waits);
        self.playing || self.target.is_some() || waits
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
