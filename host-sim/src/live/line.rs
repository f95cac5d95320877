//! One end of a conversation in lines, in which nobody can hold the other up: a line has
//! a deadline as a whole and a greatest length.

use std::io::{self, Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

use serde::Serialize;
use serde::de::DeserializeOwned;
use thiserror::Error;

use crate::excerpt::excerpt;

/// Bytes of the longest line that is heard: many times the longest that is said.
const LONGEST: usize = 64 << 10;

/// Bytes heard at a time.
const CHUNK: usize = 4096;

/// What is wrong with the other end.
#[derive(Debug, Error)]
#[allow(missing_docs)] // each variant's message is its documentation
pub enum LineError {
    #[error("went away")]
    Gone,
    #[error("said nothing for {} s", .0.as_secs())]
    Silent(Duration),
    #[error("did not end its line within {} s", .0.as_secs())]
    Slow(Duration),
    #[error("did not listen for {} s", .0.as_secs())]
    Deaf(Duration),
    #[error("said a line of more than {LONGEST} bytes")]
    TooLong,
    #[error("said `{0}`, which has no meaning here")]
    Nonsense(String),
    #[error("cannot be reached any more: {0}")]
    Io(io::Error),
}

impl LineError {
    fn of(error: io::Error) -> Self {
        use io::ErrorKind::{BrokenPipe, ConnectionAborted, ConnectionReset};
        match error.kind() {
            BrokenPipe | ConnectionAborted | ConnectionReset => Self::Gone,
            _ => Self::Io(error),
        }
    }
}

/// Whether to try again later.
fn is_later(error: &io::Error) -> bool {
    use io::ErrorKind::{Interrupted, TimedOut, WouldBlock};
    matches!(error.kind(), Interrupted | TimedOut | WouldBlock)
}

/// What is left until then, never nothing: a socket takes that for no limit.
fn left_until(then: Instant) -> Duration {
    let left = then.saturating_duration_since(Instant::now());
    left.max(Duration::from_millis(1))
}

/// One end of a conversation: one JSON value a line.
#[derive(Debug)]
pub(super) struct Line {
    stream: TcpStream,
    /// What was heard and not taken yet.
    heard: Vec<u8>,
    /// So many bytes of it hold no end of a line.
    searched: usize,
}

impl Line {
    pub(super) fn new(stream: TcpStream) -> io::Result<Self> {
        stream.set_nonblocking(false)?;
        stream.set_nodelay(true)?;
        Ok(Self {
            stream,
            heard: Vec::new(),
            searched: 0,
        })
    }

    /// Says something within `limit`.
    pub(super) fn say(
        &mut self,
        message: &impl Serialize,
        limit: Duration,
    ) -> Result<(), LineError> {
        let mut text =
            serde_json::to_string(message).map_err(|error| LineError::Io(error.into()))?;
        text.push('\n');
        let (until, mut rest) = (Instant::now() + limit, text.as_bytes());
        while !rest.is_empty() {
            let left = Some(left_until(until));
            self.stream.set_write_timeout(left).map_err(LineError::of)?;
            match self.stream.write(rest) {
                Ok(0) => return Err(LineError::Gone),
                Ok(written) => rest = rest.get(written..).unwrap_or_default(),
                Err(error) if is_later(&error) => {}
                Err(error) => return Err(LineError::of(error)),
            }
            if !rest.is_empty() && Instant::now() >= until {
                return Err(LineError::Deaf(limit));
            }
        }
        Ok(())
    }

    /// The next message, if it has come within `limit` of `since`.
    pub(super) fn hear<M: DeserializeOwned>(
        &mut self,
        since: Instant,
        limit: Duration,
    ) -> Result<M, LineError> {
        let until = since + limit;
        loop {
            if let Some(text) = self.next()? {
                return parse(&text);
            }
            let left = Some(left_until(until));
            self.stream.set_read_timeout(left).map_err(LineError::of)?;
            let is_new = self.read()?;
            if !is_new && Instant::now() >= until {
                return Err(match self.heard.is_empty() {
                    true => LineError::Silent(limit),
                    false => LineError::Slow(limit),
                });
            }
            // Whoever says something all the time says too long a line.
        }
    }

    /// The next message, if it has come.
    pub(super) fn poll<M: DeserializeOwned>(&mut self) -> Result<Option<M>, LineError> {
        self.stream.set_nonblocking(true).map_err(LineError::of)?;
        let text = loop {
            match self.next() {
                Ok(None) => {}
                other => break other,
            }
            match self.read() {
                Ok(true) => {}
                Ok(false) => break Ok(None),
                Err(error) => break Err(error),
            }
        };
        self.stream.set_nonblocking(false).map_err(LineError::of)?;
        text?.map(|text| parse(&text)).transpose()
    }

    /// Whether the other end is gone and everything that it said was taken.
    pub(super) fn is_closed(&self) -> bool {
        let peek = || {
            self.stream.set_nonblocking(true)?;
            let found = self.stream.peek(&mut [0]);
            self.stream.set_nonblocking(false)?;
            found
        };
        self.heard.is_empty()
            && match peek() {
                Ok(found) => found == 0,
                Err(error) => !is_later(&error),
            }
    }

    /// Takes in what has come; says whether that is anything.
    fn read(&mut self) -> Result<bool, LineError> {
        let mut chunk = [0; CHUNK];
        match self.stream.read(&mut chunk) {
            Ok(0) => Err(LineError::Gone),
            Ok(length) => {
                self.heard.extend(chunk.iter().take(length));
                Ok(true)
            }
            Err(error) if is_later(&error) => Ok(false),
            Err(error) => Err(LineError::of(error)),
        }
    }

    /// Takes the next whole line.
    fn next(&mut self) -> Result<Option<Vec<u8>>, LineError> {
        let new = self.heard.iter().skip(self.searched);
        match new.copied().position(|byte| byte == b'\n') {
            Some(end) if self.searched + end <= LONGEST => {
                let line = self.heard.drain(..=self.searched + end).collect();
                self.searched = 0;
                Ok(Some(line))
            }
            None if self.heard.len() <= LONGEST => {
                self.searched = self.heard.len();
                Ok(None)
            }
            _ => Err(LineError::TooLong),
        }
    }
}

fn parse<M: DeserializeOwned>(line: &[u8]) -> Result<M, LineError> {
    serde_json::from_slice(line)
        .map_err(|_| LineError::Nonsense(excerpt(String::from_utf8_lossy(line).trim_end())))
}

#[cfg(test)]
mod tests {
    use std::net::TcpListener;

    use super::*;

    const SOON: Duration = Duration::from_millis(200);

    fn pair() -> (Line, TcpStream) {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let other = TcpStream::connect(listener.local_addr().unwrap()).unwrap();
        (Line::new(listener.accept().unwrap().0).unwrap(), other)
    }

    fn hear(line: &mut Line) -> Result<u32, String> {
        line.hear(Instant::now(), SOON)
            .map_err(|error| error.to_string())
    }

    #[test]
    fn lines_are_taken_one_by_one_however_they_come() {
        let (mut line, mut other) = pair();
        other.write_all(b"1\n2\n").unwrap();
        assert_eq!(hear(&mut line), Ok(1));
        assert_eq!(line.poll::<u32>().unwrap(), Some(2));
        assert_eq!(line.poll::<u32>().unwrap(), None);
        other.write_all(b"34").unwrap();
        assert_eq!(
            hear(&mut line),
            Err("did not end its line within 0 s".into())
        );
        other.write_all(b"5\n6\n").unwrap();
        drop(other);
        assert_eq!(hear(&mut line), Ok(345));
        assert!(!line.is_closed());
        assert_eq!(hear(&mut line), Ok(6));
        assert!(line.is_closed());
        assert_eq!(hear(&mut line), Err("went away".into()));
    }

    #[test]
    fn nobody_is_waited_for_beyond_the_deadline() {
        let (mut line, mut other) = pair();
        let began = Instant::now();
        assert_eq!(hear(&mut line), Err("said nothing for 0 s".into()));
        // A byte now and then does not put the deadline off.
        let drip = std::thread::spawn(move || {
            for _ in 0..20 {
                let _ = other.write_all(b"x");
                std::thread::sleep(Duration::from_millis(50));
            }
            other
        });
        assert_eq!(
            hear(&mut line),
            Err("did not end its line within 0 s".into())
        );
        assert!(began.elapsed() < Duration::from_millis(900));
        let _other = drip.join().unwrap();
        // Nor is one who does not listen.
        let began = Instant::now();
        let long = "x".repeat(1 << 20);
        let said = (0..64).try_for_each(|_| line.say(&long, SOON));
        assert!(matches!(said, Err(LineError::Deaf(_))), "{said:?}");
        assert!(began.elapsed() < Duration::from_secs(20));
    }

    #[test]
    fn long_lines_and_nonsense_are_named() {
        let (mut line, mut other) = pair();
        other.write_all("\u{1b}[2J\n".as_bytes()).unwrap();
        let error = hear(&mut line).unwrap_err();
        assert_eq!(error, r"said `\u{1b}[2J`, which has no meaning here");
        let flood = std::thread::spawn(move || {
            // Ends when nobody listens any more.
            for _ in 0..1000 {
                if other.write_all(&[b'1'; 10_000]).is_err() {
                    return;
                }
            }
        });
        let error = hear(&mut line).unwrap_err();
        assert_eq!(error, "said a line of more than 65536 bytes");
        drop(line);
        flood.join().unwrap();
    }
}
