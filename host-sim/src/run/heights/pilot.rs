//! The planners of a run over heights: where they are, and how a robot gets its own.

use bridge::SurveyorConfig;
use planner_core::coordinated_survey::{self, Choice, CoordinatedSurvey};
use planner_core::fcao::{self, Fcao};
use planner_core::survey::{Limits, SetupError, Surveyor};
use planner_core::{Extent, RobotId};

use crate::baselines::surveys::{Follower, Guide};
use crate::run::{Here, Site};
use crate::scenario::heights::{Planner, Scenario};

/// Where the planners of a survey are.
pub trait Host: Site {
    /// The planner of a robot.
    fn surveyor<const T: usize>(
        &self,
        extent: Extent,
        limits: Limits,
        planner: SurveyorConfig,
        id: RobotId,
    ) -> Result<Box<dyn Surveyor<T, T>>, SetupError>;
}

impl Host for Here {
    fn surveyor<const T: usize>(
        &self,
        extent: Extent,
        _: Limits,
        planner: SurveyorConfig,
        id: RobotId,
    ) -> Result<Box<dyn Surveyor<T, T>>, SetupError> {
        Ok(match planner {
            SurveyorConfig::Fcao(config) => Box::new(Fcao::<T, T>::new(config, id, extent)?),
            SurveyorConfig::Coordinated(config) => {
                Box::new(CoordinatedSurvey::new(config, id, extent)?)
            }
        })
    }
}

/// A robot's planner: one of the baselines, which a centre may order about, or of the core.
pub(super) enum Pilot<const T: usize> {
    Follower(Box<Follower<T, T>>),
    Other(Box<dyn Surveyor<T, T>>),
}

impl<const T: usize> Pilot<T> {
    pub(super) fn get(&self) -> &dyn Surveyor<T, T> {
        match self {
            Self::Follower(follower) => follower.as_ref(),
            Self::Other(other) => other.as_ref(),
        }
    }

    pub(super) fn get_mut(&mut self) -> &mut dyn Surveyor<T, T> {
        match self {
            Self::Follower(follower) => follower.as_mut(),
            Self::Other(other) => other.as_mut(),
        }
    }
}

/// A robot that decides as `scenario` says.
///
/// # Errors
/// The planner cannot be set up like this.
pub(super) fn pilot<const T: usize>(
    host: &impl Host,
    extent: Extent,
    scenario: &Scenario,
    id: RobotId,
) -> Result<Pilot<T>, SetupError> {
    let limits = scenario.limits;
    let link = scenario.conditions.link();
    let mission = scenario.conditions.mission.of_surveys();
    let follower = |guide| -> Result<Pilot<T>, SetupError> {
        let follower = Follower::new(extent, limits, link, id, guide)?;
        Ok(Pilot::Follower(Box::new(follower.on(mission))))
    };
    Ok(match scenario.planner {
        Planner::ClosestFrontier => follower(Guide::Closest)?,
        Planner::ClosestUntilReached => follower(Guide::ClosestUntilReached)?,
        Planner::Greedy | Planner::GreedyUnique | Planner::GreedyInOrder => {
            follower(Guide::Centre)?
        }
        Planner::CoordinatedSurvey | Planner::CoordinatedCubic => {
            let choice = if scenario.planner == Planner::CoordinatedCubic {
                Choice::Cubic
            } else {
                Choice::Map
            };
            let config = coordinated_survey::Config {
                limits,
                link,
                choice,
                mission,
                seed: scenario.conditions.seed,
            };
            let planner = SurveyorConfig::Coordinated(config);
            Pilot::Other(host.surveyor(extent, limits, planner, id)?)
        }
        Planner::Fcao => {
            let config = fcao::Config {
                link,
                mission,
                ..fcao::Config::new(limits, scenario.conditions.seed)
            };
            let planner = SurveyorConfig::Fcao(config);
            Pilot::Other(host.surveyor(extent, limits, planner, id)?)
        }
    })
}
