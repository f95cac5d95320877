//! How much of the stack was ever used.
//!
//! cortex-m-rt paints the stack before `main`; what has lost its paint was used.

use cortex_m_rt::STACK_PAINT_VALUE;

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
