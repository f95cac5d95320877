//! The planner of a flying robot on a chip, as the survey sees it.

use std::rc::Rc;

use bridge::{
    LOOK, PatchRecord, Request, SurveyAnswer, SurveyReply, SurveyRequest, SurveyorConfig, imprint,
    relief, told,
};
use planner_core::radio::{FrameError, MAX_LEN};
use planner_core::surface::{Column, Patch};
use planner_core::survey::{Knowledge, Pilot, Surveyor};
use planner_core::{Action, Cell, Extent, Motion, Point, RobotId, Status, Wait};

use super::emulator::Chip;
use super::error::ChipError;
use super::swarm::Book;
use crate::measured::Call;

/// Passes each verb on to the chip, and the chip's answer back.
///
/// A chip that fails leaves the reason in the book, as for a
/// [`Proxy`](super::proxy::Proxy).
pub(super) struct SurveyProxy<const T: usize> {
    id: RobotId,
    /// `None` when it has failed.
    chip: Option<Chip>,
    book: Rc<Book>,
    clock_hz: u64,
    /// What the chip knows too.
    mirror: Mirror<T>,
    /// What the chip said last of itself.
    status: Status<Point, Cell>,
    waiting: Option<Wait>,
    work: u32,
}

/// What one robot knows, and no decisions.
struct Mirror<const T: usize>(Knowledge<T, T>);

impl<const T: usize> Pilot<T, T> for Mirror<T> {
    fn knowledge(&self) -> &Knowledge<T, T> {
        &self.0
    }

    fn knowledge_mut(&mut self) -> &mut Knowledge<T, T> {
        &mut self.0
    }

    fn decide(&mut self) -> Action<Point> {
        Action::Wait
    }
}

impl<const T: usize> SurveyProxy<T> {
    pub(super) fn new(
        chip: Result<Chip, ChipError>,
        book: Rc<Book>,
        knowledge: Knowledge<T, T>,
        planner: SurveyorConfig,
        id: RobotId,
    ) -> Self {
        let extent = knowledge.surface().extent();
        let mirror = Mirror(knowledge);
        let mut proxy = Self {
            id,
            chip: None,
            book,
            clock_hz: 1,
            status: mirror.status(),
            mirror,
            waiting: None,
            work: 0,
        };
        match chip.and_then(|chip| proxy.start(chip, planner, extent)) {
            Ok(chip) => proxy.chip = Some(chip),
            Err(failure) => proxy.fail(failure),
        }
        proxy
    }

    fn start(
        &mut self,
        mut chip: Chip,
        planner: SurveyorConfig,
        extent: Extent,
    ) -> Result<Chip, ChipError> {
        self.clock_hz = chip.set_up(&Request::Survey {
            planner,
            id: self.id,
            extent,
        })?;
        Ok(chip)
    }

    fn fail(&mut self, failure: ChipError) {
        self.chip = None;
        // The first failure is the cause of the others.
        let _ = self.book.failure.set(failure);
    }

    /// Sends a request. `None` after a failure.
    fn ask(&mut self, call: Option<Call>, request: &SurveyRequest<'_>) -> Option<SurveyReply> {
        let chip = self.chip.as_mut()?;
        let answer: SurveyAnswer = match chip.ask(request) {
            Ok(answer) => answer,
            Err(failure) => {
                self.fail(failure);
                return None;
            }
        };
        if let Some(call) = call {
            self.book.count(call, answer.cost, self.clock_hz);
        }
        self.status = answer.status;
        Some(answer.reply)
    }

    fn tell(&mut self, call: Option<Call>, request: &SurveyRequest<'_>) {
        match self.ask(call, request) {
            None | Some(SurveyReply::Done) => {}
            Some(reply) => self.misunderstood(&reply),
        }
    }

    fn misunderstood(&mut self, reply: &SurveyReply) {
        self.fail(ChipError::Dialogue {
            robot: self.id,
            problem: format!("{reply:?} answers something else"),
        });
    }

    fn other_map(&mut self) {
        let robot = self.id;
        self.fail(ChipError::OtherMap { robot });
    }
}

impl<const T: usize> Drop for SurveyProxy<T> {
    /// Lets the chip say what it takes, and end.
    fn drop(&mut self) {
        match self.ask(None, &SurveyRequest::Memory) {
            None => {}
            Some(SurveyReply::Memory(memory)) => {
                self.book.measured.borrow_mut().weigh(&memory);
            }
            Some(reply) => self.misunderstood(&reply),
        }
        if let Some(chip) = self.chip.take()
            && let Err(failure) = chip.end(&SurveyRequest::End)
        {
            self.fail(failure);
        }
    }
}

impl<const T: usize> Surveyor<T, T> for SurveyProxy<T> {
    fn knowledge(&self) -> &Knowledge<T, T> {
        &self.mirror.0
    }

    fn observe(&mut self, at: Point, columns: &[Column]) {
        self.mirror.observe(at, columns);
        for columns in columns.chunks(LOOK) {
            let columns = columns.iter().copied().collect();
            self.tell(None, &SurveyRequest::Look(columns));
        }
        match self.ask(Some(Call::Observe), &SurveyRequest::Observe(at)) {
            None => {}
            Some(SurveyReply::Told(news)) if news == told(&self.mirror.0) => {}
            Some(SurveyReply::Told(_)) => self.other_map(),
            Some(reply) => self.misunderstood(&reply),
        }
    }

    fn hear(&mut self, id: RobotId, status: Status<Point, Cell>) {
        self.mirror.hear(id, status);
        self.tell(Some(Call::Hear), &SurveyRequest::Hear(id, status));
    }

    fn merge(&mut self, patch: &Patch) {
        self.mirror.merge(patch);
        let mut heights = [0; 64];
        let record = PatchRecord::of(patch, &mut heights);
        self.tell(Some(Call::Join), &SurveyRequest::Merge(record));
    }

    fn tick(&mut self) -> Action<Point> {
        self.mirror.tick();
        let reply = self.ask(Some(Call::Tick), &SurveyRequest::Tick);
        let Some(reply) = reply else {
            return Action::Wait;
        };
        let SurveyReply::Decided {
            action,
            waiting,
            work,
            gain,
            reward,
            map,
        } = reply
        else {
            self.misunderstood(&reply);
            return Action::Wait;
        };
        self.work = work;
        self.waiting = waiting;
        // What was decided goes into frames.
        self.mirror.0.set_goal(self.status.goal);
        if let Action::Stop(reason) = action {
            self.mirror.0.stop(reason);
        }
        let known = &self.mirror.0;
        let here = [known.gain(), known.reward()].map(f32::to_bits);
        if here != [gain, reward].map(f32::to_bits) || map != relief(known.surface()) {
            self.other_map();
        }
        action
    }

    fn waiting(&self) -> Option<Wait> {
        self.waiting
    }

    fn resume(&mut self) {
        self.mirror.resume();
        self.tell(None, &SurveyRequest::Resume);
    }

    fn report(&mut self, motion: Motion, at: Point) {
        self.mirror.report(motion, at);
        self.tell(Some(Call::Report), &SurveyRequest::Report(motion, at));
    }

    fn transmit(&mut self, buffer: &mut [u8; MAX_LEN]) -> Option<usize> {
        let length = self.mirror.transmit(buffer);
        let sent = length.and_then(|length| buffer.get(..length)).map(imprint);
        match self.ask(Some(Call::Transmit), &SurveyRequest::Transmit) {
            None => {}
            Some(SurveyReply::Sent(theirs)) if theirs == sent => {}
            Some(SurveyReply::Sent(_)) => self.other_map(),
            Some(reply) => self.misunderstood(&reply),
        }
        length
    }

    fn receive(&mut self, bytes: &[u8]) -> Result<u32, FrameError> {
        let heard = self.mirror.receive(bytes);
        match self.ask(Some(Call::Receive), &SurveyRequest::Receive(bytes)) {
            None => {}
            Some(SurveyReply::Heard(theirs)) if theirs == heard => {}
            Some(SurveyReply::Heard(_)) => self.other_map(),
            Some(reply) => self.misunderstood(&reply),
        }
        heard
    }

    fn status(&self) -> Status<Point, Cell> {
        self.status
    }

    fn work(&self) -> u32 {
        self.work
    }
}
