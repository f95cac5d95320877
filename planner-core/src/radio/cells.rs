//! The frame as bytes and as a value that can only be valid.

use heapless::Vec;

use super::check::GridId;
use super::envelope::{
    CRC, HEADER, Header, MAX_LEN, Sealed, TAG, Writer, optional_cell, packed, unpacked,
};
use super::error::{Field, FrameError};
use super::key::Key;
use crate::cell::Extent;
use crate::map::{Level, Tile};
use crate::robot::{Activity, RobotId, Status};
use crate::tile::{TILE, TileIndex};

/// Tiles in a frame at most.
pub const MAX_TILES: usize = 2;

/// The kind of frame that carries tiles of an occupancy grid.
const OCCUPANCY: u8 = 1;

/// Bytes between the header and the tiles.
const STATUS: usize = 7;
/// Bytes of a record: column and form, row, two bits a cell.
const RECORD: usize = 18;

const _: () = assert!(HEADER + STATUS + MAX_TILES * RECORD + TAG <= MAX_LEN);
const _: () = assert!(HEADER + STATUS + MAX_TILES * RECORD + CRC <= MAX_LEN);

/// A tile of a map, or a part of what is known of it, and where it is. A record is a lower
/// bound: it joins into a map. It is written in one of three forms, in each of which a
/// cell can have three levels: free, visited, wall; doubtful, free again, wall again; free
/// for good.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TileRecord {
    /// Where.
    pub at: TileIndex,
    /// What is known of its cells.
    pub tile: Tile,
}

/// One frame: who is where, going where, and a few tiles of its map.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Frame {
    /// The grid that cells and tiles refer to.
    pub grid: GridId,
    /// Who sends.
    pub sender: RobotId,
    /// Counts the sender's frames, and wraps around.
    pub sequence: u16,
    /// What the sender says of itself.
    pub status: Status,
    /// Tiles of its map.
    pub tiles: Vec<TileRecord, MAX_TILES>,
}

impl Frame {
    /// Writes the frame and returns its length: 16 bytes, 18 more a tile, and 2
    /// more with a key. Bytes behind are not touched.
    ///
    /// Cells must lie on the grid: coordinates are written with 12 bits.
    pub fn encode(&self, key: Option<&Key>, buffer: &mut [u8; MAX_LEN]) -> usize {
        let header = Header {
            grid: self.grid,
            sender: self.sender,
            sequence: self.sequence,
        };
        let mut writer = Writer::new(OCCUPANCY, header, buffer);
        let activity = match self.status.activity {
            Activity::Exploring => 0,
            Activity::SecondChance => 1,
            Activity::Stopped => 2,
        };
        writer.put(&[activity | u8::from(self.status.goal.is_some()) << 2]);
        writer.put(&packed(self.status.position));
        writer.put(&self.status.goal.map_or([0; 3], packed));
        for record in &self.tiles {
            let form = form_of(record.tile);
            writer.put(&[record.at.x | form << FORM, record.at.y]);
            writer.put(&cell_codes(record.tile, form).to_le_bytes());
        }
        writer.finish(key)
    }

    /// Reads a frame about `grid`, a grid of `extent` cells. Every field is looked
    /// at before anything is returned.
    ///
    /// # Errors
    /// Anything that [`encode`](Self::encode) would not have written, and frames
    /// about other grids.
    pub fn decode(
        bytes: &[u8],
        key: Option<&Key>,
        grid: GridId,
        extent: Extent,
    ) -> Result<Self, FrameError> {
        let sealed = Sealed::new(bytes, key)?;
        let (status, records) = sealed.payload::<STATUS>(MAX_TILES * RECORD)?;
        let (records, rest) = records.as_chunks::<RECORD>();
        if !rest.is_empty() {
            return Err(FrameError::Length(bytes.len()));
        }
        let &[state, p0, p1, p2, q0, q1, q2] = status;
        let header = sealed.open(OCCUPANCY, grid)?;
        let activity = match state & !4 {
            0 => Activity::Exploring,
            1 => Activity::SecondChance,
            2 => Activity::Stopped,
            _ => return Err(FrameError::Field(Field::State)),
        };
        let position = unpacked([p0, p1, p2]);
        if !extent.contains(position) {
            return Err(FrameError::Field(Field::Position));
        }
        let goal = optional_cell([q0, q1, q2], state & 4 != 0, extent)?;
        let mut tiles = Vec::new();
        for &[x, y, ref codes @ ..] in records {
            let (x, form) = (x & ((1 << FORM) - 1), x >> FORM);
            let record = TileRecord {
                at: TileIndex { x, y },
                tile: tile_of(u128::from_le_bytes(*codes), form),
            };
            let inside = record.at.inside(extent);
            let is_inside = inside != 0 && record.tile.only(inside) == record.tile;
            if !is_inside || form_of(record.tile) != form {
                return Err(FrameError::Field(Field::Tile));
            }
            // There is room: the length was checked.
            let _ = tiles.push(record);
        }
        Ok(Self {
            grid: header.grid,
            sender: header.sender,
            sequence: header.sequence,
            status: Status {
                position,
                goal,
                activity,
            },
            tiles,
        })
    }
}

/// What goes out of a tile that is not usual: as far as each of the forms can say it.
/// Robots that hear them in any order know the same, and never less than before.
pub(super) fn parts(tile: Tile) -> [Tile; 3] {
    let usual = Tile::seen(tile.free(), tile.obstacle()).with(tile.visited(), Level::Visited);
    let for_good = tile.at(Level::FreeForGood);
    let rare = Tile::UNKNOWN
        .with(tile.doubtful(), Level::Doubtful)
        .with(tile.at(Level::FreeAgain) | for_good, Level::FreeAgain)
        .with(tile.at(Level::WallAgain), Level::WallAgain);
    let last = Tile::UNKNOWN.with(for_good, Level::FreeForGood);
    [usual, rare, last]
}

/// Whether a tile has cells that the first form cannot tell exactly, but for doubts.
pub(super) fn is_rare(tile: Tile) -> bool {
    let [low, mid, high] = tile.planes();
    high & (low | mid) != 0
}

/// The bit of the column byte from which on the form of the record stands.
const FORM: u32 = 6;
const _: () = assert!(crate::tile::MOST_TILES <= 1 << FORM);

/// The levels that the codes 1, 2 and 3 mean in each form.
const FORMS: [[Level; 3]; 3] = [
    [Level::Free, Level::Visited, Level::Wall],
    [Level::Doubtful, Level::FreeAgain, Level::WallAgain],
    [Level::FreeForGood; 3],
];

/// The first form that has something to say of a tile; the first of all of an unknown one.
fn form_of(tile: Tile) -> u8 {
    let says = |form: &[Level; 3]| form.iter().any(|&level| tile.at(level) != 0);
    FORMS.iter().position(says).unwrap_or(0) as u8
}

/// Two bits a cell, cell 0 in the lowest.
fn cell_codes(tile: Tile, form: u8) -> u128 {
    let Some(&[first, second, third]) = FORMS.get(usize::from(form)) else {
        return 0;
    };
    if form == 2 {
        return spaced(tile.at(first));
    }
    let third = tile.at(third);
    spaced(tile.at(first) | third) | spaced(tile.at(second) | third) << 1
}

/// The tile that codes mean; unknown where a form has no such code.
fn tile_of(codes: u128, form: u8) -> Tile {
    let (low, high) = (gathered(codes), gathered(codes >> 1));
    match FORMS.get(usize::from(form)) {
        Some(_) if form == 2 && high != 0 => Tile::UNKNOWN,
        Some(&[first, second, third]) => Tile::UNKNOWN
            .with(low & !high, first)
            .with(high & !low, second)
            .with(low & high, third),
        None => Tile::UNKNOWN,
    }
}

/// Bit `n` moved to bit `2n`.
fn spaced(bits: u64) -> u128 {
    let mut wide = u128::from(bits);
    for (shift, mask) in SPACING {
        wide = (wide | wide << shift) & mask;
    }
    wide
}

/// Bit `2n` moved to bit `n`; odd bits are dropped.
fn gathered(wide: u128) -> u64 {
    let mut bits = wide & 0x5555_5555_5555_5555_5555_5555_5555_5555;
    for (shift, mask) in [
        (1, 0x3333_3333_3333_3333_3333_3333_3333_3333),
        (2, SPACING[3].1),
        (4, SPACING[2].1),
        (8, SPACING[1].1),
        (16, SPACING[0].1),
        (32, u128::MAX),
    ] {
        bits = (bits | bits >> shift) & mask;
    }
    bits as u64
}

/// The steps that move the bits of a word apart.
const SPACING: [(u32, u128); 6] = [
    (32, 0x0000_0000_ffff_ffff_0000_0000_ffff_ffff),
    (16, 0x0000_ffff_0000_ffff_0000_ffff_0000_ffff),
    (8, 0x00ff_00ff_00ff_00ff_00ff_00ff_00ff_00ff),
    (4, 0x0f0f_0f0f_0f0f_0f0f_0f0f_0f0f_0f0f_0f0f),
    (2, 0x3333_3333_3333_3333_3333_3333_3333_3333),
    (1, 0x5555_5555_5555_5555_5555_5555_5555_5555),
];

const _: () = assert!(TILE == 8, "a record holds two bits for each of 64 cells");

#[cfg(test)]
mod tests;
