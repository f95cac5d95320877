//! One robot's end of the radio: numbering, budget, what to send, what to believe.

use crc::{CRC_16_IBM_SDLC, Crc, NoTable};
use heapless::Vec;

use super::frame::{Frame, FrameError, MAX_LEN, MAX_TILES, TileRecord};
use super::outbox::Outbox;
use crate::cell::Extent;
use crate::map::{Learnt, Map, TileSet};
use crate::planner::{RobotId, Status};

/// Names a grid: robots whose maps differ in origin, resolution or size do not
/// understand each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct GridId(pub u16);

impl GridId {
    /// A short hash (CRC-16/X-25) of the grid: its size in cells, where cell
    /// `(0, 0)` lies in the common frame, and the side of a cell, in millimetres.
    pub fn of(extent: Extent, origin_mm: (i32, i32), cell_mm: u16) -> Self {
        let crc = Crc::<u16, NoTable>::new(&CRC_16_IBM_SDLC);
        let mut digest = crc.digest();
        digest.update(&extent.width.to_le_bytes());
        digest.update(&extent.height.to_le_bytes());
        digest.update(&origin_mm.0.to_le_bytes());
        digest.update(&origin_mm.1.to_le_bytes());
        digest.update(&cell_mm.to_le_bytes());
        Self(digest.finalize())
    }
}

/// A secret that a fleet shares, with which frames are signed (SipHash-2-4,
/// the first 32 bits).
#[cfg(feature = "keyed")]
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Key(pub [u8; 16]);

/// No frame is signed without the feature `keyed`.
#[cfg(not(feature = "keyed"))]
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Key {}

impl Key {
    #[cfg(feature = "keyed")]
    pub(crate) fn tag(&self, bytes: &[u8]) -> [u8; 4] {
        use core::hash::Hasher;
        let mut hasher = siphasher::sip::SipHasher24::new_with_key(&self.0);
        hasher.write(bytes);
        let [a, b, c, d, ..] = hasher.finish().to_le_bytes();
        [a, b, c, d]
    }

    #[cfg(not(feature = "keyed"))]
    pub(crate) fn tag(&self, _: &[u8]) -> [u8; 4] {
        match *self {}
    }
}

/// Never shows the secret.
impl core::fmt::Debug for Key {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("Key(…)")
    }
}

/// How a robot uses the radio. One configuration serves a whole fleet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LinkConfig {
    /// Where cell `(0, 0)` lies in the fleet's common frame, in millimetres.
    pub origin_mm: (i32, i32),
    /// Side of a cell in millimetres.
    pub cell_mm: u16,
    /// Bytes that the robot may send a tick on average. Less than a frame: it
    /// sends one every few ticks. 0: it only listens.
    pub bytes_per_tick: u16,
    /// Frames are signed with it, and only those signed with it are taken.
    pub key: Option<Key>,
}

impl LinkConfig {
    /// One frame a tick, not signed; cells of 100 mm from the origin on.
    pub const fn new() -> Self {
        Self {
            origin_mm: (0, 0),
            cell_mm: 100,
            bytes_per_tick: MAX_LEN as u16,
            key: None,
        }
    }

    /// All zero: only listens.
    pub(crate) const fn vacant() -> Self {
        Self {
            origin_mm: (0, 0),
            cell_mm: 0,
            bytes_per_tick: 0,
            key: None,
        }
    }
}

impl Default for LinkConfig {
    fn default() -> Self {
        Self::new()
    }
}

/// What a received frame brought.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Heard {
    /// Who sent it.
    pub from: RobotId,
    /// What the map learnt.
    pub learnt: Learnt,
}

/// One robot's end of the radio.
#[derive(Clone, Debug)]
pub struct Link<const TH: usize> {
    config: LinkConfig,
    grid: GridId,
    id: RobotId,
    sequence: u16,
    outbox: Outbox<TH>,
    /// Bytes that may be sent now.
    credit: u16,
}

impl<const TH: usize> Link<TH> {
    /// A link that only listens, to grid 0, until [`reset`](Self::reset).
    pub const fn vacant() -> Self {
        Self {
            config: LinkConfig::vacant(),
            grid: GridId(0),
            id: RobotId(0),
            sequence: 0,
            outbox: Outbox::new(),
            credit: 0,
        }
    }

    /// Starts anew, with a map of `extent` cells.
    pub fn reset(&mut self, config: LinkConfig, id: RobotId, extent: Extent) {
        *self = Self::vacant();
        self.config = config;
        self.grid = GridId::of(extent, config.origin_mm, config.cell_mm);
        self.id = id;
    }

    /// Another tick: the budget of bytes grows. What is not used is not saved up
    /// beyond one frame.
    pub fn tick(&mut self) {
        let limit = self.config.bytes_per_tick.max(MAX_LEN as u16);
        self.credit = self
            .credit
            .saturating_add(self.config.bytes_per_tick)
            .min(limit);
    }

    /// Tiles that the robot itself saw change: they are sent first.
    pub fn announce(&mut self, tiles: &TileSet<TH>) {
        self.outbox.add(tiles);
    }

    /// The tiles that were announced and not sent yet, taken out.
    pub fn take_announced(&mut self) -> TileSet<TH> {
        self.outbox.take_fresh()
    }

    /// Writes the next frame and returns its length, or `None` while the budget
    /// does not allow one. Work: two tiles.
    pub fn transmit<const TW: usize>(
        &mut self,
        map: &Map<TW, TH>,
        status: Status,
        buffer: &mut [u8; MAX_LEN],
    ) -> Option<usize> {
        if usize::from(self.credit) < MAX_LEN {
            return None;
        }
        let mut tiles = Vec::new();
        for _ in 0..MAX_TILES {
            let next = self
                .outbox
                .next(map.tile_extent(), |at| map.tile_inside(at).known != 0);
            if let Some(at) = next {
                let record = TileRecord {
                    at,
                    tile: map.tile_inside(at),
                };
                // There is room: the loop stops at the capacity.
                let _ = tiles.push(record);
            }
        }
        let frame = Frame {
            grid: self.grid,
            sender: self.id,
            sequence: self.sequence,
            status,
            tiles,
        };
        let length = frame.encode(self.config.key.as_ref(), buffer);
        self.sequence = self.sequence.wrapping_add(1);
        self.credit = self.credit.saturating_sub(length as u16);
        Some(length)
    }

    /// Reads a frame, and nothing else.
    ///
    /// # Errors
    /// See [`FrameError`].
    pub fn receive(&self, bytes: &[u8], extent: Extent) -> Result<Frame, FrameError> {
        let frame = Frame::decode(bytes, self.config.key.as_ref(), self.grid, extent)?;
        if frame.sender == self.id {
            return Err(FrameError::Own);
        }
        Ok(frame)
    }
}
