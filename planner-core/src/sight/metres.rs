//! From the units of the world to those of the grid, and back.
//!
//! ROS (REP 103) and the Crazyflie reckon in metres, with y to the left of x and angles
//! counter-clockwise. In the grid y grows to the south and angles from east to south: y
//! and every angle change their sign on the way, and here alone.

use super::Pose;
use crate::cell::{Cell, Direction};

impl Pose {
    /// The pose of a robot at `x`, `y` in metres, `y` to the left of `x` (x to the east: y
    /// to the north), whose `yaw` in radians grows counter-clockwise from x.
    ///
    /// `origin_mm` is where the north-western corner of the grid lies in the same frame,
    /// and `cell_mm` the side of a cell: those of the
    /// [`LinkConfig`](crate::radio::LinkConfig). A value that is not finite, or cells of
    /// 0 mm, give a pose that no scan is taken from.
    ///
    /// ```
    /// use planner_core::sight::Pose;
    ///
    /// // 8 m × 8 m around the place where the robot starts, in cells of 200 mm.
    /// let origin_mm = (-4000, 4000);
    /// let start = Pose::from_metres(0.0, 0.0, 0.0, origin_mm, 200);
    /// assert_eq!(start, Pose { x: 20.0, y: 20.0, heading: 0.0 });
    /// let left = Pose::from_metres(0.0, 1.0, 0.5, origin_mm, 200);
    /// assert_eq!(left, Pose { x: 20.0, y: 15.0, heading: -0.5 });
    /// ```
    pub fn from_metres(x: f32, y: f32, yaw: f32, origin_mm: (i32, i32), cell_mm: u16) -> Self {
        let (east, north) = (origin_mm.0 as f32, origin_mm.1 as f32);
        let side = f32::from(cell_mm);
        Self {
            x: (x * 1000.0 - east) / side,
            y: (north - y * 1000.0) / side,
            heading: -yaw,
        }
    }
}

impl Cell {
    /// The middle of the cell in the frame of [`Pose::from_metres`], in metres: where a
    /// robot goes that is sent to the cell.
    pub fn middle_in_metres(self, origin_mm: (i32, i32), cell_mm: u16) -> (f32, f32) {
        let (east, north) = (origin_mm.0 as f32, origin_mm.1 as f32);
        let side = f32::from(cell_mm);
        let along = |cell: i16| (f32::from(cell) + 0.5) * side;
        (
            (east + along(self.x)) / 1000.0,
            (north - along(self.y)) / 1000.0,
        )
    }
}

impl Direction {
    /// The direction as a yaw in radians, counter-clockwise from the east: north is π/2.
    pub const fn yaw(self) -> f32 {
        use core::f32::consts::{FRAC_PI_2, PI};
        match self {
            Self::East => 0.0,
            Self::South => -FRAC_PI_2,
            Self::West => PI,
            Self::North => FRAC_PI_2,
        }
    }
}
