//! What a fleet has mapped, as voxels.

use std::collections::HashMap;

use planner_core::Direction;

use super::Trace;
use crate::scene::octree::OcTree;

impl Trace {
    /// The surface seen after `steps` steps as occupied voxels of one metre: the highest of
    /// each column, and below it those that a lower column beside it lays open.
    pub fn octree(&self, steps: u32) -> OcTree {
        let tops: HashMap<_, _> = self
            .mapped(steps)
            .map(|column| (column.cell, column.height.cells().floor() as i32))
            .collect();
        let mut tree = OcTree::new(1.0);
        for column in self.mapped(steps) {
            let cell = column.cell;
            let top = tops[&cell];
            let beside = Direction::ALL
                .into_iter()
                .filter_map(|way| tops.get(&cell.step(way)));
            let lowest = beside
                .copied()
                .min()
                .map_or(top, |lowest| top.min(lowest + 1));
            for z in lowest..=top {
                tree.insert([i32::from(cell.x), i32::from(cell.y), z], true);
            }
        }
        tree
    }
}
