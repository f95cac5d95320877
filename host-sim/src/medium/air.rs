//! What happens to messages on their way: the one fault model of all media.

use std::sync::Arc;

use planner_core::RobotId;

use super::{Fate, Message, Space};
use crate::dice::Dice;
use crate::scenario::{AirFaults, Conditions, Partition, Reach};

/// The air of one run: the same calls in the same order meet the same faults.
pub(crate) struct Air<W> {
    faults: AirFaults,
    /// Share of messages lost, for each pair of robots by itself.
    loss: f64,
    world: Arc<W>,
    dice: Dice,
    /// The messages of this tick, if anybody asks for them.
    messages: Option<Vec<Message>>,
}

impl<W: Space> Air<W> {
    pub(crate) fn new(conditions: &Conditions, world: Arc<W>) -> Self {
        Self {
            faults: conditions.air.clone(),
            loss: conditions.loss,
            world,
            dice: Dice::new(conditions.seed),
            messages: None,
        }
    }

    /// Whether what one robot says in `tick` arrives at another.
    pub(crate) fn carries(
        &mut self,
        tick: u32,
        from: (RobotId, W::Place),
        to: (RobotId, W::Place),
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
    pub(crate) fn note(&mut self, from: RobotId, to: RobotId, fate: Fate) {
        if let Some(messages) = &mut self.messages {
            messages.push(Message { from, to, fate });
        }
    }

    pub(crate) fn listen(&mut self) {
        self.messages.get_or_insert_default();
    }

    pub(crate) fn messages(&self) -> &[Message] {
        self.messages.as_deref().unwrap_or_default()
    }

    /// Forgets the messages of the last tick.
    pub(crate) fn clear(&mut self) {
        if let Some(messages) = &mut self.messages {
            messages.clear();
        }
    }

    /// How often a frame arrives.
    pub(crate) fn copies(&mut self) -> u32 {
        1 + u32::from(self.dice.happens(self.faults.duplication))
    }

    /// How many ticks late a frame arrives.
    pub(crate) fn delay(&mut self) -> u32 {
        match self.faults.delay {
            0 => 0,
            most => self.dice.below(most.saturating_add(1)),
        }
    }

    /// What becomes of a frame on its way; `None`: nothing.
    pub(crate) fn corrupted(&mut self, frame: &[u8]) -> Option<Vec<u8>> {
        self.dice.happens(self.faults.corruption).then(|| {
            let mut bytes = frame.to_vec();
            self.corrupt(&mut bytes);
            bytes
        })
    }

    fn reaches(&self, from: W::Place, to: W::Place) -> bool {
        match self.faults.reach {
            Reach::Everywhere => true,
            Reach::Cells(cells) => self.world.is_near(from, to, cells),
            Reach::LineOfSight => self.world.is_in_sight(from, to),
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
