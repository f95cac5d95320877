//! Somebody in the air who writes frames of his own: he hears and sees everything, and
//! has no key.

use planner_core::map::Tile;
use planner_core::radio::{Frame, GridId, Key, LinkConfig, MAX_LEN, TileRecord};
use planner_core::tile::TileIndex;
use planner_core::{Activity, Cell, Extent, Map, RobotId, Status};

use crate::dice::Dice;
use crate::fleet::Robot;
use crate::scenario::{Forger, Forgery};

/// A forger at work. He draws from a generator of his own, so the air is as without him.
pub(super) struct Desk {
    forger: Forger,
    sequence: u16,
    dice: Dice,
    /// He has no key of the fleet, so he tries one.
    key: Key,
}

impl Desk {
    pub(super) fn new(forger: Forger, seed: u64) -> Self {
        let mut dice = Dice::new(seed ^ 0x666f_7267_6572);
        let mut key = [0; 16];
        dice.fill(&mut key);
        Self {
            forger,
            sequence: 0,
            dice,
            key: Key(key),
        }
    }

    /// Lets every living robot hear what is forged for it in `tick`.
    pub(super) fn forge<const TW: usize, const TH: usize>(
        &mut self,
        tick: u32,
        robots: &mut [Robot<TW, TH>],
    ) {
        self.sequence = self.sequence.wrapping_add(1);
        let ids: Vec<RobotId> = robots.iter().map(|robot| robot.id).collect();
        let Some(first) = robots.first().map(|robot| robot.position) else {
            return;
        };
        for robot in robots.iter_mut().filter(|robot| robot.alive) {
            for frame in self.frames(tick, robot, &ids, first) {
                let mut buffer = [0; MAX_LEN];
                for key in [None, Some(&self.key)] {
                    let length = frame.encode(key, &mut buffer);
                    let _ = robot.planner.receive(&buffer[..length]);
                }
            }
        }
    }

    fn frames<const TW: usize, const TH: usize>(
        &mut self,
        tick: u32,
        robot: &Robot<TW, TH>,
        ids: &[RobotId],
        first: Cell,
    ) -> Vec<Frame> {
        let map = robot.planner.map();
        let extent = map.extent();
        let (here, goal) = (robot.position, robot.planner.status().goal);
        let frames = self.forger.frames;
        let ghosts = 0..frames.min(256);
        let exploring = |position| Status {
            position,
            goal: None,
            activity: Activity::Exploring,
        };
        let ghost = |id: u16, status| Frame {
            grid: grid(extent),
            sender: RobotId(id as u8),
            sequence: self.sequence,
            status,
            tiles: Default::default(),
        };
        match self.forger.kind {
            Forgery::Any => (0..frames).map(|_| self.drawn(extent, true)).collect(),
            Forgery::Hints => (0..frames).map(|_| self.drawn(extent, false)).collect(),
            Forgery::OwnCell => ghosts.map(|id| ghost(id, exploring(here))).collect(),
            Forgery::Around => free_around(map, here)
                .zip(ghosts)
                .map(|(cell, id)| ghost(100 + id, exploring(cell)))
                .collect(),
            Forgery::Goal => goal.map_or(Vec::new(), |cell| {
                let there = Status {
                    goal,
                    ..exploring(cell)
                };
                ghosts.map(|id| ghost(id, there)).collect()
            }),
            Forgery::Jump => goal.map_or(Vec::new(), |cell| {
                let is_there = (tick / 3).is_multiple_of(2);
                let at = if is_there { cell } else { Cell::new(0, 0) };
                ghosts.map(|id| ghost(id, exploring(at))).collect()
            }),
            Forgery::Stolen if !tick.is_multiple_of(200) => Vec::new(),
            Forgery::Stolen => {
                let stopped = Status {
                    activity: Activity::Stopped,
                    ..exploring(Cell::new(0, 0))
                };
                let sequence = (tick as u16).wrapping_add(30_000);
                ids.iter()
                    .map(|id| Frame {
                        sequence,
                        ..ghost(id.0.into(), stopped)
                    })
                    .collect()
            }
            Forgery::Crowd => (0..256).map(|id| ghost(id, exploring(first))).collect(),
        }
    }

    /// A frame with anything in it, in the right form.
    fn drawn(&mut self, extent: Extent, with_tiles: bool) -> Frame {
        let status = Status {
            position: self.cell(extent),
            goal: (self.dice.below(2) == 0).then(|| self.cell(extent)),
            activity: match self.dice.below(8) {
                0 => Activity::Stopped,
                _ => Activity::Exploring,
            },
        };
        let tiles = if with_tiles { self.dice.below(3) } else { 0 };
        Frame {
            grid: grid(extent),
            sender: RobotId(self.dice.below(256) as u8),
            sequence: self.dice.below(1 << 16) as u16,
            status,
            tiles: (0..tiles).map(|_| self.tile(extent)).collect(),
        }
    }

    fn cell(&mut self, extent: Extent) -> Cell {
        let mut below = |cells: u16| self.dice.below(cells.into()) as i16;
        Cell::new(below(extent.width), below(extent.height))
    }

    fn tile(&mut self, extent: Extent) -> TileRecord {
        let (at, _) = TileIndex::of(self.cell(extent)).expect("cells of a grid have tiles");
        let inside = (0..64)
            .filter(|&bit| extent.contains(at.cell(bit)))
            .fold(0, |mask, bit| mask | 1 << bit);
        // Few cells, or whole tiles of them.
        let few = self.dice.bits() & self.dice.bits() & self.dice.bits();
        let known = inside & if self.dice.below(4) == 0 { !0 } else { few };
        let obstacle = known & self.dice.bits();
        TileRecord {
            at,
            tile: Tile {
                known,
                obstacle,
                visited: known & !obstacle & self.dice.bits(),
            },
        }
    }
}

fn grid(extent: Extent) -> GridId {
    let link = LinkConfig::new();
    GridId::of(extent, link.origin_mm, link.cell_mm)
}

/// Cells that the map shows free, nearest first, from the robot's own on.
fn free_around<const TW: usize, const TH: usize>(
    map: &Map<TW, TH>,
    here: Cell,
) -> impl Iterator<Item = Cell> + '_ {
    let ring = move |radius: i16| {
        let cells =
            (-radius..=radius).flat_map(move |dy| (-radius..=radius).map(move |dx| (dx, dy)));
        cells.filter(move |(dx, dy)| dx.abs().max(dy.abs()) == radius)
    };
    (0..8)
        .flat_map(ring)
        .map(move |(dx, dy)| Cell::new(here.x + dx, here.y + dy))
        .filter(|&cell| map.is_free(cell))
}
