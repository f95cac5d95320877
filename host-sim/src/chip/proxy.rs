//! The planner on a chip, as the fleet sees it.

use bridge::{Answer, Reply, Request, STAGED, State, grid_hash};
use planner_core::map::Tile;
use planner_core::radio::{
    Frame, FrameError, GridId, Heard, Hearsay, LinkConfig, MAX_LEN, TileRecord,
};
use planner_core::role::Role;
use planner_core::tile::TileIndex;
use planner_core::{
    Action, Activity, Contact, Errands, Inspect, Learnt, LongSight, Map, Motion, Persist, Planner,
    RobotId, Sighting, Status, TileSet, Wait,
};

use super::dialogue::Dialogue;
use super::error::ChipError;
use super::swarm::Swarm;
use crate::measured::Call;
use crate::planners::{PlannerKind, Setup};

/// Passes each verb on to the chip, and the chip's answer back. Without answers it says
/// nothing and stands still.
pub(super) struct Proxy<const TW: usize, const TH: usize> {
    dialogue: Dialogue,
    grid: GridId,
    /// What the chip's map holds too.
    map: Map<TW, TH>,
    state: State,
}

/// Takes what a reply of one kind holds.
macro_rules! held_by {
    ($kind:ident) => {
        |reply| match reply {
            Reply::$kind(value) => Some(value),
            _ => None,
        }
    };
}

impl<const TW: usize, const TH: usize> Proxy<TW, TH> {
    pub(super) fn new(swarm: &Swarm, kind: PlannerKind, setup: Setup) -> Self {
        let Setup {
            id, extent, start, ..
        } = setup;
        let mut map = Map::vacant();
        map.reset(extent)
            .expect("the compiled size holds the world");
        let planner = kind.on_chip(setup);
        let link = planner.map_or(LinkConfig::new(), |planner| *planner.link());
        let request = planner.map(|planner| Request::Start {
            planner,
            id,
            extent,
            start,
        });
        let request = request.ok_or(ChipError::HostOnly(kind));
        Self {
            dialogue: swarm.start(id, request),
            grid: GridId::of(extent, link.origin_mm, link.cell_mm),
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
        }
    }

    /// Sends a request; `read` takes what is wanted out of the reply. `None` after
    /// a failure.
    fn ask<T>(
        &mut self,
        call: Option<Call>,
        request: &Request<'_>,
        read: impl FnOnce(Reply) -> Option<T>,
    ) -> Option<T> {
        let answer: Answer<State, Reply> = self.dialogue.ask(call, request)?;
        self.state = answer.state;
        // Where the robot stands shows in no message but this one.
        let TileRecord { at, tile } = self.state.here;
        self.map.join_tile(at, tile);
        let position = self.state.status.position;
        if TileIndex::of(position).is_some_and(|(of, bit)| of == at && tile.visited() & bit != 0) {
            self.map.stand(position);
        }
        let value = read(answer.reply);
        if value.is_none() {
            self.dialogue.misunderstood(request);
        }
        value
    }

    fn tell(&mut self, call: Option<Call>, request: &Request<'_>) {
        self.ask(call, request, |reply| {
            matches!(reply, Reply::Done).then_some(())
        });
    }
}

impl<const TW: usize, const TH: usize> Drop for Proxy<TW, TH> {
    fn drop(&mut self) {
        let memory = self.ask(None, &Request::Memory, held_by!(Memory));
        self.dialogue.close(memory, &Request::End);
    }
}

impl<const TW: usize, const TH: usize> Planner<TW, TH> for Proxy<TW, TH> {
    fn observe(&mut self, sighting: &Sighting) -> Learnt {
        self.map.observe(sighting);
        let request = Request::Observe(sighting.clone());
        self.ask(Some(Call::Observe), &request, held_by!(Learnt))
            .unwrap_or_default()
    }

    fn tick(&mut self) -> Action {
        let action = self.ask(Some(Call::Tick), &Request::Tick, held_by!(Action));
        if self.dialogue.is_open() && self.state.map != grid_hash(&self.map) {
            self.dialogue.other_map();
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
        let call = Some(Call::Transmit);
        let frame = self.ask(call, &Request::Transmit, held_by!(Frame))??;
        buffer.get_mut(..frame.len())?.copy_from_slice(&frame);
        Some(frame.len())
    }

    fn receive(&mut self, bytes: &[u8]) -> Result<Heard, FrameError> {
        let call = Some(Call::Receive);
        let heard = self.ask(call, &Request::Receive(bytes), held_by!(Heard));
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
        let call = Some(Call::TakeChanged);
        let rows = self.ask(call, &Request::TakeChanged, held_by!(Changed));
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
        self.ask(Some(Call::Join), &Request::Join, held_by!(Learnt))
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

impl<const TW: usize, const TH: usize> Errands<TW, TH> for Proxy<TW, TH> {}

impl<const TW: usize, const TH: usize> Persist<TW, TH> for Proxy<TW, TH> {}

impl<const TW: usize, const TH: usize> LongSight<TW, TH> for Proxy<TW, TH> {}

impl<const TW: usize, const TH: usize> Inspect<TW, TH> for Proxy<TW, TH> {
    fn work(&self) -> u32 {
        self.state.work
    }
}
