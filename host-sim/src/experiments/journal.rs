//! Rows as they come in, kept so that nothing that has finished is lost.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use thiserror::Error;

use super::row::Row;
use super::shard::Shard;
use crate::files;

/// The folder of the shards' files in an output folder.
pub(super) const PARTS: &str = "parts";

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
    #[error("{}: holds world {world}, which another part holds too", path.display())]
    Twice {
        /// Which file.
        path: PathBuf,
        /// The number of the world in the plan.
        world: usize,
    },
}

impl Journal {
    /// Goes on with the journal of a shard, or begins it. A row that an interruption has cut
    /// is dropped.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn open(out: &Path, shard: Shard) -> Result<Self, JournalError> {
        let folder = out.join(PARTS);
        let path = folder.join(format!("{shard}.csv"));
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

    /// Its rows.
    ///
    /// # Errors
    /// A file that cannot be read, or that holds something else.
    pub fn read(&self) -> Result<Vec<Row>, JournalError> {
        read(&self.path)
    }

    /// The rows of all shards in an output folder; none if it has no journal.
    ///
    /// # Errors
    /// Files that cannot be read, or that hold something else.
    pub fn read_all(out: &Path) -> Result<Vec<Row>, JournalError> {
        let mut rows = Vec::new();
        for path in parts(out, "csv")? {
            rows.append(&mut read(&path)?);
        }
        Ok(rows)
    }
}

fn read(path: &Path) -> Result<Vec<Row>, JournalError> {
    let text = fs::read_to_string(path).map_err(|problem| JournalError::Io {
        path: path.into(),
        problem,
    })?;
    let mut reader = csv::Reader::from_reader(whole_lines(&text).as_bytes());
    let rows: Result<Vec<Row>, csv::Error> = reader.deserialize().collect();
    rows.map_err(|problem| JournalError::Format {
        path: path.into(),
        problem,
    })
}

/// The files of all shards in an output folder that end in `.ending`, by name.
pub(super) fn parts(out: &Path, ending: &str) -> Result<Vec<PathBuf>, JournalError> {
    let folder = out.join(PARTS);
    let list = || -> io::Result<Vec<PathBuf>> {
        let mut paths = Vec::new();
        for entry in fs::read_dir(&folder)? {
            let path = entry?.path();
            if path.extension().is_some_and(|found| found == ending) {
                paths.push(path);
            }
        }
        paths.sort();
        Ok(paths)
    };
    match list() {
        Err(problem) if problem.kind() == io::ErrorKind::NotFound => Ok(Vec::new()),
        listed => listed.map_err(|problem| JournalError::Io {
            path: folder,
            problem,
        }),
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
