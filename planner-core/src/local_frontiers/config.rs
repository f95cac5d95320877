//! Parameters, and the readings of what the published text leaves open.

use crate::cell::Cell;
use crate::map::Map;
use crate::radio::LinkConfig;

/// Parameters of the local-frontiers planner. [`Default`] is the paper's
/// experiment, with the most charitable reading of what the text leaves open.
///
/// Not a parameter: a goal must be connected to the robot through cells in view,
/// since step 3c could not be carried out otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Config {
    /// Moves for which a goal is kept before another one may be chosen, `d_max`
    /// [Gauville2019 §3.2]. 2 in the paper; 0 chooses anew on every tick.
    pub d_max: u16,
    /// Whether the robot leaves its start again to follow the others' traces
    /// [Gauville2019 §6.1]. Off by default.
    pub second_chance: bool,
    /// Reading of "having unexplored neighbours": four by default.
    pub neighbourhood: Neighbourhood,
    /// Reading of "the farthest from any visited cell": Euclidean by default.
    pub distance: Distance,
    /// Reading: a goal that is no frontier any more is dropped (default), and not
    /// held until it is reached or expires.
    pub drop_resolved: bool,
    /// Reading: a goal that expired and is still a frontier is kept while no
    /// frontier is in view (default). Not in the text, and charitable: without it
    /// the robot turns back.
    pub keep_expired: bool,
    /// Reading: a goal that went out of view is approached, through the cell in
    /// view that is nearest to it, as long as that one is nearer than the robot
    /// (default). Otherwise it is dropped: no path leads to it "among the visible
    /// cells".
    pub approach_hidden: bool,
    /// Ticks without news after which another robot no longer counts as
    /// exploring; it is forgotten at the latest after twice as many. Not in the
    /// paper, where no robot dies: it keeps a second chance from lasting for ever.
    pub silence: u32,
    /// How the radio is used.
    pub link: LinkConfig,
}

impl Config {
    /// All zero: what a planner without a grid holds.
    pub(super) const VACANT: Self = Self {
        d_max: 0,
        second_chance: false,
        neighbourhood: Neighbourhood::Four,
        distance: Distance::Euclidean,
        drop_resolved: false,
        keep_expired: false,
        approach_hidden: false,
        silence: 0,
        link: LinkConfig::vacant(),
    };
}

impl Default for Config {
    fn default() -> Self {
        Self {
            d_max: 2,
            drop_resolved: true,
            keep_expired: true,
            approach_hidden: true,
            silence: 1000,
            link: LinkConfig::new(),
            ..Self::VACANT
        }
    }
}

/// Which cells are the neighbours that make a frontier.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Neighbourhood {
    /// Those with a side in common.
    Four,
    /// Those with a side or a corner in common.
    Eight,
}

impl Neighbourhood {
    /// Whether `cell` is free and has an unknown neighbour.
    pub(super) fn is_frontier<const TW: usize, const TH: usize>(
        self,
        map: &Map<TW, TH>,
        cell: Cell,
    ) -> bool {
        const CORNERS: [(i16, i16); 4] = [(-1, -1), (1, -1), (-1, 1), (1, 1)];
        map.is_frontier(cell)
            || self == Self::Eight
                && map.is_free(cell)
                && CORNERS.into_iter().any(|(dx, dy)| {
                    let corner = Cell::new(cell.x.saturating_add(dx), cell.y.saturating_add(dy));
                    !map.is_known(corner)
                })
    }
}

/// How far two cells are apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Distance {
    /// In a straight line.
    Euclidean,
    /// In steps, if nothing stands in the way.
    Manhattan,
}

impl Distance {
    /// A number that grows with the distance; comparable under the same measure.
    pub(super) const fn measure(self, dx: u32, dy: u32) -> u32 {
        match self {
            Self::Euclidean => dx * dx + dy * dy,
            Self::Manhattan => dx + dy,
        }
    }
}
