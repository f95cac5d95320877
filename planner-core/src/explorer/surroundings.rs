//! What the searches read: the map and where the robot stands on it.

use heapless::Vec;

use super::aside::Aside;
use super::body::{self, Fit, Layers, far_beside};
use super::window::{Rows, Window};
use crate::cell::{Cell, Direction};
use crate::map::{MOST_PLACES, Map};
use crate::tile::TileIndex;

/// What can be asked of all cells of a window.
#[derive(Clone, Copy)]
pub(crate) enum Layer {
    /// Cells that this robot can enter.
    Open,
    /// The frontier, and cells that are due a visit.
    Frontier,
    /// Those of them that are worth a look of this robot.
    Goals,
}

/// The robot's knowledge of the place, apart from the other robots.
pub(crate) struct Surroundings<const TW: usize, const TH: usize> {
    pub(crate) map: Map<TW, TH>,
    pub(crate) aside: Aside<TW, TH>,
    /// Walls that were free before and are to be looked at again: the free cells beside
    /// them count as frontiers.
    pub(crate) visits: Vec<Cell, MOST_PLACES>,
    pub(crate) position: Cell,
    /// Ticks so far.
    pub(crate) now: u32,
    /// Cells that the robot's body reaches beyond its own, 0 to 3.
    pub(crate) clearance: u8,
}

impl<const TW: usize, const TH: usize> Surroundings<TW, TH> {
    /// What waves read of a tile: the cells that others can enter, those that this robot can,
    /// the frontier, and the goals of this robot. Work: five tiles, or with a clearance nine.
    pub(crate) fn layers(&self, at: TileIndex) -> [u64; 4] {
        self.layers_of(at, self.clear(at))
    }

    /// As [`layers`](Self::layers), of what is clear and what is frontier.
    #[inline(never)] // small rather than fast: it stands behind every window
    pub(super) fn layers_of(&self, at: TileIndex, layers: Layers) -> [u64; 4] {
        let frontier = self.with_due(at, layers);
        let open = self.open_of(at, layers.clear, || layers.frontier);
        [
            layers.clear,
            open,
            frontier,
            frontier & !self.aside.cells(at),
        ]
    }

    /// The cells of a tile in which the robot has room, and those beside cells of which that
    /// is not known.
    fn clear(&self, at: TileIndex) -> Layers {
        match self.clearance {
            0 => Layers {
                clear: self.map.free(at),
                frontier: self.map.frontier(at),
            },
            clearance => body::tile(&self.map, clearance, at),
        }
    }

    /// The clear cells of a tile that did not refuse this robot, and the one that it stands
    /// on.
    #[inline]
    fn open_of(&self, at: TileIndex, clear: u64, frontier: impl FnOnce() -> u64) -> u64 {
        let closed = self
            .aside
            .closed(at, || self.map.tile(at).visited() & frontier());
        if closed == 0 && self.clearance == 0 {
            return clear;
        }
        let own = match TileIndex::of(self.position) {
            Some((tile, bit)) if tile == at => bit,
            _ => 0,
        };
        match self.clearance {
            0 => clear & !(closed & !own),
            _ => clear & !closed | own,
        }
    }

    /// The open cells of a tile, without a clearance.
    fn open(&self, at: TileIndex) -> u64 {
        self.open_of(at, self.map.free(at), || self.map.frontier(at))
    }

    /// The frontier cells of a tile, and those that are due a visit. Work: five tiles, and
    /// 32 cells where there are visits.
    #[inline] // mostly there are no visits
    fn with_due(&self, at: TileIndex, layers: Layers) -> u64 {
        if self.visits.is_empty() {
            return layers.frontier;
        }
        layers.frontier | self.due(at) & layers.clear
    }

    /// The frontier of a tile, without a clearance.
    fn frontier(&self, at: TileIndex) -> u64 {
        let frontier = self.map.frontier(at);
        if self.visits.is_empty() {
            return frontier;
        }
        frontier | self.due(at) & self.map.free(at)
    }

    /// A layer of a window.
    pub(crate) fn window(&self, window: Window, layer: Layer) -> Rows {
        if self.clearance > 0 {
            return self.body_window(window, layer);
        }
        match layer {
            Layer::Open => window.load(|at| self.open(at)),
            Layer::Frontier => window.load(|at| self.frontier(at)),
            Layer::Goals => window.load(|at| self.goals(at)),
        }
    }

    /// The cells of a tile from which a wall is seen that is due a visit: those beside it,
    /// or where the body is beside it.
    #[inline(never)]
    fn due(&self, at: TileIndex) -> u64 {
        let mut due = 0;
        for cell in &self.visits {
            for side in Direction::ALL {
                match TileIndex::of(self.beside(*cell, side)) {
                    Some((tile, bit)) if tile == at => due |= bit,
                    _ => {}
                }
            }
        }
        due
    }

    /// The nearest cell on a side that the body does not reach.
    fn beside(&self, cell: Cell, side: Direction) -> Cell {
        far_beside(cell, side, self.clearance + 1)
    }

    /// The frontier cells of a tile that are worth a look of this robot; without a clearance.
    fn goals(&self, at: TileIndex) -> u64 {
        self.frontier(at) & !self.aside.cells(at)
    }

    /// Whether so many frontier cells that are spoken for are all of them. With a clearance
    /// that is not known.
    pub(crate) fn are_all_taken(&self, taken: u32) -> bool {
        self.clearance == 0 && self.visits.is_empty() && taken >= self.map.frontiers()
    }

    /// Whether nothing is left to look at. With a clearance there may be nothing, too, where
    /// only frontiers of the map are left.
    pub(crate) fn is_done(&self) -> bool {
        self.map.frontiers() == 0 && self.visits.is_empty()
    }

    /// Every wall that was free before is to be looked at again, as far as places are
    /// remembered. Says whether there are any.
    pub(crate) fn visit_shut_places(&mut self) -> bool {
        self.visits.clear();
        // There is room: both are as long.
        let _ = self.visits.extend_from_slice(self.map.shut().places());
        !self.visits.is_empty()
    }

    /// Something opened, or was shut: what is no wall any more needs no visit.
    pub(crate) fn keep_visits(&mut self) {
        let map = &self.map;
        self.visits.retain(|cell| map.is_obstacle(*cell));
    }

    /// The robot has looked at the walls beside this cell.
    pub(crate) fn end_visits(&mut self, from: Cell) {
        let sides = Direction::ALL.map(|side| self.beside(from, side));
        self.visits.retain(|cell| !sides.contains(cell));
    }

    /// Whether the robot can be sent over this cell.
    pub(crate) fn is_open(&self, cell: Cell) -> bool {
        TileIndex::of(cell).is_some_and(|(at, bit)| match self.clearance {
            0 => self.open(at) & bit != 0,
            _ if cell == self.position => true,
            _ => {
                let looked_from = || self.map.tile(at).visited() & self.clear(at).frontier;
                self.aside.closed(at, looked_from) & bit == 0 && self.fit(cell) == Fit::Clear
            }
        })
    }

    /// Whether a look from this cell is worth it.
    pub(crate) fn is_goal(&self, cell: Cell) -> bool {
        let set_aside = |(at, bit)| self.aside.cells(at) & bit != 0;
        self.is_frontier(cell) && !TileIndex::of(cell).is_some_and(set_aside)
    }

    /// Whether a cell is a frontier, or due a visit.
    pub(crate) fn is_frontier(&self, cell: Cell) -> bool {
        TileIndex::of(cell).is_some_and(|(at, bit)| match self.clearance {
            0 => self.frontier(at) & bit != 0,
            _ if self.fit(cell) != Fit::Clear => false,
            _ => self.sides_to_look(cell).next().is_some(),
        })
    }

    /// The directions to the neighbours of a cell of which the robot does not know whether
    /// it can enter them for want of looks.
    pub(crate) fn unknown_sides(&self, cell: Cell) -> impl Iterator<Item = Direction> + '_ {
        let is_unknown = move |side: &Direction| self.is_unknown(cell.step(*side));
        Direction::ALL.into_iter().filter(is_unknown)
    }

    fn is_unknown(&self, cell: Cell) -> bool {
        match self.clearance {
            0 => !self.map.is_known(cell),
            _ => self.fit(cell) == Fit::Doubtful,
        }
    }

    /// Whether the map has a wall on this side of a cell that is due a visit.
    pub(crate) fn is_due(&self, cell: Cell, side: Direction) -> bool {
        self.visits.contains(&self.beside(cell, side))
    }

    /// The directions to the neighbours of a cell that are to be looked at: the unknown
    /// ones, and those that are due a visit.
    pub(crate) fn sides_to_look(&self, cell: Cell) -> impl Iterator<Item = Direction> + '_ {
        let is_due =
            move |side: &Direction| self.is_unknown(cell.step(*side)) || self.is_due(cell, *side);
        Direction::ALL.into_iter().filter(is_due)
    }
}
