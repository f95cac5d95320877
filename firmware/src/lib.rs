//! What every image for the chip shares: the world it explores, the measures of
//! its time and memory, the way to the simulator, and how it ends.
//!
//! On the host this crate is empty; see `main.rs` for the image itself.
#![cfg_attr(target_os = "none", no_std)]

#[cfg(target_os = "none")]
mod board;
#[cfg(target_os = "none")]
mod end;
#[cfg(target_os = "none")]
mod explore;
#[cfg(target_os = "none")]
mod host;
#[cfg(target_os = "none")]
pub mod memory;
#[cfg(target_os = "none")]
pub mod stack;
#[cfg(target_os = "none")]
mod stopwatch;
#[cfg(target_os = "none")]
mod world;

#[cfg(target_os = "none")]
pub use {
    board::{CLOCK_HZ, COLUMNS, ROWS},
    end::{Ending, end, fail},
    explore::{Exploration, explore},
    host::{Host, Refused, Trouble},
    stopwatch::Stopwatch,
    world::World,
};

/// What `main` of an image says when it is built for the host.
#[cfg(not(target_os = "none"))]
pub fn explain() -> std::process::ExitCode {
    eprintln!("This is an image for the chip; run it with `cargo xtask run-firmware`.");
    std::process::ExitCode::from(2)
}
