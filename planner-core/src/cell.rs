//! Cells, directions and the extent of a grid.
//!
//! Coordinates are in cells; `x` grows to the east (right), `y` to the south
//! (down), as in an image. Metres exist only at the edge of the system.

use core::fmt;

/// One cell of the occupancy grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Cell {
    /// Column, growing to the east.
    pub x: i16,
    /// Row, growing to the south.
    pub y: i16,
}

impl Cell {
    /// The cell at column `x`, row `y`.
    pub const fn new(x: i16, y: i16) -> Self {
        Self { x, y }
    }

    /// The neighbour in `direction`; saturates at the limits of `i16`.
    pub const fn step(self, direction: Direction) -> Self {
        let (dx, dy) = direction.delta();
        Self {
            x: self.x.saturating_add(dx),
            y: self.y.saturating_add(dy),
        }
    }

    /// Squared Euclidean distance.
    pub const fn distance_squared(self, other: Self) -> u32 {
        let dx = self.x.abs_diff(other.x) as u32;
        let dy = self.y.abs_diff(other.y) as u32;
        dx.saturating_mul(dx).saturating_add(dy.saturating_mul(dy))
    }

    /// Chebyshev distance: the larger of the two coordinate differences.
    pub const fn chebyshev(self, other: Self) -> u16 {
        let dx = self.x.abs_diff(other.x);
        let dy = self.y.abs_diff(other.y);
        if dx > dy { dx } else { dy }
    }

    /// The direction from here to `other` if it is one of the four neighbours.
    pub fn direction_to(self, other: Self) -> Option<Direction> {
        Direction::ALL
            .into_iter()
            .find(|&direction| self.step(direction) == other)
    }
}

impl fmt::Display for Cell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{},{}", self.x, self.y)
    }
}

/// One of the four steps that a robot can make.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[repr(u8)]
pub enum Direction {
    /// `x + 1`
    East = 0,
    /// `y + 1`
    South = 1,
    /// `x - 1`
    West = 2,
    /// `y - 1`
    North = 3,
}

impl Direction {
    /// All four, in the order in which ties are broken.
    pub const ALL: [Self; 4] = [Self::East, Self::South, Self::West, Self::North];

    /// The step as `(dx, dy)`.
    pub const fn delta(self) -> (i16, i16) {
        match self {
            Self::East => (1, 0),
            Self::South => (0, 1),
            Self::West => (-1, 0),
            Self::North => (0, -1),
        }
    }

    /// The direction with this number, modulo 4.
    pub const fn from_index(index: u8) -> Self {
        match index & 3 {
            0 => Self::East,
            1 => Self::South,
            2 => Self::West,
            _ => Self::North,
        }
    }

    /// The direction back.
    pub const fn opposite(self) -> Self {
        Self::from_index(self as u8 + 2)
    }
}

/// Width and height of a grid, in cells. Cells outside are obstacles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Extent {
    /// Number of columns.
    pub width: u16,
    /// Number of rows.
    pub height: u16,
}

impl Extent {
    /// A grid of `width` × `height` cells.
    pub const fn new(width: u16, height: u16) -> Self {
        Self { width, height }
    }

    /// Whether `cell` lies on the grid.
    pub const fn contains(self, cell: Cell) -> bool {
        cell.x >= 0 && cell.y >= 0 && (cell.x as u16) < self.width && (cell.y as u16) < self.height
    }

    /// Whether a map with room for `capacity` holds it.
    pub(crate) const fn fits(self, capacity: Self) -> Result<(), ExtentError> {
        if self.cells() == 0 {
            return Err(ExtentError::Empty);
        }
        if self.width > capacity.width || self.height > capacity.height {
            return Err(ExtentError::TooLarge {
                asked: self,
                capacity,
            });
        }
        Ok(())
    }

    /// Columns and rows of tiles that hold its cells.
    pub(crate) const fn tiles(self) -> (u8, u8) {
        (self.width.div_ceil(8) as u8, self.height.div_ceil(8) as u8)
    }

    /// Number of cells.
    pub const fn cells(self) -> u32 {
        self.width as u32 * self.height as u32
    }
}

impl fmt::Display for Extent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}×{}", self.width, self.height)
    }
}

/// A map does not hold the grid that was asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum ExtentError {
    /// A grid without cells, or a box without levels.
    Empty,
    /// The grid is larger than the map was compiled for.
    TooLarge {
        /// What was asked for.
        asked: Extent,
        /// What fits.
        capacity: Extent,
    },
    /// The box has more levels than the map was compiled for.
    TooHigh {
        /// What was asked for.
        asked: u8,
        /// What fits.
        capacity: u8,
    },
    /// The robot is to start outside of the grid.
    Start {
        /// Where it was to start.
        start: Cell,
        /// The grid.
        extent: Extent,
    },
}

impl fmt::Display for ExtentError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => write!(f, "the grid has no cells"),
            Self::TooLarge { asked, capacity } => write!(
                f,
                "a grid of {asked} cells does not fit a map compiled for {capacity}"
            ),
            Self::TooHigh { asked, capacity } => write!(
                f,
                "a box of {asked} levels does not fit a map compiled for {capacity}"
            ),
            Self::Start { start, extent } => write!(
                f,
                "the robot's start at {start} lies outside of the grid of {extent} cells"
            ),
        }
    }
}

impl core::error::Error for ExtentError {}
