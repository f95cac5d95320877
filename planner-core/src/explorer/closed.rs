//! Steps that were refused: their cells stay closed for a while, each time longer.

use heapless::Vec;

use crate::cell::Cell;
use crate::map::{TileIndex, bit_of};

/// Cells that are remembered as closed.
const CAPACITY: usize = 8;
/// Ticks that a cell stays closed after the first refusal; doubled by each further one.
const FIRST_PAUSE: u32 = 4;
/// Limit of the doublings.
const LONGEST: u8 = 12;

#[derive(Clone, Copy, Debug)]
struct Refusal {
    cell: Cell,
    times: u8,
    until: u32,
}

/// The cells that could not be entered since the robot last learnt anything.
#[derive(Debug)]
pub(crate) struct ClosedCells {
    list: Vec<Refusal, CAPACITY>,
    /// Refusals since the robot last learnt anything, saturating.
    refusals: u8,
}

impl ClosedCells {
    pub(crate) const fn new() -> Self {
        Self {
            list: Vec::new(),
            refusals: 0,
        }
    }

    pub(crate) fn refuse(&mut self, cell: Cell, now: u32) {
        self.refusals = self.refusals.saturating_add(1);
        let refused = Refusal {
            cell,
            times: 0,
            until: 0,
        };
        if !self.list.iter().any(|entry| entry.cell == cell)
            && self.list.push(refused).is_err()
            // Full: in place of the one that opens first, which would be tried again soonest.
            && let Some(soonest) = self.list.iter_mut().min_by_key(|entry| entry.until)
        {
            *soonest = refused;
        }
        if let Some(entry) = self.list.iter_mut().find(|entry| entry.cell == cell) {
            entry.until = now.saturating_add(FIRST_PAUSE << entry.times.min(LONGEST));
            entry.times = entry.times.saturating_add(1);
        }
    }

    /// The robot learnt something: what was refused counts from one again.
    pub(crate) fn renew(&mut self) {
        self.refusals = 0;
        for entry in &mut self.list {
            entry.times = entry.times.min(1);
        }
    }

    /// Forgets the refusals of a cell that was entered.
    pub(crate) fn entered(&mut self, cell: Cell) {
        self.list.retain(|entry| entry.cell != cell);
    }

    pub(crate) fn is_closed(&self, cell: Cell, now: u32) -> bool {
        self.list
            .iter()
            .any(|entry| entry.cell == cell && now < entry.until)
    }

    /// The closed cells of a tile. Work: at most 8 comparisons.
    #[inline] // mostly there are none
    pub(crate) fn mask(&self, at: TileIndex, now: u32) -> u64 {
        if self.list.is_empty() {
            return 0;
        }
        self.list
            .iter()
            .filter(|entry| now < entry.until)
            .filter(|entry| TileIndex::of(entry.cell).is_some_and(|(tile, _)| tile == at))
            .fold(0, |mask, entry| mask | bit_of(entry.cell))
    }

    /// The cells that are closed now.
    pub(crate) fn iter(&self, now: u32) -> impl Iterator<Item = Cell> + '_ {
        self.list
            .iter()
            .filter(move |entry| now < entry.until)
            .map(|entry| entry.cell)
    }

    /// Nothing else is left: a cell that was refused `patience` times if waiting
    /// for the closed cells is no use any more, else none.
    pub(crate) fn hopeless(&self, patience: u8, now: u32) -> Option<Cell> {
        let tried_out = self.refusals == u8::MAX;
        let mut closed = self.list.iter().filter(|entry| now < entry.until);
        let worst = closed.clone().max_by_key(|entry| entry.times)?;
        (tried_out || closed.all(|entry| entry.times >= patience)).then_some(worst.cell)
    }
}
