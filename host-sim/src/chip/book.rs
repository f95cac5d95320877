//! What all chips of a run write down.

use std::cell::{OnceCell, RefCell};

use bridge::Cost;

use super::emulator::Machine;
use super::error::ChipError;
use crate::measured::{Call, Measured};

/// Shared by all chips of a run.
pub(super) struct Book {
    /// The first failure. The run is worth nothing after it, and ends.
    pub(super) failure: OnceCell<ChipError>,
    pub(super) measured: RefCell<Measured>,
}

impl Book {
    /// An empty one of chips of this kind.
    pub(super) fn of(machine: Machine) -> Self {
        let measured = Measured {
            machine: machine.to_string(),
            ..Measured::default()
        };
        Self {
            failure: OnceCell::new(),
            measured: measured.into(),
        }
    }

    /// Notes what a call took. The emulated chip's clock counts instructions: each
    /// takes a nanosecond.
    pub(super) fn count(&self, call: Call, cost: Cost, clock_hz: u64) {
        let instructions = u64::from(cost.clock_ticks) * 1_000_000_000 / clock_hz;
        let mut measured = self.measured.borrow_mut();
        measured.count(call, instructions, cost.stack);
    }

    /// What was measured.
    ///
    /// # Errors
    /// The failure, if there was one.
    pub(super) fn close(self) -> Result<Measured, ChipError> {
        match self.failure.into_inner() {
            Some(failure) => Err(failure),
            None => Ok(self.measured.into_inner()),
        }
    }
}
