//! How much of the stack was ever used.
//!
//! cortex-m-rt paints the stack before `main`; what has lost its paint was used.

use core::sync::atomic::{AtomicUsize, Ordering};

use cortex_m::register::msp;
use cortex_m_rt::STACK_PAINT_VALUE;

/// The most that was in use before the paint was renewed.
static PEAK: AtomicUsize = AtomicUsize::new(0);

unsafe extern "C" {
    // Defined in memory-layout.x; only their addresses mean anything.
    static _stack_start: u32;
    static _stack_end: u32;
}

/// The addresses of the stack: the first, and the first above.
pub(crate) fn bounds() -> (usize, usize) {
    (
        (&raw const _stack_end).addr(),
        (&raw const _stack_start).addr(),
    )
}

/// Size of the stack in bytes.
pub fn size() -> usize {
    let (bottom, top) = bounds();
    top - bottom
}

/// The most that was in use at any time since the reset, in bytes.
///
/// Work: reads the unused part once.
pub fn peak() -> usize {
    PEAK.load(Ordering::Relaxed).max(since_painted())
}

/// Makes a call, and says how many bytes of stack it took.
///
/// Work: reads and writes the unused part of the stack.
#[inline(never)]
pub fn depth<T>(call: impl FnOnce() -> T) -> (T, usize) {
    PEAK.store(peak(), Ordering::Relaxed);
    let (bottom, top) = bounds();
    let here = msp::read() as usize;
    for at in (bottom..here).step_by(size_of::<u32>()) {
        // SAFETY: below the stack pointer nothing is kept. An interrupt that uses
        // it is over before the next word is written.
        unsafe {
            core::ptr::with_exposed_provenance_mut::<u32>(at).write_volatile(STACK_PAINT_VALUE);
        }
    }
    let value = apart(call);
    (value, since_painted() - (top - here))
}

/// Gives the call a frame of its own, below the one that is measured from.
#[inline(never)]
fn apart<T>(call: impl FnOnce() -> T) -> T {
    call()
}

/// The most that was in use since the stack was painted, in bytes.
fn since_painted() -> usize {
    let (bottom, top) = bounds();
    let painted = (bottom..top).step_by(size_of::<u32>()).take_while(|&at| {
        // SAFETY: the linker reserves `bottom..top` as readable memory, aligned
        // to words. It is volatile because it is read behind the compiler's back,
        // below the stack pointer, where nothing else writes while this runs.
        unsafe {
            core::ptr::with_exposed_provenance::<u32>(at).read_volatile() == STACK_PAINT_VALUE
        }
    });
    size() - painted.count() * size_of::<u32>()
}
