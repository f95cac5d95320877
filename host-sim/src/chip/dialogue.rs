//! The dialogue with one chip, until it fails.

use std::fmt::Debug;
use std::rc::Rc;

use bridge::{Answer, Memory, Request};
use planner_core::RobotId;
use serde::Serialize;
use serde::de::DeserializeOwned;

use super::book::Book;
use super::emulator::Chip;
use super::error::ChipError;
use crate::measured::Call;

/// A chip that fails leaves the reason in the book; from then on there are no answers,
/// until the run ends for that reason.
pub(super) struct Dialogue {
    robot: RobotId,
    /// `None` when it has failed.
    chip: Option<Chip>,
    book: Rc<Book>,
    clock_hz: u64,
}

impl Dialogue {
    /// Begins with the request that sets up a planner, if there is one.
    pub(super) fn open(
        robot: RobotId,
        chip: Result<Chip, ChipError>,
        book: Rc<Book>,
        request: Result<Request<'_>, ChipError>,
    ) -> Self {
        let mut dialogue = Self {
            robot,
            chip: None,
            book,
            clock_hz: 1,
        };
        let opened = chip.and_then(|mut chip| Ok((chip.set_up(&request?)?, chip)));
        match opened {
            Ok((clock_hz, chip)) => {
                dialogue.clock_hz = clock_hz;
                dialogue.chip = Some(chip);
            }
            Err(failure) => dialogue.fail(failure),
        }
        dialogue
    }

    /// Whether there are answers.
    pub(super) fn is_open(&self) -> bool {
        self.chip.is_some()
    }

    /// Sends a request, and counts the call that it asks for. `None` after a failure.
    pub(super) fn ask<S, R>(
        &mut self,
        call: Option<Call>,
        request: &impl Serialize,
    ) -> Option<Answer<S, R>>
    where
        Answer<S, R>: DeserializeOwned,
    {
        let answer: Result<Answer<S, R>, _> = self.chip.as_mut()?.ask(request);
        match answer {
            Ok(answer) => {
                if let Some(call) = call {
                    self.book.count(call, answer.cost, self.clock_hz);
                }
                Some(answer)
            }
            Err(failure) => {
                self.fail(failure);
                None
            }
        }
    }

    /// The chip's map is not what it was told.
    pub(super) fn other_map(&mut self) {
        let robot = self.robot;
        self.fail(ChipError::OtherMap { robot });
    }

    /// The answer to `request` answers something else.
    pub(super) fn misunderstood(&mut self, request: &impl Debug) {
        self.fail(ChipError::Dialogue {
            robot: self.robot,
            problem: format!("an answer to something else than {request:?}"),
        });
    }

    /// Notes what the chip takes, and lets it end.
    pub(super) fn close(&mut self, memory: Option<Memory>, end: &impl Serialize) {
        if let Some(memory) = memory {
            self.book.measured.borrow_mut().weigh(&memory);
        }
        if let Some(Err(failure)) = self.chip.take().map(|chip| chip.end(end)) {
            self.fail(failure);
        }
    }

    fn fail(&mut self, failure: ChipError) {
        self.chip = None;
        // The first failure is the cause of the others.
        let _ = self.book.failure.set(failure);
    }
}
