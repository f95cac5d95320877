//! Which row belongs where.

use std::collections::HashMap;

use planner_core::Extent;

use super::plan::{Plan, Setup};
use super::row::{Key, Row};

/// The places of the runs of a plan: world by world, and in each world in one order.
#[derive(Clone, Debug)]
pub struct Order {
    worlds: HashMap<String, (usize, Extent)>,
    runs: HashMap<Key, usize>,
}

impl Order {
    /// That of a plan.
    pub fn of(plan: &Plan) -> Self {
        let sites = plan.sites.iter();
        Self::new(
            sites.map(|site| (site.name(), site.extent())),
            &plan.setups(),
        )
    }

    /// That of these runs in these worlds.
    pub(super) fn new(worlds: impl Iterator<Item = (String, Extent)>, setups: &[Setup]) -> Self {
        let worlds = (0..).zip(worlds);
        Self {
            worlds: worlds
                .map(|(number, (name, extent))| (name, (number, extent)))
                .collect(),
            runs: setups.iter().map(Key::new).zip(0..).collect(),
        }
    }

    /// Number of runs.
    pub fn runs(&self) -> usize {
        self.worlds.len() * self.runs.len()
    }

    /// Number of runs in each world.
    pub fn runs_a_world(&self) -> usize {
        self.runs.len()
    }

    /// The number of a world of this name.
    pub fn world(&self, name: &str) -> Option<usize> {
        self.worlds.get(name).map(|&(number, _)| number)
    }

    /// The place of the run that a row tells of; `None`: it is not of the plan.
    pub fn place(&self, row: &Row) -> Option<usize> {
        let &(world, extent) = self.worlds.get(&row.world)?;
        let run = self.runs.get(&row.key())?;
        (extent == Extent::new(row.width, row.height)).then(|| world * self.runs.len() + run)
    }

    /// How many runs there are that `is_done` (number of the world, number of the run in it)
    /// does not name, and the world of the first; `None`: none.
    pub fn missing(&self, is_done: impl Fn(usize, usize) -> bool) -> Option<(usize, String)> {
        let missing_in = |world| {
            (0..self.runs.len())
                .filter(|&run| !is_done(world, run))
                .count()
        };
        let runs = (0..self.worlds.len()).map(missing_in).sum();
        let mut worlds: Vec<_> = self.worlds.iter().map(|(name, at)| (at.0, name)).collect();
        worlds.sort_unstable();
        let first = worlds.into_iter().find(|&(world, _)| missing_in(world) > 0);
        first.map(|(_, name)| (runs, name.clone()))
    }

    /// The rows of the plan among `rows`, in its order, each run once.
    pub fn sort(&self, rows: Vec<Row>) -> Vec<Row> {
        let placed = rows.into_iter();
        let mut placed: Vec<(usize, Row)> = placed
            .filter_map(|row| Some((self.place(&row)?, row)))
            .collect();
        placed.sort_by_key(|&(place, _)| place);
        placed.dedup_by_key(|&mut (place, _)| place);
        placed.into_iter().map(|(_, row)| row).collect()
    }
}
