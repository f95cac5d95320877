//! The radio: everything that one robot learns from another is in a frame.

use planner_core::RobotId;
use planner_core::radio::MAX_LEN;

use super::air::Air;
use super::forger::Desk;
use super::{Fate, Medium, Message};
use crate::fleet::Robot;
use crate::scenario::Conditions;

/// Every robot broadcasts as many frames as its planner's budget allows; the air
/// decides who receives which, when, how often and in what state.
pub struct Radio {
    air: Air,
    /// Ticks between two transmissions of a robot; 0: never.
    sync: u32,
    /// Frames on their way, those sent first first.
    flights: Vec<Flight>,
    forger: Option<Desk>,
}

/// One copy of a frame on its way to one robot.
struct Flight {
    due: u32,
    from: RobotId,
    to: RobotId,
    bytes: Vec<u8>,
}

impl Radio {
    pub(super) fn new(air: Air, conditions: &Conditions) -> Self {
        let forger = conditions.air.forger;
        Self {
            air,
            sync: conditions.sync,
            flights: Vec::new(),
            forger: forger.map(|forger| Desk::new(forger, conditions.seed)),
        }
    }

    fn speak<const TW: usize, const TH: usize>(&mut self, tick: u32, robots: &mut [Robot<TW, TH>]) {
        for speaker in 0..robots.len() {
            if !robots[speaker].alive {
                continue;
            }
            let mut buffer = [0; MAX_LEN];
            while let Some(length) = robots[speaker].planner.transmit(&mut buffer) {
                let frame = &buffer[..length];
                let robot = &mut robots[speaker];
                robot.sent.frames += 1;
                robot.sent.bytes += length as u32;
                let from = (robot.id, robot.position);
                for listener in robots.iter().filter(|other| other.id != from.0) {
                    if self
                        .air
                        .carries(tick, from, (listener.id, listener.position))
                    {
                        for (late, bytes) in self.air.copies(frame) {
                            self.flights.push(Flight {
                                due: tick.saturating_add(late),
                                from: from.0,
                                to: listener.id,
                                bytes,
                            });
                        }
                    }
                }
            }
        }
    }

    fn deliver<const TW: usize, const TH: usize>(
        &mut self,
        tick: u32,
        robots: &mut [Robot<TW, TH>],
    ) {
        for flight in self.flights.extract_if(.., |flight| flight.due <= tick) {
            let listener = &mut robots[usize::from(flight.to.0)];
            if listener.alive {
                self.air.note(flight.from, flight.to, Fate::Heard);
                // What is wrong with a frame is for the planner to find.
                let _ = listener.planner.receive(&flight.bytes);
            }
        }
        for flight in &self.flights {
            self.air.note(flight.from, flight.to, Fate::UnderWay);
        }
    }
}

impl<const TW: usize, const TH: usize> Medium<TW, TH> for Radio {
    fn listen(&mut self) {
        self.air.listen();
    }

    fn messages(&self) -> &[Message] {
        self.air.messages()
    }

    fn exchange(&mut self, tick: u32, robots: &mut [Robot<TW, TH>]) {
        self.air.clear();
        if self.sync != 0 && tick.is_multiple_of(self.sync) {
            self.speak(tick, robots);
        }
        self.deliver(tick, robots);
        if let Some(forger) = &mut self.forger {
            forger.forge(tick, robots);
        }
    }
}
