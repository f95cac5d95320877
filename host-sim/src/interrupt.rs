//! What an interrupted command leaves behind: no half-written file.

use std::sync::atomic::{AtomicBool, Ordering};

/// Whether the first interrupt asks for an early end, and no more.
static IS_HEARD: AtomicBool = AtomicBool::new(false);
/// Whether it has.
static END: AtomicBool = AtomicBool::new(false);

/// From now on the first interrupt sets what this returns, and the next one does what it
/// always does.
pub(crate) fn ask_for_end() -> &'static AtomicBool {
    IS_HEARD.store(true, Ordering::Relaxed);
    &END
}

/// From now on, an interrupt (Ctrl-C) or a request to end removes the files that are being
/// written, and then does what it always does.
pub(crate) fn leave_no_half_files() {
    #[cfg(unix)]
    {
        use host_sim::files;
        use signal_hook::consts::{SIGINT, SIGTERM};
        use signal_hook::iterator::Signals;
        use signal_hook::low_level::emulate_default_handler;

        // Without a handler everything works but this.
        let Ok(mut signals) = Signals::new([SIGINT, SIGTERM]) else {
            return;
        };
        std::thread::spawn(move || {
            for signal in signals.forever() {
                if IS_HEARD.swap(false, Ordering::Relaxed) {
                    END.store(true, Ordering::Relaxed);
                    continue;
                }
                files::abandon(|| {
                    let _ = emulate_default_handler(signal);
                });
            }
        });
    }
}
