//! What robots, media and displays call: the traits of planners.

use super::Explorer;
use crate::cell::Cell;
use crate::map::{Learnt, Map};
use crate::planner::{Contact, Inspect, LongSight, Planner};
use crate::radio::{Frame, FrameError, Heard, Hearsay, MAX_LEN};
use crate::robot::{Action, Activity, Motion, RobotId, Status, Wait};
use crate::role::Role;
use crate::sight::Sighting;
use crate::tile::{TileIndex, TileSet};

impl<const TW: usize, const TH: usize> Planner<TW, TH> for Explorer<TW, TH> {
    fn observe(&mut self, sighting: &Sighting) -> Learnt {
        let centre = sighting.centre();
        let map = &self.around.map;
        let was_astray = self.is_astray;
        self.is_astray = !map.extent().contains(centre) || map.keeps_out(centre);
        if self.is_astray {
            self.log_astray(was_astray, centre);
            return Learnt::default();
        }
        let mut is_carried = false;
        if centre != self.around.position {
            is_carried = !self.follow(centre);
            self.around.position = centre;
            self.stepping = false;
            self.looks = 0;
            self.lose_way_home();
        }
        if is_carried {
            self.role.plan = None;
        }
        let was_lost = self.evidence.is_lost();
        let mut learnt = self.look_around(sighting);
        self.log_look(was_lost, learnt);
        if self.around.clearance > 0 {
            learnt += self.around.lie();
        }
        if is_carried && learnt.anything() {
            // What it stopped for was true of another place.
            self.go_on();
        }
        self.others.purse.saw(learnt.cells);
        if let Some((at, _)) = TileIndex::of(centre) {
            self.link.look(sighting, at, self.bodies(at));
        }
        self.link.announce(&mut self.around.map);
        self.learn(learnt);
        learnt
    }

    fn tick(&mut self) -> Action {
        let (had_stopped, waited) = (self.role.has_stopped(), self.waiting);
        let action = self.decide();
        self.log_decision(had_stopped, waited, action);
        action
    }

    fn waiting(&self) -> Option<Wait> {
        self.waiting.get()
    }

    fn waypoint(&self) -> Option<Cell> {
        self.straight().map(|(cell, _)| cell)
    }

    fn resume(&mut self) {
        self.go_on();
        self.around.visit_shut_places();
    }

    fn report(&mut self, motion: Motion) {
        let plan = self.role.plan.filter(|_| self.stepping);
        self.stepping = false;
        let Some(step) = plan.and_then(|plan| plan.path.first()) else {
            return;
        };
        let next = self.around.position.step(step);
        match motion {
            Motion::Moved => {
                self.around.position = next;
                self.looks = 0;
                self.role.make_step();
                self.holds = 0;
                self.budget.make_step();
            }
            Motion::Blocked => self.refuse(next, false),
            Motion::Held => {
                self.holds = self.holds.saturating_add(1);
                if self.holds >= self.config.holds {
                    self.refuse(next, true);
                }
            }
        }
    }

    fn map(&self) -> &Map<TW, TH> {
        &self.around.map
    }

    fn status(&self) -> Status {
        Status {
            position: self.around.position,
            goal: self.role.plan.map(|plan| plan.goal),
            activity: Activity::stopped_if(self.role.has_stopped() || self.has_errand()),
        }
    }

    fn transmit(&mut self, buffer: &mut [u8; MAX_LEN]) -> Option<usize> {
        let status = self.status();
        self.link.transmit(&self.around.map, status, buffer)
    }

    fn receive(&mut self, bytes: &[u8]) -> Result<Heard, FrameError> {
        let read = self.link.read(bytes, self.around.map.extent());
        self.receive_read(bytes, &read)
    }

    fn is_lost(&self) -> bool {
        self.evidence.is_lost()
    }

    fn hearsay(&self) -> Hearsay {
        self.link.hearsay()
    }
}

impl<const TW: usize, const TH: usize> LongSight<TW, TH> for Explorer<TW, TH> {
    fn observe_far(&mut self, at: TileIndex, free: u64, blocked: u64) -> Learnt {
        if self.is_astray {
            return Learnt::default();
        }
        let blocked = blocked & !self.bodies(at);
        let wall = self.config.sensor.far_wall();
        let learnt = self.around.map.observe_far(at, free, blocked, wall);
        self.others.purse.saw(learnt.cells);
        self.link.announce(&mut self.around.map);
        self.learn(learnt);
        learnt
    }
}

impl<const TW: usize, const TH: usize> Contact<TW, TH> for Explorer<TW, TH> {
    fn take_changed(&mut self) -> TileSet<TH> {
        self.link.take_changed(&mut self.around.map)
    }

    fn join(&mut self, other: &Map<TW, TH>, tiles: &TileSet<TH>) -> Learnt {
        let learnt = self.around.map.join_tiles(other, tiles);
        self.link.joined(learnt);
        self.learn_from_others(learnt)
    }

    fn read(&self, bytes: &[u8]) -> Option<Result<Frame, FrameError>> {
        Some(self.link.read(bytes, self.around.map.extent()))
    }

    fn receive_read(
        &mut self,
        bytes: &[u8],
        read: &Result<Frame, FrameError>,
    ) -> Result<Heard, FrameError> {
        let mut heard = self.link.receive_read(bytes, read, &mut self.around.map)?;
        heard.learnt = self.learn_from_others(heard.learnt);
        if let Some(status) = heard.status {
            self.hear(heard.from, status);
        }
        Ok(heard)
    }

    fn hear(&mut self, id: RobotId, status: Status) {
        if id != self.id {
            let (own, now) = (self.around.position, self.around.now);
            if self.others.hear(id, status, own, now) {
                log!(
                    debug,
                    "robot {}: hears robot {} at {}",
                    self.id.0,
                    id.0,
                    status.position
                );
            }
        }
    }

    /// None with a budget of energy: it is this body's own.
    fn role(&self) -> Option<Role> {
        (!self.budget.is_limited()).then_some(self.role)
    }

    fn adopt(&mut self, role: Role) {
        self.role = role;
        self.stepping = false;
        self.holds = 0;
        self.far.cancel();
        self.budget.doubt();
        self.go_back();
    }
}

impl<const TW: usize, const TH: usize> Inspect<TW, TH> for Explorer<TW, TH> {
    fn work(&self) -> u32 {
        self.work
    }

    fn narrow_cells(&self) -> u32 {
        self.count_narrow_cells()
    }

    fn votes(&self, cell: Cell) -> i8 {
        self.evidence.votes(cell)
    }

    fn searched(&self, at: TileIndex) -> u64 {
        self.far.searched(at)
    }
}
