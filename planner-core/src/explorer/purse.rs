//! What hints may cost.
//!
//! Anybody can pretend robots, and a robot that leaves frontiers to them goes farther
//! than it would alone. It therefore pays for heeding them: a tick that shows it nothing
//! new. It starts with a capital, half the mean side of the grid in ticks, and earns as
//! it comes to know the place: a fifth of the looks that all cells of its map are worth,
//! at as many cells a look as its own have brought. Cells told by others count, so robots
//! that do save it work pay for themselves. When the purse is empty, the robot decides as
//! if it were alone (but leans its own way, as it may well not be), until it has half of
//! the capital again.
//!
//! So all ticks in which a robot heeds hints and sees nothing new are at most
//!
//! ```text
//! capital + 1/5 · looks that showed something new · cells known / cells seen first
//! ```
//!
//! whatever was pretended. The purse is filled again by new cells only, of which there
//! are finitely many: the proof of the explorer does not change.

use crate::cell::Extent;

/// Of the looks that the map is worth, one in so many may be spent.
const SHARE: u64 = 5;

/// The account of one robot. 16 bytes.
#[derive(Debug)]
pub(crate) struct Purse {
    /// Looks that showed something new.
    looks: u32,
    /// Cells that they showed.
    seen: u32,
    /// Ticks paid.
    paid: u32,
    /// Whether a look has shown something new since the last tick.
    has_seen: bool,
    is_empty: bool,
}

impl Purse {
    pub(crate) const fn new() -> Self {
        Self {
            looks: 0,
            seen: 0,
            paid: 0,
            has_seen: false,
            is_empty: false,
        }
    }

    /// A look has shown `cells` new cells.
    pub(crate) fn saw(&mut self, cells: u32) {
        if cells > 0 {
            self.has_seen = true;
            self.looks = self.looks.saturating_add(1);
            self.seen = self.seen.saturating_add(cells);
        }
    }

    /// Pays for a tick, if hints are heeded in it; `known` are the cells of the map.
    /// Says whether the purse has just become empty.
    pub(crate) fn pay(&mut self, heeds: bool, known: u32, extent: Extent) -> bool {
        let was_empty = self.is_empty;
        if heeds && !was_empty && !self.has_seen {
            self.paid = self.paid.saturating_add(1);
        }
        self.has_seen = false;
        let capital = (u32::from(extent.width) + u32::from(extent.height)) / 4;
        // What is still to be earned, times the cells seen: no division.
        let kept = if was_empty { capital / 2 } else { 0 };
        let debt = u64::from(self.paid.saturating_add(kept).saturating_sub(capital));
        let earned = u64::from(self.looks) * u64::from(known);
        self.is_empty = debt.saturating_mul(SHARE * u64::from(self.seen)) > earned;
        self.is_empty && !was_empty
    }

    /// Whether the robot decides as if it were alone.
    pub(crate) const fn is_empty(&self) -> bool {
        self.is_empty
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const EXTENT: Extent = Extent::new(40, 40);

    /// Ticks until the purse is empty, without anything new.
    fn ticks_left(purse: &mut Purse, known: u32) -> u32 {
        (1..)
            .find(|_| purse.pay(true, known, EXTENT))
            .expect("it will be empty")
    }

    #[test]
    fn the_capital_is_spent_and_no_more() {
        let mut purse = Purse::new();
        purse.saw(50);
        // Half the side, and a fifth of one look.
        assert_eq!(ticks_left(&mut purse, 50), 1 + 1 + 20);
        assert!(purse.is_empty());
        for _ in 0..1000 {
            assert!(!purse.pay(true, 50, EXTENT));
            assert!(purse.is_empty());
        }
    }

    #[test]
    fn what_others_tell_is_earned_and_fills_it_again() {
        let mut purse = Purse::new();
        for _ in 0..10 {
            purse.saw(8);
            purse.pay(true, 80, EXTENT);
        }
        assert_eq!(ticks_left(&mut purse, 80), 1 + 20 + 2);
        // Ten looks of eight cells: 440 cells more are worth 55, a fifth of it 11.
        assert!(!purse.pay(true, 520, EXTENT) && !purse.is_empty());
        assert_eq!(ticks_left(&mut purse, 520), 11);
        // Less than half of the capital is not enough.
        purse.pay(true, 520 + 240, EXTENT);
        assert!(purse.is_empty());
    }

    #[test]
    fn nothing_is_paid_without_hints_and_for_looks_that_show_something() {
        let mut purse = Purse::new();
        for _ in 0..1000 {
            assert!(!purse.pay(false, 5, EXTENT));
        }
        for _ in 0..1000 {
            purse.saw(1);
            assert!(!purse.pay(true, 5, EXTENT));
        }
        assert_eq!(purse.paid, 0);
    }
}
