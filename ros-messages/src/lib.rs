//! ROS 2 messages as plain data, their definitions, their bytes, and recordings of them.
//!
//! A message is a Rust struct with the fields of the `.msg` file in its order. Its bytes
//! (CDR) come from Serde, its definition as ROS writes it from [`Message::definition`], both
//! of the one struct.

mod field;
pub mod geometry;
pub mod nav;
mod recording;
pub mod sensor;
pub mod std_msgs;
pub mod tf;
pub mod visualization;

pub use field::{Field, Message};
pub use recording::{Recorded, Recording, RecordingError, recorded};
