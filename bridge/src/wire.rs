//! How messages go over a stream of bytes.

use core::fmt;

use serde::{Deserialize, Serialize};

/// No message is longer, its length included.
pub const MAX_MESSAGE: usize = 576;

/// Bytes of the length.
const HEADER: usize = 2;

/// Writes a message into the buffer; returns the bytes to send.
///
/// # Errors
/// The message is longer than [`MAX_MESSAGE`]: a bug of this crate.
pub fn encode<'a>(
    message: &impl Serialize,
    buffer: &'a mut [u8; MAX_MESSAGE],
) -> Result<&'a [u8], postcard::Error> {
    let (header, body) = buffer.split_at_mut(HEADER);
    let length = postcard::to_slice(message, body)?.len();
    header.copy_from_slice(&(length as u16).to_le_bytes());
    Ok(&buffer[..HEADER + length])
}

/// Reads the [`Inbox::message`].
///
/// # Errors
/// The bytes are no such message: the two sides are not built from one source.
pub fn decode<'a, T: Deserialize<'a>>(bytes: &'a [u8]) -> Result<T, postcard::Error> {
    postcard::from_bytes(bytes)
}

/// Puts one message together from what a stream delivers, piece by piece.
pub struct Inbox {
    buffer: [u8; MAX_MESSAGE],
    /// Where the message ends.
    end: usize,
}

/// Why there is no message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReadError<E> {
    /// The stream failed.
    Stream(E),
    /// The other side is gone.
    Closed,
    /// The bytes do not hold one message, but this many bytes of which the
    /// length says that many.
    Length(usize, usize),
}

impl<E: fmt::Display> fmt::Display for ReadError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Stream(error) => error.fmt(f),
            Self::Closed => f.write_str("the other side is gone"),
            Self::Length(found, said) => {
                write!(f, "a message of {found} bytes says that it has {said}")
            }
        }
    }
}

impl Inbox {
    /// An inbox without a message.
    pub const fn new() -> Self {
        Self {
            buffer: [0; MAX_MESSAGE],
            end: HEADER,
        }
    }

    /// Waits for one whole message. `read` waits for bytes, puts them into the
    /// front of the slice and returns their number; none: the other side is gone.
    ///
    /// # Errors
    /// See [`ReadError`].
    pub fn read<E>(
        &mut self,
        mut read: impl FnMut(&mut [u8]) -> Result<usize, E>,
    ) -> Result<(), ReadError<E>> {
        self.end = HEADER;
        let mut filled = 0;
        let mut end = None;
        while end.is_none_or(|end| filled < end) {
            let count = read(&mut self.buffer[filled..]).map_err(ReadError::Stream)?;
            filled += count;
            if count == 0 && filled < MAX_MESSAGE {
                return Err(ReadError::Closed);
            }
            if filled >= HEADER {
                let length =
                    HEADER + usize::from(u16::from_le_bytes([self.buffer[0], self.buffer[1]]));
                if length > MAX_MESSAGE || filled > length {
                    return Err(ReadError::Length(filled, length));
                }
                end = Some(length);
            }
        }
        self.end = filled;
        Ok(())
    }

    /// The message that was read last, without its length.
    pub fn message(&self) -> &[u8] {
        &self.buffer[HEADER..self.end]
    }
}

impl Default for Inbox {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use core::convert::Infallible;

    use planner_core::{Cell, Extent, Map, Motion, Sighting};

    use super::*;
    use crate::{Request, grid_hash};

    /// Sends a message in pieces of `piece` bytes.
    fn deliver<'a>(
        bytes: &[u8],
        piece: usize,
        inbox: &'a mut Inbox,
    ) -> Result<&'a [u8], ReadError<Infallible>> {
        let mut rest = bytes;
        inbox.read(|place| {
            let (now, later) = rest.split_at(piece.min(rest.len()).min(place.len()));
            place[..now.len()].copy_from_slice(now);
            rest = later;
            Ok(now.len())
        })?;
        Ok(inbox.message())
    }

    #[test]
    fn a_message_arrives_whole_however_it_is_cut() {
        let mut sighting = Sighting::new(Cell::new(70, 3));
        for step in -15..=15 {
            for across in -15..=15 {
                sighting.see_blocked(Cell::new(70 + step, 3 + across));
            }
        }
        let (mut buffer, mut inbox) = ([0xaa; MAX_MESSAGE], Inbox::new());
        for message in [
            Request::Observe(sighting),
            Request::Report(Motion::Held),
            Request::Tick,
        ] {
            let bytes = encode(&message, &mut buffer).unwrap();
            for piece in [1, 2, 3, 64, MAX_MESSAGE] {
                let arrived = deliver(bytes, piece, &mut inbox).unwrap();
                assert_eq!(decode::<Request<'_>>(arrived).unwrap(), message);
            }
        }
    }

    #[test]
    fn what_is_no_message_is_refused() {
        let mut inbox = Inbox::new();
        assert_eq!(deliver(&[3, 0, 1], 9, &mut inbox), Err(ReadError::Closed));
        assert_eq!(
            deliver(&[1, 0, 1, 1], 9, &mut inbox),
            Err(ReadError::Length(4, 3))
        );
        assert_eq!(
            deliver(&[0xff; 9], 9, &mut inbox),
            Err(ReadError::Length(9, 65537))
        );
    }

    #[test]
    fn a_fingerprint_sees_every_cell_and_not_the_compiled_size() {
        let extent = Extent::new(19, 30);
        let mut small = Map::<4, 4>::new(extent).unwrap();
        let mut large = Map::<16, 16>::new(extent).unwrap();
        let mut seen = std::collections::HashSet::from([grid_hash(&small)]);
        for (x, y) in (0..19).flat_map(|x| (0..30).map(move |y| (x, y))) {
            let look = Sighting::new(Cell::new(x, y));
            small.observe(&look);
            large.observe(&look);
            assert_eq!(grid_hash(&small), grid_hash(&large));
            assert!(seen.insert(grid_hash(&small)), "the same after {x},{y}");
        }
    }
}
