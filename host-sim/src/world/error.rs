//! What can be wrong with a map, said so that the reader can mend it.

use std::io;

use planner_core::{Cell, Extent};
use thiserror::Error;

use super::foreign::Foreign;
use super::grid::LARGEST;
use crate::excerpt::printable;

/// A world that cannot be had, and why.
#[derive(Debug, Error)]
#[error("{}: {problem}", printable(map))]
pub struct WorldError {
    /// The file as it was named, or the name of a world without a file.
    pub map: String,
    /// What is wrong with it.
    pub problem: Problem,
}

/// What is wrong: where, what was expected, what was found, what to do.
///
/// Lines and columns count from 1.
#[derive(Debug, Error)]
#[non_exhaustive]
#[allow(missing_docs)] // each variant's message is its documentation
pub enum Problem {
    #[error("no such file; check the path")]
    Missing,
    #[error("cannot be read: {0}; check that it is a file that you may read")]
    Unreadable(io::Error),
    #[error("cannot be written: {0}; check that the folder exists and may be written to")]
    Unwritable(io::Error),
    #[error("has more than {most} bytes; expected a map of at most {LARGEST} cells")]
    TooLong { most: u64 },
    #[error("is a folder; name a map file in it")]
    Folder,
    #[error(
        "unknown ending `{found}`; expected one of {expected}: \
         rename the file or convert it to one of these formats"
    )]
    UnknownEnding {
        found: String,
        expected: &'static str,
    },
    #[error("unknown ending `{found}`, and is {what}; expected one of {expected}: {advice}")]
    ForeignEnding {
        found: String,
        what: &'static str,
        expected: &'static str,
        advice: &'static str,
    },
    #[error("is {what}, whatever its name says; {advice}")]
    Foreign {
        what: &'static str,
        advice: &'static str,
    },
    #[error("holds a {format} picture, whatever its name says; name it .{ending}")]
    Misnamed {
        format: &'static str,
        ending: &'static str,
    },
    #[error("is not UTF-8 text; expected {expected}")]
    NotText { expected: &'static str },
    #[error("is not UTF-8 text but UTF-16; expected {expected}: save it as UTF-8")]
    Utf16 { expected: &'static str },

    #[error(
        "is not a complete image ({0}); expected a whole PNG or PGM file: \
         copy it again or export it again"
    )]
    BrokenImage(String),
    #[error("has more pixels than can be decoded; scale the picture down")]
    TooManyPixels,
    #[error(
        "has no free cell: {0}; robots do not enter what is unknown: \
         paint white what is free"
    )]
    NothingKnown(String),
    #[error("the image {path} that key `image` names cannot be used: {problem}")]
    RosImage { path: String, problem: Box<Problem> },
    #[error("key `{key}`: expected {expected}, found {found}")]
    Key {
        key: &'static str,
        expected: &'static str,
        found: String,
    },
    #[error(
        "`{text}`: {found}; expected the keys of a map_server YAML file, \
         for example `resolution: 0.05`"
    )]
    Yaml { text: String, found: String },

    #[error("--pixels-per-cell is 0; expected 1 or more")]
    NoPixelsPerCell,
    #[error("--pixels-per-cell {found} makes too large an image; expected {most} or less")]
    TooManyPixelsPerCell { found: u32, most: u32 },
    #[error(
        "has no resolution, so --cell-size {metres} means nothing here; \
         use --pixels-per-cell, or describe the image with a map_server YAML file"
    )]
    NoResolution { metres: f64 },
    #[error(
        "--cell-size {metres} is smaller than one pixel ({resolution} m by key `resolution`); \
         use {resolution} or more"
    )]
    CellSize { metres: f64, resolution: f64 },

    #[error("has no cell at all; expected at least one row with a free cell")]
    Empty,
    #[error("has no free cell; expected at least one: are light and dark the wrong way round?")]
    NoFreeCell,
    #[error("{width}×{height} cells are more than the largest compiled size, {LARGEST}; {advice}")]
    TooLarge {
        width: usize,
        height: usize,
        advice: String,
    },
    #[error(
        "line {line}: expected a row of {expected} cells, found {found}; \
         make all rows equally long (spaces at the end count too)"
    )]
    Ragged {
        line: usize,
        expected: usize,
        found: usize,
    },
    #[error("line {line}, column {column}: unknown character {found:?}; expected {expected}")]
    UnknownCharacter {
        line: usize,
        column: usize,
        found: char,
        expected: &'static str,
    },
    #[error(
        "line {line}, column {column}: start {digit} is there a second time; \
         give each robot a digit of its own"
    )]
    RepeatedStart {
        line: usize,
        column: usize,
        digit: char,
    },
    #[error(
        "line {line}: expected {expected}, found \"{found}\"; \
         mend the MovingAI header, or name a plain text map .txt"
    )]
    Header {
        line: usize,
        expected: &'static str,
        found: String,
    },
    #[error(
        "expected {expected} rows of cells as `height` says, found {found}; \
         mend the header or the rows"
    )]
    Rows { expected: usize, found: usize },

    #[error(
        "start {start} is outside the map of {extent} cells; \
         x counts from 0 at the left, y from 0 at the top"
    )]
    StartOutside { start: Cell, extent: Extent },
    #[error("start {start} is an obstacle; the nearest free cell is {nearest}")]
    StartOnObstacle { start: Cell, nearest: Cell },
    #[error(
        "{robots} robots need a cell each, but only {cells} free cells can be reached \
         from the start; use fewer robots or leave out --solid"
    )]
    TooManyRobots { robots: usize, cells: usize },

    #[error(
        "start {start} has no room for a body of --clearance {clearance}; start elsewhere \
         (--start spread), or take a smaller clearance or smaller cells"
    )]
    StartWithoutRoom { start: Cell, clearance: u8 },
    #[error(
        "has no room for {robots} bodies of --clearance {clearance} apart from each other; use \
         fewer robots, a smaller clearance or smaller cells"
    )]
    NoRoom { robots: usize, clearance: u8 },

    #[error("{extent} cells are too few to generate; expected {smallest}×{smallest} or more")]
    TooSmall { extent: Extent, smallest: u16 },
    #[error("{name} {found}; expected {lowest} to {highest}")]
    Parameter {
        name: &'static str,
        found: u16,
        lowest: u16,
        highest: u16,
    },
}

impl Problem {
    /// This problem as an error about `map`.
    pub(super) fn of(self, map: impl Into<String>) -> WorldError {
        WorldError {
            map: map.into(),
            problem: self,
        }
    }

    /// What an operating system error on opening a file means.
    pub(super) fn from_read(error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::NotFound => Self::Missing,
            io::ErrorKind::IsADirectory => Self::Folder,
            _ => Self::Unreadable(error),
        }
    }
}

impl From<Foreign> for Problem {
    fn from(Foreign { what, advice }: Foreign) -> Self {
        Self::Foreign { what, advice }
    }
}
