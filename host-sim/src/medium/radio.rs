//! The radio: everything that one robot learns from another is in a frame.

use std::cell::OnceCell;
use std::rc::Rc;
use std::sync::Arc;

use planner_core::radio::MAX_LEN;

use super::air::Air;
use super::forger::Desk;
use super::{Fate, Medium, Message, Space, Station};
use crate::robot::Robot;
use crate::scenario::Conditions;
use crate::world::World;

/// Every robot broadcasts as many frames as its planner's budget allows; the air
/// decides who receives which, when, how often and in what state.
pub struct Radio<W: Space> {
    pub(crate) air: Air<W>,
    /// Ticks between two transmissions of a robot; 0: never.
    sync: u32,
    /// Frames on their way, those sent first first.
    flights: Vec<Flight<W::Read>>,
    forger: Option<Desk>,
}

/// One copy of a frame on its way to one robot.
struct Flight<R> {
    due: u32,
    from: usize,
    to: usize,
    frame: Rc<Carried<R>>,
}

/// What all who hear a frame share.
struct Carried<R> {
    bytes: Vec<u8>,
    /// By the first who hears it.
    read: OnceCell<R>,
}

impl<W: Space> Radio<W> {
    pub(crate) fn new(conditions: &Conditions, world: Arc<W>) -> Self {
        let forger = conditions.air.forger;
        Self {
            air: Air::new(conditions, world),
            sync: conditions.sync,
            flights: Vec::new(),
            forger: forger.map(|forger| Desk::new(forger, conditions.seed)),
        }
    }

    /// Whether robots speak in `tick`.
    pub(crate) fn is_open(&self, tick: u32) -> bool {
        self.sync != 0 && tick.is_multiple_of(self.sync)
    }

    /// A robot sends what its budget allows, at most so many frames.
    pub(crate) fn transmit<S: Station<Place = W::Place, Read = W::Read>>(
        &mut self,
        tick: u32,
        robots: &mut [S],
        speaker: usize,
        most: usize,
    ) {
        if !robots[speaker].is_awake() || !self.is_open(tick) {
            return;
        }
        let mut buffer = [0; MAX_LEN];
        for _ in 0..most {
            let Some(length) = robots[speaker].transmit(&mut buffer) else {
                break;
            };
            let from = (robots[speaker].id(), robots[speaker].place());
            let carried = |bytes| {
                Rc::new(Carried {
                    bytes,
                    read: OnceCell::new(),
                })
            };
            let whole = carried(buffer[..length].to_vec());
            for (to, listener) in robots.iter().enumerate().filter(|(to, _)| *to != speaker) {
                let listener = (listener.id(), listener.place());
                if self.air.carries(tick, from, listener) {
                    for _ in 0..self.air.copies() {
                        let late = self.air.delay();
                        let frame = match self.air.corrupted(&whole.bytes) {
                            None => whole.clone(),
                            Some(bytes) => carried(bytes),
                        };
                        self.flights.push(Flight {
                            due: tick.saturating_add(late),
                            from: speaker,
                            to,
                            frame,
                        });
                    }
                }
            }
        }
    }

    /// Robots hear what is due in `tick`.
    pub(crate) fn deliver<S: Station<Place = W::Place, Read = W::Read>>(
        &mut self,
        tick: u32,
        robots: &mut [S],
    ) {
        for flight in self.flights.extract_if(.., |flight| flight.due <= tick) {
            if robots[flight.to].is_awake() {
                let from = robots[flight.from].id();
                let listener = &mut robots[flight.to];
                self.air.note(from, listener.id(), Fate::Heard);
                let Carried { bytes, read } = &*flight.frame;
                listener.receive(bytes, read.get_or_init(|| listener.read(bytes)));
            }
        }
    }

    /// Robots hear what is forged for them in `tick`.
    pub(crate) fn forge<S: Station>(&mut self, tick: u32, robots: &mut [S]) {
        if let Some(forger) = &mut self.forger {
            forger.forge(tick, robots);
        }
    }
}

impl<const TW: usize, const TH: usize> Medium<TW, TH> for Radio<World> {
    fn listen(&mut self) {
        self.air.listen();
    }

    fn messages(&self) -> &[Message] {
        self.air.messages()
    }

    fn exchange(&mut self, tick: u32, robots: &mut [Robot<TW, TH>]) {
        self.air.clear();
        for speaker in 0..robots.len() {
            self.transmit(tick, robots, speaker, usize::MAX);
        }
        self.deliver(tick, robots);
        for flight in &self.flights {
            let (from, to) = (robots[flight.from].id, robots[flight.to].id);
            self.air.note(from, to, Fate::UnderWay);
        }
        self.forge(tick, robots);
    }
}
