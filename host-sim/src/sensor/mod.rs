//! What a robot sees from a cell, remembered for every cell of the world.

mod lines;

use std::sync::{Arc, OnceLock};

use planner_core::sight::{Look, Row};
use planner_core::tile::{TILE, TileIndex, bits};
use planner_core::{Cell, Direction, Sighting, sight};

use crate::world::World;
use lines::{Lines, Obstacles, lines};

/// The field of view of a sensor that looks all around, in degrees.
pub const ALL_AROUND: u16 = 360;

/// A disc sensor in a world: everything in line of sight within `range` cells and
/// within the field of view around the robot's heading.
///
/// The world does not change, so each cell is looked from at most once in each
/// direction; robots, runs and threads can share one sensor.
#[derive(Debug)]
pub struct Sensor {
    world: Arc<World>,
    range: u8,
    fov: u16,
    obstacles: Obstacles,
    lines: &'static Lines,
    /// One for each cell, or four: one for each heading.
    views: Vec<OnceLock<Box<View>>>,
}

/// A tile beyond [`sight::MAX_RADIUS`]: the cells seen free and blocked.
pub type FarTile = (TileIndex, u64, u64);

/// What is seen from one cell.
#[derive(Clone, Debug)]
pub struct View {
    /// What the robot is told.
    pub sighting: Sighting,
    /// What it is told beyond that: of each tile the cells free and blocked.
    pub far: Box<[FarTile]>,
    /// The cells seen free, as (tile, cells) with tiles numbered row by row.
    pub free: Box<[(usize, u64)]>,
}

impl View {
    /// The cells that are shown as they are: free ones, and obstacles of the world.
    pub fn cells(&self, world: &World) -> impl Iterator<Item = Cell> {
        let far = |cells: fn(&FarTile) -> u64| {
            let tiles = self.far.iter();
            tiles.flat_map(move |tile| bits(cells(tile)).map(|bit| tile.0.cell(bit)))
        };
        let obstacles = self.sighting.blocked_cells().chain(far(|tile| tile.2));
        let obstacles = obstacles.filter(|&cell| !world.is_free(cell));
        let free = self.sighting.free_cells().chain(far(|tile| tile.1));
        free.chain(obstacles)
    }

    /// What of it a sensor shows that shows these cells alone.
    pub(crate) fn only(&self, world: &World, shows: impl Fn(Cell) -> bool) -> Self {
        let far = self.far.iter().map(|&(at, free, blocked)| {
            let shown = bits(free | blocked).filter(|&bit| shows(at.cell(bit)));
            let shown = shown.fold(0, |cells, bit| cells | 1 << bit);
            (at, free & shown, blocked & shown)
        });
        Self::with(world, only(&self.sighting, &shows), far.collect())
    }

    pub(crate) fn new(world: &World, sighting: Sighting) -> Self {
        Self::with(world, sighting, Box::default())
    }

    fn with(world: &World, sighting: Sighting, far: Box<[FarTile]>) -> Self {
        let columns = tile_columns(world);
        let mut free: Vec<(usize, u64)> = Vec::new();
        let Cell { x, y } = sighting.centre();
        let reach = i16::from(sight::MAX_RADIUS);
        let (first, shift) = ((x - reach).div_euclid(8), (x - reach).rem_euclid(8));
        for dy in -reach..=reach {
            let row = u64::from(sighting.free_row(dy)) << shift;
            for (cells, tile) in row.to_le_bytes().into_iter().zip(first..) {
                // Free cells lie in the world.
                let (Ok(tile), Ok(row)) = (usize::try_from(tile), usize::try_from(y + dy)) else {
                    continue;
                };
                if cells == 0 {
                    continue;
                }
                let number = row / TILE * columns + tile;
                let bits = u64::from(cells) << (row % TILE * TILE);
                match free.iter_mut().find(|(known, _)| *known == number) {
                    Some((_, cells)) => *cells |= bits,
                    None => free.push((number, bits)),
                }
            }
        }
        for &(at, cells, _) in far.iter().filter(|(_, free, _)| *free != 0) {
            let number = usize::from(at.y) * columns + usize::from(at.x);
            match free.iter_mut().find(|(known, _)| *known == number) {
                Some((_, known)) => *known |= cells,
                None => free.push((number, cells)),
            }
        }
        Self {
            sighting,
            far,
            free: free.into(),
        }
    }
}

impl Sensor {
    /// A sensor of `range` cells (1 to [`sight::MAX_LONG_RADIUS`]; larger values
    /// count as that) that looks all around.
    pub fn new(world: Arc<World>, range: u8) -> Self {
        Self::with_fov(world, range, ALL_AROUND)
    }

    /// As [`new`](Self::new), with a field of view of `fov` degrees, half of it on
    /// either side of the heading: 1 shows what is straight ahead only,
    /// [`ALL_AROUND`] and more show everything.
    pub fn with_fov(world: Arc<World>, range: u8, fov: u16) -> Self {
        let cells = world.extent().cells() as usize;
        let views = if fov >= ALL_AROUND { cells } else { 4 * cells };
        Self {
            obstacles: Obstacles::of(&world),
            lines: lines(range),
            world,
            range,
            fov,
            views: (0..views).map(|_| OnceLock::new()).collect(),
        }
    }

    /// The world that is seen.
    pub fn world(&self) -> &Arc<World> {
        &self.world
    }

    /// Range in cells.
    pub fn range(&self) -> u8 {
        self.range
    }

    /// Field of view in degrees.
    pub fn fov(&self) -> u16 {
        self.fov
    }

    /// What is seen from `cell` by a robot that is turned to `heading`.
    ///
    /// # Panics
    /// If the cell lies outside of the world.
    pub fn view(&self, cell: Cell, heading: Direction) -> &View {
        let extent = self.world.extent();
        assert!(
            extent.contains(cell),
            "no robot can look from {cell}, outside of {extent}"
        );
        let index = cell.y as usize * usize::from(extent.width) + cell.x as usize;
        let index = match self.fov {
            ALL_AROUND.. => index,
            _ => 4 * index + heading as usize,
        };
        self.views[index].get_or_init(|| Box::new(self.look(cell, heading, &[])))
    }

    /// As [`view`](Self::view), in a world where these cells are blocked too. Looks anew
    /// each time.
    pub(crate) fn view_past(&self, cell: Cell, heading: Direction, blocked: &[Cell]) -> View {
        self.look(cell, heading, blocked)
    }

    fn look(&self, cell: Cell, heading: Direction, blocked: &[Cell]) -> View {
        let all = self.lines.look(&self.obstacles, cell, blocked);
        let shown = match self.fov {
            ALL_AROUND.. => all,
            fov => only(&all, |seen| {
                let (dx, dy) = (seen.x - cell.x, seen.y - cell.y);
                is_in_sector((dx, dy), heading, fov)
            }),
        };
        let far = match self.range {
            ..=sight::MAX_RADIUS => Box::default(),
            _ => shown.far_tiles().collect(),
        };
        View::with(&self.world, shown.near(), far)
    }
}

/// The cells of a look for which `shows` holds, and the robot's own.
fn only<R: Row, const SPAN: usize>(
    sighting: &Look<R, SPAN>,
    shows: impl Fn(Cell) -> bool,
) -> Look<R, SPAN> {
    let mut shown = Look::new(sighting.centre());
    sighting
        .free_cells()
        .filter(|&cell| shows(cell))
        .for_each(|cell| shown.see_free(cell));
    sighting
        .blocked_cells()
        .filter(|&cell| shows(cell))
        .for_each(|cell| shown.see_blocked(cell));
    shown
}

/// Whether the middle of the cell at `(dx, dy)` lies within `fov` degrees around
/// `heading`, the edges included.
fn is_in_sector((dx, dy): (i16, i16), heading: Direction, fov: u16) -> bool {
    let (ahead, aside) = turned((dx, dy), heading);
    // Rounding decides nothing: a test has every angle on the edge, or far from it.
    angle(ahead, aside) <= f64::from(fov) / 2.0 + 1e-9
}

/// Cells ahead and to the right of a robot that is turned to `heading`.
fn turned((dx, dy): (i16, i16), heading: Direction) -> (i16, i16) {
    let (x, y) = heading.delta();
    (dx * x + dy * y, dy * x - dx * y)
}

/// Degrees between straight ahead and a cell, 0 to 180.
fn angle(ahead: i16, aside: i16) -> f64 {
    f64::from(aside.abs()).atan2(f64::from(ahead)).to_degrees()
}

/// Tiles in a row of the world.
pub(crate) fn tile_columns(world: &World) -> usize {
    usize::from(world.extent().width).div_ceil(TILE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use planner_core::Extent;
    use planner_core::tile::TileIndex;

    #[test]
    fn a_view_is_what_the_core_sees_and_its_tiles_hold_the_same_cells() {
        let world = World::from_fn("pillars", Extent::new(19, 13), |cell| {
            cell.x % 4 == 1 && cell.y % 3 == 1
        })
        .unwrap();
        let world = Arc::new(world);
        let sensor = Sensor::new(world.clone(), 6);
        for cell in world.free_cells() {
            let view = sensor.view(cell, Direction::North);
            assert_eq!(
                view.sighting,
                sight::look(cell, 6, |cell| !world.is_free(cell))
            );
            let in_tiles: u32 = view.free.iter().map(|(_, cells)| cells.count_ones()).sum();
            assert_eq!(in_tiles as usize, view.sighting.free_cells().count());
            let columns = tile_columns(&world);
            for seen in view.sighting.free_cells() {
                let (tile, bit) = TileIndex::of(seen).unwrap();
                let number = usize::from(tile.y) * columns + usize::from(tile.x);
                assert!(
                    view.free
                        .iter()
                        .any(|&(known, cells)| known == number && cells & bit != 0)
                );
            }
        }
    }

    /// What a robot in the middle of 9×9 cells sees with range 3: `.` free, `#` blocked,
    /// `R` its own cell.
    fn seen(fov: u16, heading: Direction) -> String {
        let world = World::from_fn("open", Extent::new(9, 9), |cell| {
            cell == Cell::new(6, 5) || cell == Cell::new(4, 2)
        });
        let sensor = Sensor::with_fov(Arc::new(world.unwrap()), 3, fov);
        let sighting = &sensor.view(Cell::new(4, 4), heading).sighting;
        let sign = |cell| match (sighting.is_free(cell), sighting.is_blocked(cell)) {
            _ if cell == Cell::new(4, 4) => 'R',
            (true, _) => '.',
            (_, true) => '#',
            _ => ' ',
        };
        let row = |y| (1..8).map(|x| sign(Cell::new(x, y))).collect::<String>();
        let rows = (1..8).map(|y| row(y).trim_end().to_owned() + "\n");
        rows.collect()
    }

    #[test]
    fn a_narrow_field_of_view_shows_a_sector_around_the_heading() {
        let rows = |rows: [&str; 7]| rows.join("\n") + "\n";
        // The cell at two to the east and one to the south is at 26.6°, that at one and
        // one is at 45°.
        let east = rows(["", "", "     .", "   R...", "     #", "", ""]);
        assert_eq!(seen(62, Direction::East), east);
        let east = rows(["", "     .", "    ..", "   R...", "    .#", "     .", ""]);
        assert_eq!(seen(90, Direction::East), east);
        let north = rows(["", "  .#.", "   .", "   R", "", "", ""]);
        assert_eq!(seen(62, Direction::North), north);
        let west = rows(["", " ..#", " ...", "...R", " ...", " ...", "   ."]);
        assert_eq!(seen(180, Direction::West), west);
        assert_eq!(
            seen(1, Direction::South),
            rows(["", "", "", "   R", "   .", "   .", "   ."])
        );
    }

    #[test]
    fn the_neighbour_straight_ahead_is_shown_by_every_field_of_view() {
        for fov in 1..=ALL_AROUND {
            for heading in Direction::ALL {
                for distance in 1..=15 {
                    let (x, y) = heading.delta();
                    assert!(is_in_sector((x * distance, y * distance), heading, fov));
                }
                let (x, y) = heading.delta();
                assert_eq!(is_in_sector((-x, -y), heading, fov), fov == ALL_AROUND);
            }
        }
    }

    /// So no machine's arctangent decides what is seen.
    #[test]
    fn every_cell_lies_on_the_edge_of_a_field_of_view_or_far_from_it() {
        for fov in 1..=ALL_AROUND {
            for (ahead, aside) in (-15..=15).flat_map(|x| (-15..=15).map(move |y| (x, y))) {
                let apart = (angle(ahead, aside) - f64::from(fov) / 2.0).abs();
                assert!(!(1e-11..1e-6).contains(&apart), "{fov}: {ahead}, {aside}");
            }
        }
    }
}
