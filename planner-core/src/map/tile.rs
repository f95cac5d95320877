//! What is known of one tile of the grid.

/// What is known of a cell: a chain. Of two opinions the later in the chain wins, so
/// merging is a maximum: commutative, associative, idempotent, and it only ever rises. A
/// cell that was taken for a wall can be refuted twice; then it stays passable.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[repr(u8)]
pub enum Level {
    /// Nobody has seen it.
    #[default]
    Unknown = 0,
    /// Seen blocked, but not often enough to believe it. As good as unknown.
    Doubtful = 1,
    /// Free.
    Free = 2,
    /// Free: somebody has stood on it.
    Visited = 3,
    /// A wall.
    Wall = 4,
    /// Taken for a wall, and free all the same.
    FreeAgain = 5,
    /// A wall where it was free again: something that opens and shuts.
    WallAgain = 6,
    /// Free for good: no look closes it any more.
    FreeForGood = 7,
}

impl Level {
    /// All of them, in their order.
    pub const ALL: [Self; 8] = [
        Self::Unknown,
        Self::Doubtful,
        Self::Free,
        Self::Visited,
        Self::Wall,
        Self::FreeAgain,
        Self::WallAgain,
        Self::FreeForGood,
    ];
}

/// The [`Level`]s of 8×8 cells, a bit of the level a word.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Tile {
    low: u64,
    mid: u64,
    high: u64,
}

impl Tile {
    /// Beyond the edge of the map: walls.
    pub const OUTSIDE: Self = Self::seen(0, u64::MAX);

    /// Nothing known yet.
    pub const UNKNOWN: Self = Self::from_planes([0; 3]);

    /// From the bits of the levels: the words of bit 0, 1 and 2.
    pub const fn from_planes([low, mid, high]: [u64; 3]) -> Self {
        Self { low, mid, high }
    }

    /// The bits of the levels: the words of bit 0, 1 and 2.
    pub const fn planes(self) -> [u64; 3] {
        [self.low, self.mid, self.high]
    }

    /// Cells that are free and cells that are walls; what is both is a wall.
    pub const fn seen(free: u64, obstacle: u64) -> Self {
        Self::from_planes([0, free & !obstacle, obstacle])
    }

    /// With these cells at that level, whatever they were.
    #[must_use]
    pub const fn with(self, cells: u64, level: Level) -> Self {
        let level = level as u8;
        Self {
            low: set(self.low, cells, level & 1 != 0),
            mid: set(self.mid, cells, level & 2 != 0),
            high: set(self.high, cells, level & 4 != 0),
        }
    }

    /// Only these cells; the others are unknown.
    #[must_use]
    pub const fn only(self, cells: u64) -> Self {
        Self::from_planes([self.low & cells, self.mid & cells, self.high & cells])
    }

    /// The cells at a level.
    pub const fn at(self, level: Level) -> u64 {
        let level = level as u8;
        same(self.low, level & 1 != 0)
            & same(self.mid, level & 2 != 0)
            & same(self.high, level & 4 != 0)
    }

    /// The level of the cell with this bit number.
    pub fn level(self, bit: u32) -> Level {
        let bit = |word: u64| (word >> (bit & 63) & 1) as usize;
        let level = bit(self.low) | bit(self.mid) << 1 | bit(self.high) << 2;
        Level::ALL.get(level).copied().unwrap_or_default()
    }

    /// Cells known: free or walls. Doubtful ones are not.
    pub const fn known(self) -> u64 {
        self.mid | self.high
    }

    /// Cells known to be free.
    pub const fn free(self) -> u64 {
        self.mid & !self.high | self.low & self.high
    }

    /// Cells known to be walls.
    pub const fn obstacle(self) -> u64 {
        self.high & !self.low
    }

    /// Free cells on which somebody has stood, or that were taken for walls before.
    pub const fn visited(self) -> u64 {
        self.low & self.known()
    }

    /// Cells seen blocked, but not often enough to believe it.
    pub const fn doubtful(self) -> u64 {
        self.low & !self.known()
    }

    /// The later level of the two for every cell.
    #[must_use]
    pub const fn joined(self, other: Self) -> Self {
        let above_low = self.low & !other.low;
        let above_mid = self.mid & !other.mid | !(self.mid ^ other.mid) & above_low;
        let above = self.high & !other.high | !(self.high ^ other.high) & above_mid;
        Self {
            low: self.low & above | other.low & !above,
            mid: self.mid & above | other.mid & !above,
            high: self.high | other.high,
        }
    }
}

const fn set(word: u64, cells: u64, bit: bool) -> u64 {
    if bit { word | cells } else { word & !cells }
}

const fn same(word: u64, bit: bool) -> u64 {
    if bit { word } else { !word }
}
