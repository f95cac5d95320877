//! Home: along the way that the robot keeps, and round what is in the way.

use super::way::Next;
use super::{MARGIN, REST, ROUNDS, Recovery, WAITS, leg_steps};
use crate::cell::Cell;
use crate::point::Point;
use crate::robot::{Action, Stop, Wait};
use crate::surface::Columns;
use crate::survey::Knowledge;
use crate::zeroed::Maybe;

/// Flights round others, and ticks of waiting for them, before it looks for a way round.
const DETOURS: u8 = 64;

/// No column.
const NOWHERE: Cell = Cell::new(-1, -1);

impl<const TW: usize, const TH: usize> Recovery<TW, TH> {
    /// One step of the way home; a stop at its end. Why it ends: `survey/mission.rs`.
    ///
    /// Cost: as of [`tick`](Self::tick).
    pub fn fly_home(&mut self, knowledge: &mut Knowledge<TW, TH>) -> Action<Point> {
        let refused = knowledge.take_refused();
        let Some(home) = knowledge.home() else {
            return knowledge.wait(Wait::Pose);
        };
        if knowledge.sets_out() {
            self.set_out();
        }
        if knowledge.is_home() {
            return knowledge.arrive();
        }
        knowledge.set_goal(Some(home.cell()));
        if !self.is_round {
            if let Some(action) = self.follow_trail(knowledge, refused.is_some()) {
                return action;
            }
            self.look_round(knowledge, home.cell());
        }
        if let Some((from, to)) = refused {
            self.close_refused(knowledge, from, to);
        }
        self.fly_round(knowledge, home)
    }

    fn set_out(&mut self) {
        self.begin_spell();
        self.is_homeward = true;
        self.is_round = false;
        self.goal = None;
        self.detours = 0;
    }

    /// A flight of the way that the robot keeps; `None` if there is none, or if what is in
    /// the way stays there.
    fn follow_trail(
        &mut self,
        knowledge: &mut Knowledge<TW, TH>,
        is_refused: bool,
    ) -> Option<Action<Point>> {
        let to = knowledge.flight_home()?;
        if !knowledge.is_open(to) || (is_refused && !self.steps_aside()) {
            return None;
        }
        if !is_refused && knowledge.may_fly(to) {
            return Some(Action::Move(to));
        }
        self.detours = self.detours.saturating_add(1);
        if self.detours > DETOURS {
            return None;
        }
        let up = knowledge.climb();
        if up.z > knowledge.position().z && knowledge.may_fly(up) {
            return Some(Action::Move(up));
        }
        let cruise = knowledge.limits().min_altitude + MARGIN;
        knowledge.count_work(29);
        let aside = knowledge.step_towards(to, cruise).map(Action::Move);
        Some(aside.unwrap_or_else(|| knowledge.wait(Wait::Closed)))
    }

    /// From now on it flies from column to column.
    fn look_round(&mut self, knowledge: &Knowledge<TW, TH>, home: Cell) {
        self.is_round = true;
        self.careful = true;
        self.climbing = false;
        self.goal = Some(home);
        self.obstacle = Maybe::Just((home, false));
        self.closed.fill(0);
        self.legs = knowledge.surface().known_columns();
        self.leg = knowledge.position().cell();
        self.patience = leg_steps(knowledge);
        self.way.begin(self.goal);
    }

    /// A flight was refused: by its column, or it is tried again as long as there is
    /// patience.
    fn close_refused(&mut self, knowledge: &Knowledge<TW, TH>, from: Point, to: Point) {
        let here = knowledge.position().cell();
        let mut crossed = Columns::new(from, to).skip(1);
        match (crossed.next(), crossed.next()) {
            (Some(only), None) => {
                self.obstacle = Maybe::Just((only.cell, false));
                self.close(only.cell, here);
            }
            (Some(_), Some(_)) => {}
            (None, _) => self.obstacle = Maybe::Just((here, false)),
        }
    }

    /// A step of the way round.
    fn fly_round(&mut self, knowledge: &mut Knowledge<TW, TH>, home: Point) -> Action<Point> {
        if self.rest > 0 {
            self.rest = self.rest.saturating_sub(1);
            return knowledge.wait(Wait::Closed);
        }
        let here = knowledge.position().cell();
        if here == home.cell() {
            return self.descend(knowledge, home);
        }
        let next = match self.way.next(knowledge, &self.closed) {
            Next::Column(cell) => cell,
            Next::Searching => return knowledge.wait(Wait::Search),
            Next::None => return self.end_way(knowledge, home.cell()),
        };
        self.begin_leg(knowledge, here, next);
        self.patience = self.patience.saturating_sub(1);
        if self.patience == 0 {
            self.patience = leg_steps(knowledge);
            self.close(next, here);
            return knowledge.wait(Wait::Search);
        }
        let cruise = knowledge.limits().min_altitude + MARGIN;
        let step = self.careful_step(knowledge, Point::over(next, 0.0), cruise);
        step.unwrap_or_else(|| knowledge.wait(Wait::Search))
    }

    /// In the column of home: straight there.
    fn descend(&mut self, knowledge: &mut Knowledge<TW, TH>, home: Point) -> Action<Point> {
        let here = home.cell();
        self.begin_leg(knowledge, here, NOWHERE);
        self.patience = self.patience.saturating_sub(1);
        let straight = knowledge.sky().step(knowledge.position(), home);
        let to = match knowledge.is_open(straight) {
            true => straight,
            false => knowledge.climb(),
        };
        if self.patience > 0 {
            match knowledge.robot_in_the_way(to) {
                None => return Action::Move(to),
                Some(robot) if self.waits_for(robot) => return knowledge.wait(Wait::Closed),
                Some(_) => {}
            }
        }
        self.patience = leg_steps(knowledge);
        self.end_round_home(knowledge)
    }

    /// No way leads home, over columns that are not closed.
    fn end_way(&mut self, knowledge: &mut Knowledge<TW, TH>, home: Cell) -> Action<Point> {
        if self.way.is_cut() {
            return self.end_round_home(knowledge);
        }
        let frontiers = knowledge.surface().frontiers();
        knowledge.end_errand(Stop::NoWay {
            frontiers,
            at: home,
        })
    }

    /// Everything is tried again, or the robot stops.
    fn end_round_home(&mut self, knowledge: &mut Knowledge<TW, TH>) -> Action<Point> {
        if self.round < ROUNDS {
            self.rest = REST << self.round;
            self.round = self.round.saturating_add(1);
            self.waits = WAITS;
            self.closed.fill(0);
            self.way.begin(self.goal);
            return knowledge.wait(Wait::Closed);
        }
        let frontiers = knowledge.surface().frontiers();
        let goal = self.goal.unwrap_or(knowledge.position().cell());
        let (at, is_robot) = self.obstacle.get().unwrap_or((goal, false));
        knowledge.end_errand(match is_robot {
            false => Stop::Blocked { frontiers, at },
            true => Stop::Held { frontiers, at },
        })
    }
}
