//! All chips of a run.

use std::cell::{OnceCell, RefCell};
use std::path::PathBuf;
use std::rc::Rc;
use std::time::Duration;

use bridge::{Cost, Request, SurveyorConfig};
use planner_core::sight::MAX_RADIUS;
use planner_core::survey::{Knowledge, Limits, SetupError, Surveyor};
use planner_core::voxel_survey::Config;
use planner_core::{AnyPlanner, Extent, ExtentError, RobotId};

use super::dialogue::Dialogue;
use super::emulator::{Chip, Machine};
use super::error::ChipError;
use super::proxy::Proxy;
use super::surveyor::SurveyProxy;
use super::voxels::VoxelProxy;
use crate::measured::{Call, Measured};
use crate::planners::{PlannerKind, Setup};
use crate::record::grid::Trace;
use crate::run::voxels::{self, Pilot};
use crate::run::{self, Here, Host, Options, Outcome, Site, heights};
use crate::scenario::ScenarioError;
use crate::scenario::grid::Scenario;

/// Many times what the longest answer takes on a busy machine.
const LIMIT: Duration = Duration::from_secs(60);

/// Hosts the planners of a run in emulated chips.
#[derive(Clone)]
pub struct Swarm {
    machine: Machine,
    image: PathBuf,
    /// How long an answer is waited for.
    limit: Duration,
    book: Rc<Book>,
}

/// What all chips of a run write down.
pub(super) struct Book {
    /// The first failure. The run is worth nothing after it, and ends.
    pub(super) failure: OnceCell<ChipError>,
    pub(super) measured: RefCell<Measured>,
}

impl Book {
    /// Notes what a call took. The emulated chip's clock counts instructions: each
    /// takes a nanosecond.
    pub(super) fn count(&self, call: Call, cost: Cost, clock_hz: u64) {
        let instructions = u64::from(cost.clock_ticks) * 1_000_000_000 / clock_hz;
        let mut measured = self.measured.borrow_mut();
        measured.count(call, instructions, cost.stack);
    }
}

impl Swarm {
    /// Chips of this kind, which run the image at that path.
    pub fn new(machine: Machine, image: PathBuf) -> Self {
        let measured = Measured {
            machine: machine.to_string(),
            ..Measured::default()
        };
        Self {
            machine,
            image,
            limit: LIMIT,
            book: Rc::new(Book {
                failure: OnceCell::new(),
                measured: measured.into(),
            }),
        }
    }

    /// The same, which give up a chip that has not answered for this long; a minute
    /// if nothing is said.
    pub fn patient_for(mut self, limit: Duration) -> Self {
        self.limit = limit;
        self
    }

    /// Runs a scenario with a chip for each robot.
    ///
    /// # Errors
    /// A scenario out of range. A chip that fails ends the run; [`finish`](Self::finish)
    /// says why.
    pub fn explore(
        &self,
        scenario: &Scenario,
        options: Options<'_>,
    ) -> Result<(Outcome, Option<Trace>), ScenarioError> {
        if scenario.range > MAX_RADIUS {
            let expected = format!("1 to {MAX_RADIUS} cells where a chip decides");
            return Err(ScenarioError::setting("range", scenario.range, expected));
        }
        run::run_on(self, scenario, options)
    }

    /// Starts the chip of a robot with the request that sets up its planner, if there is one.
    pub(super) fn start(
        &self,
        robot: RobotId,
        request: Result<Request<'_>, ChipError>,
    ) -> Dialogue {
        let chip = Chip::start(robot, self.machine, &self.image, self.limit);
        Dialogue::open(robot, chip, self.book.clone(), request)
    }

    /// What the chips took, when the run is over.
    ///
    /// # Errors
    /// Why the run failed.
    pub fn finish(self) -> Result<Measured, ChipError> {
        let book = Rc::try_unwrap(self.book);
        let Ok(book) = book else {
            unreachable!("the robots are gone with the run");
        };
        match book.failure.into_inner() {
            Some(failure) => Err(failure),
            None => Ok(book.measured.into_inner()),
        }
    }
}

impl Site for Swarm {
    fn has_failed(&self) -> bool {
        self.book.failure.get().is_some()
    }
}

impl Host for Swarm {
    fn planner<const TW: usize, const TH: usize>(
        &self,
        kind: PlannerKind,
        setup: Setup,
    ) -> Box<dyn AnyPlanner<TW, TH>> {
        Box::new(Proxy::new(self, kind, setup))
    }
}

impl voxels::Host for Swarm {
    fn pilot(
        &self,
        config: Config,
        id: RobotId,
        extent: Extent,
        levels: u8,
    ) -> Result<Box<dyn Pilot>, ExtentError> {
        let mirror = voxels::Host::pilot(&Here, config, id, extent, levels)?;
        Ok(Box::new(VoxelProxy::new(self, mirror, config, id)))
    }
}

impl heights::Host for Swarm {
    fn surveyor<const T: usize>(
        &self,
        extent: Extent,
        limits: Limits,
        planner: SurveyorConfig,
        id: RobotId,
    ) -> Result<Box<dyn Surveyor<T, T>>, SetupError> {
        let knowledge = Knowledge::new(extent, limits, *planner.link(), id)?;
        Ok(Box::new(SurveyProxy::new(self, knowledge, planner, id)))
    }
}
