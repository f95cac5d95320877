//! One robot's end of the radio in 3-D: numbering, budget, and the turn of the map.

use crate::cell::Extent;
use crate::planner::RobotId;
use crate::radio::{FrameError, GridId, LinkConfig, MAX_LEN, SurfaceFrame, position_on_wire};
use crate::surface::Tile;

use super::Status;

/// Every so many frames one begins with the turn, whatever else waits.
const TURN: u8 = 4;

#[derive(Clone, Debug)]
pub(super) struct Link {
    config: LinkConfig,
    grid: GridId,
    id: RobotId,
    sequence: u16,
    /// Bytes that may be sent now.
    credit: u16,
    /// The tile of the own map that is sent in turn, and the columns of it that were
    /// not sent yet.
    turn: Tile,
    left: u64,
    since_turn: u8,
}

impl Link {
    /// A link that says nothing; all zero.
    pub(super) const fn vacant() -> Self {
        Self {
            config: LinkConfig::vacant(),
            grid: GridId(0),
            id: RobotId(0),
            sequence: 0,
            credit: 0,
            turn: Tile { x: 0, y: 0 },
            left: 0,
            since_turn: 0,
        }
    }

    pub(super) fn new(config: LinkConfig, id: RobotId, extent: Extent) -> Self {
        Self {
            config,
            grid: GridId::of(extent, config.origin_mm, config.cell_mm),
            id,
            sequence: 0,
            credit: config.bytes_per_tick,
            turn: Tile { x: 0, y: 0 },
            left: !0,
            since_turn: 0,
        }
    }

    /// Another step: the budget of bytes grows, up to one step's or one frame.
    pub(super) fn tick(&mut self) {
        let limit = self.config.bytes_per_tick.max(MAX_LEN as u16);
        self.credit = self
            .credit
            .saturating_add(self.config.bytes_per_tick)
            .min(limit);
    }

    /// A frame without records, if the budget allows one.
    pub(super) fn begin_frame(&mut self, status: Status) -> Option<SurfaceFrame> {
        if usize::from(self.credit) < MAX_LEN {
            return None;
        }
        self.since_turn = (self.since_turn + 1) % TURN;
        Some(SurfaceFrame {
            grid: self.grid,
            sender: self.id,
            sequence: self.sequence,
            position: position_on_wire(status.position),
            target: status.target,
            stopped: status.stopped,
            records: heapless::Vec::new(),
        })
    }

    /// Whether the next record is the turn's.
    pub(super) const fn is_turn(&self) -> bool {
        self.since_turn == 0
    }

    /// The tile that is sent in turn, and the columns of it that are due.
    pub(super) const fn turn(&self) -> (Tile, u64) {
        (self.turn, self.left)
    }

    /// Goes on to another tile.
    pub(super) fn pass(&mut self, tile: Tile) {
        self.turn = tile;
        self.left = !0;
    }

    /// Columns of the tile that is sent in turn were sent.
    pub(super) fn mark_sent(&mut self, cells: u64) {
        self.left &= !cells;
    }

    /// Writes `frame`, and counts it.
    pub(super) fn send(&mut self, frame: &SurfaceFrame, buffer: &mut [u8; MAX_LEN]) -> usize {
        let length = frame.encode(self.config.key.as_ref(), buffer);
        self.sequence = self.sequence.wrapping_add(1);
        self.credit = self.credit.saturating_sub(length as u16);
        length
    }

    /// Reads another robot's frame.
    pub(super) fn read(&self, bytes: &[u8], extent: Extent) -> Result<SurfaceFrame, FrameError> {
        let frame = SurfaceFrame::decode(bytes, self.config.key.as_ref(), self.grid, extent)?;
        if frame.sender == self.id {
            return Err(FrameError::Own);
        }
        Ok(frame)
    }
}
