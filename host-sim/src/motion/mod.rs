//! Bodies that move in metres and seconds: discs with speed and inertia that follow the
//! straight ways of their planners, among walls and each other.
//!
//! In each tick a planner looks and decides; its [`Driver`] then steers for the waypoint, or
//! for the middle of the next cell, and all bodies move on in steps of 20 ms at most. A driver
//! goes nowhere that its own map does not show free, and begins nothing that it could not
//! stop in time: what it does in the next tick, and the braking after it, is clear of walls
//! on its map and of the same of all others. So without slip and drift no body touches
//! anything.
//!
//! The robot's cell, in looks and traces, follows its pose by one step a tick: a body that
//! crosses a corner takes two.

mod body;
mod collide;
mod control;
mod driver;
#[cfg(test)]
mod tests;

pub(crate) use driver::{Aim, Drivers, Steered};
