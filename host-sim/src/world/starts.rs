//! Where robots stand when a run begins.

use planner_core::Cell;
use planner_core::explorer::bodies_touch;

use super::World;
use super::error::{Problem, WorldError};
use crate::dice::Dice;

/// How the robots' first cells are chosen.
///
/// `Center`, `Corner` and `Random` give one cell of the largest component, at
/// which the whole team starts together; `Spread` gives one for each robot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Starts {
    /// Robot i starts at the i-th of these cells. If there are more robots
    /// than cells, the list is gone through again; an empty list is `Center`.
    At(Vec<Cell>),
    /// Nearest to the centre of the map.
    Center,
    /// Nearest to the top left corner.
    Corner,
    /// Any cell, by this seed.
    Random(u64),
    /// The first robot anywhere, by this seed; each further one where the way to the
    /// nearest of those before is longest.
    Spread(u64),
}

impl World {
    /// Where robots start if nobody says otherwise: at the digits of the map
    /// if it has any, else in the centre.
    pub fn default_starts(&self) -> Starts {
        if self.starts().is_empty() {
            Starts::Center
        } else {
            Starts::At(self.starts().to_vec())
        }
    }

    /// One free cell for each of `robots`.
    ///
    /// Robots may share a cell, unless they are `solid`: then a robot whose
    /// cell is taken gets the nearest free one (in steps) that it can reach.
    ///
    /// # Errors
    /// A start outside the map or on an obstacle; more solid robots than cells
    /// that can be reached.
    pub fn place(
        &self,
        robots: usize,
        starts: &Starts,
        solid: bool,
    ) -> Result<Vec<Cell>, WorldError> {
        let anchors = self
            .anchors(starts, robots)
            .map_err(|problem| problem.of(self.name()))?;
        let wished = anchors.iter().copied().cycle().take(robots);
        if !solid {
            return Ok(wished.collect());
        }
        let mut taken = Vec::with_capacity(robots);
        for anchor in wished {
            let wave = self.grid.wave(&[anchor]);
            let free = wave.iter().copied().find(|cell| !taken.contains(cell));
            taken.push(free.ok_or_else(|| {
                Problem::TooManyRobots {
                    robots,
                    cells: wave.len(),
                }
                .of(self.name())
            })?);
        }
        Ok(taken)
    }

    /// As [`place`](Self::place), for robots with bodies: where a body would touch an
    /// obstacle or another one, the robot gets the nearest place (in steps) with room.
    ///
    /// # Errors
    /// A start that is named and has no room; more bodies than fit.
    pub fn place_bodies(
        &self,
        robots: usize,
        starts: &Starts,
        clearance: u8,
    ) -> Result<Vec<Cell>, WorldError> {
        let no_room = |robots| Problem::NoRoom { robots, clearance }.of(self.name());
        if let Starts::At(cells) = starts
            && let Some(&start) = cells.iter().find(|cell| !self.has_room(**cell, clearance))
        {
            self.check_start(start)
                .map_err(|problem| problem.of(self.name()))?;
            return Err(Problem::StartWithoutRoom { start, clearance }.of(self.name()));
        }
        let centres = self.centres(clearance);
        let roomy = Self::from_grid(self.name(), centres).map_err(|_| no_room(1))?;
        let mut taken: Vec<Cell> = Vec::with_capacity(robots);
        for anchor in roomy.place(robots, starts, false)? {
            let wave = roomy.grid.wave(&[anchor]);
            let is_apart =
                |cell: &Cell| taken.iter().all(|of| !bodies_touch(clearance, *cell, *of));
            let free = wave.into_iter().find(is_apart);
            taken.push(free.ok_or_else(|| no_room(robots))?);
        }
        Ok(taken)
    }

    fn anchors(&self, starts: &Starts, robots: usize) -> Result<Vec<Cell>, Problem> {
        let extent = self.extent();
        let component = || self.grid.largest_component();
        let nearest = |distance: &dyn Fn(Cell) -> u32| {
            let key = |cell: &Cell| (distance(*cell), cell.y, cell.x);
            component()
                .into_iter()
                .min_by_key(key)
                .into_iter()
                .collect()
        };
        Ok(match starts {
            Starts::At(cells) if !cells.is_empty() => {
                for &start in cells {
                    self.check_start(start)?;
                }
                cells.clone()
            }
            Starts::Center | Starts::At(_) => {
                // Doubled coordinates: the centre of an even side lies between two cells.
                let centre = Cell::new(extent.width as i16 - 1, extent.height as i16 - 1);
                nearest(&|cell| Cell::new(2 * cell.x, 2 * cell.y).distance_squared(centre))
            }
            Starts::Corner => nearest(&|cell| cell.distance_squared(Cell::new(0, 0))),
            Starts::Random(seed) => Dice::new(*seed).pick(&component()).into_iter().collect(),
            Starts::Spread(seed) => {
                let first = Dice::new(*seed).pick(&component());
                let mut cells: Vec<Cell> = first.into_iter().collect();
                while cells.len() < robots {
                    cells.extend(self.grid.wave(&cells).pop());
                }
                cells
            }
        })
    }

    fn check_start(&self, start: Cell) -> Result<(), Problem> {
        let extent = self.extent();
        if !extent.contains(start) {
            Err(Problem::StartOutside { start, extent })
        } else if !self.is_free(start) {
            Err(Problem::StartOnObstacle {
                start,
                nearest: self.nearest_free(start),
            })
        } else {
            Ok(())
        }
    }
}
