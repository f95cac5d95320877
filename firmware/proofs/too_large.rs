//! Takes more memory than the chip has: must not link.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() -> std::process::ExitCode {
    firmware::explain()
}

/// As large as RAM in memory-layout.x; the flag of the cell is one byte too many.
#[cfg(target_os = "none")]
static TOO_LARGE: static_cell::ConstStaticCell<[u8; 112 * 1024]> =
    static_cell::ConstStaticCell::new([0; 112 * 1024]);

#[cfg(target_os = "none")]
#[cortex_m_rt::entry]
fn main() -> ! {
    core::hint::black_box(TOO_LARGE.try_take());
    firmware::end(firmware::Ending::Success)
}
