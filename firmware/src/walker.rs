//! Stand-in for the explorer: walks to the nearest frontier by waves over the
//! whole map. Unbounded work; never on a robot.

use planner_core::map::ExtentError;
use planner_core::{
    Action, Activity, Cell, Direction, Extent, Learnt, Map, Motion, Planner, RobotId, Sighting,
    Status, Stop, TileSet,
};

/// Largest map, in cells along one side.
const SIDE: usize = 64;

/// The stand-in.
pub struct Walker<const TW: usize, const TH: usize> {
    map: Map<TW, TH>,
    wave: [[u16; SIDE]; SIDE],
    position: Cell,
    next: Cell,
}

impl<const TW: usize, const TH: usize> Walker<TW, TH> {
    /// All zero.
    pub const fn vacant() -> Self {
        Self {
            map: Map::vacant(),
            wave: [[0; SIDE]; SIDE],
            position: Cell::new(0, 0),
            next: Cell::new(0, 0),
        }
    }

    /// Begins a new exploration.
    ///
    /// # Errors
    /// As [`Map::reset`].
    pub fn reset(&mut self, extent: Extent, start: Cell) -> Result<(), ExtentError> {
        self.position = start;
        self.next = start;
        self.map.reset(extent)
    }

    /// One more than the distance to a frontier; zero where none is known.
    fn wave(&self, cell: Cell) -> u16 {
        let row = self.wave.get(usize::from(cell.y as u16));
        *row.and_then(|row| row.get(usize::from(cell.x as u16)))
            .unwrap_or(&0)
    }
}

impl<const TW: usize, const TH: usize> Planner<TW, TH> for Walker<TW, TH> {
    fn observe(&mut self, sighting: &Sighting) -> Learnt {
        self.map.visit(self.position);
        self.map.observe(sighting)
    }

    fn tick(&mut self) -> Action {
        self.wave = [[0; SIDE]; SIDE];
        let extent = self.map.extent();
        for level in 1.. {
            let mut grown = false;
            for y in 0..extent.height as i16 {
                for x in 0..extent.width as i16 {
                    let cell = Cell::new(x, y);
                    let reached = self.map.is_frontier(cell)
                        || Direction::ALL
                            .iter()
                            .any(|&to| level > 1 && self.wave(cell.step(to)) == level - 1);
                    if reached && self.wave(cell) == 0 && self.map.is_free(cell) {
                        self.wave[y as usize][x as usize] = level;
                        grown = true;
                    }
                }
            }
            if !grown || self.wave(self.position) != 0 {
                break;
            }
        }
        let here = self.wave(self.position);
        let down = Direction::ALL.into_iter().find(|&to| {
            let wave = self.wave(self.position.step(to));
            wave != 0 && wave < here
        });
        match down {
            Some(direction) => {
                self.next = self.position.step(direction);
                Action::Move(direction)
            }
            None if here == 0 => Action::Stop(Stop::Complete),
            None => Action::Wait,
        }
    }

    fn report(&mut self, motion: Motion) {
        if motion == Motion::Moved {
            self.position = self.next;
        }
    }

    fn map(&self) -> &Map<TW, TH> {
        &self.map
    }

    fn status(&self) -> Status {
        Status {
            position: self.position,
            goal: None,
            activity: Activity::Exploring,
        }
    }

    fn take_changed(&mut self) -> TileSet<TH> {
        self.map.take_changed()
    }

    fn join(&mut self, other: &Map<TW, TH>, tiles: &TileSet<TH>) -> Learnt {
        self.map.join_tiles(other, tiles)
    }

    fn hear(&mut self, _: RobotId, _: Status) {}

    fn work(&self) -> u32 {
        0
    }
}
