//! What a planner is told of a look: cells mistaken, and laid where the robot believes to be.

use std::borrow::Cow;

use planner_core::{Cell, Direction, Extent, Sighting};

use crate::dice::Lot;
use crate::scenario::{ErrorKind, Trouble};

/// One look of a run.
#[derive(Clone, Copy, Debug)]
pub struct Look {
    /// When.
    pub tick: u32,
    /// Which of this tick, from 0.
    pub number: u8,
    /// Whose.
    pub robot: usize,
}

/// Kinds of chance that have nothing to do with each other.
enum Of {
    Cells = 1,
    Places,
    Slips,
}

/// The errors of all looks of a run.
#[derive(Debug)]
pub(super) struct Errors {
    trouble: Trouble,
    lot: Lot,
    range: u8,
    extent: Extent,
    /// How far off each robot's pose is, as (x, y).
    slips: Vec<(i16, i16)>,
}

impl Errors {
    pub(super) fn new(
        trouble: Trouble,
        seed: u64,
        range: u8,
        extent: Extent,
        robots: usize,
    ) -> Self {
        Self {
            trouble,
            lot: Lot::new(seed),
            range,
            extent,
            slips: vec![(0, 0); robots],
        }
    }

    /// A tick begins; the poses slip if it is time.
    pub(super) fn begin(&mut self, tick: u32) {
        if tick == 0 || self.trouble.drift == 0 || !tick.is_multiple_of(self.trouble.drift) {
            return;
        }
        for (slip, robot) in self.slips.iter_mut().zip(0u64..) {
            let lot = self.lot.of(Of::Slips as u64).of(tick.into()).of(robot);
            let (x, y) = Direction::from_index(lot.below(4) as u8).delta();
            *slip = (slip.0.saturating_add(x), slip.1.saturating_add(y));
        }
    }

    /// What is told of what is seen.
    pub(super) fn told<'a>(&self, look: Look, seen: Cow<'a, Sighting>) -> Cow<'a, Sighting> {
        let told = self.mistaken(look, seen);
        let at = told.centre();
        match self.place(look, at) {
            place if place == at => told,
            place => Cow::Owned(laid(&told, place)),
        }
    }

    fn mistaken<'a>(&self, look: Look, seen: Cow<'a, Sighting>) -> Cow<'a, Sighting> {
        let Trouble {
            false_walls,
            false_frees,
            error_kind,
            ..
        } = self.trouble;
        if false_walls <= 0.0 && false_frees <= 0.0 {
            return seen;
        }
        let at = seen.centre();
        let lot = self.lot.of(Of::Cells as u64);
        let lot = match error_kind {
            ErrorKind::Viewpoint => lot.at(at),
            ErrorKind::Transient | ErrorKind::Far => of(lot, look),
        };
        // Twice the distance is more than the range.
        let is_far = |cell: Cell| 4 * cell.distance_squared(at) > u32::from(self.range).pow(2);
        let errs = |cell: Cell, share| {
            (error_kind != ErrorKind::Far || is_far(cell)) && lot.at(cell).happens(share)
        };
        let mut told = Sighting::new(at);
        for cell in seen.free_cells() {
            match errs(cell, false_walls) {
                true => told.see_blocked(cell),
                false => told.see_free(cell),
            }
        }
        for cell in seen.blocked_cells() {
            match errs(cell, false_frees) {
                true => told.see_free(cell),
                false => told.see_blocked(cell),
            }
        }
        Cow::Owned(told)
    }

    /// Where a robot at `at` believes to be by this look: in the world.
    fn place(&self, look: Look, at: Cell) -> Cell {
        let (mut x, mut y) = self.slips.get(look.robot).copied().unwrap_or((0, 0));
        let lot = of(self.lot.of(Of::Places as u64), look);
        if lot.happens(self.trouble.misplaced) {
            // One of the eight cells around (0, 0).
            let number = match lot.of(0).below(8) as i16 {
                number @ 0..4 => number,
                number => number + 1,
            };
            x = x.saturating_add(number % 3 - 1);
            y = y.saturating_add(number / 3 - 1);
        }
        let into = |at: i16, by: i16, length: u16| {
            let last = length.min(i16::MAX as u16) as i16 - 1;
            at.saturating_add(by).clamp(0, last)
        };
        Cell::new(
            into(at.x, x, self.extent.width),
            into(at.y, y, self.extent.height),
        )
    }
}

fn of(lot: Lot, look: Look) -> Lot {
    lot.of(look.tick.into())
        .of(look.number.into())
        .of(look.robot as u64)
}

/// The same look, around another place.
pub(crate) fn laid(sighting: &Sighting, place: Cell) -> Sighting {
    let at = sighting.centre();
    let moved = |cell: Cell| Cell::new(cell.x - at.x + place.x, cell.y - at.y + place.y);
    let mut shown = Sighting::new(place);
    sighting
        .free_cells()
        .for_each(|cell| shown.see_free(moved(cell)));
    sighting
        .blocked_cells()
        .for_each(|cell| shown.see_blocked(moved(cell)));
    shown
}

#[cfg(test)]
mod tests {
    use super::*;

    const EXTENT: Extent = Extent::new(40, 40);
    const AT: Cell = Cell::new(20, 20);
    const LOOKS: u32 = 400;

    /// Two columns of obstacles, seen with range 6.
    fn seen() -> Sighting {
        planner_core::sight::look(AT, 6, |cell| cell.x == 17 || cell.x == 23)
    }

    fn errors(trouble: Trouble) -> Errors {
        Errors::new(trouble, 9, 6, EXTENT, 2)
    }

    fn told(errors: &Errors, tick: u32, number: u8, robot: usize) -> Sighting {
        let look = Look {
            tick,
            number,
            robot,
        };
        errors.told(look, Cow::Owned(seen())).into_owned()
    }

    /// Shares of the free and of the blocked cells that are told otherwise, among those for
    /// which `counts` holds.
    fn shares(errors: &Errors, counts: impl Fn(Cell) -> bool) -> [f64; 2] {
        let seen = seen();
        let (mut wrong, mut all) = ([0.0; 2], [0.0; 2]);
        for tick in 0..LOOKS {
            let told = told(errors, tick, 0, 0);
            for cell in seen.free_cells().filter(|&cell| cell != AT && counts(cell)) {
                all[0] += 1.0;
                wrong[0] += f64::from(u8::from(told.is_blocked(cell)));
            }
            for cell in seen.blocked_cells().filter(|&cell| counts(cell)) {
                all[1] += 1.0;
                wrong[1] += f64::from(u8::from(told.is_free(cell)));
            }
        }
        [wrong[0] / all[0], wrong[1] / all[1]]
    }

    fn assert_near(share: f64, expected: f64) {
        assert!((share - expected).abs() < 0.05, "{share}, not {expected}");
    }

    #[test]
    fn cells_are_mistaken_as_often_as_is_said_and_anew_by_each_look() {
        let walls = errors(Trouble {
            false_walls: 0.1,
            ..Trouble::default()
        });
        let [closed, opened] = shares(&walls, |_| true);
        assert_near(closed, 0.1);
        assert_eq!(opened, 0.0);
        let both = errors(Trouble {
            false_walls: 0.3,
            false_frees: 0.2,
            ..Trouble::default()
        });
        let [closed, opened] = shares(&both, |_| true);
        assert_near(closed, 0.3);
        assert_near(opened, 0.2);
        let first = told(&both, 5, 0, 0);
        assert_eq!(first, told(&both, 5, 0, 0));
        for (tick, number, robot) in [(6, 0, 0), (5, 1, 0), (5, 0, 1)] {
            assert_ne!(first, told(&both, tick, number, robot));
        }
    }

    #[test]
    fn errors_of_a_viewpoint_stay_and_those_from_afar_are_far() {
        let trouble = Trouble {
            false_walls: 0.3,
            false_frees: 0.3,
            ..Trouble::default()
        };
        let viewpoint = errors(Trouble {
            error_kind: ErrorKind::Viewpoint,
            ..trouble
        });
        assert_ne!(told(&viewpoint, 0, 0, 0), seen());
        for (tick, number, robot) in [(6, 0, 0), (5, 1, 0), (5, 0, 1)] {
            assert_eq!(
                told(&viewpoint, 0, 0, 0),
                told(&viewpoint, tick, number, robot)
            );
        }
        let far = errors(Trouble {
            error_kind: ErrorKind::Far,
            ..trouble
        });
        assert_eq!(
            shares(&far, |cell| cell.distance_squared(AT) <= 9),
            [0.0; 2]
        );
        let beyond = shares(&far, |cell| cell.distance_squared(AT) > 9);
        for share in beyond {
            assert_near(share, 0.3);
        }
    }

    #[test]
    fn a_misplaced_look_lies_one_cell_off_as_a_whole() {
        let misplaced = errors(Trouble {
            misplaced: 0.25,
            ..Trouble::default()
        });
        let mut centres = Vec::new();
        for tick in 0..LOOKS {
            let told = told(&misplaced, tick, 0, 0);
            assert_eq!(told, laid(&seen(), told.centre()));
            assert!(told.centre().chebyshev(AT) <= 1);
            centres.push(told.centre());
        }
        let off = centres.iter().filter(|&&centre| centre != AT).count();
        assert_near(off as f64 / f64::from(LOOKS), 0.25);
        centres.sort_unstable_by_key(|cell| (cell.y, cell.x));
        centres.dedup();
        assert_eq!(centres.len(), 9);
    }

    #[test]
    fn a_pose_drifts_by_one_cell_each_time_and_stays_in_the_world() {
        let mut drifting = errors(Trouble {
            drift: 10,
            ..Trouble::default()
        });
        let mut last = [AT; 2];
        for tick in 0..4000 {
            drifting.begin(tick);
            for (robot, last) in last.iter_mut().enumerate() {
                let centre = told(&drifting, tick, 0, robot).centre();
                assert!(EXTENT.contains(centre));
                let steps = centre.chebyshev(*last);
                assert!(
                    steps <= u16::from(tick > 0 && tick % 10 == 0),
                    "tick {tick}"
                );
                *last = centre;
            }
        }
        assert!(last[0] != AT && last[1] != AT && last[0] != last[1]);
    }
}
