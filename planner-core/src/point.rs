//! Points in space.

use crate::cell::Cell;
use crate::math;

/// A position in the air or on the surface. The unit of all three axes is one
/// cell; `z` grows upwards and is 0 at the bottom of the mapped box.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Point {
    /// East.
    pub x: f32,
    /// South.
    pub y: f32,
    /// Up.
    pub z: f32,
}

impl Point {
    /// The point `(x, y, z)`.
    pub const fn new(x: f32, y: f32, z: f32) -> Self {
        Self { x, y, z }
    }

    /// The point at height `z` over the centre of `cell`.
    pub const fn over(cell: Cell, z: f32) -> Self {
        Self::new(cell.x as f32 + 0.5, cell.y as f32 + 0.5, z)
    }

    /// The column of cells that the point is in.
    pub fn cell(self) -> Cell {
        Cell::new(math::floor(self.x) as i16, math::floor(self.y) as i16)
    }

    /// This point moved by `(dx, dy, dz)`.
    pub const fn offset(self, dx: f32, dy: f32, dz: f32) -> Self {
        Self::new(self.x + dx, self.y + dy, self.z + dz)
    }

    /// Euclidean distance.
    pub fn distance(self, other: Self) -> f32 {
        math::sqrt(self.distance_squared(other))
    }

    /// Squared Euclidean distance.
    pub const fn distance_squared(self, other: Self) -> f32 {
        let (dx, dy, dz) = (self.x - other.x, self.y - other.y, self.z - other.z);
        dx * dx + dy * dy + dz * dz
    }

    /// Distance between the two points' places on the ground plan.
    pub fn plan_distance(self, other: Self) -> f32 {
        math::length(self.x - other.x, self.y - other.y)
    }

    /// Whether all three coordinates are numbers.
    pub const fn is_finite(self) -> bool {
        self.x.is_finite() && self.y.is_finite() && self.z.is_finite()
    }
}
