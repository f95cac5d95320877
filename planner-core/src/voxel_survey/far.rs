//! The nearest pose far away that is not done: a wave over all poses, in slices. And one from
//! home, over which the robot flies back.

use super::{SLICE, VoxelSurvey, WAY};
use crate::tile::TileIndex;
use crate::volume::{Layer, Voxel, beside, word_work};

/// Work of a word that the wave may enter, and of a step back.
const WORD: u32 = 7;
pub(super) const HOME_WORD: u32 = WORD;
const BACK: u32 = 16;

/// The northernmost and the southernmost row of a tile.
const FIRST_ROW: u64 = 0xff;
const LAST_ROW: u64 = FIRST_ROW << 56;

/// What a step of the search came to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Found {
    /// The way there lies ready.
    Way,
    /// Nothing yet.
    Searching,
    /// Every pose that can be reached is done.
    Nothing,
}

/// The same of the search for the way home.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Homeward {
    /// So many steps lead there.
    Found(u32),
    /// Nothing yet.
    Searching,
    /// No way leads there.
    Nothing,
}

/// Where the search stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    Idle,
    /// The wave spreads; the number of known voxels when it began.
    Wave {
        known: u32,
    },
    /// The way is followed back from the goal, and is here.
    Back(Voxel),
    /// A wave from home spreads; the number of known voxels when it began.
    FromHome {
        known: u32,
    },
    /// It has reached the robot: distances lead home.
    Homeward,
}

/// A wave from the robot, or from home, over all poses. A pose's distance is kept modulo 3, plus one, in
/// two bits; 0 is not reached.
#[derive(Clone, Debug)]
pub(super) struct Far<const TW: usize, const TH: usize, const L: usize> {
    stage: Stage,
    low: Layer<TW, TH, L>,
    high: Layer<TW, TH, L>,
    /// The distance of what is reached next: modulo 3, and all of it.
    layer: u8,
    steps: u32,
    /// Rows of tiles of each level that the wave may enter now, and those behind them. Only
    /// beside what it reached last.
    rows: [u64; L],
    next_rows: [u64; L],
    /// Where the look at them stands.
    cursor: (TileIndex, u8),
    /// Poses of the word at the cursor that are left to rivals.
    passed: u64,
    /// The first pose of all that shows something and is left to a rival.
    spare: Option<Voxel>,
}

impl<const TW: usize, const TH: usize, const L: usize> Far<TW, TH, L> {
    /// All zero, until [`reset`](Self::reset).
    pub(super) const fn vacant() -> Self {
        Self {
            stage: Stage::Idle,
            low: Layer::EMPTY,
            high: Layer::EMPTY,
            layer: 0,
            steps: 0,
            rows: [0; L],
            next_rows: [0; L],
            cursor: (TileIndex { x: 0, y: 0 }, 0),
            passed: 0,
            spare: None,
        }
    }

    pub(super) fn is_idle(&self) -> bool {
        self.stage == Stage::Idle
    }

    /// Starts anew, in place.
    pub(super) fn reset(&mut self) {
        self.stage = Stage::Idle;
        self.low.reset();
        self.high.reset();
        self.layer = 1;
        self.steps = 1;
        self.rows.fill(0);
        self.next_rows.fill(0);
        self.cursor = (TileIndex { x: 0, y: 0 }, 0);
        self.passed = 0;
        self.spare = None;
    }

    fn begin(&mut self, from: Voxel, stage: Stage) {
        self.reset();
        self.stage = stage;
        if let Some((tile, z, bit)) = from.place() {
            self.low.add(tile, z, bit);
            self.enter(tile, z, bit);
        }
        self.rows = self.next_rows;
        self.next_rows.fill(0);
        self.find_row(0, 0);
    }

    /// The wave goes on in the rows of tiles beside `new` of a tile of a level.
    fn enter(&mut self, tile: TileIndex, z: u8, new: u64) {
        let row = 1u64.checked_shl(tile.y.into()).unwrap_or(0);
        let mut own = row;
        if new & FIRST_ROW != 0 {
            own |= row >> 1;
        }
        if new & LAST_ROW != 0 {
            own |= row << 1;
        }
        let rows = [(z, own), (z.wrapping_add(1), row), (z.wrapping_sub(1), row)];
        for (z, rows) in rows {
            if let Some(place) = self.next_rows.get_mut(usize::from(z)) {
                *place |= rows;
            }
        }
    }

    /// Puts the cursor at the first row to be looked at from row `y` of level `z` on; says
    /// whether there is one.
    fn find_row(&mut self, y: u8, z: u8) -> bool {
        let mut from = u64::MAX.checked_shl(y.into()).unwrap_or(0);
        for (&rows, z) in self.rows.iter().zip(0u8..).skip(z.into()) {
            let rows = rows & from;
            if rows != 0 {
                self.cursor = (TileIndex::new(0, rows.trailing_zeros() as u8), z);
                return true;
            }
            from = u64::MAX;
        }
        false
    }

    /// Puts the cursor at the next word to be looked at, of a map with so many columns of
    /// tiles: of this layer, or of the next one; says whether there is one.
    fn advance(&mut self, columns: u8) -> bool {
        self.passed = 0;
        let (tile, z) = self.cursor;
        if tile.x.saturating_add(1) < columns {
            self.cursor.0.x += 1;
            return true;
        }
        if self.find_row(tile.y.saturating_add(1), z) {
            return true;
        }
        self.rows = self.next_rows;
        self.next_rows.fill(0);
        self.layer = (self.layer + 1) % 3;
        self.steps = self.steps.saturating_add(1);
        self.find_row(0, 0)
    }

    /// Distance of `voxel` from the robot modulo 3, if it is reached.
    fn distance(&self, voxel: Voxel) -> Option<u8> {
        let sum = u8::from(self.low.get(voxel)) | u8::from(self.high.get(voxel)) << 1;
        sum.checked_sub(1)
    }

    /// What is reached of a tile of a level at `distance` modulo 3.
    fn at(&self, distance: u8, tile: TileIndex, z: u8) -> u64 {
        // The two bits of it, each the other way where it is 0.
        let [low, high] = match distance {
            0 => [0, u64::MAX],
            1 => [u64::MAX, 0],
            _ => [0, 0],
        };
        (self.low.word(tile, z) ^ low) & (self.high.word(tile, z) ^ high)
    }

    /// The neighbours of `at` that are a step nearer to home, once the wave from there has come.
    pub(super) fn steps_home(&self, at: Voxel) -> impl Iterator<Item = Voxel> {
        let distance = match self.stage {
            Stage::Homeward => self.distance(at),
            _ => None,
        };
        let before = distance.map(|distance| (distance + 2) % 3);
        let beside = at.beside().into_iter();
        beside.filter(move |&at| before.is_some() && self.distance(at) == before)
    }

    /// The robot is somewhere else than where the search has taken it to be.
    pub(super) fn lose_robot(&mut self) {
        if matches!(self.stage, Stage::FromHome { .. }) {
            self.reset();
        }
    }

    /// Lets the wave into those of the word at the cursor that `enterable` gives; says whether
    /// it was asked.
    fn spread_into_tile(&mut self, enterable: impl FnOnce(TileIndex, u8) -> u64) -> bool {
        let (tile, z) = self.cursor;
        let reached = self.low.word(tile, z) | self.high.word(tile, z);
        let before = (self.layer + 2) % 3;
        let next = beside(tile, z, |tile, z| self.at(before, tile, z)) & !reached;
        if next == 0 {
            return false;
        }
        let new = next & enterable(tile, z);
        if new == 0 {
            return true;
        }
        if self.layer != 1 {
            self.low.add(tile, z, new);
        }
        if self.layer != 0 {
            self.high.add(tile, z, new);
        }
        self.enter(tile, z, new);
        true
    }
}

impl<const TW: usize, const TH: usize, const L: usize> VoxelSurvey<TW, TH, L> {
    /// One step of the search. The robot stays where it is meanwhile.
    pub(super) fn look_far(&mut self) -> Found {
        match self.far.stage {
            Stage::Idle | Stage::FromHome { .. } | Stage::Homeward => {
                let known = self.volume.age();
                self.far.begin(self.position, Stage::Wave { known });
                Found::Searching
            }
            Stage::Wave { known } => self.spread(known),
            Stage::Back(at) => self.follow_back(at),
        }
    }

    /// Lets the wave into a word, and into the voxel of `guest` whatever it is.
    fn spread_into_word(&mut self, guest: Option<Voxel>) {
        let guest = guest.and_then(Voxel::place);
        let is_asked = self.far.spread_into_tile(|tile, z| {
            let poses = self.volume.poses(tile, z, self.clearance) & !self.closed.word(tile, z);
            match guest {
                Some((its_tile, its_z, bit)) if (its_tile, its_z) == (tile, z) => poses | bit,
                _ => poses,
            }
        });
        let body = if is_asked {
            word_work(self.clearance)
        } else {
            0
        };
        self.work = self.work.saturating_add(WORD + body);
    }

    /// One step of the search for the way home. The robot stays where it is meanwhile.
    ///
    /// The wave begins at home: once it has come to the robot, distances lead back.
    pub(super) fn look_for_home(&mut self, home: Voxel) -> Homeward {
        let now = self.volume.age();
        let known = match self.far.stage {
            Stage::FromHome { known } => known,
            _ => {
                self.far.begin(home, Stage::FromHome { known: now });
                now
            }
        };
        let (columns, _) = self.volume.extent().tiles();
        while self.work < SLICE {
            self.spread_into_word(Some(self.position));
            if self.far.distance(self.position).is_some() {
                self.far.stage = Stage::Homeward;
                return Homeward::Found(self.far.steps);
            }
            if !self.far.advance(columns) {
                self.far.stage = Stage::Idle;
                // What was learnt meanwhile may have opened a way.
                return if known == now {
                    Homeward::Nothing
                } else {
                    Homeward::Searching
                };
            }
        }
        Homeward::Searching
    }

    fn spread(&mut self, known: u32) -> Found {
        let (columns, _) = self.volume.extent().tiles();
        while self.work < SLICE {
            self.spread_into_word(None);
            let (tile, z) = self.far.cursor;
            let reached = self.far.at(self.far.layer, tile, z);
            let open = reached & !self.done.word(tile, z) & !self.far.passed;
            if open != 0 {
                if self.far.passed == 0 && self.finish_word(tile, z, open) {
                    continue;
                }
                // The cursor stays until all of them are done or passed.
                let pose = Voxel::of(tile, z, open.trailing_zeros());
                self.work = self.work.saturating_add(1);
                let is_a_rivals = self.is_a_rivals(pose);
                // Of what is left to rivals one is enough to know of.
                let is_looked_at = !is_a_rivals || self.far.spare.is_none();
                if is_looked_at && self.gain(pose, 1) > 0 {
                    if !is_a_rivals {
                        return self.found(pose);
                    }
                    self.far.spare = Some(pose);
                }
                if is_a_rivals {
                    self.far.passed |= 1 << open.trailing_zeros();
                }
                continue;
            }
            if self.far.advance(columns) {
                continue;
            }
            self.far.stage = Stage::Idle;
            if let Some(spare) = self.far.spare.take() {
                // Rivals may be lost: what they leave over is nobody's. Unless it shows
                // nothing by now: then the search begins anew.
                return if self.gain(spare, 1) > 0 {
                    self.found(spare)
                } else {
                    Found::Searching
                };
            }
            // What was learnt meanwhile may have opened a way, and wind may have taken the robot
            // to where the wave has not come.
            let is_reached = self.far.distance(self.position).is_some();
            return if known == self.volume.age() && is_reached {
                Found::Nothing
            } else {
                Found::Searching
            };
        }
        Found::Searching
    }

    fn found(&mut self, pose: Voxel) -> Found {
        self.goal = pose;
        self.way.clear();
        self.far.stage = Stage::Back(pose);
        Found::Searching
    }

    /// Goes back from the goal to the robot; of a long way, its beginning is kept.
    fn follow_back(&mut self, from: Voxel) -> Found {
        let mut at = from;
        while self.work < SLICE {
            self.work = self.work.saturating_add(BACK);
            if at == self.position {
                self.far.stage = Stage::Idle;
                return Found::Way;
            }
            if self.way.len() == WAY {
                self.way.remove(0);
            }
            let _ = self.way.push(at);
            let distance = self.far.distance(at).unwrap_or(0);
            let before = at
                .beside()
                .into_iter()
                .find(|&voxel| self.far.distance(voxel) == Some((distance + 2) % 3));
            let Some(before) = before else {
                // The robot was moved: search again.
                self.far.stage = Stage::Idle;
                return Found::Searching;
            };
            at = before;
        }
        self.far.stage = Stage::Back(at);
        Found::Searching
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// In a box of as many levels as there can be, too.
    #[test]
    fn the_wave_goes_on_at_the_next_row_that_it_may_enter() {
        let mut far = Far::<1, 1, 255>::vacant();
        assert!(!far.find_row(0, 0));
        let [.., last] = &mut far.rows;
        *last = 0b100;
        assert!(far.find_row(1, 9));
        assert_eq!(far.cursor, (TileIndex { x: 0, y: 2 }, 254));
        assert!(!far.find_row(3, 254));
    }
}
