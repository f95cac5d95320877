//! How an explorer decides.

use super::evidence::SensorModel;
use super::near::NearSearch;
use super::{TICK_WORK, body, far};
use crate::radio::LinkConfig;
use crate::role;

/// How an explorer decides. One configuration serves a whole fleet; none of it
/// depends on the map's size or the number of robots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Config {
    /// Work a tick, in instructions of a Cortex-M4F. The near decision takes of it what it
    /// needs, the far search gets the rest, and a quarter at least.
    pub slice: u32,
    /// Steps after which the robot decides again.
    pub d_max: u8,
    /// Changes to a longer plan between two things learnt.
    pub tokens: u8,
    /// By how many steps a frontier near the goal chosen last is preferred.
    pub hysteresis: u8,
    /// Ticks that a far goal is kept before another is searched for.
    pub far_pause: u32,
    /// Ticks after which a robot that was not heard of is forgotten.
    pub memory: u32,
    /// Rounds of trying cells that refuse a step, and as often waiting for them, 4, 8, 16
    /// … ticks, before the robot gives them up; at least 1. See `aside`.
    pub patience: u8,
    /// Looks in each direction that shows nothing before a frontier is set aside; 1 to 50,
    /// others are brought into these bounds.
    pub looks: u8,
    /// Ticks on end in which a robot in the way is let go first; then its cell counts as
    /// one that refuses.
    pub holds: u8,
    /// Steps of the way that are remembered, 1 to 256: where they are used up, the robot
    /// searches for the rest. Small numbers are for tests.
    pub way: u16,
    /// Ticks after which a robot that is done looks again at places that were free and are
    /// walls now, in turn, instead of stopping; 0: it stops.
    pub patrol: u16,
    /// Cells that the robot's body reaches beyond the one that its centre is in, 0 to 3; more
    /// counts as 3. The body lies in the disc dx² + dy² ≤ (clearance + ½)²: 1, 9, 21 or 37
    /// cells. Looks must show what is within `clearance` + 2 cells. All robots of a fleet
    /// have the same.
    pub clearance: u8,
    /// Whether a robot that has explored goes home, to where it started, before it stops;
    /// see [`Errands`](crate::planner::Errands).
    pub come_home: bool,
    /// Steps that the robot's energy lasts for, as by
    /// [`Errands::energy`](crate::planner::Errands::energy) at the start; 0: no limit.
    pub energy: u32,
    /// How far looks are believed.
    pub sensor: SensorModel,
    /// How the radio is used.
    pub link: LinkConfig,
}

impl Config {
    /// The configuration that is shipped.
    pub const fn new() -> Self {
        Self {
            slice: 232_000,
            d_max: 2,
            tokens: 2,
            hysteresis: 3,
            far_pause: 8,
            memory: 256,
            patience: 8,
            looks: 2,
            holds: 64,
            way: role::CAPACITY as u16,
            patrol: 0,
            clearance: 0,
            come_home: false,
            energy: 0,
            sensor: SensorModel::truthful(),
            link: LinkConfig::new(),
        }
    }

    /// That of a planner before its reset.
    pub(super) const fn vacant() -> Self {
        Self {
            slice: 0,
            d_max: 0,
            tokens: 0,
            hysteresis: 0,
            far_pause: 0,
            memory: 0,
            patience: 0,
            looks: 0,
            holds: 0,
            way: 0,
            patrol: 0,
            clearance: 0,
            come_home: false,
            energy: 0,
            sensor: SensorModel::vacant(),
            link: LinkConfig::vacant(),
        }
    }

    /// No [`Planner::tick`](crate::Planner::tick) counts more work than this, in instructions of a Cortex-M4F. What
    /// is counted is weighed so that no tick takes a tenth more.
    pub const fn work_bound(&self) -> u32 {
        let with_least = NearSearch::LARGEST_WORK + self.least_far() + far::WAY_WORK;
        let most = if self.slice > with_least {
            self.slice
        } else {
            with_least
        };
        let body = match self.clearance {
            0 => 0,
            _ => body::CELLS_WORK + 5 * body::WINDOW_WORK + 4 * body::TILE_WORK,
        };
        most.saturating_add(TICK_WORK + far::LAST_WORK + body)
    }

    /// What the far search gets of a tick in any case.
    pub(super) const fn least_far(&self) -> u32 {
        self.slice / 4 + 1
    }
}

impl Default for Config {
    fn default() -> Self {
        Self::new()
    }
}
