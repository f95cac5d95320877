//! All chips of a run.

use std::path::PathBuf;
use std::rc::Rc;
use std::time::Duration;

use bridge::{Request, SurveyorConfig};
use planner_core::sight::MAX_RADIUS;
use planner_core::survey::{Knowledge, Limits, SetupError, Surveyor};
use planner_core::voxel_survey::Config;
use planner_core::{AnyPlanner, Extent, ExtentError, RobotId};

use super::book::Book;
use super::dialogue::Dialogue;
use super::emulator::{Chip, Machine};
use super::error::ChipError;
use super::proxy::Proxy;
use super::surveyor::SurveyProxy;
use super::voxels::VoxelProxy;
use crate::measured::Measured;
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

impl Swarm {
    /// Chips of this kind, which run the image at that path.
    pub fn new(machine: Machine, image: PathBuf) -> Self {
        Self {
            book: Rc::new(Book::of(machine)),
            machine,
            image,
            limit: LIMIT,
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
        book.close()
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
