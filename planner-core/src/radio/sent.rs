//! What a robot has sent of late: to tell its own echo from a robot of the same id.

use crate::robot::RobotId;

use super::FrameError;

/// The check bytes of the last `N` frames, by their numbers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Sent<const N: usize> {
    checks: [u16; N],
    count: u8,
}

impl<const N: usize> Sent<N> {
    pub(crate) const fn new() -> Self {
        assert!(N > 0 && N < 256);
        Self {
            checks: [0; N],
            count: 0,
        }
    }

    /// Frame number `sequence` goes out.
    pub(crate) fn note(&mut self, sequence: u16, frame: &[u8]) {
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
    pub(crate) fn refusal(
        &mut self,
        id: RobotId,
        next: u16,
        sequence: u16,
        frame: &[u8],
    ) -> FrameError {
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
