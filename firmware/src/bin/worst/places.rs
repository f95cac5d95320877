//! Places of 32×32 cells, which are as large as the explorer's window. On a larger
//! map they lie in its corner, with walls around them, so that they cost the same.

use planner_core::rng::Rng;
use planner_core::{Cell, RobotId};

/// Cells along a side, the walls included.
pub(crate) const SIDE: i16 = 32;

/// What a cell is.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Unknown,
    Free,
    Blocked,
}

/// A place, and who is where in it.
#[derive(Clone, Copy)]
pub(crate) enum Place {
    /// The longest way that fits: stairs side by side, joined at their ends. Each of
    /// its cells is a layer of its own to a wave. Both ends are frontiers, and other
    /// robots stand on them, so that the robot looks twice.
    Stairs,
    /// The same without frontiers that can be reached: the robot searches all of it.
    Enclosed,
    /// An open square with frontiers all around and the others in the middle, around
    /// the robot. In the far search their waves reach nearly everything, then all are
    /// served, and the robot's wave takes back every cell from one of many labels.
    Crowded,
    /// An open square with unknown cells here and there: fronts with frontiers and
    /// robots of all labels in every tile.
    Scattered(u8),
    /// The whole map, open, with obstacles here and there and frontiers only far away:
    /// waves of all labels run through many tiles at once.
    Wide(u8),
}

/// Wide places that are tried.
const WIDE: u8 = 16;

/// A number that a cell has in all places of this seed.
fn chance(seed: u8, Cell { x, y }: Cell) -> u32 {
    Rng::new(u64::from(seed), (x as u64) << 8 | y as u64).next_u32()
}

/// The last row of the stairs; below them, behind a wall, is a hall.
const STAIRS: i16 = 26;

/// Unknown cells that make frontiers of the two ends of the stairs.
pub(crate) const LOOSE: [Cell; 2] = [Cell::new(0, STAIRS + 1), Cell::new(SIDE - 1, 0)];

impl Place {
    /// All that are tried.
    pub(crate) fn all() -> impl Iterator<Item = Self> {
        let scattered = (0..SCATTERED).map(Self::Scattered);
        let wide = (0..WIDE).map(Self::Wide);
        [Self::Stairs, Self::Enclosed, Self::Crowded]
            .into_iter()
            .chain(scattered)
            .chain(wide)
    }

    /// What the cell is.
    pub(crate) fn kind(self, cell: Cell) -> Kind {
        let Cell { x, y } = cell;
        if let Self::Wide(seed) = self {
            let chance = chance(seed, cell);
            let is_far = cell.chebyshev(self.own()) > 20;
            return match chance {
                chance if chance % 512 == 0 && is_far => Kind::Unknown,
                chance if chance / 512 % 64 < u32::from(seed % 4) * 5 => Kind::Blocked,
                _ => Kind::Free,
            };
        }
        if x >= SIDE || y >= SIDE {
            return Kind::Unknown;
        }
        match self {
            Self::Stairs if LOOSE.contains(&cell) => return Kind::Unknown,
            // Frontiers of a chamber without a door.
            Self::Enclosed if cell == Cell::new(SIDE - 2, SIDE - 3) => return Kind::Unknown,
            _ => {}
        }
        if x == SIDE - 1 || y == SIDE - 1 {
            return Kind::Blocked;
        }
        if let Self::Crowded = self {
            let border = [0, SIDE - 2];
            let is_loose =
                (border.contains(&x) && y % 3 == 0) || (border.contains(&y) && x % 3 == 0);
            return if is_loose { Kind::Unknown } else { Kind::Free };
        }
        let is_free = match self {
            Self::Scattered(seed) => {
                let chance = chance(seed, cell);
                // Ever more unknown cells, and ever more obstacles.
                let (unknown, blocked) = (1 + u32::from(seed % 5), u32::from(seed / 5 % 5) * 4);
                return match chance % 64 {
                    chance if chance < unknown => Kind::Unknown,
                    chance if chance < unknown + blocked => Kind::Blocked,
                    _ => Kind::Free,
                };
            }
            Self::Crowded | Self::Wide(_) => true,
            _ if y > STAIRS => y > STAIRS + 1 && x > 1 && x != SIDE - 3,
            _ => is_stair(cell),
        };
        if is_free { Kind::Free } else { Kind::Blocked }
    }

    /// The number of the robot. Whoever has a lower one wins ties.
    pub(crate) fn id(self) -> RobotId {
        match self {
            Self::Scattered(seed) if seed % 2 == 1 => RobotId(7),
            _ => RobotId(15),
        }
    }

    /// Where the robot stands: where the window is the whole place.
    pub(crate) fn own(self) -> Cell {
        if let Self::Wide(_) = self {
            return Cell::new(15, 14);
        }
        let mut cell = Cell::new(15, 14);
        while self.kind(cell) != Kind::Free {
            cell.x += 1;
        }
        cell
    }

    /// Where robot `number` of the others stands.
    pub(crate) fn other(self, number: u8) -> Cell {
        let number = i16::from(number);
        match self {
            Self::Stairs if number == 0 => Cell::new(0, STAIRS),
            Self::Stairs if number == 1 => Cell::new(SIDE - 2, 0),
            Self::Stairs | Self::Enclosed => Cell::new(2 + number, SIDE - 2),
            Self::Wide(seed) => {
                let step = 2 + i16::from(seed / 4);
                Cell::new(step * (1 + number % 4), step * (1 + number / 4))
            }
            Self::Crowded => Cell::new(11 + 3 * (number % 4), 10 + 3 * (number / 4)),
            Self::Scattered(_) => {
                let mut cell = Cell::new(3 + 7 * (number % 4), 3 + 7 * (number / 4));
                while self.kind(cell) != Kind::Free {
                    cell.x += 1;
                }
                cell
            }
        }
    }
}

/// Scattered places that are tried.
const SCATTERED: u8 = 160;

fn is_stair(cell: Cell) -> bool {
    let diagonal = cell.x - cell.y;
    if diagonal.rem_euclid(3) != 2 {
        return true;
    }
    // The wall between two stairs has its door at one end or the other, in turn.
    let (first, last) = (diagonal.max(0), (STAIRS + diagonal).min(SIDE - 2));
    cell.x
        == if diagonal.rem_euclid(6) == 2 {
            first
        } else {
            last
        }
}
