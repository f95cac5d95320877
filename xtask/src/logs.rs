//! Logs of an image: bytes that only its own table of formats makes sense of.

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

/// The lines that an image has logged.
pub(crate) fn decode(image: &Path, bytes: &[u8]) -> Result<Vec<String>> {
    let table = table(image)?;
    let mut decoder = table.new_stream_decoder();
    decoder.received(bytes);
    let mut lines = Vec::new();
    loop {
        match decoder.decode() {
            Ok(frame) => lines.push(frame.display(false).to_string()),
            Err(DecodeError::UnexpectedEof) => return Ok(lines),
            Err(DecodeError::Malformed) => {
                bail!("log {} of {} makes no sense", lines.len(), image.display())
            }
        }
    }
}
