//! Worlds from a seed.

mod cave;
mod maze;
pub mod paper;
mod rooms;
mod scatter;

use std::fmt;

use clap::ValueEnum;
use planner_core::Extent;
use serde::{Deserialize, Serialize};

use super::World;
use super::error::{Problem, WorldError};
use super::grid::{self, Grid};
use crate::dice::Dice;

/// Least width and height of a generated world.
const SMALLEST: u16 = 5;

/// A kind of generated world.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, ValueEnum, Serialize, Deserialize,
)]
#[serde(rename_all = "kebab-case")]
pub enum Family {
    /// Corridors of one cell with exactly one way between any two cells.
    PerfectMaze,
    /// The same with every dead end opened: loops, and no dead end.
    BraidedMaze,
    /// A perfect maze whose corridors are 2 to 5 cells wide.
    WideMaze,
    /// Caverns grown by a cellular automaton.
    Cave,
    /// Rectangular rooms with doors of one cell.
    Rooms,
    /// Each cell is an obstacle by chance.
    RandomObstacles,
    /// Boxes that touch neither each other nor the border.
    IsolatedBlocks,
    /// A hall with a few pillars of one cell.
    Open,
}

impl Family {
    /// All families, in the order of their declaration.
    pub const ALL: [Self; 8] = [
        Self::PerfectMaze,
        Self::BraidedMaze,
        Self::WideMaze,
        Self::Cave,
        Self::Rooms,
        Self::RandomObstacles,
        Self::IsolatedBlocks,
        Self::Open,
    ];
}

/// The name used on the command line, for example `perfect-maze`.
impl fmt::Display for Family {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let value = self.to_possible_value().expect("no family is hidden");
        f.write_str(value.get_name())
    }
}

/// Everything that a generated world follows from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Recipe {
    /// Kind of world.
    pub family: Family,
    /// Size in cells: at least 5×5, at most [`LARGEST`](super::LARGEST).
    pub extent: Extent,
    /// Same recipe, same world, on every platform.
    pub seed: u64,
    /// Width of the corridors of a wide maze, 2 to 5 cells; drawn from the
    /// seed if not given. Other families have no use for it.
    pub corridor: Option<u16>,
    /// Share of obstacles in per cent: of random obstacles 0 to 40 (drawn from
    /// 10 to 35 if not given), of isolated blocks 0 to 40 (drawn from 10 to
    /// 25). A share that is too dense to be met is met as far as possible.
    /// Other families have no use for it.
    pub density: Option<u16>,
}

impl Recipe {
    /// A recipe that leaves all but the size and the seed to the family.
    pub fn new(family: Family, extent: Extent, seed: u64) -> Self {
        Self {
            family,
            extent,
            seed,
            corridor: None,
            density: None,
        }
    }

    /// The world. Its free cells are all connected: what the largest component
    /// does not reach is filled.
    ///
    /// # Errors
    /// A size, corridor or density outside its range.
    pub fn generate(&self) -> Result<World, WorldError> {
        let name = format!("{}-{}", self.family, self.seed);
        self.grid()
            .and_then(|grid| World::from_grid(&name, grid.only_largest_component()))
            .map_err(|problem| problem.of(name))
    }

    fn grid(&self) -> Result<Grid, Problem> {
        let extent =
            grid::checked_extent(self.extent.width.into(), self.extent.height.into(), || {
                "generate a smaller world".into()
            })?;
        if extent.width.min(extent.height) < SMALLEST {
            return Err(Problem::TooSmall {
                extent,
                smallest: SMALLEST,
            });
        }
        let corridor = in_range("corridor", self.corridor, 2, 5)?;
        let density = in_range("density", self.density, 0, 40)?;
        let mut dice = Dice::new(self.seed);
        Ok(match self.family {
            Family::PerfectMaze => maze::maze(extent, 1, 0, &mut dice),
            Family::BraidedMaze => maze::maze(extent, 1, 100, &mut dice),
            Family::WideMaze => {
                let widest = 5.min(extent.width.min(extent.height) - 2);
                let corridor = corridor.unwrap_or_else(|| dice.between(2, widest));
                maze::maze(extent, corridor.min(widest), 0, &mut dice)
            }
            Family::Cave => cave::cave(extent, &mut dice),
            Family::Rooms => rooms::rooms(extent, &mut dice),
            Family::RandomObstacles => {
                let density = density.unwrap_or_else(|| dice.between(10, 35));
                scatter::obstacles(extent, density, &mut dice)
            }
            Family::IsolatedBlocks => {
                let density = density.unwrap_or_else(|| dice.between(10, 25));
                scatter::blocks(extent, density, 4, &mut dice)
            }
            Family::Open => scatter::blocks(extent, 1, 1, &mut dice),
        })
    }
}

/// The world of [`Recipe::new`] with `width`×`height` cells.
///
/// # Errors
/// A size outside 5×5 to [`LARGEST`](super::LARGEST).
pub fn generate(family: Family, width: u16, height: u16, seed: u64) -> Result<World, WorldError> {
    Recipe::new(family, Extent::new(width, height), seed).generate()
}

fn in_range(
    name: &'static str,
    value: Option<u16>,
    lowest: u16,
    highest: u16,
) -> Result<Option<u16>, Problem> {
    match value {
        Some(found) if !(lowest..=highest).contains(&found) => Err(Problem::Parameter {
            name,
            found,
            lowest,
            highest,
        }),
        _ => Ok(value),
    }
}

#[cfg(test)]
mod tests;
