//! What a robot sees: every column within range whose ground is in line of sight.

use planner_core::surface::{Column, in_sight};
use planner_core::{Cell, Point};

use super::Terrain;

/// The columns that `eye` sees within `range` cells [Renzaglia2019 §3].
pub fn look(terrain: &Terrain, eye: Point, range: f32) -> Vec<Column> {
    let centre = eye.cell();
    let reach = range.ceil() as i16;
    let mut seen = Vec::new();
    for y in centre.y - reach..=centre.y + reach {
        for x in centre.x - reach..=centre.x + reach {
            let cell = Cell::new(x, y);
            let Some(height) = terrain.height(cell) else {
                continue;
            };
            let ground = Point::over(cell, height.cells());
            if eye.distance_squared(ground) <= range * range
                && in_sight(eye, ground, |cell| terrain.height(cell))
            {
                seen.push(Column { cell, height });
            }
        }
    }
    seen
}
