//! What the searches read: the map and where the robot stands on it.

use heapless::Vec;

use super::aside::Aside;
use crate::cell::{Cell, Direction};
use crate::map::{MOST_PLACES, Map};
use crate::tile::TileIndex;

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
}

impl<const TW: usize, const TH: usize> Surroundings<TW, TH> {
    /// Free cells of a tile, as far as anybody knows: for the others' waves.
    pub(crate) fn free(&self, at: TileIndex) -> u64 {
        self.map.free(at)
    }

    /// Free cells of a tile that did not refuse this robot, and the one that it stands on:
    /// for its own waves.
    pub(crate) fn open(&self, at: TileIndex) -> u64 {
        let free = self.free(at);
        let closed = self.aside.closed(at, &self.map);
        if closed == 0 {
            return free;
        }
        let own = match TileIndex::of(self.position) {
            Some((tile, bit)) if tile == at => bit,
            _ => 0,
        };
        free & !(closed & !own)
    }

    /// The frontier cells of a tile, and those that are due a visit. Work: five tiles, and
    /// 32 cells where there are visits.
    #[inline] // mostly there are no visits
    pub(crate) fn frontier(&self, at: TileIndex) -> u64 {
        let frontier = self.map.frontier(at);
        if self.visits.is_empty() {
            return frontier;
        }
        frontier | self.due(at)
    }

    /// The free cells of a tile beside a wall that is due a visit.
    #[inline(never)]
    fn due(&self, at: TileIndex) -> u64 {
        let sides = self
            .visits
            .iter()
            .flat_map(|cell| Direction::ALL.map(|side| cell.step(side)));
        let due = sides
            .filter_map(TileIndex::of)
            .filter(|(tile, _)| *tile == at)
            .fold(0, |cells, (_, bit)| cells | bit);
        due & self.map.free(at)
    }

    /// The frontier cells of a tile that are worth a look of this robot.
    pub(crate) fn goals(&self, at: TileIndex) -> u64 {
        self.frontier(at) & !self.aside.cells(at)
    }

    /// Whether nothing is left to look at.
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
        self.visits
            .retain(|cell| !Direction::ALL.map(|side| from.step(side)).contains(cell));
    }

    /// Whether the robot can be sent over this cell.
    pub(crate) fn is_open(&self, cell: Cell) -> bool {
        TileIndex::of(cell).is_some_and(|(at, bit)| self.open(at) & bit != 0)
    }

    /// Whether a look from this cell is worth it.
    pub(crate) fn is_goal(&self, cell: Cell) -> bool {
        TileIndex::of(cell).is_some_and(|(at, bit)| self.goals(at) & bit != 0)
    }

    /// The directions to the unknown neighbours of a cell.
    pub(crate) fn unknown_sides(&self, cell: Cell) -> impl Iterator<Item = Direction> + '_ {
        let is_unknown = move |side: &Direction| !self.map.is_known(cell.step(*side));
        Direction::ALL.into_iter().filter(is_unknown)
    }

    /// The directions to the neighbours of a cell that are to be looked at: the unknown
    /// ones, and those that are due a visit.
    pub(crate) fn sides_to_look(&self, cell: Cell) -> impl Iterator<Item = Direction> + '_ {
        let is_due = move |side: &Direction| {
            let beside = cell.step(*side);
            !self.map.is_known(beside) || self.visits.contains(&beside)
        };
        Direction::ALL.into_iter().filter(is_due)
    }
}
