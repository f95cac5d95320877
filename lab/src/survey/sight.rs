//! What sensors show of what is in range, as outlines in space.

use egui::{Color32, Pos2, Shape, Stroke, Vec2};
use planner_core::Point;
use planner_core::volume::{Field, Heading};

use super::eye::Eye;
use crate::view::lines;

/// Straight parts of a quarter of a circle.
const PARTS: i16 = 12;

/// How far a sensor shows something, and what of that.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sight {
    /// In cells.
    pub(super) range: f32,
    pub(super) field: Field,
}

impl Sight {
    /// What a sensor at `at` has in its field: of a camera the edges of its image up to the
    /// range, of a lidar its disc, of half a sphere a bowl, of a whole one its circle.
    pub(super) fn outline(
        &self,
        eye: &Eye,
        (at, heading): (Point, Heading),
        color: Color32,
    ) -> Vec<Shape> {
        let stroke = Stroke::new(1.5, color);
        let Some(side) = self.field.side else {
            return self.round(eye, at, stroke);
        };
        let corners = self.corners(side);
        let end = |aside, above| eye.over(self.end((at, heading), aside, above));
        let rim = (0..4).flat_map(|corner| {
            let (from, to) = (corners[corner], corners[(corner + 1) % 4]);
            (0..PARTS).map(move |part| {
                let share = f32::from(part) / f32::from(PARTS);
                let between = |a: f32, b: f32| a + (b - a) * share;
                end(between(from.0, to.0), between(from.1, to.1))
            })
        });
        let mut shapes = closed(rim.collect(), stroke);
        let edges = corners.map(|(aside, above)| [eye.over(at), end(aside, above)]);
        shapes.extend(edges.map(|edge| Shape::line_segment(edge, stroke)));
        shapes
    }

    /// The corners of an image: tangents of the angles aside and above.
    fn corners(&self, side: u16) -> [(f32, f32); 4] {
        let tangents = [side, self.field.down, self.field.up].map(|of| f32::from(of) / 256.0);
        let [side, down, up] = tangents;
        [(-side, -down), (side, -down), (side, up), (-side, up)]
    }

    /// Where that part of the image that lies so far aside and above ends.
    fn end(&self, (at, heading): (Point, Heading), aside: f32, above: f32) -> Point {
        let away = self.range / (1.0 + aside * aside + above * above).sqrt();
        let (south, east) = angle(heading).sin_cos();
        Point {
            x: at.x + away * (east - aside * south),
            y: at.y + away * (south + aside * east),
            z: at.z + away * above,
        }
    }

    fn round(&self, eye: &Eye, at: Point, stroke: Stroke) -> Vec<Shape> {
        let circle = (0..4 * PARTS).map(|part| {
            let (south, east) = quarter(part).sin_cos();
            let (x, y) = (at.x + self.range * east, at.y + self.range * south);
            eye.project(x, y, at.z)
        });
        let circle: Vec<_> = circle.collect();
        let is_flat = (self.field.up, self.field.down) == (0, 0);
        if is_flat {
            let fill = stroke.color.gamma_multiply(0.15);
            return vec![Shape::convex_polygon(circle, fill, stroke)];
        }
        let mut shapes = closed(circle, stroke);
        if self.field.up == 0 {
            // Half a ball looks the same from everywhere, but for its rim.
            let radius = self.range * eye.scale();
            let below = (0..=2 * PARTS).map(|part| Vec2::angled(quarter(part)));
            let below = below.map(|way| eye.over(at) + way * radius);
            shapes.extend(lines(below, stroke));
        }
        shapes
    }
}

/// So many parts of a circle, in radians.
fn quarter(part: i16) -> f32 {
    f32::from(part) / f32::from(PARTS) * std::f32::consts::FRAC_PI_2
}

/// From x to y, in radians.
fn angle(heading: Heading) -> f32 {
    f32::from(heading.eighths()) * std::f32::consts::FRAC_PI_4
}

/// A direction in words, among voxels, where y leads north.
pub(super) fn name(heading: Heading) -> &'static str {
    const NAMES: [&str; 8] = [
        "east",
        "north-east",
        "north",
        "north-west",
        "west",
        "south-west",
        "south",
        "south-east",
    ];
    NAMES[usize::from(heading.eighths())]
}

fn closed(mut points: Vec<Pos2>, stroke: Stroke) -> Vec<Shape> {
    points.extend(points.first().copied());
    lines(points, stroke)
}

/// A beak that shows where a drone is turned; its disc hides the rest.
pub(super) fn beak(
    eye: &Eye,
    (at, heading): (Point, Heading),
    fill: Color32,
    stroke: Stroke,
) -> Shape {
    let (south, east) = angle(heading).sin_cos();
    let (middle, next) = (eye.over(at), eye.project(at.x + east, at.y + south, at.z));
    let ahead = (next - middle).normalized();
    let (tip, side) = (middle + ahead * 13.0, ahead.rot90() * 5.0);
    Shape::convex_polygon(vec![middle - side, tip, middle + side], fill, stroke)
}

#[cfg(test)]
mod tests {
    use planner_core::volume::Voxel;

    use super::*;

    /// The edges that are drawn are those of the field.
    #[test]
    fn the_edges_of_an_image_are_those_of_its_field() {
        let sight = Sight {
            range: 300.0,
            field: Field::CAMERA,
        };
        let eye = Voxel::new(400, 500, 600);
        let at = Point::over(eye.cell(), f32::from(eye.z) + 0.5);
        for heading in Heading::all() {
            for (aside, above) in sight.corners(256) {
                let shows = |aside, above| {
                    let Point { x, y, z } = sight.end((at, heading), aside, above);
                    let voxel = Voxel::new(x as i16, y as i16, z as i16);
                    let range = f64::from(eye.distance_squared(voxel)).sqrt();
                    assert!((range - 300.0).abs() < 2.0, "{range}");
                    Field::CAMERA.shows(eye, heading, voxel)
                };
                assert!(shows(0.97 * aside, 0.97 * above), "{heading:?}");
                assert!(!shows(1.03 * aside, above), "{heading:?}");
                assert!(!shows(aside, 1.03 * above), "{heading:?}");
            }
        }
    }
}
