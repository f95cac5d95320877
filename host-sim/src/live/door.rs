//! Who wants in: a thread of its own listens to all that come, so that nobody who says
//! nothing, or half a line, or too much, holds up a tick.

use std::collections::VecDeque;
use std::io;
use std::net::{SocketAddr, TcpListener};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::time::{Duration, Instant};

use super::line::Line;
use super::protocol::{FromRobot, refuse};

/// How long somebody may take to say who it is.
const PATIENCE: Duration = Duration::from_secs(5);
/// Strangers listened to at once; when there are more, the first of them goes.
const CALLERS: usize = 64;
/// Robots that wait for the next tick to be let in.
const NEWCOMERS: usize = 64;
/// Time between two looks.
const PAUSE: Duration = Duration::from_millis(2);

/// One that has said which robot it is.
pub(super) struct Newcomer {
    pub(super) robot: u8,
    pub(super) line: Line,
}

/// Where robots come in. Closed when dropped.
pub(super) struct Door {
    address: SocketAddr,
    newcomers: Receiver<Newcomer>,
    is_closed: Arc<AtomicBool>,
}

impl Door {
    /// Opens the door.
    pub(super) fn open(at: SocketAddr) -> io::Result<Self> {
        let listener = TcpListener::bind(at)?;
        listener.set_nonblocking(true)?;
        let address = listener.local_addr()?;
        let (to, newcomers) = sync_channel(NEWCOMERS);
        let is_closed = Arc::new(AtomicBool::new(false));
        let flag = is_closed.clone();
        std::thread::Builder::new()
            .name("door".into())
            .spawn(move || keep(&listener, &to, &flag))?;
        Ok(Self {
            address,
            newcomers,
            is_closed,
        })
    }

    pub(super) fn address(&self) -> SocketAddr {
        self.address
    }

    /// Those that have come since, at most as many as wait.
    pub(super) fn newcomers(&self) -> impl Iterator<Item = Newcomer> + '_ {
        self.newcomers.try_iter().take(NEWCOMERS)
    }
}

impl Drop for Door {
    fn drop(&mut self) {
        self.is_closed.store(true, Ordering::Relaxed);
    }
}

struct Caller {
    line: Line,
    came: Instant,
}

fn keep(listener: &TcpListener, to: &SyncSender<Newcomer>, is_closed: &AtomicBool) {
    let mut callers: VecDeque<Caller> = VecDeque::new();
    while !is_closed.load(Ordering::Relaxed) {
        // Whatever fails here fails for the one who came; the others come all the same.
        for _ in 0..CALLERS {
            let Ok((stream, _)) = listener.accept() else {
                break;
            };
            if let Ok(line) = Line::new(stream) {
                let came = Instant::now();
                callers.push_back(Caller { line, came });
            }
            // A robot says at once who it is, so that the first is the likeliest stranger.
            if callers.len() > CALLERS {
                callers.pop_front();
            }
        }
        for _ in 0..callers.len() {
            let Some(mut caller) = callers.pop_front() else {
                break;
            };
            match caller.line.poll() {
                Ok(Some(FromRobot::Hello { robot })) => {
                    let line = caller.line;
                    if let Err(full) = to.try_send(Newcomer { robot, line }) {
                        let (std::sync::mpsc::TrySendError::Full(newcomer)
                        | std::sync::mpsc::TrySendError::Disconnected(newcomer)) = full;
                        refuse(newcomer.line, "too many come at once; come again later");
                    }
                }
                Ok(None) if caller.came.elapsed() < PATIENCE => callers.push_back(caller),
                Ok(None) => refuse(caller.line, "it did not say which robot it is"),
                Ok(Some(_)) => refuse(caller.line, "a robot says first which one it is"),
                Err(error) => refuse(caller.line, &format!("it {error}")),
            }
        }
        std::thread::sleep(PAUSE);
    }
}
