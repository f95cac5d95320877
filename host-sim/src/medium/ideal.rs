//! The medium of the papers: whole maps, at once, without a frame.

use std::sync::Arc;

use planner_core::{Map, RobotId, Status, TileSet};

use super::air::Air;
use super::{Fate, Medium, Message};
use crate::robot::Robot;
use crate::scenario::{AirFaults, Conditions, Faults, Reach};
use crate::world::World;

/// Every living robot hands its whole map and its status to every other; all
/// speak at the same moment, and the air decides who misses whom.
///
/// Only tiles that the receiver may lack are joined, which gives the same maps
/// as joining all of them. Where everybody hears everybody, all know the same after an
/// exchange, and one map in common stands for what all say.
pub struct Ideal<const TW: usize, const TH: usize> {
    air: Air<World>,
    /// Ticks between two exchanges; 0: never.
    sync: u32,
    /// Whether all who live hear all others every time.
    is_whole: bool,
    /// What all knew together at the last exchange.
    common: Option<Box<Map<TW, TH>>>,
    voices: Vec<Voice<TW, TH>>,
    /// Tiles of robot `s` that robot `r` may lack, at `r · robots + s`.
    pending: Vec<TileSet<TH>>,
}

/// What one robot says.
struct Voice<const TW: usize, const TH: usize> {
    id: RobotId,
    /// `None` if it is dead.
    status: Option<Status>,
    /// Its map as of this exchange: what it hears meanwhile is not passed on.
    map: Box<Map<TW, TH>>,
    /// Tiles that it learnt from others when it last listened.
    heard: TileSet<TH>,
}

impl<const TW: usize, const TH: usize> Ideal<TW, TH> {
    pub(super) fn new(conditions: &Conditions, world: Arc<World>) -> Self {
        Self {
            air: Air::new(conditions, world),
            sync: conditions.sync,
            is_whole: is_whole(conditions),
            common: None,
            voices: Vec::new(),
            pending: Vec::new(),
        }
    }

    /// All tell all others what they know.
    fn pool(&mut self, robots: &mut [Robot<TW, TH>]) {
        let Some(first) = robots.first() else { return };
        let common = self.common.get_or_insert_with(|| vacant(first));
        let mut changed = TileSet::new();
        let mut told: Vec<(RobotId, Status)> = Vec::with_capacity(robots.len());
        for robot in robots.iter_mut().filter(|robot| robot.alive) {
            let own = robot.planner.take_changed();
            common.join_tiles(robot.planner.map(), &own);
            changed.extend(&own);
            told.push((robot.id, robot.planner.status()));
        }
        for robot in robots.iter_mut().filter(|robot| robot.alive) {
            robot.planner.join(common, &changed);
            for &(id, status) in told.iter().filter(|(id, _)| *id != robot.id) {
                self.air.note(id, robot.id, Fate::Heard);
                robot.planner.hear(id, status);
            }
            // What was heard need not be passed on: all know it.
            robot.planner.take_changed();
        }
    }

    fn speak(&mut self, robots: &mut [Robot<TW, TH>]) {
        if self.voices.is_empty() {
            self.voices = robots.iter().map(Voice::silent).collect();
            self.pending = vec![TileSet::new(); robots.len() * robots.len()];
        }
        let count = robots.len();
        for (speaker, (robot, voice)) in robots.iter_mut().zip(&mut self.voices).enumerate() {
            voice.status = robot.alive.then(|| robot.planner.status());
            if robot.alive {
                let changed = robot.planner.take_changed();
                voice.heard.extend(&changed);
                voice.map.join_tiles(robot.planner.map(), &voice.heard);
                for row in self.pending.chunks_exact_mut(count) {
                    row[speaker].extend(&changed);
                }
            }
        }
    }

    fn listen(&mut self, tick: u32, robots: &mut [Robot<TW, TH>]) {
        let rows = self.pending.chunks_exact_mut(robots.len());
        for (robot, row) in robots.iter_mut().zip(rows) {
            if !robot.alive {
                continue;
            }
            for (voice, pending) in self.voices.iter().zip(row) {
                let to = (robot.id, robot.position);
                if let Some(status) = voice.status
                    && voice.id != robot.id
                    && self.air.carries(tick, (voice.id, status.position), to)
                {
                    self.air.note(voice.id, robot.id, Fate::Heard);
                    robot.planner.join(&voice.map, pending);
                    robot.planner.hear(voice.id, status);
                    pending.clear();
                }
            }
        }
    }

    /// What was heard has to be passed on next time, unless all know it by now.
    fn settle(&mut self, robots: &mut [Robot<TW, TH>]) {
        let mut heard = TileSet::new();
        for (robot, voice) in robots.iter_mut().zip(&mut self.voices) {
            if robot.alive {
                voice.heard = robot.planner.take_changed();
                heard.extend(&voice.heard);
            }
        }
        let maps: Vec<&Map<TW, TH>> = robots
            .iter()
            .filter(|robot| robot.alive)
            .map(|robot| robot.planner.map())
            .collect();
        for tile in heard.iter() {
            if maps
                .windows(2)
                .all(|pair| pair[0].tile(tile) == pair[1].tile(tile))
            {
                continue;
            }
            for row in self.pending.chunks_exact_mut(robots.len()) {
                for (voice, pending) in self.voices.iter().zip(row) {
                    if voice.heard.contains(tile) {
                        pending.insert(tile);
                    }
                }
            }
        }
    }
}

impl<const TW: usize, const TH: usize> Medium<TW, TH> for Ideal<TW, TH> {
    fn listen(&mut self) {
        self.air.listen();
    }

    fn messages(&self) -> &[Message] {
        self.air.messages()
    }

    fn exchange(&mut self, tick: u32, robots: &mut [Robot<TW, TH>]) {
        self.air.clear();
        if self.sync != 0 && tick.is_multiple_of(self.sync) {
            if self.is_whole {
                self.pool(robots);
                return;
            }
            self.speak(robots);
            self.listen(tick, robots);
            self.settle(robots);
        }
    }
}

impl<const TW: usize, const TH: usize> Voice<TW, TH> {
    fn silent(robot: &Robot<TW, TH>) -> Self {
        Self {
            id: robot.id,
            status: None,
            map: vacant(robot),
            heard: TileSet::new(),
        }
    }
}

/// An empty map of a robot's world.
fn vacant<const TW: usize, const TH: usize>(robot: &Robot<TW, TH>) -> Box<Map<TW, TH>> {
    let mut map = Box::new(Map::vacant());
    map.reset(robot.planner.map().extent())
        .expect("a map of the same size holds the same extent");
    map
}

/// Whether no message is lost, nobody comes late or begins anew, and no two robots can
/// believe opposites of one cell: then it is the same whether what others know comes at
/// once or piece by piece.
fn is_whole(conditions: &Conditions) -> bool {
    let AirFaults {
        reach, partitions, ..
    } = &conditions.air;
    let faults = Faults {
        deaths: Vec::new(),
        ..conditions.faults.clone()
    };
    conditions.loss == 0.0
        && *reach == Reach::Everywhere
        && partitions.is_empty()
        && conditions.trouble.is_none()
        && faults == Faults::default()
}
