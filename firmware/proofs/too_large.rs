//! Takes more memory than the chip has: must not link.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() -> std::process::ExitCode {
    firmware::explain()
}

/// LENGTH of RAM in memory-layout.x.
#[cfg(target_os = "none")]
const RAM: usize = 118_016;

/// As large as RAM; the flag of the cell is one byte too many.
#[cfg(target_os = "none")]
static TOO_LARGE: static_cell::ConstStaticCell<[u8; RAM]> =
    static_cell::ConstStaticCell::new([0; RAM]);

#[cfg(target_os = "none")]
#[cortex_m_rt::entry]
fn main() -> ! {
    core::hint::black_box(TOO_LARGE.try_take());
    firmware::end(firmware::Ending::Success)
}
