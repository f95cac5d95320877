//! The planner on a chip, as the fleet sees it.

use std::rc::Rc;

use bridge::{Answer, Reply, Request, STAGED, State, fingerprint};
use planner_core::map::Tile;
use planner_core::radio::{Frame, FrameError, GridId, Heard, Hearsay, MAX_LEN, TileRecord};
use planner_core::role::Role;
use planner_core::tile::TileIndex;
use planner_core::{
    Action, Activity, Contact, Inspect, Learnt, Map, Motion, Planner, RobotId, Sighting, Status,
    TileSet, Wait,
};

use super::emulator::Chip;
use super::error::ChipError;
use super::swarm::Book;
use crate::measured::Call;
use crate::planners::{PlannerKind, Setup};

/// Passes each verb on to the chip, and the chip's answer back.
///
/// A chip that fails leaves the reason in the book; from then on the proxy says
/// nothing and stands still, until the run ends for that reason.
pub(super) struct Proxy<const TW: usize, const TH: usize> {
    id: RobotId,
    /// `None` when it has failed.
    chip: Option<Chip>,
    book: Rc<Book>,
    clock_hz: u64,
    grid: GridId,
    /// What the chip's map holds too.
    map: Map<TW, TH>,
    state: State,
}

impl<const TW: usize, const TH: usize> Proxy<TW, TH> {
    pub(super) fn new(
        chip: Result<Chip, ChipError>,
        book: Rc<Book>,
        kind: PlannerKind,
        setup: Setup,
    ) -> Self {
        let Setup {
            id, extent, start, ..
        } = setup;
        let mut map = Map::vacant();
        map.reset(extent)
            .expect("the compiled size holds the world");
        let mut proxy = Self {
            id,
            chip: None,
            book,
            clock_hz: 1,
            grid: GridId(0),
            map,
            state: State {
                status: Status {
                    position: start,
                    goal: None,
                    activity: Activity::Exploring,
                },
                work: 0,
                map: 0,
                here: TileRecord {
                    at: TileIndex::new(0, 0),
                    tile: Tile::UNKNOWN,
                },
                role: None,
                waiting: None,
                hearsay: Hearsay::default(),
            },
        };
        match chip.and_then(|chip| proxy.start(chip, kind, setup)) {
            Ok(chip) => proxy.chip = Some(chip),
            Err(failure) => proxy.fail(failure),
        }
        proxy
    }

    fn start(
        &mut self,
        mut chip: Chip,
        kind: PlannerKind,
        setup: Setup,
    ) -> Result<Chip, ChipError> {
        let Setup { extent, start, .. } = setup;
        let planner = kind.on_chip(setup).ok_or(ChipError::HostOnly(kind))?;
        let link = planner.link();
        self.grid = GridId::of(extent, link.origin_mm, link.cell_mm);
        self.clock_hz = chip.set_up(&Request::Start {
            planner,
            id: self.id,
            extent,
            start,
        })?;
        Ok(chip)
    }

    fn fail(&mut self, failure: ChipError) {
        self.chip = None;
        // The first failure is the cause of the others.
        let _ = self.book.failure.set(failure);
    }

    /// Sends a request; `read` takes what is wanted out of the reply. `None` after
    /// a failure.
    fn ask<T>(
        &mut self,
        call: Option<Call>,
        request: &Request<'_>,
        read: impl FnOnce(Reply<'_>) -> Option<T>,
    ) -> Option<T> {
        let chip = self.chip.as_mut()?;
        let answer = match chip.ask::<Answer<'_>>(request) {
            Ok(answer) => answer,
            Err(failure) => {
                self.fail(failure);
                return None;
            }
        };
        if let Some(call) = call {
            self.book.count(call, answer.cost, self.clock_hz);
        }
        self.state = answer.state;
        // Where the robot stands shows in no message but this one.
        let TileRecord { at, tile } = self.state.here;
        self.map.join_tile(at, tile);
        let position = self.state.status.position;
        if TileIndex::of(position).is_some_and(|(of, bit)| of == at && tile.visited & bit != 0) {
            self.map.stand(position);
        }
        let value = read(answer.reply);
        if value.is_none() {
            self.fail(ChipError::Dialogue {
                robot: self.id,
                problem: format!("an answer to something else than {request:?}"),
            });
        }
        value
    }

    fn tell(&mut self, call: Option<Call>, request: &Request<'_>) {
        self.ask(call, request, |reply| {
            matches!(reply, Reply::Done).then_some(())
        });
    }

    /// Lets the chip say what it takes, and end.
    fn finish(&mut self) {
        let read = |reply: Reply<'_>| match reply {
            Reply::Memory(memory) => Some(memory),
            _ => None,
        };
        if let Some(memory) = self.ask(None, &Request::Memory, read) {
            self.book.measured.borrow_mut().weigh(&memory);
        }
        if let Some(Err(failure)) = self.chip.take().map(|chip| chip.end(&Request::End)) {
            self.fail(failure);
        }
    }
}

impl<const TW: usize, const TH: usize> Drop for Proxy<TW, TH> {
    fn drop(&mut self) {
        self.finish();
    }
}

fn learnt(reply: Reply<'_>) -> Option<Learnt> {
    match reply {
        Reply::Learnt(learnt) => Some(learnt),
        _ => None,
    }
}

impl<const TW: usize, const TH: usize> Planner<TW, TH> for Proxy<TW, TH> {
    fn observe(&mut self, sighting: &Sighting) -> Learnt {
        self.map.observe(sighting);
        let request = Request::Observe(sighting.clone());
        self.ask(Some(Call::Observe), &request, learnt)
            .unwrap_or_default()
    }

    fn tick(&mut self) -> Action {
        let action = self.ask(Some(Call::Tick), &Request::Tick, |reply| match reply {
            Reply::Action(action) => Some(action),
            _ => None,
        });
        if self.chip.is_some() && self.state.map != fingerprint(&self.map) {
            self.fail(ChipError::OtherMap { robot: self.id });
        }
        action.unwrap_or(Action::Wait)
    }

    fn waiting(&self) -> Option<Wait> {
        self.state.waiting
    }

    fn resume(&mut self) {
        self.tell(None, &Request::Resume);
    }

    fn report(&mut self, motion: Motion) {
        self.tell(Some(Call::Report), &Request::Report(motion));
    }

    fn transmit(&mut self, buffer: &mut [u8; MAX_LEN]) -> Option<usize> {
        self.ask(
            Some(Call::Transmit),
            &Request::Transmit,
            |reply| match reply {
                Reply::Frame(None) => Some(None),
                Reply::Frame(Some(frame)) => {
                    buffer.get_mut(..frame.len())?.copy_from_slice(frame);
                    Some(Some(frame.len()))
                }
                _ => None,
            },
        )
        .flatten()
    }

    fn receive(&mut self, bytes: &[u8]) -> Result<Heard, FrameError> {
        let heard = self.ask(
            Some(Call::Receive),
            &Request::Receive(bytes),
            |reply| match reply {
                Reply::Heard(heard) => Some(heard),
                _ => None,
            },
        );
        let heard = heard.unwrap_or(Err(FrameError::Length(0)))?;
        for record in Frame::decode(bytes, None, self.grid, self.map.extent())?.tiles {
            self.map.join_tile(record.at, record.tile);
        }
        Ok(heard)
    }

    fn map(&self) -> &Map<TW, TH> {
        &self.map
    }

    fn status(&self) -> Status {
        self.state.status
    }

    fn hearsay(&self) -> Hearsay {
        self.state.hearsay
    }
}

impl<const TW: usize, const TH: usize> Contact<TW, TH> for Proxy<TW, TH> {
    fn take_changed(&mut self) -> TileSet<TH> {
        let request = Request::TakeChanged;
        let rows = self.ask(Some(Call::TakeChanged), &request, |reply| match reply {
            Reply::Changed(rows) => Some(rows),
            _ => None,
        });
        let mut changed = TileSet::new();
        for (&row, y) in rows.iter().flatten().zip(0u8..) {
            for x in planner_core::tile::bits(row) {
                changed.insert(TileIndex::new(x as u8, y));
            }
        }
        changed
    }

    fn join(&mut self, other: &Map<TW, TH>, tiles: &TileSet<TH>) -> Learnt {
        if tiles.is_empty() {
            return Learnt::default();
        }
        let records = tiles.iter().map(|at| TileRecord {
            at,
            tile: other.tile(at),
        });
        for records in records.collect::<Vec<_>>().chunks(STAGED) {
            let records = records.iter().copied().collect();
            self.tell(None, &Request::Stage(records));
        }
        self.map.join_tiles(other, tiles);
        self.ask(Some(Call::Join), &Request::Join, learnt)
            .unwrap_or_default()
    }

    fn hear(&mut self, id: RobotId, status: Status) {
        self.tell(Some(Call::Hear), &Request::Hear(id, status));
    }

    fn role(&self) -> Option<Role> {
        self.state.role
    }

    fn adopt(&mut self, role: Role) {
        self.tell(Some(Call::Adopt), &Request::Adopt(role));
    }
}

impl<const TW: usize, const TH: usize> Inspect<TW, TH> for Proxy<TW, TH> {
    fn work(&self) -> u32 {
        self.state.work
    }
}
