//! The calls of the planners that fly.

use core::fmt::{self, Write as _};

use bridge::Seen;
use cortex_m_semihosting::hio;
use firmware::Stopwatch;
use planner_core::cao::{Degree, Frame, Model, Sample};
use planner_core::coordinated_survey::{self, Choice, CoordinatedSurvey};
use planner_core::fcao::{self, Fcao};
use planner_core::rng::Rng;
use planner_core::surface::{Column, Height, Patch, Tile};
use planner_core::survey::{Action, Limits, MAX_PEERS, Motion, Status, Surveyor};
use planner_core::{Cell, Extent, Point};
use static_cell::ConstStaticCell;

use crate::Most;

/// Tiles along a side of the map: 104×104 columns.
const TILES: usize = 13;
const EXTENT: Extent = Extent::new(104, 104);

static FCAO: ConstStaticCell<Fcao<TILES, TILES>> = ConstStaticCell::new(Fcao::vacant());
static COORDINATED: ConstStaticCell<CoordinatedSurvey<TILES, TILES>> =
    ConstStaticCell::new(CoordinatedSurvey::vacant());
static SEEN: ConstStaticCell<Seen> = ConstStaticCell::new(Seen::new());

/// The set-up of the comparisons.
const LIMITS: Limits = Limits {
    range: 8.0,
    step: 2.0,
    min_altitude: 2.0,
    ceiling: 40.0,
    separation: 1.0,
};

/// Steps of each flight.
const STEPS: u16 = 400;

#[derive(Clone, Copy, Default)]
struct Calls {
    observe: Most,
    tick: Most,
    merge: Most,
}

/// Measures, and prints `name: value` lines.
pub(crate) fn measure(stopwatch: &Stopwatch) -> fmt::Result {
    let seen = SEEN.take();
    let fcao = FCAO.take();
    for seed in 0..2 {
        let config = fcao::Config::new(LIMITS, seed);
        fcao.reset(EXTENT, config, 0).map_err(|_| fmt::Error)?;
        report("fcao", fly(fcao, seen, stopwatch))?;
    }
    let coordinated = COORDINATED.take();
    for choice in [Choice::Map, Choice::Cubic] {
        let config = coordinated_survey::Config {
            limits: LIMITS,
            seed: 0,
            choice,
        };
        coordinated
            .reset(EXTENT, config, 0)
            .map_err(|_| fmt::Error)?;
        report("coordinated_survey", fly(coordinated, seen, stopwatch))?;
    }
    let mut out = hio::hstdout().map_err(|()| fmt::Error)?;
    let step = optimise(stopwatch);
    writeln!(out, "worst_cao_step: {}", step.instructions())
}

/// CAO alone: a fit to a full history, and the best of 100 candidates.
fn optimise(stopwatch: &Stopwatch) -> Most {
    let mut most = Most::default();
    let mut rng = Rng::new(1, 0);
    let here = Point::new(50.0, 50.0, 5.0);
    for _ in 0..20 {
        let samples: [Sample; 8] = core::array::from_fn(|_| {
            let (x, y, z) = rng.direction();
            Sample {
                at: here.offset(8.0 * x, 8.0 * y, 8.0 * z),
                value: 30.0 * rng.unit(),
                weight: 1.0,
            }
        });
        most.of(stopwatch, || {
            let frame = Frame {
                origin: here,
                scale: 1.0 / 8.0,
            };
            let model = Model::fit::<8>(&samples, frame, Degree::Cubic, 8e-4)?;
            let mut best = (f32::MIN, here);
            for _ in 0..100 {
                let (x, y, z) = rng.direction();
                let to = here.offset(2.0 * x, 2.0 * y, 2.0 * z);
                let value = model.value(to);
                if value > best.0 {
                    best = (value, to);
                }
            }
            Some(core::hint::black_box(best))
        });
    }
    most
}

fn report(planner: &str, calls: Calls) -> fmt::Result {
    let mut out = hio::hstdout().map_err(|()| fmt::Error)?;
    let of = [
        ("observe", calls.observe),
        ("tick", calls.tick),
        ("merge", calls.merge),
    ];
    for (call, most) in of {
        writeln!(out, "worst_{planner}_{call}: {}", most.instructions())?;
        writeln!(out, "worst_{planner}_{call}_stack: {}", most.stack)?;
    }
    Ok(())
}

/// Height of the ground: hills, and steps between them.
fn height(cell: Cell) -> Height {
    let slope = |at: i16| (at % 32 - 16).unsigned_abs() as u8;
    Height(slope(cell.x).wrapping_mul(2) + slope(cell.y) * 2 + (cell.x / 8 % 2) as u8 * 8)
}

/// A whole survey among as many others as are remembered, who fly along.
fn fly(planner: &mut impl Surveyor<TILES, TILES>, seen: &mut Seen, stopwatch: &Stopwatch) -> Calls {
    let mut calls = Calls::default();
    let mut at = Point::over(Cell::new(3, 3), height(Cell::new(3, 3)).cells() + 3.0);
    for step in 0..STEPS {
        look(at, seen);
        calls.observe.of(stopwatch, || planner.observe(at, seen));
        for id in 1..=MAX_PEERS as u8 {
            let (east, south) = (f32::from(id % 4) * 4.0 - 6.0, f32::from(id / 4) * 4.0 - 6.0);
            let status = Status {
                position: at.offset(east, south, 1.0),
                target: None,
                stopped: false,
            };
            planner.hear(id, status);
        }
        let cell = at.cell();
        let tile = Tile {
            x: (cell.x / 8) as u8,
            y: (cell.y / 8) as u8,
        };
        let patch = Patch {
            tile,
            cells: if step % 8 == 0 { !0 } else { 0 },
            heights: core::array::from_fn(|bit| height(tile.cell(bit as u32))),
            fresh: true,
        };
        calls.merge.of(stopwatch, || planner.merge(&patch));
        match calls.tick.of(stopwatch, || planner.tick()) {
            Action::Fly(to) => {
                at = to;
                planner.report(Motion::Moved);
            }
            Action::Hover => {}
            Action::Stop(_) => break,
        }
    }
    calls
}

/// All columns in range.
fn look(at: Point, seen: &mut Seen) {
    seen.clear();
    let (centre, reach) = (at.cell(), LIMITS.range as i16);
    for (dx, dy) in (-reach..=reach).flat_map(|dx| (-reach..=reach).map(move |dy| (dx, dy))) {
        let cell = Cell::new(centre.x + dx, centre.y + dy);
        if EXTENT.contains(cell) && dx * dx + dy * dy <= reach * reach {
            let column = Column {
                cell,
                height: height(cell),
            };
            // There is room for more than the range holds.
            let _ = seen.push(column);
        }
    }
}
