//! Four maps in the spirit of figure 4 of Gauville & Charpillet 2019, and a maze
//! for the MinPos slides; only pictures of them were published. Ten robots start together at the top left.

use planner_core::{Cell, Extent};

use super::super::grid::Grid;
use super::super::{Starts, World};
use super::{maze as mazes, scatter};
use crate::dice::Dice;

const ROBOTS: usize = 10;
/// Share of the labyrinths' dead ends, in per cent, that are opened to a loop.
const OPENED: u16 = 35;

/// Labyrinth 1: corridors of 2 cells, 52×52, a third of the dead ends opened.
pub fn labyrinth1(seed: u64) -> World {
    let grid = mazes::maze(Extent::new(52, 52), 2, OPENED, &mut Dice::new(seed));
    with_starts("labyrinth1", grid)
}

/// Labyrinth 2: corridors of 5 cells, 61×61, a third of the dead ends opened.
pub fn labyrinth2(seed: u64) -> World {
    let grid = mazes::maze(Extent::new(61, 61), 5, OPENED, &mut Dice::new(seed));
    with_starts("labyrinth2", grid)
}

/// A maze in the spirit of the MinPos slides \[Bautin2011\], of which only a picture
/// was published: corridors of 3 cells, 61×61, no loop.
pub fn maze(seed: u64) -> World {
    let grid = mazes::maze(Extent::new(61, 61), 3, 0, &mut Dice::new(seed));
    with_starts("maze", grid)
}

/// Circle: a disc of radius 29 with five boxes, placed like the five of a die.
pub fn circle() -> World {
    const RADIUS: i16 = 29;
    let extent = Extent::new(2 * RADIUS as u16 + 1, 2 * RADIUS as u16 + 1);
    let centre = Cell::new(RADIUS, RADIUS);
    // r² + r, the integer below (r + ½)², rounds the rim without lone cells at the poles.
    let rim = (RADIUS * (RADIUS + 1)) as u32;
    let mut grid = Grid::from_fn(extent, |cell| cell.distance_squared(centre) > rim);
    const SIDE: u16 = 5;
    for (left, top) in [(13, 13), (41, 13), (27, 27), (13, 41), (41, 41)] {
        scatter::fill(&mut grid, left, top, SIDE, SIDE);
    }
    with_starts("circle", grid)
}

/// Blocks: 3×3 cells every 6 cells, nine by nine of them, 57×57 in all.
pub fn blocks() -> World {
    const PITCH: i16 = 6;
    let grid = Grid::from_fn(Extent::new(57, 57), |cell| {
        cell.x % PITCH >= PITCH / 2 && cell.y % PITCH >= PITCH / 2
    });
    with_starts("blocks", grid)
}

fn with_starts(name: &str, grid: Grid) -> World {
    World::from_grid(name, grid)
        .map_err(|problem| problem.of(name))
        .and_then(|world| {
            let starts = world.place(ROBOTS, &Starts::Corner, true)?;
            world.with_starts(starts)
        })
        .expect("these maps have room for their robots")
}
