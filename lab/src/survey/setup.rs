//! What is flown: on screen, in an address, as a command.

use std::fmt::Write;
use std::ops::RangeInclusive;
use std::str::FromStr;

use clap::ValueEnum;
use host_sim::medium::MediumKind;
use host_sim::survey::{Planner, Scenario, TerrainSource};

/// Columns along a side: what can be drawn in time.
pub const SIZES: RangeInclusive<u16> = 16..=128;
/// Numbers of drones.
pub const ROBOTS: RangeInclusive<u8> = 1..=32;
/// Least altitudes.
pub const ALTITUDES: RangeInclusive<f32> = 1.0..=6.0;
/// Greatest heights.
pub const CEILINGS: RangeInclusive<f32> = 20.0..=60.0;

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
    /// Least altitude over ground, in cells.
    pub min_altitude: f32,
    /// Greatest height, in cells.
    pub ceiling: f32,
    /// How drones tell each other what they know.
    pub medium: MediumKind,
    /// Share of messages lost.
    pub loss: f64,
    /// Seed of the drones' choices.
    pub seed: u64,
}

impl Default for SurveySetup {
    fn default() -> Self {
        Self {
            terrain: TerrainSource::Gaussian(0),
            size: 60,
            planner: Planner::CoordinatedSurvey,
            robots: 4,
            min_altitude: 2.0,
            ceiling: 40.0,
            medium: MediumKind::Radio,
            loss: 0.0,
            seed: 0,
        }
    }
}

impl SurveySetup {
    /// The scenario over the terrain.
    pub fn scenario(&self) -> Scenario {
        let mut scenario = Scenario::new(self.planner, self.robots.into(), self.seed);
        scenario.limits.min_altitude = self.min_altitude;
        scenario.limits.ceiling = self.ceiling;
        scenario.medium = self.medium;
        scenario.loss = self.loss;
        scenario
    }

    /// Every setting but the terrain, as names and values.
    fn settings(&self) -> [(&'static str, String); 8] {
        [
            ("size", self.size.to_string()),
            ("planner", self.planner.to_string()),
            ("robots", self.robots.to_string()),
            ("min-altitude", self.min_altitude.to_string()),
            ("ceiling", self.ceiling.to_string()),
            ("medium", self.medium.to_string()),
            ("loss", self.loss.to_string()),
            ("seed", self.seed.to_string()),
        ]
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
        for ((name, value), (_, usual)) in self.settings().iter().zip(Self::default().settings()) {
            if *value != usual {
                let _ = write!(address, "&{name}={value}");
            }
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
        for (name, value) in parts(address) {
            let done = match name {
                "terrain" => match value.parse() {
                    Ok(TerrainSource::File(_) | TerrainSource::Town(_)) | Err(_) => None,
                    Ok(terrain) => {
                        setup.terrain = terrain;
                        Some(())
                    }
                },
                "size" => within(value, SIZES, &mut setup.size),
                "planner" => Planner::from_str(value, true)
                    .ok()
                    .map(|planner| setup.planner = planner),
                "robots" => within(value, ROBOTS, &mut setup.robots),
                "min-altitude" => within(value, ALTITUDES, &mut setup.min_altitude),
                "ceiling" => within(value, CEILINGS, &mut setup.ceiling),
                "medium" => MediumKind::from_str(value, true)
                    .ok()
                    .map(|medium| setup.medium = medium),
                "loss" => within(value, 0.0..=1.0, &mut setup.loss),
                "seed" => within(value, 0..=u64::MAX, &mut setup.seed),
                _ => None,
            };
            done.ok_or_else(|| format!("the address: `{name}={value}` is not understood"))?;
        }
        Ok(setup)
    }

    /// The `host-sim` line that runs the same: same trace, same digest.
    pub fn command(&self) -> String {
        let mut command = format!(
            "cargo run --release -- survey --terrain {}",
            self.terrain_name()
        );
        for (name, value) in self.settings() {
            let _ = write!(command, " --{name} {value}");
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

    pub(in crate::survey) fn unusual() -> SurveySetup {
        SurveySetup {
            terrain: TerrainSource::Urban(3),
            size: 24,
            planner: Planner::Fcao,
            robots: 2,
            min_altitude: 1.5,
            ceiling: 50.0,
            medium: MediumKind::Ideal,
            loss: 0.25,
            seed: 7,
        }
    }

    #[test]
    fn an_address_carries_everything() {
        for setup in [SurveySetup::default(), unusual()] {
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
    }

    #[test]
    fn the_command_names_every_setting() {
        assert_eq!(
            unusual().command(),
            "cargo run --release -- survey --terrain urban:3 --size 24 --planner fcao --robots 2 \
             --min-altitude 1.5 --ceiling 50 --medium ideal --loss 0.25 --seed 7"
        );
    }
}
