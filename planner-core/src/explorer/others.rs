//! What the robot last heard of the others. Hints with an age: they steer who
//! goes where, and nothing else depends on them. What they cost is paid from a purse.

use heapless::Vec;

use super::purse::Purse;
use crate::cell::{Cell, Direction};
use crate::list;
use crate::map::Map;
use crate::robot::{Activity, RobotId, Status};
use crate::tile::TileIndex;

/// Other robots that are remembered; of more, the nearest.
pub const MAX_OTHERS: usize = 15;

#[derive(Clone, Copy, Debug)]
pub(crate) struct Other {
    pub(crate) id: RobotId,
    pub(crate) position: Cell,
    goal: Option<Cell>,
    has_stopped: bool,
    heard_at: u32,
}

impl Other {
    /// Whether the robot was heard just now.
    pub(crate) fn is_fresh(&self, now: u32) -> bool {
        now.saturating_sub(self.heard_at) <= 1
    }

    /// The cells of a tile in which a sensor may have seen the robot a moment ago: its own,
    /// and those a step away.
    fn body(&self, at: TileIndex, now: u32) -> u64 {
        let tiles = |of: i16, tile: u8| ((of >> 3) - i16::from(tile)).unsigned_abs();
        let is_far = tiles(self.position.x, at.x).max(tiles(self.position.y, at.y)) > 1;
        if is_far || now.saturating_sub(self.heard_at) > 2 {
            return 0;
        }
        let sides = Direction::ALL.map(|side| self.position.step(side));
        let cells = sides.into_iter().chain([self.position]);
        cells
            .filter_map(TileIndex::of)
            .filter(|(tile, _)| *tile == at)
            .fold(0, |cells, (_, bit)| cells | bit)
    }

    /// Where the robot is and where it is going: frontiers beside either are its own.
    pub(crate) fn whereabouts(&self) -> impl Iterator<Item = Cell> + use<> {
        [Some(self.position), self.goal].into_iter().flatten()
    }
}

/// The robots heard of lately, by id.
#[derive(Debug)]
pub(crate) struct Others {
    list: Vec<Other, MAX_OTHERS>,
    pub(crate) purse: Purse,
}

impl Others {
    pub(crate) const fn new() -> Self {
        Self {
            list: Vec::new(),
            purse: Purse::new(),
        }
    }

    /// Takes in a status. Work: the list once.
    pub(crate) fn hear(&mut self, id: RobotId, status: Status, own: Cell, now: u32) {
        let heard = Other {
            id,
            position: status.position,
            goal: status.goal,
            has_stopped: status.activity == Activity::Stopped,
            heard_at: now,
        };
        if let Some(known) = self.list.iter_mut().find(|other| other.id == id) {
            *known = heard;
            return;
        }
        if self.list.is_full() && !self.make_room(&heard, own) {
            return;
        }
        // There is room now; by id, so that ties fall the same way for everybody.
        let place = self.list.iter().take_while(|other| other.id < id).count();
        list::insert(&mut self.list, place, heard);
    }

    /// Forgets a robot that has stopped, or else the farthest, if it is farther
    /// than the one heard.
    fn make_room(&mut self, heard: &Other, own: Cell) -> bool {
        // One number, for all of a crowd are ranked for each frame.
        let rank = |other: &Other| {
            let distance = other.position.distance_squared(own);
            u32::from(other.has_stopped) << 31 | distance.min(u32::MAX >> 1)
        };
        let (mut worst, mut last) = (rank(heard), None);
        for other in &self.list {
            let rank = rank(other);
            // Of equals the last, but not the one heard.
            if rank > worst || rank == worst && last.is_some() {
                (worst, last) = (rank, Some(other.id));
            }
        }
        if let Some(id) = last {
            // Not `remove`, which panics for an index outside.
            self.list.retain(|other| other.id != id);
        }
        last.is_some()
    }

    /// Forgets whom nothing was heard of for more than `memory` ticks.
    pub(crate) fn forget(&mut self, now: u32, memory: u32) {
        self.list
            .retain(|other| now.saturating_sub(other.heard_at) <= memory);
    }

    /// Pays for a tick with them; says whether they do not count any more from now on.
    pub(crate) fn pay<const TW: usize, const TH: usize>(&mut self, map: &Map<TW, TH>) -> bool {
        let heeds = self.heard().next().is_some();
        self.purse.pay(heeds, map.known_cells(), map.extent())
    }

    /// Those that still explore, by id; nobody while hints do not count.
    pub(crate) fn exploring(&self) -> impl Iterator<Item = &Other> {
        self.heard().filter(|_| !self.purse.is_empty())
    }

    /// The cells of a tile in which robots may be seen that were heard just now. Work: the
    /// list once.
    pub(crate) fn bodies(&self, at: TileIndex, now: u32) -> u64 {
        self.list
            .iter()
            .fold(0, |cells, other| cells | other.body(at, now))
    }

    /// Whether the robot knows where every other one went that it has heard of.
    pub(crate) fn are_all_fresh(&self, now: u32) -> bool {
        let mut heard = self.heard();
        heard.all(|other| !self.purse.is_empty() && other.is_fresh(now))
    }

    fn heard(&self) -> impl Iterator<Item = &Other> {
        self.list.iter().filter(|other| !other.has_stopped)
    }
}
