//! Exploration planners for swarms of microcontroller-class robots.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

mod cell;

pub use cell::{Cell, Direction, Extent};
