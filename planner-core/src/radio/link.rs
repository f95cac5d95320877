//! One robot's end of the radio: numbering, budget, what to send, what to believe.

use heapless::Vec;

use super::cells::{Frame, MAX_TILES, TileRecord, is_rare, parts};
use super::check::GridId;
use super::envelope::MAX_LEN;
use super::error::FrameError;
use super::hearsay::{Hearsay, Witness};
use super::key::Key;
use super::outbox::Outbox;
use super::sender::{LinkConfig, Sender};
use crate::cell::Extent;
use crate::map::{Learnt, Map, Tile};
use crate::robot::{RobotId, Status};
use crate::sight::Sighting;
use crate::tile::{TileIndex, TileSet};

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
    sender: Sender<ECHOES>,
    outbox: Outbox<TH>,
    /// A tile that did not fit the last frame: it needs two records.
    pending: Option<TileIndex>,
    latest: Vec<Latest, SENDERS>,
    witness: Witness,
}

impl<const TH: usize> Link<TH> {
    /// A link that only listens, to grid 0, until [`reset`](Self::reset).
    pub const fn vacant() -> Self {
        Self {
            sender: Sender::vacant(),
            outbox: Outbox::new(),
            pending: None,
            latest: Vec::new(),
            witness: Witness::new(),
        }
    }

    /// Starts anew, with a map of `extent` cells and the first tick's budget.
    pub fn reset(&mut self, config: LinkConfig, id: RobotId, extent: Extent) {
        *self = Self::vacant();
        let grid = GridId::of(extent, config.origin_mm, config.cell_mm);
        self.sender = Sender::new(config, grid, id);
    }

    /// Another tick: the budget of bytes grows. What is not used is not saved up
    /// beyond one frame.
    pub fn tick(&mut self) {
        self.sender.tick();
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

    /// What the robot saw of the tile that it looked from, but for `robots` in it: what others
    /// tell is held against it. Work: eight rows.
    pub fn look(&mut self, sighting: &Sighting, at: TileIndex, robots: u64) {
        self.witness.look(sighting, at, robots);
    }

    /// The map has learnt from others without a frame.
    pub fn joined(&mut self, learnt: Learnt) {
        self.sender.hearsay.told(learnt.cells);
    }

    /// What was heard so far, and what speaks against it.
    pub const fn hearsay(&self) -> Hearsay {
        self.sender.hearsay
    }

    /// Names the grid.
    pub(crate) const fn grid(&self) -> GridId {
        self.sender.grid
    }

    /// The number of the next frame.
    pub(crate) const fn sequence(&self) -> u16 {
        self.sender.sequence
    }

    /// Goes on after frames up to number `sequence`, and maybe as many more as can be under
    /// way, with a map of which others told so many cells.
    pub(crate) fn restore(&mut self, sequence: u16, cells: u32) {
        self.sender.sequence = sequence.wrapping_add(UNDER_WAY);
        self.sender.hearsay.told(cells);
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
        if !self.sender.may_send() {
            return None;
        }
        let mut tiles = Vec::new();
        for _ in 0..MAX_TILES {
            let next = self.pending.take().or_else(|| {
                self.outbox
                    .next(map.tile_extent(), |at| map.tile_inside(at).known() != 0)
            });
            let Some(at) = next else { continue };
            let tile = map.tile_inside(at);
            let [usual, rare, last] = parts(tile);
            if !is_rare(tile) {
                // There is room: the loop stops at the capacity.
                let _ = tiles.push(TileRecord { at, tile: usual });
                continue;
            }
            if !tiles.is_empty() {
                self.pending = Some(at);
                break;
            }
            // What two records cannot tell goes out now and then: in an order that falls
            // in step with nothing.
            let dice = self.sender.sequence.wrapping_mul(40_503) >> 15 == 1;
            let other = if dice && last != Tile::UNKNOWN {
                last
            } else {
                rare
            };
            let both = [usual, other].map(|tile| TileRecord { at, tile });
            let _ = tiles.extend_from_slice(&both);
            break;
        }
        let frame = Frame {
            grid: self.sender.grid,
            sender: self.sender.id,
            sequence: self.sender.sequence,
            status,
            tiles,
        };
        let write = |key: Option<&Key>, buffer: &mut _| frame.encode(key, buffer);
        Some(self.sender.send(buffer, write))
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
        let read = self.read(bytes, map.extent());
        self.receive_read(bytes, &read, map)
    }

    /// Reads a frame, on a map of `extent` cells, for all who hear it: links of the same
    /// grid and key read the same.
    ///
    /// # Errors
    /// See [`FrameError`].
    pub fn read(&self, bytes: &[u8], extent: Extent) -> Result<Frame, FrameError> {
        Frame::decode(bytes, self.sender.key(), self.sender.grid, extent)
    }

    /// As [`receive`](Self::receive), of a frame that was [read](Self::read).
    ///
    /// # Errors
    /// As of `receive`.
    pub fn receive_read<const TW: usize>(
        &mut self,
        bytes: &[u8],
        read: &Result<Frame, FrameError>,
        map: &mut Map<TW, TH>,
    ) -> Result<Heard, FrameError> {
        let of = |frame: &&Frame| (frame.sender, frame.sequence);
        let read = read.as_ref().map_err(|&error| error);
        let frame = self.sender.admit(bytes, read, of)?;
        let contradictions = self.sender.hearsay.contradictions;
        let mut learnt = Learnt::default();
        let mut last = None;
        for record in &frame.tiles {
            // What a frame says twice counts once.
            if last != Some(record) {
                self.witness
                    .hear(&mut self.sender.hearsay, frame.sender, record, map);
            }
            last = Some(record);
            learnt += map.join_tile(record.at, record.tile);
            let own = map.tile_inside(record.at);
            if !is_rare(own) && parts(own)[0] == record.tile {
                // The sender knows all of it.
                self.outbox.told(record.at);
            }
        }
        self.sender.hearsay.told(learnt.cells);
        let now = self.sender.hearsay.contradictions;
        if now > contradictions {
            self.log_contradictions(frame.sender, now, contradictions == 0);
        }
        map.take_changed();
        let is_news = self.is_news(frame.sender, frame.sequence);
        Ok(Heard {
            from: frame.sender,
            learnt,
            status: is_news.then_some(frame.status),
        })
    }

    /// Somebody told otherwise than the robot saw: the first time that is worth a look.
    fn log_contradictions(&self, sender: RobotId, sum: u16, is_first: bool) {
        let (id, sender) = (self.sender.id.0, sender.0);
        if is_first {
            log!(
                warn,
                "robot {}: robot {} tells otherwise than it sees",
                id,
                sender
            );
        }
        log!(
            debug,
            "robot {}: {} cells told otherwise, the last by robot {}",
            id,
            sum,
            sender
        );
    }

    /// Whether a sender's number follows its last one, which it then becomes: not by
    /// more frames than the sender can have sent since. A number that runs ahead of that
    /// changes nothing, so whoever forges one silences nobody. Of more than [`SENDERS`]
    /// senders some are forgotten, and believed.
    fn is_news(&mut self, sender: RobotId, sequence: u16) -> bool {
        let a_tick = self.sender.bytes_per_tick.max(MAX_LEN as u16) / SHORTEST + 1;
        let heard = Latest {
            sender,
            sequence,
            age: 0,
        };
        // One pass, for this is done for every frame of a crowd.
        let (mut age, mut oldest) = (0, 0);
        for (index, latest) in self.latest.iter_mut().enumerate() {
            if latest.sender == sender {
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
            if latest.age >= age {
                (age, oldest) = (latest.age, index);
            }
        }
        if self.latest.is_full() {
            if let Some(latest) = self.latest.get_mut(oldest) {
                *latest = heard;
            }
            return true;
        }
        let _ = self.latest.push(heard);
        true
    }
}

#[cfg(test)]
mod tests;
