//! Shares of the work.

use std::fmt;
use std::str::FromStr;

use super::plan::Plan;

/// A share of the worlds of a plan, written `I/N` with I from 1: of each family every N-th
/// world, so that shares take about as long as each other. No two shares of N have a world
/// in common, and all N have every world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    index: usize,
    count: usize,
}

impl Shard {
    /// The whole plan.
    pub const ALL: Self = Self { index: 0, count: 1 };

    /// The numbers of its worlds, in ascending order. Empty where a plan has fewer worlds
    /// than there are shares.
    pub fn of(self, plan: &Plan) -> Vec<usize> {
        let mut dealt: Vec<usize> = (0..plan.sites.len()).collect();
        dealt.sort_by_cached_key(|&site| plan.sites[site].family());
        let mut own: Vec<usize> = dealt
            .into_iter()
            .skip(self.index)
            .step_by(self.count)
            .collect();
        own.sort_unstable();
        own
    }
}

impl FromStr for Shard {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        text.split_once('/')
            .and_then(|(index, count)| Some((index.parse().ok()?, count.parse().ok()?)))
            .filter(|&(index, count): &(usize, usize)| (1..=count).contains(&index))
            .map(|(index, count)| Self {
                index: index - 1,
                count,
            })
            .ok_or("expected I/N with I from 1 to N, for example 2/8")
    }
}

/// For file names: `2-of-8`.
impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}-of-{}", self.index + 1, self.count)
    }
}
