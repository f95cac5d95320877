//! What the image takes of the chip, by the linker's symbols.

use bridge::Memory;

use crate::stack;

unsafe extern "C" {
    // Defined by the linker scripts of cortex-m-rt; only their addresses mean anything.
    static __vector_table: u32;
    static __sidata: u32;
    static __sdata: u32;
    static __edata: u32;
    static __euninit: u32;
    static _stack_start: u32;
}

/// Bytes that the statics take. They begin where the stack does.
pub fn statics() -> usize {
    (&raw const __euninit).addr() - (&raw const _stack_start).addr()
}

/// Bytes of flash: the vector table, code, constants and initial values.
pub fn flash() -> usize {
    let initial_values = (&raw const __edata).addr() - (&raw const __sdata).addr();
    (&raw const __sidata).addr() + initial_values - (&raw const __vector_table).addr()
}

/// What the image and a planner of that size take.
pub fn taken(planner: usize) -> Memory {
    let bytes = |size: usize| size as u32;
    Memory {
        planner: bytes(planner),
        statics: bytes(statics()),
        flash: bytes(flash()),
        stack_peak: bytes(stack::peak()),
        stack: bytes(stack::size()),
    }
}
