//! Where one looks from.

use egui::{Color32, Mesh, Pos2, Rect, Shape, Vec2, vec2};
use planner_core::{Extent, Point};

use crate::colors::mix;

/// Width and height of the room that a scene takes whose diagonal is one long.
pub const SHAPE: Vec2 = vec2(1.0, 0.85);

/// How the user has turned the scene; the same for all that are beside each other.
#[derive(Clone, Copy, Debug)]
pub struct Turn {
    /// About the vertical, in radians.
    pub(super) about: f32,
    /// How steeply one looks down, in radians.
    pub(super) down: f32,
    /// How much larger than fitting.
    pub(super) zoom: f32,
}

impl Default for Turn {
    fn default() -> Self {
        Self {
            about: 0.7,
            down: 0.75,
            zoom: 1.0,
        }
    }
}

/// Turned about the middle of the scene, without perspective.
pub(super) struct Eye {
    middle: Vec2,
    /// 1 where y leads south, -1 where it leads north.
    south: f32,
    centre: Pos2,
    sine: f32,
    cosine: f32,
    /// How steeply one looks down, as sine and cosine.
    down: f32,
    along: f32,
    scale: f32,
}

impl Eye {
    /// Of a place whose y leads north if it is `northward`, else south.
    pub(super) fn new(extent: Extent, northward: bool, turn: Turn, rect: Rect) -> Self {
        let size = vec2(extent.width.into(), extent.height.into());
        let room = SHAPE * size.length();
        let fitting = (rect.width() / room.x).min(rect.height() / room.y);
        Self {
            middle: size / 2.0,
            south: if northward { -1.0 } else { 1.0 },
            centre: rect.center() + vec2(0.0, rect.height() * 0.05),
            sine: turn.about.sin(),
            cosine: turn.about.cos(),
            down: turn.down.sin(),
            along: turn.down.cos(),
            scale: fitting * turn.zoom,
        }
    }

    pub(super) fn project(&self, x: f32, y: f32, z: f32) -> Pos2 {
        let (x, y) = (x - self.middle.x, (y - self.middle.y) * self.south);
        let right = x * self.cosine - y * self.sine;
        let near = x * self.sine + y * self.cosine;
        self.centre + vec2(right, near * self.down - z * self.along) * self.scale
    }

    pub(super) fn over(&self, point: Point) -> Pos2 {
        self.project(point.x, point.y, point.z)
    }

    /// Points a cell, for what does not lean away.
    pub(super) fn scale(&self) -> f32 {
        self.scale
    }

    pub(super) fn east_is_near(&self) -> bool {
        self.sine > 0.0
    }

    /// Whether what has the larger y is nearer.
    pub(super) fn end_is_near(&self) -> bool {
        self.cosine * self.south > 0.0
    }

    /// All columns, far ones first.
    pub(super) fn columns(&self, extent: Extent) -> impl Iterator<Item = (i16, i16)> + use<> {
        let (width, height) = (extent.width as i16, extent.height as i16);
        let far = |at, end, end_is_near| if end_is_near { at } else { end - 1 - at };
        let (east, south) = (self.east_is_near(), self.end_is_near());
        (0..height).flat_map(move |y| {
            (0..width).map(move |x| (far(x, width, east), far(y, height, south)))
        })
    }
}

/// Blocks that stand over one column, painted in the order in which they come.
pub(super) struct Blocks<'a> {
    eye: &'a Eye,
    mesh: Mesh,
}

impl<'a> Blocks<'a> {
    pub(super) fn new(eye: &'a Eye) -> Self {
        Self {
            eye,
            mesh: Mesh::default(),
        }
    }

    fn quad(&mut self, corners: [Pos2; 4], color: Color32) {
        let first = self.mesh.vertices.len() as u32;
        for corner in corners {
            self.mesh.colored_vertex(corner, color);
        }
        self.mesh.add_triangle(first, first + 1, first + 2);
        self.mesh.add_triangle(first, first + 2, first + 3);
    }

    /// The side that faces the eye in the east or west.
    pub(super) fn across(&mut self, (x, y): (f32, f32), (low, high): (f32, f32), color: Color32) {
        let x = if self.eye.east_is_near() { x + 1.0 } else { x };
        let at = |dy, z| self.eye.project(x, y + dy, z);
        let corners = [at(0.0, high), at(1.0, high), at(1.0, low), at(0.0, low)];
        self.quad(corners, mix(color, Color32::BLACK, 0.3));
    }

    /// The side that faces the eye in the south or north.
    pub(super) fn along(&mut self, (x, y): (f32, f32), (low, high): (f32, f32), color: Color32) {
        let y = if self.eye.end_is_near() { y + 1.0 } else { y };
        let at = |dx, z| self.eye.project(x + dx, y, z);
        let corners = [at(0.0, high), at(1.0, high), at(1.0, low), at(0.0, low)];
        self.quad(corners, mix(color, Color32::BLACK, 0.45));
    }

    pub(super) fn top(&mut self, (x, y): (f32, f32), z: f32, color: Color32) {
        let at = |dx, dy| self.eye.project(x + dx, y + dy, z);
        let corners = [at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)];
        self.quad(corners, color);
    }

    pub(super) fn shape(self) -> Shape {
        Shape::mesh(self.mesh)
    }
}
