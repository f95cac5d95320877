//! What frames of all kinds begin and end with, and how cells are written.

use super::check::{CHECK, GridId};
use super::error::{Field, FrameError, VERSION};
use super::key::Key;
use crate::cell::{Cell, Extent};
use crate::robot::RobotId;
use crate::tile::{MOST_TILES, TILE};

/// The longest frame in bytes: what the Crazyflie's peer-to-peer radio carries
/// safely, less two.
pub const MAX_LEN: usize = 55;

/// Bytes of the header: version, kind, grid, sender, sequence.
pub(super) const HEADER: usize = 7;
/// Bytes of the CRC.
pub(super) const CRC: usize = 2;
/// Bytes of the keyed tag, which takes the place of the CRC.
pub(super) const TAG: usize = 4;

/// What is behind version and kind in the header.
pub(super) struct Header {
    pub(super) grid: GridId,
    pub(super) sender: RobotId,
    pub(super) sequence: u16,
}

/// A frame whose header and check bytes have not been looked at.
pub(super) struct Sealed<'a> {
    header: &'a [u8; HEADER],
    payload: &'a [u8],
    body: &'a [u8],
    check: &'a [u8],
    key: Option<&'a Key>,
}

impl<'a> Sealed<'a> {
    /// # Errors
    /// The frame is shorter than header and check bytes.
    pub(super) fn new(bytes: &'a [u8], key: Option<&'a Key>) -> Result<Self, FrameError> {
        let wrong_length = FrameError::Length(bytes.len());
        let check_bytes = if key.is_some() { TAG } else { CRC };
        let body = bytes.len().checked_sub(check_bytes).ok_or(wrong_length)?;
        let (body, check) = bytes.split_at_checked(body).ok_or(wrong_length)?;
        let (header, payload) = body.split_first_chunk().ok_or(wrong_length)?;
        Ok(Self {
            header,
            payload,
            body,
            check,
            key,
        })
    }

    /// What is between header and check bytes: the status, of a fixed length, and at most
    /// `room` bytes of records.
    ///
    /// # Errors
    /// It is shorter or longer.
    pub(super) fn payload<const STATUS: usize>(
        &self,
        room: usize,
    ) -> Result<(&'a [u8; STATUS], &'a [u8]), FrameError> {
        self.payload
            .split_first_chunk()
            .filter(|(_, records)| records.len() <= room)
            .ok_or(FrameError::Length(self.body.len() + self.check.len()))
    }

    /// The kind that the frame says it is of.
    pub(super) const fn kind(&self) -> u8 {
        self.header[1]
    }

    /// The header of an intact frame of this kind about `grid`.
    ///
    /// # Errors
    /// Another version, kind or grid, or wrong check bytes.
    pub(super) fn open(&self, kind: u8, grid: GridId) -> Result<Header, FrameError> {
        let &[version, theirs, g0, g1, sender, s0, s1] = self.header;
        if version != VERSION {
            return Err(FrameError::Version(version));
        }
        if theirs != kind {
            return Err(FrameError::Kind(theirs));
        }
        let intact = match self.key {
            Some(key) => key.verifies(self.body, self.check),
            None => CHECK.checksum(self.body).to_le_bytes() == self.check,
        };
        if !intact {
            return Err(FrameError::Check);
        }
        let theirs = GridId(u16::from_le_bytes([g0, g1]));
        if theirs != grid {
            return Err(FrameError::OtherGrid(theirs));
        }
        Ok(Header {
            grid,
            sender: RobotId(sender),
            sequence: u16::from_le_bytes([s0, s1]),
        })
    }
}

/// A goal: a cell of the grid, or three zeros where there is none.
pub(super) fn optional_cell(
    bytes: [u8; 3],
    is_there: bool,
    extent: Extent,
) -> Result<Option<Cell>, FrameError> {
    let cell = unpacked(bytes);
    if !is_there && bytes != [0; 3] || !extent.contains(cell) {
        return Err(FrameError::Field(Field::Goal));
    }
    Ok(is_there.then_some(cell))
}

/// Writes into the front of a buffer; what does not fit is left out, which the
/// lengths of the frames rule out.
pub(super) struct Writer<'a> {
    buffer: &'a mut [u8; MAX_LEN],
    length: usize,
}

impl<'a> Writer<'a> {
    /// Begins a frame of that kind.
    pub(super) fn new(kind: u8, header: Header, buffer: &'a mut [u8; MAX_LEN]) -> Self {
        let mut writer = Self { buffer, length: 0 };
        writer.put(&[VERSION, kind]);
        writer.put(&header.grid.0.to_le_bytes());
        writer.put(&[header.sender.0]);
        writer.put(&header.sequence.to_le_bytes());
        writer
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

const _: () = assert!(
    MOST_TILES * TILE <= 1 << 12,
    "a coordinate is written with 12 bits"
);

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
