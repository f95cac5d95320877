//! The frame as bytes and as a value that can only be valid.

use core::fmt;

use crc::{CRC_16_IBM_SDLC, Crc, NoTable};
use heapless::Vec;

use super::link::{GridId, Key};
use crate::cell::{Cell, Extent};
use crate::map::{TILE, Tile, TileIndex};
use crate::planner::{Activity, RobotId, Status};

/// The longest frame in bytes: what the Crazyflie's peer-to-peer radio carries
/// safely, less two.
pub const MAX_LEN: usize = 55;

/// Tiles in a frame at most.
pub const MAX_TILES: usize = 2;

/// The format that this code writes, and the only one that it reads.
pub(super) const VERSION: u8 = 1;
/// The kind of frame that carries tiles of an occupancy grid.
const OCCUPANCY: u8 = 1;

/// Bytes before the tiles.
const HEADER: usize = 14;
/// Bytes of a tile: column, row, two bits a cell.
const RECORD: usize = 18;
/// Bytes of the CRC.
pub(super) const CRC: usize = 2;
/// Bytes of the keyed tag, which takes the place of the CRC.
pub(super) const TAG: usize = 4;

const _: () = assert!(HEADER + MAX_TILES * RECORD + TAG <= MAX_LEN);
const _: () = assert!(HEADER + MAX_TILES * RECORD + CRC <= MAX_LEN);

pub(super) const CHECK: Crc<u16, NoTable> = Crc::<u16, NoTable>::new(&CRC_16_IBM_SDLC);

/// A tile of a map and where it is.
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

/// A field of a frame that holds what it cannot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Field {
    /// The state byte.
    State,
    /// The position lies outside of the grid.
    Position,
    /// The goal lies outside of the grid, or is there and should not be.
    Goal,
    /// A tile lies outside of the grid, or knows of cells that do.
    Tile,
}

/// Why a frame was not taken. Nothing has changed then.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum FrameError {
    /// No frame has this length: cut short, or followed by something else.
    Length(usize),
    /// Written in another version of the format.
    Version(u8),
    /// A kind of frame that this planner does not read.
    Kind(u8),
    /// The check bytes do not match: corrupted, or not signed with the key.
    Check,
    /// The sender's map is of another place, resolution or size.
    OtherGrid(GridId),
    /// The robot's own frame.
    Own,
    /// A field holds what it cannot.
    Field(Field),
}

impl fmt::Display for FrameError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Length(bytes) => write!(f, "no frame is {bytes} bytes long"),
            Self::Version(version) => write!(
                f,
                "the frame is of version {version}, this planner reads version {VERSION}"
            ),
            Self::Kind(kind) => write!(f, "this planner does not read frames of kind {kind}"),
            Self::Check => write!(f, "the frame's check bytes do not match"),
            Self::OtherGrid(grid) => write!(
                f,
                "the frame is about grid {:04x}: check origin, resolution and size on both robots",
                grid.0
            ),
            Self::Own => write!(f, "the frame is the robot's own"),
            Self::Field(field) => write!(f, "the frame's {field:?} field is out of range"),
        }
    }
}

impl core::error::Error for FrameError {}

impl Frame {
    /// Writes the frame and returns its length: 16 bytes, 18 more a tile, and 2
    /// more with a key. Bytes behind are not touched.
    ///
    /// Cells must lie on the grid: coordinates are written with 12 bits.
    pub fn encode(&self, key: Option<&Key>, buffer: &mut [u8; MAX_LEN]) -> usize {
        let mut writer = Writer::new(buffer);
        writer.put(&[VERSION, OCCUPANCY]);
        writer.put(&self.grid.0.to_le_bytes());
        writer.put(&[self.sender.0]);
        writer.put(&self.sequence.to_le_bytes());
        let activity = match self.status.activity {
            Activity::Exploring => 0,
            Activity::SecondChance => 1,
            Activity::Stopped => 2,
        };
        writer.put(&[activity | u8::from(self.status.goal.is_some()) << 2]);
        writer.put(&packed(self.status.position));
        writer.put(&self.status.goal.map_or([0; 3], packed));
        for record in &self.tiles {
            writer.put(&[record.at.x, record.at.y]);
            writer.put(&cell_codes(record.tile).to_le_bytes());
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
        let check_bytes = if key.is_some() { TAG } else { CRC };
        let wrong_length = FrameError::Length(bytes.len());
        let body = bytes.len().checked_sub(check_bytes).ok_or(wrong_length)?;
        let (body, check) = bytes.split_at_checked(body).ok_or(wrong_length)?;
        let (header, records) = body.split_first_chunk::<HEADER>().ok_or(wrong_length)?;
        let (records, rest) = records.as_chunks::<RECORD>();
        if !rest.is_empty() || records.len() > MAX_TILES {
            return Err(wrong_length);
        }
        let &[
            version,
            kind,
            g0,
            g1,
            sender,
            s0,
            s1,
            state,
            p0,
            p1,
            p2,
            q0,
            q1,
            q2,
        ] = header;
        if version != VERSION {
            return Err(FrameError::Version(version));
        }
        if kind != OCCUPANCY {
            return Err(FrameError::Kind(kind));
        }
        let intact = match key {
            Some(key) => key.tag(body) == check,
            None => CHECK.checksum(body).to_le_bytes() == check,
        };
        if !intact {
            return Err(FrameError::Check);
        }
        let theirs = GridId(u16::from_le_bytes([g0, g1]));
        if theirs != grid {
            return Err(FrameError::OtherGrid(theirs));
        }
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
        let goal = unpacked([q0, q1, q2]);
        let has_goal = state & 4 != 0;
        if !has_goal && [q0, q1, q2] != [0; 3] || !extent.contains(goal) {
            return Err(FrameError::Field(Field::Goal));
        }
        let mut tiles = Vec::new();
        for &[x, y, ref codes @ ..] in records {
            let record = TileRecord {
                at: TileIndex { x, y },
                tile: tile_of(u128::from_le_bytes(*codes)),
            };
            if record.tile.known & !extent_mask(extent, record.at) != 0
                || extent_mask(extent, record.at) == 0
            {
                return Err(FrameError::Field(Field::Tile));
            }
            // There is room: the length was checked.
            let _ = tiles.push(record);
        }
        Ok(Self {
            grid: theirs,
            sender: RobotId(sender),
            sequence: u16::from_le_bytes([s0, s1]),
            status: Status {
                position,
                goal: has_goal.then_some(goal),
                activity,
            },
            tiles,
        })
    }
}

/// Writes into the front of a buffer; what does not fit is left out, which the
/// assertions above rule out.
pub(super) struct Writer<'a> {
    buffer: &'a mut [u8; MAX_LEN],
    length: usize,
}

impl<'a> Writer<'a> {
    pub(super) const fn new(buffer: &'a mut [u8; MAX_LEN]) -> Self {
        Self { buffer, length: 0 }
    }

    /// Writes the check bytes behind all the rest; returns the length of the frame.
    pub(super) fn finish(mut self, key: Option<&Key>) -> usize {
        match key {
            Some(key) => {
                let tag = key.tag(self.written());
                self.put(&tag);
            }
            None => {
                let check = CHECK.checksum(self.written());
                self.put(&check.to_le_bytes());
            }
        }
        self.length
    }

    pub(super) fn put(&mut self, bytes: &[u8]) {
        let end = self.length + bytes.len();
        if let Some(place) = self.buffer.get_mut(self.length..end) {
            place.copy_from_slice(bytes);
            self.length = end;
        }
    }

    fn written(&self) -> &[u8] {
        self.buffer.get(..self.length).unwrap_or(&[])
    }
}

/// A cell in three bytes: 12 bits of `x`, then 12 bits of `y`, low bits first.
pub(super) const fn packed(cell: Cell) -> [u8; 3] {
    let (x, y) = (cell.x as u16, cell.y as u16);
    [
        x as u8,
        (x >> 8 & 15) as u8 | (y << 4) as u8,
        (y >> 4) as u8,
    ]
}

pub(super) const fn unpacked([a, b, c]: [u8; 3]) -> Cell {
    Cell::new(
        (a as u16 | (b as u16 & 15) << 8) as i16,
        (b as u16 >> 4 | (c as u16) << 4) as i16,
    )
}

/// Two bits a cell, cell 0 in the lowest: 0 unknown, 1 free, 2 visited, 3 obstacle.
fn cell_codes(tile: Tile) -> u128 {
    let obstacle = tile.obstacle & tile.known;
    let visited = tile.visited & !obstacle;
    let low = obstacle | tile.known & !visited;
    let high = obstacle | visited;
    spaced(low) | spaced(high) << 1
}

fn tile_of(codes: u128) -> Tile {
    let (low, high) = (gathered(codes), gathered(codes >> 1));
    Tile {
        known: low | high,
        obstacle: low & high,
        visited: high & !low,
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

/// The cells of a tile that lie on the grid.
fn extent_mask(extent: Extent, at: TileIndex) -> u64 {
    crate::map::inside_mask(extent, usize::from(at.x), usize::from(at.y))
}

const _: () = assert!(TILE == 8, "a record holds two bits for each of 64 cells");

#[cfg(test)]
mod tests;
