//! What a call takes at worst: the planners in places that are made to cost as much
//! as possible, by the clock that counts instructions.
//!
//! `cargo xtask test --only worst` runs it and holds it against fixtures/budget.txt.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod cao;
#[cfg(target_os = "none")]
mod explorer;
#[cfg(target_os = "none")]
mod places;
#[cfg(target_os = "none")]
mod scan;
#[cfg(target_os = "none")]
mod voxels;

#[cfg(not(target_os = "none"))]
fn main() -> std::process::ExitCode {
    firmware::explain()
}

#[cfg(target_os = "none")]
#[cortex_m_rt::entry]
fn main() -> ! {
    let stopwatch = firmware::Stopwatch::start();
    let measured = explorer::measure(&stopwatch)
        .and_then(|()| scan::measure(&stopwatch))
        .and_then(|()| cao::measure(&stopwatch))
        .and_then(|()| voxels::measure(&stopwatch));
    match measured {
        Ok(()) => firmware::end(firmware::Ending::Success),
        Err(core::fmt::Error) => panic!("the host does not take the report; enable semihosting"),
    }
}

/// The most that calls of one kind took.
#[cfg(target_os = "none")]
#[derive(Clone, Copy, Default)]
struct Most {
    clock_ticks: u32,
    stack: u32,
}

#[cfg(target_os = "none")]
impl Most {
    /// Makes a call, and remembers what it took if that was more than ever.
    fn of<T>(&mut self, stopwatch: &firmware::Stopwatch, call: impl FnOnce() -> T) -> T {
        let (value, cost) = stopwatch.measure(call);
        self.clock_ticks = self.clock_ticks.max(cost.clock_ticks);
        self.stack = self.stack.max(cost.stack);
        value
    }

    /// Under QEMU's `-icount shift=0` an instruction takes a nanosecond.
    fn instructions(self) -> u64 {
        u64::from(self.clock_ticks) * 1_000_000_000 / u64::from(firmware::CLOCK_HZ)
    }
}
