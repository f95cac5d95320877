//! The frontier that the fewest others are nearer to.

use planner_core::{Cell, RobotId};

use super::groups::{Frontier, Groups};
use super::peer::{Rule, Term};
use super::waves::{Spot, Waves};

/// MinPos \[Bautin2011\]: robot i goes to the frontier j at which its position
/// P_ij = |{k ≠ i : C_kj < C_ij}| is least; of those to the one of least cost.
/// Robots at equal distance are ranked by id; else robots that stand on one
/// cell would never part.
///
/// Each robot computes its own row of P from where it last heard the others. All
/// waves move in step, so P_ij is known when the own wave arrives at j, and the
/// search ends with the first frontier that nobody is nearer to.
#[derive(Debug)]
pub struct MinPos<const STRONG: bool> {
    groups: Groups,
    /// By frontier: how many robots are nearer.
    nearer: Vec<u16>,
}

/// As published: a frontier is an 8-connected component, assigned anew every
/// d_max = 2 moves.
pub type PaperMinPos = MinPos<false>;

/// Every frontier cell is a frontier, assigned anew in every tick.
pub type StrongMinPos = MinPos<true>;

impl<const STRONG: bool> Default for MinPos<STRONG> {
    fn default() -> Self {
        Self {
            groups: Groups::default(),
            nearer: Vec::new(),
        }
    }
}

impl<const STRONG: bool> MinPos<STRONG> {
    /// Counts a robot for the frontiers that its wave has just reached.
    fn count(&mut self, waves: &Waves, robot: usize) {
        for &spot in waves.layer(robot) {
            if waves.is_frontier(spot) {
                let frontier = self.groups.of(spot);
                if self.groups.touch(robot, frontier) {
                    self.nearer[frontier] += 1;
                }
            }
        }
    }

    /// The best of the frontiers that the own wave has just reached: P and spot.
    fn arrive(&mut self, waves: &Waves) -> Option<(u16, Spot)> {
        let mut best = None;
        for &spot in waves.layer(waves.me()) {
            if waves.is_frontier(spot) {
                let frontier = self.groups.of(spot);
                let position = self.nearer[frontier];
                if self.groups.touch(waves.me(), frontier)
                    && best.is_none_or(|(least, _)| position < least)
                {
                    best = Some((position, spot));
                }
            }
        }
        best
    }

    /// The least P that a frontier can still turn out to have.
    fn least_to_come(&self, me: usize) -> Option<u16> {
        (0..self.groups.count())
            .filter(|&frontier| !self.groups.is_touched(me, frontier))
            .map(|frontier| self.nearer[frontier])
            .min()
    }
}

impl<const STRONG: bool> Rule for MinPos<STRONG> {
    fn term(&self) -> Term {
        match STRONG {
            true => Term::EVERY_MOVE,
            false => Term::PAPER,
        }
    }

    fn assign(&mut self, waves: &mut Waves, _team: &[(RobotId, Cell)]) -> Option<Spot> {
        let frontier = if STRONG {
            Frontier::Cell
        } else {
            Frontier::Component
        };
        self.groups.find(waves, frontier);
        self.nearer.clear();
        self.nearer.resize(self.groups.count(), 0);
        let (me, robots) = (waves.me(), waves.robots());
        let mut best: Option<(u16, Spot)> = None;
        while !waves.layer(me).is_empty() {
            for lower in 0..me {
                self.count(waves, lower);
            }
            if let Some((position, spot)) = self.arrive(waves)
                && best.is_none_or(|(least, _)| position < least)
            {
                best = Some((position, spot));
            }
            for higher in me + 1..robots {
                self.count(waves, higher);
            }
            if let Some((least, _)) = best
                && self
                    .least_to_come(me)
                    .is_none_or(|to_come| to_come >= least)
            {
                break;
            }
            for robot in 0..robots {
                waves.advance(robot);
            }
        }
        best.map(|(_, spot)| spot)
    }
}
