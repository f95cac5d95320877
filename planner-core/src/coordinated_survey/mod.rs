//! A fleet that surveys a surface faster than FCAO: pockets first, then a local
//! choice by CAO's cubic, then frontiers shared out among the robots.
//!
//! FCAO loses its time where robots fly to the same frontier, and at the end, where
//! they return for small holes left behind. Here each robot announces where it goes;
//! it closes a *pocket*, a hole in known surface, as soon as it is the nearest to it;
//! and its local model is fitted not only to the past but to probes of the map ahead.
//! Every decision looks at a bounded neighbourhood, the tile counts, and at most
//! [`MAX_PEERS`](crate::radio::MAX_PEERS) robots.
//!
//! # Why it ends
//! Pockets, swaths and frontiers are heuristics, and what others say of themselves bends
//! them: a robot that hears of rivals everywhere leaves everything to them. But all
//! three serve only as long as something is gained: after [`Limits::patience`] steps in a
//! row without it, or a few near a goal, the recovery decides, which heeds nobody's claims.
//! The few are forgotten with the next gain too. So the proof in `survey/recovery.rs`
//! holds here, with its case 1.

mod frontier;
mod pocket;
mod swath;
mod vicinity;

use crate::cao::History;
use crate::cell::{Cell, Extent};
use crate::point::Point;
use crate::radio::LinkConfig;
use crate::rng::Rng;
use crate::robot::{Action, RobotId};
use crate::survey::{Knowledge, Limits, Mission, Pilot, Recovery, SetupError};
use crate::tile::TileIndex;
use frontier::SHORTLIST;
use heapless::Vec;

/// Measurements that the local model remembers.
const HISTORY: usize = 8;

/// Height over ground at which a robot flies, as a share of its range: half of its swath
/// is lost at its edges if it flies higher.
const CRUISE: f32 = 0.36;

/// How a robot chooses among random local steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Choice {
    /// Each candidate is judged on the map: the faster survey in small fleets.
    #[default]
    Map,
    /// Eight probes are judged on the map, and CAO's cubic through them and the past
    /// judges the candidates: less work.
    Cubic,
}

/// Length of flights without gain near a goal after which the robot looks over its edges,
/// in ranges.
const NEAR_PATIENCE: f32 = 1.5;

/// What a fleet agrees on.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Config {
    /// The fleet's physics.
    pub limits: Limits,
    /// How the robots use the radio.
    pub link: LinkConfig,
    /// Seed of the fleet's random headings.
    pub seed: u64,
    /// How the local step is chosen.
    pub choice: Choice,
    /// What the robots are sent out with.
    pub mission: Mission,
}

/// The planner of one robot, over a map of `TW`×`TH` tiles.
#[derive(Clone, Debug)]
pub struct CoordinatedSurvey<const TW: usize, const TH: usize> {
    config: Config,
    knowledge: Knowledge<TW, TH>,
    rng: Rng,
    history: History<HISTORY>,
    recovery: Recovery<TW, TH>,
    /// The best tiles with frontiers of the last time, and where the look at all of
    /// them in turn stands.
    shortlist: Vec<TileIndex, SHORTLIST>,
    turn: TileIndex,
    /// Steps near a goal since the last gain.
    stuck: u16,
    /// Whether the last step was a local one.
    local: bool,
}

impl<const TW: usize, const TH: usize> CoordinatedSurvey<TW, TH> {
    /// A robot without a map; a `static` of it costs no flash. Call
    /// [`reset`](Self::reset) before use.
    pub const fn vacant() -> Self {
        Self {
            config: Config {
                limits: Limits::NONE,
                link: LinkConfig::vacant(),
                seed: 0,
                choice: Choice::Map,
                mission: Mission::NONE,
            },
            knowledge: Knowledge::vacant(),
            rng: Rng::vacant(),
            history: History::new(),
            recovery: Recovery::vacant(),
            shortlist: Vec::new(),
            turn: TileIndex { x: 0, y: 0 },
            stuck: 0,
            local: false,
        }
    }

    /// Robot `id` of a fleet over a surface of `extent` columns.
    pub fn new(config: Config, id: RobotId, extent: Extent) -> Result<Self, SetupError> {
        let mut robot = Self::vacant();
        robot.reset(config, id, extent)?;
        Ok(robot)
    }

    /// Starts anew, in place; unchanged after an error.
    pub fn reset(&mut self, config: Config, id: RobotId, extent: Extent) -> Result<(), SetupError> {
        self.knowledge
            .reset(extent, config.limits, config.link, id)?;
        self.knowledge.set_mission(config.mission);
        self.config = config;
        self.rng = Rng::new(config.seed, u64::from(id.0));
        self.history = History::new();
        self.recovery.reset();
        self.shortlist.clear();
        self.turn = TileIndex { x: 0, y: 0 };
        self.stuck = 0;
        self.local = false;
        Ok(())
    }

    /// Height over ground at which the robot flies.
    fn cruise(&self) -> f32 {
        self.config.limits.cruise(CRUISE)
    }

    /// Whether the robot has been near its goal for a while and gained nothing: it
    /// hides, behind an edge or on a tower.
    fn is_stuck(&mut self, gain: f32) -> bool {
        let Limits { range, .. } = self.config.limits;
        let here = self.knowledge.position();
        let near = self
            .knowledge
            .goal()
            .is_none_or(|goal| here.plan_distance(Point::over(goal, 0.0)) < 0.5 * range);
        if gain > 0.0 {
            self.stuck = 0;
        } else if near {
            self.stuck = self.stuck.saturating_add(1);
        }
        self.stuck >= self.config.limits.steps_of(NEAR_PATIENCE * range, 2, 3_600)
    }

    /// Towards `goal`, or further into the unknown if `beyond`.
    fn fly_to(&mut self, goal: Option<Cell>, beyond: bool) -> Option<Action<Point>> {
        self.knowledge.set_goal(goal);
        self.knowledge.count_work(29);
        let goal = Point::over(goal?, 0.0);
        let place = if beyond { self.beyond(goal) } else { goal };
        self.knowledge
            .step_towards(place, self.cruise())
            .map(Action::Move)
    }

    /// Any allowed flight of one step: the way out of a place where flights are
    /// refused.
    fn sidestep(&mut self) -> Action<Point> {
        for _ in 0..16 {
            let heading = self.rng.angle();
            let to = self
                .knowledge
                .step_along(heading, self.config.limits.step, self.cruise());
            if self.knowledge.may_fly(to) {
                return Action::Move(to);
            }
        }
        Action::Wait
    }
}

impl<const TW: usize, const TH: usize> Pilot<TW, TH> for CoordinatedSurvey<TW, TH> {
    fn knowledge(&self) -> &Knowledge<TW, TH> {
        &self.knowledge
    }

    fn knowledge_mut(&mut self) -> &mut Knowledge<TW, TH> {
        &mut self.knowledge
    }

    fn fly_home(&mut self) -> Option<Action<Point>> {
        Some(self.recovery.fly_home(&mut self.knowledge))
    }

    fn decide(&mut self) -> Action<Point> {
        let gain = self.knowledge.gain();
        self.history
            .push(self.knowledge.position(), self.knowledge.reward());
        let needs_recovery = self.knowledge.idle() >= self.config.limits.patience();
        if self.knowledge.is_blocked() && (!needs_recovery || self.recovery.steps_aside()) {
            self.knowledge.take_refused();
            return self.sidestep();
        }
        if self.is_stuck(gain) || needs_recovery {
            return self.recovery.tick(&mut self.knowledge);
        }
        if let Some(pocket) = self.nearest_pocket()
            && let Some(action) = self.fly_to(Some(pocket), gain > 0.0)
        {
            return action;
        }
        if let Some(to) = self.best_swath(gain) {
            self.knowledge.set_goal(None);
            return Action::Move(to);
        }
        let frontier = self.own_frontier();
        self.fly_to(frontier, true).unwrap_or(Action::Wait)
    }
}
