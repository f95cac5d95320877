//! Logs of range scans, and what the planner's map makes of them.
//!
//! ```text
//! file -> Log -> replay -> Replayed: the map's belief | the vote of all beams | Score
//! ```
//! The simulator's looks say what its world is. A log's looks say what a real robot saw:
//! with noise, with poses that are a little off, past people.

#[cfg(all(feature = "mcap", not(target_arch = "wasm32")))]
mod bag;
mod frame;
mod laser;
mod line;
mod read;
mod replay;
mod score;
mod votes;

pub use frame::{CellSizeError, Options};
pub use laser::Laser;
pub use read::{LogError, Problem};
pub use replay::Replayed;
pub use score::{Belief, Score};
pub use votes::Verdict;

/// Scans in the order in which they were taken, perhaps by several robots.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Log {
    /// The file's name without its ending.
    pub name: String,
    /// At least one.
    pub looks: Vec<Look>,
    /// A reading of this or more, in metres, hit nothing: the sensor's largest range where
    /// the log says it, else the log's largest reading. (Where the sensor answers
    /// otherwise, one beam is lost.)
    pub nothing_from: f32,
}

/// One scan. Metres and radians, `x` to the right, `y` up, angles counter-clockwise.
#[derive(Clone, Debug, PartialEq)]
pub struct Look {
    /// Where the sensor was.
    pub x: f64,
    /// Where the sensor was.
    pub y: f64,
    /// Where bearing 0 points to.
    pub heading: f64,
    /// The beams, in the order of the log.
    pub readings: Vec<Reading>,
}

/// One beam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Direction relative to the heading.
    pub bearing: f32,
    /// Distance to what was hit; negative: no measurement.
    pub range: f32,
}
