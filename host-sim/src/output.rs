//! Standard output and standard error of the command: the one place that writes to them.
//!
//! `println!` of the standard library panics when nobody reads any more or the disk is
//! full. Here these names are taken by macros that do not: whoever reads has read enough
//! when the pipe is closed, and any other failure is told at the end by [`close`].

use std::fmt;
use std::io::{self, Write};
use std::sync::{Mutex, PoisonError};

/// Why standard output takes no more.
static FAILED: Mutex<Option<io::Error>> = Mutex::new(None);

/// Prints on standard output, and goes on if that cannot be.
macro_rules! print {
    ($($words:tt)*) => { $crate::output::out(format_args!($($words)*)) };
}

/// A line on standard output; see [`print!`].
macro_rules! println {
    ($($words:tt)*) => {
        $crate::output::out(format_args!("{}\n", format_args!($($words)*)))
    };
}

/// A line on standard error, if anybody takes it.
macro_rules! eprintln {
    ($($words:tt)*) => { $crate::output::err(format_args!($($words)*)) };
}

pub(crate) fn out(words: fmt::Arguments<'_>) {
    let mut failed = FAILED.lock().unwrap_or_else(PoisonError::into_inner);
    if failed.is_none() {
        *failed = io::stdout().write_fmt(words).err();
    }
}

pub(crate) fn err(words: fmt::Arguments<'_>) {
    // Where else could it be said that standard error takes nothing?
    let _ = writeln!(io::stderr(), "{words}");
}

/// Writes what is still to be written.
///
/// # Errors
/// What was printed did not all arrive, though somebody was there to read it.
pub(crate) fn close() -> Result<(), String> {
    let failed = FAILED.lock().unwrap_or_else(PoisonError::into_inner).take();
    match failed.map_or_else(|| io::stdout().flush(), Err) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(format!(
            "standard output cannot be written: {error}; what was printed is not complete"
        )),
        _ => Ok(()),
    }
}
