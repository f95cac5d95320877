//! What a run is a pure function of: [`Conditions`] that all worlds share, and the rest for
//! each kind of world.

mod air;
mod arguments;
mod error;
mod faults;
pub mod grid;
pub mod heights;
mod key;
mod motion;
mod trouble;
pub mod voxels;
mod wind;

use planner_core::radio::{Key, LinkConfig, MAX_LEN};
use serde::{Deserialize, Serialize};

pub use crate::limits::{Area, Limits, LimitsArgs};
pub use crate::mission::{Mission, MissionArgs};
pub use crate::saves::{Save, SaveError};
pub use air::{AirFaults, Forger, Forgery, MediumKind, Partition, Reach};
pub use arguments::{ConditionsArgs, LinkArgs, parse_share};
pub use error::ScenarioError;
pub use faults::{CellSpan, Event, FaultText, Faults, RobotSpan};
pub use motion::{Drive, Motion, MotionArgs};
pub use trouble::{ErrorKind, Preset, Trouble, TroubleArgs};
pub use wind::Wind;

/// Ten frames of 55 bytes: with 30 % of them lost, eight robots take hardly longer.
const FLOWN_BYTE_BUDGET: u16 = 550;
/// Steps after which a survey is given up unless said otherwise.
const FLOWN_MAX_TICKS: u32 = 20_000;

/// What a fleet works under, in every kind of world. A step of a flight is a tick.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Conditions {
    /// What carries what robots tell each other.
    pub medium: MediumKind,
    /// Ticks between two exchanges among robots; 0: never.
    #[serde(default = "every_tick")]
    pub sync: u32,
    /// Bytes that a robot may send by radio in a tick on average. Less than a
    /// frame: it sends one every few ticks.
    pub byte_budget: u16,
    /// Share of messages lost, 0 to 1.
    pub loss: f64,
    /// What else goes wrong in the air.
    #[serde(default)]
    pub air: AirFaults,
    /// The fleet's secret, with which frames are signed; written nowhere.
    #[serde(skip)]
    pub key: Option<Key>,
    /// Seed of all chance in the run.
    pub seed: u64,
    /// The run ends after this many ticks.
    pub max_ticks: u32,
    /// What goes wrong with robots, cells and senses.
    #[serde(flatten)]
    pub faults: Faults,
    /// How the world misleads robots.
    #[serde(default, skip_serializing_if = "Trouble::is_none")]
    pub trouble: Trouble,
    /// The robots' model of their sensors.
    #[serde(default, skip_serializing_if = "is_usual")]
    pub preset: Preset,
    /// What robots are sent out with.
    #[serde(default, skip_serializing_if = "Mission::is_none")]
    pub mission: Mission,
    /// What robots keep out of.
    #[serde(default, skip_serializing_if = "Limits::is_none")]
    pub limits: Limits,
    /// What pushes robots in the air.
    #[serde(default, skip_serializing_if = "Wind::is_none")]
    pub wind: Wind,
}

fn is_usual(preset: &Preset) -> bool {
    *preset == Preset::default()
}

const fn every_tick() -> u32 {
    1
}

impl Conditions {
    /// The ideal medium with an exchange in every tick, a frame a tick on the radio, and
    /// no faults.
    pub fn new(seed: u64, max_ticks: u32) -> Self {
        Self {
            medium: MediumKind::Ideal,
            sync: every_tick(),
            byte_budget: MAX_LEN as u16,
            loss: 0.0,
            air: AirFaults::default(),
            key: None,
            seed,
            max_ticks,
            faults: Faults::default(),
            trouble: Trouble::default(),
            preset: Preset::default(),
            mission: Mission::default(),
            limits: Limits::default(),
            wind: Wind::default(),
        }
    }

    /// The same for fleets that fly: ten frames a step, and 20,000 steps.
    pub fn flown(seed: u64) -> Self {
        Self {
            byte_budget: FLOWN_BYTE_BUDGET,
            ..Self::new(seed, FLOWN_MAX_TICKS)
        }
    }

    /// Takes out what only frames have, for the ideal medium.
    pub fn without_frames(self) -> Self {
        Self {
            medium: MediumKind::Ideal,
            air: AirFaults {
                duplication: 0.0,
                delay: 0,
                corruption: 0.0,
                forger: None,
                ..self.air
            },
            key: None,
            ..self
        }
    }

    /// How a robot uses the radio.
    pub fn link(&self) -> LinkConfig {
        LinkConfig {
            bytes_per_tick: self.byte_budget,
            key: self.key,
            ..LinkConfig::new()
        }
    }

    /// Whether so many robots can work under them.
    ///
    /// # Errors
    /// The first setting that is out of its range or does not apply.
    pub fn check(&self, robots: usize) -> Result<(), ScenarioError> {
        if !(1..=255).contains(&robots) {
            return Err(ScenarioError::setting("robots", robots, "1 to 255"));
        }
        check_share("loss", self.loss)?;
        check_share("duplicate", self.air.duplication)?;
        check_share("corrupt", self.air.corruption)?;
        self.trouble.check()?;
        self.wind.check()?;
        if let Some(option) = self.of_frames().next()
            && self.medium != MediumKind::Radio
        {
            return Err(ScenarioError::NoFrames(option));
        }
        let mut named = self.faults.robots();
        match named.find(|(_, robot)| usize::from(robot.0) >= robots) {
            Some((option, robot)) => Err(ScenarioError::NoSuchRobot {
                option,
                robot: robot.0,
                last: robots - 1,
            }),
            None => Ok(()),
        }
    }

    /// The settings in use that only frames have.
    fn of_frames(&self) -> impl Iterator<Item = &'static str> {
        let air = &self.air;
        let settings = [
            ("duplicate", air.duplication > 0.0),
            ("delay", air.delay > 0),
            ("corrupt", air.corruption > 0.0),
            ("forge", air.forger.is_some()),
            ("key", self.key.is_some()),
        ];
        let used = settings.into_iter().filter(|(_, is_used)| *is_used);
        used.map(|(option, _)| option)
    }

    /// Nothing that is of cells or poses of a grid but those options that `world` `has`, too.
    fn check_flown(&self, world: &'static str, has: &[&str]) -> Result<(), ScenarioError> {
        let faults = &self.faults;
        let of_grids = [
            ("close", !faults.closures.is_empty()),
            ("shut", !faults.shut.is_empty()),
            ("preset", !is_usual(&self.preset)),
            ("blind", !faults.blind.is_empty()),
            ("sensor-fails", !faults.sensor_failures.is_empty()),
            ("pose-lost", !faults.lost_poses.is_empty()),
        ];
        let used = of_grids.into_iter().filter(|(_, is_used)| *is_used);
        let mut settings = self.trouble.settings(&Trouble::default());
        settings.extend(self.mission.settings());
        settings.extend(self.wind.settings());
        settings.extend(self.limits.settings());
        let named = settings.iter().map(|(option, _)| *option);
        let mut all = used.map(|(option, _)| option).chain(named);
        match all.find(|option| !has.contains(option)) {
            Some("preset") => {
                let expected = format!(
                    "truthful {world}, where no look errs; rangers is for voxels, in town:SEED or \
                     a --scene FILE"
                );
                Err(ScenarioError::setting("preset", self.preset, expected))
            }
            Some(option) => Err(ScenarioError::NotHere { option, world }),
            None => Ok(()),
        }
    }
}

/// A share that is one.
fn check_share(option: &'static str, share: f64) -> Result<(), ScenarioError> {
    match (0.0..=1.0).contains(&share) {
        true => Ok(()),
        false => Err(ScenarioError::setting(option, share, "a share from 0 to 1")),
    }
}
