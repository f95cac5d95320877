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

/// The [`Level`]s of 8×8 cells.
///
/// Three words, laid out for what is read most: which cells are free, which levels are 4
/// and above, and a third bit that tells the rest apart.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Tile {
    free: u64,
    high: u64,
    rest: u64,
}

impl Tile {
    /// Beyond the edge of the map: walls.
    pub const OUTSIDE: Self = Self::seen(0, u64::MAX);

    /// Nothing known yet.
    pub const UNKNOWN: Self = Self::from_planes([0; 3]);

    /// From the bits of the levels: the words of bit 0, 1 and 2.
    pub const fn from_planes([low, mid, high]: [u64; 3]) -> Self {
        // Below 4, bit 1 says free; from 4 on, bit 0 does.
        let swapped = (low ^ mid) & high;
        Self {
            free: mid ^ swapped,
            high,
            rest: low ^ swapped,
        }
    }

    /// The bits of the levels: the words of bit 0, 1 and 2.
    pub const fn planes(self) -> [u64; 3] {
        let swapped = (self.free ^ self.rest) & self.high;
        [self.rest ^ swapped, self.free ^ swapped, self.high]
    }

    /// Cells that are free and cells that are walls; what is both is a wall.
    pub const fn seen(free: u64, obstacle: u64) -> Self {
        Self {
            free: free & !obstacle,
            high: obstacle,
            rest: 0,
        }
    }

    /// With these cells at that level, whatever they were.
    #[must_use]
    pub const fn with(self, cells: u64, level: Level) -> Self {
        let (free, high, rest) = level.bits();
        Self {
            free: set(self.free, cells, free),
            high: set(self.high, cells, high),
            rest: set(self.rest, cells, rest),
        }
    }

    /// Only these cells; the others are unknown.
    #[must_use]
    pub const fn only(self, cells: u64) -> Self {
        Self {
            free: self.free & cells,
            high: self.high & cells,
            rest: self.rest & cells,
        }
    }

    /// The cells at a level.
    pub const fn at(self, level: Level) -> u64 {
        let (free, high, rest) = level.bits();
        same(self.free, free) & same(self.high, high) & same(self.rest, rest)
    }

    /// The level of the cell with this bit number.
    pub fn level(self, bit: u32) -> Level {
        let bit = |word: u64| (word >> (bit & 63) & 1) as usize;
        let [low, mid, high] = self.planes();
        let level = bit(low) | bit(mid) << 1 | bit(high) << 2;
        Level::ALL.get(level).copied().unwrap_or_default()
    }

    /// Cells known: free or walls. Doubtful ones are not.
    pub const fn known(self) -> u64 {
        self.free | self.high
    }

    /// Cells known to be free.
    pub const fn free(self) -> u64 {
        self.free
    }

    /// Cells known to be walls.
    pub const fn obstacle(self) -> u64 {
        self.high & !self.free
    }

    /// Free cells on which somebody has stood, or that were taken for walls before.
    pub const fn visited(self) -> u64 {
        self.free & (self.high | self.rest)
    }

    /// Cells seen blocked, but not often enough to believe it.
    pub const fn doubtful(self) -> u64 {
        self.rest & !self.known()
    }

    /// Cells of level 4 and above.
    pub(crate) const fn high(self) -> u64 {
        self.high
    }

    /// The later level of the two for every cell.
    #[must_use]
    pub const fn joined(self, other: Self) -> Self {
        let ([a_low, a_mid, a_high], [b_low, b_mid, b_high]) = (self.planes(), other.planes());
        let above = a_low & !b_low;
        let above = a_mid & !b_mid | !(a_mid ^ b_mid) & above;
        let above = a_high & !b_high | !(a_high ^ b_high) & above;
        Self {
            free: self.free & above | other.free & !above,
            high: a_high | b_high,
            rest: self.rest & above | other.rest & !above,
        }
    }
}

impl Level {
    /// The bits of a tile's three words.
    const fn bits(self) -> (bool, bool, bool) {
        let level = self as u8;
        let (low, mid, high) = (level & 1 != 0, level & 2 != 0, level & 4 != 0);
        if high {
            (low, high, mid)
        } else {
            (mid, high, low)
        }
    }
}

const fn set(word: u64, cells: u64, bit: bool) -> u64 {
    if bit { word | cells } else { word & !cells }
}

const fn same(word: u64, bit: bool) -> u64 {
    if bit { word } else { !word }
}
