//! What an interrupted command leaves behind: no half-written file.

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
            if let Some(signal) = signals.forever().next() {
                files::abandon(|| {
                    let _ = emulate_default_handler(signal);
                });
            }
        });
    }
}
