//! What every frame of a robot takes: a number, and bytes of its budget.

use crate::radio::{FrameError, GridId, Hearsay, Key, LinkConfig, MAX_LEN, Sent};
use crate::robot::RobotId;

/// Own frames that are remembered, to know their echo: those of three steps.
const ECHOES: usize = 32;

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
    echoes: Sent<ECHOES>,
    pub(crate) hearsay: Hearsay,
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
            echoes: Sent::new(),
            hearsay: Hearsay::new(),
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

    /// Counts a frame.
    pub(crate) fn sent(&mut self, frame: &[u8]) {
        self.echoes.note(self.sequence, frame);
        self.sequence = self.sequence.wrapping_add(1);
        self.credit = self.credit.saturating_sub(frame.len() as u16);
    }

    /// Takes in what a frame in `bytes` was read as: not if the robot itself is the
    /// sender. Counts what is refused.
    pub(crate) fn admit<F>(
        &mut self,
        bytes: &[u8],
        read: Result<F, FrameError>,
        sender: impl Fn(&F) -> (RobotId, u16),
    ) -> Result<F, FrameError> {
        let admitted = read.and_then(|frame| {
            let (from, sequence) = sender(&frame);
            if from == self.id {
                return Err(self.echoes.refusal(from, self.sequence, sequence, bytes));
            }
            Ok(frame)
        });
        admitted.inspect_err(|&error| self.hearsay.refuse(error))
    }
}
