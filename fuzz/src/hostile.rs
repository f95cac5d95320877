//! A robot among liars. Used by the fuzz target and by a property test.

use planner_core::explorer::{Config, Explorer};
use planner_core::map::{Tile, TileIndex};
use planner_core::radio::{Frame, GridId, LinkConfig, MAX_LEN, TileRecord};
use planner_core::sight::look;
use planner_core::{Action, Activity, Cell, Extent, Map, Motion, Planner, RobotId, Status};

type Robot = Explorer<3, 3>;

/// Longer than any robot needs on a grid of 18×18 cells.
const PATIENCE: u32 = 20_000;

/// Lets one robot explore a small world while it is fed what `script` says, over
/// and over again.
///
/// # Panics
/// If it does not stop, if a refused frame changed the map, if its map is not
/// one that sightings and valid frames can make, or if it claims to be done while
/// something on its map is left.
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
    let start = script.at;
    let mut position = Cell::new(0, 0);
    let mut robot = Box::new(Robot::vacant());
    robot
        .reset(Config::new(), RobotId(3), extent, position)
        .expect("the grid fits");
    for _ in 0..PATIENCE {
        robot.observe(&look(position, radius, is_blocked));
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
                // A lie may show a wall as free, but never one that is in sight.
                assert!(!is_blocked(next), "a step into an obstacle at {next}");
                position = next;
                robot.report(Motion::Moved);
            }
            Action::Wait => {}
            Action::Stop(stop) => {
                assert!(stop.is_complete(), "{stop}");
                assert_sound(robot.map());
                assert!(!reaches_frontier(robot.map(), position), "{stop}");
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
fn feed(robot: &mut Robot, script: &mut Script<'_>, extent: Extent) {
    let mut buffer = [0; MAX_LEN];
    let kind = script.byte();
    let length = if kind & 3 == 0 {
        let length = usize::from(script.byte()) % (MAX_LEN + 1);
        buffer[..length].fill_with(|| script.byte());
        length
    } else {
        forged(kind, script, extent).encode(None, &mut buffer)
    };
    let before = robot.map().clone();
    if robot.receive(&buffer[..length]).is_err() {
        assert!(*robot.map() == before, "a refused frame changed the map");
    }
}

fn forged(kind: u8, script: &mut Script<'_>, extent: Extent) -> Frame {
    let LinkConfig {
        origin_mm, cell_mm, ..
    } = LinkConfig::new();
    let mut cell = || {
        let (x, y) = (script.byte(), script.byte());
        Cell::new((x % 22).into(), (y % 22).into())
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
            tile: Tile {
                known: script.word(),
                obstacle: script.word(),
                visited: script.word(),
            },
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
    let Tile {
        known,
        obstacle,
        visited,
    } = record.tile;
    TileRecord {
        tile: Tile {
            known: known & mask,
            obstacle: obstacle & mask,
            visited: visited & mask,
        },
        ..record
    }
}

/// The counts of a map are those of one that learns the same tiles at once.
fn assert_sound(map: &Map<3, 3>) {
    let mut again = Map::<3, 3>::new(map.extent()).expect("the extent is that of a map");
    for (x, y) in (0..3).flat_map(|y| (0..3).map(move |x| (x, y))) {
        let at = TileIndex::new(x, y);
        let tile = map.tile_inside(at);
        assert_eq!(tile.obstacle & !tile.known, 0);
        assert_eq!(tile.visited & !tile.free(), 0);
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
