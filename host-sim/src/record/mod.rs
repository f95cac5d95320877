//! Traces as files, of every kind of world.
//!
//! A trace file is text. Line 1 is a JSON object, the *header*: what was run and where,
//! the number of records and their digest. Line 2 names the columns; every further line is
//! one record: numbers with commas between. Numbers with a decimal point are the shortest
//! that read back as the same `f32`.
//!
//! The digest is the first 16 hex digits of the SHA-256 of all records, each as its
//! numbers in the order of the columns, little-endian, as wide as the type of each.

mod decision;
mod error;
mod flight;
pub mod grid;
pub mod heights;
mod reason;
pub mod voxels;

use std::fmt::Display;
use std::io::{self, BufRead, Write};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use sha2::{Digest, Sha256};

pub use decision::{Kind, Nothing, Record};
pub use error::TraceError;
pub use flight::Deed;
pub(crate) use reason::{action_of, reason_of};

use crate::excerpt::excerpt;

/// The line of the first record.
const FIRST_LINE: usize = 3;

/// What the header says of the file itself, and this program reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Format {
    /// Of what kind the trace is.
    pub name: &'static str,
    /// The version that is written.
    pub version: u32,
    /// The oldest version that is read.
    pub oldest: u32,
}

/// 16 hex digits that differ if any record does.
pub(crate) fn digest<K: Kind>(records: &[Record<K>]) -> String {
    let mut sha = Sha256::new();
    for record in records {
        record.add_to(&mut sha);
    }
    let digest = sha.finalize();
    let first = digest.iter().take(8);
    first.map(|byte| format!("{byte:02x}")).collect()
}

/// What every header says of the file itself.
#[derive(Serialize, Deserialize)]
struct Label {
    format: String,
    version: u32,
    digest: String,
    records: usize,
}

/// Writes a trace file whose header is `header` and the label.
///
/// # Errors
/// Those of `to`.
pub(crate) fn write<K: Kind>(
    mut to: impl Write,
    header: &impl Serialize,
    records: &[Record<K>],
) -> io::Result<()> {
    #[derive(Serialize)]
    struct Labelled<'a, H> {
        #[serde(flatten)]
        label: Label,
        #[serde(flatten)]
        header: &'a H,
    }
    let label = Label {
        format: K::FORMAT.name.into(),
        version: K::FORMAT.version,
        digest: digest(records),
        records: records.len(),
    };
    serde_json::to_writer(&mut to, &Labelled { label, header })?;
    writeln!(to)?;
    let mut builder = csv::WriterBuilder::new();
    let mut lines = builder.has_headers(false).from_writer(to);
    lines.write_record(Record::<K>::columns())?;
    for record in records {
        lines.serialize(record)?;
    }
    lines.flush()
}

/// Takes a trace file apart, and checks that it is whole: its version, header and records.
///
/// # Errors
/// What is wrong, and in which line.
pub(crate) fn read<H: DeserializeOwned, K: Kind>(
    mut from: impl BufRead,
) -> Result<(u32, H, Vec<Record<K>>), TraceError> {
    let mut header = String::new();
    from.read_line(&mut header)?;
    // By way of a value: what is flattened reads its numbers only so where serde_json keeps
    // all their digits, which any crate beside this one may ask of it.
    let header: Value = serde_json::from_str(&header)?;
    let label = Label::deserialize(&header)?;
    let reads = K::FORMAT;
    if label.format != reads.name || !(reads.oldest..=reads.version).contains(&label.version) {
        return Err(TraceError::Format {
            reads,
            format: excerpt(&label.format),
            version: label.version,
        });
    }
    let header = serde_json::from_value(header)?;
    let records = read_records::<K>(from)?;
    if records.len() != label.records {
        return Err(TraceError::Records {
            expected: label.records,
            found: records.len(),
        });
    }
    let found = digest(&records);
    if found != label.digest {
        let expected = excerpt(&label.digest);
        return Err(TraceError::Digest { expected, found });
    }
    Ok((label.version, header, records))
}

/// The lines below the header.
fn read_records<K: Kind>(from: impl BufRead) -> Result<Vec<Record<K>>, TraceError> {
    let mut lines = from.lines();
    let names = Record::<K>::columns();
    let columns = lines.next().transpose()?.unwrap_or_default();
    if columns != names.join(",") {
        let expected = format!("the columns {}", names.join(","));
        return Err(wrong(expected, columns).at(FIRST_LINE - 1));
    }
    let record = |(text, line): (io::Result<String>, usize)| {
        let text = text?;
        let fields: csv::StringRecord = text.split(',').collect();
        let numbers = || format!("{} numbers with commas between", names.len());
        let record = match fields.len() == names.len() {
            true => fields.deserialize(None).map_err(|error| said(&error)),
            false => Err(None),
        };
        record.map_err(|said| wrong(said.unwrap_or_else(numbers), text).at(line))
    };
    lines.zip(FIRST_LINE..).map(record).collect()
}

/// What a number should be that is one, but none of a record.
fn said(error: &csv::Error) -> Option<String> {
    let csv::ErrorKind::Deserialize { err, .. } = error.kind() else {
        return None;
    };
    match err.kind() {
        csv::DeserializeErrorKind::Message(expected) => Some(expected.clone()),
        _ => None,
    }
}

/// Checks the records one by one.
///
/// # Errors
/// The first objection, with its line.
pub(crate) fn check<K: Kind>(
    records: &[Record<K>],
    mut check: impl FnMut(&Record<K>) -> Result<(), Objection>,
) -> Result<(), TraceError> {
    let mut lines = records.iter().zip(FIRST_LINE..);
    lines.try_for_each(|(record, line)| check(record).map_err(|objection| objection.at(line)))
}

/// What should stand in a line, and what does.
#[derive(Debug)]
pub(crate) struct Objection {
    expected: String,
    found: String,
}

/// An objection.
pub(crate) fn wrong(expected: impl Into<String>, found: impl Display) -> Objection {
    Objection {
        expected: expected.into(),
        found: found.to_string(),
    }
}

impl Objection {
    fn at(self, line: usize) -> TraceError {
        TraceError::Line {
            line,
            expected: self.expected,
            found: excerpt(&self.found),
        }
    }
}

/// Checks that the records of a run come in order: by tick, then by robot.
pub(crate) struct Order {
    /// Number of robots.
    pub(crate) robots: usize,
    /// The first tick that is too late.
    pub(crate) end: u32,
    /// Tick and robot of the last record.
    pub(crate) last: Option<(u32, u8)>,
}

impl Order {
    /// # Errors
    /// A robot that there is not, or a record that is late or too early.
    pub(crate) fn take<K: Kind>(&mut self, record: &Record<K>) -> Result<(), Objection> {
        let (tick, robot) = (record.tick, record.robot);
        if usize::from(robot) >= self.robots {
            return Err(wrong(
                format!("a robot from 0 to {}", self.robots - 1),
                robot,
            ));
        }
        if tick >= self.end {
            let expected = format!("a tick before {}", self.end);
            return Err(wrong(expected, format!("tick {tick}")));
        }
        if self.last.is_some_and(|(last, _)| last > tick) {
            return Err(wrong("ticks in order", format!("tick {tick}")));
        }
        if self.last.is_some_and(|last| last >= (tick, robot)) {
            let found = format!("robot {robot}");
            return Err(wrong("each robot once a tick, in order", found));
        }
        self.last = Some((tick, robot));
        Ok(())
    }
}
