//! Surveys of a terrain of heights.

use clap::ValueEnum;
use planner_core::survey::{Limits, MAX_RANGE};
use planner_core::{Cell, Extent, Point};
use serde::{Deserialize, Serialize};

use super::{Conditions, ScenarioError, check_share};
use crate::terrain::Terrain;

/// Shortest and longest step in cells: with a shorter one a robot gives up on its way
/// across the largest terrain.
const STEPS: std::ops::RangeInclusive<f32> = 0.1..=100.0;
/// Highest ceiling in cells: what frames can tell.
const HIGHEST: f32 = 500.0;
/// Columns between two starts, and of the first from the edge.
const APART: usize = 2;

/// Options that are of grids, too.
const OF_GRIDS: [&str; 7] = [
    "come-home",
    "energy",
    "close",
    "blind",
    "sensor-fails",
    "pose-lost",
    "wind",
];

/// How the robots decide.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Planner {
    /// Pockets, local steps judged on the map, coordinated frontiers: the fastest.
    CoordinatedSurvey,
    /// The same, its local steps by CAO's cubic.
    CoordinatedCubic,
    /// FCAO as published.
    Fcao,
    /// Every robot to the closest frontier, chosen anew in every step.
    ClosestFrontier,
    /// Every robot to the closest frontier, and to the next one when it has reached that,
    /// as published.
    ClosestUntilReached,
    /// A centre assigns groups of frontiers to robots, nearest pair first; robots left
    /// over start a second round.
    Greedy,
    /// The same without the second round: no frontier has two robots.
    GreedyUnique,
    /// A centre gives one robot after the other the nearest group that is left, one each,
    /// as published.
    GreedyInOrder,
}

impl std::fmt::Display for Planner {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let value = self.to_possible_value().expect("no value is skipped");
        f.write_str(value.get_name())
    }
}

/// Everything about a run but the terrain.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scenario {
    /// How the robots decide.
    pub planner: Planner,
    /// Number of robots, 1 to 255.
    pub robots: usize,
    /// The fleet's physics.
    #[serde(flatten)]
    pub limits: Limits,
    /// Share of a robot's steps that it sleeps through.
    pub skip: f64,
    /// What all worlds share.
    #[serde(flatten)]
    pub conditions: Conditions,
}

impl Scenario {
    /// The set-up of the comparisons: range 8, step 2, no faults, and robots that tell
    /// each other all news at once as in the paper.
    pub fn new(planner: Planner, robots: usize, seed: u64) -> Self {
        let limits = Limits {
            range: 8.0,
            step: 2.0,
            min_altitude: 2.0,
            ceiling: 40.0,
            separation: 1.0,
        };
        Self {
            planner,
            robots,
            limits,
            skip: 0.0,
            conditions: Conditions::flown(seed),
        }
    }

    /// Whether the scenario can be flown over some terrain.
    ///
    /// # Errors
    /// The first setting that is out of its range, and the range.
    pub fn check(&self) -> Result<(), ScenarioError> {
        let Limits {
            range,
            step,
            min_altitude,
            ceiling,
            separation,
        } = self.limits;
        self.conditions.check(self.robots)?;
        self.conditions
            .check_flown("over a terrain of heights", &OF_GRIDS)?;
        check_share("skip", self.skip)?;
        let within = |option, found: f32, is_good: bool, expected: String| match is_good {
            true => Ok(()),
            false => Err(ScenarioError::setting(option, found, expected)),
        };
        within(
            "range",
            range,
            range > 0.0 && range <= MAX_RANGE,
            format!("above 0 and at most {MAX_RANGE} cells"),
        )?;
        within(
            "step",
            step,
            STEPS.contains(&step),
            format!("{} to {} cells", STEPS.start(), STEPS.end()),
        )?;
        within(
            "min-altitude",
            min_altitude,
            (0.0..range).contains(&min_altitude),
            format!("0 or more, and less than the range of {range} cells, or no ground is seen"),
        )?;
        within(
            "ceiling",
            ceiling,
            ceiling > min_altitude && ceiling <= HIGHEST,
            format!("above the least altitude of {min_altitude} and at most {HIGHEST} cells"),
        )?;
        within(
            "separation",
            separation,
            (0.0..=APART as f32).contains(&separation),
            format!("0 to {APART} cells, as starts are {APART} apart"),
        )
    }

    /// Where the robots start: in the north-west corner, two cells apart, row by row of
    /// a square, one cell above the least altitude.
    ///
    /// # Errors
    /// They do not fit into the terrain, or under the ceiling, and what would; or a fault is of
    /// a column that lies outside.
    pub fn starts(&self, terrain: &Terrain) -> Result<Vec<Point>, ScenarioError> {
        let extent = terrain.extent();
        self.conditions.faults.check_cells(extent)?;
        if !fit(self.robots, extent) {
            return Err(ScenarioError::NoRoom {
                robots: self.robots,
                extent,
                most: (1..self.robots)
                    .rfind(|&most| fit(most, extent))
                    .unwrap_or(0),
            });
        }
        let altitude = self.limits.min_altitude + 1.0;
        let starts: Vec<_> = places(self.robots)
            .map(|place| {
                let ground = terrain.height(place).unwrap_or_default();
                Point::over(place, ground.cells() + altitude)
            })
            .collect();
        let ceiling = self.limits.ceiling;
        match starts.iter().position(|start| start.z > ceiling) {
            Some(robot) => Err(ScenarioError::StartTooHigh {
                robot,
                height: starts[robot].z,
                ceiling,
                needed: starts.iter().fold(0.0, |most, start| start.z.max(most)),
            }),
            None => Ok(starts),
        }
    }
}

/// The columns over which so many robots start.
fn places(robots: usize) -> impl Iterator<Item = Cell> {
    let per_row = (robots as f64).sqrt().ceil() as usize;
    let place = |index| (APART + APART * index) as i16;
    (0..robots).map(move |i| Cell::new(place(i % per_row), place(i / per_row)))
}

fn fit(robots: usize, extent: Extent) -> bool {
    places(robots).all(|place| extent.contains(place))
}

#[cfg(test)]
mod tests {
    use planner_core::surface::Height;

    use super::*;

    fn scenario(robots: usize) -> Scenario {
        Scenario::new(Planner::CoordinatedSurvey, robots, 0)
    }

    fn flat(width: u16, height: u16, ground: u8) -> Terrain {
        Terrain::from_fn(Extent::new(width, height), |_| Height(ground))
    }

    #[test]
    fn starts_lie_inside_and_under_the_ceiling_or_there_are_none() {
        for side in 1..24 {
            for robots in [1, 2, 3, 4, 5, 16, 64, 255] {
                for ground in [0, 120, 148, 152, 255] {
                    let terrain = flat(side, side.min(9), ground);
                    let scenario = scenario(robots);
                    let Ok(starts) = scenario.starts(&terrain) else {
                        continue;
                    };
                    assert_eq!(starts.len(), robots);
                    for start in starts {
                        assert!(terrain.extent().contains(start.cell()));
                        assert!(start.z <= scenario.limits.ceiling);
                        let altitude = start.z - f32::from(ground) / 4.0;
                        assert!(altitude >= scenario.limits.min_altitude);
                    }
                }
            }
        }
    }

    #[test]
    fn what_would_fit_is_said_and_fits() {
        let terrain = flat(8, 8, 0);
        let Err(ScenarioError::NoRoom { most, .. }) = scenario(16).starts(&terrain) else {
            panic!("16 robots start in 8×8 columns");
        };
        assert_eq!(most, 9);
        assert!(scenario(9).starts(&terrain).is_ok() && scenario(10).starts(&terrain).is_err());
        assert!(scenario(1).starts(&flat(2, 2, 0)).is_err());

        let high = flat(8, 8, 255);
        let mut scenario = scenario(4);
        let Err(ScenarioError::StartTooHigh { needed, .. }) = scenario.starts(&high) else {
            panic!("robots start above the ceiling");
        };
        scenario.limits.ceiling = needed;
        assert!(scenario.starts(&high).is_ok());
        scenario.limits.ceiling = needed - 0.25;
        assert!(scenario.starts(&high).is_err());
    }

    #[test]
    fn every_setting_has_a_range_that_its_error_names() {
        let bad = |change: &dyn Fn(&mut Scenario), words: &[&str]| {
            let mut scenario = scenario(2);
            change(&mut scenario);
            let error = scenario.check().unwrap_err().to_string();
            for word in words {
                assert!(error.contains(word), "{word:?} is not in {error}");
            }
        };
        assert_eq!(scenario(2).check(), Ok(()));
        for number in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, 1e9] {
            bad(&|it| it.limits.range = number, &["--range", "at most 12"]);
            bad(&|it| it.limits.step = number, &["--step", "0.1 to 100"]);
            bad(&|it| it.limits.min_altitude = number, &["--min-altitude"]);
            bad(
                &|it| it.limits.ceiling = number,
                &["--ceiling", "at most 500"],
            );
            bad(&|it| it.limits.separation = number, &["--separation"]);
            bad(
                &|it| it.conditions.loss = number.into(),
                &["--loss", "0 to 1"],
            );
            bad(&|it| it.skip = number.into(), &["--skip", "0 to 1"]);
        }
        bad(&|it| it.limits.range = 0.0, &["--range", "above 0"]);
        bad(&|it| it.limits.step = 0.0, &["--step"]);
        bad(&|it| it.limits.min_altitude = 8.0, &["range of 8"]);
        bad(&|it| it.robots = 0, &["--robots 0", "1 to 255"]);
        bad(&|it| it.robots = 256, &["--robots 256"]);
        let kill = "2@3".parse().unwrap();
        bad(
            &|it| it.conditions.faults.deaths = vec![kill],
            &["--kill", "no robot 2", "0 to 1"],
        );
    }
}
