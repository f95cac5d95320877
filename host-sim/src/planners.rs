//! Every planner that a robot can run.

use std::fmt;

use clap::ValueEnum;
use planner_core::explorer::{self, Explorer};
use planner_core::local_frontiers::{self, LocalFrontiers};
use planner_core::map::ExtentError;
use planner_core::radio::LinkConfig;
use planner_core::{Cell, Extent, Planner, RobotId};
use serde::{Deserialize, Serialize};

use crate::peers::{Bmilrv, Closest, Greedy, Marks, PaperMinPos, Peer, StrongMinPos};

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
    /// Brick & Mortar with long range vision: closes what nobody needs any more.
    Bmilrv,
}

impl PlannerKind {
    /// How many times longer than others this planner may take: BMILRV goes
    /// round loops many times.
    pub fn patience(self) -> u32 {
        match self {
            Self::Bmilrv => 12,
            _ => 1,
        }
    }

    /// The planner of robot `id`, which sees `range` cells far and starts at
    /// `start` on a grid of `extent`, and uses the radio by `link`.
    ///
    /// # Errors
    /// A grid that a map of `TW`×`TH` tiles does not hold.
    pub fn build<const TW: usize, const TH: usize>(
        self,
        id: RobotId,
        range: u8,
        extent: Extent,
        start: Cell,
        link: LinkConfig,
    ) -> Result<Box<dyn Planner<TW, TH>>, ExtentError> {
        self.build_among(&Marks::new(extent, start), id, range, extent, start, link)
    }

    /// The same, in a team that shares `marks`, if the planner works by marks.
    ///
    /// # Errors
    /// A grid that a map of `TW`×`TH` tiles does not hold.
    pub fn build_among<const TW: usize, const TH: usize>(
        self,
        marks: &Marks,
        id: RobotId,
        range: u8,
        extent: Extent,
        start: Cell,
        link: LinkConfig,
    ) -> Result<Box<dyn Planner<TW, TH>>, ExtentError> {
        Ok(match self {
            Self::Explorer => {
                let config = explorer::Config {
                    link,
                    ..explorer::Config::new()
                };
                let mut explorer = Box::new(Explorer::vacant());
                explorer.reset(config, id, extent, start)?;
                explorer
            }
            Self::LocalFrontiers => local_frontiers(false, id, extent, start, link)?,
            Self::LocalFrontiersSecondChance => local_frontiers(true, id, extent, start, link)?,
            Self::Closest => Box::new(Peer::new(Closest, id, extent, start, link)?),
            Self::Greedy => Box::new(Peer::new(Greedy::default(), id, extent, start, link)?),
            Self::MinPos => Box::new(Peer::new(PaperMinPos::default(), id, extent, start, link)?),
            Self::MinPosStrong => {
                Box::new(Peer::new(StrongMinPos::default(), id, extent, start, link)?)
            }
            Self::Bmilrv => Box::new(Bmilrv::new(marks.clone(), id, extent, start, link)?),
        })
    }
}

fn local_frontiers<const TW: usize, const TH: usize>(
    second_chance: bool,
    id: RobotId,
    extent: Extent,
    start: Cell,
    link: LinkConfig,
) -> Result<Box<dyn Planner<TW, TH>>, ExtentError> {
    let config = local_frontiers::Config {
        second_chance,
        link,
        ..Default::default()
    };
    let mut planner = Box::new(LocalFrontiers::vacant());
    planner.reset(config, id, extent, start)?;
    Ok(planner)
}

/// The name used on the command line, for example `closest`.
impl fmt::Display for PlannerKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let value = self.to_possible_value().expect("no planner is hidden");
        f.write_str(value.get_name())
    }
}
