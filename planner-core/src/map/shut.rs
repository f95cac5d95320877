//! Cells that were free and are walls now: doors that somebody shut, people who stopped.

use heapless::Vec;

use crate::cell::{Cell, Extent};
use crate::list;

/// Places that are remembered; of more, the last ones.
pub const MOST_PLACES: usize = 8;

/// What was shut when it was last seen. 40 bytes.
#[derive(Clone, Debug, Default)]
pub struct Shut {
    cells: u32,
    places: Vec<Cell, MOST_PLACES>,
}

impl Shut {
    pub(super) const fn new() -> Self {
        Self {
            cells: 0,
            places: Vec::new(),
        }
    }

    /// So many cells, and the last of them, the latest one last.
    pub(crate) fn of(cells: u32, places: impl Iterator<Item = Cell>) -> Self {
        let places = list::collect(places);
        Self { cells, places }
    }

    /// Number of cells that had been free and became walls, without those that were seen
    /// to open again. A cell that opens after eight others were shut is counted all the
    /// same, for it is not remembered any more.
    pub const fn cells(&self) -> u32 {
        self.cells
    }

    /// The last [`MOST_PLACES`] of them that are still shut, the latest one last.
    pub fn places(&self) -> &[Cell] {
        &self.places
    }

    pub(super) fn add(&mut self, cell: Cell) {
        self.cells = self.cells.saturating_add(1);
        if self.places.is_full() {
            let mut is_first = true;
            self.places.retain(|_| !core::mem::take(&mut is_first));
        }
        // There is room now.
        let _ = self.places.push(cell);
    }

    /// The grid moves so many cells to the east and south: places that fall off are
    /// forgotten.
    pub(super) fn shift(&mut self, dx: i16, dy: i16, extent: Extent) {
        let before = self.places.len();
        for place in &mut self.places {
            *place = Cell::new(place.x.saturating_sub(dx), place.y.saturating_sub(dy));
        }
        self.places.retain(|place| extent.contains(*place));
        let gone = before.saturating_sub(self.places.len());
        self.cells = self.cells.saturating_sub(gone as u32);
    }

    /// A wall opens; `was_free` where its level tells that it had been free before.
    pub(super) fn remove(&mut self, cell: Cell, was_free: bool) {
        let before = self.places.len();
        self.places.retain(|place| *place != cell);
        if was_free || self.places.len() < before {
            self.cells = self.cells.saturating_sub(1);
        }
    }
}
