//! Two wheels behind an H-bridge, each with one pin for either direction, that go by time. A
//! robot with encoders replaces this file.

use embassy_time::Timer;
use embedded_hal::digital::OutputPin;
use planner_core::Direction;

/// Time for the way from one cell to the next, and for a quarter turn, in milliseconds.
const STEP_MS: u64 = 900;
const TURN_MS: u64 = 450;

/// The pins of a wheel: forward, back.
type Wheel<P> = [P; 2];

/// Two wheels.
pub struct Wheels<P> {
    left: Wheel<P>,
    right: Wheel<P>,
}

impl<P: OutputPin> Wheels<P> {
    /// Each wheel's pins: forward, back.
    pub fn new(left: Wheel<P>, right: Wheel<P>) -> Self {
        Self { left, right }
    }

    /// Goes one cell ahead.
    pub(crate) async fn go(&mut self) {
        self.drive(true, true, STEP_MS).await;
    }

    /// Turns from `heading` to `direction` on the spot.
    pub(crate) async fn turn(&mut self, heading: Direction, direction: Direction) {
        match (direction as u8).wrapping_sub(heading as u8) & 3 {
            0 => {}
            1 => self.drive(true, false, TURN_MS).await,
            2 => self.drive(true, false, 2 * TURN_MS).await,
            _ => self.drive(false, true, TURN_MS).await,
        }
    }

    async fn drive(&mut self, left: bool, right: bool, time_ms: u64) {
        set(&mut self.left, left, !left);
        set(&mut self.right, right, !right);
        Timer::after_millis(time_ms).await;
        set(&mut self.left, false, false);
        set(&mut self.right, false, false);
    }
}

fn set<P: OutputPin>([forward, back]: &mut Wheel<P>, ahead: bool, reverse: bool) {
    let obeyed = forward
        .set_state(ahead.into())
        .and(back.set_state(reverse.into()));
    if obeyed.is_err() {
        defmt::error!("a wheel does not obey");
    }
}
