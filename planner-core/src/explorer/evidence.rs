//! What looks are worth: votes near the robot, decisions on the map.
//!
//! Looks are wrong now and then. So a wall is believed, and a cell that is known changes,
//! only when a margin of votes speaks for it. Votes are counted in a window around the
//! robot and never leave it; what is decided stands on the map, where levels only rise
//! ([`Level`]). In a world where looks are right nothing takes longer: the first look
//! makes a cell free at once, or doubtful, and a doubtful cell is as good as unknown: the
//! robot goes there and looks again.

use crate::cell::{Cell, Direction};
use crate::map::{Learnt, Level, Map};
use crate::sight::{MAX_RADIUS, Sighting};
use crate::tile::TileIndex;
use crate::zeroed::Maybe;

use super::window::Window;

/// How far the looks of a sensor can be believed.
///
/// If votes are independent and wrong with probability `p < ½`, a decision at margin `n`
/// is wrong with `1 / (1 + ((1 - p) / p)ⁿ)` (Wald's sequential test \[Wald1945\]):
///
/// | wrong looks | margin 1 | 2 | 3 |
/// |---|---|---|---|
/// | 1 % | 1 % | 0.01 % | 0.0001 % |
/// | 5 % | 5 % | 0.3 % | 0.015 % |
/// | 20 % | 20 % | 6 % | 1.5 % |
///
/// A wall that is not there hides what is behind it with that probability for each cell
/// of the narrowest passage. So `n` is the least margin for which it, times the free
/// cells of the place, is below the share of wrong stops that can be borne.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SensorModel {
    /// Votes by which one side leads before a cell is decided, 1 to 3; others are brought
    /// into these bounds.
    pub margin: u8,
    /// Which looks vote.
    pub votes: Votes,
    /// How far from the robot, in cells each way, a cell may be so that looks at it can
    /// make it a wall. What is blocked farther away is doubtful until seen from near.
    pub sure_range: u8,
    /// How far, in cells each way, a cell may be so that looks speak against it once it is
    /// known. What agrees counts from as far as `sure_range`.
    pub flip_range: u8,
    /// The same for cells on which somebody has stood.
    pub visited_range: u8,
    /// Whether the sensor sees other robots: what is blocked within a step of the body of a
    /// robot that was heard just now, or has stopped there, is then left out of a look. In a
    /// look that the robot asked for that holds for known cells alone, so that a robot that
    /// is only pretended hides no wall for long.
    pub sees_robots: bool,
}

/// Which looks vote.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Votes {
    /// Every look votes on doubtful cells, one a tick on known ones: for a sensor whose
    /// errors come and go.
    PerLook,
    /// A look from another cell than the last one that voted; where the robot stands still
    /// before something doubtful, one look a tick on the cells beside it: for errors that a
    /// place has (angles, gaps between beams, a pose that is off).
    PerPlace,
}

impl SensorModel {
    /// A sensor that is always right: the first look decides.
    pub const fn truthful() -> Self {
        Self {
            margin: 1,
            votes: Votes::PerLook,
            sure_range: u8::MAX,
            flip_range: u8::MAX,
            visited_range: u8::MAX,
            sees_robots: false,
        }
    }

    /// A laser scanner with three looks or more a step: errors that come and go.
    pub const fn lidar() -> Self {
        Self {
            margin: 3,
            votes: Votes::PerLook,
            sure_range: u8::MAX,
            flip_range: 8,
            visited_range: 2,
            sees_robots: true,
        }
    }

    /// A few range sensors, one look a step: errors that come and go, that hang on the
    /// place, and poses that are a cell off now and then. A sensor that sees things from
    /// afar that are not there wants a `sure_range` of 2.
    pub const fn rangers() -> Self {
        Self {
            margin: 3,
            votes: Votes::PerPlace,
            sure_range: 4,
            flip_range: 2,
            visited_range: 2,
            sees_robots: true,
        }
    }

    pub(super) const fn vacant() -> Self {
        Self {
            margin: 0,
            votes: Votes::PerLook,
            sure_range: 0,
            flip_range: 0,
            visited_range: 0,
            sees_robots: false,
        }
    }

    /// What a cell is that one look shows blocked beyond [`MAX_RADIUS`].
    pub(super) fn far_wall(&self) -> Level {
        match self.margin() {
            1 if self.sure_range > MAX_RADIUS => Level::Wall,
            _ => Level::Doubtful,
        }
    }

    fn margin(&self) -> u8 {
        self.margin.clamp(1, LARGEST_MARGIN)
    }

    /// Looks without anything new before a margin of one is in force.
    pub(super) fn barren_looks(&self) -> u8 {
        (self.margin() - 1) * BARREN
    }
}

impl Default for SensorModel {
    fn default() -> Self {
        Self::truthful()
    }
}

const LARGEST_MARGIN: u8 = 3;
/// Barren ticks after which the margin falls by one.
const BARREN: u8 = 8;

/// The votes in the 4×4 tiles around the robot. 416 bytes, whatever the map.
#[derive(Debug)]
pub(super) struct Evidence {
    window: Window,
    /// That of the tile `(x, y)` lies at `x mod 4 + 4 · (y mod 4)`.
    counts: [Counts; Window::TILES],
    /// Where the last look that voted was made.
    voted_from: Maybe<Cell>,
    /// Whether a look has voted on known cells in this tick.
    has_voted: bool,
    /// Ticks on frontier cells since something was learnt.
    barren: u8,
    /// Whether the last look showed a wall free from near.
    is_disputed: bool,
    strain: Strain,
}

impl Evidence {
    pub(super) const fn new() -> Self {
        Self {
            window: Window::new(),
            counts: [Counts::NONE; Window::TILES],
            voted_from: Maybe::Nothing,
            has_voted: false,
            barren: 0,
            is_disputed: false,
            strain: Strain::NONE,
        }
    }

    pub(super) fn reset(&mut self) {
        *self = Self::new();
    }

    /// Another tick: a look may change known cells again.
    pub(super) fn tick(&mut self) {
        self.has_voted = false;
    }

    /// A tick that begins on a frontier cell.
    pub(super) fn rest(&mut self) {
        self.barren = self.barren.saturating_add(1);
    }

    /// Something was learnt.
    pub(super) fn renew(&mut self) {
        self.barren = 0;
    }

    /// Something that was seen free was told to be a wall.
    pub(super) fn dispute(&mut self) {
        self.is_disputed = true;
    }

    /// Whether the last look showed a wall of the map free, from so near that looks can
    /// change it.
    pub(super) fn is_disputed(&self) -> bool {
        self.is_disputed
    }

    /// Whether the looks have contradicted the map for long.
    pub(super) fn is_lost(&self) -> bool {
        self.strain.is_too_much()
    }

    /// The count of votes of a cell, -3 to 3: above 0 for a wall.
    pub(super) fn votes(&self, cell: Cell) -> i8 {
        let Some((at, bit)) = TileIndex::of(cell) else {
            return 0;
        };
        let at = (i16::from(at.x), i16::from(at.y));
        let is_held = self.window.holds(at);
        let counts = self.counts.get(Window::slot(at)).filter(|_| is_held);
        counts.map_or(0, |counts| counts.of(bit))
    }

    /// Ticks on frontier cells since something was learnt, up to 255.
    pub(super) fn barren(&self) -> u8 {
        self.barren
    }

    /// Takes in what was seen from a cell of the extent; `purpose` says what the robot
    /// stands there for, `bodies` in which cells of a tile the look may show other
    /// robots, which are left out. Work: at most 25 tiles, each with its four
    /// neighbours.
    pub(super) fn observe<const TW: usize, const TH: usize>(
        &mut self,
        map: &mut Map<TW, TH>,
        sighting: &Sighting,
        model: &SensorModel,
        purpose: Purpose,
        bodies: impl Fn(TileIndex) -> u64,
    ) -> Learnt {
        let centre = sighting.centre();
        self.follow(centre);
        let is_first = !self.has_voted;
        // Otherwise a look votes on what it is made for alone.
        let votes_on_all = model.votes == Votes::PerLook || self.voted_from.get() != Some(centre);
        let votes = votes_on_all || purpose != Purpose::None && is_first;
        let flips = votes && is_first;
        if votes {
            self.voted_from = Maybe::Just(centre);
            self.has_voted = true;
        }
        let margin = model.margin().saturating_sub(self.barren / BARREN).max(1);
        let mut learnt = map.stand(centre);
        if let Some((at, bit)) = TileIndex::of(centre)
            && let Some(counts) = self.counts_mut(at)
        {
            counts.set_least(bit);
        }
        self.strain.relax();
        let mut disputed = 0;
        for at in sighting.tiles() {
            let (free, mut blocked) = sighting.tile(at);
            let minded = !map.kept_out(at);
            let free = free & minded;
            blocked &= minded;
            if model.sees_robots && blocked != 0 {
                let mut hidden = bodies(at);
                if purpose != Purpose::None {
                    // Only what is known: a robot that is only pretended hides nothing for
                    // long.
                    hidden &= map.tile(at).known();
                }
                blocked &= !hidden;
            }
            if free | blocked == 0 {
                continue;
            }
            let before = map.tile(at);
            let (known, doubtful) = (before.known(), before.doubtful());
            let walls = (before.obstacle() | doubtful) & near(at, centre, STRAIN_RANGE);
            self.strain.add(walls & free, walls & blocked);
            let unknown = !(known | doubtful);
            let mut after = before
                .with(unknown & free, Level::Free)
                .with(unknown & blocked, Level::Doubtful);
            let mut may_vote = unknown;
            if votes {
                may_vote |= doubtful;
            }
            let within = near(at, centre, model.sure_range);
            if flips {
                may_vote |= (before.free() & free | before.obstacle() & blocked) & within;
                let visited = before.visited();
                may_vote |= known & !visited & near(at, centre, model.flip_range);
                may_vote |= visited & near(at, centre, model.visited_range);
            }
            if !votes_on_all {
                may_vote &= match purpose {
                    Purpose::None => unknown,
                    Purpose::Sides(sides) => unknown | beside(at, centre, sides),
                    Purpose::Within(range) => unknown | near(at, centre, range),
                    Purpose::Walls => unknown | before.obstacle() & free,
                };
            }
            let against = free & may_vote;
            let sure = known | within;
            let towards = blocked & may_vote & sure;
            let mut none = Counts::NONE;
            // Beyond the window a look stands alone.
            let counts = self.counts_mut(at).unwrap_or(&mut none);
            counts.raise(towards);
            counts.raise(towards & sighting.firm_tile(at));
            counts.lower(against);
            let walls = towards & counts.at_least(margin);
            after = after
                .with(walls & !before.high(), Level::Wall)
                .with(walls & before.at(Level::FreeAgain), Level::WallAgain);
            let gaps = against & counts.at_most(margin);
            after = after
                .with(gaps & before.at(Level::Wall), Level::FreeAgain)
                .with(gaps & before.at(Level::WallAgain), Level::FreeForGood)
                .with(doubtful & free & !counts.at_least(1), Level::Free);
            let walls = after.obstacle() & free & near(at, centre, model.flip_range);
            disputed |= walls;
            learnt += map.join_tile(at, after);
        }
        self.is_disputed = disputed != 0;
        learnt
    }

    /// The robot is at `centre`: votes that leave the window are forgotten. Work: 16 words
    /// times 3.
    fn follow(&mut self, centre: Cell) {
        let window = Window::around(centre);
        if window == self.window {
            return;
        }
        for (at, slot) in window.slots() {
            if !self.window.holds(at)
                && let Some(counts) = self.counts.get_mut(slot)
            {
                *counts = Counts::NONE;
            }
        }
        self.window = window;
    }

    fn counts_mut(&mut self, at: TileIndex) -> Option<&mut Counts> {
        let (x, y) = (i16::from(at.x), i16::from(at.y));
        if !self.window.holds((x, y)) {
            return None;
        }
        self.counts.get_mut(Window::slot((x, y)))
    }
}

/// What a robot that stands still looks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Purpose {
    None,
    /// The cells beside it on these sides, a bit each.
    Sides(u8),
    /// The cells around it, so far each way.
    Within(u8),
    /// Walls of the map that it sees free.
    Walls,
}

/// The cells of a tile beside `centre` on these sides.
fn beside(at: TileIndex, centre: Cell, sides: u8) -> u64 {
    Direction::ALL
        .into_iter()
        .filter(|side| sides >> *side as u8 & 1 == 1)
        .filter_map(|side| TileIndex::of(centre.step(side)))
        .filter(|(tile, _)| *tile == at)
        .fold(0, |cells, (_, bit)| cells | bit)
}

/// How far walls are compared with looks, in cells each way.
const STRAIN_RANGE: u8 = 8;

/// How far looks agree with the map: of its walls that they show again, those that they
/// show free. A robot that has lost its way, and no other in nine public logs of scans,
/// shows most of them free. Both sums forget a sixteenth a look.
#[derive(Clone, Copy, Debug)]
struct Strain {
    /// Sixteenths of cells.
    contradicted: u32,
    shown: u32,
}

impl Strain {
    const NONE: Self = Self {
        contradicted: 0,
        shown: 0,
    };
    /// Walls that the last looks must have shown.
    const LEAST: u32 = 40;

    fn relax(&mut self) {
        self.contradicted -= self.contradicted / 16;
        self.shown -= self.shown / 16;
    }

    fn add(&mut self, free: u64, blocked: u64) {
        self.contradicted += 16 * free.count_ones();
        self.shown += 16 * (free | blocked).count_ones();
    }

    const fn is_too_much(self) -> bool {
        self.shown >= 16 * Self::LEAST && 5 * self.contradicted >= 3 * self.shown
    }
}

/// The cells of a tile at most so many cells from `centre` each way.
fn near(at: TileIndex, centre: Cell, range: u8) -> u64 {
    if range >= MAX_RADIUS {
        return u64::MAX;
    }
    at.near(centre, range)
}

/// A counter for each cell of a tile, -3 to 3, a bit of its two's complement a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Counts([u64; 3]);

impl Counts {
    const NONE: Self = Self([0; 3]);

    /// That of one cell, given as its bit.
    const fn of(&self, bit: u64) -> i8 {
        let [a, b, c] = self.0;
        (a & bit != 0) as i8 + 2 * (b & bit != 0) as i8 - 4 * (c & bit != 0) as i8
    }

    /// One more for these cells, up to 3.
    fn raise(&mut self, cells: u64) {
        let [a, b, c] = &mut self.0;
        let carry = cells & !(*a & *b & !*c);
        let into_b = *a & carry;
        let into_c = *b & into_b;
        *a ^= carry;
        *b ^= into_b;
        *c ^= into_c;
    }

    /// One less for these cells, down to -3.
    fn lower(&mut self, cells: u64) {
        let [a, b, c] = &mut self.0;
        let borrow = cells & !(*a & !*b & *c);
        let from_b = !*a & borrow;
        let from_c = !*b & from_b;
        *a ^= borrow;
        *b ^= from_b;
        *c ^= from_c;
    }

    /// -3 for these cells.
    fn set_least(&mut self, cells: u64) {
        let [a, b, c] = &mut self.0;
        *a |= cells;
        *b &= !cells;
        *c |= cells;
    }

    /// Cells that count at least `n`, 1 to 3.
    fn at_least(&self, n: u8) -> u64 {
        let [a, b, c] = self.0;
        !c & match n {
            0 | 1 => a | b,
            2 => b,
            _ => a & b,
        }
    }

    /// Cells that count at most `-n`, 1 to 3.
    fn at_most(&self, n: u8) -> u64 {
        let [a, b, c] = self.0;
        c & match n {
            0 | 1 => u64::MAX,
            2 => !(a & b),
            _ => !b,
        }
    }
}
#[cfg(test)]
mod tests;
