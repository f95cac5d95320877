//! The Cortex-M image: explores a built-in map and reports through semihosting.
//!
//! `cargo xtask run-firmware` builds it and runs it in QEMU.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod image;

#[cfg(not(target_os = "none"))]
fn main() -> std::process::ExitCode {
    firmware::explain()
}
