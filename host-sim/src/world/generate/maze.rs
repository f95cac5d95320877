//! Mazes: a lattice of junctions, joined by corridors.

use planner_core::{Cell, Direction, Extent};

use super::super::grid::Grid;
use crate::dice::Dice;

/// A maze inside a wall, carved by a random depth-first walk. Corridors are
/// `corridor` cells wide and walls one; columns and rows that are left over on
/// the right and at the bottom stay filled. Each dead end is then opened to
/// a random neighbour with a chance of `braid` per cent.
pub(super) fn maze(extent: Extent, corridor: u16, braid: u16, dice: &mut Dice) -> Grid {
    let mut maze = Maze::new(extent, corridor);
    maze.carve(dice);
    maze.open_dead_ends(braid, dice);
    maze.grid
}

struct Maze {
    grid: Grid,
    lattice: Extent,
    corridor: i16,
}

impl Maze {
    fn new(extent: Extent, corridor: u16) -> Self {
        let pitch = corridor + 1;
        Self {
            grid: Grid::filled(extent, true),
            lattice: Extent::new((extent.width - 1) / pitch, (extent.height - 1) / pitch),
            corridor: corridor as i16,
        }
    }

    /// Top left cell of a junction.
    fn corner(&self, junction: Cell) -> Cell {
        let pitch = self.corridor + 1;
        Cell::new(1 + junction.x * pitch, 1 + junction.y * pitch)
    }

    fn is_carved(&self, junction: Cell) -> bool {
        self.grid.is_free(self.corner(junction))
    }

    fn neighbours(&self, junction: Cell) -> Vec<Cell> {
        Direction::ALL
            .into_iter()
            .map(|direction| junction.step(direction))
            .filter(|&neighbour| self.lattice.contains(neighbour))
            .collect()
    }

    /// Frees the square of `junction`, moved by one cell towards `direction`
    /// if there is one: that removes the wall between it and its neighbour.
    fn free_square(&mut self, junction: Cell, towards: Option<Direction>) {
        let corner = self.corner(junction);
        let corner = towards.map_or(corner, |direction| corner.step(direction));
        for y in corner.y..corner.y + self.corridor {
            for x in corner.x..corner.x + self.corridor {
                self.grid.set_blocked(Cell::new(x, y), false);
            }
        }
    }

    /// Whether there is no wall between two neighbouring junctions.
    fn is_joined(&self, junction: Cell, neighbour: Cell) -> bool {
        let corner = self.corner(junction);
        junction.direction_to(neighbour).is_some_and(|direction| {
            let (dx, dy) = direction.delta();
            let reach = if dx + dy > 0 { self.corridor } else { 1 };
            self.grid
                .is_free(Cell::new(corner.x + dx * reach, corner.y + dy * reach))
        })
    }

    fn carve(&mut self, dice: &mut Dice) {
        let first = Cell::new(
            dice.below(self.lattice.width.into()) as i16,
            dice.below(self.lattice.height.into()) as i16,
        );
        self.free_square(first, None);
        let mut trail = vec![first];
        while let Some(&junction) = trail.last() {
            let mut fresh = self.neighbours(junction);
            fresh.retain(|&neighbour| !self.is_carved(neighbour));
            let Some(next) = dice.pick(&fresh) else {
                trail.pop();
                continue;
            };
            self.free_square(junction, junction.direction_to(next));
            self.free_square(next, None);
            trail.push(next);
        }
    }

    fn open_dead_ends(&mut self, percent: u16, dice: &mut Dice) {
        let mut junctions: Vec<Cell> = super::grid::cells(self.lattice).collect();
        dice.shuffle(&mut junctions);
        for junction in junctions {
            let (joined, walled): (Vec<_>, Vec<_>) = self
                .neighbours(junction)
                .into_iter()
                .partition(|&neighbour| self.is_joined(junction, neighbour));
            if joined.len() == 1
                && dice.chance(percent)
                && let Some(opened) = dice.pick(&walled)
            {
                self.free_square(junction, junction.direction_to(opened));
            }
        }
    }
}
