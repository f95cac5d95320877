//! Runs in a grid of cells.

use std::cell::RefCell;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use planner_core::{AnyPlanner, Extent, RobotId};

use super::{Here, Outcome, Progress, Running, Site, Stepping};
use crate::baselines::{Bmilrv, Marks};
use crate::fleet::{Fleet, Rules};
use crate::medium;
use crate::planners::{PlannerKind, Setup};
use crate::record::grid::Trace;
use crate::scenario::ScenarioError;
use crate::scenario::grid::Scenario;
use crate::sensor::Sensor;

/// Looks at a run that is over.
type Ended<'a> = &'a mut dyn FnMut(&dyn Stepping);

/// How a scenario is run; changes nothing of what happens.
#[derive(Default)]
pub struct Options<'a> {
    /// A sensor of the scenario's world, range and field of view that other runs have filled.
    pub sensor: Option<Arc<Sensor>>,
    /// Whether a trace is kept.
    pub trace: bool,
    /// Called after every tick.
    pub progress: Option<&'a mut dyn FnMut(Progress)>,
    /// When it is set, the run ends after the tick.
    pub end: Option<&'a AtomicBool>,
    /// Called with the run when it is over.
    pub ended: Option<Ended<'a>>,
}

/// Where the planners of a run are.
pub trait Host: Site {
    /// The planner of a robot.
    ///
    /// # Panics
    /// If the grid does not fit a map of `TW`×`TH` tiles.
    fn planner<const TW: usize, const TH: usize>(
        &self,
        kind: PlannerKind,
        setup: Setup,
    ) -> Box<dyn AnyPlanner<TW, TH>>;
}

impl Host for Here {
    fn planner<const TW: usize, const TH: usize>(
        &self,
        kind: PlannerKind,
        setup: Setup,
    ) -> Box<dyn AnyPlanner<TW, TH>> {
        kind.build(setup)
            .expect("the compiled size holds the world")
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
    // Each size is compiled anew; on maps of twice the side, runs take 2 % longer.
    Ok(match width.max(height) {
        0..=64 => Box::new(Running::<8, 8>::new(&Here, scenario, sensor, true)),
        65..=256 => Box::new(Running::<32, 32>::new(&Here, scenario, sensor, true)),
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
        0..=64 => compiled_on::<8, 8>(host, scenario, options),
        65..=256 => compiled_on::<32, 32>(host, scenario, options),
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

pub(super) fn fleet_on<const TW: usize, const TH: usize>(
    host: &impl Host,
    scenario: &Scenario,
    sensor: Arc<Sensor>,
) -> Fleet<TW, TH> {
    let rules = Rules {
        solid: scenario.solid,
        clearance: scenario.clearance,
        motion: scenario.motion,
        faults: scenario.conditions.faults.clone(),
        trouble: scenario.conditions.trouble,
        seed: scenario.conditions.seed,
        energy: scenario.conditions.mission.energy,
    };
    let mission = scenario.conditions.mission;
    let link = scenario.conditions.link();
    let sensor_model = scenario.conditions.preset.model();
    let (host, kind, clearance) = (host.clone(), scenario.planner, scenario.clearance);
    let extent = scenario.world.extent();
    let kept_out = scenario.conditions.limits.cells(extent);
    // Robots that work by marks share them, and meet where the first one starts.
    let marks = match (kind, scenario.starts.first()) {
        (PlannerKind::Bmilrv, Some(&start)) => Some(Marks::new(extent, start)),
        _ => None,
    };
    // For the first planner of each robot; one that restarts has lost what it knew.
    let saved: Vec<_> = { scenario.restored.iter() }
        .flat_map(|save| save.planners().map(Some))
        .collect();
    let saved = RefCell::new(saved);
    let build = Box::new(move |id: RobotId, start| -> Box<dyn AnyPlanner<TW, TH>> {
        if let Some(marks) = &marks {
            let robot = Bmilrv::new(marks.clone(), id, extent, start, link);
            return Box::new(robot.expect("the compiled size holds the world"));
        }
        let setup = Setup {
            id,
            extent,
            start,
            link,
            sensor: sensor_model,
            clearance,
            mission,
        };
        let mut planner = host.planner(kind, setup);
        let save = saved
            .borrow_mut()
            .get_mut(usize::from(id.0))
            .and_then(Option::take);
        if let Some(save) = save {
            planner.restore(&save).expect("the save was checked");
        }
        if kept_out.is_some() {
            let kept_out = planner.keep_out(kept_out);
            kept_out.expect("the planner can, and its start was checked");
        }
        planner
    });
    let medium = medium::build(&scenario.conditions, scenario.world.clone());
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
    let is_ended = || options.end.is_some_and(|end| end.load(Ordering::Relaxed));
    while !host.has_failed() && !is_ended() && running.tick() {
        if let Some(progress) = &mut progress {
            progress(running.progress());
        }
    }
    if let Some(ended) = options.ended {
        ended(&running);
    }
    running.end()
}
