//! What surveys came to.

mod summary;

pub use summary::{RobotSummary, Summary};
