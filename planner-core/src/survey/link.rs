//! One robot's end of the radio over a surface, and the turn of its map.

use crate::cell::{Cell, Extent};
use crate::point::Point;
use crate::radio::{FrameError, GridId, Hearsay, Key, LinkConfig, MAX_LEN, Sender, SurfaceFrame};
use crate::robot::{RobotId, Status};
use crate::tile::TileIndex;

/// Every so many frames one begins with the turn, whatever else waits.
const TURN: u8 = 4;

/// Own frames that are remembered, to know their echo: those of three steps.
const ECHOES: usize = 32;

#[derive(Clone, Debug)]
pub(super) struct Link {
    sender: Sender<ECHOES>,
    /// The tile of the own map that is sent in turn, and the columns of it that were
    /// not sent yet.
    turn: TileIndex,
    left: u64,
    since_turn: u8,
}

impl Link {
    /// A link that says nothing; all zero.
    pub(super) const fn vacant() -> Self {
        Self {
            sender: Sender::vacant(),
            turn: TileIndex { x: 0, y: 0 },
            left: 0,
            since_turn: 0,
        }
    }

    pub(super) fn new(config: LinkConfig, id: RobotId, extent: Extent) -> Self {
        let grid = GridId::of(extent, config.origin_mm, config.cell_mm);
        Self {
            sender: Sender::new(config, grid, id),
            turn: TileIndex { x: 0, y: 0 },
            left: !0,
            since_turn: 0,
        }
    }

    /// The robot's own name.
    pub(super) const fn id(&self) -> RobotId {
        self.sender.id
    }

    /// Another step: the budget of bytes grows.
    pub(super) fn tick(&mut self) {
        self.sender.tick();
    }

    /// A frame without records, if the budget allows one.
    pub(super) fn begin_frame(&mut self, status: Status<Point, Cell>) -> Option<SurfaceFrame> {
        if !self.sender.may_send() {
            return None;
        }
        self.since_turn = (self.since_turn + 1) % TURN;
        Some(SurfaceFrame {
            grid: self.sender.grid,
            sender: self.sender.id,
            sequence: self.sender.sequence,
            status,
            records: heapless::Vec::new(),
        })
    }

    /// Whether the next record is the turn's.
    pub(super) const fn is_turn(&self) -> bool {
        self.since_turn == 0
    }

    /// The tile that is sent in turn, and the columns of it that are due.
    pub(super) const fn turn(&self) -> (TileIndex, u64) {
        (self.turn, self.left)
    }

    /// Goes on to another tile.
    pub(super) fn pass(&mut self, tile: TileIndex) {
        self.turn = tile;
        self.left = !0;
    }

    /// Columns of the tile that is sent in turn were sent.
    pub(super) fn mark_sent(&mut self, cells: u64) {
        self.left &= !cells;
    }

    /// Writes `frame`, and counts it.
    pub(super) fn send(&mut self, frame: &SurfaceFrame, buffer: &mut [u8; MAX_LEN]) -> usize {
        self.sender.send(buffer, |key: Option<&Key>, buffer| {
            frame.encode(key, buffer)
        })
    }

    /// Reads another robot's frame.
    pub(super) fn read(
        &mut self,
        bytes: &[u8],
        extent: Extent,
    ) -> Result<SurfaceFrame, FrameError> {
        let read = SurfaceFrame::decode(bytes, self.sender.key(), self.sender.grid, extent);
        self.sender
            .admit(bytes, read, |frame| (frame.sender, frame.sequence))
    }

    /// The map has learnt `columns` from others.
    pub(super) fn told(&mut self, columns: u32) {
        self.sender.hearsay.told(columns);
    }

    /// What was heard so far.
    pub(super) const fn hearsay(&self) -> Hearsay {
        self.sender.hearsay
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::Activity;

    const EXTENT: Extent = Extent::new(20, 20);
    const STATUS: Status<Point, Cell> = Status {
        position: Point::new(3.0, 4.0, 5.0),
        goal: None,
        activity: Activity::Exploring,
    };

    #[test]
    fn an_echo_is_told_from_a_robot_of_the_same_id() {
        let link = || Link::new(LinkConfig::new(), RobotId(7), EXTENT);
        let (mut robot, mut twin) = (link(), link());
        let mut buffer = [0; MAX_LEN];
        let frame = robot.begin_frame(STATUS).unwrap();
        let length = robot.send(&frame, &mut buffer);
        let refusal = |link: &mut Link| link.read(&buffer[..length], EXTENT).unwrap_err();
        assert_eq!(refusal(&mut robot), FrameError::Own);
        assert_eq!(refusal(&mut twin), FrameError::SameId(RobotId(7)));
        assert_eq!(robot.hearsay().same_id, 0);
        assert_eq!(twin.hearsay().same_id, 1);
    }
}
