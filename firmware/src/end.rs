//! How an image ends: with a status for the host, whatever happens.

use core::fmt::Write as _;
use core::panic::PanicInfo;

use cortex_m_semihosting::{debug, hio};

use crate::stack;

/// What the host is told.
pub enum Ending {
    /// Exit status 0.
    Success,
    /// Exit status 1.
    Failure,
}

/// Ends the emulation, or the debugger's session, with a status.
pub fn end(ending: Ending) -> ! {
    loop {
        debug::exit(match ending {
            Ending::Success => debug::EXIT_SUCCESS,
            Ending::Failure => debug::EXIT_FAILURE,
        });
    }
}

#[panic_handler]
fn panic(info: &PanicInfo<'_>) -> ! {
    fail(format_args!("{info}"))
}

/// Reports on the host's standard error and ends with a failure.
pub fn fail(what: core::fmt::Arguments<'_>) -> ! {
    if let Ok(mut out) = hio::hstderr() {
        // Without a host that listens, the status is all that is left to say.
        let _ = writeln!(out, "error: {what}");
    }
    end(Ending::Failure)
}

/// Takes every fault. The stack may be the fault's cause, and a handler that
/// needs it would only fault again: begin a new one first.
///
/// cortex-m-rt puts the address of the symbol `HardFault` into the vector table.
#[unsafe(no_mangle)]
#[unsafe(naked)]
extern "C" fn HardFault() -> ! {
    core::arch::naked_asm!(
        "mrs r0, msp",
        "ldr r1, =_stack_start",
        "msr msp, r1",
        "ldr r1, ={report}", // farther than a Cortex-M0 can branch
        "bx r1",
        report = sym report_fault,
    )
}

extern "C" fn report_fault(stack_pointer: usize) -> ! {
    let (bottom, _) = stack::bounds();
    if stack_pointer < bottom {
        fail(format_args!(
            "the stack overflowed its {} bytes; raise the LENGTH of STACK in memory-layout.x",
            stack::size()
        ));
    }
    fail(format_args!(
        "hard fault with the stack pointer at {stack_pointer:#010x}; run it under a debugger"
    ))
}
