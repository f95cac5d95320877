//! What every frame of a robot takes: a number, and bytes of its budget.

use crate::radio::{GridId, Key, LinkConfig, MAX_LEN};
use crate::robot::RobotId;

#[derive(Clone, Debug)]
pub(crate) struct Sender {
    pub(crate) grid: GridId,
    pub(crate) id: RobotId,
    /// Of the next frame.
    pub(crate) sequence: u16,
    key: Option<Key>,
    bytes_per_tick: u16,
    /// Bytes that may be sent now.
    credit: u16,
}

impl Sender {
    /// Says nothing; all zero.
    pub(crate) const fn vacant() -> Self {
        Self::new(LinkConfig::vacant(), GridId(0), RobotId(0))
    }

    pub(crate) const fn new(config: LinkConfig, grid: GridId, id: RobotId) -> Self {
        Self {
            grid,
            id,
            sequence: 0,
            key: config.key,
            bytes_per_tick: config.bytes_per_tick,
            credit: config.bytes_per_tick,
        }
    }

    pub(crate) const fn key(&self) -> Option<&Key> {
        self.key.as_ref()
    }

    /// Another step: the budget of bytes grows, up to one step's or one frame.
    pub(crate) fn tick(&mut self) {
        let limit = self.bytes_per_tick.max(MAX_LEN as u16);
        self.credit = self.credit.saturating_add(self.bytes_per_tick).min(limit);
    }

    /// Whether the budget allows a frame.
    pub(crate) fn may_send(&self) -> bool {
        usize::from(self.credit) >= MAX_LEN
    }

    /// Counts a frame of `length` bytes.
    pub(crate) fn sent(&mut self, length: usize) {
        self.sequence = self.sequence.wrapping_add(1);
        self.credit = self.credit.saturating_sub(length as u16);
    }
}
