//! From a scenario to what happened.

mod book;
mod stepping;

use std::sync::Arc;

use planner_core::radio::{Hearsay, Key, LinkConfig, MAX_LEN};
use planner_core::{Cell, Extent, Planner, Stop, sight};
use thiserror::Error;

use crate::fleet::{Faults, Fleet, Rules, Sent, Violation};
use crate::medium::{AirFaults, MediumKind};
use crate::peers::{Bmilrv, Marks};
use crate::planners::{PlannerKind, Setup};
use crate::senses::Senses;
use crate::sensor::{ALL_AROUND, Sensor};
use crate::trace::Trace;
use crate::world::{Reachable, World};

pub use stepping::{Running, Seen, Stepping};

/// Everything that a run follows from. The same scenario gives the same run on
/// every machine.
#[derive(Clone, Debug)]
pub struct Scenario {
    /// What is explored.
    pub world: Arc<World>,
    /// Where each robot starts; as many robots as starts, 1 to 255.
    pub starts: Vec<Cell>,
    /// What decides in each robot.
    pub planner: PlannerKind,
    /// Sensor range in cells, 1 to 15.
    pub range: u8,
    /// The sensor's field of view around the robot's heading, in degrees, 1 to
    /// [`ALL_AROUND`]. Robots begin turned to the east.
    pub fov: u16,
    /// What carries what robots tell each other.
    pub medium: MediumKind,
    /// Ticks between two exchanges among robots; 0: never.
    pub sync: u32,
    /// Bytes that a robot may send by radio in a tick on average. Less than a
    /// frame: it sends one every few ticks.
    pub byte_budget: u16,
    /// Share of messages lost, 0 to 1.
    pub loss: f64,
    /// What else goes wrong in the air.
    pub air: AirFaults,
    /// The fleet's secret, with which frames are signed.
    pub key: Option<Key>,
    /// Seed of all chance in the run.
    pub seed: u64,
    /// Whether a cell holds at most one robot.
    pub solid: bool,
    /// The run ends after this many ticks.
    pub max_ticks: u32,
    /// What goes wrong with robots and cells.
    pub faults: Faults,
}

/// A scenario that cannot be run.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ScenarioError {
    /// See the message.
    #[error("{0} robots; expected 1 to 255")]
    Robots(usize),
    /// See the message.
    #[error("a sensor range of {0} cells; expected 1 to {max}", max = sight::MAX_RADIUS)]
    Range(u8),
    /// See the message.
    #[error("a field of view of {0} degrees; expected 1 to {ALL_AROUND}")]
    Fov(u16),
    /// See the message.
    #[error(
        "planner {planner} never turns its sensor, and needs a field of view of {ALL_AROUND} \
         degrees, not {fov}; the explorer turns it"
    )]
    NeverTurns {
        /// What was to decide.
        planner: PlannerKind,
        /// With what field of view.
        fov: u16,
    },
    /// See the message.
    #[error("a share of {share} for {name}; expected 0 (none) to 1 (all)")]
    Share {
        /// Of what.
        name: &'static str,
        /// How much.
        share: f64,
    },
    /// See the message.
    #[error("a {0} only works on frames: the medium must be radio")]
    NoFrames(&'static str),
    /// See the message.
    #[error("robot {robot} starts at {start}, which is no free cell of the world")]
    Start {
        /// Index of the robot.
        robot: usize,
        /// Where it was to start.
        start: Cell,
    },
    /// See the message.
    #[error("a {what} cell at {cell}, outside of the map of {extent} cells")]
    FaultOutside {
        /// Closed or blind.
        what: &'static str,
        /// Which cell.
        cell: Cell,
        /// Size of the map.
        extent: Extent,
    },
    /// See the message.
    #[error("robots {first} and {second} both start at {start}, but no two may share a cell")]
    SharedStart {
        /// Index of the one.
        first: usize,
        /// Index of the other.
        second: usize,
        /// Where both were to start.
        start: Cell,
    },
}

impl Scenario {
    /// A scenario with the defaults: sensor range 5 all around, the ideal medium with an
    /// exchange in every tick, shared cells, seed 0, no faults, and ticks enough
    /// for any planner that gets anywhere.
    pub fn new(world: Arc<World>, starts: Vec<Cell>, planner: PlannerKind) -> Self {
        let max_ticks = default_max_ticks(&world.reachable(&starts), planner);
        Self {
            world,
            starts,
            planner,
            range: 5,
            fov: ALL_AROUND,
            medium: MediumKind::Ideal,
            sync: 1,
            byte_budget: MAX_LEN as u16,
            loss: 0.0,
            air: AirFaults::default(),
            key: None,
            seed: 0,
            solid: false,
            max_ticks,
            faults: Faults::default(),
        }
    }

    /// Whether the scenario can be run.
    ///
    /// # Errors
    /// What is out of range.
    pub fn check(&self) -> Result<(), ScenarioError> {
        let robots = self.starts.len();
        if !(1..=255).contains(&robots) {
            return Err(ScenarioError::Robots(robots));
        }
        if !(1..=sight::MAX_RADIUS).contains(&self.range) {
            return Err(ScenarioError::Range(self.range));
        }
        if !(1..=ALL_AROUND).contains(&self.fov) {
            return Err(ScenarioError::Fov(self.fov));
        }
        if self.fov < ALL_AROUND && !self.planner.turns_sensor() {
            return Err(ScenarioError::NeverTurns {
                planner: self.planner,
                fov: self.fov,
            });
        }
        self.check_fault_cells()?;
        for (name, share) in [
            ("loss", self.loss),
            ("duplication", self.air.duplication),
            ("corruption", self.air.corruption),
        ] {
            if !(0.0..=1.0).contains(&share) {
                return Err(ScenarioError::Share { name, share });
            }
        }
        let of_frames = [
            ("key", self.key.is_some()),
            ("forger", self.air.forger.is_some()),
        ];
        if let Some((name, _)) = of_frames.iter().find(|(_, is_given)| *is_given)
            && self.medium != MediumKind::Radio
        {
            return Err(ScenarioError::NoFrames(name));
        }
        for (robot, &start) in self.starts.iter().enumerate() {
            if !self.world.is_free(start) {
                return Err(ScenarioError::Start { robot, start });
            }
            if self.solid
                && let Some(first) = self.starts[..robot].iter().position(|&cell| cell == start)
            {
                return Err(ScenarioError::SharedStart {
                    first,
                    second: robot,
                    start,
                });
            }
        }
        Ok(())
    }

    fn check_fault_cells(&self) -> Result<(), ScenarioError> {
        let extent = self.world.extent();
        let closed = self.faults.closures.iter().map(|of| ("closed", of.cell));
        let blind = self.faults.blind.iter().map(|of| ("blind", of.cell));
        match closed
            .chain(blind)
            .find(|(_, cell)| !extent.contains(*cell))
        {
            None => Ok(()),
            Some((what, cell)) => Err(ScenarioError::FaultOutside { what, cell, extent }),
        }
    }

    /// The sensor that its robots carry.
    pub fn sensor(&self) -> Arc<Sensor> {
        let world = self.world.clone();
        Arc::new(Sensor::with_fov(world, self.range, self.fov))
    }

    /// What its robots see, before the first tick; `sensor` is the scenario's.
    pub fn senses(&self, sensor: Arc<Sensor>) -> Senses {
        Senses::new(sensor, &self.faults, self.starts.len())
    }
}

/// Ticks after which a run is given up if nobody says otherwise: a thousand, and
/// eight for each cell that can be reached, of which one robot that walks to
/// every cell and back needs two. BMILRV may go round many loops many times: a
/// hundred for each cell.
pub fn default_max_ticks(reachable: &Reachable, planner: PlannerKind) -> u32 {
    let each = match planner {
        PlannerKind::Bmilrv => 100,
        _ => 8,
    };
    1000 + each * reachable.count()
}

/// What happened in a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Outcome {
    /// Ticks that were run.
    pub ticks: u32,
    /// Moves that anybody could have made when somebody had seen every
    /// reachable cell; `None` if nobody ever did.
    pub ticks_to_seen: Option<u32>,
    /// Moves that anybody could have made when the last living robot had
    /// stopped; `None` if the run ended before.
    pub ticks_to_stopped: Option<u32>,
    /// Free cells that can be reached from any start.
    pub reachable_cells: u32,
    /// Reachable cells that somebody has seen.
    pub seen_cells: u32,
    /// Reachable cells that more than one robot has seen with its own sensor.
    pub shared_cells: u32,
    /// Largest work of one planner in one tick.
    pub max_work_per_tick: u32,
    /// Reachable cells seen by somebody, tick by tick.
    pub coverage: Vec<u32>,
    /// Costs of the ways that were assigned.
    pub assignments: Assignments,
    /// Robot by robot.
    pub robots: Vec<RobotOutcome>,
    /// Moves into obstacles. Anything but none is a bug of a planner.
    pub violations: Vec<Violation>,
}

/// What happened to one robot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RobotOutcome {
    /// Cells walked.
    pub steps: u32,
    /// Steps that something stood in the way of.
    pub blocked_steps: u32,
    /// Cells on its own map, obstacles included.
    pub cells_known: u32,
    /// Cells that it could reach and that its own map lacks.
    pub cells_missed: u32,
    /// Cells that another living robot's map holds and its own lacks, if it lives.
    pub cells_unheard: u32,
    /// Work of its planner over the run.
    pub work: u64,
    /// What it sent by radio over the run.
    pub sent: Sent,
    /// Why it stopped; `None` if it did not.
    pub stop: Option<Stop>,
    /// Whether it lived to the end of the run.
    pub alive: bool,
    /// What it had from others, and what spoke against them.
    pub hearsay: Hearsay,
}

/// The costs of assignments by both criteria of \[Bautin2011\]. The robots that get
/// a way in the same tick make up one assignment; a cost is the length of a way
/// in steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Assignments {
    /// Ticks in which a robot was assigned a way.
    pub count: u32,
    /// Criterion 1, summed over assignments: the sum of costs.
    pub sum: u64,
    /// Criterion 2, summed over assignments: the largest cost.
    pub largest: u64,
}

impl Assignments {
    fn add(&mut self, costs: impl Iterator<Item = u32> + Clone) {
        if let Some(largest) = costs.clone().max() {
            self.count += 1;
            self.sum += costs.map(u64::from).sum::<u64>();
            self.largest += u64::from(largest);
        }
    }

    /// Mean of criterion 1; `None` if nothing was assigned.
    pub fn mean_sum(&self) -> Option<f64> {
        (self.count > 0).then(|| self.sum as f64 / f64::from(self.count))
    }

    /// Mean of criterion 2; `None` if nothing was assigned.
    pub fn mean_largest(&self) -> Option<f64> {
        (self.count > 0).then(|| self.largest as f64 / f64::from(self.count))
    }
}

impl Outcome {
    /// Moves that anybody could have made when the share `share` (0 to 1) of
    /// the reachable cells had been seen; `None` if that never was.
    pub fn ticks_to_share(&self, share: f64) -> Option<u32> {
        let enough = share * f64::from(self.reachable_cells);
        let reached = |&seen: &u32| f64::from(seen) >= enough;
        Some(self.coverage.iter().position(reached)? as u32)
    }

    /// Whether every reachable cell was seen by somebody, without a violation.
    pub fn is_complete(&self) -> bool {
        self.ticks_to_seen.is_some() && self.violations.is_empty()
    }

    /// Whether all living robots know the same cells in the end.
    pub fn maps_agree(&self) -> bool {
        self.robots.iter().all(|robot| robot.cells_unheard == 0)
    }

    /// Share of the seen cells that more than one robot saw with its own
    /// sensor, 0 to 1.
    pub fn overlap(&self) -> f64 {
        f64::from(self.shared_cells) / f64::from(self.seen_cells.max(1))
    }
}

/// A run as far as it has come.
#[derive(Clone, Copy, Debug)]
pub struct Progress {
    /// Ticks done.
    pub ticks: u32,
    /// Reachable cells that somebody has seen.
    pub seen_cells: u32,
    /// Cells that can be reached.
    pub reachable_cells: u32,
}

/// How a scenario is run; changes nothing of what happens.
#[derive(Default)]
pub struct Options<'a> {
    /// A sensor of the scenario's world, range and field of view that other runs have filled.
    pub sensor: Option<Arc<Sensor>>,
    /// Whether a trace is kept.
    pub trace: bool,
    /// Called after every tick.
    pub progress: Option<&'a mut dyn FnMut(Progress)>,
}

/// Where the planners of a run are.
pub trait Host: Clone + 'static {
    /// The planner of a robot.
    ///
    /// # Panics
    /// If the grid does not fit a map of `TW`×`TH` tiles.
    fn planner<const TW: usize, const TH: usize>(
        &self,
        kind: PlannerKind,
        setup: Setup,
    ) -> Box<dyn Planner<TW, TH>>;

    /// Whether the run has to end because a planner is lost.
    fn has_failed(&self) -> bool;
}

/// In this process.
#[derive(Clone, Copy, Debug)]
pub struct Here;

impl Host for Here {
    fn planner<const TW: usize, const TH: usize>(
        &self,
        kind: PlannerKind,
        setup: Setup,
    ) -> Box<dyn Planner<TW, TH>> {
        kind.build(setup)
            .expect("the compiled size holds the world")
    }

    fn has_failed(&self) -> bool {
        false
    }
}

/// Runs a scenario until every living robot has stopped or time is up.
///
/// # Errors
/// A scenario out of range.
pub fn run(
    scenario: &Scenario,
    options: Options<'_>,
) -> Result<(Outcome, Option<Trace>), ScenarioError> {
    run_on(&Here, scenario, options)
}

/// A scenario before its first tick, for whoever wants to watch: the same run tick
/// by tick, with a trace. `sensor` is one of the scenario's, if there is one already.
///
/// # Errors
/// A scenario out of range.
pub fn open(
    scenario: &Scenario,
    sensor: Option<Arc<Sensor>>,
) -> Result<Box<dyn Stepping>, ScenarioError> {
    scenario.check()?;
    let Extent { width, height } = scenario.world.extent();
    Ok(match width.max(height) {
        0..=32 => Box::new(Running::<4, 4>::new(&Here, scenario, sensor, true)),
        33..=64 => Box::new(Running::<8, 8>::new(&Here, scenario, sensor, true)),
        65..=128 => Box::new(Running::<16, 16>::new(&Here, scenario, sensor, true)),
        129..=256 => Box::new(Running::<32, 32>::new(&Here, scenario, sensor, true)),
        _ => Box::new(Running::<64, 64>::new(&Here, scenario, sensor, true)),
    })
}

/// As [`run`], with planners that are elsewhere.
///
/// # Errors
/// A scenario out of range.
pub fn run_on(
    host: &impl Host,
    scenario: &Scenario,
    options: Options<'_>,
) -> Result<(Outcome, Option<Trace>), ScenarioError> {
    scenario.check()?;
    let Extent { width, height } = scenario.world.extent();
    Ok(match width.max(height) {
        0..=32 => compiled_on::<4, 4>(host, scenario, options),
        33..=64 => compiled_on::<8, 8>(host, scenario, options),
        65..=128 => compiled_on::<16, 16>(host, scenario, options),
        129..=256 => compiled_on::<32, 32>(host, scenario, options),
        _ => compiled_on::<64, 64>(host, scenario, options),
    })
}

/// The fleet of a scenario before its first tick, on maps of `TW`×`TH` tiles.
///
/// # Panics
/// If the world does not fit maps of this size.
pub fn fleet<const TW: usize, const TH: usize>(
    scenario: &Scenario,
    sensor: Arc<Sensor>,
) -> Fleet<TW, TH> {
    fleet_on(&Here, scenario, sensor)
}

fn fleet_on<const TW: usize, const TH: usize>(
    host: &impl Host,
    scenario: &Scenario,
    sensor: Arc<Sensor>,
) -> Fleet<TW, TH> {
    let rules = Rules {
        solid: scenario.solid,
        faults: scenario.faults.clone(),
    };
    let link = LinkConfig {
        bytes_per_tick: scenario.byte_budget,
        key: scenario.key,
        ..LinkConfig::new()
    };
    let (host, kind) = (host.clone(), scenario.planner);
    let extent = scenario.world.extent();
    // Robots that work by marks share them, and meet where the first one starts.
    let marks = match (kind, scenario.starts.first()) {
        (PlannerKind::Bmilrv, Some(&start)) => Some(Marks::new(extent, start)),
        _ => None,
    };
    let build = Box::new(move |id, start| -> Box<dyn Planner<TW, TH>> {
        if let Some(marks) = &marks {
            let robot = Bmilrv::new(marks.clone(), id, extent, start, link);
            return Box::new(robot.expect("the compiled size holds the world"));
        }
        let setup = Setup {
            id,
            extent,
            start,
            link,
        };
        host.planner(kind, setup)
    });
    let medium = scenario.medium.build(
        scenario.sync,
        scenario.loss,
        scenario.air.clone(),
        scenario.seed,
        scenario.world.clone(),
    );
    Fleet::new(sensor, medium, rules, build, &scenario.starts)
}

/// Runs a checked scenario with maps of `TW`×`TH` tiles. The result does not
/// depend on them.
///
/// # Panics
/// If the world does not fit maps of this size.
pub fn run_compiled<const TW: usize, const TH: usize>(
    scenario: &Scenario,
    options: Options<'_>,
) -> (Outcome, Option<Trace>) {
    compiled_on::<TW, TH>(&Here, scenario, options)
}

fn compiled_on<const TW: usize, const TH: usize>(
    host: &impl Host,
    scenario: &Scenario,
    options: Options<'_>,
) -> (Outcome, Option<Trace>) {
    let mut running = Running::<TW, TH>::new(host, scenario, options.sensor, options.trace);
    let mut progress = options.progress;
    while !host.has_failed() && running.tick() {
        if let Some(progress) = &mut progress {
            progress(running.progress());
        }
    }
    running.end()
}
