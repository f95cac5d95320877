//! The ways of robots as files for autopilots.

use std::error::Error;

use clap::Args;
use host_sim::export::{self, Home, Way};

use crate::command::folder::Folder;

/// Metres a second in missions, unless said otherwise.
const USUAL_SPEED: f64 = 1.0;

/// Options of what is flown in metres and seconds.
#[derive(Args)]
pub(super) struct WayArgs {
    /// How fast robots fly, in metres a second: the summary has seconds then. A step takes as
    /// long as the longest flight in it.
    #[arg(long, value_name = "M/S", allow_negative_numbers = true, value_parser = super::metres)]
    pub(super) speed: Option<f64>,
    /// Writes the way of each robot as a MAVLink mission, mission-N.plan and
    /// mission-N.waypoints; with --resume mission-N-2.plan and so on, one for each charge. The origin of the --scene, or the north-west corner of the
    /// --terrain, lies at this latitude and longitude; x leads east and y north.
    #[arg(long, value_name = "LAT,LON", allow_hyphen_values = true)]
    home: Option<Home>,
    /// Writes the way of each robot as a Crazyflie trajectory, trajectory-N.csv, in parts as the
    /// missions, that is nowhere
    /// faster than --speed.
    #[arg(long, requires = "speed")]
    crazyflie: bool,
}

impl WayArgs {
    /// # Errors
    /// A speed out of its range; an option that counts metres where there are none.
    pub(super) fn check(&self, has_metres: bool) -> Result<(), String> {
        if let Some(speed) = self.speed.filter(|speed| !(0.01..=100.0).contains(speed)) {
            return Err(format!(
                "--speed {speed}: expected 0.01 to 100 metres a second"
            ));
        }
        let given = [
            ("--speed", self.speed.is_some()),
            ("--home", self.home.is_some()),
        ];
        match given.into_iter().find(|(_, given)| *given && !has_metres) {
            None => Ok(()),
            Some((option, _)) => Err(format!(
                "{option} counts metres, and nothing says how many of them a cell has; give \
                 --metres-per-cell M, or leave it out"
            )),
        }
    }

    /// Says what missions indoors need.
    pub(super) fn warn_of_cover(&self, starts_covered: bool) {
        if self.home.is_some() && starts_covered {
            eprintln!(
                "the robots start under something, where satellites do not reach: a mission of \
                 --home needs a position of the vehicle's own there"
            );
        }
    }

    /// Prepares the files that are asked for, of the ways of each robot in metres.
    pub(super) fn write(
        &self,
        folder: &mut Folder,
        robots: impl Iterator<Item = Vec<Way>>,
    ) -> Result<(), Box<dyn Error>> {
        let robots: Vec<_> = robots.collect();
        let mut ways = robots.iter().flatten();
        if (self.home.is_some() || self.crazyflie) && ways.any(|way| !way.is_ground_known) {
            eprintln!(
                "the file does not say what is under a start: the take-off may not be from the \
                 ground; choose another place with --start X,Y,Z"
            );
        }
        let numbered = robots.iter().zip(0..).flat_map(|(ways, robot)| {
            let names = (1..).map(move |part| match part {
                1 => format!("{robot}"),
                _ => format!("{robot}-{part}"),
            });
            ways.iter().zip(names)
        });
        for (way, robot) in numbered {
            if let Some(home) = self.home {
                let plan = export::plan(way, home, self.speed.unwrap_or(USUAL_SPEED));
                let plan = serde_json::to_string_pretty(&plan)?;
                folder.put(format!("mission-{robot}.plan"), &(plan + "\n"))?;
                folder.write(format!("mission-{robot}.waypoints"), |file| {
                    Ok(export::waypoints(way, home, file)?)
                })?;
            }
            if let Some(speed) = self.speed.filter(|_| self.crazyflie) {
                folder.write(format!("trajectory-{robot}.csv"), |file| {
                    Ok(export::trajectory(way, speed, file)?)
                })?;
            }
        }
        Ok(())
    }
}
