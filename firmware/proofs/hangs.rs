//! Never answers: the simulator must not wait for it for ever.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() -> std::process::ExitCode {
    firmware::explain()
}

#[cfg(target_os = "none")]
#[cortex_m_rt::entry]
fn main() -> ! {
    use firmware as _; // its handlers of panics and faults
    loop {
        cortex_m::asm::wfi();
    }
}
