//! Runs in parallel.

use std::sync::{Arc, OnceLock};

use rayon::prelude::*;
use thiserror::Error;

use super::journal::JournalError;
use super::plan::Plan;
use super::row::Row;
use super::shard::Shard;
use crate::run::{Options, Outcome, run};
use crate::scenario::ScenarioError;
use crate::sensor::Sensor;
use crate::world::WorldError;

/// Why runs ended early. What had finished by then was handed over.
#[derive(Debug, Error)]
pub enum ExecuteError {
    /// See the message.
    #[error(transparent)]
    World(#[from] WorldError),
    /// See the message.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// See the message.
    #[error(transparent)]
    Journal(#[from] JournalError),
}

/// Does the runs of a plan in the worlds of the shard, but for those that `is_done` (number
/// of the world, number of the run in it) names, and hands over each row and outcome as a
/// run ends. Runs in one world share its sensors, which are dropped before the next world
/// is begun.
///
/// # Errors
/// The first that a world, a scenario or `finish` gives.
pub fn execute(
    plan: &Plan,
    shard: Shard,
    is_done: &(dyn Fn(usize, usize) -> bool + Sync),
    finish: &(dyn Fn(Row, Outcome) -> Result<(), JournalError> + Sync),
) -> Result<(), ExecuteError> {
    let setups = plan.setups();
    let at_site = |number: usize| {
        let missing: Vec<_> = (0..)
            .zip(&setups)
            .filter(|&(run, _)| !is_done(number, run))
            .map(|(_, setup)| setup)
            .collect();
        if missing.is_empty() {
            return Ok(());
        }
        let site = &plan.sites[number];
        let world = site.world()?;
        let sensors: Vec<OnceLock<Arc<Sensor>>> = vec![OnceLock::new(); plan.ranges.len()];
        missing.into_par_iter().try_for_each(|setup| {
            let sensor = plan
                .ranges
                .iter()
                .position(|&range| range == setup.range)
                .map(|kind| {
                    let sensor = || Arc::new(Sensor::new(world.clone(), setup.range));
                    sensors[kind].get_or_init(sensor).clone()
                });
            let scenario = setup.scenario(&world)?;
            let options = Options {
                sensor,
                ..Options::default()
            };
            let (outcome, _) = run(&scenario, options)?;
            Ok(finish(Row::new(site, setup, &outcome), outcome)?)
        })
    };
    let sites = shard.of(plan);
    sites.into_par_iter().try_for_each(at_site)
}
