//! Wind: robots in the air come to be elsewhere than they flew to.

use planner_core::RobotId;
use serde::{Deserialize, Serialize};

use super::ScenarioError;
use crate::dice::Lot;

/// Sets gusts apart from whatever else follows from the seed.
const GUSTS: u64 = 0x5749_4e44;

/// Wind, in which every flight and every hover ends off where it should. None by default; in
/// the air only. A robot knows where it has come to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Wind {
    /// How far off along each axis, in cells: the standard deviation, 0 to 1.
    pub deviation: f64,
}

impl Wind {
    /// Whether the air is calm.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }

    /// What is set, as names and values of options.
    pub(super) fn settings(&self) -> Option<(&'static str, String)> {
        (!self.is_none()).then(|| ("wind", self.deviation.to_string()))
    }

    pub(super) fn check(&self) -> Result<(), ScenarioError> {
        match (0.0..=1.0).contains(&self.deviation) {
            true => Ok(()),
            false => {
                let expected = "0 to 1 cells along each axis";
                Err(ScenarioError::setting("wind", self.deviation, expected))
            }
        }
    }

    /// How far off `robot` ends in this tick of a run with this seed: along x, y and z, normally
    /// distributed, nearly, by sums alone, so that it is the same on every machine.
    pub(crate) fn gust(&self, seed: u64, tick: u32, robot: RobotId) -> [f64; 3] {
        let lot = Lot::new(seed ^ GUSTS);
        let lot = lot.of(tick.into()).of(robot.0.into());
        [0, 1, 2].map(|axis| {
            let lot = lot.of(axis);
            let sum: f64 = (0..12).map(|number| lot.of(number).unit()).sum();
            self.deviation * (sum - 6.0)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gusts_have_the_deviation_that_was_asked_for() {
        let wind = Wind { deviation: 0.3 };
        let gusts = (0..4000).map(|tick| wind.gust(7, tick, RobotId(tick as u8)));
        let all: Vec<f64> = gusts.flatten().collect();
        let mean = all.iter().sum::<f64>() / all.len() as f64;
        let square = all.iter().map(|it| it * it).sum::<f64>() / all.len() as f64;
        assert!(
            mean.abs() < 0.02 && (square.sqrt() - 0.3).abs() < 0.02,
            "{mean} {square}"
        );
        assert_eq!(wind.gust(7, 3, RobotId(1)), wind.gust(7, 3, RobotId(1)));
        assert_eq!(Wind::default().gust(7, 3, RobotId(1)), [0.0; 3]);
    }
}
