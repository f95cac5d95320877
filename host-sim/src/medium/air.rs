//! What happens to messages on their way: the one fault model of all media.

use std::sync::Arc;

use planner_core::{Cell, RobotId, sight};

use super::{Fate, Message};
use crate::dice::Dice;
use crate::scenario::{AirFaults, Conditions, Partition, Reach};
use crate::world::World;

/// The air of one run: the same calls in the same order meet the same faults.
pub(super) struct Air {
    faults: AirFaults,
    /// Share of messages lost, for each pair of robots by itself.
    loss: f64,
    world: Arc<World>,
    dice: Dice,
    /// The messages of this tick, if anybody asks for them.
    messages: Option<Vec<Message>>,
}

impl Air {
    pub(super) fn new(conditions: &Conditions, world: Arc<World>) -> Self {
        Self {
            faults: conditions.air.clone(),
            loss: conditions.loss,
            world,
            dice: Dice::new(conditions.seed),
            messages: None,
        }
    }

    /// Whether what one robot says in `tick` arrives at another.
    pub(super) fn carries(
        &mut self,
        tick: u32,
        from: (RobotId, Cell),
        to: (RobotId, Cell),
    ) -> bool {
        let is_cut = |partition: &Partition| {
            (partition.from..partition.until).contains(&tick)
                && (from.0.0 < partition.border) != (to.0.0 < partition.border)
        };
        let reaches = !self.faults.partitions.iter().any(is_cut) && self.reaches(from.1, to.1);
        let arrives = reaches && !self.dice.happens(self.loss);
        match (reaches, arrives) {
            (_, true) => {}
            (true, false) => self.note(from.0, to.0, Fate::Lost),
            (false, false) => self.note(from.0, to.0, Fate::OutOfReach),
        }
        arrives
    }

    /// Remembers what became of a message, if anybody asks for it.
    pub(super) fn note(&mut self, from: RobotId, to: RobotId, fate: Fate) {
        if let Some(messages) = &mut self.messages {
            messages.push(Message { from, to, fate });
        }
    }

    pub(super) fn listen(&mut self) {
        self.messages.get_or_insert_default();
    }

    pub(super) fn messages(&self) -> &[Message] {
        self.messages.as_deref().unwrap_or_default()
    }

    /// Forgets the messages of the last tick.
    pub(super) fn clear(&mut self) {
        if let Some(messages) = &mut self.messages {
            messages.clear();
        }
    }

    /// The copies of a frame that a robot receives, and how many ticks late.
    pub(super) fn copies(&mut self, frame: &[u8]) -> Vec<(u32, Vec<u8>)> {
        let copies = 1 + usize::from(self.dice.happens(self.faults.duplication));
        (0..copies)
            .map(|_| {
                let late = match self.faults.delay {
                    0 => 0,
                    most => self.dice.below(most.saturating_add(1)),
                };
                let mut bytes = frame.to_vec();
                if self.dice.happens(self.faults.corruption) {
                    self.corrupt(&mut bytes);
                }
                (late, bytes)
            })
            .collect()
    }

    fn reaches(&self, from: Cell, to: Cell) -> bool {
        match self.faults.reach {
            Reach::Everywhere => true,
            Reach::Cells(cells) => from.distance_squared(to) <= u32::from(cells).pow(2),
            Reach::LineOfSight => sight::line_of_sight(from, to, |cell| !self.world.is_free(cell)),
        }
    }

    /// One to eight wrong bits, or an end that is missing.
    fn corrupt(&mut self, bytes: &mut Vec<u8>) {
        let length = bytes.len() as u32;
        if self.dice.below(8) == 0 {
            bytes.truncate(self.dice.below(length) as usize);
            return;
        }
        for _ in 0..=self.dice.below(8) {
            let bit = self.dice.below(8 * length);
            bytes[bit as usize / 8] ^= 1 << (bit % 8);
        }
    }
}
