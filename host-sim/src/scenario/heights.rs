//! Surveys of a terrain of heights.

use clap::ValueEnum;
use planner_core::surface::MAX_CLEARANCE;
use planner_core::survey::{Limits, MAX_RANGE};
use planner_core::{Cell, Point};
use serde::{Deserialize, Serialize};

use super::{Conditions, ScenarioError, check_share};
use crate::terrain::Terrain;

/// Shortest and longest step in cells: with a shorter one a robot gives up on its way
/// across the largest terrain.
const STEPS: std::ops::RangeInclusive<f32> = 0.1..=100.0;
/// Highest ceiling in cells: what frames can tell.
const HIGHEST: f32 = 500.0;
/// Columns between two starts, and of the first from the edge.
const APART: u8 = 2;

/// The largest radius of a body, in columns, by clearance.
pub const ROOM: [f64; MAX_CLEARANCE as usize + 1] = [0.0, 1.0, 2.0, 3.0];

/// The least clearance for a body with a radius of so many columns; `None`: none is enough.
pub fn clearance_for(radius: f64) -> Option<u8> {
    let fits = ROOM.iter().position(|&room| radius <= room);
    fits.map(|clearance| clearance as u8)
}

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
            clearance: 0,
        };
        Self {
            planner,
            robots,
            limits,
            skip: 0.0,
            conditions: Conditions::flown(seed),
        }
    }

    /// The same with robots of this clearance, which keep as much apart and above ground as
    /// that takes.
    pub fn with_clearance(mut self, clearance: u8) -> Self {
        let radius = f32::from(clearance);
        let limits = &mut self.limits;
        limits.clearance = clearance;
        limits.min_altitude = limits.min_altitude.max(radius);
        limits.separation = limits.separation.max(2.0 * radius);
        self
    }

    /// The steepest slope, rise a column along a row or down a column, on which wide robots see
    /// from where they cruise all ground that is under them a column on; over steeper ground they
    /// search long, and leave some unseen. `None` of robots without a width.
    pub fn slope(&self) -> Option<f32> {
        let Limits {
            range, clearance, ..
        } = self.limits;
        let radius = f32::from(clearance);
        let across = (radius + 1.0) * std::f32::consts::SQRT_2;
        let down = (range * range - across * across).max(0.0).sqrt();
        let drop = down - self.limits.cruise(0.0);
        (clearance > 0).then_some((drop / (2.0 * radius + 1.0)).max(0.0))
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
            clearance,
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
        if clearance > MAX_CLEARANCE {
            let expected = format!("0 to {MAX_CLEARANCE} columns");
            return Err(ScenarioError::setting("clearance", clearance, expected));
        }
        let (radius, apart) = (f32::from(clearance), apart(clearance));
        within(
            "min-altitude",
            min_altitude,
            min_altitude >= radius,
            format!("{radius} or more, with --clearance {clearance}, or bodies touch the ground"),
        )?;
        // From where robots start, over level ground, to the corner of a body a column on.
        let corner = (min_altitude + 1.0).hypot((radius + 1.0) * std::f32::consts::SQRT_2);
        let corner = (100.0 * corner).ceil() / 100.0;
        within(
            "range",
            range,
            clearance == 0 || range >= corner,
            format!(
                "{corner} cells or more, with --clearance {clearance} and --min-altitude \
                 {min_altitude}, or the ground under bodies is not seen"
            ),
        )?;
        within(
            "separation",
            separation,
            (2.0 * radius..=f32::from(apart)).contains(&separation),
            format!(
                "{} to {apart} cells, as bodies must not touch and starts are {apart} apart",
                2.0 * radius
            ),
        )
    }

    /// Where the robots start: in the north-west corner, two cells or the columns of a body apart,
    /// row by row of a square, one cell above the least altitude.
    ///
    /// # Errors
    /// They do not fit into the terrain, or under the ceiling, and what would; or a fault is of
    /// a column that lies outside.
    pub fn starts(&self, terrain: &Terrain) -> Result<Vec<Point>, ScenarioError> {
        let extent = terrain.extent();
        self.conditions.faults.check_cells(extent)?;
        let clearance = self.limits.clearance;
        let fit = |robots| fit(robots, clearance, terrain);
        if !fit(self.robots) {
            return Err(ScenarioError::NoRoom {
                robots: self.robots,
                apart: apart(clearance),
                extent,
                most: (1..self.robots).rfind(|&most| fit(most)).unwrap_or(0),
            });
        }
        let altitude = self.limits.min_altitude + 1.0;
        let starts: Vec<_> = places(self.robots, clearance)
            .map(|place| {
                let ground = terrain.under(place, clearance).unwrap_or_default();
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
fn places(robots: usize, clearance: u8) -> impl Iterator<Item = Cell> {
    let per_row = (robots as f64).sqrt().ceil() as usize;
    let first = usize::from(APART.max(clearance));
    let apart = usize::from(apart(clearance));
    let place = move |index: usize| (first + apart * index) as i16;
    (0..robots).map(move |i| Cell::new(place(i % per_row), place(i / per_row)))
}

/// Columns from one start to the next: more than bodies keep apart, or those that start would hold
/// each other up.
fn apart(clearance: u8) -> u8 {
    let width = clearance.saturating_mul(2).saturating_add(1);
    APART.max(width)
}

fn fit(robots: usize, clearance: u8, terrain: &Terrain) -> bool {
    places(robots, clearance).all(|place| terrain.under(place, clearance).is_some())
}

#[cfg(test)]
mod tests {
    use planner_core::Extent;
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
    fn bodies_start_where_they_have_room_and_apart() {
        for side in 1..40 {
            for (robots, clearance) in [(1, 1), (1, 3), (2, 1), (4, 2), (9, 3)] {
                let terrain = Terrain::from_fn(Extent::new(side, side), |cell| {
                    Height((cell.x * 5 + cell.y * 3) as u8 % 16)
                });
                let scenario = scenario(robots).with_clearance(clearance);
                assert_eq!(scenario.check(), Ok(()));
                let starts = match scenario.starts(&terrain) {
                    Ok(starts) => starts,
                    Err(ScenarioError::NoRoom { most, .. }) => {
                        assert!(most < robots && side < 24, "{most}");
                        continue;
                    }
                    Err(error) => panic!("{error}"),
                };
                let radius = f32::from(clearance);
                for (number, start) in starts.iter().enumerate() {
                    let ground = terrain.under(start.cell(), clearance).unwrap();
                    assert!(start.z - ground.cells() > radius);
                    let others = starts.iter().skip(number + 1);
                    assert!(
                        others
                            .into_iter()
                            .all(|other| { other.plan_distance(*start) > 2.0 * radius })
                    );
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
        bad(&|it| it.limits.clearance = 4, &["--clearance 4", "0 to 3"]);
        let wide = scenario(2).with_clearance(3);
        let bad_wide = |change: &dyn Fn(&mut Scenario), words: &[&str]| {
            bad(
                &|it| {
                    *it = wide.clone();
                    change(it);
                },
                words,
            );
        };
        bad_wide(
            &|it| it.limits.min_altitude = 2.5,
            &["--min-altitude 2.5", "3 or more"],
        );
        bad_wide(
            &|it| it.limits.separation = 5.0,
            &["--separation 5", "6 to 7"],
        );
        bad_wide(
            &|it| it.limits.range = 6.0,
            &["--range 6", "6.93", "--clearance 3"],
        );
        bad(&|it| it.robots = 0, &["--robots 0", "1 to 255"]);
        bad(&|it| it.robots = 256, &["--robots 256"]);
        let kill = "2@3".parse().unwrap();
        bad(
            &|it| it.conditions.faults.deaths = vec![kill],
            &["--kill", "no robot 2", "0 to 1"],
        );
    }
}
