//! The image of one robot among voxels in lock step with the simulator: firmware in the loop.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod robot;

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
