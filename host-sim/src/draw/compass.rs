//! Which way is north in a picture, and how long a cell is there.

use image::RgbImage;
use planner_core::volume::Voxel;
use planner_core::{Cell, Extent, Point};

use crate::record::heights::Trace;
use crate::record::voxels::VoxelTrace;

/// Which way the rows of a place lead. Pictures have the north above, whichever it is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rows {
    count: u16,
    northward: bool,
}

impl Rows {
    /// Of a terrain: those of drawn ones and of pictures lead south.
    pub(super) fn of_heights(trace: &Trace) -> Self {
        Self {
            count: trace.extent.height,
            northward: trace.terrain.scale().is_some_and(|scale| scale.northward),
        }
    }

    /// Of a scene of voxels, whose y leads north.
    pub(super) fn of_voxels(extent: Extent) -> Self {
        Self {
            count: extent.height,
            northward: true,
        }
    }

    /// A cell, counted from the north.
    pub(super) fn cell(self, cell: Cell) -> Cell {
        match self.northward {
            true => Cell::new(cell.x, self.count as i16 - 1 - cell.y),
            false => cell,
        }
    }

    /// The upper left corner of a cell in a picture from above, whose cells are `scale` pixels wide.
    pub(super) fn corner(self, cell: Cell, scale: u32) -> (f32, f32) {
        let Cell { x, y } = self.cell(cell);
        (f32::from(x) * scale as f32, f32::from(y) * scale as f32)
    }

    /// A point, counted from the north.
    pub(super) fn point(self, at: Point) -> Point {
        match self.northward {
            true => Point::new(at.x, f32::from(self.count) - at.y, at.z),
            false => at,
        }
    }
}

/// The ways of all robots until a step.
pub(super) fn ways_over_heights(trace: &Trace, step: u32) -> Vec<Vec<Point>> {
    let rows = Rows::of_heights(trace);
    let way = |robot| trace.way(robot, step).into_iter();
    (0..trace.robots)
        .map(|robot| way(robot).map(|at| rows.point(at)).collect())
        .collect()
}

/// The same among voxels.
pub(super) fn ways_among_voxels(trace: &VoxelTrace, tick: u32) -> Vec<Vec<Point>> {
    let rows = Rows::of_voxels(trace.scene.extent());
    let middle = |at: &Voxel| rows.point(Point::over(at.cell(), f32::from(at.z) + 0.5));
    let flown = (tick as usize).saturating_add(1);
    let ways = trace.ways.iter();
    ways.map(|way| way.iter().take(flown).map(middle).collect())
        .collect()
}

/// A picture, and how many pixels a cell's side takes in it: to the east, to the north and up.
pub(super) struct Drawn {
    pub(super) image: RgbImage,
    pub(super) sides: Sides,
}

/// See [`Drawn`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Sides {
    pub(super) east: (f32, f32),
    pub(super) north: (f32, f32),
    /// Nothing in a picture from above.
    pub(super) up: Option<(f32, f32)>,
}

impl Sides {
    /// Of a picture from above, whose cells are `scale` pixels wide.
    pub(super) fn from_above(scale: u32) -> Self {
        let side = scale as f32;
        Self {
            east: (side, 0.0),
            north: (0.0, -side),
            up: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_north_is_above_whichever_way_rows_lead() {
        let count = 10;
        let [south, north] = [false, true].map(|northward| Rows { count, northward });
        let (first, last) = (Cell::new(3, 0), Cell::new(3, 9));
        assert_eq!((south.cell(first), north.cell(first)), (first, last));
        let at = Point::over(first, 2.0);
        assert_eq!(
            (south.point(at), north.point(at)),
            (at, Point::over(last, 2.0))
        );
        assert_eq!(north.corner(first, 6), (18.0, 54.0));
    }
}
