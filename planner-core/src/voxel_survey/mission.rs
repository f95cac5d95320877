//! Home and energy: when to turn back, and the way home.
//!
//! # Energy
//! Energy counts ticks, for a robot that hovers spends as one that flies; one that has stopped
//! spends nothing. Let E be the ticks that are left and h ≥ the steps home over poses: 0 at home,
//! one more with each step, for the robot can fly back as it came, and exact after a search. A
//! search for a way of at most h steps takes at most S(h) ticks before the one in which it ends,
//! where S(h) = h·w·W / [`SLICE`]: w are the words of the tiles of levels that a wave of h steps
//! comes to, of which it looks at each at most once a step; W is the [work](far::HOME_WORD) of
//! one, and a tick that does not end the search does a slice of it at least.
//!
//! The robot explores on in a tick only if h + 1 + S(h + 1) ≤ E − 1. So h + S(h) ≤ E holds before
//! each tick: in between were at most a step and a tick. Where the rule forbids to go on, the
//! robot searches, which takes S(h) at most and finds a way of at most h steps, and each of its
//! steps takes one off both: it is home with E ≥ 0. It explores on after a search only if more is
//! left than a quarter of the way, so that it does not search after every step.
//!
//! That holds while what was free stays free and every step is followed where it was sent, as in
//! the proof of the whole. Else the robot searches again, and comes home as well as it can; what
//! others tell in the very ticks of a search may cost one search more.
//!
//! # Why the way home ends
//! Each step brings the robot nearer to home, by one of the steps that the search has counted.
//! Where that does not hold any more it searches again: after something was learnt, or a step was
//! not followed. What refuses is tried again in rounds, of which there is a last one, and then
//! the stop is [`Stop::Blocked`]; without a way at all it is [`Stop::NoWay`].

use super::far::{self, Homeward};
use super::{Config, SLICE, VoxelSurvey};
use crate::robot::{Action, Stop, Wait};
use crate::tile::TILE;
use crate::volume::{Voxel, word_work};
use crate::zeroed::Maybe;

/// What the robot is to come home for, and with.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mission {
    /// Where it was first.
    home: Maybe<Voxel>,
    comes_home: bool,
    errand: Maybe<End>,
    /// Ticks that are left, if that was told.
    energy: Maybe<u32>,
    /// Steps of the way home at most; [`UNKNOWN`](Self::UNKNOWN) until it was searched for.
    way_home: u32,
    /// Whether the last move was one of them.
    is_on_way: bool,
}

/// What ends at home.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum End {
    /// The way there, as it was told or for its energy.
    Home,
    /// The survey, for this reason, with so many voxels known.
    Survey(Stop<Voxel>, u32),
}

impl Mission {
    const UNKNOWN: u32 = u32::MAX;

    pub(super) const fn vacant() -> Self {
        Self {
            home: Maybe::Nothing,
            comes_home: false,
            errand: Maybe::Nothing,
            energy: Maybe::Nothing,
            way_home: 0,
            is_on_way: false,
        }
    }

    pub(super) const fn of(config: &Config) -> Self {
        Self {
            comes_home: config.come_home,
            energy: match config.energy {
                0 => Maybe::Nothing,
                ticks => Maybe::Just(ticks),
            },
            ..Self::vacant()
        }
    }

    /// Whether the robot is on its way home, or there.
    pub(super) const fn has_errand(&self) -> bool {
        matches!(self.errand, Maybe::Just(_))
    }

    pub(super) fn end_errand(&mut self) {
        self.errand = Maybe::Nothing;
    }

    /// A survey that has ended goes on: the robot may be where it has not surveyed.
    pub(super) fn reopen_survey(&mut self) {
        if let Maybe::Just(End::Survey(..)) = self.errand {
            self.end_errand();
        }
    }

    /// Whether the robot has been anywhere yet.
    pub(super) const fn has_home(&self) -> bool {
        matches!(self.home, Maybe::Just(_))
    }

    pub(super) fn is_home(&self, at: Voxel) -> bool {
        self.home.get() == Some(at)
    }

    /// Where the robot goes on an errand.
    pub(super) fn goal(&self) -> Option<Voxel> {
        self.home.get().filter(|_| self.has_errand())
    }

    /// The robot is at `to`: after a step from a pose, or without.
    pub(super) fn arrive(&mut self, from: Option<Voxel>, to: Voxel) {
        if self.home.get().is_none() {
            self.home = Maybe::Just(to);
        }
        let is_on_way = core::mem::take(&mut self.is_on_way);
        self.way_home = match from {
            _ if self.is_home(to) => 0,
            Some(from) if from == to => self.way_home,
            Some(_) if is_on_way => self.way_home.saturating_sub(1),
            Some(from) if from.distance_squared(to) == 1 => self.way_home.saturating_add(1),
            _ => Self::UNKNOWN,
        };
    }

    /// A tick in the air has passed.
    pub(super) fn spend(&mut self) {
        if let Maybe::Just(energy) = &mut self.energy {
            *energy = energy.saturating_sub(1);
        }
    }
}

impl<const TW: usize, const TH: usize, const L: usize> VoxelSurvey<TW, TH, L> {
    /// Sends the robot home, to where it was first: it explores no more, and stops there with
    /// [`Stop::Home`], until [`resume`](Self::resume).
    pub fn go_home(&mut self) {
        self.send(End::Home);
    }

    /// Tells for how many ticks the robot's energy lasts from now on, flown or hovered: it turns
    /// back in time, and stops with [`Stop::Home`]. That rests on flights that are followed, and
    /// on a map in which what was free stays free; else it comes home as well as it can.
    pub fn energy(&mut self, left: u32) {
        self.mission.energy = Maybe::Just(left);
    }

    /// What the robot does for its mission in this tick; `None`: it explores.
    pub(super) fn mind_mission(&mut self) -> Option<Action<Voxel, Voxel>> {
        if !self.mission.has_errand() && self.mission.energy.get().is_none() {
            return None;
        }
        self.mind_errand()
    }

    // Not in line: mostly there is none.
    #[inline(never)]
    fn mind_errand(&mut self) -> Option<Action<Voxel, Voxel>> {
        if let Maybe::Just(End::Survey(_, known)) = self.mission.errand
            && known != self.volume.age()
        {
            // There may be more to survey.
            self.mission.end_errand();
            self.far.reset();
        }
        if !self.mission.has_errand() && self.allows_a_step() {
            return None;
        }
        let home = self.mission.home.get()?;
        if self.position == home {
            return Some(self.come_home());
        }
        if self.mission.has_errand() && self.rest > 0 {
            self.rest = self.rest.saturating_sub(1);
            return Some(self.wait(Wait::Closed));
        }
        if let Some(next) = self.next_home() {
            return Some(self.fly_home(next));
        }
        Some(match self.look_for_home(home) {
            Homeward::Found(steps) => {
                self.mission.way_home = steps;
                if !self.mission.has_errand() {
                    if self.allows_more(steps / 4) {
                        self.far.reset();
                        return Some(self.wait(Wait::Search));
                    }
                    self.mission.errand = Maybe::Just(End::Home);
                }
                match self.next_home() {
                    Some(next) => self.fly_home(next),
                    None => self.wait(Wait::Search),
                }
            }
            Homeward::Searching => self.wait(Wait::Search),
            Homeward::Nothing => self.lack_a_way(home),
        })
    }

    /// The end of a survey: the robot stops, or comes home first.
    pub(super) fn end(&mut self, reason: Stop<Voxel>) -> Action<Voxel, Voxel> {
        let is_home = self.mission.is_home(self.position);
        if !self.mission.comes_home || self.mission.has_errand() || is_home {
            return self.stop(reason);
        }
        self.send(End::Survey(reason, self.volume.age()));
        self.wait(Wait::Search)
    }

    /// The robot explores no more; what refused a step is tried anew.
    fn send(&mut self, end: End) {
        self.mission.errand = Maybe::Just(end);
        self.stopped = false;
        self.way.clear();
        self.far.reset();
        self.open_all();
        self.round = 0;
        self.rest = 0;
    }

    /// The errand stays, until the robot is told to go on.
    fn come_home(&mut self) -> Action<Voxel, Voxel> {
        let frontiers = self.volume.frontiers();
        let end = self.mission.errand.get().unwrap_or(End::Home);
        self.mission.errand = Maybe::Just(end);
        self.stop(match end {
            End::Home => Stop::Home { frontiers },
            End::Survey(reason, _) => reason,
        })
    }

    fn fly_home(&mut self, next: Voxel) -> Action<Voxel, Voxel> {
        self.way.clear();
        self.mission.is_on_way = true;
        Action::Move(next)
    }

    /// No way home was found: what is closed is tried again, or the robot stops.
    fn lack_a_way(&mut self, home: Voxel) -> Action<Voxel, Voxel> {
        self.mission.errand = Maybe::Just(self.mission.errand.get().unwrap_or(End::Home));
        if self.is_closed {
            return self.end_round();
        }
        self.stop(Stop::NoWay {
            frontiers: self.volume.frontiers(),
            at: home,
        })
    }

    /// The next step of the way that was found.
    fn next_home(&self) -> Option<Voxel> {
        if self.mission.way_home == 0 {
            return None;
        }
        self.far.steps_home(self.position).find(|&at| {
            let is_enterable = self.mission.is_home(at) || self.volume.is_pose(at, self.clearance);
            is_enterable && !self.closed.get(at)
        })
    }

    /// Whether the robot can do anything in this tick and still come home.
    fn allows_a_step(&self) -> bool {
        self.allows_more(0)
    }

    /// The same with so many ticks left over.
    fn allows_more(&self, ticks: u32) -> bool {
        let Some(energy) = self.mission.energy.get() else {
            return true;
        };
        let steps = self.mission.way_home.saturating_add(1);
        let needed = steps.saturating_add(self.search_ticks(steps));
        needed.saturating_add(1).saturating_add(ticks) <= energy
    }

    /// Ticks of a search for a way of at most so many steps, before the one that ends it.
    fn search_ticks(&self, steps: u32) -> u32 {
        let (columns, rows) = self.volume.extent().tiles();
        let about =
            |within: u32, side: u8| within.saturating_mul(2).saturating_add(1).min(side.into());
        // Tiles beyond that of home; the wave looks at whole rows of them.
        let tiles = about(steps / TILE as u32 + 1, rows);
        let levels = about(steps.saturating_add(1), self.volume.levels());
        let words = u32::from(columns)
            .saturating_mul(tiles)
            .saturating_mul(levels);
        let word = far::HOME_WORD.saturating_add(word_work(self.clearance));
        steps.saturating_mul(words).saturating_mul(word) / SLICE
    }
}
