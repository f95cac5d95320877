//! FCAO as published: local optimisation by CAO, and the closest frontier when that
//! is stuck [Renzaglia2019 Algorithm 1].
//!
//! The paper leaves points open: each reading taken here is named where it is applied.
//!
//! The paper's robots never stop. Here every step without gain counts, and after
//! [`Limits::patience`] of them in a row the recovery decides until something is gained: why that
//! ends, whatever refuses a flight, whatever no look shows and whatever others say, is
//! proved in `survey/recovery.rs`.

use crate::cao::{Degree, Frame, History, Model};
use crate::cell::Extent;
use crate::point::Point;
use crate::radio::LinkConfig;
use crate::rng::Rng;
use crate::robot::{Action, RobotId};
use crate::survey::{Knowledge, Limits, Mission, Pilot, Recovery, SetupError};

/// Reading: a step is a local optimum if it gains at most this share of the area
/// that a straight step newly covers, 2Rα.
const LOCAL_OPTIMUM: f32 = 0.5;

/// Reading: height of flights to a frontier, as a share of the range.
const CRUISE: f32 = 0.5;

/// Reading: ridge of the fit, per measurement.
const RIDGE: f32 = 1e-4;

/// Fewer measurements than this are not fitted.
const FEWEST: usize = 4;

/// What a fleet that runs FCAO agrees on.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Config {
    /// The fleet's physics.
    pub limits: Limits,
    /// How the robots use the radio.
    pub link: LinkConfig,
    /// Degree of the local model; cubic as published.
    pub degree: Degree,
    /// Number M of random candidates in each step.
    pub candidates: u16,
    /// Seed of the fleet's random candidates.
    pub seed: u64,
    /// What the robots are sent out with.
    pub mission: Mission,
}

impl Config {
    /// As published, with 100 candidates.
    pub const fn new(limits: Limits, seed: u64) -> Self {
        Self {
            limits,
            link: LinkConfig::new(),
            degree: Degree::Cubic,
            candidates: 100,
            seed,
            mission: Mission::NONE,
        }
    }
}

/// FCAO on one robot, over a map of `TW`×`TH` tiles, with a history of `H`
/// measurements, the current one included.
#[derive(Clone, Debug)]
pub struct Fcao<const TW: usize, const TH: usize, const H: usize = 8> {
    config: Config,
    knowledge: Knowledge<TW, TH>,
    rng: Rng,
    history: History<H>,
    recovery: Recovery<TW, TH>,
}

impl<const TW: usize, const TH: usize, const H: usize> Fcao<TW, TH, H> {
    /// A robot without a map; a `static` of it costs no flash. Call
    /// [`reset`](Self::reset) before use.
    pub const fn vacant() -> Self {
        Self {
            config: Config {
                limits: Limits::NONE,
                link: LinkConfig::vacant(),
                degree: Degree::Linear,
                candidates: 0,
                seed: 0,
                mission: Mission::NONE,
            },
            knowledge: Knowledge::vacant(),
            rng: Rng::vacant(),
            history: History::new(),
            recovery: Recovery::vacant(),
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
        Ok(())
    }

    /// Gain of a step that is too little to go on locally.
    fn least_gain(&self) -> f32 {
        LOCAL_OPTIMUM * 2.0 * self.config.limits.range * self.config.limits.step
    }

    /// CAO's step: the best of the random candidates by the local model, or `None`
    /// if staying is better [Renzaglia2019 function CAO].
    fn optimise(&mut self) -> Option<Action<Point>> {
        let here = self.knowledge.position();
        let model = (self.history.len() >= FEWEST)
            .then(|| self.fit(here))
            .flatten();
        let Some(model) = model else {
            return Some(self.wander());
        };
        let mut best: Option<(f32, Point)> = None;
        for _ in 0..self.config.candidates {
            let to = self.candidate(here);
            if !self.knowledge.may_fly(to) {
                continue;
            }
            let value = model.value(to);
            // [Renzaglia2019 eq. 7]
            if best.is_none_or(|(most, _)| value > most) {
                best = Some((value, to));
            }
        }
        match best {
            Some((value, _)) if value <= model.value(here) => None,
            Some((_, to)) => Some(Action::Move(to)),
            None => Some(self.climb()),
        }
    }

    // [Renzaglia2019 eq. 5]; reading: centred on the robot, scaled to the history's
    // reach, J less its mean.
    #[inline(never)] // what it keeps on the stack goes with it
    fn fit(&mut self, here: Point) -> Option<Model> {
        self.knowledge.count_work((H * H) as u32);
        let reach = self.history.reach(here).max(self.config.limits.step);
        let frame = Frame {
            origin: here,
            scale: 1.0 / reach,
        };
        let ridge = RIDGE * self.history.len() as f32;
        Model::fit::<H>(
            self.history.centred().as_slice(),
            frame,
            self.config.degree,
            ridge,
        )
    }

    /// A random point of the sphere of one step [Renzaglia2019 eq. 6].
    fn candidate(&mut self, here: Point) -> Point {
        self.knowledge.count_work(1);
        let (x, y, z) = self.rng.direction();
        let step = self.config.limits.step;
        here.offset(step * x, step * y, step * z)
    }

    /// The first allowed candidate.
    fn wander(&mut self) -> Action<Point> {
        let here = self.knowledge.position();
        for _ in 0..self.config.candidates {
            let to = self.candidate(here);
            if self.knowledge.may_fly(to) {
                return Action::Move(to);
            }
        }
        self.climb()
    }

    fn climb(&self) -> Action<Point> {
        let up = self.knowledge.climb();
        if self.knowledge.may_fly(up) {
            Action::Move(up)
        } else {
            Action::Wait
        }
    }

    /// Flies to the closest frontier [Renzaglia2019 §4.2]. Reading: low enough that
    /// it comes into range, and another one as soon as this one is none any more.
    fn fly_to_frontier(&mut self) -> Action<Point> {
        let is_frontier = |cell| self.knowledge.surface().is_frontier(cell);
        if !self.knowledge.goal().is_some_and(is_frontier) {
            let (goal, work) = self.knowledge.closest_frontier();
            self.knowledge.set_goal(goal);
            self.knowledge.count_work(work);
        }
        let cruise = self.config.limits.cruise(CRUISE);
        self.knowledge.count_work(29);
        self.knowledge
            .goal()
            .and_then(|goal| {
                let goal = Point::over(goal, 0.0);
                self.knowledge.step_towards(goal, cruise)
            })
            .map_or(Action::Wait, Action::Move)
    }
}

impl<const TW: usize, const TH: usize, const H: usize> Pilot<TW, TH> for Fcao<TW, TH, H> {
    fn knowledge(&self) -> &Knowledge<TW, TH> {
        &self.knowledge
    }

    fn knowledge_mut(&mut self) -> &mut Knowledge<TW, TH> {
        &mut self.knowledge
    }

    fn fly_home(&mut self) -> Option<Action<Point>> {
        Some(self.recovery.fly_home(&mut self.knowledge))
    }

    // [Renzaglia2019 Algorithm 1]
    fn decide(&mut self) -> Action<Point> {
        self.history
            .push(self.knowledge.position(), self.knowledge.reward());
        let needs_recovery = self.knowledge.idle() >= self.config.limits.patience();
        if self.knowledge.is_blocked() && (!needs_recovery || self.recovery.steps_aside()) {
            self.knowledge.take_refused();
            return self.wander();
        }
        if needs_recovery {
            return self.recovery.tick(&mut self.knowledge);
        }
        if self.knowledge.gain() > self.least_gain() {
            // Without a goal: the robot optimises locally.
            self.knowledge.set_goal(None);
            if let Some(action) = self.optimise() {
                return action;
            }
        }
        self.fly_to_frontier()
    }
}
