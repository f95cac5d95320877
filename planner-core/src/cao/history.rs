//! The last few measurements of the objective.

use heapless::Vec;

use super::Sample;
use crate::list;
use crate::point::Point;

/// The last `H` positions and rewards, the current one included; oldest first.
#[derive(Clone, Debug)]
pub(crate) struct History<const H: usize>(Vec<(Point, f32), H>);

impl<const H: usize> History<H> {
    pub(crate) const fn new() -> Self {
        Self(Vec::new())
    }

    pub(crate) fn push(&mut self, at: Point, reward: f32) {
        list::push_out(&mut self.0, (at, reward));
    }

    pub(crate) fn len(&self) -> usize {
        self.0.len()
    }

    /// Largest distance of a measurement from `here`.
    pub(crate) fn reach(&self, here: Point) -> f32 {
        self.0
            .iter()
            .map(|(at, _)| at.distance(here))
            .fold(0.0, f32::max)
    }

    /// Oldest first, each with weight 1 and the mean of all rewards taken off.
    pub(crate) fn centred(&self) -> Vec<Sample, H> {
        let sum: f32 = self.0.iter().map(|(_, reward)| reward).sum();
        let mean = sum / self.len().max(1) as f32;
        self.samples(|reward| reward - mean, 1.0)
    }

    /// Oldest first, with `value` of each reward.
    pub(crate) fn samples(&self, value: impl Fn(f32) -> f32, weight: f32) -> Vec<Sample, H> {
        let mut samples = Vec::new();
        for &(at, reward) in &self.0 {
            // As long as the buffer that it is read from.
            let _ = samples.push(Sample {
                at,
                value: value(reward),
                weight,
            });
        }
        samples
    }
}
