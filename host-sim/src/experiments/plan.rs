//! Which runs make up an experiment.

use std::fmt;
use std::sync::Arc;

use clap::ValueEnum;
use planner_core::Cell;
use serde::{Deserialize, Serialize};

use crate::planners::PlannerKind;
use crate::scenario::grid::Scenario;
use crate::scenario::{MediumKind, Preset, Trouble};
use crate::world::{Recipe, Starts, World, WorldError};

/// Every combination of these is one run.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Worlds.
    pub sites: Vec<Site>,
    /// Planners.
    pub planners: Vec<PlannerKind>,
    /// Numbers of robots.
    pub robots: Vec<u8>,
    /// How robots are placed.
    pub place: Place,
    /// Placings in each world.
    pub starts: u32,
    /// What carries messages.
    pub medium: MediumKind,
    /// Ticks between two exchanges.
    pub syncs: Vec<u32>,
    /// Shares of messages lost.
    pub losses: Vec<f64>,
    /// Sensor ranges in cells.
    pub ranges: Vec<u8>,
    /// How the worlds mislead robots.
    pub trouble: Trouble,
    /// What the explorer takes its sensors for.
    pub preset: Preset,
    /// Seed of placings, losses and trouble.
    pub seed: u64,
}

/// A world of an experiment.
#[derive(Clone, Debug)]
pub enum Site {
    /// Made when it is wanted; counts for its family.
    Generated(Recipe),
    /// Counts for itself.
    Given(Arc<World>),
}

/// How the robots of a run are placed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Place {
    /// Together on a cell that is drawn.
    #[default]
    Random,
    /// Each on a cell that is drawn.
    Scattered,
    /// The first on a cell that is drawn, each further one as far as possible from those
    /// before.
    Spread,
    /// Together, nearest to the centre; further placings on the next nearest
    /// cells.
    Center,
    /// Together, nearest to the top left corner, and on.
    Corner,
    /// Where the map says, else in the centre; further placings together, on
    /// the cells nearest to the map's first start.
    Map,
}

/// One run of a plan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setup {
    /// What decides.
    pub planner: PlannerKind,
    /// Number of robots.
    pub robots: u8,
    /// How they are placed.
    pub place: Place,
    /// Which placing, from 0.
    pub start: u32,
    /// What carries messages.
    pub medium: MediumKind,
    /// Ticks between two exchanges.
    pub sync: u32,
    /// Share of messages lost.
    pub loss: f64,
    /// Sensor range in cells.
    pub range: u8,
    /// How the world misleads robots.
    pub trouble: Trouble,
    /// What the explorer takes its sensors for.
    pub preset: Preset,
    /// The plan's seed.
    pub seed: u64,
}

/// The name used on the command line and in tables.
impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let value = self.to_possible_value().expect("no place is hidden");
        f.write_str(value.get_name())
    }
}

impl Plan {
    /// The runs in each world.
    pub fn setups(&self) -> Vec<Setup> {
        let mut setups = Vec::new();
        for &range in &self.ranges {
            for &loss in &self.losses {
                for &sync in &self.syncs {
                    for &robots in &self.robots {
                        for start in 0..self.starts {
                            setups.extend(self.planners.iter().map(|&planner| Setup {
                                planner,
                                robots,
                                place: self.place,
                                start,
                                medium: self.medium,
                                sync,
                                loss,
                                range,
                                trouble: self.trouble,
                                preset: self.preset,
                                seed: self.seed,
                            }));
                        }
                    }
                }
            }
        }
        setups
    }

    /// Number of runs.
    pub fn runs(&self) -> usize {
        self.sites.len() * self.setups().len()
    }
}

impl Site {
    /// The world.
    ///
    /// # Errors
    /// A recipe out of range.
    pub fn world(&self) -> Result<Arc<World>, WorldError> {
        match self {
            Self::Generated(recipe) => recipe.generate().map(Arc::new),
            Self::Given(world) => Ok(world.clone()),
        }
    }

    /// Name of the world.
    pub fn name(&self) -> String {
        match self {
            Self::Generated(recipe) => format!("{}-{}", recipe.family, recipe.seed),
            Self::Given(world) => world.name().into(),
        }
    }

    /// Worlds of the same family are told together.
    pub fn family(&self) -> String {
        match self {
            Self::Generated(recipe) => recipe.family.to_string(),
            Self::Given(world) => world.name().into(),
        }
    }

    pub(super) fn extent(&self) -> planner_core::Extent {
        match self {
            Self::Generated(recipe) => recipe.extent,
            Self::Given(world) => world.extent(),
        }
    }
}

impl Setup {
    /// What is to be run in `world`.
    ///
    /// # Errors
    /// Starts that the world does not have.
    pub fn scenario(&self, world: &Arc<World>) -> Result<Scenario, WorldError> {
        let mut scenario = Scenario::new(world.clone(), self.starts(world)?, self.planner);
        scenario.range = self.range;
        scenario.conditions.medium = self.medium;
        scenario.conditions.sync = self.sync;
        scenario.conditions.loss = self.loss;
        scenario.conditions.trouble = self.trouble;
        if self.planner.weighs_looks() {
            scenario.conditions.preset = self.preset;
        }
        scenario.conditions.seed = self.seed + u64::from(self.start);
        Ok(scenario)
    }

    fn starts(&self, world: &World) -> Result<Vec<Cell>, WorldError> {
        let drawn = self.seed + u64::from(self.start);
        let starts = match self.place {
            Place::Random => Starts::Random(drawn),
            Place::Spread => Starts::Spread(drawn),
            Place::Center => self.beside(world, Starts::Center)?,
            Place::Corner => self.beside(world, Starts::Corner)?,
            Place::Map => self.beside(world, world.default_starts())?,
            Place::Scattered => {
                let robots = 0..u64::from(self.robots);
                let cells = robots
                    .map(|robot| world.place(1, &Starts::Random((drawn << 8) + robot), false));
                return Ok(cells.collect::<Result<Vec<_>, _>>()?.concat());
            }
        };
        world.place(self.robots.into(), &starts, false)
    }

    /// The first placing is at `starts`, each further one on the next cell from
    /// there.
    fn beside(&self, world: &World, starts: Starts) -> Result<Starts, WorldError> {
        if self.start == 0 {
            return Ok(starts);
        }
        let first = world.place(1, &starts, false)?;
        let mut cells: Vec<Cell> = world.reachable(&first).cells().collect();
        cells.sort_by_key(|cell| (cell.distance_squared(first[0]), cell.y, cell.x));
        Ok(Starts::At(vec![cells[self.start as usize % cells.len()]]))
    }
}
