//! What the robot last heard of the others. Hints with an age: they steer who
//! goes where, and nothing else depends on them.

use heapless::Vec;

use crate::cell::Cell;
use crate::planner::{Activity, RobotId, Status};

/// Other robots that are remembered; of more, the nearest.
pub const MAX_OTHERS: usize = 15;

#[derive(Clone, Copy, Debug)]
pub(crate) struct Other {
    pub(crate) id: RobotId,
    pub(crate) position: Cell,
    pub(crate) goal: Option<Cell>,
    heard_at: u32,
}

/// The exploring robots heard of lately, by id.
#[derive(Debug)]
pub(crate) struct Others {
    list: Vec<Other, MAX_OTHERS>,
}

impl Others {
    pub(crate) const fn new() -> Self {
        Self { list: Vec::new() }
    }

    /// Takes in a status. A robot that has stopped explores nothing any more: it
    /// is forgotten. Work: the list once.
    pub(crate) fn hear(&mut self, id: RobotId, status: Status, own: Cell, now: u32) {
        self.list.retain(|other| other.id != id);
        if status.activity == Activity::Stopped {
            return;
        }
        let heard = Other {
            id,
            position: status.position,
            goal: status.goal,
            heard_at: now,
        };
        if self.list.is_full() {
            let farthest = self
                .list
                .iter()
                .enumerate()
                .max_by_key(|(_, other)| other.position.distance_squared(own));
            match farthest {
                Some((index, other))
                    if heard.position.distance_squared(own)
                        < other.position.distance_squared(own) =>
                {
                    self.list.remove(index);
                }
                _ => return,
            }
        }
        // There is room now; by id, so that ties fall the same way for everybody.
        let place = self.list.iter().take_while(|other| other.id < id).count();
        let _ = self.list.insert(place, heard);
    }

    /// Forgets whom nothing was heard of for more than `memory` ticks.
    pub(crate) fn forget(&mut self, now: u32, memory: u32) {
        self.list
            .retain(|other| now.saturating_sub(other.heard_at) <= memory);
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = &Other> {
        self.list.iter()
    }
}
