//! One robot's end of the radio over a surface, and the turn of its map.

use crate::cell::Extent;
use crate::radio::{FrameError, GridId, LinkConfig, MAX_LEN, SurfaceFrame, position_on_wire};
use crate::robot::RobotId;
use crate::surface::Tile;

use super::Status;
use super::sender::Sender;

/// Every so many frames one begins with the turn, whatever else waits.
const TURN: u8 = 4;

#[derive(Clone, Debug)]
pub(super) struct Link {
    sender: Sender,
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
            sender: Sender::vacant(),
            turn: Tile { x: 0, y: 0 },
            left: 0,
            since_turn: 0,
        }
    }

    pub(super) fn new(config: LinkConfig, id: RobotId, extent: Extent) -> Self {
        let grid = GridId::of(extent, config.origin_mm, config.cell_mm);
        Self {
            sender: Sender::new(config, grid, id),
            turn: Tile { x: 0, y: 0 },
            left: !0,
            since_turn: 0,
        }
    }

    /// Another step: the budget of bytes grows.
    pub(super) fn tick(&mut self) {
        self.sender.tick();
    }

    /// A frame without records, if the budget allows one.
    pub(super) fn begin_frame(&mut self, status: Status) -> Option<SurfaceFrame> {
        if !self.sender.may_send() {
            return None;
        }
        self.since_turn = (self.since_turn + 1) % TURN;
        Some(SurfaceFrame {
            grid: self.sender.grid,
            sender: self.sender.id,
            sequence: self.sender.sequence,
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
        let length = frame.encode(self.sender.key(), buffer);
        self.sender.sent(length);
        length
    }

    /// Reads another robot's frame.
    pub(super) fn read(&self, bytes: &[u8], extent: Extent) -> Result<SurfaceFrame, FrameError> {
        let frame = SurfaceFrame::decode(bytes, self.sender.key(), self.sender.grid, extent)?;
        if frame.sender == self.sender.id {
            return Err(FrameError::Own);
        }
        Ok(frame)
    }
}
