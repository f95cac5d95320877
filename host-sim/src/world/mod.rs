//! The world that robots explore: cells that are free or blocked.
//!
//! A [`World`] comes from a file ([`World::read`]: PNG, PGM, ROS map_server
//! YAML, MovingAI, plain text), from a seed ([`generate`]) or from a closure
//! ([`World::from_fn`]). It has at least one free cell and fits the largest
//! compiled map, [`LARGEST`]; whatever breaks that is a [`WorldError`].

mod error;
pub(crate) mod foreign;
mod generate;
mod grid;
mod known;
mod movingai;
mod raster;
mod reach;
mod read;
mod ros;
mod starts;
mod text;
mod write;

use std::fmt;

use planner_core::{Cell, Extent};

pub use error::{Problem, WorldError};
pub use generate::{Family, Recipe, generate, paper};
pub use grid::LARGEST;
pub(crate) use grid::{cells, index};
pub use known::KnownMap;
pub use reach::Reachable;
pub use read::{ReadOptions, Scale};
pub use starts::Starts;

use grid::Grid;

/// A world: a grid of free and blocked cells. Outside everything is blocked.
#[derive(Clone, PartialEq)]
pub struct World {
    name: String,
    grid: Grid,
    starts: Vec<Cell>,
    metres_per_cell: Option<f64>,
    /// Pose of the lower left corner: metres and radians.
    origin: [f64; 3],
    notes: Vec<String>,
}

impl World {
    /// A world in which `blocked` tells the obstacles; asked once for each
    /// cell, in reading order.
    ///
    /// # Errors
    /// An extent beyond [`LARGEST`]; no free cell.
    pub fn from_fn(
        name: impl Into<String>,
        extent: Extent,
        blocked: impl FnMut(Cell) -> bool,
    ) -> Result<Self, WorldError> {
        let name = name.into();
        let (width, height) = (extent.width.into(), extent.height.into());
        grid::checked_extent(width, height, || "use a smaller extent".into())
            .map(|extent| Grid::from_fn(extent, blocked))
            .and_then(|grid| Self::from_grid(&name, grid))
            .map_err(|problem| problem.of(name))
    }

    fn from_grid(name: &str, grid: Grid) -> Result<Self, Problem> {
        if grid.extent().cells() == 0 {
            return Err(Problem::Empty);
        }
        if grid.free_cells().next().is_none() {
            return Err(Problem::NoFreeCell);
        }
        Ok(Self {
            name: name.into(),
            grid,
            starts: Vec::new(),
            metres_per_cell: None,
            origin: [0.0; 3],
            notes: Vec::new(),
        })
    }

    /// This world with these starts in place of those it had.
    ///
    /// # Errors
    /// A start outside the map or on an obstacle.
    pub fn with_starts(mut self, starts: Vec<Cell>) -> Result<Self, WorldError> {
        let robots = starts.len();
        self.starts = self.place(robots, &Starts::At(starts), false)?;
        Ok(self)
    }

    /// Short name: the file's name without its ending, or what made the world.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Width and height in cells.
    pub fn extent(&self) -> Extent {
        self.grid.extent()
    }

    /// Whether a robot can be in `cell`; false outside.
    pub fn is_free(&self, cell: Cell) -> bool {
        self.grid.is_free(cell)
    }

    /// Every free cell in reading order, reachable or not.
    pub fn free_cells(&self) -> impl Iterator<Item = Cell> + '_ {
        self.grid.free_cells()
    }

    /// Starts that the map itself names (digits in a text map), in order.
    pub fn starts(&self) -> &[Cell] {
        &self.starts
    }

    /// Side of a cell in metres, if the map says so.
    pub fn metres_per_cell(&self) -> Option<f64> {
        self.metres_per_cell
    }

    /// The pose of its lower left corner in its own frame: x, y and yaw in metres and radians,
    /// x to the right, y up, angles counter-clockwise. All 0 unless the map says so.
    pub fn origin(&self) -> [f64; 3] {
        self.origin
    }

    /// The cell at a place in that frame, on the map or not; on a border, the one to the
    /// right, or above. `None`: the map does not say how wide its cells are.
    pub fn cell_at(&self, x: f64, y: f64) -> Option<Cell> {
        let side = self.metres_per_cell?;
        let [left, low, yaw] = self.origin;
        let (sin, cos) = libm::sincos(-yaw);
        let (dx, dy) = (x - left, y - low);
        let column = libm::floor((dx * cos - dy * sin) / side);
        let row = libm::floor((dx * sin + dy * cos) / side);
        let whole = |number: f64| number.is_finite().then_some(number as i16);
        let top = self.extent().height as i16 - 1;
        Some(Cell::new(whole(column)?, top.saturating_sub(whole(row)?)))
    }

    /// What the user should be told about how the file was read, for example
    /// that a size was rounded. Empty if all is as asked.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }
}

/// The map as text, one line a row.
impl fmt::Debug for World {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}\n{}", self.name, self.extent(), self.to_text())
    }
}

#[cfg(test)]
mod tests;
