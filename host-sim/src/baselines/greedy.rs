//! The globally shortest pair of robot and frontier first.

use planner_core::{Cell, RobotId};

use super::groups::{Frontier, Groups};
use super::peer::{Rule, Term};
use super::waves::{Spot, Waves};

/// Greedy allocation [Bautin2011, "Greedy allocation"]: take the robot i and the
/// frontier j of least C_ij, assign them, take both away, and go on; when no
/// frontier is left, start again with all of them.
///
/// Each robot does it for itself, from where it last heard the others. All waves
/// move in step, so the next pair of least cost is the next arrival; of equal
/// ones the lower id goes first.
#[derive(Debug, Default)]
pub struct Greedy {
    groups: Groups,
    taken: Vec<bool>,
    assigned: Vec<bool>,
}

impl Greedy {
    /// The first frontier not taken that a robot's wave has just reached.
    fn arrive(&self, waves: &Waves, robot: usize) -> Option<Spot> {
        let mut layer = waves.layer(robot).iter().copied();
        layer.find(|&spot| waves.is_frontier(spot) && !self.taken[self.groups.of(spot)])
    }

    /// Every robot without a frontier gets one, as long as there are some. The
    /// own one as soon as it is found; whether anybody got one otherwise.
    fn round(&mut self, waves: &mut Waves) -> Result<Spot, bool> {
        let robots = waves.robots();
        let mut left = self.groups.count();
        self.taken.clear();
        self.taken.resize(left, false);
        let mut anybody = false;
        while left > 0 {
            let mut under_way = false;
            for robot in 0..robots {
                if self.assigned[robot] {
                    continue;
                }
                if let Some(spot) = self.arrive(waves, robot) {
                    if robot == waves.me() {
                        return Ok(spot);
                    }
                    self.assigned[robot] = true;
                    self.taken[self.groups.of(spot)] = true;
                    left -= 1;
                    anybody = true;
                } else {
                    waves.advance(robot);
                    under_way |= !waves.layer(robot).is_empty();
                }
            }
            if !under_way {
                break;
            }
        }
        Err(anybody)
    }
}

impl Rule for Greedy {
    fn term(&self) -> Term {
        Term::PAPER
    }

    fn assign(&mut self, waves: &mut Waves, team: &[(RobotId, Cell)]) -> Option<Spot> {
        self.groups.find(waves, Frontier::Component);
        self.assigned.clear();
        self.assigned.resize(team.len(), false);
        loop {
            match self.round(waves) {
                Ok(spot) => return Some(spot),
                Err(false) => return None,
                Err(true) => {}
            }
            for (robot, &(id, cell)) in team.iter().enumerate() {
                if !self.assigned[robot] {
                    waves.restart(robot, id, cell);
                }
            }
        }
    }
}
