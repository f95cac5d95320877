//! Brick & Mortar Improved Long Range Vision.

mod board;
mod planner;
mod robot;
#[cfg(test)]
mod tests;

pub use planner::{Bmilrv, Marks};
