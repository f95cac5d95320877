//! What a run among voxels leaves behind.

mod file;

use planner_core::Stop;
use planner_core::volume::{Heading, Voxel};

use serde::{Deserialize, Serialize};

use crate::scenario::voxels::Scenario;
use crate::scene::octree::OcTree;
use crate::scene::{Frame, Marks, Scene};

pub use file::{Record, Voxels};

/// A whole run.
#[derive(Clone, Debug)]
pub struct VoxelTrace {
    /// What was run.
    pub scenario: Scenario,
    /// Where.
    pub scene: Scene,
    /// Where each robot was, step by step from its start.
    pub ways: Vec<Vec<Voxel>>,
    /// Where each robot's sensor was turned, step by step; empty if it shows all round.
    pub headings: Vec<Vec<Heading>>,
    /// Every decision, in order.
    pub records: Vec<Record>,
    /// Voxels in the order in which they were seen, each with the step and with whether the
    /// robots take it for occupied; once more in each step in which that has changed.
    pub found: Vec<(u32, Voxel, bool)>,
    /// Occupied voxels that can be seen from any place that can be reached: all that
    /// there is to see.
    pub visible: u32,
    /// Those that somebody had seen after each number of steps, from 0.
    pub seen: Vec<u32>,
    /// Whether every robot had stopped.
    pub all_stopped: bool,
    /// Why each robot had stopped at the end, if it had.
    pub stops: Vec<Option<Stop<Voxel>>>,
    /// Flights into or beside something, or longer than a voxel. A trace does not say where a
    /// robot flew that the wind pushed: then none is counted when it is read.
    pub violations: u32,
    /// Steps that the wind ended beside or in something.
    pub contacts: u32,
    /// Steps that ended at an obstacle that a look may have hidden. A trace does not say it: 0
    /// when it is read, and so are the false claims.
    pub bumps: u32,
    /// Living robots that say in the end that all that they could see is known, while a voxel
    /// that can be seen is not known to them.
    pub false_claims: u32,
    /// What each robot's map had wrong in the end; empty if no look may mistake anything.
    pub wrong: Vec<Wrong>,
}

/// What a map says otherwise than it is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Wrong {
    /// Free voxels that are occupied on it.
    pub closed: u32,
    /// Occupied voxels that are free on it.
    pub opened: u32,
}

impl VoxelTrace {
    /// Where the first robot started.
    pub fn start(&self) -> Option<Voxel> {
        self.ways.first().and_then(|way| way.first()).copied()
    }

    /// Whether anything is over that place.
    pub fn starts_covered(&self) -> bool {
        self.start().is_some_and(|start| {
            let above = start.z.saturating_add(1)..i16::from(self.scene.levels());
            let mut above = above.map(|z| Voxel { z, ..start });
            above.any(|voxel| self.scene.is_occupied(voxel))
        })
    }

    /// Steps until `share` of all that there is to see had been seen.
    pub fn ticks_to(&self, share: f64) -> Option<u32> {
        let wanted = (share * f64::from(self.visible)).ceil() as u32;
        let tick = self.seen.iter().position(|&seen| seen >= wanted);
        tick.map(|tick| tick as u32)
    }

    /// Voxels that the scene does not know beside free ones that were seen: there the scan
    /// ends.
    pub fn edge(&self) -> u32 {
        let mut seen = Marks::of(&self.scene);
        for (_, voxel, _) in &self.found {
            seen.insert(&self.scene, *voxel);
        }
        self.scene.edge(|voxel| seen.contains(&self.scene, voxel))
    }

    /// Whether everything that can be seen was seen, without a violation.
    pub fn complete(&self) -> bool {
        let all = Some(&self.visible).filter(|&&all| all > 0);
        all.is_some() && self.seen.last() == all && self.violations == 0
    }

    /// The robots' map after `tick` steps: voxels that were seen, each with whether it is taken for
    /// occupied.
    pub fn map(&self, tick: u32) -> Vec<(Voxel, bool)> {
        let mut told = Marks::of(&self.scene);
        let known = self.found.partition_point(|found| found.0 <= tick);
        let newest_first = self.found[..known].iter().rev();
        let newest = newest_first.filter(|found| told.insert(&self.scene, found.1));
        let mut map: Vec<_> = newest.map(|found| (found.1, found.2)).collect();
        map.reverse();
        map
    }

    /// That map as an octree, free voxels included, with the coordinates and the resolution of the
    /// scene's file.
    pub fn octree(&self, tick: u32) -> OcTree {
        let frame = self.scene.frame().unwrap_or(Frame::PLAIN);
        let mut tree = OcTree::new(frame.voxel_size);
        for (voxel, occupied) in self.map(tick) {
            tree.insert(frame.key(voxel), occupied);
        }
        tree
    }
}
