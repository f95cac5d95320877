//! What the menus set: everything that a run follows from, as plain data, and the two
//! texts that it can be written as: an address and a command.

use std::fmt::Write;
use std::sync::Arc;

use host_sim::planners::PlannerKind;
use host_sim::scenario::grid::{Scenario, default_max_ticks};
use host_sim::scenario::{Conditions, MediumKind};
use host_sim::sensor::ALL_AROUND;
use host_sim::world::{Starts, World};
use planner_core::Cell;

use crate::maps::Map;

/// What is to be run. The defaults are those of `host-sim explore`.
#[derive(Clone, Debug, PartialEq)]
pub struct Setup {
    /// What is explored.
    pub map: Map,
    /// What decides in each robot.
    pub planner: PlannerKind,
    /// Number of robots, 1 to 255.
    pub robots: u8,
    /// Where they start; `None`: where the map says, else in the centre.
    pub starts: Option<Starts>,
    /// Sensor range in cells.
    pub range: u8,
    /// Its field of view in degrees.
    pub fov: u16,
    /// A cell holds at most one robot.
    pub solid: bool,
    /// Cells that their bodies reach beyond the one of their centre.
    pub clearance: u8,
    /// What all worlds share. No `max_ticks`, 0: as many as the map needs.
    pub conditions: Conditions,
}

impl Default for Setup {
    fn default() -> Self {
        Self {
            map: Map::BuiltIn("office"),
            planner: PlannerKind::Explorer,
            robots: 3,
            starts: None,
            range: 5,
            fov: ALL_AROUND,
            solid: false,
            clearance: 0,
            conditions: Conditions {
                medium: MediumKind::Radio,
                ..Conditions::new(1, 0)
            },
        }
    }
}

impl Setup {
    /// The scenario, checked.
    ///
    /// # Errors
    /// What cannot be run, in a sentence for the user.
    pub fn scenario(&self) -> Result<Scenario, String> {
        let world = self.map.world()?;
        let starts = self
            .starts
            .clone()
            .unwrap_or_else(|| world.default_starts());
        let starts = match self.clearance {
            0 => world.place(self.robots.into(), &starts, self.solid),
            clearance => world.place_bodies(self.robots.into(), &starts, clearance),
        };
        let starts = starts.map_err(|error| error.to_string())?;
        let mut scenario = Scenario::new(world, starts, self.planner);
        scenario.range = self.range;
        scenario.fov = self.fov;
        scenario.solid = self.solid;
        scenario.clearance = self.clearance;
        let max_ticks = match self.conditions.max_ticks {
            0 => scenario.conditions.max_ticks,
            given => given,
        };
        scenario.conditions = Conditions {
            max_ticks,
            ..self.conditions.clone()
        };
        scenario.check().map_err(|error| error.to_string())?;
        Ok(scenario)
    }

    /// The setup that gives this scenario, as far as the menus reach.
    pub fn of(scenario: &Scenario) -> Self {
        let max_ticks = scenario.conditions.max_ticks;
        let reachable = scenario.world.reachable(&scenario.starts);
        let is_usual = max_ticks == default_max_ticks(&reachable, scenario.planner);
        Self {
            map: Map::Given(scenario.world.clone()),
            planner: scenario.planner,
            robots: scenario.starts.len().min(255) as u8,
            starts: Some(Starts::At(scenario.starts.clone())),
            range: scenario.range,
            fov: scenario.fov,
            solid: scenario.solid,
            clearance: scenario.clearance,
            conditions: Conditions {
                max_ticks: if is_usual { 0 } else { max_ticks },
                ..scenario.conditions.clone()
            },
        }
    }

    /// The settings that differ from the defaults, as names and values; the map apart.
    fn settings(&self) -> Vec<(&'static str, String)> {
        let usual = Self::default();
        let mut settings = Vec::new();
        let mut say = |differs: bool, name, value: String| {
            if differs {
                settings.push((name, value));
            }
        };
        say(
            self.planner != usual.planner,
            "planner",
            self.planner.to_string(),
        );
        say(
            self.robots != usual.robots,
            "robots",
            self.robots.to_string(),
        );
        match &self.starts {
            None => {}
            Some(Starts::Center) => say(true, "start", "center".into()),
            Some(Starts::Corner) => say(true, "start", "corner".into()),
            Some(Starts::Random(_)) => say(true, "start", "random".into()),
            Some(Starts::Spread(_)) => say(true, "start", "spread".into()),
            Some(Starts::At(cells)) => {
                for cell in cells {
                    say(true, "start", cell.to_string());
                }
            }
        }
        say(self.range != usual.range, "range", self.range.to_string());
        say(self.fov != usual.fov, "fov", self.fov.to_string());
        say(self.solid, "solid", String::new());
        say(self.clearance > 0, "clearance", self.clearance.to_string());
        settings.extend(self.conditions.settings(&usual.conditions));
        settings
    }

    /// The `host-sim` lines that run the same: same trace, same digest. A map that was
    /// drawn or dropped must be saved first, under the name that the line gives.
    pub fn command(&self) -> String {
        let mut command = String::new();
        let file = self.map.file();
        let file = file.display();
        if let Map::Generated {
            family,
            extent,
            seed,
        } = &self.map
        {
            let (width, height) = (extent.width, extent.height);
            let _ = writeln!(
                command,
                "cargo run --release -- generate {family} --size {width}x{height} --seed {seed} --output {file}"
            );
        }
        let _ = write!(command, "cargo run --release -- explore {file}");
        for (name, value) in self.settings() {
            let _ = write!(command, " --{name}");
            if !value.is_empty() {
                let _ = write!(command, " {value}");
            }
        }
        command
    }

    /// The part of an address behind `#`.
    pub fn address(&self) -> String {
        let mut address = match &self.map {
            Map::BuiltIn(name) => format!("map={name}"),
            Map::Generated {
                family,
                extent,
                seed,
            } => {
                format!(
                    "map=generate:{family}:{}x{}:{seed}",
                    extent.width, extent.height
                )
            }
            Map::Given(world) => format!("map={}", crate::pack::pack(world)),
        };
        for (name, value) in self.settings() {
            let _ = write!(address, "&{name}={value}");
        }
        address
    }

    /// Reads [`address`](Self::address).
    ///
    /// # Errors
    /// What is wrong with it, in a sentence for the user.
    pub fn from_address(address: &str) -> Result<Self, String> {
        let mut setup = Self::default();
        let mut starts = Vec::new();
        let mut seeded = None;
        for part in address
            .trim_start_matches('#')
            .split('&')
            .filter(|part| !part.is_empty())
        {
            let (name, value) = part.split_once('=').unwrap_or((part, ""));
            let wrong = || format!("the address: `{name}={value}` is not understood");
            match name {
                "map" => setup.map = map(value)?,
                "planner" => {
                    use clap::ValueEnum;
                    setup.planner = PlannerKind::from_str(value, true).map_err(|_| wrong())?;
                }
                "robots" => setup.robots = value.parse().map_err(|_| wrong())?,
                "start" => match value {
                    "center" => setup.starts = Some(Starts::Center),
                    "corner" => setup.starts = Some(Starts::Corner),
                    "random" => seeded = Some(Starts::Random as fn(u64) -> Starts),
                    "spread" => seeded = Some(Starts::Spread),
                    _ => starts.push(cell(value).ok_or_else(wrong)?),
                },
                "range" => setup.range = value.parse().map_err(|_| wrong())?,
                "fov" => setup.fov = value.parse().map_err(|_| wrong())?,
                "solid" => setup.solid = true,
                "clearance" => setup.clearance = value.parse().map_err(|_| wrong())?,
                _ => setup.conditions.set(name, value).ok_or_else(wrong)?,
            }
        }
        if let Some(starts) = seeded {
            setup.starts = Some(starts(setup.conditions.seed));
        }
        if !starts.is_empty() {
            setup.starts = Some(Starts::At(starts));
        }
        Ok(setup)
    }

    /// The same with a world of the user's own.
    pub(crate) fn with_world(&self, world: World) -> Self {
        Self {
            map: Map::Given(Arc::new(world)),
            ..self.clone()
        }
    }
}

fn map(value: &str) -> Result<Map, String> {
    use clap::ValueEnum;
    if let Some(map) = Map::named(value) {
        return Ok(map);
    }
    if let Some(recipe) = value.strip_prefix("generate:") {
        let parse = || {
            let mut parts = recipe.split(':');
            let family = host_sim::world::Family::from_str(parts.next()?, true).ok()?;
            let (width, height) = parts.next()?.split_once('x')?;
            Some(Map::Generated {
                family,
                extent: planner_core::Extent::new(width.parse().ok()?, height.parse().ok()?),
                seed: parts.next()?.parse().ok()?,
            })
        };
        return parse()
            .ok_or_else(|| format!("the address: no map can be generated of `{recipe}`"));
    }
    crate::pack::unpack(value).map(|world| Map::Given(Arc::new(world)))
}

fn cell(text: &str) -> Option<Cell> {
    let (x, y) = text.split_once(',')?;
    Some(Cell::new(x.parse().ok()?, y.parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use host_sim::scenario::{
        AirFaults, ErrorKind, Faults, Limits, Mission, Preset, Reach, Trouble, Wind,
    };
    use planner_core::Extent;

    fn unusual() -> Setup {
        Setup {
            map: Map::Generated {
                family: host_sim::world::Family::Rooms,
                extent: Extent::new(40, 30),
                seed: 7,
            },
            planner: PlannerKind::MinPos,
            robots: 4,
            starts: Some(Starts::Corner),
            range: 6,
            fov: ALL_AROUND,
            solid: true,
            clearance: 0,
            conditions: Conditions {
                medium: MediumKind::Radio,
                sync: 3,
                byte_budget: 30,
                loss: 0.25,
                air: AirFaults {
                    reach: Reach::Cells(9),
                    partitions: vec!["5-20:2".parse().unwrap()],
                    duplication: 0.5,
                    delay: 2,
                    corruption: 0.125,
                    forger: Some("2:goal".parse().unwrap()),
                },
                key: None,
                seed: 5,
                max_ticks: 900,
                faults: Faults {
                    deaths: vec!["1@40".parse().unwrap()],
                    arrivals: vec!["3@12".parse().unwrap()],
                    restarts: vec!["0@60".parse().unwrap()],
                    resumes: vec!["2@90".parse().unwrap()],
                    closures: vec!["4,5@9-20".parse().unwrap()],
                    shut: vec!["5,5@3-8".parse().unwrap()],
                    blind: vec!["6,7".parse().unwrap()],
                    sensor_failures: vec!["1@30".parse().unwrap()],
                    lost_poses: vec!["0@5-9".parse().unwrap()],
                },
                trouble: Trouble {
                    false_walls: 0.01,
                    false_frees: 0.02,
                    error_kind: ErrorKind::Far,
                    misplaced: 0.03,
                    drift: 200,
                    people: 2,
                    doors: 6,
                    see_robots: true,
                    looks: 3,
                },
                preset: Preset::Rangers,
                mission: Mission {
                    come_home: true,
                    energy: 70,
                },
                limits: Limits {
                    keep_out: vec!["1,2:3,4".parse().unwrap(), "5,5:7,5:5,7".parse().unwrap()],
                    only: vec!["0,0:9,9".parse().unwrap()],
                },
                wind: Wind { deviation: 0.5 },
            },
        }
    }

    #[test]
    fn an_address_carries_everything() {
        let drawn = unusual().map.world().unwrap();
        let start = drawn.free_cells().next().unwrap();
        let given = Setup {
            starts: Some(Starts::At(vec![start; 2])),
            map: Map::Given(drawn),
            ..unusual()
        };
        let narrow = Setup {
            fov: 62,
            ..Setup::default()
        };
        assert!(narrow.command().ends_with(" --fov 62"));
        let wide = Setup {
            clearance: 2,
            ..Setup::default()
        };
        assert!(wide.command().ends_with(" --clearance 2"));
        for setup in [Setup::default(), unusual(), given, narrow, wide] {
            let back = Setup::from_address(&setup.address()).unwrap();
            assert_eq!(back.address(), setup.address());
            assert_eq!(back, setup);
        }
    }

    #[test]
    fn a_bad_address_says_which_part() {
        for (address, part) in [
            ("robots=many", "robots=many"),
            ("map=nowhere", "nowhere"),
            ("map=generate:rooms:4", "rooms:4"),
            ("colour=red", "colour=red"),
            ("fov=wide", "fov=wide"),
            ("blind=3", "blind=3"),
            ("key=00", "key=00"),
        ] {
            let error = Setup::from_address(address).unwrap_err();
            assert!(error.contains(part), "{error}");
        }
    }

    #[test]
    fn the_command_names_what_differs_from_the_defaults() {
        assert_eq!(
            Setup::default().command(),
            "cargo run --release -- explore fixtures/maps/office.png"
        );
        let command = unusual().command();
        assert!(command.starts_with(
            "cargo run --release -- generate rooms --size 40x30 --seed 7 --output rooms-7.txt\n"
        ));
        assert!(command.ends_with(
            "explore rooms-7.txt --planner minpos --robots 4 --start corner --range 6 --solid \
             --sync 3 --byte-budget 30 --loss 0.25 --radio-range 9 --duplicate 0.5 --delay 2 \
             --corrupt 0.125 --seed 5 --preset rangers --max-ticks 900 --forge 2:goal --partition 5-20:2 \
             --kill 1@40 --late 3@12 --restart 0@60 --resume 2@90 --close 4,5@9-20 --shut 5,5@3-8 \
             --blind 6,7 --sensor-fails 1@30 --pose-lost 0@5-9 --come-home --energy 70 \
             --keep-out 1,2:3,4 --keep-out 5,5:7,5:5,7 --only 0,0:9,9 --wind 0.5 \
             --false-walls 0.01 --false-frees 0.02 --error-kind far --misplaced 0.03 --drift 200 --people 2 --doors 6 --see-robots \
             --looks 3"
        ));
    }
}
