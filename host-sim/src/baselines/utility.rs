//! The frontier from which much is new and that is not far.

use planner_core::{Cell, RobotId, sight};

use super::peer::{Rule, Term};
use super::waves::{Spot, Waves};

/// The frontier cell of largest A·exp(−L/R) [GonzalezBanos2002 §4]: A unknown cells are in
/// sight of it within R, as far as the known obstacles tell, and it is L steps away. R is
/// the farthest that the robot has seen so far. Every robot for itself; meant for one with
/// a long sensor.
#[derive(Clone, Copy, Debug)]
pub struct Utility;

impl Rule for Utility {
    fn term(&self) -> Term {
        Term::PAPER
    }

    fn assign(&mut self, waves: &mut Waves, _team: &[(RobotId, Cell)]) -> Option<Spot> {
        let me = waves.me();
        let reach = waves.reach().max(1);
        let most = (2.0 * f64::from(reach) + 1.0).powi(2);
        let each_step = exp(-1.0 / f64::from(reach));
        let mut weight = 1.0;
        let mut best = None;
        while !waves.layer(me).is_empty() {
            let found = best.map_or(0.0, |(utility, _)| utility);
            if most * weight <= found {
                break;
            }
            for &spot in waves.layer(me) {
                if waves.is_frontier(spot) {
                    let area = unknown_in_sight(waves, waves.cell(spot), reach);
                    let utility = f64::from(area) * weight;
                    // The nearest of those with nothing in sight, too.
                    if best.is_none_or(|(found, _)| utility > found) {
                        best = Some((utility, spot));
                    }
                }
            }
            waves.advance(me);
            weight *= each_step;
        }
        best.map(|(_, spot)| spot)
    }
}

fn unknown_in_sight(waves: &Waves, from: Cell, reach: u8) -> u32 {
    let seen = sight::look_far(from, reach, |cell| waves.is_obstacle(cell));
    seen.free_cells()
        .filter(|&cell| waves.is_unknown(cell))
        .count() as u32
}

/// e^x for x from -1 to 0, by sums and products alone: the same on every machine.
fn exp(x: f64) -> f64 {
    (1..20)
        .rev()
        .fold(1.0, |sum, n| 1.0 + sum * x / f64::from(n))
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_exponential_is_that_of_the_library() {
        for n in 1..=100 {
            let x = -1.0 / f64::from(n);
            assert!((super::exp(x) - x.exp()).abs() < 1e-15);
        }
    }
}
