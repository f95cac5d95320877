//! Surveys of a scene of voxels.

use clap::ValueEnum;
use planner_core::volume::{Field, MAX_CLEARANCE, Voxel};
use planner_core::voxel_survey::{MAX_RANGE, Sensor};
use serde::{Deserialize, Serialize};

use super::error::BodyText;
use super::{Conditions, Preset, ScenarioError, Trouble};
use crate::scene::{LARGEST, LEVELS, Scene};

/// How the robots decide.
#[derive(
    Clone,
    Copy,
    Debug,
    Default,
    PartialEq,
    Eq,
    Hash,
    PartialOrd,
    Ord,
    ValueEnum,
    Serialize,
    Deserialize,
)]
#[serde(rename_all = "kebab-case")]
pub enum Planner {
    /// The complete planner of the core.
    #[default]
    VoxelSurvey,
    /// Every robot to the nearest place that shows a frontier, chosen anew in every step.
    ClosestFrontier,
    /// A centre that knows all that anybody has seen assigns groups of frontiers to robots,
    /// the shortest way first; robots left over start another round.
    Greedy,
}

impl Planner {
    fn is_usual(&self) -> bool {
        *self == Self::default()
    }
}

impl std::fmt::Display for Planner {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let value = self.to_possible_value().expect("no value is skipped");
        f.write_str(value.get_name())
    }
}

/// What of grids applies among voxels, too.
const OPTIONS: [&str; 6] = [
    "come-home",
    "energy",
    "wind",
    "preset",
    "false-walls",
    "false-frees",
];

/// The largest radius, in voxels, of a ball that touches nothing wherever a robot is and on its
/// way, by clearance: to the nearest voxel that need not be free.
pub const ROOM: [f64; MAX_CLEARANCE as usize + 1] = [0.5, 0.707, 1.581, 2.549];

/// The least clearance for a ball of so many voxels' radius; `None`: none is enough.
pub fn clearance_for(radius: f64) -> Option<u8> {
    let fits = ROOM.iter().position(|&room| radius <= room);
    fits.map(|clearance| clearance as u8)
}

/// What a run is a function of, beside the scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scenario {
    /// How the robots decide.
    #[serde(default, skip_serializing_if = "Planner::is_usual")]
    pub planner: Planner,
    /// Number of robots, 1 to 255.
    pub robots: usize,
    /// Sensor range in voxels, 2 to 12 and more than the clearance.
    pub range: u8,
    /// Voxels that the robots' bodies reach beyond the one of their middle, 0 to 3; see
    /// [`Config::clearance`](planner_core::voxel_survey::Config::clearance).
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub clearance: u8,
    /// What of that the robots' sensors show.
    #[serde(default = "all_round", skip_serializing_if = "Field::is_whole")]
    pub field: Field,
    /// Where all robots start; [`Scene::start`] if nothing is said.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub start: Option<Voxel>,
    /// What all worlds share.
    #[serde(flatten)]
    pub conditions: Conditions,
}

impl Scenario {
    /// Range 8, no losses, and robots that share everything at once.
    pub fn new(robots: usize, seed: u64) -> Self {
        Self {
            planner: Planner::default(),
            robots,
            range: 8,
            clearance: one(),
            field: Field::ALL_ROUND,
            start: None,
            conditions: Conditions::flown(seed),
        }
    }

    /// Whether the scenario can be flown in `scene`.
    ///
    /// # Errors
    /// The first setting that is out of its range, and the range.
    pub fn check(&self, scene: &Scene) -> Result<(), ScenarioError> {
        self.conditions.check(self.robots)?;
        self.conditions.check_flown("among voxels", &OPTIONS)?;
        if self.conditions.preset == Preset::Lidar {
            let expected = "truthful or rangers among voxels";
            return Err(ScenarioError::setting("preset", Preset::Lidar, expected));
        }
        if !(2..=MAX_RANGE).contains(&self.range) {
            let expected = format!("2 to {MAX_RANGE} voxels");
            return Err(ScenarioError::setting("range", self.range, expected));
        }
        if self.clearance > MAX_CLEARANCE {
            let expected = format!("0 to {MAX_CLEARANCE} voxels");
            return Err(ScenarioError::setting(
                "clearance",
                self.clearance,
                expected,
            ));
        }
        if self.range <= self.clearance {
            let least = self.clearance + 1;
            let expected = format!(
                "{least} voxels or more, with --clearance {}",
                self.clearance
            );
            return Err(ScenarioError::setting("range", self.range, expected));
        }
        let mission = self.conditions.mission.settings().into_iter().next();
        if let Some((option, _)) = mission
            && self.planner != Planner::VoxelSurvey
        {
            return Err(ScenarioError::NotHere {
                option,
                world: "to what voxel-survey is compared with, which knows no way home",
            });
        }
        let mut errors = self.conditions.trouble.settings(&Trouble::default());
        if self.conditions.preset != Preset::Truthful {
            errors.push(("preset", String::new()));
        }
        if let Some((option, _)) = errors.into_iter().next()
            && self.planner != Planner::VoxelSurvey
        {
            return Err(ScenarioError::NotHere {
                option,
                world: "to what voxel-survey is compared with, which believes every look",
            });
        }
        if self.planner != Planner::VoxelSurvey && !self.field.is_whole() {
            return Err(ScenarioError::NotHere {
                option: "sensor",
                world: "to what voxel-survey is compared with, which sees all round",
            });
        }
        if let Some(start) = self.start {
            check_start(start, scene, self.clearance)?;
        }
        let (extent, levels) = (scene.extent(), scene.levels());
        let sides = 1..=LARGEST;
        let fits = sides.contains(&extent.width)
            && sides.contains(&extent.height)
            && (1..=LEVELS).contains(&levels);
        match fits {
            true => Ok(()),
            false => Err(ScenarioError::Scene {
                extent,
                levels,
                side: LARGEST,
                most: LEVELS,
            }),
        }
    }

    /// What the robots take their sensors for.
    pub(crate) fn sensor(&self) -> Sensor {
        match self.conditions.preset {
            Preset::Truthful => Sensor::Truthful,
            Preset::Lidar | Preset::Rangers => Sensor::Errs,
        }
    }

    /// Where the robots start in `scene`.
    ///
    /// # Errors
    /// There is no room for a robot.
    pub(crate) fn start_in(&self, scene: &Scene) -> Result<Voxel, ScenarioError> {
        let start = self.start.or_else(|| scene.start(self.clearance));
        start.ok_or(no_pose(self.clearance))
    }
}

const fn one() -> u8 {
    1
}

fn is_one(clearance: &u8) -> bool {
    *clearance == one()
}

const fn no_pose(clearance: u8) -> ScenarioError {
    ScenarioError::NoPose(BodyText(clearance))
}

const fn all_round() -> Field {
    Field::ALL_ROUND
}

/// # Errors
/// A robot has no room at `start`; with the nearest place where it has.
fn check_start(start: Voxel, scene: &Scene, clearance: u8) -> Result<(), ScenarioError> {
    if scene.is_pose(start, clearance) {
        return Ok(());
    }
    let nearest = scene.nearest_pose(start, clearance);
    let nearest = nearest.ok_or(no_pose(clearance))?;
    let (found, nearest) = match scene.frame() {
        None => (start.to_string(), nearest.to_string()),
        Some(frame) => (metres(frame.middle(start)), metres(frame.middle(nearest))),
    };
    let body = BodyText(clearance);
    Err(ScenarioError::NoRoomAt {
        found,
        body,
        nearest,
    })
}

fn metres([x, y, z]: [f64; 3]) -> String {
    format!("{x:.2},{y:.2},{z:.2}")
}
