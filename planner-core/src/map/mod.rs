//! The occupancy grid: bit-packed layers over 8×8 tiles, with frontier counts
//! kept as cells become known.
//!
//! A *frontier* cell is known, free, and has an unknown 4-neighbour
//! \[Yamauchi1997\]. Cells beyond the extent count as known obstacles, so the map
//! has no special edge; so do cells that the robot keeps out of.

mod cell_set;
mod shut;
mod tile;

use core::fmt;

pub use cell_set::CellSet;
pub use shut::{MOST_PLACES, Shut};
pub use tile::{Level, Tile};

use crate::cell::{Cell, Direction, Extent, ExtentError};
use crate::sight::Sighting;
use crate::tile::{
    MOST_TILES, TILE, TileIndex, TileSet, Tiles, bits, carried, every_tile, neighbours,
};

/// What a map learnt from a sighting, a tile or another map.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Learnt {
    /// Cells that became known.
    pub cells: u32,
    /// Cells that had been free and became obstacles.
    pub closed: u32,
    /// Cells that had been obstacles and became free.
    pub opened: u32,
    /// Unknown cells that became doubtful.
    pub doubtful: u32,
}

impl Learnt {
    /// Whether anything changed that a decision can depend on.
    pub const fn anything(self) -> bool {
        self.cells | self.closed | self.opened | self.doubtful > 0
    }
}

impl core::ops::AddAssign for Learnt {
    fn add_assign(&mut self, other: Self) {
        self.cells += other.cells;
        self.closed += other.closed;
        self.opened += other.opened;
        self.doubtful += other.doubtful;
    }
}

/// An occupancy grid of at most `8·TW` × `8·TH` cells. `TW` and `TH`
/// are at most 64.
///
/// Memory: 24 bytes a tile for the layers, 1 for its frontier count, 8 bytes a row of
/// tiles, and 84.
#[derive(Clone)]
pub struct Map<const TW: usize, const TH: usize> {
    extent: Extent,
    tiles: Tiles<Tile, TW, TH>,
    frontier_counts: Tiles<u8, TW, TH>,
    frontiers: u32,
    unknown: u32,
    /// Free cells on the edge of the extent.
    edge: u32,
    kept_out: Option<&'static CellSet<TW, TH>>,
    shut: Shut,
    changed: TileSet<TH>,
}

/// Maps are equal that know the same.
impl<const TW: usize, const TH: usize> PartialEq for Map<TW, TH> {
    fn eq(&self, other: &Self) -> bool {
        self.extent == other.extent && self.tiles == other.tiles
    }
}

impl<const TW: usize, const TH: usize> Eq for Map<TW, TH> {}

impl<const TW: usize, const TH: usize> Default for Map<TW, TH> {
    fn default() -> Self {
        Self::vacant()
    }
}

impl<const TW: usize, const TH: usize> Map<TW, TH> {
    /// The largest grid that fits.
    pub const CAPACITY: Extent = {
        assert!(
            TW >= 1 && TW <= MOST_TILES,
            "a map has 1 to 64 columns of tiles"
        );
        assert!(
            TH >= 1 && TH <= MOST_TILES,
            "a map has 1 to 64 rows of tiles"
        );
        Extent::new((TW * TILE) as u16, (TH * TILE) as u16)
    };

    /// A map without cells: all zero, so a `static` of it lies in `.bss`. Call
    /// [`reset`](Self::reset) before use.
    pub const fn vacant() -> Self {
        Self {
            extent: Extent::new(0, 0),
            tiles: Tiles::all(Tile::UNKNOWN),
            frontier_counts: Tiles::all(0),
            frontiers: 0,
            unknown: 0,
            edge: 0,
            kept_out: None,
            shut: Shut::new(),
            changed: TileSet::new(),
        }
    }

    /// A map of `extent` with nothing known.
    ///
    /// # Errors
    /// The extent is empty or larger than [`CAPACITY`](Self::CAPACITY).
    pub fn new(extent: Extent) -> Result<Self, ExtentError> {
        let mut map = Self::vacant();
        map.reset(extent)?;
        Ok(map)
    }

    /// Forgets everything and takes a new extent, in place. Work: every tile once.
    ///
    /// # Errors
    /// As [`new`](Self::new); the map is then unchanged.
    pub fn reset(&mut self, extent: Extent) -> Result<(), ExtentError> {
        extent.fits(Self::CAPACITY)?;
        self.extent = extent;
        self.frontier_counts.fill(0);
        self.frontiers = 0;
        self.unknown = extent.cells();
        self.edge = 0;
        self.kept_out = None;
        self.shut = Shut::new();
        self.changed.clear();
        for (at, tile) in every_tile(TW, TH).zip(self.tiles.values_mut()) {
            *tile = Tile::seen(0, !at.inside(extent));
        }
        Ok(())
    }

    /// As [`reset`](Self::reset), for a robot that starts in that cell.
    ///
    /// # Errors
    /// As [`new`](Self::new), and a start outside of the extent; the map is then
    /// unchanged.
    pub fn reset_with(&mut self, extent: Extent, start: Cell) -> Result<(), ExtentError> {
        if !extent.contains(start) && extent.cells() > 0 {
            return Err(ExtentError::Start { start, extent });
        }
        self.reset(extent)
    }

    /// The grid's size in cells.
    pub const fn extent(&self) -> Extent {
        self.extent
    }

    /// Rows and columns of tiles that hold cells of the extent, as `(columns, rows)`.
    pub const fn tile_extent(&self) -> (u8, u8) {
        self.extent.tiles()
    }

    /// Number of frontier cells: zero when nothing is left to explore.
    pub const fn frontiers(&self) -> u32 {
        self.frontiers
    }

    /// Number of cells of the extent that are not known, nor kept out of. Never grows, unless
    /// the robot is told to keep out of others.
    pub const fn unknown_cells(&self) -> u32 {
        self.unknown
    }

    /// Number of known cells of the extent, and of those that the robot keeps out of.
    pub const fn known_cells(&self) -> u32 {
        self.extent.cells() - self.unknown
    }

    /// Number of known free cells on the edge of the extent: the world may go on behind
    /// them.
    pub const fn free_edge_cells(&self) -> u32 {
        self.edge
    }

    /// What was free and is a wall now.
    pub const fn shut(&self) -> &Shut {
        &self.shut
    }

    /// One tile; outside of the map, obstacles.
    pub fn tile(&self, at: TileIndex) -> Tile {
        self.tiles.get(at).copied().unwrap_or(Tile::OUTSIDE)
    }

    /// The free cells of a tile.
    pub(crate) fn free(&self, at: TileIndex) -> u64 {
        self.tiles.get(at).map_or(0, |tile| tile.free())
    }

    /// One tile without the cells beyond the extent and those that the robot keeps out of, as
    /// robots tell each other.
    pub fn tile_inside(&self, at: TileIndex) -> Tile {
        self.tile(at).only(self.inside(at))
    }

    /// The cells of a tile that the map tells of.
    #[inline]
    fn inside(&self, at: TileIndex) -> u64 {
        at.inside(self.extent) & !self.kept_out(at)
    }

    /// The cells of a tile that the robot keeps out of, see
    /// [`keep_out`](crate::Errands::keep_out).
    #[inline]
    pub fn kept_out(&self, at: TileIndex) -> u64 {
        self.kept_out.map_or(0, |cells| cells.word(at))
    }

    /// Whether the robot keeps out of the cell.
    pub fn keeps_out(&self, cell: Cell) -> bool {
        self.kept_out.is_some_and(|cells| cells.contains(cell))
    }

    /// The cells that the robot keeps out of, if it does.
    pub(crate) const fn kept_out_cells(&self) -> Option<&'static CellSet<TW, TH>> {
        self.kept_out
    }

    /// Takes what is known from a save: the tiles of the extent, row by row. What is counted
    /// is not counted before [`keep_out`](Self::keep_out).
    pub(crate) fn load(&mut self, tiles: impl Iterator<Item = Tile>, shut: Shut) {
        let (columns, rows) = self.tile_extent();
        for (at, saved) in every_tile(columns.into(), rows.into()).zip(tiles) {
            let inside = at.inside(self.extent);
            if let Some(tile) = self.tiles.get_mut(at) {
                *tile = saved.only(inside).with(!inside, Level::Wall);
            }
        }
        self.shut = shut;
    }

    /// From now on the robot keeps out of these cells, and forgets what it knows of them and
    /// of those that it kept out of before. Work: every tile, with its neighbours.
    pub(crate) fn keep_out(&mut self, cells: Option<&'static CellSet<TW, TH>>) {
        let before = core::mem::replace(&mut self.kept_out, cells);
        for at in every_tile(TW, TH) {
            let forgotten = before.map_or(0, |cells| cells.word(at));
            let kept_out = self.kept_out(at) & at.inside(self.extent);
            if let Some(tile) = self.tiles.get_mut(at) {
                let inside = forgotten & at.inside(self.extent);
                *tile = tile
                    .with(inside, Level::Unknown)
                    .with(kept_out, Level::Wall);
            }
        }
        self.count_all();
    }

    /// Moves the grid by so many tiles to the east and to the south. What falls off is given
    /// to `fallen` first, by the old tiles; what comes in is unknown. Work: every tile, with
    /// its neighbours.
    pub(crate) fn shift(&mut self, columns: i8, rows: i8, mut fallen: impl FnMut(TileIndex, Tile)) {
        let extent = self.extent;
        let moved = |at: TileIndex, columns: i16, rows: i16| {
            let x = u8::try_from(i16::from(at.x) + columns).ok()?;
            let y = u8::try_from(i16::from(at.y) + rows).ok()?;
            Some(TileIndex::new(x, y))
        };
        let (columns, rows) = (i16::from(columns), i16::from(rows));
        for at in every_tile(TW, TH) {
            let stays = moved(at, -columns, -rows).map_or(0, |to| to.inside(extent));
            let falls = self.tile_inside(at).only(!stays);
            if falls != Tile::UNKNOWN {
                fallen(at, falls);
            }
        }
        // In the order in which nothing is written before it was read.
        let order = |tiles: usize, by: i16| {
            let tiles = tiles as u8;
            (0..tiles).map(move |at| if by < 0 { tiles - 1 - at } else { at })
        };
        for (y, x) in order(TH, rows).flat_map(|y| order(TW, columns).map(move |x| (y, x))) {
            let at = TileIndex::new(x, y);
            let inside = at.inside(extent);
            let from = moved(at, columns, rows).map_or(Tile::UNKNOWN, |from| self.tile_known(from));
            if let Some(tile) = self.tiles.get_mut(at) {
                *tile = from.only(inside).with(!inside, Level::Wall);
            }
        }
        self.shut
            .shift(columns * TILE as i16, rows * TILE as i16, extent);
        self.changed.clear();
        self.count_all();
    }

    /// A tile without the cells beyond the extent; unknown outside of the map.
    fn tile_known(&self, at: TileIndex) -> Tile {
        let tile = self.tiles.get(at).copied().unwrap_or(Tile::UNKNOWN);
        tile.only(at.inside(self.extent))
    }

    /// Counts what is kept counted as cells become known.
    fn count_all(&mut self) {
        (self.unknown, self.edge) = (0, 0);
        for at in every_tile(TW, TH) {
            let tile = self.tile(at);
            self.unknown += (!tile.known()).count_ones();
            self.edge += (tile.free() & at.edge(self.extent)).count_ones();
            self.recount(at);
        }
    }

    fn bit(&self, cell: Cell, layer: impl Fn(Tile) -> u64) -> bool {
        TileIndex::of(cell).map_or(layer(Tile::OUTSIDE) != 0, |(at, bit)| {
            layer(self.tile(at)) & bit != 0
        })
    }

    /// What is known of the cell; a wall outside.
    pub fn level(&self, cell: Cell) -> Level {
        TileIndex::of(cell).map_or(Level::Wall, |(at, bit)| {
            self.tile(at).level(bit.trailing_zeros())
        })
    }

    /// Whether the cell is known to be free or an obstacle.
    pub fn is_known(&self, cell: Cell) -> bool {
        self.bit(cell, Tile::known)
    }

    /// Whether the cell is known and free.
    pub fn is_free(&self, cell: Cell) -> bool {
        self.bit(cell, Tile::free)
    }

    /// Whether the cell is known to be an obstacle, or lies outside.
    pub fn is_obstacle(&self, cell: Cell) -> bool {
        self.bit(cell, Tile::obstacle)
    }

    /// Whether the cell was seen blocked, but not often enough to believe it: it is not
    /// known, and no way leads over it.
    pub fn is_doubtful(&self, cell: Cell) -> bool {
        self.bit(cell, Tile::doubtful)
    }

    /// Whether anybody has stood on the cell, or it was refuted as a wall.
    pub fn is_visited(&self, cell: Cell) -> bool {
        self.bit(cell, Tile::visited)
    }

    /// Whether the cell is a frontier. Reads five tiles.
    pub fn is_frontier(&self, cell: Cell) -> bool {
        TileIndex::of(cell).is_some_and(|(at, bit)| self.frontier(at) & bit != 0)
    }

    /// The frontier cells of a tile. Reads five tiles, or none where the count is zero.
    pub fn frontier(&self, at: TileIndex) -> u64 {
        match self.frontier_counts.get(at) {
            None | Some(0) => 0,
            Some(_) => self.frontier_by_neighbours(at),
        }
    }

    fn frontier_by_neighbours(&self, at: TileIndex) -> u64 {
        let unknown = |at| self.tiles.get(at).map_or(0, |tile| !tile.known());
        self.free(at) & neighbours(at, unknown)
    }

    /// A robot stands on the cell: it is free, whatever the map says of it, for its own
    /// place is surer than any look. Ignored outside. Work: one tile, and its four
    /// neighbours where the map did not agree.
    pub fn stand(&mut self, cell: Cell) -> Learnt {
        match TileIndex::of(cell) {
            Some((at, bit)) if self.extent.contains(cell) => {
                let tile = self.tile(at);
                let level = match tile.level(bit.trailing_zeros()) {
                    Level::Unknown | Level::Doubtful | Level::Free | Level::Visited => {
                        Level::Visited
                    }
                    Level::Wall | Level::FreeAgain => Level::FreeAgain,
                    Level::WallAgain | Level::FreeForGood => Level::FreeForGood,
                };
                self.join_tile(at, Tile::UNKNOWN.with(bit, level))
            }
            _ => Learnt::default(),
        }
    }

    /// Takes in what was seen, at its word: the first look decides, and what was ever seen
    /// blocked is an obstacle until somebody stands on it. An
    /// [`Explorer`](crate::explorer::Explorer) weighs looks instead. Nothing is taken in where the robot stood outside of the
    /// extent, for its pose was wrong then. The robot's own cell is free, also if the map
    /// calls it an obstacle. Work: at most 25 tiles, each with its four neighbours.
    pub fn observe(&mut self, sighting: &Sighting) -> Learnt {
        let centre = sighting.centre();
        if !self.extent.contains(centre) {
            return Learnt::default();
        }
        let mut learnt = Learnt::default();
        if self.is_obstacle(centre) {
            learnt += self.stand(centre);
        }
        for at in sighting.tiles() {
            let (free, blocked) = sighting.tile(at);
            learnt += self.join_tile(at, Tile::seen(free, blocked));
        }
        learnt
    }

    /// Takes in what was seen of a tile from far away: of cells that nobody has seen, the
    /// free ones, and the blocked ones at that level. Work: the tile and its four
    /// neighbours.
    pub fn observe_far(&mut self, at: TileIndex, free: u64, blocked: u64, wall: Level) -> Learnt {
        let before = self.tile(at);
        let unseen = !(before.known() | before.doubtful());
        let free = free & !blocked & unseen;
        let seen = before.with(free, Level::Free).with(blocked & unseen, wall);
        self.join_tile(at, seen)
    }

    /// Joins another robot's tile into this map; ignored outside. Work: the tile
    /// and its four neighbours.
    pub fn join_tile(&mut self, at: TileIndex, other: Tile) -> Learnt {
        let inside = self.inside(at);
        let Some(tile) = self.tiles.get_mut(at) else {
            return Learnt::default();
        };
        let before = *tile;
        let after = before.joined(other.only(inside));
        if after == before {
            return Learnt::default();
        }
        *tile = after;
        self.changed.insert(at);
        let learnt = Learnt {
            cells: (after.known() & !before.known()).count_ones(),
            closed: (after.obstacle() & before.free()).count_ones(),
            opened: (after.free() & before.obstacle()).count_ones(),
            doubtful: (after.doubtful() & !before.doubtful()).count_ones(),
        };
        if learnt.cells | learnt.closed | learnt.opened > 0 {
            self.unknown -= learnt.cells;
            let edge = at.edge(self.extent);
            if edge != 0 {
                self.edge += (after.free() & edge).count_ones();
                self.edge -= (before.free() & edge).count_ones();
            }
            for bit in bits(after.obstacle() & before.free()) {
                self.shut.add(at.cell(bit));
            }
            for bit in bits(after.free() & before.obstacle()) {
                let was_free = before.level(bit) == Level::WallAgain;
                self.shut.remove(at.cell(bit), was_free);
            }
            self.recount(at);
            if learnt.cells > 0 {
                for direction in Direction::ALL {
                    if carried(after.known() & !before.known(), direction) != 0
                        && let Some(next) = at.neighbour(direction)
                    {
                        self.recount(next);
                    }
                }
            }
        }
        learnt
    }

    fn recount(&mut self, at: TileIndex) {
        let now = self.frontier_by_neighbours(at).count_ones() as u8;
        if let Some(count) = self.frontier_counts.get_mut(at) {
            self.frontiers = self.frontiers - u32::from(*count) + u32::from(now);
            *count = now;
        }
    }

    /// Joins everything that another map holds. Maps of different extents do not
    /// join: nothing is learnt. Work: every tile once.
    pub fn join(&mut self, other: &Self) -> Learnt {
        let mut learnt = Learnt::default();
        if self.extent == other.extent {
            for at in every_tile(TW, TH) {
                learnt += self.join_tile(at, other.tile_inside(at));
            }
        }
        learnt
    }

    /// Joins the given tiles of another map of the same extent.
    pub fn join_tiles(&mut self, other: &Self, tiles: &TileSet<TH>) -> Learnt {
        let mut learnt = Learnt::default();
        if self.extent == other.extent {
            for at in tiles.iter() {
                learnt += self.join_tile(at, other.tile_inside(at));
            }
        }
        learnt
    }

    /// The tiles that changed since the last call.
    pub fn take_changed(&mut self) -> TileSet<TH> {
        core::mem::take(&mut self.changed)
    }
}

/// The map as text: `#` obstacle, `.` free, `+` visited, `?` frontier, `!` doubtful, space
/// unknown.
impl<const TW: usize, const TH: usize> fmt::Debug for Map<TW, TH> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{} cells, {} unknown, {} frontiers",
            self.extent, self.unknown, self.frontiers
        )?;
        for y in 0..self.extent.height as i16 {
            for x in 0..self.extent.width as i16 {
                let cell = Cell::new(x, y);
                let sign = if self.is_doubtful(cell) {
                    '!'
                } else if !self.is_known(cell) {
                    ' '
                } else if self.is_obstacle(cell) {
                    '#'
                } else if self.is_frontier(cell) {
                    '?'
                } else if self.is_visited(cell) {
                    '+'
                } else {
                    '.'
                };
                write!(f, "{sign}")?;
            }
            writeln!(f)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
