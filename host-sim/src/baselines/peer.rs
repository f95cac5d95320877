//! A robot that walks to the frontier that a rule assigns to it.

use planner_core::map::Level;
use planner_core::radio::{Frame, FrameError, Heard, Hearsay, Link, LinkConfig, MAX_LEN};
use planner_core::sight::line_of_sight;
use planner_core::tile::{TileIndex, bits};
use planner_core::{
    Action, Activity, Cell, Contact, Errands, Extent, ExtentError, Inspect, Learnt, LongSight, Map,
    Motion, Persist, Planner, RobotId, Sighting, Status, Stop, TileSet,
};

use super::waves::{Spot, Waves};

/// Which frontier a robot goes to.
pub trait Rule {
    /// How long an assignment lasts.
    fn term(&self) -> Term;

    /// The frontier cell for the robot [`Waves::me`]. The waves are at distance
    /// 0; its own must have reached the answer. `None` if it can reach none.
    fn assign(&mut self, waves: &mut Waves, team: &[(RobotId, Cell)]) -> Option<Spot>;
}

/// How long an assignment lasts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Term {
    /// Moves until the next one.
    pub moves: u32,
    /// Whether it also ends when its goal is no frontier any more.
    pub until_resolved: bool,
}

impl Term {
    /// d_max = 2 [Gauville2019 §5.1].
    pub const PAPER: Self = Self {
        moves: 2,
        until_resolved: false,
    };
    /// A fresh decision in every tick.
    pub const EVERY_MOVE: Self = Self {
        moves: 1,
        until_resolved: true,
    };
}

/// Steps of the way that are tried for a waypoint, as the explorer does.
const LONGEST: usize = 64;

/// Ticks for which a cell that could not be entered is taken for closed.
const CLOSED_TICKS: u32 = 8;

/// Blocked steps after the last new cell until the robot gives up.
const PATIENCE: u32 = 1000;

/// A planner that follows a [`Rule`].
pub struct Peer<const TW: usize, const TH: usize> {
    rule: Box<dyn Rule>,
    id: RobotId,
    map: Box<Map<TW, TH>>,
    link: Link<TH>,
    position: Cell,
    /// The farthest that it has seen, in cells.
    reach: u8,
    /// By id, as last heard.
    others: Vec<Option<Status>>,
    waves: Waves,
    team: Vec<(RobotId, Cell)>,
    goal: Option<Cell>,
    /// The cells to the goal, the last one first.
    way: Vec<Cell>,
    /// Moves since the assignment.
    moves: u32,
    clock: u32,
    /// Cells that could not be entered, and when to try them again.
    closed: Vec<(Cell, u32)>,
    blocked_steps: u32,
    stopped: Option<Stop>,
    /// Whether the last pose lay off the grid.
    is_astray: bool,
    /// Steps to the goal that this tick assigned.
    assignment: Option<u32>,
    work: u32,
}

impl<const TW: usize, const TH: usize> Peer<TW, TH> {
    /// Robot `id` at `start` on a grid of `extent`, with this use of the radio.
    ///
    /// # Errors
    /// A grid that a map of this size does not hold.
    pub fn new(
        rule: Box<dyn Rule>,
        id: RobotId,
        extent: Extent,
        start: Cell,
        config: LinkConfig,
    ) -> Result<Self, ExtentError> {
        let mut map = Box::new(Map::vacant());
        map.reset_with(extent, start)?;
        let mut link = Link::vacant();
        link.reset(config, id, extent);
        Ok(Self {
            rule,
            id,
            map,
            link,
            position: start,
            reach: 0,
            others: Vec::new(),
            waves: Waves::default(),
            team: Vec::new(),
            goal: None,
            way: Vec::new(),
            moves: 0,
            clock: 0,
            closed: Vec::new(),
            blocked_steps: 0,
            stopped: None,
            is_astray: false,
            assignment: None,
            work: 0,
        })
    }

    /// Whether the assignment holds and its next cell is beside the robot and can be entered.
    fn has_way(&self) -> bool {
        let is_resolved = || !self.goal.is_some_and(|goal| self.map.is_frontier(goal));
        let term = self.rule.term();
        let has_ended = self.moves >= term.moves || term.until_resolved && is_resolved();
        let is_beside = |next: Cell| self.position.direction_to(next).is_some();
        let can_be_entered = |&next: &Cell| is_beside(next) && self.map.is_free(next);
        !has_ended && self.way.last().is_some_and(can_be_entered)
    }

    fn assign(&mut self) {
        self.goal = None;
        self.way.clear();
        self.moves = 0;
        if self.map.frontiers() == 0 {
            return;
        }
        self.team.clear();
        let walking = |status: &Status| status.activity != Activity::Stopped;
        for (status, id) in self.others.iter().zip(0..=u8::MAX) {
            if let Some(status) = status.filter(walking) {
                self.team.push((RobotId(id), status.position));
            }
        }
        let place = self.team.partition_point(|&(id, _)| id < self.id);
        self.team.insert(place, (self.id, self.position));
        let closed = self.closed.iter().map(|&(cell, _)| cell);
        let me = (self.id, self.reach);
        self.waves.start(&self.map, closed, me, &self.team);
        if let Some(goal) = self.rule.assign(&mut self.waves, &self.team) {
            self.goal = Some(self.waves.cell(goal));
            self.waves.way(self.position, goal, &mut self.way);
            self.assignment = Some(self.way.len() as u32);
        }
        self.work = self.waves.visits();
    }

    /// Without a way to any frontier: wait, or stop for good.
    fn rest(&mut self) -> Action {
        let frontiers = self.map.frontiers();
        let stop = match self.closed.last() {
            _ if frontiers == 0 => Stop::nothing_left(self.map.free_edge_cells()),
            None => Stop::Enclosed { frontiers },
            Some(&(at, _)) if self.blocked_steps > PATIENCE => Stop::Blocked { frontiers, at },
            Some(_) => return Action::Wait,
        };
        self.stopped = Some(stop);
        Action::Stop(stop)
    }

    fn learn(&mut self, learnt: Learnt) -> Learnt {
        if learnt.anything() {
            self.blocked_steps = 0;
        }
        learnt
    }
}

impl<const TW: usize, const TH: usize> Planner<TW, TH> for Peer<TW, TH> {
    fn observe(&mut self, sighting: &Sighting) -> Learnt {
        self.is_astray = !self.map.extent().contains(sighting.centre());
        if self.is_astray {
            return Learnt::default();
        }
        let on_way = self.way.iter().rposition(|&cell| cell == sighting.centre());
        if let Some(left) = on_way {
            // It came there in its own way, and goes on from there.
            self.moves += (self.way.len() - left) as u32;
            self.way.truncate(left);
        }
        self.position = sighting.centre();
        let seen = sighting.free_cells().chain(sighting.blocked_cells());
        let farthest = seen.map(|cell| cell.distance_squared(self.position)).max();
        self.reach = self.reach.max(farthest.unwrap_or(0).isqrt() as u8);
        self.map.stand(self.position);
        let learnt = self.map.observe(sighting);
        if let Some((at, _)) = TileIndex::of(sighting.centre()) {
            self.link.look(sighting, at, 0);
        }
        self.link.announce(&mut self.map);
        self.learn(learnt)
    }

    fn tick(&mut self) -> Action {
        self.work = 0;
        self.assignment = None;
        self.link.tick();
        if let Some(stop) = self.stopped {
            return Action::Stop(stop);
        }
        if self.is_astray {
            return Action::Wait;
        }
        self.clock += 1;
        let now = self.clock;
        self.closed.retain(|&(_, until)| until > now);
        if !self.has_way() {
            self.assign();
        }
        let next = self.way.last();
        match next.and_then(|&next| self.position.direction_to(next)) {
            Some(direction) => Action::Move(direction),
            None => self.rest(),
        }
    }

    fn waypoint(&self) -> Option<Cell> {
        let is_closed = |cell| !self.map.is_free(cell);
        let ahead = self.way.iter().rev().take(LONGEST).rev();
        let mut farthest_first = ahead.copied();
        farthest_first.find(|&cell| line_of_sight(self.position, cell, is_closed))
    }

    fn resume(&mut self) {
        self.stopped = None;
        self.closed.clear();
        self.blocked_steps = 0;
        self.way.clear();
    }

    fn report(&mut self, motion: Motion) {
        let Some(next) = self.way.pop() else { return };
        match motion {
            Motion::Moved => {
                self.position = next;
                self.moves += 1;
            }
            Motion::Blocked => {
                self.closed.push((next, self.clock + CLOSED_TICKS));
                self.blocked_steps += 1;
                self.way.clear();
            }
            Motion::Held => self.way.push(next),
        }
    }

    fn transmit(&mut self, buffer: &mut [u8; MAX_LEN]) -> Option<usize> {
        let status = self.status();
        self.link.transmit(&self.map, status, buffer)
    }

    fn receive(&mut self, bytes: &[u8]) -> Result<Heard, FrameError> {
        let read = self.link.read(bytes, self.map.extent());
        self.receive_read(bytes, &read)
    }

    fn map(&self) -> &Map<TW, TH> {
        &self.map
    }

    fn status(&self) -> Status {
        let activity = match self.stopped {
            Some(_) => Activity::Stopped,
            None => Activity::Exploring,
        };
        Status {
            position: self.position,
            goal: self.goal,
            activity,
        }
    }

    fn hearsay(&self) -> Hearsay {
        self.link.hearsay()
    }
}

impl<const TW: usize, const TH: usize> LongSight<TW, TH> for Peer<TW, TH> {
    fn observe_far(&mut self, at: TileIndex, free: u64, blocked: u64) -> Learnt {
        if self.is_astray {
            return Learnt::default();
        }
        let seen = bits(free | blocked).map(|bit| at.cell(bit).distance_squared(self.position));
        let farthest = seen.max().unwrap_or(0).isqrt();
        self.reach = self.reach.max(farthest as u8);
        let learnt = self.map.observe_far(at, free, blocked, Level::Wall);
        self.link.announce(&mut self.map);
        self.learn(learnt)
    }
}

impl<const TW: usize, const TH: usize> Contact<TW, TH> for Peer<TW, TH> {
    fn take_changed(&mut self) -> TileSet<TH> {
        self.link.take_changed(&mut self.map)
    }

    fn join(&mut self, other: &Map<TW, TH>, tiles: &TileSet<TH>) -> Learnt {
        let learnt = self.map.join_tiles(other, tiles);
        self.link.joined(learnt);
        self.learn(learnt)
    }

    fn read(&self, bytes: &[u8]) -> Option<Result<Frame, FrameError>> {
        Some(self.link.read(bytes, self.map.extent()))
    }

    fn receive_read(
        &mut self,
        bytes: &[u8],
        read: &Result<Frame, FrameError>,
    ) -> Result<Heard, FrameError> {
        let heard = self.link.receive_read(bytes, read, &mut self.map)?;
        self.learn(heard.learnt);
        if let Some(status) = heard.status {
            self.hear(heard.from, status);
        }
        Ok(heard)
    }

    fn hear(&mut self, id: RobotId, status: Status) {
        let index = usize::from(id.0);
        if self.others.len() <= index {
            self.others.resize(index + 1, None);
        }
        self.others[index] = Some(status);
    }
}

impl<const TW: usize, const TH: usize> Errands<TW, TH> for Peer<TW, TH> {}

impl<const TW: usize, const TH: usize> Persist<TW, TH> for Peer<TW, TH> {}

impl<const TW: usize, const TH: usize> Inspect<TW, TH> for Peer<TW, TH> {
    fn work(&self) -> u32 {
        self.work
    }

    fn assignment(&self) -> Option<u32> {
        self.assignment
    }
}
