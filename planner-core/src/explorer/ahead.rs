//! What the last looks saw beside the robot: whether its next step can be made.

use super::body::saw_blocked;
use crate::cell::{Cell, Direction};
use crate::sight::Sighting;

/// Ticks that a step waits where the last look saw something in its way: enough for looks
/// that agree to turn a cell that was surely free into a wall.
pub(super) const MOST_WAITS: u8 = 8;

/// Whether a step can be made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Verdict {
    /// Make it.
    Go,
    /// Something is in the way: look again.
    Wait,
    /// What is in the way stays.
    Refused,
}

/// The last look, and what the place before it had shown.
#[derive(Debug)]
pub(super) struct Ahead {
    /// Where the last look was made.
    from: Cell,
    /// What it saw free there, see [`Sighting::free_near`].
    free: [u8; 5],
    /// Sides on which it saw the next cell blocked, a bit each.
    blocked: u8,
    /// Sides on which the last look from another place saw that cell free.
    was_free: u8,
    /// Ticks waited before a step.
    waits: u8,
}

impl Ahead {
    pub(super) const fn new() -> Self {
        Self {
            from: Cell::new(0, 0),
            free: [0; 5],
            blocked: 0,
            was_free: 0,
            waits: 0,
        }
    }

    /// Takes in a look.
    pub(super) fn look(&mut self, sighting: &Sighting, clearance: u8) {
        let here = sighting.centre();
        if here != self.from {
            self.was_free = sides(|side| self.saw_free(here.step(side)));
            self.from = here;
        }
        self.free = sighting.free_near();
        self.blocked = sides(|side| saw_blocked(sighting, clearance, here.step(side)));
        if clearance > 0 {
            // What it saw free is one cell of many.
            self.was_free = 0;
        }
    }

    fn saw_free(&self, cell: Cell) -> bool {
        let place = |at: i16, from: i16| usize::try_from(i32::from(at) - i32::from(from) + 2).ok();
        let (column, row) = (place(cell.x, self.from.x), place(cell.y, self.from.y));
        let row = row.and_then(|row| self.free.get(row));
        column
            .zip(row)
            .is_some_and(|(column, row)| column < self.free.len() && row >> column & 1 == 1)
    }

    /// Whether the last look saw the next cell on this side blocked, where the place before
    /// had shown it free. With a sensor whose errors hang on the place it is likely free.
    pub(super) fn is_contradicted(&self, side: Direction) -> bool {
        (self.blocked & self.was_free) >> side as u8 & 1 == 1
    }

    /// Whether this step can be made. With a sensor whose errors hang on the place
    /// (`errs_by_place`) looks from the same one do not make sure: what the place before
    /// contradicts is tried.
    pub(super) fn check(&mut self, step: Direction, errs_by_place: bool) -> Verdict {
        let is_blocked = self.blocked >> step as u8 & 1 == 1;
        if is_blocked && self.waits < MOST_WAITS {
            self.waits += 1;
            return Verdict::Wait;
        }
        self.waits = 0;
        match is_blocked && !(errs_by_place && self.is_contradicted(step)) {
            true => Verdict::Refused,
            false => Verdict::Go,
        }
    }
}

fn sides(holds: impl Fn(Direction) -> bool) -> u8 {
    Direction::ALL
        .into_iter()
        .filter(|side| holds(*side))
        .fold(0, |sides, side| sides | 1 << side as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    const A: Cell = Cell::new(3, 3);
    const B: Cell = Cell::new(4, 3);
    const C: Cell = Cell::new(5, 3);

    fn seen(from: Cell, free: bool) -> Sighting {
        let mut sighting = Sighting::new(from);
        match free {
            true => sighting.see_free(C),
            false => sighting.see_blocked(C),
        }
        sighting
    }

    /// Verdicts on the step from B to C: the number of waits, and what comes then.
    fn verdict(looks: &[(Cell, bool)], errs_by_place: bool) -> (u8, Verdict) {
        let mut ahead = Ahead::new();
        for &(from, free) in looks {
            ahead.look(&seen(from, free), 0);
        }
        let mut waits = 0;
        loop {
            match ahead.check(Direction::East, errs_by_place) {
                Verdict::Wait => waits += 1,
                verdict => return (waits, verdict),
            }
        }
    }

    #[test]
    fn what_is_in_the_way_is_waited_for_and_tried_only_where_another_place_saw_it_free() {
        for errs_by_place in [false, true] {
            let verdict = |looks: &[_]| verdict(looks, errs_by_place);
            assert_eq!(verdict(&[(A, true), (B, true)]), (0, Verdict::Go));
            assert_eq!(verdict(&[(A, false), (B, true)]), (0, Verdict::Go));
            let refused = (MOST_WAITS, Verdict::Refused);
            assert_eq!(verdict(&[(A, false), (B, false)]), refused);
            assert_eq!(verdict(&[(B, true), (B, false)]), refused);
            assert_eq!(verdict(&[(Cell::new(-9, 3), true), (B, false)]), refused);
            let tried = match errs_by_place {
                true => (MOST_WAITS, Verdict::Go),
                false => refused,
            };
            assert_eq!(verdict(&[(A, true), (B, false), (B, false)]), tried);
        }
    }
}
