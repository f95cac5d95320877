//! Who else still explores, as heard.

use crate::robot::{Activity, RobotId};

/// The other robots last heard exploring: the one thing that a second chance
/// asks about [Gauville2019 §6.1]. A bit for each possible id, in two
/// generations, so the table is never full. 72 bytes.
#[derive(Clone, PartialEq, Eq)]
pub(super) struct Others {
    recent: [u64; 4],
    earlier: [u64; 4],
    /// Ticks since the last change of generations; 0 while nobody is known.
    age: u32,
}

impl Others {
    pub(super) const fn new() -> Self {
        Self {
            recent: [0; 4],
            earlier: [0; 4],
            age: 0,
        }
    }

    /// Takes in what `id` told about itself.
    pub(super) fn hear(&mut self, id: RobotId, activity: Activity) {
        let (word, bit) = (usize::from(id.0 >> 6), 1 << (id.0 & 63));
        if let (Some(recent), Some(earlier)) =
            (self.recent.get_mut(word), self.earlier.get_mut(word))
        {
            *earlier &= !bit;
            if activity == Activity::Exploring {
                *recent |= bit;
            } else {
                *recent &= !bit;
            }
        }
    }

    /// Whether any other robot neither stopped nor is in its second chance.
    pub(super) fn anybody_explores(&self) -> bool {
        self.recent.iter().chain(&self.earlier).any(|&ids| ids != 0)
    }

    /// Lets a tick pass: who was not heard for `silence` to `2·silence` ticks is
    /// forgotten.
    pub(super) fn age(&mut self, silence: u32) {
        self.age = self.age.saturating_add(1);
        if self.age > silence {
            self.earlier = core::mem::take(&mut self.recent);
            self.age = 0;
        }
        if !self.anybody_explores() {
            self.age = 0;
        }
    }
}
