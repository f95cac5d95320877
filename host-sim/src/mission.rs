//! Where robots go when they have explored, and how far they can go.

use clap::Args;
use planner_core::survey;
use serde::{Deserialize, Serialize};

/// What robots are sent out with. Nothing of it by default; for the explorer, and in the air.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Mission {
    /// Whether a robot that has explored goes home, to where it started, before it stops.
    pub come_home: bool,
    /// Steps that the energy of a robot lasts for, and again when it is told to go on; 0: no
    /// limit. In the air it spends as much when it hovers.
    pub energy: u32,
}

impl Mission {
    pub(crate) fn is_none(&self) -> bool {
        *self == Self::default()
    }

    /// The same for planners over heights.
    pub(crate) const fn of_surveys(self) -> survey::Mission {
        survey::Mission {
            come_home: self.come_home,
            energy: self.energy,
        }
    }

    /// What is set, as names and values of options.
    pub(crate) fn settings(&self) -> Vec<(&'static str, String)> {
        let come_home = self.come_home.then(|| ("come-home", String::new()));
        let energy = (self.energy > 0).then(|| ("energy", self.energy.to_string()));
        come_home.into_iter().chain(energy).collect()
    }
}

/// The options that set a [`Mission`].
#[derive(Args, Clone, Copy)]
pub struct MissionArgs {
    /// A robot that has explored goes home, to where it started, before it stops. For the
    /// explorer, and in the air.
    #[arg(long)]
    come_home: bool,
    /// Steps that a robot's energy lasts for: it turns back in time, and stops at home. With
    /// --resume it goes on with as much again. For the explorer, and in the air, where hovering
    /// takes as much as a step: seconds of flight × speed / side of a cell, or / the metres of
    /// --step over heights.
    #[arg(long, value_name = "STEPS", allow_negative_numbers = true, value_parser = steps)]
    energy: Option<u32>,
}

impl MissionArgs {
    pub(crate) fn over(self, mission: Mission) -> Mission {
        Mission {
            come_home: self.come_home || mission.come_home,
            energy: self.energy.unwrap_or(mission.energy),
        }
    }
}

fn steps(text: &str) -> Result<u32, String> {
    let steps = text.parse().ok().filter(|&steps| steps > 0);
    steps.ok_or_else(|| format!("expected 1 to {} steps", u32::MAX))
}
