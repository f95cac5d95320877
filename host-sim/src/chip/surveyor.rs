//! The planner of a flying robot on a chip, as the survey sees it.

use std::mem::discriminant;

use bridge::{
    LOOK, PatchRecord, Request, SurveyAnswer, SurveyReply, SurveyRequest, SurveyorConfig,
    frame_hash, patches_hash, surface_hash,
};
use planner_core::radio::{FrameError, MAX_LEN};
use planner_core::surface::{Column, Patch};
use planner_core::survey::{Knowledge, Pilot, Surveyor};
use planner_core::{Action, Cell, Motion, Point, RobotId, Status, Wait};

use super::dialogue::Dialogue;
use super::swarm::Swarm;
use crate::measured::Call;

/// Passes each verb on to the chip, and the chip's answer back, as a
/// [`Proxy`](super::proxy::Proxy) does.
pub(super) struct SurveyProxy<const T: usize> {
    dialogue: Dialogue,
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
        swarm: &Swarm,
        knowledge: Knowledge<T, T>,
        planner: SurveyorConfig,
        id: RobotId,
    ) -> Self {
        let request = Request::Survey {
            planner,
            id,
            extent: knowledge.surface().extent(),
        };
        let mirror = Mirror(knowledge);
        Self {
            dialogue: swarm.start(id, Ok(request)),
            status: mirror.status(),
            mirror,
            waiting: None,
            work: 0,
        }
    }

    /// Sends a request. `None` after a failure.
    fn ask(&mut self, call: Option<Call>, request: &SurveyRequest<'_>) -> Option<SurveyReply> {
        let answer: SurveyAnswer = self.dialogue.ask(call, request)?;
        self.status = answer.state;
        Some(answer.reply)
    }

    /// Sends a request whose answer the mirror knows.
    fn tell(&mut self, call: Option<Call>, request: &SurveyRequest<'_>, expected: SurveyReply) {
        match self.ask(call, request) {
            None => {}
            Some(reply) if reply == expected => {}
            Some(reply) if discriminant(&reply) == discriminant(&expected) => {
                self.dialogue.other_map();
            }
            Some(_) => self.dialogue.misunderstood(request),
        }
    }
}

impl<const T: usize> Drop for SurveyProxy<T> {
    fn drop(&mut self) {
        let memory = match self.ask(None, &SurveyRequest::Memory) {
            Some(SurveyReply::Memory(memory)) => Some(memory),
            _ => None,
        };
        self.dialogue.close(memory, &SurveyRequest::End);
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
            self.tell(None, &SurveyRequest::Look(columns), SurveyReply::Done);
        }
        let told = SurveyReply::Told(patches_hash(&self.mirror.0));
        self.tell(Some(Call::Observe), &SurveyRequest::Observe(at), told);
    }

    fn hear(&mut self, id: RobotId, status: Status<Point, Cell>) {
        self.mirror.hear(id, status);
        let request = SurveyRequest::Hear(id, status);
        self.tell(Some(Call::Hear), &request, SurveyReply::Done);
    }

    fn merge(&mut self, patch: &Patch) {
        self.mirror.merge(patch);
        let mut heights = [0; 64];
        let request = SurveyRequest::Merge(PatchRecord::of(patch, &mut heights));
        self.tell(Some(Call::Join), &request, SurveyReply::Done);
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
            self.dialogue.misunderstood(&SurveyRequest::Tick);
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
        if here != [gain, reward].map(f32::to_bits) || map != surface_hash(known.surface()) {
            self.dialogue.other_map();
        }
        action
    }

    fn waiting(&self) -> Option<Wait> {
        self.waiting
    }

    fn resume(&mut self) {
        self.mirror.resume();
        self.tell(None, &SurveyRequest::Resume, SurveyReply::Done);
    }

    fn report(&mut self, motion: Motion, at: Point) {
        self.mirror.report(motion, at);
        let request = SurveyRequest::Report(motion, at);
        self.tell(Some(Call::Report), &request, SurveyReply::Done);
    }

    fn transmit(&mut self, buffer: &mut [u8; MAX_LEN]) -> Option<usize> {
        let length = self.mirror.transmit(buffer);
        let sent = length
            .and_then(|length| buffer.get(..length))
            .map(frame_hash);
        let sent = SurveyReply::Sent(sent);
        self.tell(Some(Call::Transmit), &SurveyRequest::Transmit, sent);
        length
    }

    fn receive(&mut self, bytes: &[u8]) -> Result<u32, FrameError> {
        let heard = self.mirror.receive(bytes);
        let request = SurveyRequest::Receive(bytes);
        self.tell(Some(Call::Receive), &request, SurveyReply::Heard(heard));
        heard
    }

    fn status(&self) -> Status<Point, Cell> {
        self.status
    }

    fn work(&self) -> u32 {
        self.work
    }
}
