//! What a call costs: time by the timer that every Cortex-M has, stack by paint.
//!
//! Under QEMU's `-icount shift=0` an instruction takes one nanosecond, so the
//! timer counts instructions: the same number in every run, to within one tick.

use core::sync::atomic::{AtomicU32, Ordering};

use bridge::Cost;
use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m_rt::exception;

use crate::stack;

/// The timer has 24 bits and counts down.
const RELOAD: u32 = 0x00ff_ffff;

/// How often the timer has started anew.
static ROUNDS: AtomicU32 = AtomicU32::new(0);

#[exception]
fn SysTick() {
    // Nobody else writes, and a chip may lack read-modify-write instructions.
    ROUNDS.store(
        ROUNDS.load(Ordering::Relaxed).wrapping_add(1),
        Ordering::Relaxed,
    );
}

/// A running clock.
pub struct Stopwatch(());

impl Stopwatch {
    /// Starts the chip's timer at the speed of the processor.
    ///
    /// # Panics
    /// If it was started before.
    pub fn start() -> Self {
        let chip = cortex_m::Peripherals::take().expect("nobody else takes the timer");
        let mut timer = chip.SYST;
        timer.set_clock_source(SystClkSource::Core);
        timer.set_reload(RELOAD);
        timer.clear_current();
        timer.enable_interrupt();
        timer.enable_counter();
        Self(())
    }

    /// Makes a call, and says what it took.
    pub fn measure<T>(&self, call: impl FnOnce() -> T) -> (T, Cost) {
        let timed = || {
            let begin = self.now();
            let value = call();
            (value, self.now().wrapping_sub(begin))
        };
        let ((value, clock_ticks), stack) = stack::depth(timed);
        let stack = stack as u32;
        (value, Cost { clock_ticks, stack })
    }

    /// Ticks since the start, modulo 2³².
    fn now(&self) -> u32 {
        loop {
            let rounds = ROUNDS.load(Ordering::Relaxed);
            let passed = RELOAD - SYST::get_current();
            if rounds == ROUNDS.load(Ordering::Relaxed) {
                return rounds.wrapping_mul(RELOAD + 1).wrapping_add(passed);
            }
        }
    }
}
