//! Robots that fly as the baselines say.

use planner_core::radio::{FrameError, MAX_LEN};
use planner_core::tile::TileIndex;
use planner_core::volume::{Content, Heading, Voxel, VoxelPatch};
use planner_core::{Action, Extent, RobotId, Status};

use super::pilot::Pilot;
use crate::baselines::voxels::{Body, Chart, closest};

/// Steps without anything learnt after which the way out of `voxel_survey` is taken: as
/// many as that planner waits before no rival counts.
const PATIENCE: u32 = 512;

/// A robot with the map, the radio and the way out of `voxel_survey`, which it takes when no
/// place that it can reach shows a frontier: so it ends for the same reasons.
pub(super) struct Follower {
    inner: Box<dyn Pilot>,
    id: RobotId,
    /// What it knows, for the closest frontier.
    chart: Chart,
    /// What the centre says, where there is one: the next place, and the work of finding it.
    order: Option<(Option<Voxel>, u32)>,
    known: u32,
    idle: u32,
    /// Voxels known when no place that could be reached showed a frontier.
    exhausted: Option<u32>,
    work: u32,
}

impl Follower {
    pub(super) fn new(inner: Box<dyn Pilot>, id: RobotId, body: Body) -> Self {
        let chart = Chart::new(inner.extent(), inner.levels(), body);
        Self {
            inner,
            id,
            chart,
            order: None,
            known: 0,
            idle: 0,
            exhausted: None,
            work: 0,
        }
    }
}

impl Pilot for Follower {
    fn tick(&mut self) -> Action<Voxel, Voxel> {
        let (known, here) = (self.inner.known_voxels(), self.inner.status().position);
        self.idle = if known == self.known {
            self.idle + 1
        } else {
            0
        };
        self.known = known;
        self.chart.copy(|voxel| self.inner.content(voxel));
        let (to, work) = match self.order {
            _ if self.idle > PATIENCE => (None, 0),
            Some(order) => order,
            None if self.exhausted == Some(known) => (None, 0),
            None => closest(&mut self.chart, self.id, here),
        };
        self.work = work;
        if self.order.is_none() && to.is_none() {
            self.exhausted = Some(known);
        }
        // What the centre says of a place that this robot knows otherwise is not flown.
        match to.filter(|&to| self.chart.is_pose(to)) {
            Some(to) => {
                self.inner.pass();
                match to == here {
                    true => Action::Wait,
                    false => Action::Move(to),
                }
            }
            None => {
                let action = self.inner.tick();
                self.work += self.inner.work();
                action
            }
        }
    }

    fn obey(&mut self, to: Option<Voxel>, work: u32) {
        self.order = Some((to, work));
    }

    fn work(&self) -> u32 {
        self.work
    }

    fn pass(&mut self) {
        self.inner.pass();
    }

    fn observe(&mut self, at: Voxel, heading: Heading, seen: &[(Voxel, bool)]) {
        self.inner.observe(at, heading, seen);
    }

    fn heading(&self) -> Heading {
        self.inner.heading()
    }

    fn resume(&mut self) {
        self.idle = 0;
        self.exhausted = None;
        self.inner.resume();
    }

    fn energy(&mut self, left: u32) {
        self.inner.energy(left);
    }

    fn status(&self) -> Status<Voxel> {
        self.inner.status()
    }

    fn hear(&mut self, id: RobotId, status: Status<Voxel>) {
        self.inner.hear(id, status);
    }

    fn transmit(&mut self, buffer: &mut [u8; MAX_LEN]) -> Option<usize> {
        self.inner.transmit(buffer)
    }

    fn receive(&mut self, frame: &[u8]) -> Result<u32, FrameError> {
        self.inner.receive(frame)
    }

    fn merge(&mut self, patch: &VoxelPatch) {
        self.inner.merge(patch);
    }

    fn patch(&self, tile: TileIndex, z: u8) -> VoxelPatch {
        self.inner.patch(tile, z)
    }

    fn after(&self, tile: TileIndex, z: u8) -> (TileIndex, u8) {
        self.inner.after(tile, z)
    }

    fn known_voxels(&self) -> u32 {
        self.inner.known_voxels()
    }

    fn content(&self, voxel: Voxel) -> Content {
        self.inner.content(voxel)
    }

    fn extent(&self) -> Extent {
        self.inner.extent()
    }

    fn levels(&self) -> u8 {
        self.inner.levels()
    }
}
