//! The frame of a height map: kind 2 of the wire format.

use heapless::Vec;

use super::check::GridId;
use super::envelope::{HEADER, Header, MAX_LEN, Sealed, TAG, Writer, optional_cell, packed};
use super::error::{Field, FrameError};
use super::key::Key;
use crate::cell::{Cell, Extent};
use crate::list;
use crate::point::Point;
use crate::robot::{Activity, RobotId, Status};
use crate::surface::{Height, Patch};
use crate::tile::MOST_TILES;
use crate::tile::{TILE, TileIndex, bits};

/// The kind of frame that carries columns of a height map.
const HEIGHTS: u8 = 2;
/// Bytes between the header and the records.
const STATUS: usize = 10;
/// Bytes of a record before its heights.
const RECORD: usize = 6;
/// Bytes for records: the same with and without a key.
const ROOM: usize = MAX_LEN - HEADER - STATUS - TAG;

/// Most columns in one record.
pub(crate) const MAX_COLUMNS: usize = ROOM - RECORD;
/// Most records in one frame: each has a column at least.
const MAX_RECORDS: usize = ROOM / (RECORD + 1);

/// Coordinates on the wire in one cell.
const PER_CELL: f32 = 128.0;
const _: () = assert!(
    MOST_TILES * TILE * PER_CELL as usize <= 1 << u16::BITS,
    "a coordinate is written as a u16"
);
const _: () = assert!(
    MOST_TILES <= 1 << 6,
    "a column of tiles is written with 6 bits"
);
const _: () = assert!(
    MAX_COLUMNS <= u32::BITS as usize,
    "a record has the columns of half a tile"
);

/// Some columns of the northern or southern half of a tile.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct HeightRecord {
    /// Which tile; its coordinates are below 64.
    pub tile: TileIndex,
    /// Which half: rows 4 to 7 instead of 0 to 3.
    pub south: bool,
    /// See [`Patch::fresh`].
    pub fresh: bool,
    /// Which columns of the half, at least one.
    pub cells: u32,
    /// Their heights, lowest bit first: one for each bit of `cells`.
    pub heights: Vec<Height, MAX_COLUMNS>,
}

/// One frame: who is where, going where, and some heights of its map.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceFrame {
    /// The grid that cells and tiles refer to.
    pub grid: GridId,
    /// Who sends.
    pub sender: RobotId,
    /// Counts the sender's frames, and wraps around.
    pub sequence: u16,
    /// What the sender says of itself. Its position travels rounded down to 1/128 of a
    /// cell, so that it stays in its column; 0 and 511.99 beyond the ends.
    pub status: Status<Point, Cell>,
    /// Heights of its map; together at most 34 bytes.
    pub records: Vec<HeightRecord, MAX_RECORDS>,
}

impl HeightRecord {
    /// The first columns of `cells` of one half of `patch` that fit beside `taken`
    /// bytes of other records.
    pub(crate) fn of(patch: &Patch, south: bool, cells: u64, taken: usize) -> Option<Self> {
        let room = ROOM.checked_sub(taken)?.checked_sub(RECORD)?;
        let shift = if south { 32 } else { 0 };
        let half = (cells & patch.cells) >> shift & 0xffff_ffff;
        let mut record = Self {
            tile: patch.tile,
            south,
            fresh: patch.fresh,
            cells: 0,
            heights: Vec::new(),
        };
        for bit in bits(half).take(room) {
            let height = patch.heights.get((bit + shift) as usize)?;
            record.heights.push(*height).ok()?;
            record.cells |= 1 << bit;
        }
        (record.cells != 0).then_some(record)
    }

    /// Its columns as bits of the tile.
    pub(crate) fn tile_cells(&self) -> u64 {
        u64::from(self.cells) << if self.south { 32 } else { 0 }
    }

    /// Its length on the wire in bytes.
    pub(crate) fn length(&self) -> usize {
        RECORD + self.heights.len()
    }

    /// As it is joined into a map.
    pub(crate) fn patch(&self) -> Patch {
        let mut heights = [Height(0); 64];
        let cells = self.tile_cells();
        for (bit, height) in bits(cells).zip(&self.heights) {
            if let Some(place) = heights.get_mut(bit as usize) {
                *place = *height;
            }
        }
        Patch {
            tile: self.tile,
            cells,
            heights,
            fresh: self.fresh,
        }
    }
}

impl SurfaceFrame {
    /// Writes the frame and returns its length, at most [`MAX_LEN`]. Bytes behind are
    /// not touched.
    ///
    /// The goal must lie on the grid, and the records fit into 34 bytes together:
    /// those that do not are left out.
    pub fn encode(&self, key: Option<&Key>, buffer: &mut [u8; MAX_LEN]) -> usize {
        let header = Header {
            grid: self.grid,
            sender: self.sender,
            sequence: self.sequence,
        };
        let mut writer = Writer::new(HEIGHTS, header, buffer);
        let Status { position, goal, .. } = self.status;
        writer.put(&[u8::from(self.status.has_stopped()) | u8::from(goal.is_some()) << 1]);
        for coordinate in [position.x, position.y, position.z] {
            writer.put(&((coordinate * PER_CELL) as u16).to_le_bytes());
        }
        writer.put(&goal.map_or([0; 3], packed));
        let mut room = ROOM;
        for record in &self.records {
            let Some(left) = room.checked_sub(record.length()) else {
                break;
            };
            room = left;
            let flags = u8::from(record.south) << 7 | u8::from(record.fresh) << 6;
            writer.put(&[record.tile.x & 63 | flags, record.tile.y & 63]);
            writer.put(&record.cells.to_le_bytes());
            for height in &record.heights {
                writer.put(&[height.0]);
            }
        }
        writer.finish(key)
    }

    /// Reads a frame about `grid`, a grid of `extent` columns. Every field is looked
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
        let (status, mut rest) = sealed.payload::<STATUS>(ROOM)?;
        let &[state, x0, x1, y0, y1, z0, z1, t0, t1, t2] = status;
        let header = sealed.open(HEIGHTS, grid)?;
        if state & !3 != 0 {
            return Err(FrameError::Field(Field::State));
        }
        let coordinates = [[x0, x1], [y0, y1], [z0, z1]].map(u16::from_le_bytes);
        let [x, y, z] = coordinates.map(|coordinate| f32::from(coordinate) / PER_CELL);
        let position = Point::new(x, y, z);
        if !extent.contains(position.cell()) {
            return Err(FrameError::Field(Field::Position));
        }
        let goal = optional_cell([t0, t1, t2], state & 2 != 0, extent)?;
        let mut records = Vec::new();
        while !rest.is_empty() {
            let (record, behind) = decode_record(rest, extent)?;
            // There is room: the length was checked, and every record has a column.
            let _ = records.push(record);
            rest = behind;
        }
        Ok(Self {
            grid: header.grid,
            sender: header.sender,
            sequence: header.sequence,
            status: Status {
                position,
                goal,
                activity: Activity::stopped_if(state & 1 != 0),
            },
            records,
        })
    }
}

fn decode_record(bytes: &[u8], extent: Extent) -> Result<(HeightRecord, &[u8]), FrameError> {
    let wrong = FrameError::Field(Field::Tile);
    let (&[x, y, c0, c1, c2, c3], rest) = bytes.split_first_chunk::<RECORD>().ok_or(wrong)?;
    let cells = u32::from_le_bytes([c0, c1, c2, c3]);
    let (heights, rest) = rest
        .split_at_checked(cells.count_ones() as usize)
        .ok_or(wrong)?;
    let record = HeightRecord {
        tile: TileIndex { x: x & 63, y },
        south: x & 128 != 0,
        fresh: x & 64 != 0,
        cells,
        heights: list::collect(heights.iter().map(|&height| Height(height))),
    };
    let inside = record.tile.inside(extent);
    if y > 63 || cells == 0 || record.tile_cells() & !inside != 0 {
        return Err(wrong);
    }
    Ok((record, rest))
}

#[cfg(test)]
mod tests;
