//! A radio that carries bytes from each robot to all others: a transparent modem.
//!
//! It knows no frames. They are told apart by a zero, which COBS keeps out of them; what the
//! air garbles the planner refuses by its check bytes.
#![allow(dead_code, reason = "who has no modem uses Silence alone")]

use embedded_hal_nb::serial::Write;
use heapless::Vec;
use heapless::spsc::{Consumer, Producer, Queue};
use planner_core::radio::MAX_LEN;

/// A frame of the planner.
pub(crate) type Frame = Vec<u8, MAX_LEN>;

/// Frames that were heard and that the planner has not read: those of 16 robots that send
/// one a tick. When it is full the newest is dropped, as if the air had lost it.
pub(crate) type Frames = Queue<Frame, 17>;

/// Bytes of a frame in COBS, without the zero that ends it.
const MAX_CODED: usize = MAX_LEN + 1;

/// What the main loop needs of a radio.
pub(crate) trait Radio {
    /// The next frame that was heard.
    fn receive(&mut self) -> Option<Frame>;

    /// Sends a frame. One that is lost is told again.
    fn send(&mut self, frame: &[u8]);
}

/// No radio.
pub(crate) struct Silence;

impl Radio for Silence {
    fn receive(&mut self) -> Option<Frame> {
        None
    }

    fn send(&mut self, _: &[u8]) {}
}

/// The end of the interrupt: bytes come in.
pub(crate) struct Receiver {
    frames: Producer<'static, Frame>,
    coded: Vec<u8, MAX_CODED>,
}

impl Receiver {
    pub(crate) fn new(frames: Producer<'static, Frame>) -> Self {
        Self {
            frames,
            coded: Vec::new(),
        }
    }

    /// Takes in a byte. Short: at most one frame is decoded.
    pub(crate) fn take(&mut self, byte: u8) {
        if byte != 0 {
            // What is longer than a frame is none: it ends with the next zero.
            let _ = self.coded.push(byte);
            return;
        }
        let mut frame = [0; MAX_CODED];
        if let Ok(length) = cobs::decode(&self.coded, &mut frame)
            && let Some(bytes) = frame.get(..length)
            && let Ok(frame) = Frame::from_slice(bytes)
        {
            let _ = self.frames.enqueue(frame);
        }
        self.coded.clear();
    }
}

/// The end of the main loop.
pub(crate) struct Modem<W> {
    pub(crate) frames: Consumer<'static, Frame>,
    pub(crate) sender: W,
}

impl<W: Write<u8>> Radio for Modem<W> {
    fn receive(&mut self) -> Option<Frame> {
        self.frames.dequeue()
    }

    fn send(&mut self, frame: &[u8]) {
        let coded = encode(frame);
        for &byte in coded.iter().chain(&[0]) {
            if nb::block!(self.sender.write(byte)).is_err() {
                defmt::debug!("a frame is lost");
            }
        }
    }
}

/// A frame in COBS.
pub(crate) fn encode(frame: &[u8]) -> Vec<u8, MAX_CODED> {
    let mut coded = [0; MAX_CODED];
    let length = match frame.len() {
        ..=MAX_LEN => cobs::encode(frame, &mut coded),
        _ => 0,
    };
    let coded = coded.get(..length).unwrap_or(&[]);
    Vec::from_slice(coded).unwrap_or_default()
}
