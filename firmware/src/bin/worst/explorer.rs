//! The explorer's calls.

use core::fmt::{self, Write as _};

use cortex_m_semihosting::hio;
use firmware::Stopwatch;
use planner_core::explorer::{Config, Explorer, MAX_OTHERS};
use planner_core::map::{Map, Tile};
use planner_core::radio::MAX_LEN;
use planner_core::sight::look;
use planner_core::tile::TileIndex;
use planner_core::{
    Action, Activity, Cell, Contact, Extent, Inspect, Motion, Planner, RobotId, Status,
};
use static_cell::ConstStaticCell;

use crate::Most;
use crate::places::{Kind, LOOSE, Place, SIDE};

/// Side of the largest map, in tiles. Every map is held by a planner for this one, so
/// that it is the map that differs and not what the compiler made of the planner.
const TILES: usize = 16;

type Robot = Explorer<TILES, TILES>;

/// The robot and what it is told.
struct Bench {
    robot: Robot,
    map: Map<TILES, TILES>,
}

static BENCH: ConstStaticCell<Bench> = ConstStaticCell::new(Bench {
    robot: Explorer::vacant(),
    map: Map::vacant(),
});

/// How far the robot sees, in cells.
const RANGE: u8 = 5;

/// Ticks in each place.
const TICKS: usize = 16;

#[derive(Clone, Copy, Default)]
struct Calls {
    observe: Most,
    tick: Most,
    transmit: Most,
    receive: Most,
    /// The largest work of a tick.
    work: u32,
}

/// Measures, and prints `name: value` lines.
pub(crate) fn measure(stopwatch: &Stopwatch) -> fmt::Result {
    let bench = BENCH.take();
    for others in [0, 9, MAX_OTHERS as u8] {
        for side in [32, 64, 128] {
            report(side, others, run(bench, stopwatch, side, others))?;
        }
    }
    Ok(())
}

fn report(side: u16, others: u8, calls: Calls) -> fmt::Result {
    let mut out = hio::hstdout().map_err(|()| fmt::Error)?;
    let prefix = format_args!("worst_explorer_{side}_others_{others}");
    let of = [
        ("observe", calls.observe),
        ("tick", calls.tick),
        ("transmit", calls.transmit),
        ("receive", calls.receive),
    ];
    for (call, most) in of {
        writeln!(out, "{prefix}_{call}: {}", most.instructions())?;
        writeln!(out, "{prefix}_{call}_stack: {}", most.stack)?;
    }
    writeln!(out, "{prefix}_work: {}", calls.work)?;
    writeln!(out, "{prefix}_work_bound: {}", Config::new().work_bound())
}

fn run(bench: &mut Bench, stopwatch: &Stopwatch, side: u16, others: u8) -> Calls {
    let mut calls = Calls::default();
    let extent = Extent::new(side, side);
    for place in Place::all() {
        decide(bench, stopwatch, place, extent, others, &mut calls);
        talk(bench, stopwatch, place, extent, &mut calls);
    }
    calls
}

/// Sets up the robot in a place that it knows.
fn enter(bench: &mut Bench, place: Place, extent: Extent, others: u8) {
    let Bench { robot, map, .. } = bench;
    let _ = robot.reset(Config::new(), place.id(), extent, place.own());
    let _ = map.reset(extent);
    let (columns, rows) = map.tile_extent();
    for (x, y) in (0..columns).flat_map(|x| (0..rows).map(move |y| (x, y))) {
        let at = TileIndex::new(x, y);
        let (mut free, mut blocked) = (0, 0);
        for bit in 0..64 {
            match place.kind(at.cell(bit)) {
                Kind::Unknown => {}
                Kind::Blocked => blocked |= 1 << bit,
                _ => free |= 1 << bit,
            }
        }
        map.join_tile(at, Tile::seen(free, blocked));
    }
    let changed = map.take_changed();
    robot.join(map, &changed);
    for number in 0..others {
        let id = RobotId(number + u8::from(number >= place.id().0));
        let status = Status {
            position: place.other(number),
            goal: Some(place.other(number)),
            activity: Activity::Exploring,
        };
        robot.hear(id, status);
    }
}

/// Decides as often as the far search is under way, and after each time that the
/// goal which was chosen is taken away.
fn decide(
    bench: &mut Bench,
    stopwatch: &Stopwatch,
    place: Place,
    extent: Extent,
    others: u8,
    calls: &mut Calls,
) {
    enter(bench, place, extent, others);
    let Bench { robot, map, .. } = bench;
    for _ in 0..TICKS {
        let action = calls.tick.of(stopwatch, || robot.tick());
        calls.work = calls.work.max(robot.work());
        if let (Place::Stairs, Some(goal)) = (place, robot.status().goal) {
            // Something was in the unknown cell.
            for loose in LOOSE.into_iter().filter(|cell| cell.chebyshev(goal) <= 1) {
                if let Some((at, bit)) = TileIndex::of(loose) {
                    map.join_tile(at, Tile::seen(0, bit));
                }
            }
            let changed = map.take_changed();
            robot.join(map, &changed);
        }
        match action {
            Action::Move(_) => robot.report(Motion::Moved),
            Action::Wait => {}
            Action::Stop(_) => break,
        }
    }
}

/// Looks around from cells in every position within a tile, sends what was seen, and
/// lets the robot hear it when it knows nothing.
fn talk(bench: &mut Bench, stopwatch: &Stopwatch, place: Place, extent: Extent, calls: &mut Calls) {
    let Bench { robot, .. } = bench;
    let start = place.own();
    let mut frames = [(0, [0; MAX_LEN]); FRAMES];
    let mut free = frames.iter_mut();
    // In the name of another.
    let _ = robot.reset(Config::new(), RobotId(1), extent, start);
    for step in 0..24 {
        let centre = Cell::new(8 + step % 5 * 3, 8 + step / 5 * 3);
        let is_outside = |cell: Cell| cell.x >= SIDE || cell.y >= SIDE;
        let sighting = look(centre, RANGE, |cell| {
            is_outside(cell) || place.kind(cell) == Kind::Blocked
        });
        calls.observe.of(stopwatch, || robot.observe(&sighting));
        robot.tick();
        let mut frame = [0; MAX_LEN];
        while let Some(length) = calls.transmit.of(stopwatch, || robot.transmit(&mut frame)) {
            if let Some(place) = free.next() {
                *place = (length, frame);
            }
        }
    }
    let _ = robot.reset(Config::new(), place.id(), extent, start);
    for (length, frame) in &frames {
        let frame = frame.get(..*length).unwrap_or_default();
        let _ = calls.receive.of(stopwatch, || robot.receive(frame));
    }
}

/// Frames that the robot hears.
const FRAMES: usize = 24;
