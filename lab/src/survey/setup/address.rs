//! A setup in an address, and as a command.

use std::fmt::Write;
use std::ops::RangeInclusive;
use std::str::FromStr;

use clap::ValueEnum;
use host_sim::scene::Sensor;
use host_sim::terrain::TerrainSource;

use super::{ALTITUDES, CEILINGS, CLEARANCES, RANGES, ROBOTS, SurveySetup};

impl SurveySetup {
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
mod tests {
    use host_sim::scenario::voxels;

    use super::super::tests::*;
    use super::*;

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
