//! Links only if no path from planner-core leads to a panic: the panic handler
//! calls a function that does not exist, and the linker drops the handler if
//! nothing can reach it. This image is never run.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[path = "no_panic/verbs.rs"]
mod verbs;

#[cfg(not(target_os = "none"))]
fn main() -> std::process::ExitCode {
    firmware::explain()
}

#[cfg(target_os = "none")]
#[cortex_m_rt::entry]
fn main() -> ! {
    loop {
        verbs::call_all();
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
