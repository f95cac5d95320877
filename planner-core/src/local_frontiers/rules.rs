//! The published rules, one tick of them.

use super::view::Window;
use super::{Goal, LocalFrontiers, Phase};
use crate::cell::{Cell, Direction};
use crate::robot::{Action, Stop};

impl<const TW: usize, const TH: usize> LocalFrontiers<TW, TH> {
    /// One round of the algorithm; step 1, the marking of what is visible, is
    /// [`observe`](crate::Planner::observe).
    pub(super) fn decide(&mut self) -> Action {
        let closed = self.closed.iter();
        let mut window = Window::new(&self.view, &self.map, closed, self.position);
        let pursued = self.pursued(&mut window);
        self.work = window.work;
        self.goal = pursued.map(|(goal, _)| goal);
        match pursued {
            Some((_, step)) => {
                // [Gauville2019 §6.1 step 2b i]: a frontier is in view again.
                self.phase = Phase::Exploring;
                // [Gauville2019 §3.2 step 3a]
                self.trace.mark(self.position);
                // [Gauville2019 §3.2 step 3b]
                self.map.stand(self.position);
                // [Gauville2019 §3.2 step 3c]
                Action::Move(step)
            }
            None => self.without_frontier(),
        }
    }

    /// The goal, kept or new, and the first step towards it.
    fn pursued(&self, window: &mut Window) -> Option<(Goal, Direction)> {
        let is_frontier = |cell| self.config.neighbourhood.is_frontier(&self.map, cell);
        let goal = self.goal.filter(|goal| {
            goal.cell != self.position && (!self.config.drop_resolved || is_frontier(goal.cell))
        });
        let expired = |goal: &Goal| goal.moves >= self.config.d_max;
        goal.filter(|goal| !expired(goal))
            .and_then(|goal| self.towards(goal, window))
            // [Gauville2019 §3.2 step 2a]
            .or_else(|| {
                let goal = self.farthest_frontier(window)?;
                self.towards(goal, window)
            })
            .or_else(|| {
                let goal = goal.filter(expired)?;
                let kept = self.config.keep_expired && is_frontier(goal.cell);
                kept.then(|| self.towards(goal, window))?
            })
    }

    /// The frontier cell in view that is farthest from any visited cell
    /// [Gauville2019 §3.2 step 2a]. Robot 0 takes the nearest of equals, the others
    /// in turn.
    fn farthest_frontier(&self, window: &mut Window) -> Option<Goal> {
        let frontiers = window.frontiers(&self.map, self.config.neighbourhood);
        let visited = window.visited(&self.map);
        let mut work = 0;
        let cell = window.best_reached(self.position, &frontiers, self.id.0, |cell| {
            visited.distance(cell, self.config.distance, &mut work)
        });
        window.work += work;
        cell.map(|cell| Goal { cell, moves: 0 })
    }

    /// The first step of a shortest way to the goal among the cells in view (the
    /// paper takes A*; a breadth-first wave finds a way of the same length), or to
    /// the cell in view that is nearest to it [Gauville2019 §3.2 step 3c].
    fn towards(&self, goal: Goal, window: &mut Window) -> Option<(Goal, Direction)> {
        let own = self.position;
        let direct = window
            .is_open(goal.cell)
            .then(|| window.first_step(own, goal.cell));
        let step = direct.flatten().or_else(|| {
            let open = window.open();
            let near = |cell: Cell| u32::MAX - cell.distance_squared(goal.cell);
            let target = self
                .config
                .approach_hidden
                .then(|| window.best_reached(own, &open, 0, near))
                .flatten()
                .filter(|&target| near(target) > near(own))?;
            window.first_step(own, target)
        })?;
        Some((goal, step))
    }

    /// What to do with no frontier in view.
    fn without_frontier(&mut self) -> Action {
        let frontiers = self.map.frontiers();
        let at_start = self.position == self.start;
        let again = self.config.second_chance && self.others.anybody_explores();
        if again && (at_start || self.phase == Phase::SecondChance) {
            // [Gauville2019 §6.1 step 2b i]
            if self.phase == Phase::Exploring {
                log!(info, "robot {}: leaves its start again", self.id.0);
            }
            self.phase = Phase::SecondChance;
            self.trace.mark(self.position);
            self.go_or_stop(self.step_after_others(), Stop::NoTrace { frontiers })
        } else if self.closed.is_patient() {
            Action::Wait
        } else if at_start {
            // [Gauville2019 §3.2 step 2b], [Gauville2019 §6.1 step 2b ii]
            self.go_or_stop(None, Stop::BackAtStart { frontiers })
        } else {
            // [Gauville2019 §3.2 step 2c]. On its way home from a second chance a
            // robot stays in that mode: nobody shall set out because of it.
            self.go_or_stop(self.step_back(), Stop::NoTrace { frontiers })
        }
    }

    /// The neighbour of the lowest rank on the own trace [Gauville2019 §3.2 step 2c].
    /// From a cell with a rank always a lower one: without obstacles and closed
    /// cells there is one.
    fn step_back(&self) -> Option<Direction> {
        let own = self.trace.rank(self.position);
        Direction::ALL
            .into_iter()
            .map(|direction| (self.trace.rank(self.position.step(direction)), direction))
            .filter(|&(rank, _)| rank > 0 && (own == 0 || rank < own))
            .filter(|&(_, direction)| self.is_passable(direction))
            .min_by_key(|&(rank, _)| rank)
            .map(|(_, direction)| direction)
    }

    /// A neighbour that somebody has visited, rather one that the robot itself
    /// has not [Gauville2019 §6.1 step 2b i].
    fn step_after_others(&self) -> Option<Direction> {
        const LEFT_STRAIGHT_RIGHT_BACK: [u8; 4] = [3, 0, 1, 2];
        let visited = || {
            LEFT_STRAIGHT_RIGHT_BACK
                .into_iter()
                .map(|turn| Direction::from_index(self.heading as u8 + turn))
                .filter(|&direction| {
                    self.map.is_visited(self.position.step(direction))
                        && self.is_passable(direction)
                })
        };
        visited()
            .find(|&direction| self.trace.rank(self.position.step(direction)) == 0)
            .or_else(|| visited().next())
    }

    fn is_passable(&self, direction: Direction) -> bool {
        let cell = self.position.step(direction);
        self.map.is_free(cell) && !self.closed.contains(cell)
    }

    /// Makes the step. Without one: waits for closed cells to open, since the way
    /// or a frontier may lie behind them, and otherwise stops.
    fn go_or_stop(&mut self, step: Option<Direction>, reason: Stop) -> Action {
        match step {
            Some(direction) => Action::Move(direction),
            None if !self.closed.is_empty() => Action::Wait,
            None => self.stop(reason),
        }
    }

    /// Stops for good, for the given reason or a better one.
    pub(super) fn stop(&mut self, reason: Stop) -> Action {
        let nothing_left = self.map.frontiers() == 0 && self.map.is_free(self.position);
        let stop = if nothing_left {
            Stop::nothing_left(self.map.free_edge_cells())
        } else {
            reason
        };
        log!(
            info,
            "robot {}: stops at {}: {}",
            self.id.0,
            self.position,
            stop
        );
        self.goal = None;
        self.phase = Phase::Stopped(stop);
        Action::Stop(stop)
    }
}
