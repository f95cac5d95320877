//! A robot among liars. Used by the fuzz target and by a property test.

use planner_core::explorer::{Config, Explorer};
use planner_core::map::Tile;
use planner_core::radio::{Frame, GridId, LinkConfig, MAX_LEN, TileRecord};
use planner_core::sight::look;
use planner_core::tile::TileIndex;
use planner_core::{
    Action, Activity, Cell, Extent, Map, Motion, Planner, RobotId, Sighting, Status, Stop, Wait,
};

type Robot = Explorer<3, 3>;

/// Longer than any robot needs on a grid of 18×18 cells, most of which refuse.
const PATIENCE: u32 = 200_000;

/// What the robot cannot rely on, bit by bit.
#[derive(Clone, Copy)]
struct Trouble {
    bits: u8,
    seed: u8,
}

impl Trouble {
    fn has(self, bit: u8) -> bool {
        self.bits >> bit & 1 == 1
    }

    /// Short ways at hand, so that their rest is searched for.
    fn way(self) -> u16 {
        if self.has(0) { 8 } else { 256 }
    }

    /// No look says anything about the cell.
    fn is_silent(self, cell: Cell) -> bool {
        self.has(1) && scramble(cell, !self.seed) < 16
    }

    /// The cell cannot be entered, and why.
    fn refuses(self, cell: Cell) -> Option<Motion> {
        let refuses = self.has(2) && scramble(cell, self.seed ^ 0x55) < 40;
        let motion = if self.has(3) {
            Motion::Held
        } else {
            Motion::Blocked
        };
        refuses.then_some(motion)
    }

    /// The pose lies off the grid.
    fn is_astray(self, tick: u32) -> bool {
        self.has(4) && tick % 97 < 20 && tick < 2_000
    }
}

/// Lets one robot explore a small world while it is fed what `script` says, over
/// and over again.
///
/// # Panics
/// If it does not stop, if a refused frame changed the map, if its map is not
/// one that sightings and valid frames can make, if it decides anything from a pose off
/// the grid, or if it stops for a reason that is not so.
pub fn explore(script: &[u8]) {
    let mut script = Script {
        bytes: script,
        at: 0,
    };
    let extent = Extent::new(
        u16::from(4 + script.byte() % 15),
        u16::from(4 + script.byte() % 15),
    );
    let (density, seed, radius) = (script.byte() % 160, script.byte(), 1 + script.byte() % 8);
    let is_blocked = |cell: Cell| {
        !extent.contains(cell) || cell != Cell::new(0, 0) && scramble(cell, seed) < density
    };
    let trouble = Trouble {
        bits: script.byte(),
        seed,
    };
    let config = Config {
        way: trouble.way(),
        ..Config::new()
    };
    let start = script.at;
    let mut position = Cell::new(0, 0);
    let mut robot = Box::new(Robot::vacant());
    robot
        .reset(config, RobotId(3), extent, position)
        .expect("the grid fits");
    for tick in 0..PATIENCE {
        let is_astray = trouble.is_astray(tick);
        let mut sighting = Sighting::new(if is_astray {
            Cell::new(-3, 7)
        } else {
            position
        });
        if !is_astray {
            let all = look(position, radius, is_blocked);
            for cell in all.free_cells().filter(|&cell| !trouble.is_silent(cell)) {
                sighting.see_free(cell);
            }
            for cell in all.blocked_cells().filter(|&cell| !trouble.is_silent(cell)) {
                sighting.see_blocked(cell);
            }
        }
        robot.observe(&sighting);
        for _ in 0..script.byte() % 4 {
            feed(&mut robot, &mut script, extent);
        }
        if script.at >= script.bytes.len() {
            script.at = start;
        }
        let mut buffer = [0; MAX_LEN];
        if let Some(length) = robot.transmit(&mut buffer) {
            assert!(length <= MAX_LEN);
        }
        match robot.tick() {
            Action::Move(direction) => {
                let next = position.step(direction);
                assert!(!is_astray, "a step from a pose off the grid");
                match trouble.refuses(next) {
                    Some(motion) => robot.report(motion),
                    // Of a cell that it cannot see the robot believes any lie.
                    None if is_blocked(next) && trouble.is_silent(next) => {
                        robot.report(Motion::Blocked);
                    }
                    None => {
                        // A lie may show a wall as free, but never one that is in sight.
                        assert!(!is_blocked(next), "a step into an obstacle at {next}");
                        position = next;
                        robot.report(Motion::Moved);
                    }
                }
            }
            Action::Wait => assert_eq!(is_astray, robot.waiting() == Some(Wait::Pose)),
            Action::Stop(stop) => {
                assert!(!is_astray, "a stop from a pose off the grid");
                assert_sound(robot.map());
                match stop {
                    Stop::Blocked { at, .. } | Stop::Held { at, .. } => {
                        // Or a wall that was told to be free.
                        let is_so = trouble.refuses(at).is_some()
                            || trouble.is_silent(at)
                            || is_blocked(at);
                        assert!(is_so, "{stop}");
                    }
                    Stop::Unseen { at, .. } => assert!(trouble.is_silent(at), "{stop}"),
                    _ => {
                        assert!(stop.is_complete(), "{stop}");
                        assert!(!reaches_frontier(robot.map(), position), "{stop}");
                    }
                }
                return;
            }
        }
    }
    panic!(
        "still under way at {position} after {PATIENCE} ticks\n{:?}",
        robot.map()
    );
}

/// One frame: raw bytes, or one that says anything in the right form.
///
/// A position is the robot's own cell or its goal now and then: where hints hurt most.
fn feed(robot: &mut Robot, script: &mut Script<'_>, extent: Extent) {
    let mut buffer = [0; MAX_LEN];
    let kind = script.byte();
    let length = if kind & 3 == 0 {
        let length = usize::from(script.byte()) % (MAX_LEN + 1);
        buffer[..length].fill_with(|| script.byte());
        length
    } else {
        let own = robot.status();
        let aims = [Some(own.position), own.goal];
        forged(kind, script, extent, aims).encode(None, &mut buffer)
    };
    let before = robot.map().clone();
    if robot.receive(&buffer[..length]).is_err() {
        assert!(*robot.map() == before, "a refused frame changed the map");
    }
}

fn forged(kind: u8, script: &mut Script<'_>, extent: Extent, aims: [Option<Cell>; 2]) -> Frame {
    let LinkConfig {
        origin_mm, cell_mm, ..
    } = LinkConfig::new();
    let mut cell = || {
        let (x, y) = (script.byte(), script.byte());
        let aim = aims.get(usize::from(x >> 6)).copied().flatten();
        aim.unwrap_or(Cell::new((x % 22).into(), (y % 22).into()))
    };
    let status = Status {
        position: cell(),
        goal: (kind & 4 != 0).then(&mut cell),
        activity: match kind & 24 {
            0 => Activity::Stopped,
            8 => Activity::SecondChance,
            _ => Activity::Exploring,
        },
    };
    let tiles = (0..kind >> 6 & 1)
        .chain(0..kind >> 7)
        .map(|_| TileRecord {
            at: TileIndex::new(script.byte() % 4, script.byte() % 4),
            tile: Tile::from_planes([script.word(), script.word(), script.word()]),
        })
        .map(|record| inside(record, extent))
        .collect();
    Frame {
        grid: GridId::of(extent, origin_mm, cell_mm),
        sender: RobotId(script.byte()),
        sequence: u16::from_le_bytes([script.byte(), script.byte()]),
        status,
        tiles,
    }
}

/// Without the cells beyond the edge, for which the frame would be refused.
fn inside(record: TileRecord, extent: Extent) -> TileRecord {
    let mask = (0..64)
        .filter(|&bit| extent.contains(record.at.cell(bit)))
        .fold(0, |mask, bit| mask | 1 << bit);
    TileRecord {
        tile: record.tile.only(mask),
        ..record
    }
}

/// The counts of a map are those of one that learns the same tiles at once.
fn assert_sound(map: &Map<3, 3>) {
    let mut again = Map::<3, 3>::new(map.extent()).expect("the extent is that of a map");
    for (x, y) in (0..3).flat_map(|y| (0..3).map(move |x| (x, y))) {
        let at = TileIndex::new(x, y);
        let tile = map.tile_inside(at);
        assert_eq!(tile.obstacle() & tile.free(), 0);
        assert_eq!(tile.visited() & !tile.free(), 0);
        again.join_tile(at, tile);
    }
    assert_eq!(map.frontiers(), again.frontiers());
    assert_eq!(map.unknown_cells(), again.unknown_cells());
}

/// Whether a way over free cells of the map leads to a frontier.
fn reaches_frontier(map: &Map<3, 3>, from: Cell) -> bool {
    let mut found = vec![from];
    let mut next = 0;
    while let Some(&cell) = found.get(next) {
        if map.is_frontier(cell) {
            return true;
        }
        for direction in planner_core::Direction::ALL {
            let beside = cell.step(direction);
            if map.is_free(beside) && !found.contains(&beside) {
                found.push(beside);
            }
        }
        next += 1;
    }
    false
}

fn scramble(cell: Cell, seed: u8) -> u8 {
    let mixed =
        ((cell.x as u32).wrapping_mul(0x9e37_79b9)) ^ ((cell.y as u32).wrapping_mul(0x85eb_ca6b));
    let mixed = (mixed ^ u32::from(seed).wrapping_mul(0xc2b2_ae35)).wrapping_mul(0x27d4_eb2f);
    (mixed >> 24) as u8
}

/// Bytes one after another, then zeros.
struct Script<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Script<'_> {
    fn byte(&mut self) -> u8 {
        let byte = self.bytes.get(self.at).copied().unwrap_or(0);
        self.at += 1;
        byte
    }

    fn word(&mut self) -> u64 {
        u64::from_le_bytes(std::array::from_fn(|_| self.byte()))
    }
}
