//! Exploration planners for swarms of microcontroller-class robots.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

pub mod cao;
mod cell;
pub mod coordinated_survey;
pub mod fcao;
mod math;
mod point;
pub mod rng;
pub mod surface;
pub mod survey;

pub use cell::{Cell, Direction, Extent};
pub use point::Point;
