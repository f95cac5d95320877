//! The other end of `examples/crazyflie/stub/stub.c`.

use std::io::{Read, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

use anyhow::{Context, Result};

use crate::install;

/// Packets that the stub takes at once.
pub(super) const PACKETS: usize = 16;

/// Its size, and 61 bytes.
pub(super) type Packet = [u8; 62];

/// What an app asks for when it waits.
pub(super) struct Request {
    /// Milliseconds.
    pub(super) delay: u32,
    pub(super) known: u32,
    pub(super) stack: u32,
    /// Metres, and a yaw in radians.
    pub(super) target: [f32; 4],
    /// Seconds.
    pub(super) duration: f32,
    pub(super) command: u8,
    pub(super) state: u8,
    pub(super) stop: u8,
    pub(super) id: u32,
    pub(super) packets: Vec<Packet>,
}

/// What an app hears.
pub(super) struct Reply {
    pub(super) now: u32,
    pub(super) sensed: Sensed,
    pub(super) go: bool,
    pub(super) packets: Vec<Packet>,
}

/// What sensors say.
pub(super) struct Sensed {
    /// Metres.
    pub(super) pose: [f32; 3],
    /// Roll, pitch and yaw in degrees.
    pub(super) angles: [f32; 3],
    /// Front, back, left and right, in metres.
    pub(super) ranges: [f32; 4],
    pub(super) volts: f32,
}

/// An emulator with the app in it, and what it says.
pub(super) struct Chip {
    emulator: Child,
    requests: Receiver<Request>,
    replies: ChildStdin,
}

impl Chip {
    pub(super) fn start(image: &Path) -> Result<Self> {
        let mut emulator = Command::new(install::QEMU)
            .args([
                "-machine",
                "netduinoplus2",
                "-nodefaults",
                "-display",
                "none",
            ])
            .args(["-monitor", "none", "-serial", "none"])
            .args(["-semihosting-config", "enable=on,target=native"])
            .arg("-kernel")
            .arg(image)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .context(install::QEMU)?;
        let replies = emulator.stdin.take().context("no pipe")?;
        let mut stream = emulator.stdout.take().context("no pipe")?;
        let (sender, requests) = channel();
        std::thread::spawn(move || {
            while let Ok(request) = read(&mut stream) {
                if sender.send(request).is_err() {
                    break;
                }
            }
        });
        Ok(Self {
            emulator,
            requests,
            replies,
        })
    }

    pub(super) fn receive(&mut self) -> Result<Request> {
        const LONGEST: Duration = Duration::from_secs(60);
        let request = self.requests.recv_timeout(LONGEST);
        request.context("the app ended, or has not waited for a minute")
    }

    pub(super) fn send(&mut self, reply: &Reply) -> Result<()> {
        let mut bytes = reply.now.to_le_bytes().to_vec();
        let Sensed {
            pose,
            angles,
            ranges,
            volts,
        } = &reply.sensed;
        for value in pose.iter().chain(angles).chain(ranges).chain([volts]) {
            bytes.extend(value.to_le_bytes());
        }
        bytes.extend([reply.go.into(), reply.packets.len() as u8, 0, 0]);
        bytes.extend(reply.packets.iter().flatten());
        self.replies.write_all(&bytes).context("the app has ended")
    }
}

impl Drop for Chip {
    fn drop(&mut self) {
        // It is of no use any more.
        let _ = self.emulator.kill();
        let _ = self.emulator.wait();
    }
}

fn read(stream: &mut impl Read) -> std::io::Result<Request> {
    let mut bytes = [0; 40];
    stream.read_exact(&mut bytes)?;
    let word = |at: usize| [bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]];
    let [command, state, stop, count] = word(32);
    let mut packets = vec![[0; 62]; count.into()];
    for packet in &mut packets {
        stream.read_exact(packet)?;
    }
    Ok(Request {
        delay: u32::from_le_bytes(word(0)),
        known: u32::from_le_bytes(word(4)),
        stack: u32::from_le_bytes(word(8)),
        target: [12, 16, 20, 24].map(|at| f32::from_le_bytes(word(at))),
        duration: f32::from_le_bytes(word(28)),
        command,
        state,
        stop,
        id: u32::from_le_bytes(word(36)),
        packets,
    })
}
