//! One emulated chip, and the dialogue with it.

use std::fmt;
use std::fs::File;
use std::io::{self, Read, Seek, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::Duration;

use bridge::{Hello, Inbox, MAX_MESSAGE, ReadError, Request, VERSION, Welcome};
use clap::ValueEnum;
use planner_core::RobotId;
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use serde::{Deserialize, Serialize};

use super::error::ChipError;

const QEMU: &str = "qemu-system-arm";

/// A board that QEMU emulates and that the image is built for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Machine {
    /// STM32F405, the chip of the Crazyflie: Cortex-M4F, 168 MHz.
    Netduinoplus2,
    /// Cortex-M3, 25 MHz, no floating-point unit.
    Mps2An385,
    /// nRF51: Cortex-M0, 16 MHz, 16 KiB of RAM; maps of at most 32×32 cells.
    Microbit,
}

impl Machine {
    /// The Rust target of its image.
    const fn target(self) -> &'static str {
        match self {
            Self::Netduinoplus2 => "thumbv7em-none-eabihf",
            Self::Mps2An385 => "thumbv7m-none-eabi",
            Self::Microbit => "thumbv6m-none-eabi",
        }
    }

    /// Where `cargo xtask build-firmware` puts its image.
    pub fn image(self) -> PathBuf {
        let target = std::env::var_os("CARGO_TARGET_DIR").map_or("target".into(), PathBuf::from);
        target.join(self.target()).join("firmware").join("robot")
    }
}

/// The name that QEMU knows it by.
impl fmt::Display for Machine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let value = self.to_possible_value().expect("no machine is hidden");
        f.write_str(value.get_name())
    }
}

/// A running emulator. Dropping it ends it.
pub(super) struct Chip {
    robot: RobotId,
    emulator: Child,
    requests: ChildStdin,
    answers: ChildStdout,
    /// What the image and QEMU print.
    messages: File,
    /// How long an answer is waited for.
    limit: Duration,
    inbox: Inbox,
    outbox: [u8; MAX_MESSAGE],
}

impl Chip {
    /// Starts the image.
    pub(super) fn start(
        robot: RobotId,
        machine: Machine,
        image: &Path,
        limit: Duration,
    ) -> Result<Self, ChipError> {
        if !image.is_file() {
            let path = image.to_path_buf();
            return Err(ChipError::NoImage { path, machine });
        }
        let system = |problem| ChipError::System { robot, problem };
        let messages = tempfile::tempfile().map_err(system)?;
        let mut emulator = Command::new(QEMU)
            .args(["-machine", &machine.to_string()])
            .args([
                "-nodefaults",
                "-display",
                "none",
                "-monitor",
                "none",
                "-serial",
                "none",
            ])
            // An instruction takes a nanosecond: the chip's clock counts them.
            .args(["-icount", "shift=0"])
            .args(["-semihosting-config", "enable=on,target=native"])
            .arg("-kernel")
            .arg(image)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(messages.try_clone().map_err(system)?)
            .spawn()
            .map_err(|problem| ChipError::NoEmulator {
                program: QEMU,
                problem,
            })?;
        let (requests, answers) = (emulator.stdin.take(), emulator.stdout.take());
        Ok(Self {
            robot,
            emulator,
            requests: requests.expect("it is a pipe"),
            answers: answers.expect("it is a pipe"),
            messages,
            limit,
            inbox: Inbox::new(),
            outbox: [0; MAX_MESSAGE],
        })
    }

    /// Sets up a planner. Returns the ticks of the chip's clock in a second.
    pub(super) fn set_up(&mut self, request: &Request<'_>) -> Result<u64, ChipError> {
        let robot = self.robot;
        match self.ask(request)? {
            Welcome::Ready(Hello {
                version: VERSION,
                clock_hz,
            }) => Ok(clock_hz.into()),
            Welcome::Ready(Hello { version, .. }) => Err(ChipError::Dialogue {
                robot,
                problem: format!("version {version} instead of {VERSION}"),
            }),
            Welcome::Refused(problem) => Err(ChipError::Extent { robot, problem }),
            Welcome::Grounded(problem) => Err(ChipError::Grounded { robot, problem }),
            Welcome::NotHosted => Err(ChipError::NotHosted { robot }),
        }
    }

    /// Sends a request and waits for the answer.
    pub(super) fn ask<'a, T: Deserialize<'a>>(
        &'a mut self,
        request: &impl Serialize,
    ) -> Result<T, ChipError> {
        if let Err(error) = self.send(request).map_err(ReadError::Stream) {
            return Err(self.explain(error));
        }
        let (answers, limit) = (&mut self.answers, self.limit);
        if let Err(error) = self.inbox.read(|place| read_within(answers, limit, place)) {
            return Err(self.explain(error));
        }
        let robot = self.robot;
        bridge::decode(self.inbox.message()).map_err(|problem| ChipError::Dialogue {
            robot,
            problem: problem.to_string(),
        })
    }

    fn send(&mut self, request: &impl Serialize) -> io::Result<()> {
        let bytes = bridge::encode(request, &mut self.outbox).map_err(io::Error::other)?;
        self.requests.write_all(bytes)
    }

    /// Lets the image end by itself; `request` asks for that.
    pub(super) fn end(mut self, request: &impl Serialize) -> Result<(), ChipError> {
        let ended = self.send(request).and_then(|()| self.emulator.wait());
        match ended {
            Ok(status) if status.success() => Ok(()),
            _ => Err(self.explain(ReadError::Closed)),
        }
    }

    /// Why there is no answer.
    fn explain(&mut self, error: ReadError<io::Error>) -> ChipError {
        let robot = self.robot;
        match error {
            ReadError::Stream(error) if error.kind() == io::ErrorKind::TimedOut => {
                // The state that it is in shows in nothing but its messages.
                let _ = self.emulator.kill();
                ChipError::Silent {
                    robot,
                    seconds: self.limit.as_secs(),
                    messages: self.messages(),
                }
            }
            ReadError::Stream(problem) if problem.kind() != io::ErrorKind::BrokenPipe => {
                ChipError::System { robot, problem }
            }
            ReadError::Length(..) => ChipError::Dialogue {
                robot,
                problem: error.to_string(),
            },
            ReadError::Stream(_) | ReadError::Closed => match self.emulator.wait() {
                Err(problem) => ChipError::System { robot, problem },
                Ok(status) => ChipError::Ended {
                    robot,
                    status,
                    messages: self.messages(),
                },
            },
        }
    }

    fn messages(&mut self) -> String {
        let mut text = Vec::new();
        let read = self
            .messages
            .rewind()
            .and_then(|()| self.messages.read_to_end(&mut text));
        match read {
            Ok(_) => String::from_utf8_lossy(&text).into_owned(),
            Err(problem) => format!("(its messages cannot be read: {problem})"),
        }
    }
}

impl Drop for Chip {
    fn drop(&mut self) {
        // It has ended already, or is of no use any more.
        let _ = self.emulator.kill();
        let _ = self.emulator.wait();
    }
}

/// Reads what there is, and waits for it no longer than `limit`.
fn read_within(answers: &mut ChildStdout, limit: Duration, place: &mut [u8]) -> io::Result<usize> {
    let limit = Timespec::try_from(limit).map_err(io::Error::other)?;
    let ready = poll(&mut [PollFd::new(answers, PollFlags::IN)], Some(&limit))?;
    if ready == 0 {
        return Err(io::ErrorKind::TimedOut.into());
    }
    answers.read(place)
}
