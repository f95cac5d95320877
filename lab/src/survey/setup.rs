//! What is flown: on screen, in an address, as a command.

use std::fmt::Write;
use std::ops::RangeInclusive;
use std::str::FromStr;

use clap::ValueEnum;
use host_sim::record::heights::Trace;
use host_sim::record::voxels::VoxelTrace;
use host_sim::scenario::heights::{Planner, Scenario};
use host_sim::scenario::{Conditions, MediumKind, voxels};
use host_sim::terrain::TerrainSource;

/// Numbers of drones.
pub const ROBOTS: RangeInclusive<u8> = 1..=32;
/// Least altitudes.
pub const ALTITUDES: RangeInclusive<f32> = 1.0..=6.0;
/// Greatest heights.
pub const CEILINGS: RangeInclusive<f32> = 20.0..=60.0;
/// Sensor ranges in cells.
pub const RANGES: RangeInclusive<u8> = 2..=12;

/// What is flown.
#[derive(Clone, Debug, PartialEq)]
pub struct SurveySetup {
    /// What is mapped.
    pub terrain: TerrainSource,
    /// Columns along a side.
    pub size: u16,
    /// How the drones decide.
    pub planner: Planner,
    /// Number of drones.
    pub robots: u8,
    /// Sensor range in cells.
    pub range: u8,
    /// Least altitude over ground, in cells.
    pub min_altitude: f32,
    /// Greatest height, in cells.
    pub ceiling: f32,
    /// What all worlds share.
    pub conditions: Conditions,
}

impl Default for SurveySetup {
    fn default() -> Self {
        Self {
            terrain: TerrainSource::Gaussian(0),
            size: 60,
            planner: Planner::CoordinatedSurvey,
            robots: 4,
            range: 8,
            min_altitude: 2.0,
            ceiling: 40.0,
            conditions: Conditions {
                medium: MediumKind::Radio,
                ..Conditions::flown(0)
            },
        }
    }
}

impl SurveySetup {
    /// The scenario over a terrain of heights.
    pub fn scenario(&self) -> Scenario {
        let mut scenario = Scenario::new(self.planner, self.robots.into(), 0);
        scenario.limits.range = self.range.into();
        scenario.limits.min_altitude = self.min_altitude;
        scenario.limits.ceiling = self.ceiling;
        scenario.conditions.clone_from(&self.conditions);
        scenario
    }

    /// The scenario in a town of voxels.
    pub fn voxel_scenario(&self) -> voxels::Scenario {
        voxels::Scenario {
            range: self.range,
            conditions: self.conditions.clone(),
            ..voxels::Scenario::new(self.robots.into(), 0)
        }
    }

    /// The setup that gives this trace, as far as the menus reach.
    pub fn of(trace: &Trace) -> Self {
        let (scenario, limits) = (&trace.scenario, trace.scenario.limits);
        let size = trace.extent.width;
        let drawn = |terrain: &TerrainSource| terrain.load(size).as_ref() == Ok(&trace.terrain);
        Self {
            terrain: drawn_as(trace.terrain.name(), drawn),
            size,
            planner: scenario.planner,
            robots: trace.robots.min(255) as u8,
            range: limits.range as u8,
            min_altitude: limits.min_altitude,
            ceiling: limits.ceiling,
            conditions: scenario.conditions.clone(),
        }
    }

    /// Whether it gives this trace.
    pub fn gives(&self, trace: &Trace) -> bool {
        self.is_drawn() && self.scenario() == trace.scenario
    }

    /// As [`of`](Self::of), among voxels.
    pub fn of_voxels(trace: &VoxelTrace) -> Self {
        let (scenario, scene) = (&trace.scenario, &trace.scene);
        let size = scene.extent().width;
        let drawn = |terrain: &TerrainSource| terrain.scene(size).as_ref() == Some(scene);
        Self {
            terrain: drawn_as(scene.name(), drawn),
            size,
            robots: scenario.robots.min(255) as u8,
            range: scenario.range,
            conditions: scenario.conditions.clone(),
            ..Self::default()
        }
    }

    /// As [`gives`](Self::gives), among voxels.
    pub fn gives_voxels(&self, trace: &VoxelTrace) -> bool {
        self.is_drawn() && self.voxel_scenario() == trace.scenario
    }

    fn is_drawn(&self) -> bool {
        !matches!(self.terrain, TerrainSource::File(_))
    }

    /// Whether it is flown among voxels.
    pub fn is_of_voxels(&self) -> bool {
        matches!(self.terrain, TerrainSource::Town(_))
    }

    /// Columns along a side: what can be drawn in time.
    pub fn sizes(&self) -> RangeInclusive<u16> {
        16..=if self.is_of_voxels() { 64 } else { 128 }
    }

    /// Every setting of its own that the terrain leaves, as names and values.
    fn settings(&self) -> Vec<(&'static str, String)> {
        let mut settings = vec![("size", self.size.to_string())];
        if !self.is_of_voxels() {
            settings.push(("planner", self.planner.to_string()));
        }
        settings.push(("robots", self.robots.to_string()));
        settings.push(("range", self.range.to_string()));
        if !self.is_of_voxels() {
            settings.push(("min-altitude", self.min_altitude.to_string()));
            settings.push(("ceiling", self.ceiling.to_string()));
        }
        settings
    }

    fn terrain_name(&self) -> String {
        match &self.terrain {
            TerrainSource::Gaussian(seed) => format!("gaussian:{seed}"),
            TerrainSource::Urban(seed) => format!("urban:{seed}"),
            TerrainSource::Town(seed) => format!("town:{seed}"),
            TerrainSource::File(path) => path.display().to_string(),
        }
    }

    /// The part of an address behind `#`: the terrain, and what differs from the
    /// defaults.
    pub fn address(&self) -> String {
        let mut address = format!("terrain={}", self.terrain_name());
        let usual = Self {
            terrain: self.terrain.clone(),
            ..Self::default()
        };
        for ((name, value), (_, usual)) in self.settings().iter().zip(usual.settings()) {
            if *value != usual {
                let _ = write!(address, "&{name}={value}");
            }
        }
        for (name, value) in self.conditions.settings(&usual.conditions) {
            let _ = write!(address, "&{name}={value}");
        }
        address
    }

    /// Whether an address is that of a survey.
    pub fn is_meant(address: &str) -> bool {
        parts(address).any(|(name, _)| name == "terrain")
    }

    /// Reads [`address`](Self::address).
    ///
    /// # Errors
    /// What is wrong with it, in a sentence for the user.
    pub fn from_address(address: &str) -> Result<Self, String> {
        let mut setup = Self::default();
        let wrong = |name, value| format!("the address: `{name}={value}` is not understood");
        for (name, value) in parts(address).filter(|(name, _)| *name == "terrain") {
            setup.terrain = match value.parse() {
                Ok(TerrainSource::File(_)) | Err(_) => return Err(wrong(name, value)),
                Ok(terrain) => terrain,
            };
        }
        let known = setup.settings();
        for (name, value) in parts(address).filter(|(name, _)| *name != "terrain") {
            let is_own = known.iter().any(|(known, _)| *known == name);
            let done = match name {
                _ if !is_own => setup.conditions.set(name, value),
                "size" => within(value, setup.sizes(), &mut setup.size),
                "planner" => Planner::from_str(value, true)
                    .ok()
                    .map(|planner| setup.planner = planner),
                "robots" => within(value, ROBOTS, &mut setup.robots),
                "range" => within(value, RANGES, &mut setup.range),
                "min-altitude" => within(value, ALTITUDES, &mut setup.min_altitude),
                "ceiling" => within(value, CEILINGS, &mut setup.ceiling),
                _ => None,
            };
            done.ok_or_else(|| wrong(name, value))?;
        }
        Ok(setup)
    }

    /// The `host-sim` line that runs the same: same trace, same digest.
    pub fn command(&self) -> String {
        let mut command = format!(
            "cargo run --release -- survey --terrain {}",
            self.terrain_name()
        );
        let usual = Self::default().conditions;
        let conditions = self.conditions.settings(&usual);
        for (name, value) in self.settings().into_iter().chain(conditions) {
            let _ = write!(command, " --{name} {value}");
        }
        command
    }
}

/// The terrain that was drawn under this name, if it is that.
fn drawn_as(name: &str, is_it: impl Fn(&TerrainSource) -> bool) -> TerrainSource {
    let drawn = name.replacen('-', ":", 1).parse().ok();
    let is_drawn = |terrain: &TerrainSource| !matches!(terrain, TerrainSource::File(_));
    drawn
        .filter(|terrain| is_drawn(terrain) && is_it(terrain))
        .unwrap_or_else(|| TerrainSource::File(name.into()))
}

/// Names and values of an address.
fn parts(address: &str) -> impl Iterator<Item = (&str, &str)> {
    let parts = address.trim_start_matches('#').split('&');
    parts
        .filter(|part| !part.is_empty())
        .map(|part| part.split_once('=').unwrap_or((part, "")))
}

/// Sets a number, if it is one and within its limits.
fn within<T: FromStr + PartialOrd>(
    value: &str,
    limits: RangeInclusive<T>,
    to: &mut T,
) -> Option<()> {
    let value = value.parse().ok().filter(|value| limits.contains(value))?;
    *to = value;
    Some(())
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    fn conditions() -> Conditions {
        Conditions {
            loss: 0.25,
            ..Conditions::flown(7)
        }
    }

    pub(in crate::survey) fn unusual() -> SurveySetup {
        SurveySetup {
            terrain: TerrainSource::Urban(3),
            size: 24,
            planner: Planner::Fcao,
            robots: 2,
            range: 6,
            min_altitude: 1.5,
            ceiling: 50.0,
            conditions: conditions(),
        }
    }

    pub(in crate::survey) fn town() -> SurveySetup {
        SurveySetup {
            terrain: TerrainSource::Town(2),
            size: 24,
            robots: 3,
            range: 6,
            conditions: conditions(),
            ..SurveySetup::default()
        }
    }

    #[test]
    fn an_address_carries_everything() {
        for setup in [SurveySetup::default(), unusual(), town()] {
            let address = setup.address();
            assert!(SurveySetup::is_meant(&address));
            assert_eq!(SurveySetup::from_address(&address), Ok(setup));
        }
        assert_eq!(SurveySetup::default().address(), "terrain=gaussian:0");
        assert!(!SurveySetup::is_meant("map=office"));
    }

    #[test]
    fn a_bad_address_says_which_part() {
        for part in [
            "terrain=moon:1",
            "terrain=/etc/passwd",
            "robots=0",
            "size=100000",
            "ceiling=NaN",
            "colour=red",
        ] {
            let error = SurveySetup::from_address(&format!("terrain=urban:1&{part}")).unwrap_err();
            assert!(error.contains(part), "{error}");
        }
        // Among voxels one planner flies, in a smaller town.
        for part in ["planner=fcao", "ceiling=30", "size=80"] {
            let error = SurveySetup::from_address(&format!("{part}&terrain=town:1")).unwrap_err();
            assert!(error.contains(part), "{error}");
        }
    }

    #[test]
    fn the_command_names_every_setting() {
        assert_eq!(
            unusual().command(),
            "cargo run --release -- survey --terrain urban:3 --size 24 --planner fcao --robots 2 \
             --range 6 --min-altitude 1.5 --ceiling 50 --medium ideal --loss 0.25 --seed 7"
        );
        assert_eq!(
            town().command(),
            "cargo run --release -- survey --terrain town:2 --size 24 --robots 3 --range 6 \
             --medium ideal --loss 0.25 --seed 7"
        );
    }
}
