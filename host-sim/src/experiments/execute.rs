//! Runs in parallel.

use std::collections::HashSet;
use std::str::FromStr;
use std::sync::{Arc, OnceLock};

use rayon::prelude::*;
use thiserror::Error;

use super::journal::JournalError;
use super::plan::{Plan, Site};
use super::row::{Key, Row};
use crate::run::{Options, Outcome, run};
use crate::scenario::ScenarioError;
use crate::sensor::Sensor;
use crate::world::WorldError;

/// Every N-th run of a plan, written `I/N` with I from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    index: usize,
    count: usize,
}

impl Shard {
    /// The whole plan.
    pub const ALL: Self = Self { index: 0, count: 1 };

    fn holds(self, run: usize) -> bool {
        run % self.count == self.index
    }
}

impl FromStr for Shard {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        text.split_once('/')
            .and_then(|(index, count)| Some((index.parse().ok()?, count.parse().ok()?)))
            .filter(|&(index, count): &(usize, usize)| (1..=count).contains(&index))
            .map(|(index, count)| Self {
                index: index - 1,
                count,
            })
            .ok_or("expected I/N with I from 1 to N, for example 2/8")
    }
}

/// For file names: `2-of-8`.
impl std::fmt::Display for Shard {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}-of-{}", self.index + 1, self.count)
    }
}

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

/// Does the runs of a plan that belong to the shard and are not `done`, and
/// hands over each row and outcome as a run ends. Runs in one world share its sensors,
/// which are dropped before the next world is begun.
///
/// # Errors
/// The first that a world, a scenario or `finish` gives.
pub fn execute(
    plan: &Plan,
    shard: Shard,
    done: &HashSet<Key>,
    finish: &(dyn Fn(Row, Outcome) -> Result<(), JournalError> + Sync),
) -> Result<(), ExecuteError> {
    let setups = plan.setups();
    let at_site = |(number, site): (usize, &Site)| {
        let first = number * setups.len();
        let missing: Vec<_> = (first..)
            .zip(&setups)
            .filter(|&(run, setup)| shard.holds(run) && !done.contains(&Key::new(site, setup)))
            .map(|(_, setup)| setup)
            .collect();
        if missing.is_empty() {
            return Ok(());
        }
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
    plan.sites.par_iter().enumerate().try_for_each(at_site)
}
