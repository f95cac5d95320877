//! The nearest frontier.

use planner_core::{Cell, RobotId};

use super::peer::{Rule, Term};
use super::waves::{Spot, Waves};

/// α_ij = 1 for the frontier j of least cost C_ij [Yamauchi1997; Bautin2011,
/// "Closest frontier"]: every robot for itself.
#[derive(Clone, Copy, Debug)]
pub struct Closest;

impl Rule for Closest {
    fn term(&self) -> Term {
        Term::PAPER
    }

    fn assign(&mut self, waves: &mut Waves, _team: &[(RobotId, Cell)]) -> Option<Spot> {
        let me = waves.me();
        loop {
            let layer = waves.layer(me);
            if let Some(&goal) = layer.iter().find(|&&spot| waves.is_frontier(spot)) {
                return Some(goal);
            }
            if layer.is_empty() {
                return None;
            }
            waves.advance(me);
        }
    }
}
