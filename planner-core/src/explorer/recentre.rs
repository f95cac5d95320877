//! A place that is larger than the map: the grid moves on by whole tiles.

use super::Explorer;
use crate::cell::Cell;
use crate::map::Tile;
use crate::radio::LinkConfig;
use crate::role::Role;
use crate::tile::{TILE, TileIndex};

/// Moves of the grid between two stops, at most: so the robot stops however it is moved.
pub const MOST_MOVES: u8 = 16;

/// Why the grid was not moved; nothing has changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum MoveError {
    /// The robot stands on this cell, which the grid would not hold any more.
    Robot(Cell),
    /// Nor its home; see [`Explorer::settle`].
    Home(Cell),
    /// The robot keeps out of cells of this grid: call
    /// [`keep_out`](crate::Errands::keep_out) without any before, and with those of the new
    /// grid afterwards.
    KeptOut,
    /// It was moved 16 times since the last stop.
    TooOften,
    /// The corner of the grid would lie 2³¹ millimetres or more from the origin.
    TooFar,
}

impl core::fmt::Display for MoveError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Robot(at) => write!(f, "the robot's cell {at} would fall off the grid"),
            Self::Home(at) => write!(f, "the robot's home {at} would fall off the grid"),
            Self::KeptOut => write!(f, "the robot keeps out of cells of the present grid"),
            Self::TooOften => write!(f, "the grid was moved {MOST_MOVES} times without a stop"),
            Self::TooFar => write!(f, "the grid would lie too far from the origin"),
        }
    }
}

impl core::error::Error for MoveError {}

impl<const TW: usize, const TH: usize> Explorer<TW, TH> {
    /// Moves the grid by so many tiles of 8 cells to the east and to the south: every cell is
    /// called by a number 8 less for each. The robot goes on from a stop. First `fallen` is
    /// given what falls off, by the old tiles: for flash, or for a radio to a base. What comes
    /// in is unknown.
    ///
    /// "Complete" is said of the present grid: what fell off was known so far as `fallen` was
    /// told. A [stop](crate::Stop) with free cells on the edge asks for a move.
    ///
    /// The grid has another id now ([`LinkConfig::origin_mm`] moves along), and robots
    /// understand each other on the same grid alone: a fleet moves by agreement, every robot
    /// by the same tiles. Until all have, they do not hear each other, and nothing is lost but
    /// time. As after [`restore`](crate::Persist::restore), plan, hints, votes and what is set
    /// aside are gone. Work: every tile, with its neighbours: not for every tick.
    ///
    /// # Errors
    /// See [`MoveError`]; then nothing has changed, and nothing was given to `fallen`.
    pub fn recentre(
        &mut self,
        columns: i8,
        rows: i8,
        fallen: impl FnMut(TileIndex, Tile),
    ) -> Result<(), MoveError> {
        let map = &self.around.map;
        let extent = map.extent();
        let tile = TILE as i16;
        let (dx, dy) = (i16::from(columns) * tile, i16::from(rows) * tile);
        let moved = |cell: Cell| Cell::new(cell.x.saturating_sub(dx), cell.y.saturating_sub(dy));
        let (position, home) = (moved(self.around.position), moved(self.role.home));
        let moves = match self.role.has_stopped() {
            true => 0,
            false => self.moves,
        };
        if !extent.contains(position) {
            return Err(MoveError::Robot(self.around.position));
        }
        if !extent.contains(home) {
            return Err(MoveError::Home(self.role.home));
        }
        if map.kept_out_cells().is_some() {
            return Err(MoveError::KeptOut);
        }
        if moves >= MOST_MOVES {
            return Err(MoveError::TooOften);
        }
        let link = moved_link(self.config.link, (dx, dy)).ok_or(MoveError::TooFar)?;
        self.config.link = link;
        self.around.map.shift(columns, rows, fallen);
        let (rank, budget, now) = (self.role.rank, self.budget, self.around.now);
        let (sequence, heard) = (self.link.sequence(), self.link.hearsay().cells);
        self.start(self.config, self.id, position);
        self.role = Role::new(rank, home);
        self.link.restore(sequence, heard);
        self.budget = budget;
        self.budget.doubt();
        self.around.now = now;
        self.moves = moves + 1;
        Ok(())
    }

    /// From now on the robot's home is where it stands.
    pub fn settle(&mut self) {
        self.role.home = self.around.position;
        self.budget.doubt();
    }
}

/// The same on a grid whose corner lies so many cells to the east and south.
fn moved_link(link: LinkConfig, (dx, dy): (i16, i16)) -> Option<LinkConfig> {
    let (east, north) = link.origin_mm;
    let cell = i32::from(link.cell_mm);
    let origin_mm = (
        east.checked_add(i32::from(dx).checked_mul(cell)?)?,
        north.checked_sub(i32::from(dy).checked_mul(cell)?)?,
    );
    Some(LinkConfig { origin_mm, ..link })
}

#[cfg(test)]
mod tests;
