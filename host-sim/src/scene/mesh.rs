//! Whether a triangle touches a voxel.

use super::shape::Point;

/// By what share of its side a cube is taken for larger: a wall on the border of two voxels
/// must lie in one of them, however the border is rounded.
const ROUNDING: f64 = 1e-9;

/// Whether `triangle` and the cube about `middle` have a point in common; `half` is half of
/// the cube's side.
///
/// By the separating axis theorem over the cube's three axes, the triangle's normal and the
/// nine products of their edges \[AkenineMoller2001\].
pub(super) fn touches(triangle: &[Point; 3], middle: Point, half: f64) -> bool {
    let corners = triangle.map(|corner| minus(corner, middle));
    let [a, b, c] = corners;
    let edges = [minus(b, a), minus(c, b), minus(a, c)];
    let half = half * (1.0 + ROUNDING);
    let is_apart = |axis: Point| {
        let reach = half * axis.iter().map(|it| it.abs()).sum::<f64>();
        let along = corners.map(|corner| dot(axis, corner));
        let (low, high) = (
            along.iter().copied().fold(f64::INFINITY, f64::min),
            along.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        );
        low > reach || high < -reach
    };
    let units = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut products = edges
        .iter()
        .flat_map(|&edge| units.map(|unit| cross(unit, edge)));
    !(units.into_iter().any(is_apart)
        || is_apart(cross(edges[0], edges[1]))
        || products.any(is_apart))
}

fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Point, b: Point) -> Point {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn point() -> impl Strategy<Value = Point> {
        prop::array::uniform3(-3.0..3.0)
    }

    /// How far `point` lies outside of the unit cube about 0, along its worst axis.
    fn outside(point: Point) -> f64 {
        point
            .iter()
            .fold(0.0, |most: f64, it| most.max(it.abs() - 0.5))
    }

    /// How near a triangle comes to the cube by that measure, which is convex in the shares
    /// of two of its sides: by sections between sections.
    fn nearest([a, b, c]: [Point; 3]) -> f64 {
        let least = |most: f64, of: &dyn Fn(f64) -> f64| {
            let (mut low, mut high) = (0.0, most);
            for _ in 0..60 {
                let (one, two) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
                if of(one) <= of(two) {
                    high = two;
                } else {
                    low = one;
                }
            }
            of(low).min(of(high))
        };
        least(1.0, &|along| {
            least(1.0 - along, &|aside| {
                outside([0, 1, 2].map(|axis| {
                    a[axis] + along * (b[axis] - a[axis]) + aside * (c[axis] - a[axis])
                }))
            })
        })
    }

    proptest! {
        #[test]
        fn a_triangle_touches_a_cube_if_some_point_of_it_does(
            triangle in prop::array::uniform3(point()),
        ) {
            let distance = nearest(triangle);
            // Nearer than a search by thirds can tell nothing is said.
            if distance > 1e-3 {
                prop_assert!(!touches(&triangle, [0.0; 3], 0.5), "{distance}");
            } else if distance == 0.0 {
                prop_assert!(touches(&triangle, [0.0; 3], 0.5));
            }
        }
    }

    #[test]
    fn a_corner_in_the_cube_is_found_beyond_one_outside() {
        let line = [[0.0, -0.6, 0.0], [0.0, -2.4, 0.0], [0.0; 3]];
        assert_eq!(nearest(line), 0.0);
        assert!(touches(&line, [0.0; 3], 0.5));
    }

    #[test]
    fn a_triangle_without_area_is_a_line_or_a_point() {
        let line = [[-2.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 0.0, 0.0]];
        assert!(touches(&line, [0.0; 3], 0.5));
        assert!(!touches(&line, [0.0, 0.6, 0.0], 0.5));
        assert!(touches(&[[0.4; 3]; 3], [0.0; 3], 0.5));
        assert!(!touches(&[[0.6; 3]; 3], [0.0; 3], 0.5));
    }
}
