//! Robots and worlds of cells, as the air sees them.

use planner_core::map::{Level, Tile};
use planner_core::radio::{Frame, FrameError, GridId, Key, LinkConfig, MAX_LEN, TileRecord};
use planner_core::tile::TileIndex;
use planner_core::{Cell, Extent, RobotId, Status, sight};

use super::{Claim, Space, Station};
use crate::dice::Dice;
use crate::robot::Robot;
use crate::world::World;

/// `None`: each robot reads for itself.
type Read = Option<Result<Frame, FrameError>>;

impl Space for World {
    type Place = Cell;
    type Read = Read;

    fn is_near(&self, from: Cell, to: Cell, cells: u16) -> bool {
        from.distance_squared(to) <= u32::from(cells).pow(2)
    }

    fn is_in_sight(&self, from: Cell, to: Cell) -> bool {
        sight::line_of_sight(from, to, |cell| !self.is_free(cell))
    }
}

impl<const TW: usize, const TH: usize> Station for Robot<TW, TH> {
    type Place = Cell;
    type Frame = Frame;
    type Read = Read;

    fn id(&self) -> RobotId {
        self.id
    }

    fn place(&self) -> Cell {
        self.position
    }

    fn is_awake(&self) -> bool {
        self.alive
    }

    fn transmit(&mut self, buffer: &mut [u8; MAX_LEN]) -> Option<usize> {
        let length = self.planner.transmit(buffer)?;
        self.sent.count(length);
        Some(length)
    }

    fn read(&self, frame: &[u8]) -> Read {
        self.planner.read(frame)
    }

    fn receive(&mut self, frame: &[u8], read: &Read) {
        let _ = match read {
            Some(read) => self.planner.receive_read(frame, read),
            None => self.planner.receive(frame),
        };
    }

    fn goal(&self) -> Option<Cell> {
        self.planner.status().goal
    }

    fn corner(&self) -> Cell {
        Cell::new(0, 0)
    }

    fn anywhere(&self, dice: &mut Dice) -> Cell {
        any_cell(self.planner.map().extent(), dice)
    }

    fn around(&self) -> Vec<Cell> {
        let ring = |radius: i16| {
            let cells =
                (-radius..=radius).flat_map(move |dy| (-radius..=radius).map(move |dx| (dx, dy)));
            cells.filter(move |(dx, dy)| dx.abs().max(dy.abs()) == radius)
        };
        let cells = (0..8).flat_map(ring);
        let Cell { x, y } = self.position;
        cells
            .map(|(dx, dy)| Cell::new(x + dx, y + dy))
            .filter(|&cell| self.planner.map().is_free(cell))
            .collect()
    }

    fn forged(&self, claim: Claim<Cell>, pieces: u32, dice: &mut Dice) -> Frame {
        let extent = self.planner.map().extent();
        let link = LinkConfig::new();
        Frame {
            grid: GridId::of(extent, link.origin_mm, link.cell_mm),
            sender: claim.sender,
            sequence: claim.sequence,
            status: Status {
                position: claim.position,
                goal: claim.goal,
                activity: claim.activity,
            },
            tiles: (0..pieces).map(|_| any_tile(extent, dice)).collect(),
        }
    }

    fn encode(frame: &Frame, key: Option<&Key>, buffer: &mut [u8; MAX_LEN]) -> usize {
        frame.encode(key, buffer)
    }
}

pub(super) fn any_cell(extent: Extent, dice: &mut Dice) -> Cell {
    let mut below = |cells: u16| dice.below(cells.into()) as i16;
    Cell::new(below(extent.width), below(extent.height))
}

/// Some tile with an eighth of its 64 bits, or all: those inside of `extent`.
pub(super) fn any_bits(extent: Extent, dice: &mut Dice) -> (TileIndex, u64) {
    let (at, _) = TileIndex::of(any_cell(extent, dice)).expect("cells of a grid have tiles");
    let inside = (0..64)
        .filter(|&bit| extent.contains(at.cell(bit)))
        .fold(0, |mask, bit| mask | 1 << bit);
    let few = dice.bits() & dice.bits() & dice.bits();
    (at, inside & if dice.below(4) == 0 { !0 } else { few })
}

fn any_tile(extent: Extent, dice: &mut Dice) -> TileRecord {
    let (at, known) = any_bits(extent, dice);
    let obstacle = known & dice.bits();
    let visited = known & !obstacle & dice.bits();
    TileRecord {
        at,
        tile: Tile::seen(known, obstacle).with(visited, Level::Visited),
    }
}
