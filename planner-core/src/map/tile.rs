//! What is known of one tile of the grid.

/// What is known of 8×8 cells. A cell is unknown, free, visited or an obstacle, in
/// this order, and of two opinions the later in the order wins: merging is a
/// maximum, hence commutative, associative, idempotent, and it only ever adds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Tile {
    /// Cells seen by anybody.
    pub known: u64,
    /// Cells seen blocked by anybody.
    pub obstacle: u64,
    /// Cells that anybody has stood on and nobody has seen blocked.
    pub visited: u64,
}

impl Tile {
    /// Beyond the edge of the map: obstacles.
    pub const OUTSIDE: Self = Self {
        known: u64::MAX,
        obstacle: u64::MAX,
        visited: 0,
    };

    /// Nothing known yet.
    pub const UNKNOWN: Self = Self {
        known: 0,
        obstacle: 0,
        visited: 0,
    };

    /// Cells known and not blocked.
    pub const fn free(self) -> u64 {
        self.known & !self.obstacle
    }

    /// The later opinion of the two for every cell. What is visited or an
    /// obstacle counts as known, and an obstacle not as visited.
    #[must_use]
    pub const fn joined(self, other: Self) -> Self {
        let obstacle = self.obstacle | other.obstacle;
        let visited = (self.visited | other.visited) & !obstacle;
        Self {
            known: self.known | other.known | visited | obstacle,
            obstacle,
            visited,
        }
    }
}
