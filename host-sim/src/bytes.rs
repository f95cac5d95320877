//! Files as bytes, up to a bound.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

/// Why a file cannot be had.
#[derive(Debug)]
pub(crate) enum Unread {
    /// There is none.
    Missing,
    /// It is a folder or a device.
    NoFile,
    /// It has more bytes than are read.
    TooLong,
    /// The system says so.
    Io(io::Error),
}

impl From<io::Error> for Unread {
    fn from(error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::NotFound => Self::Missing,
            _ => Self::Io(error),
        }
    }
}

/// All of a file of at most `most` bytes. Neither a pipe without a writer nor a device
/// without an end is waited for.
///
/// # Errors
/// See [`Unread`].
pub(crate) fn read(path: &Path, most: u64) -> Result<Vec<u8>, Unread> {
    if !fs::metadata(path)?.is_file() {
        return Err(Unread::NoFile);
    }
    let mut bytes = Vec::new();
    File::open(path)?.take(most + 1).read_to_end(&mut bytes)?;
    match bytes.len() as u64 > most {
        true => Err(Unread::TooLong),
        false => Ok(bytes),
    }
}
