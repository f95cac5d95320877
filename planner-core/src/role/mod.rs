//! Robots that may not share a cell: roles walk, bodies stay.
//!
//! A role is what a robot is about to do, apart from its body, its map and its
//! radio. Where two bodies are in each other's way, the roles pass through each
//! other by an exchange of bodies.

mod path;

pub(crate) use path::{CAPACITY, Path};

use crate::cell::{Cell, Direction};
use crate::robot::{RobotId, Stop};
use crate::zeroed::Maybe;

/// Where a role is going, and how.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Plan {
    pub(crate) goal: Cell,
    /// Steps to the goal at most.
    pub(crate) remaining: u32,
    /// The first of them.
    pub(crate) path: Path,
}

/// Where a role goes instead of exploring, and what it stops with there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Errand {
    pub(crate) to: Cell,
    pub(crate) end: End,
}

/// What ends with an errand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) enum End {
    /// A visit to a cell.
    Visit,
    /// The way home, as it was told or for its energy.
    Home,
    /// The exploration, for this reason; the robot is on its way home.
    Exploration(Stop),
}

/// Plans that a role may lose by exchanges; then bodies in its way count as obstacles,
/// until it learns something or a round of cells set aside ends. Bodies set
/// cells aside each for itself: without a limit they could send roles round and round.
const MOST_LOST: u8 = 4;

/// What a robot is about to do. Robot `k` starts with role `k`, and its home is the home of
/// this role.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Role {
    pub(crate) rank: RobotId,
    pub(crate) plan: Option<Plan>,
    /// Steps since the last decision.
    pub(crate) since: u8,
    /// Plans that were made longer since the role last learnt anything.
    pub(crate) changes: u8,
    /// Plans that were worthless, or longer, in the body that it got by an exchange, see
    /// [`exchange`].
    pub(crate) lost: u8,
    /// Whether it has reached its goal and has not decided since.
    pub(crate) has_arrived: bool,
    pub(crate) stopped: Maybe<Stop>,
    pub(crate) home: Cell,
    pub(crate) errand: Maybe<Errand>,
    /// How often an exchange took it from where its errand had led.
    pub(crate) returns: u8,
    /// Names the cells that its body keeps out of; 0: none.
    pub(crate) kept_out: u16,
}

impl Role {
    pub(crate) const fn new(rank: RobotId, home: Cell) -> Self {
        Self {
            rank,
            home,
            errand: Maybe::Nothing,
            returns: 0,
            kept_out: 0,
            plan: None,
            since: 0,
            changes: 0,
            lost: 0,
            has_arrived: false,
            stopped: Maybe::Nothing,
        }
    }

    /// Names the role, and says whom it gives way to: to every lower one.
    pub const fn rank(&self) -> RobotId {
        self.rank
    }

    /// Whether the role has stopped.
    pub const fn has_stopped(&self) -> bool {
        matches!(self.stopped, Maybe::Just(_))
    }

    /// Where the role is going.
    pub fn goal(&self) -> Option<Cell> {
        self.plan.as_ref().map(|plan| plan.goal)
    }

    /// Steps to the goal at most; 0 without a plan.
    pub fn remaining(&self) -> u32 {
        self.plan.as_ref().map_or(0, |plan| plan.remaining)
    }

    /// The first steps of the way that it is committed to, at most 256.
    pub fn way(&self) -> impl Iterator<Item = Direction> + use<> {
        self.plan.map_or(Path::new(), |plan| plan.path).steps()
    }

    /// Changes to a longer plan since the role last learnt anything.
    pub const fn changes(&self) -> u8 {
        self.changes
    }

    /// The cell that the role goes to next from `here`.
    pub fn next_cell(&self, here: Cell) -> Option<Cell> {
        let plan = self.plan.as_ref().filter(|_| !self.has_stopped())?;
        Some(here.step(plan.path.first()?))
    }

    pub(crate) fn make_step(&mut self) {
        if let Some(plan) = &mut self.plan {
            plan.path.pop_front();
            plan.remaining = plan.remaining.saturating_sub(1);
            self.has_arrived = plan.remaining == 0;
        }
        self.since = self.since.saturating_add(1);
    }

    /// Drops a plan that is worthless in this body.
    pub(crate) fn lose_plan(&mut self) {
        self.lost = self.lost.saturating_add(1);
        self.plan = None;
    }

    /// The rest of the way at hand takes so many steps: if they are more than were left, the
    /// plan was worthless in this body.
    pub(crate) fn measure_rest(&mut self, length: u32) {
        if length > self.remaining() {
            self.lost = self.lost.saturating_add(1);
        }
    }

    fn is_pushed_back(&mut self, from: Cell, to: Cell) {
        if let (Some(plan), Some(way_back)) = (&mut self.plan, to.direction_to(from)) {
            // A way that is used up stays so: its rest is being searched for.
            if !plan.path.is_empty() {
                plan.path.push_front(way_back);
            }
            plan.remaining = plan.remaining.saturating_add(1);
        }
    }
}

/// What comes of it when the next cell of role `mine`, whose body stands on
/// `here`, is held by the body of role `theirs` on `there`: the two roles for
/// these two bodies, in this order, or `None` if `mine` waits.
///
/// 1. The other has just reached its goal: wait, so that it can look from there.
/// 2. Head-on: exchange, both have made their step.
/// 3. The other is passive, or gives way: exchange; it gets its cell put in front
///    of its path, unless that is used up and the rest is being searched for.
/// 4. Else wait: no new plan, nothing is used up. So too if `mine` has lost four plans,
///    since it last learnt anything, to bodies that had set aside what they led to; and
///    where the two bodies keep out of different cells: what is done for one is not for the
///    other.
///
/// The bodies join each other's maps, whatever comes of it: who waits may learn what makes
/// it go on. After an exchange neither role acts again in this tick.
pub fn exchange(mine: &Role, here: Cell, theirs: &Role, there: Cell) -> Option<(Role, Role)> {
    let is_elsewhere = mine.kept_out != theirs.kept_out;
    if theirs.has_arrived || mine.lost >= MOST_LOST || is_elsewhere {
        return None;
    }
    let (mut mine, mut theirs) = (*mine, *theirs);
    let head_on = theirs.next_cell(there) == Some(here);
    let passive = theirs.next_cell(there).is_none();
    if head_on {
        theirs.make_step();
    } else if passive || mine.rank < theirs.rank {
        theirs.is_pushed_back(there, here);
    } else {
        return None;
    }
    mine.make_step();
    Some((theirs, mine))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A role with a plan of ten steps, the first of them eastward.
    fn role(rank: u8, first: usize) -> Role {
        let mut path = Path::new();
        for _ in 0..first {
            path.push_front(Direction::East);
        }
        Role {
            plan: Some(Plan {
                goal: Cell::new(20, 1),
                remaining: 10,
                path,
            }),
            ..Role::new(RobotId(rank), HERE)
        }
    }

    const HERE: Cell = Cell::new(4, 1);
    const THERE: Cell = Cell::new(5, 1);

    #[test]
    fn a_role_that_gives_way_gets_its_cell_back() {
        let (theirs, mine) = exchange(&role(0, 3), HERE, &role(1, 3), THERE).unwrap();
        assert_eq!((mine.remaining(), mine.way().count()), (9, 2));
        assert_eq!((theirs.remaining(), theirs.way().count()), (11, 4));
        assert_eq!(exchange(&role(1, 3), HERE, &role(0, 3), THERE), None);
    }

    #[test]
    fn a_way_that_is_used_up_stays_so() {
        // With one step back, two such roles would push each other to and fro for ever.
        let (theirs, _) = exchange(&role(1, 3), HERE, &role(0, 0), THERE).unwrap();
        assert_eq!((theirs.remaining(), theirs.way().count()), (11, 0));
    }

    #[test]
    fn a_role_that_lost_its_plans_waits() {
        let mut mine = role(0, 3);
        mine.lost = MOST_LOST;
        assert_eq!(exchange(&mine, HERE, &role(1, 3), THERE), None);
        assert!(exchange(&role(1, 3), HERE, &mine, THERE).is_none());
        mine.stopped = Maybe::Just(Stop::Complete);
        assert!(exchange(&role(1, 3), HERE, &mine, THERE).is_some());
        mine.kept_out = 1;
        assert_eq!(exchange(&role(1, 3), HERE, &mine, THERE), None);
    }
}
