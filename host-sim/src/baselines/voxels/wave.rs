//! The ways from one place to all that can be reached over known ground.

use std::collections::VecDeque;

use planner_core::volume::Voxel;

use super::Chart;

/// A breadth-first search over the places of a chart.
pub(super) struct Wave {
    /// By place: steps, and where the last one came from; nothing where no way leads.
    steps: Vec<Option<(u32, Voxel)>>,
    front: VecDeque<Voxel>,
    start: Voxel,
}

impl Wave {
    pub(super) fn new(chart: &Chart, start: Voxel) -> Self {
        let mut steps = vec![None; chart.size()];
        if let Some(index) = chart.index(start) {
            steps[index] = Some((0, start));
        }
        Self {
            steps,
            front: VecDeque::from([start]),
            start,
        }
    }

    /// The next place, by the number of steps.
    pub(super) fn next(&mut self, chart: &Chart) -> Option<Voxel> {
        let at = self.front.pop_front()?;
        let (steps, _) = self.steps[chart.index(at)?]?;
        for beside in at.beside() {
            if let Some(index) = chart.index(beside)
                && self.steps[index].is_none()
                && chart.is_pose(beside)
            {
                self.steps[index] = Some((steps + 1, at));
                self.front.push_back(beside);
            }
        }
        Some(at)
    }

    /// Steps to `place`, if a way leads there.
    pub(super) fn steps_to(&self, chart: &Chart, place: Voxel) -> Option<u32> {
        let index = chart.index(place)?;
        self.steps[index].map(|(steps, _)| steps)
    }

    /// The first step on the way to `place`; the place itself if the robot is there.
    pub(super) fn first_step(&self, chart: &Chart, place: Voxel) -> Option<Voxel> {
        let mut at = place;
        loop {
            let (_, before) = self.steps[chart.index(at)?]?;
            if before == self.start {
                return Some(at);
            }
            at = before;
        }
    }
}
