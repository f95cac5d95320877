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
    #[arg(long, value_name = "M/S")]
    pub(super) speed: Option<f64>,
    /// Writes the way of each robot as a MAVLink mission, mission-N.plan and
    /// mission-N.waypoints. The origin of the --scene, or the north-west corner of the
    /// --terrain, lies at this latitude and longitude; x leads east and y north.
    #[arg(long, value_name = "LAT,LON", allow_hyphen_values = true)]
    home: Option<Home>,
    /// Writes the way of each robot as a Crazyflie trajectory, trajectory-N.csv, that is nowhere
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

    /// Prepares the files of each way, in metres, that are asked for.
    pub(super) fn write(
        &self,
        folder: &mut Folder,
        ways: impl Iterator<Item = Way>,
    ) -> Result<(), Box<dyn Error>> {
        for (way, robot) in ways.zip(0..) {
            if let Some(home) = self.home {
                let plan = export::plan(&way, home, self.speed.unwrap_or(USUAL_SPEED));
                let plan = serde_json::to_string_pretty(&plan)?;
                folder.put(format!("mission-{robot}.plan"), &(plan + "\n"))?;
                folder.write(format!("mission-{robot}.waypoints"), |file| {
                    Ok(export::waypoints(&way, home, file)?)
                })?;
            }
            if let Some(speed) = self.speed.filter(|_| self.crazyflie) {
                folder.write(format!("trajectory-{robot}.csv"), |file| {
                    Ok(export::trajectory(&way, speed, file)?)
                })?;
            }
        }
        Ok(())
    }
}
