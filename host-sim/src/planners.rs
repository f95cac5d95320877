//! Every planner that a robot can run.

use std::fmt;

use bridge::PlannerConfig;
use clap::ValueEnum;
use planner_core::ExtentError;
use planner_core::explorer::{self, Explorer, SensorModel};
use planner_core::local_frontiers::{self, LocalFrontiers};
use planner_core::radio::LinkConfig;
use planner_core::{AnyPlanner, Cell, Extent, RobotId};
use serde::{Deserialize, Serialize};

use crate::baselines::{
    Bmilrv, Closest, Greedy, Marks, PaperMinPos, Peer, Rule, StrongMinPos, Utility,
};
use crate::mission::Mission;

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
    /// The frontier cell of most unknown cells in sight, the nearer the better.
    Utility,
    /// Brick & Mortar with long range vision: closes what nobody needs any more.
    Bmilrv,
}

/// What a robot starts with.
#[derive(Clone, Copy, Debug)]
pub struct Setup {
    /// Its number.
    pub id: RobotId,
    /// Size of the grid.
    pub extent: Extent,
    /// Where it stands.
    pub start: Cell,
    /// How it uses the radio.
    pub link: LinkConfig,
    /// What it takes its sensor for, if it [weighs looks](PlannerKind::weighs_looks).
    pub sensor: SensorModel,
    /// Cells that its body reaches beyond its own, if it [has a body](PlannerKind::has_body).
    pub clearance: u8,
    /// What it is sent out with, if it [knows home](PlannerKind::knows_home).
    pub mission: Mission,
}

impl PlannerKind {
    /// Whether it asks for looks in the directions that it needs: only such a planner
    /// can explore with a sensor that does not look all around.
    pub fn turns_sensor(self) -> bool {
        match self {
            Self::Explorer => true,
            Self::LocalFrontiers
            | Self::LocalFrontiersSecondChance
            | Self::Closest
            | Self::Greedy
            | Self::MinPos
            | Self::MinPosStrong
            | Self::Utility
            | Self::Bmilrv => false,
        }
    }

    /// Whether it takes in what lies beyond [`MAX_RADIUS`](planner_core::sight::MAX_RADIUS).
    pub fn sees_far(self) -> bool {
        match self {
            Self::Explorer
            | Self::Closest
            | Self::Greedy
            | Self::MinPos
            | Self::MinPosStrong
            | Self::Utility => true,
            Self::LocalFrontiers | Self::LocalFrontiersSecondChance | Self::Bmilrv => false,
        }
    }

    /// Whether it can take its sensor for one that errs.
    pub fn weighs_looks(self) -> bool {
        self == Self::Explorer
    }

    /// Whether it can plan for a body that is wider than a cell.
    pub fn has_body(self) -> bool {
        self == Self::Explorer
    }

    /// Whether it can be sent home, and told how far it can go.
    pub fn knows_home(self) -> bool {
        self == Self::Explorer
    }

    /// Whether its state can be saved, and restored.
    pub fn is_saved(self) -> bool {
        self == Self::Explorer
    }

    /// Whether it can be told what to keep out of.
    pub fn keeps_out(self) -> bool {
        self == Self::Explorer
    }

    /// How a planner decides that can run on a chip, and runs in the same way on
    /// the host. `None`: this one has a view of all robots, which no chip has.
    pub fn on_chip(self, setup: Setup) -> Option<PlannerConfig> {
        let Setup {
            link,
            sensor,
            clearance,
            mission,
            ..
        } = setup;
        let local_frontiers = |second_chance| {
            PlannerConfig::LocalFrontiers(local_frontiers::Config {
                second_chance,
                link,
                ..Default::default()
            })
        };
        match self {
            Self::Explorer => Some(PlannerConfig::Explorer(explorer::Config {
                link,
                sensor,
                clearance,
                come_home: mission.come_home,
                energy: mission.energy,
                ..explorer::Config::new()
            })),
            Self::LocalFrontiers => Some(local_frontiers(false)),
            Self::LocalFrontiersSecondChance => Some(local_frontiers(true)),
            Self::Closest
            | Self::Greedy
            | Self::MinPos
            | Self::MinPosStrong
            | Self::Utility
            | Self::Bmilrv => None,
        }
    }

    /// The planner of a robot that is set up like this.
    ///
    /// # Errors
    /// A grid that a map of `TW`×`TH` tiles does not hold.
    pub fn build<const TW: usize, const TH: usize>(
        self,
        setup: Setup,
    ) -> Result<Box<dyn AnyPlanner<TW, TH>>, ExtentError> {
        if let Some(config) = self.on_chip(setup) {
            return on_host(config, setup);
        }
        let Setup {
            id,
            extent,
            start,
            link,
            ..
        } = setup;
        let rule: Box<dyn Rule> = match self {
            Self::Explorer | Self::LocalFrontiers | Self::LocalFrontiersSecondChance => {
                unreachable!("planner-core has them")
            }
            Self::Closest => Box::new(Closest),
            Self::Greedy => Box::new(Greedy::default()),
            Self::MinPos => Box::new(PaperMinPos::default()),
            Self::MinPosStrong => Box::new(StrongMinPos::default()),
            Self::Utility => Box::new(Utility),
            Self::Bmilrv => {
                let marks = Marks::new(extent, start);
                return Ok(Box::new(Bmilrv::new(marks, id, extent, start, link)?));
            }
        };
        Ok(Box::new(Peer::new(rule, id, extent, start, link)?))
    }
}

/// A planner of planner-core, here.
///
/// # Errors
/// A grid that a map of `TW`×`TH` tiles does not hold.
pub fn on_host<const TW: usize, const TH: usize>(
    config: PlannerConfig,
    setup: Setup,
) -> Result<Box<dyn AnyPlanner<TW, TH>>, ExtentError> {
    let Setup {
        id, extent, start, ..
    } = setup;
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
