//! Cells that are set aside: those that refused a step, and frontier cells from which no
//! look showed what is beside them. One bit a cell, and one age for all of them.
//!
//! A *round* begins with nothing set aside. A cell that refuses a step is closed: no way
//! leads over it. A frontier cell that shows nothing is no goal any more; ways lead over
//! it as before. Each refusal puts the end of the round off, by 4 ticks in the first
//! round, by twice as many in each further one; then all cells are tried again. The last
//! round that [`Config::patience`](super::Config::patience) allows has no end by time:
//! every way that is left is tried in it, however many cells refuse, before the robot
//! gives up. Robots walk away: where only they refuse, a round is the last one if the
//! patience has been used up by such rounds alone.
//!
//! Which of the two a cell is, the map tells: only a robot that stood on a cell can have
//! looked from it, so a visited frontier cell is one that shows nothing. Where such a
//! cell refuses a step too, all cells of the round count as closed.

use crate::cell::Cell;
use crate::tile::{TileIndex, Tiles};

/// Ticks from the last refusal to the end of the first round.
const FIRST_PAUSE: u32 = 4;
/// Limit of the doublings.
const LONGEST: u8 = 12;

/// What to do when nothing else is left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// No cell is set aside.
    Nothing,
    /// Wait for the end of the round.
    Wait,
    /// Begin a new round.
    Again,
    /// Give up: this cell refused.
    Blocked(Cell),
    /// Give up: a robot stayed on this cell.
    Held(Cell),
    /// Give up: no look showed this cell.
    Unseen(Cell),
}

/// The cells set aside since the round began. 8 bytes a tile, and 24.
#[derive(Debug)]
pub(crate) struct Aside<const TW: usize, const TH: usize> {
    cells: Tiles<u64, TW, TH>,
    /// A cell that refused, and one that no look showed.
    refused_at: Cell,
    unseen_at: Cell,
    /// The tick in which the round ends.
    until: u32,
    round: u8,
    /// Rounds in which only robots refused.
    held: u8,
    has_refused: bool,
    /// Whether something other than a robot refused.
    is_blocked: bool,
    /// Frontier cells that show nothing.
    unseen: u16,
    /// Whether the robot learnt anything in this round.
    has_learnt: bool,
    /// Whether a cell that shows nothing refused too.
    all_closed: bool,
}

impl<const TW: usize, const TH: usize> Aside<TW, TH> {
    pub(crate) const fn new() -> Self {
        Self {
            cells: Tiles::all(0),
            refused_at: Cell::new(0, 0),
            unseen_at: Cell::new(0, 0),
            until: 0,
            round: 0,
            held: 0,
            has_refused: false,
            is_blocked: false,
            unseen: 0,
            has_learnt: false,
            all_closed: false,
        }
    }

    /// Tries everything again, as if nothing had been tried before. Work: a word a tile.
    pub(crate) fn reset(&mut self) {
        self.begin_round();
        self.round = 0;
        self.held = 0;
    }

    fn begin_round(&mut self) {
        if self.has_refused || self.unseen > 0 {
            self.cells.fill(0);
        }
        self.has_refused = false;
        self.is_blocked = false;
        self.unseen = 0;
        self.has_learnt = false;
        self.all_closed = false;
    }

    /// Ends the round if it is time. Says whether cells are tried again. Work: nothing,
    /// or a word a tile.
    pub(crate) fn tick(&mut self, patience: u8, now: u32) -> bool {
        let is_over = self.has_refused && !self.is_last_round(patience) && now >= self.until;
        if is_over {
            self.next_round(patience, now);
        }
        is_over
    }

    /// Begins a new round. Work: a word a tile.
    pub(crate) fn next_round(&mut self, patience: u8, now: u32) {
        // Cells that were not waited for are none the surer for it.
        if self.has_refused && now >= self.until {
            let last = patience.saturating_sub(1);
            self.round = self.round.saturating_add(1).min(last);
            self.held = self.held.saturating_add(u8::from(!self.is_blocked));
        }
        self.begin_round();
    }

    const fn is_last_round(&self, patience: u8) -> bool {
        let is_sure = self.is_blocked || self.held.saturating_add(1) >= patience;
        is_sure && self.round.saturating_add(1) >= patience
    }

    /// A cell could not be entered.
    pub(crate) fn refuse(&mut self, cell: Cell, by_robot: bool, now: u32) {
        if !by_robot || !self.is_blocked {
            self.refused_at = cell;
        }
        self.has_refused = true;
        self.is_blocked |= !by_robot;
        let pause = FIRST_PAUSE
            << if self.round < LONGEST {
                self.round
            } else {
                LONGEST
            };
        self.until = now.saturating_add(pause);
        self.all_closed |= !self.add(cell);
    }

    /// No look from this frontier cell showed `unseen` beside it.
    pub(crate) fn show_nothing(&mut self, frontier: Cell, unseen: Cell) {
        self.unseen_at = unseen;
        if self.add(frontier) {
            self.unseen = self.unseen.saturating_add(1);
        }
    }

    /// Sets a cell aside; false if it was before.
    pub(crate) fn add(&mut self, cell: Cell) -> bool {
        let Some((word, bit)) = self.word_mut(cell) else {
            return true;
        };
        let is_new = *word & bit == 0;
        *word |= bit;
        is_new
    }

    /// The robot learnt something: what refused is tried again soon.
    pub(crate) fn renew(&mut self) {
        self.round = self.round.min(1);
        self.held = self.held.min(1);
        self.has_learnt = true;
    }

    fn word_mut(&mut self, cell: Cell) -> Option<(&mut u64, u64)> {
        let (at, bit) = TileIndex::of(cell)?;
        Some((self.cells.get_mut(at)?, bit))
    }

    /// Whether a cell refused a step in this round.
    pub(crate) const fn has_refused(&self) -> bool {
        self.has_refused
    }

    /// The cells of a tile that are no goals.
    pub(crate) fn cells(&self, at: TileIndex) -> u64 {
        if !self.has_refused && self.unseen == 0 {
            return 0;
        }
        self.cells.word(at)
    }

    /// The cells of a tile that no way leads over; `looked_from` are the frontier cells of
    /// it on which somebody has stood. Work: one word, and `looked_from` where one of them is
    /// set aside.
    #[inline] // mostly there are none
    pub(crate) fn closed(&self, at: TileIndex, looked_from: impl FnOnce() -> u64) -> u64 {
        if !self.has_refused {
            return 0;
        }
        let cells = self.cells(at);
        if cells == 0 || self.all_closed || self.unseen == 0 {
            return cells;
        }
        cells & !looked_from()
    }

    /// What is to be done if of so many frontier cells none is left that is worth a look.
    pub(crate) fn verdict(&self, patience: u8, frontiers: u32, now: u32) -> Verdict {
        let all_unseen = self.unseen > 0 && u32::from(self.unseen) >= frontiers;
        if all_unseen || !self.has_refused && self.unseen > 0 {
            return match self.has_learnt {
                true => Verdict::Again,
                false => Verdict::Unseen(self.unseen_at),
            };
        }
        self.verdict_on_ways(patience, now)
    }

    /// What is to be done if no way leads to a cell.
    pub(crate) fn verdict_on_ways(&self, patience: u8, now: u32) -> Verdict {
        match self.has_refused {
            false => Verdict::Nothing,
            true if self.is_last_round(patience) => match self.is_blocked {
                true => Verdict::Blocked(self.refused_at),
                false => Verdict::Held(self.refused_at),
            },
            true if now < self.until => Verdict::Wait,
            true => Verdict::Again,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cell::Extent;
    use crate::map::Map;

    type Small = Aside<3, 3>;

    const PATIENCE: u8 = 3;

    #[test]
    fn a_round_ends_a_while_after_the_last_refusal_and_the_last_one_never() {
        let mut aside = Small::new();
        let doors: std::vec::Vec<Cell> = (0..24).map(|y| Cell::new(9, y)).collect();
        let closed = |aside: &Small| -> u32 {
            (0..9)
                .map(|i| {
                    aside
                        .closed(TileIndex::new(i % 3, i / 3), || 0)
                        .count_ones()
                })
                .sum()
        };
        let mut now = 0;
        for pause in [4, 8] {
            for &door in &doors {
                now += 3;
                assert!(!aside.tick(PATIENCE, now));
                aside.refuse(door, false, now);
            }
            assert_eq!(closed(&aside), 24);
            assert_eq!(aside.verdict(PATIENCE, 30, now), Verdict::Wait);
            assert!(!aside.tick(PATIENCE, now + pause - 1));
            now += pause;
            assert!(aside.tick(PATIENCE, now));
            assert_eq!(closed(&aside), 0);
        }
        for &door in &doors {
            now += 100_000;
            assert!(!aside.tick(PATIENCE, now));
            aside.refuse(door, false, now);
        }
        assert_eq!(closed(&aside), 24);
        assert_eq!(
            aside.verdict(PATIENCE, 30, now),
            Verdict::Blocked(doors[23])
        );
        aside.renew();
        assert!(aside.tick(PATIENCE, now + 100), "something was learnt");
    }

    #[test]
    fn only_robots_in_the_way_are_told_apart() {
        let mut aside = Small::new();
        aside.refuse(Cell::new(3, 3), true, 0);
        assert_eq!(aside.verdict(1, 30, 0), Verdict::Held(Cell::new(3, 3)));
        aside.refuse(Cell::new(4, 3), false, 0);
        assert_eq!(aside.verdict(1, 30, 0), Verdict::Blocked(Cell::new(4, 3)));
    }

    #[test]
    fn robots_have_a_patience_of_their_own() {
        let door = Cell::new(3, 3);
        let mut aside = Small::new();
        let mut now = 0;
        let mut refuse = |aside: &mut Small, by_robot| {
            now += 1000;
            aside.refuse(door, by_robot, now);
            (
                aside.verdict(PATIENCE, 30, now),
                aside.tick(PATIENCE, now + 100),
            )
        };
        for _ in 1..PATIENCE {
            assert_eq!(refuse(&mut aside, false), (Verdict::Wait, true));
        }
        for _ in 1..PATIENCE {
            assert_eq!(refuse(&mut aside, true), (Verdict::Wait, true));
        }
        assert_eq!(refuse(&mut aside, true), (Verdict::Held(door), false));
    }

    #[test]
    fn what_shows_nothing_is_no_goal_but_a_way() {
        let mut map = Map::<3, 3>::new(Extent::new(24, 24)).unwrap();
        let frontier = Cell::new(5, 5);
        map.observe(&crate::sight::Sighting::new(frontier));
        map.stand(frontier);
        let (at, bit) = TileIndex::of(frontier).unwrap();
        let mut aside = Small::new();
        aside.show_nothing(frontier, Cell::new(6, 5));
        assert_eq!(
            (
                aside.cells(at),
                aside.closed(at, || map.tile(at).visited() & map.frontier(at))
            ),
            (bit, 0)
        );
        assert_eq!(aside.verdict(8, 30, 0), Verdict::Unseen(Cell::new(6, 5)));
        let (_, other) = TileIndex::of(Cell::new(1, 1)).unwrap();
        aside.refuse(Cell::new(1, 1), false, 0);
        assert_eq!(
            (
                aside.cells(at),
                aside.closed(at, || map.tile(at).visited() & map.frontier(at))
            ),
            (bit | other, other)
        );
        assert_eq!(aside.verdict(8, 1, 0), Verdict::Unseen(Cell::new(6, 5)));
        aside.refuse(frontier, false, 0);
        assert_eq!(
            aside.closed(at, || map.tile(at).visited() & map.frontier(at)),
            bit | other
        );
        aside.next_round(8, 9);
        assert_eq!(
            (aside.cells(at), aside.verdict(8, 30, 9)),
            (0, Verdict::Nothing)
        );
    }

    #[test]
    fn what_shows_nothing_is_tried_again_once_something_else_was_learnt() {
        let mut aside = Small::new();
        aside.show_nothing(Cell::new(5, 5), Cell::new(6, 5));
        aside.renew();
        assert_eq!(aside.verdict(8, 30, 0), Verdict::Again);
        aside.next_round(8, 9);
        aside.show_nothing(Cell::new(5, 5), Cell::new(6, 5));
        assert_eq!(aside.verdict(8, 30, 0), Verdict::Unseen(Cell::new(6, 5)));
    }
}
