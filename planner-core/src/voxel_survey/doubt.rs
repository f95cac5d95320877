//! What looks say against the map, when the map gives in, and steps that wait meanwhile.

use heapless::Vec;

use super::VoxelSurvey;
use super::gain::within;
use crate::list;
use crate::robot::{Action, Wait};
use crate::tile::TileIndex;
use crate::volume::{Content, Voxel};

/// What a fleet takes its sensors for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Sensor {
    /// Every look is believed at once, and what is occupied stays so.
    #[default]
    Truthful,
    /// Looks err now and then: three in a row against the map change it. What they find free
    /// again stays free; a look that shows something there only holds a step back.
    Errs,
}

impl Sensor {
    /// Looks from one place after which no more is expected of it.
    pub(super) const fn looks(self) -> u8 {
        match self {
            Self::Truthful => 1,
            Self::Errs => FLIPS + 1,
        }
    }
}

/// Looks in a row that contradict the map before it changes.
const FLIPS: u8 = 3;

/// Changes at doubts since anything was learnt after which nothing free becomes occupied, and what
/// looks have missed is not looked for any more. Nothing is withdrawn after `u8::MAX` of them.
const CHANGES: u8 = 32;

/// Voxels that are doubted at a time.
const DOUBTS: usize = 32;

/// Voxels ahead that are remembered.
const AHEAD: usize = 8;

/// Ticks that a step waits for what the last look showed to go away.
const HOLD: u8 = 4;

/// A voxel of which looks say otherwise than the map.
#[derive(Clone, Copy, Debug)]
struct Doubt {
    at: Voxel,
    looks: u8,
}

/// What looks say against the map.
#[derive(Clone, Debug)]
pub(super) struct Doubts {
    against: Vec<Doubt, DOUBTS>,
    /// What the last look showed where the map says free, as far as the next step reaches.
    ahead: Vec<Voxel, AHEAD>,
    /// Ticks that a step has waited for it.
    held: u8,
    /// Changes at doubts since so many voxels were known.
    changes: u8,
    known: u32,
}

impl Doubts {
    pub(super) const fn new() -> Self {
        Self {
            against: Vec::new(),
            ahead: Vec::new(),
            held: 0,
            changes: 0,
            known: 0,
        }
    }

    /// What was given up is tried again.
    pub(super) fn renew(&mut self) {
        self.changes = 0;
    }

    /// Whether the map, with so many `known` voxels, has changed often without anything learnt.
    pub(super) fn is_weary(&self, known: u32) -> bool {
        self.known == known && self.changes >= CHANGES
    }

    /// Whether the map may change once more, so that something becomes occupied or free.
    fn may_change(&mut self, known: u32, occupied: bool) -> bool {
        if self.known != known {
            self.known = known;
            self.changes = 0;
        }
        self.changes < if occupied { CHANGES } else { u8::MAX }
    }

    /// A look begins.
    pub(super) fn look(&mut self) {
        self.ahead.clear();
    }

    fn place(&self, at: Voxel) -> Option<usize> {
        self.against.iter().position(|doubt| doubt.at == at)
    }

    /// A look agrees with the map.
    fn settle(&mut self, at: Voxel) {
        if let Some(place) = self.place(at) {
            list::take_out(&mut self.against, place);
        }
    }

    /// A look contradicts the map; says whether enough have. Where all places are taken, one
    /// that is out of range by now leaves; if none is, the look does not count.
    fn add(&mut self, at: Voxel, is_in_range: impl Fn(Voxel) -> bool) -> bool {
        let new = Doubt { at, looks: 1 };
        let Some(place) = self.place(at) else {
            if self.against.push(new).is_err()
                && let Some(old) = self.against.iter_mut().find(|old| !is_in_range(old.at))
            {
                *old = new;
            }
            return false;
        };
        if let Some(doubt) = self.against.get_mut(place) {
            doubt.looks += 1;
            if doubt.looks < FLIPS {
                return false;
            }
        }
        list::take_out(&mut self.against, place);
        true
    }

    /// Whether something ahead is within the body about `to`, or may be.
    fn obstruct(&self, to: Voxel, clearance: u8) -> bool {
        let reach = u32::from(clearance) * u32::from(clearance);
        let is_in_reach = |at: &Voxel| at.distance_squared(to) <= reach;
        self.ahead.is_full() || self.ahead.iter().any(is_in_reach)
    }
}

impl<const TW: usize, const TH: usize, const L: usize> VoxelSurvey<TW, TH, L> {
    /// Takes in what a look from here shows of `voxel`; says whether the map has changed.
    ///
    /// Cost: of a sensor that errs, at most two comparisons with each voxel that is doubted.
    pub(super) fn take_in(&mut self, voxel: Voxel, occupied: bool) -> bool {
        let has_changed = match self.sensor {
            Sensor::Truthful => self.volume.learn(voxel, occupied),
            Sensor::Errs => self.weigh(voxel, occupied),
        };
        let may_differ = self.sensor == Sensor::Errs || self.volume.withdrawn() > 0;
        if occupied && may_differ {
            let reach = u32::from(self.clearance) + 1;
            let is_ahead = voxel.distance_squared(self.position) <= reach * reach;
            if is_ahead && self.is_free_inside(voxel) {
                let _ = self.doubts.ahead.push(voxel);
            }
        }
        has_changed
    }

    fn is_free_inside(&self, voxel: Voxel) -> bool {
        self.volume.contains(voxel) && self.volume.content(voxel) == Content::Free
    }

    #[inline(never)]
    pub(super) fn weigh(&mut self, voxel: Voxel, occupied: bool) -> bool {
        let content = self.volume.content(voxel);
        if content == Content::Unknown {
            return self.volume.learn(voxel, occupied);
        }
        if occupied == (content == Content::Occupied) {
            self.doubts.settle(voxel);
            return false;
        }
        let (here, range) = (self.position, u32::from(self.range));
        let is_in_range = |at: Voxel| at.distance_squared(here) <= range * range;
        let is_final = self.volume.is_withdrawn(voxel) || !self.volume.contains(voxel);
        let is_held = self.stopped || !self.doubts.may_change(self.volume.known_voxels(), occupied);
        if is_final || is_held || !self.doubts.add(voxel, is_in_range) {
            return false;
        }
        self.doubts.changes = self.doubts.changes.saturating_add(1);
        match occupied {
            true => self.volume.learn(voxel, true),
            false => self.withdraw(voxel),
        }
    }

    /// The robot stands at `voxel`: nothing else is there.
    pub(super) fn stand(&mut self, voxel: Voxel) {
        let has_changed = match (self.volume.content(voxel), self.sensor) {
            (Content::Free, _) => false,
            (Content::Unknown, _) => self.volume.learn(voxel, false),
            (Content::Occupied, Sensor::Errs) => self.withdraw(voxel),
            (Content::Occupied, Sensor::Truthful) => {
                self.volume.stand(voxel);
                false
            }
        };
        if has_changed && let Some((tile, z, _)) = voxel.place() {
            self.news.add(tile, z);
        }
    }

    fn withdraw(&mut self, voxel: Voxel) -> bool {
        let is_news = self.volume.withdraw(voxel);
        if is_news && let Some((tile, z, _)) = voxel.place() {
            self.undo(tile, z);
        }
        is_news
    }

    /// Something of a tile of a level is free again: poses that may have it in sight are not
    /// done any more.
    ///
    /// Cost: a word for each tile of a level within range.
    pub(super) fn undo(&mut self, tile: TileIndex, z: u8) {
        for (tile, z) in within(self.range, tile, z) {
            self.done.put(tile, z, 0);
        }
    }

    /// Holds a step back into what the last look has shown: for a while, and then its end is
    /// closed.
    pub(super) fn heed(&mut self, action: Action<Voxel, Voxel>) -> Action<Voxel, Voxel> {
        let Action::Move(to) = action else {
            return action;
        };
        if !self.doubts.obstruct(to, self.clearance) {
            self.doubts.held = 0;
            return action;
        }
        self.doubts.held += 1;
        if self.doubts.held < HOLD {
            let _ = self.way.push(to);
        } else {
            self.doubts.held = 0;
            self.way.clear();
            self.close(to);
        }
        self.wait(Wait::Obstructed)
    }
}
