//! Steps that were reported blocked. The published algorithm knows no such thing.

use crate::cell::Cell;

/// Cells that can be closed at a time.
const CAPACITY: usize = 8;

/// Ticks for which a cell is closed the first time, and at most.
const FIRST: u8 = 4;
const LONGEST: u8 = 64;
/// Times that the first pause is doubled at most.
const DOUBLINGS: u8 = 4;
const _: () = assert!(
    (FIRST as u32) << DOUBLINGS <= u8::MAX as u32,
    "the longest pause is counted in a u8"
);

/// Blocked steps in a row after which the robot no longer waits on the spot.
const PATIENT: u8 = 3;

/// Blocked steps in a row, without a cell learnt in between, after which the
/// robot gives up.
const PATIENCE: u8 = 12;

/// Cells into which a step was blocked, each closed for a while: 4 ticks, doubling
/// to 64 with every blocked step since the map last grew.
#[derive(Clone, PartialEq, Eq)]
pub(super) struct Closed {
    /// A cell and the ticks that it stays closed; 0: a free place.
    cells: [(Cell, u8); CAPACITY],
    /// Blocked steps since the map last grew.
    failures: u8,
}

impl Closed {
    pub(super) const fn new() -> Self {
        Self {
            cells: [(Cell::new(0, 0), 0); CAPACITY],
            failures: 0,
        }
    }

    /// Closes a cell. With no place left the cell that would open first gives
    /// way: it may be tried too early, which costs one more blocked step.
    pub(super) fn close(&mut self, cell: Cell) {
        let doublings = self.failures.min(DOUBLINGS);
        self.failures = self.failures.saturating_add(1);
        if let Some(place) = self.cells.iter_mut().min_by_key(|(_, ticks)| *ticks) {
            *place = (cell, (FIRST << doublings).min(LONGEST));
        }
    }

    /// Whether to wait for a closed cell to open rather than to turn back.
    pub(super) fn is_patient(&self) -> bool {
        self.failures <= PATIENT && !self.is_empty()
    }

    /// Whether so many steps were blocked that trying on is pointless.
    pub(super) const fn is_hopeless(&self) -> bool {
        self.failures >= PATIENCE
    }

    /// The map has grown: patience is new.
    pub(super) const fn renew(&mut self) {
        self.failures = 0;
    }

    /// Lets a tick pass.
    pub(super) fn age(&mut self) {
        for (_, ticks) in &mut self.cells {
            *ticks = ticks.saturating_sub(1);
        }
    }

    /// The cells that are closed now.
    pub(super) fn iter(&self) -> impl Iterator<Item = Cell> + '_ {
        self.cells
            .iter()
            .filter(|(_, ticks)| *ticks > 0)
            .map(|(cell, _)| *cell)
    }

    pub(super) fn contains(&self, cell: Cell) -> bool {
        self.iter().any(|closed| closed == cell)
    }

    pub(super) fn is_empty(&self) -> bool {
        self.iter().next().is_none()
    }
}
