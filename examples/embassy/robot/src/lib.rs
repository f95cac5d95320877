//! A robot on embassy, for any chip: three tasks, and what waits between them.
//!
//! ```text
//!  radio ──FRAMES──▶ planner ◀──ZONES── sensor
//!    ▲                  │
//!    └─────OUTBOX───────┘
//! ```
//!
//! [`radio`] runs at the priority of an interrupt, so that no frame is missed while the planner
//! thinks. [`sensor`] and [`planner`] share the main executor. The planner alone calls
//! `receive`: it belongs to one task, and frames wait in [`FRAMES`] until that has time.
#![no_std]

mod planner;
mod wheels;

use embassy_futures::select::{Either, select};
use embassy_sync::blocking_mutex::raw::CriticalSectionRawMutex;
use embassy_sync::channel::Channel;
use embassy_sync::signal::Signal;
use heapless::Vec;
use planner_core::radio::MAX_LEN;
use planner_core::sight::Zone;

pub use planner::{Place, planner};
pub use wheels::Wheels;

/// A frame of the planner, as it goes over the air.
pub type Frame = Vec<u8, MAX_LEN>;

/// Frames that were heard and that the planner has not read: those of 16 robots that send one
/// a tick. When it is full, the newest is dropped, as if the air had lost it.
static FRAMES: Channel<CriticalSectionRawMutex, Frame, 16> = Channel::new();

/// Frames that are to be sent. The planner writes one a tick.
static OUTBOX: Channel<CriticalSectionRawMutex, Frame, 2> = Channel::new();

/// What the sensor measured last; an older measurement that nobody took is overwritten.
static ZONES: Signal<CriticalSectionRawMutex, [Zone; 64]> = Signal::new();

/// Carries frames as they are. What it garbles the planner refuses by its check bytes.
#[allow(
    async_fn_in_trait,
    reason = "one executor; nothing moves between threads"
)]
pub trait Radio {
    /// Sends a frame. One that cannot be sent is lost; the next ones say the same again.
    async fn send(&mut self, frame: &[u8]);

    /// The next frame. Dropping the future loses at most the frame that is coming in.
    async fn receive(&mut self) -> Frame;
}

/// A sensor with 8×8 zones, the topmost row first and each from left to right.
#[allow(
    async_fn_in_trait,
    reason = "one executor; nothing moves between threads"
)]
pub trait Zones {
    /// The next measurement.
    async fn measure(&mut self) -> [Zone; 64];
}

/// Sends what the planner wants to say and keeps what is heard.
pub async fn radio(mut radio: impl Radio) -> ! {
    loop {
        match select(radio.receive(), OUTBOX.receive()).await {
            Either::First(frame) => {
                if FRAMES.try_send(frame).is_err() {
                    defmt::debug!("a frame is dropped: the planner is behind");
                }
            }
            Either::Second(frame) => radio.send(&frame).await,
        }
    }
}

/// Measures all the time.
pub async fn sensor(mut zones: impl Zones) -> ! {
    loop {
        ZONES.signal(zones.measure().await);
    }
}
