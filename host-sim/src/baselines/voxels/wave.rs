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
    /// Which of the six directions comes first.
    first: usize,
}

impl Wave {
    /// Of ways of equal length, those of robot `id` begin in another direction than those of
    /// the next: robots that stand together part.
    pub(super) fn new(chart: &Chart, start: Voxel, id: usize) -> Self {
        let mut steps = vec![None; chart.size()];
        if let Some(index) = chart.index(start) {
            steps[index] = Some((0, start));
        }
        Self {
            steps,
            front: VecDeque::from([start]),
            start,
            first: id % 6,
        }
    }

    /// The next place, by the number of steps.
    pub(super) fn next(&mut self, chart: &Chart) -> Option<Voxel> {
        let at = self.front.pop_front()?;
        let (steps, _) = self.steps[chart.index(at)?]?;
        let mut besides = at.beside();
        besides.rotate_left(self.first);
        for beside in besides {
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
