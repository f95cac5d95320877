//! Traces as files, of every kind of world.
//!
//! A trace file is text. Line 1 is a JSON object, the *header*: what was run and where,
//! the number of records and their digest. Line 2 names the columns; every further line is
//! one record: numbers with commas between. Numbers with a decimal point are the shortest
//! that read back as the same `f32`.
//!
//! The digest is the first 16 hex digits of the SHA-256 of all records, each as its
//! numbers in the order of the columns, little-endian, as wide as the type of each.

mod error;
mod flight;
mod reason;

use std::fmt::Display;
use std::io::{self, BufRead, Write};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

pub use error::TraceError;
pub use flight::Deed;
pub(crate) use reason::{action_of, last_action, reason_of};

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

/// A record as it stands in a file.
pub(crate) trait Row: Copy + Serialize + DeserializeOwned {
    /// What the numbers are.
    const COLUMNS: &'static [&'static str];

    /// Adds the numbers to a digest.
    fn add_to(&self, sha: &mut Sha256);
}

/// Declares a [`Row`] by its columns.
macro_rules! row {
    ($(#[$about:meta])* $name:ident { $($column:ident: $number:ty),* $(,)? }) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
        pub(crate) struct $name {
            $(pub(crate) $column: $number,)*
        }

        impl $crate::record::Row for $name {
            const COLUMNS: &'static [&'static str] = &[$(stringify!($column)),*];

            fn add_to(&self, sha: &mut sha2::Sha256) {
                $(sha2::Digest::update(sha, self.$column.to_le_bytes());)*
            }
        }
    };
}
pub(crate) use row;

/// 16 hex digits that differ if any record does.
pub(crate) fn digest<R: Row>(rows: impl IntoIterator<Item = R>) -> String {
    let mut sha = Sha256::new();
    for row in rows {
        row.add_to(&mut sha);
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
pub(crate) fn write<R: Row>(
    mut to: impl Write,
    format: Format,
    header: &impl Serialize,
    rows: impl ExactSizeIterator<Item = R> + Clone,
) -> io::Result<()> {
    #[derive(Serialize)]
    struct Labelled<'a, H> {
        #[serde(flatten)]
        label: Label,
        #[serde(flatten)]
        header: &'a H,
    }
    let label = Label {
        format: format.name.into(),
        version: format.version,
        digest: digest(rows.clone()),
        records: rows.len(),
    };
    serde_json::to_writer(&mut to, &Labelled { label, header })?;
    writeln!(to)?;
    let mut builder = csv::WriterBuilder::new();
    let mut lines = builder.has_headers(false).from_writer(to);
    lines.write_record(R::COLUMNS)?;
    for row in rows {
        lines.serialize(row)?;
    }
    lines.flush()
}

/// What stands below the header.
pub(crate) struct Lines<R> {
    /// Of the file.
    pub(crate) version: u32,
    rows: Vec<R>,
}

/// Takes a trace file apart, and checks that it is whole.
///
/// # Errors
/// What is wrong, and in which line.
pub(crate) fn read<H: DeserializeOwned, R: Row>(
    mut from: impl BufRead,
    format: Format,
) -> Result<(H, Lines<R>), TraceError> {
    let mut header = String::new();
    from.read_line(&mut header)?;
    let label: Label = serde_json::from_str(&header)?;
    let versions = format.oldest..=format.version;
    if label.format != format.name || !versions.contains(&label.version) {
        return Err(TraceError::Format {
            reads: format,
            format: excerpt(&label.format),
            version: label.version,
        });
    }
    let header = serde_json::from_str(&header)?;
    let rows = read_rows::<R>(from)?;
    if rows.len() != label.records {
        return Err(TraceError::Records {
            expected: label.records,
            found: rows.len(),
        });
    }
    let found = digest(rows.iter().copied());
    if found != label.digest {
        let expected = excerpt(&label.digest);
        return Err(TraceError::Digest { expected, found });
    }
    let version = label.version;
    Ok((header, Lines { version, rows }))
}

/// The lines below the header.
fn read_rows<R: Row>(from: impl BufRead) -> Result<Vec<R>, TraceError> {
    let mut lines = from.lines();
    let columns = lines.next().transpose()?.unwrap_or_default();
    if columns != R::COLUMNS.join(",") {
        let expected = format!("the columns {}", R::COLUMNS.join(","));
        return Err(wrong(expected, columns).at(FIRST_LINE - 1));
    }
    let row = |(text, line): (io::Result<String>, usize)| {
        let text = text?;
        let fields: csv::StringRecord = text.split(',').collect();
        let row = fields.deserialize(None).ok();
        row.filter(|_| fields.len() == R::COLUMNS.len())
            .ok_or_else(|| {
                let expected = format!("{} numbers with commas between", R::COLUMNS.len());
                wrong(expected, text).at(line)
            })
    };
    lines.zip(FIRST_LINE..).map(row).collect()
}

impl<R: Row> Lines<R> {
    /// The records, each of which `take` makes of its row, or objects to.
    ///
    /// # Errors
    /// The first objection, with its line.
    pub(crate) fn records<T>(
        &self,
        mut take: impl FnMut(R) -> Result<T, Objection>,
    ) -> Result<Vec<T>, TraceError> {
        let rows = self.rows.iter().zip(FIRST_LINE..);
        rows.map(|(&row, line)| take(row).map_err(|objection| objection.at(line)))
            .collect()
    }
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
    pub(crate) fn take(&mut self, tick: u32, robot: u8) -> Result<(), Objection> {
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
