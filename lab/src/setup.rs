//! What the menus set: everything that a run follows from, as plain data, and the two
//! texts that it can be written as: an address and a command.

use std::fmt::Write;
use std::sync::Arc;

use host_sim::fleet::Faults;
use host_sim::medium::{MediumKind, Reach};
use host_sim::planners::PlannerKind;
use host_sim::run::Scenario;
use host_sim::sensor::ALL_AROUND;
use host_sim::world::{Starts, World};
use planner_core::Cell;
use planner_core::radio::MAX_LEN;

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
    /// What carries what robots tell each other.
    pub medium: MediumKind,
    /// Ticks between two exchanges; 0: never.
    pub sync: u32,
    /// Share of messages lost.
    pub loss: f64,
    /// Who hears whom.
    pub reach: Reach,
    /// Frames come so many ticks late at most.
    pub delay: u32,
    /// Bytes that a robot may send in a tick on average.
    pub byte_budget: u16,
    /// Seed of all chance in the run.
    pub seed: u64,
    /// A cell holds at most one robot.
    pub solid: bool,
    /// What happens to robots and cells.
    pub faults: Faults,
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
            medium: MediumKind::Radio,
            sync: 1,
            loss: 0.0,
            reach: Reach::Everywhere,
            delay: 0,
            byte_budget: MAX_LEN as u16,
            seed: 1,
            solid: false,
            faults: Faults::default(),
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
        let starts = world
            .place(self.robots.into(), &starts, self.solid)
            .map_err(|error| error.to_string())?;
        let mut scenario = Scenario::new(world, starts, self.planner);
        scenario.range = self.range;
        scenario.fov = self.fov;
        scenario.medium = self.medium;
        scenario.sync = self.sync;
        scenario.loss = self.loss;
        scenario.air.reach = self.reach;
        scenario.air.delay = self.delay;
        scenario.byte_budget = self.byte_budget;
        scenario.seed = self.seed;
        scenario.solid = self.solid;
        scenario.faults.clone_from(&self.faults);
        scenario.check().map_err(|error| error.to_string())?;
        Ok(scenario)
    }

    /// The setup that gives this scenario, as far as the menus reach.
    pub fn of(scenario: &Scenario) -> Self {
        Self {
            map: Map::Given(scenario.world.clone()),
            planner: scenario.planner,
            robots: scenario.starts.len().min(255) as u8,
            starts: Some(Starts::At(scenario.starts.clone())),
            range: scenario.range,
            fov: scenario.fov,
            medium: scenario.medium,
            sync: scenario.sync,
            loss: scenario.loss,
            reach: scenario.air.reach,
            delay: scenario.air.delay,
            byte_budget: scenario.byte_budget,
            seed: scenario.seed,
            solid: scenario.solid,
            faults: scenario.faults.clone(),
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
            Some(Starts::At(cells)) => {
                for cell in cells {
                    say(true, "start", cell.to_string());
                }
            }
        }
        say(self.range != usual.range, "range", self.range.to_string());
        say(self.fov != usual.fov, "fov", self.fov.to_string());
        say(
            self.medium != usual.medium,
            "medium",
            self.medium.to_string(),
        );
        say(self.sync != usual.sync, "sync", self.sync.to_string());
        say(self.loss != usual.loss, "loss", self.loss.to_string());
        let reach = match self.reach {
            Reach::Everywhere => "all".into(),
            Reach::LineOfSight => "sight".into(),
            Reach::Cells(cells) => cells.to_string(),
        };
        say(self.reach != usual.reach, "radio-range", reach);
        say(self.delay != usual.delay, "delay", self.delay.to_string());
        let budget = self.byte_budget;
        say(
            budget != usual.byte_budget,
            "byte-budget",
            budget.to_string(),
        );
        say(self.seed != usual.seed, "seed", self.seed.to_string());
        say(self.solid, "solid", String::new());
        settings.extend(fault_settings(&self.faults));
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
        let mut seeded = false;
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
                    "random" => seeded = true,
                    _ => starts.push(cell(value).ok_or_else(wrong)?),
                },
                "range" => setup.range = value.parse().map_err(|_| wrong())?,
                "fov" => setup.fov = value.parse().map_err(|_| wrong())?,
                "medium" => {
                    use clap::ValueEnum;
                    setup.medium = MediumKind::from_str(value, true).map_err(|_| wrong())?;
                }
                "sync" => setup.sync = value.parse().map_err(|_| wrong())?,
                "loss" => setup.loss = value.parse().map_err(|_| wrong())?,
                "radio-range" => {
                    setup.reach = match value {
                        "all" => Reach::Everywhere,
                        "sight" => Reach::LineOfSight,
                        _ => Reach::Cells(value.parse().map_err(|_| wrong())?),
                    }
                }
                "delay" => setup.delay = value.parse().map_err(|_| wrong())?,
                "byte-budget" => setup.byte_budget = value.parse().map_err(|_| wrong())?,
                "seed" => setup.seed = value.parse().map_err(|_| wrong())?,
                "solid" => setup.solid = true,
                _ => add_fault(&mut setup.faults, name, value).ok_or_else(wrong)?,
            }
        }
        if seeded {
            setup.starts = Some(Starts::Random(setup.seed));
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

/// The faults under the names that `host-sim explore` has for them.
fn fault_settings(faults: &Faults) -> Vec<(&'static str, String)> {
    fn all<T: ToString>(
        name: &'static str,
        faults: &[T],
    ) -> impl Iterator<Item = (&'static str, String)> {
        faults.iter().map(move |of| (name, of.to_string()))
    }
    all("kill", &faults.deaths)
        .chain(all("late", &faults.arrivals))
        .chain(all("restart", &faults.restarts))
        .chain(all("resume", &faults.resumes))
        .chain(all("close", &faults.closures))
        .chain(all("blind", &faults.blind))
        .chain(all("sensor-fails", &faults.sensor_failures))
        .chain(all("pose-lost", &faults.lost_poses))
        .collect()
}

/// Adds one of [`fault_settings`]; `None`: it is not understood.
fn add_fault(faults: &mut Faults, name: &str, value: &str) -> Option<()> {
    match name {
        "kill" => faults.deaths.push(value.parse().ok()?),
        "late" => faults.arrivals.push(value.parse().ok()?),
        "restart" => faults.restarts.push(value.parse().ok()?),
        "resume" => faults.resumes.push(value.parse().ok()?),
        "close" => faults.closures.push(value.parse().ok()?),
        "blind" => faults.blind.push(value.parse().ok()?),
        "sensor-fails" => faults.sensor_failures.push(value.parse().ok()?),
        "pose-lost" => faults.lost_poses.push(value.parse().ok()?),
        _ => return None,
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;
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
            medium: MediumKind::Ideal,
            sync: 3,
            loss: 0.25,
            reach: Reach::Cells(9),
            delay: 2,
            byte_budget: 30,
            seed: 5,
            solid: true,
            faults: Faults {
                deaths: vec!["1@40".parse().unwrap()],
                arrivals: vec!["3@12".parse().unwrap()],
                restarts: vec!["0@60".parse().unwrap()],
                resumes: vec!["2@90".parse().unwrap()],
                closures: vec!["4,5@9-20".parse().unwrap()],
                blind: vec!["6,7".parse().unwrap()],
                sensor_failures: vec!["1@30".parse().unwrap()],
                lost_poses: vec!["0@5-9".parse().unwrap()],
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
        for setup in [Setup::default(), unusual(), given, narrow] {
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
            "explore rooms-7.txt --planner minpos --robots 4 --start corner --range 6 \
             --medium ideal --sync 3 --loss 0.25 --radio-range 9 --delay 2 --byte-budget 30 --seed 5 \
             --solid --kill 1@40 --late 3@12 --restart 0@60 --resume 2@90 --close 4,5@9-20 \
             --blind 6,7 --sensor-fails 1@30 --pose-lost 0@5-9"
        ));
    }
}
