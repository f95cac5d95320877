//! The way to the host: its standard streams, by semihosting's file calls.
//!
//! The streams are pipes, so that either side is told when the other one dies.
//! They are opened by name: what semihosting calls its console may be a terminal,
//! a log or nothing, and is kept for messages to people.

use core::fmt;

use bridge::{Inbox, MAX_MESSAGE, ReadError};
use cortex_m_semihosting::syscall;
use serde::{Deserialize, Serialize};

/// Why the dialogue ended.
pub enum Trouble {
    /// The host does not open a stream.
    Stream(&'static str),
    /// No whole message arrived.
    Read(ReadError<Refused>),
    /// The simulator and the image are not built from one source.
    Message(postcard::Error),
    /// An answer that the host does not take.
    Write(Refused),
    /// Something was asked for before the planner was set up.
    NotStarted,
}

impl fmt::Display for Trouble {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Stream(name) => write!(f, "the host does not open {name}"),
            Self::Read(error) => write!(f, "no request: {error}"),
            Self::Message(error) => write!(
                f,
                "a request that makes no sense ({error}); build image and simulator from one source"
            ),
            Self::Write(Refused) => write!(f, "the host does not take the answer"),
            Self::NotStarted => write!(f, "the first request does not set up a planner"),
        }
    }
}

/// The host refused a semihosting call.
#[derive(Debug)]
pub struct Refused;

impl fmt::Display for Refused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the host refused the call")
    }
}

/// The two streams.
pub struct Host {
    requests: usize,
    answers: usize,
}

impl Host {
    /// Opens both.
    ///
    /// # Errors
    /// The host does not open one of them.
    pub fn connect() -> Result<Self, Trouble> {
        const READ_BINARY: usize = 1;
        const WRITE_BINARY: usize = 5;
        Ok(Self {
            requests: open(c"/dev/stdin", READ_BINARY)?,
            answers: open(c"/dev/stdout", WRITE_BINARY)?,
        })
    }

    /// Waits for a request.
    ///
    /// # Errors
    /// None arrives, or none that makes sense.
    pub fn ask<'a, T: Deserialize<'a>>(&self, inbox: &'a mut Inbox) -> Result<T, Trouble> {
        inbox
            .read(|place| read(self.requests, place))
            .map_err(Trouble::Read)?;
        bridge::decode(inbox.message()).map_err(Trouble::Message)
    }

    /// Answers it.
    ///
    /// # Errors
    /// The host does not take the answer.
    pub fn answer(
        &self,
        answer: &impl Serialize,
        buffer: &mut [u8; MAX_MESSAGE],
    ) -> Result<(), Trouble> {
        let bytes = bridge::encode(answer, buffer).map_err(Trouble::Message)?;
        write(self.answers, bytes).map_err(Trouble::Write)
    }
}

fn open(name: &'static core::ffi::CStr, mode: usize) -> Result<usize, Trouble> {
    // SAFETY: SYS_OPEN reads the name, which ends with a zero byte, and keeps nothing.
    let handle = unsafe { syscall!(OPEN, name.as_ptr(), mode, name.count_bytes()) };
    match handle {
        usize::MAX => Err(Trouble::Stream(name.to_str().unwrap_or_default())),
        handle => Ok(handle),
    }
}

fn read(handle: usize, place: &mut [u8]) -> Result<usize, Refused> {
    // SAFETY: SYS_READ writes at most as many bytes as the slice has.
    let missing = unsafe { syscall!(READ, handle, place.as_mut_ptr(), place.len()) };
    place.len().checked_sub(missing).ok_or(Refused)
}

fn write(handle: usize, bytes: &[u8]) -> Result<(), Refused> {
    // SAFETY: SYS_WRITE only reads the slice.
    match unsafe { syscall!(WRITE, handle, bytes.as_ptr(), bytes.len()) } {
        0 => Ok(()),
        _ => Err(Refused),
    }
}
