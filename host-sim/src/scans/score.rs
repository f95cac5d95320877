//! How far the map's belief and the vote of all beams agree.

use planner_core::{Cell, Direction, Extent};
use serde::Serialize;

use super::Log;
use super::frame::Frame;
use super::line::cell;
use super::replay::Replayed;
use super::votes::Verdict;
use crate::world::{cells, index};

/// What the planner's map says of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Belief {
    /// Nothing.
    Unknown,
    /// It can be passed.
    Free,
    /// It was seen blocked, too seldom to be decided: an obstacle for now.
    Doubtful,
    /// It cannot be passed.
    Wall,
}

impl Belief {
    /// Whether no way leads over it.
    pub fn is_obstacle(self) -> bool {
        matches!(self, Self::Doubtful | Self::Wall)
    }
}

/// How far belief and vote agree.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Score {
    /// The log's name.
    pub log: String,
    /// Scans.
    pub looks: usize,
    /// Beams that measured anything.
    pub beams: usize,
    /// Side of a cell in metres.
    pub cell_size: f64,
    /// How far beams counted, in cells.
    pub range: u8,
    /// From this reading on, in metres, nothing was hit.
    pub nothing_from: f32,
    /// Cells of the grid, across.
    pub width: u16,
    /// Cells of the grid, down.
    pub height: u16,
    /// Cells that at least 3 beams crossed or hit, fewer than 20 % of them hits.
    pub open_floor: usize,
    /// Share of the open floor that is an obstacle on the map, in per cent.
    pub closed_percent: f64,
    /// Share of the open floor that is a doubtful obstacle there, in per cent.
    pub doubtful_percent: f64,
    /// Share of the open floor that cannot be reached over free cells from the first
    /// place, in per cent.
    pub cut_off_percent: f64,
    /// Cells that at least 3 beams hit, and at least 50 % of all.
    pub walls: usize,
    /// Share of these that are free on the map, in per cent.
    pub opened_percent: f64,
    /// Cells that the robot drove through.
    pub driven: usize,
    /// Those of them that are obstacles on the map at the end.
    pub driven_closed: usize,
}

impl Score {
    /// Of a log, replayed.
    pub(super) fn of(log: &Log, frame: &Frame, replayed: &Replayed) -> Self {
        let matching = |that: &dyn Fn(Cell) -> bool| -> Vec<Cell> {
            cells(frame.extent).filter(|at| that(*at)).collect()
        };
        let open = matching(&|at| replayed.verdict(at) == Verdict::Open);
        let walls = matching(&|at| replayed.verdict(at) == Verdict::Wall);
        let driven = matching(&|at| replayed.is_driven(at));
        let is = |at: Cell, belief| replayed.belief(at) == belief;
        let start = replayed.ways()[0][0];
        let reached = wave(frame.extent, cell(start), |at| is(at, Belief::Free));
        let percent = |all: &[Cell], that: &dyn Fn(Cell) -> bool| {
            let those = all.iter().filter(|at| that(**at)).count();
            100.0 * those as f64 / all.len().max(1) as f64
        };
        let measured = |look: &super::Look| frame.measured(log, look).count();
        Self {
            log: log.name.clone(),
            looks: log.looks.len(),
            beams: log.looks.iter().map(measured).sum(),
            cell_size: frame.options.cell_size,
            range: frame.options.range,
            nothing_from: log.nothing_from,
            width: frame.extent.width,
            height: frame.extent.height,
            open_floor: open.len(),
            closed_percent: percent(&open, &|at| replayed.belief(at).is_obstacle()),
            doubtful_percent: percent(&open, &|at| is(at, Belief::Doubtful)),
            cut_off_percent: percent(&open, &|at| !reached[index(frame.extent, at)]),
            walls: walls.len(),
            opened_percent: percent(&walls, &|at| is(at, Belief::Free)),
            driven: driven.len(),
            driven_closed: driven
                .iter()
                .filter(|at| replayed.belief(**at).is_obstacle())
                .count(),
        }
    }
}

/// The cells that steps over cells that are `free` lead to from a start, row by row.
fn wave(extent: Extent, start: Cell, free: impl Fn(Cell) -> bool) -> Vec<bool> {
    let mut reached = vec![false; extent.cells() as usize];
    let mut next = vec![start];
    reached[index(extent, start)] = true;
    while let Some(at) = next.pop() {
        for to in Direction::ALL.map(|direction| at.step(direction)) {
            if extent.contains(to) && free(to) && !reached[index(extent, to)] {
                reached[index(extent, to)] = true;
                next.push(to);
            }
        }
    }
    reached
}
