//! Logs of an image: bytes that only its own table of formats makes sense of.

use std::io::Write;
use std::path::Path;

use anyhow::{Context, Result, bail};
use defmt_decoder::{DecodeError, Table};

/// The formats of an image's logs.
pub(crate) fn table(image: &Path) -> Result<Table> {
    let elf = std::fs::read(image).with_context(|| image.display().to_string())?;
    let table = Table::parse(&elf).with_context(|| image.display().to_string())?;
    let table = table.with_context(|| format!("{} logs nothing", image.display()))?;
    if table.is_empty() {
        bail!("{} has no log point", image.display());
    }
    Ok(table)
}

/// The lines that an image has logged as these bytes.
pub(crate) fn decode(image: &Path, bytes: &Path) -> Result<Vec<u8>> {
    let table = table(image)?;
    let mut decoder = table.new_stream_decoder();
    decoder.received(&std::fs::read(bytes)?);
    let mut lines = Vec::new();
    loop {
        match decoder.decode() {
            Ok(frame) => writeln!(lines, "{}", frame.display(false))?,
            Err(DecodeError::UnexpectedEof) => return Ok(lines),
            Err(DecodeError::Malformed) => {
                let end = String::from_utf8_lossy(&lines);
                bail!("what {} logs makes no sense after\n{end}", image.display())
            }
        }
    }
}
