//! The image of one robot in lock step with the simulator: firmware in the loop.
//!
//! `host-sim firmware` starts one in QEMU for each robot.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod robot;
// Only where there is a unit for its floats, and room for its planners.
#[cfg(all(target_os = "none", board = "stm32f405"))]
mod survey;

#[cfg(not(target_os = "none"))]
fn main() -> std::process::ExitCode {
    firmware::explain()
}

#[cfg(target_os = "none")]
#[cortex_m_rt::entry]
fn main() -> ! {
    match robot::serve() {
        Ok(()) => firmware::end(firmware::Ending::Success),
        Err(trouble) => firmware::fail(format_args!("{trouble}")),
    }
}
