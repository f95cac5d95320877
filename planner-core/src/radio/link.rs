//! One robot's end of the radio: numbering, budget, what to send, what to believe.

use heapless::Vec;

use super::envelope::CHECK;
use super::frame::{Frame, FrameError, MAX_LEN, MAX_TILES, TileRecord};
use super::hearsay::{Hearsay, Witness};
use super::outbox::Outbox;
use super::sent::Sent;
use crate::cell::Extent;
use crate::map::{Learnt, Map};
use crate::robot::{RobotId, Status};
use crate::sight::Sighting;
use crate::tile::TileSet;

/// Names a grid: robots whose maps differ in origin, resolution or size do not
/// understand each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct GridId(pub u16);

impl GridId {
    /// A short hash (CRC-16/X-25) of the grid: its size in cells, where cell
    /// `(0, 0)` lies in the common frame, and the side of a cell, in millimetres.
    pub fn of(extent: Extent, origin_mm: (i32, i32), cell_mm: u16) -> Self {
        let mut digest = CHECK.digest();
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

    /// Whether `tag` is that of `bytes`, in a time that does not hang on how much of it
    /// is.
    #[cfg(feature = "keyed")]
    pub(crate) fn verifies(&self, bytes: &[u8], tag: &[u8]) -> bool {
        use subtle::ConstantTimeEq;
        self.tag(bytes).ct_eq(tag).into()
    }

    #[cfg(not(feature = "keyed"))]
    pub(crate) fn tag(&self, _: &[u8]) -> [u8; 4] {
        match *self {}
    }

    #[cfg(not(feature = "keyed"))]
    pub(crate) fn verifies(&self, _: &[u8], _: &[u8]) -> bool {
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
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LinkConfig {
    /// Where cell `(0, 0)` lies in the fleet's common frame, in millimetres.
    pub origin_mm: (i32, i32),
    /// Side of a cell in millimetres.
    pub cell_mm: u16,
    /// Bytes that the robot may send a tick on average. Less than a frame: it
    /// sends one every few ticks. 0: it only listens.
    pub bytes_per_tick: u16,
    /// Frames are signed with it, and only those signed with it are taken. A
    /// secret is not serialised.
    #[cfg_attr(feature = "serde", serde(skip))]
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
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Heard {
    /// Who sent it.
    pub from: RobotId,
    /// What the map learnt.
    pub learnt: Learnt,
    /// What the sender said of itself; `None` if a newer frame of it was heard
    /// before: this one is late, a repetition or a replay.
    pub status: Option<Status>,
}

/// Senders whose last sequence number is remembered.
const SENDERS: usize = 16;
/// Ticks without a newer frame after which a sender may start counting anew.
const SILENCE: u16 = 256;
/// Frames that may be under way: by so many a number may run ahead of what the budget
/// allows.
const UNDER_WAY: u16 = 32;
/// Bytes of the shortest frame.
const SHORTEST: u16 = 16;
/// Own frames that are remembered, to know their echo.
const ECHOES: usize = 8;

/// The last frame heard of a sender.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Latest {
    sender: RobotId,
    sequence: u16,
    /// Ticks ago.
    age: u16,
}

/// One robot's end of the radio.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Link<const TH: usize> {
    config: LinkConfig,
    grid: GridId,
    id: RobotId,
    sequence: u16,
    outbox: Outbox<TH>,
    /// Bytes that may be sent now.
    credit: u16,
    latest: Vec<Latest, SENDERS>,
    sent: Sent<ECHOES>,
    witness: Witness,
    hearsay: Hearsay,
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
            latest: Vec::new(),
            sent: Sent::new(),
            witness: Witness::new(),
            hearsay: Hearsay::new(),
        }
    }

    /// Starts anew, with a map of `extent` cells and the first tick's budget.
    pub fn reset(&mut self, config: LinkConfig, id: RobotId, extent: Extent) {
        *self = Self::vacant();
        self.config = config;
        self.grid = GridId::of(extent, config.origin_mm, config.cell_mm);
        self.id = id;
        self.credit = config.bytes_per_tick;
    }

    /// Another tick: the budget of bytes grows. What is not used is not saved up
    /// beyond one frame.
    pub fn tick(&mut self) {
        let limit = self.config.bytes_per_tick.max(MAX_LEN as u16);
        self.credit = self
            .credit
            .saturating_add(self.config.bytes_per_tick)
            .min(limit);
        for latest in &mut self.latest {
            latest.age = latest.age.saturating_add(1);
        }
        self.latest.retain(|latest| latest.age <= SILENCE);
    }

    /// The robot has just looked: what changed on its map is sent first. What
    /// others told goes out again in turn, not at once.
    pub fn announce<const TW: usize>(&mut self, map: &mut Map<TW, TH>) {
        self.outbox.add(&map.take_changed());
    }

    /// What the robot saw: what others tell is held against it. Work: eight rows.
    pub fn look(&mut self, sighting: &Sighting) {
        self.witness.look(sighting);
    }

    /// The map has learnt from others without a frame.
    pub fn joined(&mut self, learnt: Learnt) {
        self.hearsay.told(learnt.cells);
    }

    /// What was heard so far, and what speaks against it.
    pub const fn hearsay(&self) -> Hearsay {
        self.hearsay
    }

    /// The tiles that changed since the last call, for media that carry whole maps.
    pub fn take_changed<const TW: usize>(&mut self, map: &mut Map<TW, TH>) -> TileSet<TH> {
        let mut changed = map.take_changed();
        changed.extend(&self.outbox.take_fresh());
        changed
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
        self.sent
            .note(self.sequence, buffer.get(..length).unwrap_or(&[]));
        self.sequence = self.sequence.wrapping_add(1);
        self.credit = self.credit.saturating_sub(length as u16);
        Some(length)
    }

    /// Reads a frame and joins its tiles into the map. Work: two tiles.
    ///
    /// # Errors
    /// See [`FrameError`]; nothing but [`hearsay`](Self::hearsay) has changed then.
    pub fn receive<const TW: usize>(
        &mut self,
        bytes: &[u8],
        map: &mut Map<TW, TH>,
    ) -> Result<Heard, FrameError> {
        let frame = self.read(bytes, map.extent());
        let frame = frame.inspect_err(|&error| self.hearsay.refuse(error))?;
        let mut learnt = Learnt::default();
        let mut last = None;
        for record in &frame.tiles {
            // What a frame says twice counts once.
            if last != Some(record) {
                self.witness
                    .hear(&mut self.hearsay, frame.sender, record, map);
            }
            last = Some(record);
            learnt += map.join_tile(record.at, record.tile);
            if map.tile_inside(record.at) == record.tile {
                // The sender knows all of it.
                self.outbox.told(record.at);
            }
        }
        self.hearsay.told(learnt.cells);
        map.take_changed();
        let is_news = self.is_news(frame.sender, frame.sequence);
        Ok(Heard {
            from: frame.sender,
            learnt,
            status: is_news.then_some(frame.status),
        })
    }

    /// A frame of another robot.
    fn read(&mut self, bytes: &[u8], extent: Extent) -> Result<Frame, FrameError> {
        let frame = Frame::decode(bytes, self.config.key.as_ref(), self.grid, extent)?;
        if frame.sender == self.id {
            return Err(self
                .sent
                .refusal(self.id, self.sequence, frame.sequence, bytes));
        }
        Ok(frame)
    }

    /// Whether a sender's number follows its last one, which it then becomes: not by
    /// more frames than the sender can have sent since. A number that runs ahead of that
    /// changes nothing, so whoever forges one silences nobody. Of more than [`SENDERS`]
    /// senders some are forgotten, and believed.
    fn is_news(&mut self, sender: RobotId, sequence: u16) -> bool {
        let a_tick = self.config.bytes_per_tick.max(MAX_LEN as u16) / SHORTEST + 1;
        let heard = Latest {
            sender,
            sequence,
            age: 0,
        };
        if let Some(latest) = self.latest.iter_mut().find(|of| of.sender == sender) {
            let most = a_tick
                .saturating_mul(latest.age + 2)
                .saturating_add(UNDER_WAY);
            let ahead = sequence.wrapping_sub(latest.sequence);
            let is_news = (1..=most.min(i16::MAX as u16)).contains(&ahead);
            if is_news {
                *latest = heard;
            }
            return is_news;
        }
        if self.latest.is_full() {
            if let Some(oldest) = self.latest.iter_mut().max_by_key(|of| of.age) {
                *oldest = heard;
            }
            return true;
        }
        let _ = self.latest.push(heard);
        true
    }
}

#[cfg(test)]
mod tests;
