//! Frontier cells that count as one frontier.

use super::waves::{Spot, Waves};

/// What one frontier is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Frontier {
    /// A set of 8-connected frontier cells, as in the papers.
    Component,
    /// A single frontier cell.
    Cell,
}

/// The frontiers of a map, numbered from 0.
#[derive(Debug, Default)]
pub(super) struct Groups {
    /// By spot; means something for frontier spots only.
    label: Vec<u32>,
    count: u32,
    /// Which robot has touched which frontier, at `robot · count + frontier`.
    touched: Vec<bool>,
    stack: Vec<Spot>,
}

const NONE: u32 = u32::MAX;

impl Groups {
    /// Numbers the frontiers of the map that `waves` hold.
    pub(super) fn find(&mut self, waves: &Waves, frontier: Frontier) {
        self.label.resize(waves.spots(), NONE);
        self.count = 0;
        for spot in waves.frontiers() {
            self.label[spot as usize] = NONE;
        }
        for spot in waves.frontiers() {
            if self.label[spot as usize] == NONE {
                self.label[spot as usize] = self.count;
                if frontier == Frontier::Component {
                    self.spread(waves, spot);
                }
                self.count += 1;
            }
        }
        self.touched.clear();
        self.touched.resize(waves.robots() * self.count(), false);
    }

    /// Gives the number of `spot` to all that are connected to it.
    fn spread(&mut self, waves: &Waves, spot: Spot) {
        self.stack.push(spot);
        while let Some(spot) = self.stack.pop() {
            for next in waves.around(spot) {
                if waves.is_frontier(next) && self.label[next as usize] == NONE {
                    self.label[next as usize] = self.count;
                    self.stack.push(next);
                }
            }
        }
    }

    /// Number of frontiers.
    pub(super) fn count(&self) -> usize {
        self.count as usize
    }

    /// The frontier that a frontier spot belongs to.
    pub(super) fn of(&self, spot: Spot) -> usize {
        self.label[spot as usize] as usize
    }

    /// Notes that a robot's wave has reached a frontier; whether for the first time.
    pub(super) fn touch(&mut self, robot: usize, frontier: usize) -> bool {
        let place = robot * self.count() + frontier;
        !std::mem::replace(&mut self.touched[place], true)
    }

    /// Whether a robot's wave has reached a frontier.
    pub(super) fn is_touched(&self, robot: usize, frontier: usize) -> bool {
        self.touched[robot * self.count() + frontier]
    }
}
