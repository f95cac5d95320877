//! Every planner that a robot can run.

use std::fmt;

use bridge::PlannerConfig;
use clap::ValueEnum;
use planner_core::explorer::{self, Explorer};
use planner_core::local_frontiers::{self, LocalFrontiers};
use planner_core::map::ExtentError;
use planner_core::{Cell, Extent, Planner, RobotId};
use serde::{Deserialize, Serialize};

use crate::peers::{Closest, Greedy, PaperMinPos, Peer, StrongMinPos};

/// Names a planner, on the command line and in traces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PlannerKind {
    /// The complete planner with bounded work.
    Explorer,
    /// Local frontiers as published: not complete.
    LocalFrontiers,
    /// The same with a second chance: not complete.
    LocalFrontiersSecondChance,
    /// Each robot to the nearest frontier of its map.
    Closest,
    /// The robot and the frontier that are nearest to each other first, and so on.
    Greedy,
    /// Each robot to the frontier that the fewest others are nearer to.
    #[value(name = "minpos")]
    #[serde(rename = "minpos")]
    MinPos,
    /// The same with every frontier cell for itself, decided anew in every tick.
    #[value(name = "minpos-strong")]
    #[serde(rename = "minpos-strong")]
    MinPosStrong,
}

impl PlannerKind {
    /// How a robot is set up that sees `range` cells far and decides by itself, on
    /// the host as on a chip. `None`: the planner has a view of all robots, and
    /// only the host can run it.
    pub fn on_chip(self, range: u8) -> Option<PlannerConfig> {
        let local_frontiers = |second_chance| {
            PlannerConfig::LocalFrontiers(local_frontiers::Config {
                second_chance,
                ..Default::default()
            })
        };
        match self {
            Self::Explorer => Some(PlannerConfig::Explorer(explorer::Config::new(range))),
            Self::LocalFrontiers => Some(local_frontiers(false)),
            Self::LocalFrontiersSecondChance => Some(local_frontiers(true)),
            Self::Closest | Self::Greedy | Self::MinPos | Self::MinPosStrong => None,
        }
    }

    /// The planner of robot `id`, which sees `range` cells far and starts at
    /// `start` on a grid of `extent`.
    ///
    /// # Errors
    /// A grid that a map of `TW`×`TH` tiles does not hold.
    pub fn build<const TW: usize, const TH: usize>(
        self,
        id: RobotId,
        range: u8,
        extent: Extent,
        start: Cell,
    ) -> Result<Box<dyn Planner<TW, TH>>, ExtentError> {
        if let Some(config) = self.on_chip(range) {
            return on_host(config, id, extent, start);
        }
        Ok(match self {
            Self::Explorer | Self::LocalFrontiers | Self::LocalFrontiersSecondChance => {
                unreachable!("planner-core has them")
            }
            Self::Closest => Box::new(Peer::new(Closest, id, extent, start)?),
            Self::Greedy => Box::new(Peer::new(Greedy::default(), id, extent, start)?),
            Self::MinPos => Box::new(Peer::new(PaperMinPos::default(), id, extent, start)?),
            Self::MinPosStrong => Box::new(Peer::new(StrongMinPos::default(), id, extent, start)?),
        })
    }
}

/// A planner of planner-core, here.
fn on_host<const TW: usize, const TH: usize>(
    config: PlannerConfig,
    id: RobotId,
    extent: Extent,
    start: Cell,
) -> Result<Box<dyn Planner<TW, TH>>, ExtentError> {
    Ok(match config {
        PlannerConfig::Explorer(config) => {
            let mut planner = Box::new(Explorer::vacant());
            planner.reset(config, id, extent, start)?;
            planner
        }
        PlannerConfig::LocalFrontiers(config) => {
            let mut planner = Box::new(LocalFrontiers::vacant());
            planner.reset(config, id, extent, start)?;
            planner
        }
    })
}

/// The name used on the command line, for example `closest`.
impl fmt::Display for PlannerKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let value = self.to_possible_value().expect("no planner is hidden");
        f.write_str(value.get_name())
    }
}
