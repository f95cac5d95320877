//! The lab: watch, steer and compare explorations, in a window and in the browser.
//!
//! ```text
//! Setup -> host-sim's scenario -> Watch (run or trace, tick by tick) -> views, plots
//! ```
//! Nothing is simulated here: [`watch::Watch`] drives host-sim's run and remembers what
//! is needed to go back. [`setup::Setup`] is what the menus set, and can be written as an
//! address and as a `host-sim` command; both reproduce the run, to the same digest.

pub mod app;
pub mod colors;
pub mod decisions;
pub mod export;
pub mod gallery;
pub mod ground;
pub mod maps;
mod opened;
mod pack;
mod panels;
pub mod platform;
pub mod playback;
pub mod setup;
pub mod survey;
pub mod view;
pub mod watch;
#[cfg(target_arch = "wasm32")]
mod web;

pub use app::App;
