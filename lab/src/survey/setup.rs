//! What is flown: on screen, in an address, as a command.

use std::fmt::Write;
use std::ops::RangeInclusive;
use std::str::FromStr;

use clap::ValueEnum;
use host_sim::record::heights::Trace;
use host_sim::record::voxels::VoxelTrace;
use host_sim::scenario::heights::{Planner, Scenario};
use host_sim::scenario::{Conditions, MediumKind, Mission, Preset, Trouble, voxels};
use host_sim::scene::{Fov, Sensor};
use host_sim::terrain::TerrainSource;
use planner_core::volume::MAX_CLEARANCE;

/// Numbers of drones.
pub const ROBOTS: RangeInclusive<u8> = 1..=32;
/// Least altitudes.
pub const ALTITUDES: RangeInclusive<f32> = 1.0..=6.0;
/// Greatest heights.
pub const CEILINGS: RangeInclusive<f32> = 20.0..=60.0;
/// Sensor ranges in cells.
pub const RANGES: RangeInclusive<u8> = 2..=12;
/// Voxels that bodies reach beyond the one of their middle.
pub const CLEARANCES: RangeInclusive<u8> = 0..=MAX_CLEARANCE;

/// What is flown.
#[derive(Clone, Debug, PartialEq)]
pub struct SurveySetup {
    /// What is mapped.
    pub terrain: TerrainSource,
    /// Columns along a side.
    pub size: u16,
    /// How the drones decide over heights.
    pub planner: Planner,
    /// The same among voxels.
    pub voxel_planner: voxels::Planner,
    /// Number of drones.
    pub robots: u8,
    /// Sensor range in cells.
    pub range: u8,
    /// What the drones see of what is in range and in sight.
    pub sensor: Sensor,
    /// The image of a camera.
    pub fov: Fov,
    /// Voxels that the drones' bodies reach beyond the one of their middle.
    pub clearance: u8,
    /// Least altitude over ground, in cells.
    pub min_altitude: f32,
    /// Greatest height, in cells.
    pub ceiling: f32,
    /// What all worlds share.
    pub conditions: Conditions,
    /// Whether a place that is only in a trace is made of voxels.
    pub is_scene: bool,
}

impl Default for SurveySetup {
    fn default() -> Self {
        Self {
            terrain: TerrainSource::Gaussian(0),
            size: 60,
            planner: Planner::CoordinatedSurvey,
            voxel_planner: voxels::Planner::default(),
            robots: 4,
            range: 8,
            sensor: Sensor::default(),
            fov: Fov::default(),
            clearance: 1,
            min_altitude: 2.0,
            ceiling: 40.0,
            conditions: Conditions {
                medium: MediumKind::Radio,
                ..Conditions::flown(0)
            },
            is_scene: false,
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
            planner: self.voxel_planner,
            range: self.range,
            clearance: self.clearance,
            field: self.sensor.field_for(self.fov, self.clearance),
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
            ..Self::default()
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
        let (sensor, fov) = Sensor::of(scenario.field).unwrap_or_default();
        let terrain = drawn_as(scene.name(), drawn);
        Self {
            is_scene: matches!(terrain, TerrainSource::File(_)),
            terrain,
            size,
            voxel_planner: scenario.planner,
            robots: scenario.robots.min(255) as u8,
            range: scenario.range,
            sensor,
            fov,
            clearance: scenario.clearance,
            conditions: scenario.conditions.clone(),
            ..Self::default()
        }
    }

    /// As [`gives`](Self::gives), among voxels.
    pub fn gives_voxels(&self, trace: &VoxelTrace) -> bool {
        let said = trace.scenario.start;
        let usual = said.filter(|_| said == trace.scene.start(trace.scenario.clearance));
        let scenario = voxels::Scenario {
            start: usual,
            ..self.voxel_scenario()
        };
        self.is_drawn() && scenario == trace.scenario
    }

    /// Whether the terrain is one that can be drawn anew.
    pub fn is_drawn(&self) -> bool {
        !matches!(self.terrain, TerrainSource::File(_))
    }

    /// Whether it is flown among voxels.
    pub fn is_of_voxels(&self) -> bool {
        match self.terrain {
            TerrainSource::Town(_) => true,
            TerrainSource::File(_) => self.is_scene,
            TerrainSource::Gaussian(_) | TerrainSource::Urban(_) => false,
        }
    }

    /// Whether its planner takes more sensors than one.
    pub fn has_sensors(&self) -> bool {
        self.is_of_voxels() && self.voxel_planner == voxels::Planner::VoxelSurvey
    }

    /// Whether its planner knows the way home.
    pub fn has_mission(&self) -> bool {
        !self.is_of_voxels() || self.voxel_planner == voxels::Planner::VoxelSurvey
    }

    /// Whether looks can err, and its planner can tell.
    pub fn has_errors(&self) -> bool {
        self.is_of_voxels() && self.voxel_planner == voxels::Planner::VoxelSurvey
    }

    /// The same with looks that are right.
    #[must_use]
    pub fn without_errors(mut self) -> Self {
        self.conditions.trouble = Trouble::default();
        self.conditions.preset = Preset::default();
        self
    }

    /// The same without what does not apply.
    #[must_use]
    pub fn tidied(mut self) -> Self {
        if !self.has_sensors() {
            self.sensor = Sensor::default();
        }
        if self.sensor != Sensor::Camera {
            self.fov = Fov::default();
        }
        if self.is_of_voxels() {
            // A body has to see where it comes to next.
            self.range = self.range.max(self.clearance + 1);
        } else {
            self.clearance = Self::default().clearance;
        }
        if !self.has_mission() {
            self.conditions.mission = Mission::default();
        }
        if !self.has_errors() {
            self = self.without_errors();
        }
        if self.is_drawn() {
            self.size = self.size.min(*self.sizes().end());
        }
        self
    }

    /// Columns along a side: what can be drawn in time.
    pub fn sizes(&self) -> RangeInclusive<u16> {
        16..=if self.is_of_voxels() { 64 } else { 128 }
    }

    /// Every setting of its own that applies: name, value, whether that is not the default.
    fn settings(&self) -> Vec<(&'static str, String, bool)> {
        let usual = Self::default();
        let is_of_voxels = self.is_of_voxels();
        let mut settings = Vec::new();
        let mut say = |applies, name, value: &dyn ToString, usual: &dyn ToString| {
            let (value, usual) = (value.to_string(), usual.to_string());
            let differs = value != usual;
            settings.extend(Some((name, value, differs)).filter(|_| applies));
        };
        say(true, "size", &self.size, &usual.size);
        // The command has no name for the planner that flies if none is named.
        let (planner, first) = (&self.voxel_planner, &usual.voxel_planner);
        say(is_of_voxels && planner != first, "planner", planner, first);
        say(!is_of_voxels, "planner", &self.planner, &usual.planner);
        say(true, "robots", &self.robots, &usual.robots);
        say(is_of_voxels, "clearance", &self.clearance, &usual.clearance);
        say(true, "range", &self.range, &usual.range);
        say(self.has_sensors(), "sensor", &self.sensor, &usual.sensor);
        let has_image = self.has_sensors() && self.sensor == Sensor::Camera;
        say(has_image, "fov", &self.fov, &usual.fov);
        let (altitude, ceiling) = (&self.min_altitude, &self.ceiling);
        say(!is_of_voxels, "min-altitude", altitude, &usual.min_altitude);
        say(!is_of_voxels, "ceiling", ceiling, &usual.ceiling);
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
        let own = self.settings().into_iter().filter(|(.., differs)| *differs);
        let own = own.map(|(name, value, _)| (name, value));
        let conditions = self.conditions.settings(&Self::default().conditions);
        for (name, value) in own.chain(conditions) {
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
        let others = || parts(address).filter(|(name, _)| *name != "terrain");
        for (name, value) in others() {
            let done = setup.set(name, value);
            done.ok_or_else(|| wrong(name, value))?;
        }
        // A sensor that its planner does not take, an image without a camera.
        let known = setup.settings();
        let is_vain =
            |of: &str| ["sensor", "fov"].contains(&of) && !known.iter().any(|it| it.0 == of);
        match others().find(|(name, _)| is_vain(name)) {
            Some((name, value)) => Err(wrong(name, value)),
            None => Ok(setup),
        }
    }

    /// Sets what has this name, if it is there on this terrain and can have this value.
    fn set(&mut self, name: &str, value: &str) -> Option<()> {
        let is_of_voxels = self.is_of_voxels();
        match name {
            "size" => within(value, self.sizes(), &mut self.size),
            "planner" if is_of_voxels => chosen(value, &mut self.voxel_planner),
            "planner" => chosen(value, &mut self.planner),
            "robots" => within(value, ROBOTS, &mut self.robots),
            "range" => within(value, RANGES, &mut self.range),
            "clearance" if is_of_voxels => within(value, CLEARANCES, &mut self.clearance),
            "sensor" if is_of_voxels => chosen(value, &mut self.sensor),
            "fov" if is_of_voxels => {
                self.fov = value.parse().ok()?;
                Some(())
            }
            "min-altitude" if !is_of_voxels => within(value, ALTITUDES, &mut self.min_altitude),
            "ceiling" if !is_of_voxels => within(value, CEILINGS, &mut self.ceiling),
            _ => self.conditions.set(name, value),
        }
    }

    /// The `host-sim` line that runs the same: same trace, same digest.
    pub fn command(&self) -> String {
        let mut command = format!(
            "cargo run --release -- survey --terrain {}",
            self.terrain_name()
        );
        let own = self.settings().into_iter();
        let own = own.map(|(name, value, _)| (name, value));
        let conditions = self.conditions.settings(&Self::default().conditions);
        for (name, value) in own.chain(conditions) {
            let _ = write!(command, " --{name}");
            if !value.is_empty() {
                let _ = write!(command, " {value}");
            }
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

/// Sets one of several, if it is named so.
fn chosen<T: ValueEnum>(value: &str, to: &mut T) -> Option<()> {
    *to = T::from_str(value, true).ok()?;
    Some(())
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
    use host_sim::scenario::Wind;

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
            ..SurveySetup::default()
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

    /// Home, in time, through wind.
    fn homing() -> Conditions {
        Conditions {
            mission: Mission {
                come_home: true,
                energy: 2000,
            },
            wind: Wind { deviation: 0.2 },
            ..conditions()
        }
    }

    /// The same over heights.
    pub(in crate::survey) fn blown() -> SurveySetup {
        SurveySetup {
            conditions: homing(),
            ..unusual()
        }
    }

    /// The same among voxels, by drones that are as small as they can be.
    pub(in crate::survey) fn blown_about_rooms() -> SurveySetup {
        SurveySetup {
            clearance: 0,
            conditions: homing(),
            ..town()
        }
    }

    /// Wide drones that see ahead.
    fn wide() -> SurveySetup {
        SurveySetup {
            clearance: 2,
            ..filmed()
        }
    }

    pub(in crate::survey) fn filmed() -> SurveySetup {
        SurveySetup {
            sensor: Sensor::Camera,
            fov: Fov::new(100, 60).unwrap(),
            ..town()
        }
    }

    /// By looks that err, which the drones expect.
    pub(in crate::survey) fn misled() -> SurveySetup {
        SurveySetup {
            conditions: Conditions {
                trouble: Trouble {
                    false_walls: 0.01,
                    false_frees: 0.01,
                    ..Trouble::default()
                },
                preset: Preset::Rangers,
                ..conditions()
            },
            ..town()
        }
    }

    /// By what the planner of the core is compared with.
    pub(in crate::survey) fn compared() -> SurveySetup {
        SurveySetup {
            voxel_planner: voxels::Planner::Greedy,
            ..town()
        }
    }

    /// One of each kind.
    pub(in crate::survey) fn all() -> [SurveySetup; 9] {
        let hills = SurveySetup {
            size: 24,
            ..SurveySetup::default()
        };
        [
            hills,
            unusual(),
            blown(),
            town(),
            filmed(),
            wide(),
            compared(),
            blown_about_rooms(),
            misled(),
        ]
    }

    #[test]
    fn an_address_carries_everything() {
        for setup in all() {
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
        // What does not apply: other planners fly among voxels, in a smaller town.
        for (terrain, part) in [
            ("town:1", "planner=fcao"),
            ("town:1", "ceiling=30"),
            ("town:1", "size=80"),
            ("town:1", "sensor=radar"),
            ("town:1", "fov=90x60"),
            ("town:1&sensor=camera", "fov=9x60"),
            ("town:1&sensor=lidar", "fov=90x60"),
            ("town:1&planner=greedy", "sensor=camera"),
            ("urban:1", "planner=voxel-survey"),
            ("urban:1", "sensor=camera"),
            ("urban:1", "clearance=0"),
            ("town:1", "clearance=4"),
        ] {
            let address = format!("{part}&terrain={terrain}");
            let error = SurveySetup::from_address(&address).unwrap_err();
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
            "cargo run --release -- survey --terrain town:2 --size 24 --robots 3 --clearance 1 \
             --range 6 --sensor all-round --medium ideal --loss 0.25 --seed 7"
        );
        assert_eq!(
            filmed().command(),
            "cargo run --release -- survey --terrain town:2 --size 24 --robots 3 --clearance 1 \
             --range 6 --sensor camera --fov 100x60 --medium ideal --loss 0.25 --seed 7"
        );
        for (setup, body) in [(blown(), ""), (blown_about_rooms(), " --clearance 0")] {
            let command = setup.command();
            assert!(command.contains(body), "{command}");
            assert!(
                command.ends_with(" --come-home --energy 2000 --wind 0.2"),
                "{command}"
            );
        }
        let elsewhere = SurveySetup {
            terrain: TerrainSource::Town(2),
            voxel_planner: voxels::Planner::Greedy,
            ..blown()
        };
        assert!(!elsewhere.tidied().command().contains("--energy"));
        let errors = " --preset rangers";
        let command = misled().command();
        assert!(command.contains(" --false-walls 0.01 --false-frees 0.01"));
        assert!(command.contains(errors), "{command}");
        for elsewhere in [
            SurveySetup {
                terrain: TerrainSource::Urban(2),
                ..misled()
            },
            SurveySetup {
                voxel_planner: voxels::Planner::Greedy,
                ..misled()
            },
        ] {
            assert!(!elsewhere.tidied().command().contains(errors));
        }
        assert_eq!(
            compared().command(),
            "cargo run --release -- survey --terrain town:2 --size 24 --planner greedy --robots 3 \
             --clearance 1 --range 6 --medium ideal --loss 0.25 --seed 7"
        );
    }
}
