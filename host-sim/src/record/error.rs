//! Why a trace cannot be read.

use std::io;

use thiserror::Error;

use super::Format;
use crate::excerpt::excerpt;
use crate::scenario::ScenarioError;
use crate::world::WorldError;

/// A trace that cannot be read.
#[derive(Debug, Error)]
pub enum TraceError {
    /// See the message.
    #[error("cannot be read: {0}")]
    Io(#[from] io::Error),
    /// See the message.
    #[error(
        "line 1: expected the JSON header of a trace: {}; is this a trace file?",
        excerpt(&.0.to_string())
    )]
    Header(#[from] serde_json::Error),
    /// See the message.
    #[error(
        "is `{format}` version {version}, this program reads `{}` version {}; \
         run the scenario again to have a trace of that version", .reads.name, .reads.version
    )]
    Format {
        /// What can be read.
        reads: Format,
        /// What the header says.
        format: String,
        /// What the header says.
        version: u32,
    },
    /// See the message.
    #[error("the header's world: {0}")]
    World(#[from] WorldError),
    /// See the message.
    #[error("the header's world: row {row} has {found} cells, the first has {expected}")]
    Ragged {
        /// Which row, from 1.
        row: usize,
        /// Length of the first row.
        expected: usize,
        /// Length of this one.
        found: usize,
    },
    /// See the message.
    #[error("the header's scenario: {0}")]
    Scenario(#[from] ScenarioError),
    /// See the message.
    #[error("the header's survey: {0}; it was edited or damaged")]
    Survey(String),
    /// See the message.
    #[error("line {line}: expected {expected}, found \"{found}\"")]
    Line {
        /// Which line, from 1.
        line: usize,
        /// What should be there.
        expected: String,
        /// What is there.
        found: String,
    },
    /// See the message.
    #[error(
        "has {found} records, its header says {expected}; it was cut off or edited: \
         copy it again from where it was written"
    )]
    Records {
        /// By the header.
        expected: usize,
        /// In the file.
        found: usize,
    },
    /// See the message.
    #[error(
        "has digest {found}, its header says {expected}; it was edited or damaged: \
         copy it again from where it was written"
    )]
    Digest {
        /// By the header.
        expected: String,
        /// Of the records.
        found: String,
    },
}
