//! Home and energy: where a robot goes when it has surveyed, and when it turns back.
//!
//! Home is where the robot was when it first had a good pose: it ends above its start, at the
//! same height, or, if that was below the least altitude, where it had risen to.
//! A wide robot that does not see all ground under it there flies to where it does first, and
//! that is home.
//!
//! # The way home
//! A robot that may have to go home keeps a way there: a chain of straight parts over
//! corners, whose last one is home. Each part is one flight, or it is open to
//! both sides too, so that places on it may be rounded. A flight between the least altitude
//! and the ceiling, with room for the body, is open back, too, for a line crosses the same
//! [columns](crate::surface::Columns) both ways. After each flight either the last
//! corner is still straight ahead, or the place that the robot comes from is a new one; then
//! corners are left out that need not be there. So the way is known at any time, without a
//! search. It takes as many ticks as its parts take steps, climbs included: a part of length
//! d takes ⌈d / step⌉.
//!
//! # Energy
//! Let E be the ticks that the energy lasts for when a tick has been paid for, and W those of
//! the way home. Hovering costs as much as flying. The robot may do what its planner likes
//! only if W + 2 ≤ E. Whatever it does adds at most one flight back to the way: W grows by one
//! at most, and the next tick takes one off E, so that W ≤ E then. If the rule now forbids
//! more, it flies home, and each flight takes one off both. The tick between is for
//! rounding: the ends of steps on long parts are rounded, which may cost a step. So a
//! robot is never away from home without energy, if it had at least two ticks of it, no
//! flight was refused or held up, it is where it was sent, and it began between the least
//! altitude and the ceiling. A way with more corners than there is room for ends the survey
//! as an empty battery does.
//!
//! # Who is in the way
//! A robot that another one holds up on its way climbs over it, flies round it or waits, at
//! most 64 times, each of which adds a flight to the way at most.
//! After that, after three refused flights, and where wind or a hand has taken it off its way,
//! the recovery looks for a way round: a wave over known columns, and flights from each to the
//! next, as it flies to frontiers, with the same ends. It waits and tries again three times
//! at longer and longer rests; then the stop says what was in the way. Energy is not kept for
//! that.

use super::Knowledge;
use super::flight::{SAME, Sky};
use super::trail::Trail;
use crate::point::Point;
use crate::robot::{Action, Stop};
use crate::surface::Height;
use crate::zeroed::Maybe;

/// Ticks that the robot has to spare beside those of the way home, before it does anything
/// else: one for that, and one for rounding.
const SPARE: u32 = 2;

/// How near to home a robot has come that was sent there and pushed aside.
const REACHED: f32 = 1.0;

/// What robots are sent out with. Nothing of it by default.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Mission {
    /// Whether a robot that stops flies home first.
    pub come_home: bool,
    /// Ticks in the air that its energy lasts for, and again when it is told to go on; 0: no
    /// limit. A robot that has to turn back stops at home, with
    /// [`Stop::Home`](crate::Stop::Home).
    pub energy: u32,
}

impl Mission {
    /// Nothing of it.
    pub const NONE: Self = Self {
        come_home: false,
        energy: 0,
    };

    const fn budget(self) -> Maybe<u32> {
        match self.energy {
            0 => Maybe::Nothing,
            energy => Maybe::Just(energy),
        }
    }
}

/// A robot's mission, and what has become of it.
#[derive(Clone, Debug)]
pub(super) struct Errand {
    mission: Mission,
    /// Ticks left.
    energy: Maybe<u32>,
    home: Maybe<Point>,
    trail: Trail,
    /// Whether it goes home for its energy, or as it was told.
    returns: bool,
    /// Whether it was on its way in the last tick.
    is_under_way: bool,
    /// Whether it has come home, or has given up.
    is_over: bool,
}

impl Errand {
    /// All zero.
    pub(super) const fn vacant() -> Self {
        Self {
            mission: Mission::NONE,
            energy: Maybe::Nothing,
            home: Maybe::Nothing,
            trail: Trail::vacant(),
            returns: false,
            is_under_way: false,
            is_over: false,
        }
    }

    /// Forgets all, in place.
    pub(super) fn reset(&mut self) {
        self.mission = Mission::NONE;
        self.energy = Maybe::Nothing;
        self.home = Maybe::Nothing;
        self.end();
    }

    /// The robot has a good pose; the first one is home, or the first of those with room for
    /// its body, if it `had_room` in none yet.
    pub(super) fn begin(&mut self, at: Point, had_room: bool) {
        if !had_room || matches!(self.home, Maybe::Nothing) {
            self.home = Maybe::Just(at);
            self.trail.begin(at);
        }
    }

    /// Whether the robot has had a good pose yet.
    pub(super) const fn has_home(&self) -> bool {
        matches!(self.home, Maybe::Just(_))
    }

    /// It explores again, with as much energy as at first.
    pub(super) fn resume(&mut self) {
        if let Maybe::Just(_) = self.mission.budget() {
            self.energy = self.mission.budget();
        }
        self.end();
    }

    fn end(&mut self) {
        self.returns = false;
        self.is_under_way = false;
        self.is_over = false;
    }

    /// Whether the robot explores no more.
    pub(super) const fn returns(&self) -> bool {
        self.returns
    }

    const fn is_limited(&self) -> bool {
        matches!(self.energy, Maybe::Just(_))
    }
}

impl<const TW: usize, const TH: usize> Knowledge<TW, TH> {
    /// What the robot is sent out with. Call it before the first tick.
    pub fn set_mission(&mut self, mission: Mission) {
        self.errand.mission = mission;
        self.errand.energy = mission.budget();
    }

    /// Ticks that the robot's energy still lasts for.
    pub(super) fn set_energy(&mut self, left: u32) {
        self.errand.energy = Maybe::Just(left);
    }

    /// From now on the robot goes home.
    pub(super) fn send_home(&mut self) {
        self.errand.end();
        self.errand.returns = true;
    }

    /// Where it ends: at home, but not lower than anything may fly.
    pub(super) fn home(&self) -> Option<Point> {
        let home = self.errand.home.get()?;
        let ground = self.sky().highest(home, home).map_or(0.0, Height::cells);
        let least = ground + self.limits.min_altitude;
        Some(Point::new(home.x, home.y, home.z.max(least)))
    }

    /// Whether the robot is there, or was sent there and pushed aside.
    pub(super) fn is_home(&self) -> bool {
        self.home().is_some_and(|home| {
            let off = self.position.distance(home);
            let (_, to) = self.flight();
            off <= SAME || (off <= REACHED && to.distance(home) <= SAME)
        })
    }

    /// The part of each tick that minds the mission, after
    /// [`begin_tick`](Self::begin_tick): whether the robot is to fly home now.
    ///
    /// Cost: nothing without a mission; with one, at most 7 straight ways, of at most two
    /// lines each.
    pub(super) fn is_to_go_home(&mut self) -> bool {
        let is_due = self.mind_mission();
        self.errand.is_under_way &= is_due;
        is_due
    }

    fn mind_mission(&mut self) -> bool {
        let Errand {
            mission, returns, ..
        } = self.errand;
        if !mission.come_home && !returns && !self.errand.is_limited() {
            return false;
        }
        if let Maybe::Just(energy) = &mut self.errand.energy {
            *energy = energy.saturating_sub(1);
        }
        if self.is_lost() {
            return false;
        }
        let sky = Sky {
            limits: self.limits,
            surface: &self.surface,
        };
        let trail = &mut self.errand.trail;
        trail.follow(self.position, &sky);
        if let Some(home) = trail.home() {
            self.errand.home = Maybe::Just(home);
        }
        let way = trail.steps(self.position, &sky);
        let is_full = trail.is_full();
        self.count_work(8);
        if !self.stopped {
            self.errand.is_over = false;
        }
        let lasts = |energy| way.saturating_add(SPARE) <= energy && !is_full;
        let is_low = self.errand.energy.get().is_some_and(|it| !lasts(it));
        self.errand.returns |= is_low && !self.stopped;
        let is_due = self.errand.returns || self.stopped && (mission.come_home || is_low);
        is_due && !self.errand.is_over
    }

    /// Whether a robot that stops flies home first.
    pub(super) const fn comes_home(&self) -> bool {
        self.errand.mission.come_home && !self.errand.is_over
    }

    /// Whether this is the first tick of a way home; asking makes the next one another.
    pub(super) fn sets_out(&mut self) -> bool {
        !core::mem::replace(&mut self.errand.is_under_way, true)
    }

    /// The next flight of the way home, if it is known.
    pub(super) fn flight_home(&self) -> Option<Point> {
        let trail = &self.errand.trail;
        let to = trail.next().filter(|_| trail.is_whole())?;
        Some(self.sky().step(self.position, to))
    }

    /// The robot is at home: it stops there.
    pub(super) fn arrive(&mut self) -> Action<Point> {
        let frontiers = self.surface.frontiers();
        let (reason, _) = self.reason();
        self.end_errand(match self.errand.returns {
            true => Stop::Home { frontiers },
            false => reason,
        })
    }

    /// The way home ends here, for this reason.
    pub(super) fn end_errand(&mut self, stop: Stop) -> Action<Point> {
        if let Maybe::Just(home) = self.errand.home
            && self.is_home()
        {
            self.errand.trail.begin(home);
        }
        self.errand.is_over = true;
        self.stop(stop)
    }
}
