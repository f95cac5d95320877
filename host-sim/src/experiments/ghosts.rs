//! What it costs a fleet that somebody pretends robots: three explorers among ghosts
//! against one that explores alone.

use std::fmt;
use std::sync::Arc;

use planner_core::RobotId;
use planner_core::explorer::SensorModel;
use planner_core::radio::LinkConfig;

use crate::fleet::{Fleet, Rules};
use crate::medium;
use crate::planners::{PlannerKind, Setup};
use crate::scenario::grid::default_max_ticks;
use crate::scenario::{Conditions, Forger, Forgery, MediumKind, Mission};
use crate::sensor::Sensor;
use crate::world::{Starts, World, WorldError};

/// Sensor range in cells.
const RANGE: u8 = 5;

/// What disturbs a fleet of three.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Attack {
    /// Forged hints, and how many.
    Forged(Forger),
    /// Robots with these numbers instead of 1, 2 and 3.
    Ids([u8; 3]),
}

impl Attack {
    /// Every attack by hints.
    pub fn all() -> Vec<Self> {
        let forged = |kind| {
            let frames = if kind == Forgery::Around { 15 } else { 1 };
            Self::Forged(Forger { frames, kind })
        };
        let ids = [[1, 1, 3], [1, 1, 1]].map(Self::Ids);
        Forgery::HINTS.into_iter().map(forged).chain(ids).collect()
    }
}

impl fmt::Display for Attack {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Forged(Forger { frames, kind }) => write!(f, "--forge {frames}:{kind}"),
            Self::Ids([a, b, c]) => write!(f, "robots {a}, {b} and {c}"),
        }
    }
}

/// Ticks until every one of three robots has stopped that start together in a corner
/// of `world` and speak by radio; `None` if one never does.
///
/// # Errors
/// A world without a free cell.
pub fn three_robots(
    world: &Arc<World>,
    sensor: &Arc<Sensor>,
    attack: Option<Attack>,
) -> Result<Option<u32>, WorldError> {
    let (ids, forger) = match attack {
        None => ([1, 2, 3], None),
        Some(Attack::Forged(forger)) => ([1, 2, 3], Some(forger)),
        Some(Attack::Ids(ids)) => (ids, None),
    };
    explore(world, sensor, &ids, forger)
}

/// The same of one robot.
///
/// # Errors
/// As [`three_robots`].
pub fn one_robot(world: &Arc<World>, sensor: &Arc<Sensor>) -> Result<Option<u32>, WorldError> {
    explore(world, sensor, &[1], None)
}

fn explore(
    world: &Arc<World>,
    sensor: &Arc<Sensor>,
    ids: &[u8],
    forger: Option<Forger>,
) -> Result<Option<u32>, WorldError> {
    let starts = world.place(ids.len(), &Starts::Corner, false)?;
    let max_ticks = default_max_ticks(&world.reachable(&starts), PlannerKind::Explorer);
    let mut conditions = Conditions {
        medium: MediumKind::Radio,
        ..Conditions::new(1, max_ticks)
    };
    conditions.air.forger = forger;
    let extent = world.extent();
    let ids = ids.to_vec();
    let build = Box::new(move |id: RobotId, start| {
        let setup = Setup {
            id: RobotId(ids.get(usize::from(id.0)).copied().unwrap_or(id.0)),
            extent,
            start,
            link: LinkConfig::new(),
            sensor: SensorModel::truthful(),
            clearance: 0,
            mission: Mission::default(),
        };
        PlannerKind::Explorer
            .build(setup)
            .expect("the compiled size holds the world")
    });
    let medium = medium::build(&conditions, world.clone());
    let mut fleet = Fleet::<8, 8>::new(sensor.clone(), medium, Rules::default(), build, &starts);
    while !fleet.has_stopped() {
        if fleet.ticks() >= max_ticks {
            return Ok(None);
        }
        fleet.tick();
    }
    Ok(Some(fleet.ticks()))
}

/// The sensor of a world.
pub fn sensor(world: &Arc<World>) -> Arc<Sensor> {
    Arc::new(Sensor::new(world.clone(), RANGE))
}
