//! Waves over the known free cells of a map, from every robot, step by step.

use planner_core::tile::TileIndex;
use planner_core::{Cell, Direction, Extent, Map, RobotId};

/// A cell of the padded grid of bits, as its number.
pub type Spot = u32;

/// Blocked spots before the first cell of a row; a byte, as tiles come in bytes.
const MARGIN: Spot = 8;

/// One wave for each robot, all at the same distance from where they began.
///
/// The buffers are reused from decision to decision.
#[derive(Debug, Default)]
pub struct Waves {
    grid: Grid,
    fronts: Vec<Front>,
    me: usize,
    /// For spots that the own wave has reached: the index of the step into them.
    came: Vec<u8>,
    visits: u32,
    /// The farthest that the robot has seen, in cells.
    reach: u8,
}

/// Unknown, free and frontier cells as rows of bits, with a margin of blocked cells on
/// all sides, so that the eight spots around a free one are always there.
#[derive(Debug, Default)]
struct Grid {
    stride: u32,
    /// `None` before the first map.
    extent: Option<Extent>,
    unknown: Vec<u8>,
    free: Vec<u8>,
    frontier: Vec<u8>,
}

#[derive(Debug, Default)]
struct Front {
    /// Free spots that the wave has not reached.
    todo: Vec<u8>,
    layer: Vec<Spot>,
    next: Vec<Spot>,
    /// The order in which it tries the four steps.
    steps: [(u8, i32); 4],
}

impl Waves {
    /// Takes in the map, without the `closed` cells, and starts a wave of
    /// distance 0 for each robot of `team`, which must be in the order of ids
    /// and hold `me`, which has seen `reach` cells far.
    pub fn start<const TW: usize, const TH: usize>(
        &mut self,
        map: &Map<TW, TH>,
        closed: impl Iterator<Item = Cell>,
        (me, reach): (RobotId, u8),
        team: &[(RobotId, Cell)],
    ) {
        self.grid.load(map, closed);
        self.reach = reach;
        self.me = team.iter().position(|&(id, _)| id == me).unwrap_or(0);
        self.came.resize(self.grid.free.len() * 8, 0);
        self.fronts.resize_with(team.len(), Front::default);
        self.visits = 0;
        for (front, &(id, cell)) in self.fronts.iter_mut().zip(team) {
            front.start(&self.grid, id, cell);
        }
    }

    /// Starts the wave of robot number `index` again.
    pub fn restart(&mut self, index: usize, id: RobotId, cell: Cell) {
        self.fronts[index].start(&self.grid, id, cell);
    }

    /// Number of robots.
    pub fn robots(&self) -> usize {
        self.fronts.len()
    }

    /// Which of them is the one that decides.
    pub fn me(&self) -> usize {
        self.me
    }

    /// How many cells far the one that decides has seen.
    pub fn reach(&self) -> u8 {
        self.reach
    }

    /// Cells reached since the start, by all waves.
    pub fn visits(&self) -> u32 {
        self.visits
    }

    /// The spots that wave `index` reached last, in a fixed order.
    pub fn layer(&self, index: usize) -> &[Spot] {
        &self.fronts[index].layer
    }

    /// Moves wave `index` one step on.
    pub fn advance(&mut self, index: usize) {
        let front = &mut self.fronts[index];
        if index == self.me {
            let came = &mut self.came;
            front.advance(|spot, step| came[spot as usize] = step);
        } else {
            front.advance(|_, _| ());
        }
        self.visits += front.layer.len() as u32;
    }

    /// Whether a spot is a frontier.
    pub fn is_frontier(&self, spot: Spot) -> bool {
        bit(&self.grid.frontier, spot)
    }

    /// Whether a cell of the grid is unknown.
    pub fn is_unknown(&self, cell: Cell) -> bool {
        self.grid.holds(cell) && bit(&self.grid.unknown, self.grid.spot(cell))
    }

    /// Whether a cell is a known obstacle, or outside of the grid.
    pub fn is_obstacle(&self, cell: Cell) -> bool {
        let Grid { unknown, free, .. } = &self.grid;
        !self.grid.holds(cell) || {
            let spot = self.grid.spot(cell);
            !bit(unknown, spot) && !bit(free, spot)
        }
    }

    /// All frontier spots, row by row.
    pub fn frontiers(&self) -> impl Iterator<Item = Spot> + '_ {
        let bytes = self.grid.frontier.iter().zip(0..);
        bytes.flat_map(|(&byte, at)| {
            planner_core::tile::bits(u64::from(byte)).map(move |bit| at * 8 + bit)
        })
    }

    /// The eight spots around one.
    pub fn around(&self, spot: Spot) -> [Spot; 8] {
        let stride = self.grid.stride;
        let (above, below) = (spot - stride, spot + stride);
        [
            above - 1,
            above,
            above + 1,
            spot - 1,
            spot + 1,
            below - 1,
            below,
            below + 1,
        ]
    }

    /// One more than the largest spot.
    pub fn spots(&self) -> usize {
        self.grid.free.len() * 8
    }

    /// The cell at a spot.
    pub fn cell(&self, spot: Spot) -> Cell {
        let (x, y) = (spot % self.grid.stride, spot / self.grid.stride);
        Cell::new((x - MARGIN) as i16, y as i16 - 1)
    }

    /// Writes the way from `from`, where the own wave began, to `goal`, which
    /// it has reached: goal first, `from` left out.
    pub fn way(&self, from: Cell, goal: Spot, way: &mut Vec<Cell>) {
        way.clear();
        let mut cell = self.cell(goal);
        while cell != from {
            way.push(cell);
            let step = Direction::from_index(self.came[self.grid.spot(cell) as usize]);
            cell = cell.step(step.opposite());
        }
    }
}

impl Grid {
    fn load<const TW: usize, const TH: usize>(
        &mut self,
        map: &Map<TW, TH>,
        closed: impl Iterator<Item = Cell>,
    ) {
        let (columns, rows) = map.tile_extent();
        let bytes = usize::from(columns) + 2;
        self.stride = 8 * bytes as u32;
        self.extent = Some(map.extent());
        for bits in [&mut self.unknown, &mut self.free, &mut self.frontier] {
            bits.clear();
            bits.resize(bytes * (8 * usize::from(rows) + 2), 0);
        }
        for y in 0..rows {
            for x in 0..columns {
                let at = TileIndex::new(x, y);
                let unknown = (!map.tile(at).known()).to_le_bytes();
                let free = map.tile(at).free().to_le_bytes();
                let frontier = map.frontier(at).to_le_bytes();
                let first = (8 * usize::from(y) + 1) * bytes + 1 + usize::from(x);
                for row in 0..8 {
                    self.unknown[first + row * bytes] = unknown[row];
                    self.free[first + row * bytes] = free[row];
                    self.frontier[first + row * bytes] = frontier[row];
                }
            }
        }
        for cell in closed {
            let spot = self.spot(cell);
            clear(&mut self.free, spot);
            clear(&mut self.frontier, spot);
        }
    }

    fn holds(&self, cell: Cell) -> bool {
        self.extent.is_some_and(|extent| extent.contains(cell))
    }

    fn spot(&self, cell: Cell) -> Spot {
        (cell.y + 1) as u32 * self.stride + cell.x as u32 + MARGIN
    }
}

impl Front {
    /// A wave from `cell`; none if that is not known to be free.
    fn start(&mut self, grid: &Grid, id: RobotId, cell: Cell) {
        self.todo.clone_from(&grid.free);
        self.layer.clear();
        let spot = grid.spot(cell);
        if bit(&self.todo, spot) {
            clear(&mut self.todo, spot);
            self.layer.push(spot);
        }
        let stride = grid.stride as i32;
        self.steps = steps_of(id).map(|direction| {
            let (dx, dy) = direction.delta();
            (direction as u8, i32::from(dx) + i32::from(dy) * stride)
        });
    }

    fn advance(&mut self, mut reached: impl FnMut(Spot, u8)) {
        self.next.clear();
        for &spot in &self.layer {
            for (step, offset) in self.steps {
                let to = spot.wrapping_add_signed(offset);
                if bit(&self.todo, to) {
                    clear(&mut self.todo, to);
                    self.next.push(to);
                    reached(to, step);
                }
            }
        }
        std::mem::swap(&mut self.layer, &mut self.next);
    }
}

/// The order in which a robot tries the four steps. It differs from robot to
/// robot, so that robots on one cell that follow the same rule part.
fn steps_of(id: RobotId) -> [Direction; 4] {
    let turn = if id.0 & 4 == 0 { 1 } else { 3 };
    [0, 1, 2, 3].map(|step: u8| Direction::from_index(id.0.wrapping_add(turn * step)))
}

fn bit(bits: &[u8], spot: Spot) -> bool {
    bits[spot as usize / 8] >> (spot % 8) & 1 == 1
}

fn clear(bits: &mut [u8], spot: Spot) {
    bits[spot as usize / 8] &= !(1 << (spot % 8));
}
