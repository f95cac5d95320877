//! Recurses without end: must fault as soon as the stack is full.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() -> std::process::ExitCode {
    firmware::explain()
}

#[cfg(target_os = "none")]
#[cortex_m_rt::entry]
fn main() -> ! {
    firmware::end(if depth(0) > 0 {
        firmware::Ending::Success
    } else {
        firmware::Ending::Failure
    })
}

/// Comes back only where the stack has no end.
#[cfg(target_os = "none")]
#[inline(never)]
fn depth(level: u32) -> u32 {
    let level = core::hint::black_box(level);
    if level == u32::MAX {
        return 0;
    }
    // Not the last thing that is done: else it becomes a loop.
    core::hint::black_box(depth(level + 1)) + 1
}
