//! Where the cells lie on the screen, and how the user moves over them.

use egui::{Pos2, Rect, Response, Ui, Vec2, pos2, vec2};
use planner_core::{Cell, Extent};

use super::Tool;
use crate::watch::Watch;

/// Which part of the map is looked at; the same in all views of one world.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    /// How much larger than fitting.
    pub zoom: f32,
    /// The point of the map in the middle, from 0 to 1 in each direction.
    pub centre: Pos2,
}

impl Default for Camera {
    fn default() -> Self {
        Self {
            zoom: 1.0,
            centre: pos2(0.5, 0.5),
        }
    }
}

/// Below so many points a cell, ways and plans are pixels of the ground: thousands of
/// lines take longer, and could not be told apart.
const COARSE: f32 = 3.0;

/// Moves and zooms.
pub(super) fn steer(ui: &Ui, response: &Response, camera: &mut Camera, place: &Place, tool: Tool) {
    if tool == Tool::Look && response.dragged() {
        let moved = response.drag_delta() / place.map().size();
        camera.centre -= moved;
    }
    if let Some(pointer) = response.hover_pos() {
        let (pinch, wheel) = ui.input(|input| (input.zoom_delta(), input.smooth_scroll_delta().y));
        let factor = pinch * (wheel / 300.0).exp();
        let zoom = (camera.zoom * factor).clamp(1.0, 40.0);
        if zoom != camera.zoom {
            // The point under the pointer stays where it is.
            let point = (pointer - place.map().min) / place.map().size();
            let away = point - camera.centre.to_vec2();
            camera.centre += away * (1.0 - camera.zoom / zoom);
            camera.zoom = zoom;
        }
    }
    let most = 0.5 - 0.5 / camera.zoom;
    camera.centre = camera
        .centre
        .clamp(pos2(0.5 - most, 0.5 - most), pos2(0.5 + most, 0.5 + most));
}

/// Where the cells lie on the screen.
pub(super) struct Place {
    /// The top left corner of the map.
    origin: Pos2,
    /// Points a cell.
    pub(super) scale: f32,
    extent: Extent,
}

impl Place {
    pub(super) fn new(rect: Rect, extent: Extent, camera: &Camera) -> Self {
        let size = vec2(extent.width.into(), extent.height.into());
        let fitting = (rect.width() / size.x).min(rect.height() / size.y);
        let scale = (fitting * camera.zoom).max(0.01);
        Self {
            origin: rect.center() - camera.centre.to_vec2() * size * scale,
            scale,
            extent,
        }
    }

    pub(super) fn map(&self) -> Rect {
        let size = vec2(self.extent.width.into(), self.extent.height.into());
        Rect::from_min_size(self.origin, size * self.scale)
    }

    /// The middle of a cell.
    pub(super) fn middle(&self, cell: Cell) -> Pos2 {
        self.origin + vec2(f32::from(cell.x) + 0.5, f32::from(cell.y) + 0.5) * self.scale
    }

    pub(super) fn cell(&self, at: Pos2) -> Option<Cell> {
        let place = (at - self.origin) / self.scale;
        let cell = Cell::new(place.x.floor() as i16, place.y.floor() as i16);
        self.extent.contains(cell).then_some(cell)
    }

    /// Whether cells are too small for lines between them.
    pub(super) fn is_coarse(&self) -> bool {
        self.scale < COARSE
    }

    /// Radius of a robot: large enough to be seen and hit on any map.
    pub(super) fn robot(&self) -> f32 {
        (self.scale * 0.42).clamp(3.5, 14.0)
    }

    /// A little aside, so that the ways of several robots stay apart.
    pub(super) fn lane(&self, robot: usize, robots: usize) -> Vec2 {
        let lanes = robots.min(7) as f32;
        let lane = (robot % 7) as f32 - (lanes - 1.0) / 2.0;
        Vec2::splat(lane / lanes * self.scale * 0.6)
    }
}

pub(super) fn robot_at(watch: &Watch, place: &Place, at: Pos2) -> Option<usize> {
    let near = |cell: Cell| place.middle(cell).distance(at);
    let positions = watch.positions().into_iter().enumerate();
    let (robot, distance) = positions
        .map(|(robot, cell)| (robot, near(cell)))
        .min_by(|a, b| a.1.total_cmp(&b.1))?;
    (distance <= place.robot() + 6.0).then_some(robot)
}
