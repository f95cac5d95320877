//! What the robot last heard of the others. Hints with an age: they steer who
//! goes where, and nothing else depends on them. What they cost is paid from a purse.

use heapless::Vec;

use super::body::{bodies_touch, swept_reach};
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

    /// The cells of a tile in which a sensor may have seen the robot: its body, and that a
    /// step away. One that has stopped is still there. Work: a row of the body at a time.
    fn body(&self, at: TileIndex, clearance: u8, now: u32) -> u64 {
        let distance = |of: i16, tile: u8| ((of >> 3) - i16::from(tile)).unsigned_abs();
        let is_far = distance(self.position.x, at.x).max(distance(self.position.y, at.y)) > 1;
        let is_old = !self.has_stopped && now.saturating_sub(self.heard_at) > 2;
        if is_far || is_old {
            return 0;
        }
        // Column and row in the tile, -8 to 15.
        let (x, y) = (
            self.position.x - i16::from(at.x) * 8,
            self.position.y - i16::from(at.y) * 8,
        );
        let last = i16::from(clearance) + 1;
        let mut cells = 0;
        for dy in -last..=last {
            let row = y + dy;
            if !(0..8).contains(&row) {
                continue;
            }
            let reach = swept_reach(clearance, dy);
            // Bit 12 is the tile's first column.
            let wide = ((2u32 << (2 * reach)) - 1) << (x - reach + 12).unsigned_abs();
            cells |= u64::from(wide >> 12 & 0xff) << (8 * row.unsigned_abs());
        }
        cells
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

    /// Takes in a status; says whether the robot is new to the list. Work: the list once.
    pub(crate) fn hear(&mut self, id: RobotId, status: Status, own: Cell, now: u32) -> bool {
        let heard = Other {
            id,
            position: status.position,
            goal: status.goal,
            has_stopped: status.activity == Activity::Stopped,
            heard_at: now,
        };
        if let Some(known) = self.list.iter_mut().find(|other| other.id == id) {
            *known = heard;
            return false;
        }
        if self.list.is_full() && !self.make_room(&heard, own) {
            return false;
        }
        // There is room now; by id, so that ties fall the same way for everybody.
        let place = self.list.iter().take_while(|other| other.id < id).count();
        list::insert(&mut self.list, place, heard);
        true
    }

    /// Forgets a robot that has stopped, or else the farthest, if it is farther
    /// than the one heard.
    fn make_room(&mut self, heard: &Other, own: Cell) -> bool {
        // One number, for all of a crowd are ranked for each frame. Cells of a grid are less
        // than 2^12 apart: nothing wraps.
        let rank = |other: &Other| {
            let dx = i32::from(other.position.x) - i32::from(own.x);
            let dy = i32::from(other.position.y) - i32::from(own.y);
            let distance = dx.wrapping_mul(dx).wrapping_add(dy.wrapping_mul(dy));
            u32::from(other.has_stopped) << 31 | distance as u32 & u32::MAX >> 1
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

    /// Robot `id` forgets whom nothing was heard of for more than `memory` ticks.
    pub(crate) fn forget(&mut self, id: RobotId, now: u32, memory: u32) {
        self.list.retain(|other| {
            let is_kept = now.saturating_sub(other.heard_at) <= memory;
            if !is_kept {
                log!(debug, "robot {}: hears robot {} no more", id.0, other.id.0);
            }
            is_kept
        });
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

    /// The cells of a tile in which a sensor that sees robots may show those that were heard
    /// just now, or that have stopped. Work: the list once.
    #[inline(never)] // most robots see no others
    pub(crate) fn bodies(&self, at: TileIndex, clearance: u8, now: u32) -> u64 {
        let mut cells = 0;
        for other in &self.list {
            cells |= other.body(at, clearance, now);
        }
        cells
    }

    /// Whether the robot knows where every other one went that it has heard of.
    pub(crate) fn are_all_fresh(&self, now: u32) -> bool {
        let mut heard = self.heard();
        heard.all(|other| !self.purse.is_empty() && other.is_fresh(now))
    }

    /// Where another robot's body is that this one would touch in `to`. Who moves away from
    /// it never does. Robots step at once: to those with lower ids a step is left. Work: the
    /// list once.
    pub(crate) fn in_the_way(
        &self,
        id: RobotId,
        from: Cell,
        to: Cell,
        clearance: u8,
    ) -> Option<Cell> {
        let touches = |at: Cell| {
            bodies_touch(clearance, to, at) && to.distance_squared(at) <= from.distance_squared(at)
        };
        let is_in_the_way = |other: &&Other| {
            let moves = other.id < id && !other.has_stopped;
            let mut sides = Direction::ALL
                .map(|side| other.position.step(side))
                .into_iter();
            touches(other.position) || moves && sides.any(touches)
        };
        let other = self.list.iter().find(is_in_the_way);
        other.map(|other| other.position)
    }

    fn heard(&self) -> impl Iterator<Item = &Other> {
        self.list.iter().filter(|other| !other.has_stopped)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use std::vec::Vec;

    use super::*;
    use crate::explorer::body::{MAX_CLEARANCE, body_cells};

    /// The same by the words of the rule: id, stopped, position.
    fn remember(list: &mut Vec<(u8, bool, Cell)>, heard: (u8, bool, Cell), own: Cell) {
        let rank = |of: &(u8, bool, Cell)| (of.1, of.2.distance_squared(own));
        if let Some(known) = list.iter_mut().find(|of| of.0 == heard.0) {
            *known = heard;
            return;
        }
        if list.len() == MAX_OTHERS {
            let worst = (0..list.len()).max_by_key(|&index| rank(&list[index]));
            let worst = worst.expect("the list is full");
            if rank(&heard) >= rank(&list[worst]) {
                return;
            }
            list.remove(worst);
        }
        list.push(heard);
        list.sort_by_key(|of| of.0);
    }

    #[test]
    fn a_body_is_seen_where_it_is_and_a_step_away_and_stays_where_it_stopped() {
        let (clearances, place) = (0..=MAX_CLEARANCE, -5..13);
        let places = place
            .clone()
            .flat_map(|y| place.clone().map(move |x| Cell::new(x, y)));
        for (clearance, position) in
            clearances.flat_map(|of| places.clone().map(move |at| (of, at)))
        {
            let mut others = Others::new();
            let hear = |others: &mut Others, stopped| {
                let activity = Activity::stopped_if(stopped);
                let status = Status {
                    position,
                    goal: None,
                    activity,
                };
                others.hear(RobotId(1), status, Cell::new(0, 0), 10);
            };
            hear(&mut others, false);
            let places = Direction::ALL.map(|side| position.step(side));
            let places = places.into_iter().chain([position]);
            let mut seen = 0;
            for (tile, bit) in places
                .flat_map(|at| body_cells(clearance, at))
                .filter_map(TileIndex::of)
            {
                if tile == TileIndex::new(0, 0) {
                    seen |= bit;
                }
            }
            let at = TileIndex::new(0, 0);
            assert_eq!(
                others.bodies(at, clearance, 12),
                seen,
                "{clearance} at {position}"
            );
            assert_eq!(others.bodies(at, clearance, 13), 0);
            hear(&mut others, true);
            assert_eq!(others.bodies(at, clearance, 13), seen);
        }
    }

    proptest! {
        #[test]
        fn of_a_crowd_those_near_by_are_remembered(
            heard in prop::collection::vec((0u8..40, 0i16..9, 0i16..9, any::<bool>()), 0..200),
        ) {
            let (mut others, mut list) = (Others::new(), Vec::new());
            for (number, (id, x, y, stopped)) in heard.into_iter().enumerate() {
                let own = Cell::new(number as i16 / 50, 4);
                let position = Cell::new(x, y);
                let activity = Activity::stopped_if(stopped);
                let status = Status { position, goal: None, activity };
                others.hear(RobotId(id), status, own, 0);
                remember(&mut list, (id, stopped, position), own);
                let known = others.list.iter();
                let known = known.map(|of| (of.id.0, of.has_stopped, of.position));
                prop_assert_eq!(known.collect::<Vec<_>>(), list.clone());
            }
        }
    }
}
