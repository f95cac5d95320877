//! Two wheels, driven by pulse width, that go from cell to cell by time.
//!
//! Time is a poor measure of the way; a robot with encoders or a flow sensor
//! replaces [`Wheels::go`] by a controller, which knows whether it has come there.

use embedded_hal::delay::DelayNs;
use embedded_hal::digital::OutputPin;
use embedded_hal::pwm::SetDutyCycle;
use planner_core::Direction;

/// Time for the way from one cell to the next.
const STEP_MS: u32 = 900;
/// Time for a quarter turn on the spot.
pub(crate) const TURN_MS: u32 = 450;
/// Share of full power.
const POWER_PERCENT: u8 = 40;

/// Two motors, each with a pin that reverses it.
pub(crate) struct Wheels<P, Q, A, B, D> {
    pub(crate) left: P,
    pub(crate) right: Q,
    pub(crate) left_back: A,
    pub(crate) right_back: B,
    pub(crate) delay: D,
}

impl<P, Q, A, B, D> Wheels<P, Q, A, B, D>
where
    P: SetDutyCycle,
    Q: SetDutyCycle,
    A: OutputPin,
    B: OutputPin,
    D: DelayNs,
{
    /// Goes one cell ahead.
    pub(crate) fn go(&mut self) {
        self.drive(false, false, STEP_MS);
    }

    /// Turns from `heading` to `direction` on the spot.
    pub(crate) fn turn(&mut self, heading: Direction, direction: Direction) {
        match (direction as u8).wrapping_sub(heading as u8) & 3 {
            0 => {}
            1 => self.drive(false, true, TURN_MS),
            2 => self.drive(false, true, 2 * TURN_MS),
            _ => self.drive(true, false, TURN_MS),
        }
    }

    pub(crate) fn wait(&mut self) {
        self.delay.delay_ms(STEP_MS);
    }

    /// Drives for a while; a wheel that does not obey stops the robot.
    fn drive(&mut self, left_back: bool, right_back: bool, time_ms: u32) {
        let obeyed = self.left_back.set_state(left_back.into()).is_ok()
            && self.right_back.set_state(right_back.into()).is_ok()
            && self.left.set_duty_cycle_percent(POWER_PERCENT).is_ok()
            && self.right.set_duty_cycle_percent(POWER_PERCENT).is_ok();
        if obeyed {
            self.delay.delay_ms(time_ms);
        } else {
            defmt::error!("a motor does not obey");
        }
        // Both are tried, whatever the other says.
        let _ = self.left.set_duty_cycle_fully_off();
        let _ = self.right.set_duty_cycle_fully_off();
    }
}
