//! Must not link: the control of `no_panic.rs`. One panic that the compiler
//! cannot rule out is enough for the missing function to be missed.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() -> std::process::ExitCode {
    firmware::explain()
}

#[cfg(target_os = "none")]
#[cortex_m_rt::entry]
fn main() -> ! {
    let places = core::hint::black_box([0_u8; 4]);
    let place = core::hint::black_box(4_usize);
    loop {
        core::hint::black_box(places[place]);
    }
}

#[cfg(target_os = "none")]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    unsafe extern "C" {
        fn a_panic_is_reachable() -> !;
    }
    // SAFETY: never called: an image with this call does not link.
    unsafe { a_panic_is_reachable() }
}
