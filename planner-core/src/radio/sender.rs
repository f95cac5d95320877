//! What every frame of a robot takes: a number, and bytes of its budget.

use super::check::GridId;
use super::envelope::MAX_LEN;
use super::error::FrameError;
use super::hearsay::Hearsay;
use super::key::Key;
use crate::robot::RobotId;

/// How a robot uses the radio. One configuration serves a whole fleet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LinkConfig {
    /// Where the grid lies in the fleet's common frame, in millimetres: its north-western
    /// corner, which is that of cell `(0, 0)`.
    pub origin_mm: (i32, i32),
    /// Side of a cell in millimetres.
    pub cell_mm: u16,
    /// Bytes that the robot may send a tick on average. Less than a frame: it
    /// sends one every few ticks. 0: it only listens.
    pub bytes_per_tick: u16,
    /// Frames are signed with it, and only those signed with it are taken. A
    /// secret is not serialised.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub key: Option<Key>,
}

impl LinkConfig {
    /// One frame a tick, not signed; cells of 100 mm from the origin on.
    pub const fn new() -> Self {
        Self {
            origin_mm: (0, 0),
            cell_mm: 100,
            bytes_per_tick: MAX_LEN as u16,
            key: None,
        }
    }

    /// All zero: only listens.
    pub(crate) const fn vacant() -> Self {
        Self {
            origin_mm: (0, 0),
            cell_mm: 0,
            bytes_per_tick: 0,
            key: None,
        }
    }
}

impl Default for LinkConfig {
    fn default() -> Self {
        Self::new()
    }
}

/// One robot's end of the air, whatever its frames are about. It knows the echo of its
/// last `N` frames.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Sender<const N: usize> {
    pub(crate) grid: GridId,
    pub(crate) id: RobotId,
    /// Of the next frame.
    pub(crate) sequence: u16,
    key: Option<Key>,
    pub(super) bytes_per_tick: u16,
    /// Bytes that may be sent now.
    credit: u16,
    echoes: Echoes<N>,
    pub(crate) hearsay: Hearsay,
}

impl<const N: usize> Sender<N> {
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
            echoes: Echoes::new(),
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

    /// Lets `write` write the next frame, and counts it; returns its length.
    pub(crate) fn send(
        &mut self,
        buffer: &mut [u8; MAX_LEN],
        write: impl FnOnce(Option<&Key>, &mut [u8; MAX_LEN]) -> usize,
    ) -> usize {
        let length = write(self.key(), buffer);
        let frame = buffer.get(..length).unwrap_or(&[]);
        self.echoes.note(self.sequence, frame);
        self.sequence = self.sequence.wrapping_add(1);
        self.credit = self.credit.saturating_sub(length as u16);
        length
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
        admitted.inspect_err(|&error| {
            let (id, is_first) = (self.id.0, self.hearsay.same_id == 0);
            match error {
                FrameError::Own => log!(trace, "robot {}: {}", id, error),
                FrameError::SameId(_) if is_first => log!(warn, "robot {}: {}", id, error),
                _ => log!(debug, "robot {}: refuses a frame: {}", id, error),
            }
            self.hearsay.refuse(error);
        })
    }
}

/// The check bytes of the last `N` frames, by their numbers.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Echoes<const N: usize> {
    checks: [u16; N],
    count: u8,
}

impl<const N: usize> Echoes<N> {
    const fn new() -> Self {
        assert!(N > 0 && N < 256);
        Self {
            checks: [0; N],
            count: 0,
        }
    }

    /// Frame number `sequence` goes out.
    fn note(&mut self, sequence: u16, frame: &[u8]) {
        if let (Some(place), Some(check)) = (self.place(sequence), check_of(frame)) {
            *place = check;
            self.count = self.count.saturating_add(1).min(N as u8);
        }
    }

    fn place(&mut self, sequence: u16) -> Option<&mut u16> {
        self.checks.get_mut(usize::from(sequence) % N)
    }

    /// Why a frame under the robot's own id is not taken: it is one of the last `N`,
    /// or of another robot. `next` is the number of the frame to be sent next.
    fn refusal(&mut self, id: RobotId, next: u16, sequence: u16, frame: &[u8]) -> FrameError {
        let is_late = (1..=u16::from(self.count)).contains(&next.wrapping_sub(sequence));
        let check = check_of(frame);
        if is_late && self.place(sequence).is_some_and(|own| Some(*own) == check) {
            FrameError::Own
        } else {
            FrameError::SameId(id)
        }
    }
}

/// The last two bytes, which hang on all of the others.
fn check_of(frame: &[u8]) -> Option<u16> {
    frame.last_chunk().map(|&check| u16::from_le_bytes(check))
}
