//! Looks: what they tell, where more are asked for, and when they stop a step.

use super::Explorer;
use super::ahead::{MOST_WAITS, Verdict};
use super::body::body_cells;
use super::evidence::{Purpose, Votes};
use crate::cell::{Cell, Direction};
use crate::map::Learnt;
use crate::robot::Wait;
use crate::sight::Sighting;
use crate::tile::TileIndex;

/// The most looks in each of four directions that a byte counts.
const MOST_LOOKS: u8 = 50;

impl<const TW: usize, const TH: usize> Explorer<TW, TH> {
    /// Takes in a look from a cell of the grid.
    pub(super) fn look_around(&mut self, sighting: &Sighting) -> Learnt {
        self.ahead.look(sighting, self.around.clearance);
        let purpose = self.purpose();
        let (around, others) = (&mut self.around, &self.others);
        let (clearance, now) = (around.clearance, around.now);
        let (map, model) = (&mut around.map, &self.config.sensor);
        let bodies = |at| others.bodies(at, clearance, now);
        self.evidence.observe(map, sighting, model, purpose, bodies)
    }

    /// What the robot stands still for.
    fn purpose(&self) -> Purpose {
        match self.waiting.get() {
            Some(Wait::Look(_) | Wait::Obstructed) if self.around.clearance > 0 => {
                Purpose::Within(self.around.clearance + 1)
            }
            Some(Wait::Look(_)) => {
                let sides = self.around.sides_to_look(self.around.position);
                Purpose::Sides(sides.fold(0, |sides, side| sides | 1 << side as u8))
            }
            Some(Wait::Obstructed) => match self.next_step() {
                Some(step) if !(self.errs_by_place() && self.ahead.is_contradicted(step)) => {
                    Purpose::Sides(1 << step as u8)
                }
                _ => Purpose::None,
            },
            Some(Wait::Doubt) => Purpose::Walls,
            _ => Purpose::None,
        }
    }

    fn errs_by_place(&self) -> bool {
        self.config.sensor.votes == Votes::PerPlace
    }

    /// A robot on a frontier cell without a plan looks in every direction that shows
    /// nothing, in turn, and then sets the cell aside. The direction to look in, if any.
    pub(super) fn look(&mut self) -> Option<Direction> {
        let here = self.around.position;
        if self.role.plan.is_some() || !self.around.is_goal(here) {
            return None;
        }
        let sides = self.around.sides_to_look(here).count().max(1);
        let made = usize::from(self.looks);
        let least = sides * usize::from(self.config.looks.clamp(1, MOST_LOOKS));
        if made < least || self.may_decide() {
            self.looks = self.looks.saturating_add(1);
            return self.around.sides_to_look(here).nth(made % sides);
        }
        self.looks = 0;
        self.around.end_visits(here);
        let unseen = self.around.unknown_sides(here).next();
        if let Some(side) = unseen {
            let unseen = self.around.unknown_near(here, side);
            self.around.aside.show_nothing(here, unseen);
        }
        self.far_is_doubtful = true;
        None
    }

    /// Whether more looks may decide of what is beside the cell that the robot stands on.
    fn may_decide(&self) -> bool {
        let here = self.around.position;
        let is_doubtful = |side: Direction| self.around.is_doubtful_near(here, side);
        let is_visit = |side: Direction| self.around.is_due(here, side);
        let mut sides = self.around.sides_to_look(here);
        let barren = self.config.sensor.barren_looks();
        let may_fall = barren > 0 && self.evidence.barren() <= barren + 1;
        may_fall && self.around.sides_to_look(here).any(is_doubtful)
            || self.looks < MOST_WAITS && sides.any(is_visit)
    }

    /// Whether the step leads to where the last look saw something: the robot looks again,
    /// and takes what stays for a refusal.
    pub(super) fn vetoes(&mut self, step: Direction) -> bool {
        let verdict = self.ahead.check(step, self.errs_by_place());
        if verdict == Verdict::Refused {
            let next = self.around.position.step(step);
            let by_robot = body_cells(self.around.clearance, next).any(|cell| self.is_body(cell));
            self.refuse(next, by_robot);
        }
        verdict != Verdict::Go
    }

    /// Whether what a sensor sees in a cell may be another robot.
    fn is_body(&self, cell: Cell) -> bool {
        TileIndex::of(cell).is_some_and(|(at, bit)| self.bodies(at) & bit != 0)
    }

    /// The cells of a tile in which a look may show other robots.
    #[inline(never)] // thrice the same
    pub(super) fn bodies(&self, at: TileIndex) -> u64 {
        let (clearance, now) = (self.around.clearance, self.around.now);
        match self.config.sensor.sees_robots {
            true => self.others.bodies(at, clearance, now),
            false => 0,
        }
    }
}
