//! Robots as processes of their own: one serves the world, each of the others is
//! a robot, and what robots tell each other are UDP datagrams that hold the frames
//! of the radio and nothing else.
//!
//! The world keeps the ticks in step over TCP, so that a run does not depend on
//! how fast a process is; which frame arrives in which tick does. Nobody waits for ever
//! for anybody: each line has a deadline and a greatest length, and strangers are
//! listened to beside the ticks.

mod door;
mod error;
mod line;
mod protocol;
mod robot;
mod world;

pub use error::LiveError;
pub use line::LineError;
pub use robot::{RobotOptions, RobotReport, explore};
pub use world::{Event, Server, WorldOptions, WorldReport};
