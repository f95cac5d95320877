//! Rows as they come in, kept so that nothing that has finished is lost.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use thiserror::Error;

use super::execute::Shard;
use super::row::Row;
use crate::files;

/// The rows of one shard, in `parts/I-of-N.csv` of an output folder. Each row
/// goes to the file as soon as it is known, in one piece.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    file: Mutex<File>,
}

/// A journal that cannot be used.
#[derive(Debug, Error)]
pub enum JournalError {
    /// See the message.
    #[error("{}: {problem}", path.display())]
    Io {
        /// Which file.
        path: PathBuf,
        /// What went wrong.
        problem: io::Error,
    },
    /// See the message.
    #[error("{}: {problem}; it was written by another version, or is no table of runs", path.display())]
    Format {
        /// Which file.
        path: PathBuf,
        /// What went wrong.
        problem: csv::Error,
    },
    /// See the message.
    #[error("{} holds runs already; go on with --resume, or choose another folder with --out", path.display())]
    Exists {
        /// Which file.
        path: PathBuf,
    },
}

impl Journal {
    /// Opens the journal of a shard; with `resume` one that has rows already.
    ///
    /// # Errors
    /// A file that cannot be written, or that is there without `resume`.
    pub fn open(out: &Path, shard: Shard, resume: bool) -> Result<Self, JournalError> {
        let folder = out.join("parts");
        let path = folder.join(format!("{shard}.csv"));
        if path.exists() && !resume {
            return Err(JournalError::Exists { path });
        }
        let open = || {
            fs::create_dir_all(&folder)?;
            if path.exists() {
                let text = fs::read_to_string(&path)?;
                files::write(&path, whole_lines(&text).as_bytes())?;
            }
            OpenOptions::new().append(true).create(true).open(&path)
        };
        match open() {
            Ok(file) => Ok(Self {
                path,
                file: Mutex::new(file),
            }),
            Err(problem) => Err(JournalError::Io { path, problem }),
        }
    }

    /// Adds a row.
    ///
    /// # Errors
    /// Those of the file.
    pub fn add(&self, row: &Row) -> Result<(), JournalError> {
        let mut file = self.file.lock().expect("nobody panics while writing");
        let mut add = || {
            let is_empty = file.metadata()?.len() == 0;
            file.write_all(to_csv([row], is_empty).as_bytes())
        };
        add().map_err(|problem| JournalError::Io {
            path: self.path.clone(),
            problem,
        })
    }

    /// The rows of all shards in an output folder; none if it has no journal.
    ///
    /// # Errors
    /// Files that cannot be read, or that hold something else.
    pub fn read_all(out: &Path) -> Result<Vec<Row>, JournalError> {
        let folder = out.join("parts");
        let Ok(entries) = fs::read_dir(&folder) else {
            return Ok(Vec::new());
        };
        let mut rows = Vec::new();
        for entry in entries {
            let path = entry.map(|entry| entry.path());
            let path = path.map_err(|problem| JournalError::Io {
                path: folder.clone(),
                problem,
            })?;
            match fs::read_to_string(&path) {
                Err(problem) => return Err(JournalError::Io { path, problem }),
                Ok(text) => {
                    let mut reader = csv::Reader::from_reader(whole_lines(&text).as_bytes());
                    for row in reader.deserialize() {
                        rows.push(row.map_err(|problem| JournalError::Format {
                            path: path.clone(),
                            problem,
                        })?);
                    }
                }
            }
        }
        Ok(rows)
    }
}

/// A row is whole if its line has ended: an interruption may have cut the last.
fn whole_lines(text: &str) -> &str {
    &text[..text.rfind('\n').map_or(0, |end| end + 1)]
}

/// Rows as CSV, with or without the line of column names.
pub fn to_csv<'a>(rows: impl IntoIterator<Item = &'a Row>, headers: bool) -> String {
    let mut builder = csv::WriterBuilder::new();
    let mut writer = builder.has_headers(headers).from_writer(Vec::new());
    for row in rows {
        writer.serialize(row).expect("a row has plain fields only");
    }
    let csv = writer.into_inner().expect("a Vec takes everything");
    String::from_utf8(csv).expect("fields are text")
}
