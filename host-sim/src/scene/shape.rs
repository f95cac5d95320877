//! Points and triangles as voxels.
//!
//! Such a file says where something is, and nowhere that nothing is. What is free is
//! therefore taken for it, as [`Free`] says, or seen along rays.

use clap::ValueEnum;
use planner_core::volume::{Content, Voxel};
use serde::{Deserialize, Serialize};

use super::error::FARTHEST;
use super::mesh::touches;
use super::{Frame, Scene, SceneError, SceneOptions};
use crate::options::OptionError;

/// A place in metres.
pub(super) type Point = [f64; 3];

/// Most voxels that are tried for the triangles of a mesh: some half a minute.
const MOST_TRIED: u64 = 1 << 31;

/// Widest margin in metres.
const WIDEST: f64 = 1000.0;

/// What a file says of where something is.
#[derive(Debug)]
pub(super) enum Shape {
    /// Points that were measured; those that are not finite were not.
    Cloud {
        points: Vec<Point>,
        /// Where they were seen from.
        viewpoint: Option<Point>,
    },
    /// Surfaces.
    Mesh(Vec<[Point; 3]>),
}

/// What of a cloud or a mesh counts as free.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Free {
    /// All of its bounding box where nothing is: hidden places and the inside of walls, too.
    Rest,
    /// What lies on the rays from the viewpoint of a PCD file to its points; the rest is
    /// unknown.
    Rays,
}

impl Shape {
    fn name(&self) -> &'static str {
        match self {
            Self::Cloud { .. } => "point",
            Self::Mesh(_) => "triangle",
        }
    }

    /// Its points or corners.
    fn points(&self) -> Box<dyn Iterator<Item = Point> + '_> {
        match self {
            Self::Cloud { points, .. } => Box::new(points.iter().copied().filter(is_finite)),
            Self::Mesh(triangles) => Box::new(triangles.iter().flatten().copied()),
        }
    }

    /// Where rays come from, if these tell what is free.
    fn viewpoint(&self, options: &SceneOptions) -> Result<Option<Point>, SceneError> {
        match (self, options.free) {
            (_, None | Some(Free::Rest)) => Ok(None),
            (Self::Cloud { viewpoint, .. }, Some(Free::Rays)) => {
                let viewpoint = viewpoint.filter(is_finite).ok_or(SceneError::NoViewpoint)?;
                match options.margin {
                    None => Ok(Some(viewpoint)),
                    Some(_) => Err(OptionError::DoesNotApply {
                        option: "--margin",
                        what: "--free rays",
                    }
                    .into()),
                }
            }
            (Self::Mesh(_), Some(Free::Rays)) => Err(OptionError::DoesNotApply {
                option: "--free rays",
                what: "a mesh, which nobody looked at",
            }
            .into()),
        }
    }

    /// The scene of it.
    ///
    /// # Errors
    /// There is nothing in it, its voxels have no size or are too many, or an option does
    /// not apply.
    pub(super) fn scene(&self, options: &SceneOptions) -> Result<Scene, SceneError> {
        if let Self::Mesh(triangles) = self
            && let Some(number) = triangles.iter().position(|it| !it.iter().all(is_finite))
        {
            let place = format!("triangle {number}");
            return Err(SceneError::broken("mesh", place, "a corner lies nowhere"));
        }
        let viewpoint = self.viewpoint(options)?;
        let [mut low, mut high] = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for point in self.points().chain(viewpoint) {
            for axis in 0..3 {
                low[axis] = low[axis].min(point[axis]);
                high[axis] = high[axis].max(point[axis]);
            }
        }
        if self.points().next().is_none() {
            return Err(SceneError::Nothing(self.name()));
        }
        let voxel_size = voxel_size(options.voxel_size, low, high)?;
        let margin = margin(options.margin, voxel_size)?;
        let key = |at: Point| at.map(|at| (at / voxel_size).floor());
        let (mut low, mut high) = (key(low), key(high));
        for axis in 0..3 {
            high[axis] += margin;
            // Below it there may be ground, of which it says nothing.
            low[axis] -= if axis < 2 { margin } else { 0.0 };
        }
        let farthest = low
            .iter()
            .chain(&high)
            .fold(0.0, |far: f64, at| far.max(at.abs()));
        if farthest >= FARTHEST as f64 {
            return Err(SceneError::FarAway {
                metres: farthest * voxel_size,
                voxel_size,
            });
        }
        let bounds = [low, high].map(|at| at.map(|at| at as i32));
        let mut scene = Scene::within(bounds, voxel_size)?;
        let frame = scene.frame.unwrap_or(Frame::PLAIN);
        if viewpoint.is_none() {
            let inner = |at: [i32; 3]| [0, 1, 2].map(|axis| (at[axis] - frame.corner[axis]) as i16);
            scene.add(inner(bounds[0]), inner(bounds[1]), Content::Free);
        }
        match self {
            Self::Cloud { points, .. } => scene.add_points(points, frame, viewpoint),
            Self::Mesh(triangles) => scene.add_triangles(triangles, frame)?,
        }
        scene.free = Some(viewpoint.map_or(Free::Rest, |_| Free::Rays));
        Ok(scene)
    }
}

impl Scene {
    /// Occupies the voxels of points; frees those between the first point of each and the
    /// viewpoint.
    fn add_points(&mut self, points: &[Point], frame: Frame, viewpoint: Option<Point>) {
        let mut hits = Vec::new();
        for &point in points.iter().filter(|point| is_finite(point)) {
            if let Some(index) = frame.voxel(point).and_then(|voxel| self.index(voxel))
                && self.contents[index] != Content::Occupied
            {
                self.contents[index] = Content::Occupied;
                hits.push(point);
            }
        }
        for (point, eye) in hits.into_iter().zip(viewpoint.iter().cycle()) {
            for voxel in between(*eye, point, frame) {
                let at = [voxel.x, voxel.y, voxel.z];
                self.add(at, at, Content::Free);
            }
        }
    }

    /// Occupies the voxels that triangles touch.
    fn add_triangles(&mut self, triangles: &[[Point; 3]], frame: Frame) -> Result<(), SceneError> {
        let mut tried = 0;
        for triangle in triangles {
            let of = |pick: fn(f64, f64) -> f64| {
                let [a, b, c] = *triangle;
                frame.voxel([0, 1, 2].map(|axis| pick(pick(a[axis], b[axis]), c[axis])))
            };
            let Some((low, high)) = of(f64::min).zip(of(f64::max)) else {
                continue;
            };
            let side = |low: i16, high: i16| u64::from(high.abs_diff(low)) + 1;
            tried += side(low.x, high.x) * side(low.y, high.y) * side(low.z, high.z);
            if tried > MOST_TRIED {
                return Err(SceneError::TooMuchWork {
                    voxel_size: frame.voxel_size,
                });
            }
            for z in low.z..=high.z {
                for y in low.y..=high.y {
                    for x in low.x..=high.x {
                        let voxel = Voxel::new(x, y, z);
                        let middle = frame.middle(voxel);
                        if touches(triangle, middle, frame.voxel_size / 2.0) {
                            self.add([x, y, z], [x, y, z], Content::Occupied);
                        }
                    }
                }
            }
        }
        Ok(())
    }
}

fn is_finite(point: &Point) -> bool {
    point.iter().all(|it| it.is_finite())
}

/// # Errors
/// There is none, or it is no length; with one that fits something between these corners.
fn voxel_size(asked: Option<f64>, low: Point, high: Point) -> Result<f64, SceneError> {
    let spans = [0, 1, 2].map(|axis| high[axis] - low[axis]);
    let longest = spans.iter().copied().fold(0.0, f64::max);
    match asked {
        Some(asked) if asked > 0.0 && asked.is_finite() => Ok(asked),
        Some(found) => Err(OptionError::Setting {
            option: "--voxel-size",
            found,
            expected: "more than 0 metres",
        }
        .into()),
        None => Err(SceneError::NoVoxelSize {
            spans,
            suggested: round(longest / 100.0),
        }),
    }
}

/// The next of 1, 2, 5, 10 and so on; a millimetre at least.
fn round(metres: f64) -> f64 {
    let steps = [1.0, 2.0, 5.0];
    let mut decade = 1e-3;
    while decade < 1e12 {
        if let Some(step) = steps.iter().find(|step| *step * decade >= metres) {
            return (step * decade * 1e3).round() / 1e3;
        }
        decade *= 10.0;
    }
    metres
}

/// Free voxels about a bounding box.
fn margin(metres: Option<f64>, voxel_size: f64) -> Result<f64, OptionError> {
    let metres = metres.unwrap_or(0.0);
    match (0.0..=WIDEST).contains(&metres) {
        true => Ok((metres / voxel_size).ceil()),
        false => Err(OptionError::Setting {
            option: "--margin",
            found: metres,
            expected: "0 to 1000 metres",
        }),
    }
}

/// The voxels through which the line from `eye` to `point` comes, that of `eye` first, that
/// of `point` left out \[Amanatides1987\].
fn between(eye: Point, point: Point, frame: Frame) -> impl Iterator<Item = Voxel> {
    let ends = frame.voxel(eye).zip(frame.voxel(point));
    let ends = ends.map(|(from, to)| [[from.x, from.y, from.z], [to.x, to.y, to.z]]);
    let [mut at, to] = ends.unwrap_or_default();
    let sides: u32 = (0..3)
        .map(|axis| u32::from(at[axis].abs_diff(to[axis])))
        .sum();
    // Shares of the line from one border to the next, and to the next one.
    let voxels = |axis: usize| (point[axis] - eye[axis]).abs() / frame.voxel_size;
    let share = [0, 1, 2].map(|axis| 1.0 / voxels(axis));
    let mut next = [0, 1, 2].map(|axis| {
        let inside = eye[axis] / frame.voxel_size - (eye[axis] / frame.voxel_size).floor();
        let left = if to[axis] >= at[axis] {
            1.0 - inside
        } else {
            inside
        };
        left * share[axis]
    });
    (0..sides).map(move |_| {
        let here = at;
        // Only axes along which there is a way left.
        let axes = (0..3).filter(|&axis| here[axis] != to[axis]);
        if let Some(axis) = axes.min_by(|&a, &b| next[a].total_cmp(&next[b])) {
            at[axis] += (to[axis] - here[axis]).signum();
            next[axis] += share[axis];
        }
        Voxel::new(here[0], here[1], here[2])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn options(voxel_size: f64) -> SceneOptions {
        SceneOptions {
            voxel_size: Some(voxel_size),
            ..SceneOptions::default()
        }
    }

    fn cloud(points: &[Point]) -> Shape {
        Shape::Cloud {
            points: points.to_vec(),
            viewpoint: None,
        }
    }

    fn count(scene: &Scene, content: Content) -> usize {
        let is_it = |voxel: &Voxel| scene.content(*voxel) == Some(content);
        scene.voxels().filter(is_it).count()
    }

    #[test]
    fn the_rest_of_the_box_of_a_cloud_is_free_and_beyond_it_nothing_is_known() {
        let points = [[0.05, 0.0, 0.0], [1.0, -0.35, 0.55], [f64::NAN, 9.0, 9.0]];
        let scene = cloud(&points).scene(&options(0.1)).unwrap();
        // 11 by 5 by 6 voxels, and a rim.
        let extent = scene.extent();
        assert_eq!((extent.width, extent.height, scene.levels()), (13, 7, 8));
        assert_eq!(count(&scene, Content::Occupied), 2);
        assert_eq!(count(&scene, Content::Free), 11 * 5 * 6 - 2);
        let frame = scene.frame().unwrap();
        for point in &points[..2] {
            assert!(scene.is_occupied(frame.voxel(*point).unwrap()));
        }
        assert_eq!(scene.free(), Some(Free::Rest));
        let wider = SceneOptions {
            margin: Some(0.15),
            ..options(0.1)
        };
        let wider = cloud(&points).scene(&wider).unwrap();
        assert_eq!(count(&wider, Content::Free), 15 * 9 * 8 - 2);
    }

    #[test]
    fn rays_free_what_they_cross_and_nothing_behind_a_point() {
        let shape = Shape::Cloud {
            points: vec![[4.5, 0.5, 0.5], [2.5, 2.5, 0.5]],
            viewpoint: Some([0.5, 0.5, 0.5]),
        };
        let options = SceneOptions {
            free: Some(Free::Rays),
            ..options(1.0)
        };
        let scene = shape.scene(&options).unwrap();
        let row = |y| (0..7).map(move |x| Voxel::new(x, y, 1));
        let contents: Vec<_> = row(1).map(|at| scene.content(at).unwrap()).collect();
        use Content::{Free as Gap, Occupied, Unknown};
        assert_eq!(contents, [Unknown, Gap, Gap, Gap, Gap, Occupied, Unknown]);
        assert_eq!(scene.content(Voxel::new(2, 2, 1)), Some(Gap));
        assert_eq!(scene.content(Voxel::new(3, 3, 1)), Some(Occupied));
        assert_eq!(scene.content(Voxel::new(4, 3, 1)), Some(Unknown));
    }

    #[test]
    fn a_way_of_voxels_leads_from_face_to_face() {
        let frame = Frame {
            voxel_size: 0.25,
            corner: [-40; 3],
        };
        let (eye, point) = ([0.1, -0.3, 2.2], [-3.3, 1.7, 0.4]);
        let way: Vec<_> = between(eye, point, frame).collect();
        assert_eq!(way.first().copied(), frame.voxel(eye));
        for pair in way.windows(2) {
            assert_eq!(pair[0].distance_squared(pair[1]), 1);
        }
        let end = frame.voxel(point).unwrap();
        assert_eq!(way.last().unwrap().distance_squared(end), 1);
        for voxel in way {
            let line = [eye, point, point];
            assert!(touches(&line, frame.middle(voxel), 0.126), "{voxel}");
        }
        assert_eq!(between(eye, eye, frame).count(), 0);
    }

    /// A box of twelve triangles from 0 to `side` on each axis.
    fn room(side: f64) -> Vec<[Point; 3]> {
        let mut triangles = Vec::new();
        for axis in 0..3 {
            for at in [0.0, side] {
                let corner = |u: f64, v: f64| {
                    let mut corner = [at; 3];
                    corner[(axis + 1) % 3] = u * side;
                    corner[(axis + 2) % 3] = v * side;
                    corner
                };
                let [a, b, c, d] = [
                    corner(0.0, 0.0),
                    corner(1.0, 0.0),
                    corner(1.0, 1.0),
                    corner(0.0, 1.0),
                ];
                triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
        triangles
    }

    #[test]
    fn a_room_of_triangles_is_closed_and_free_inside() {
        // Walls lie on the borders of voxels, however these are rounded.
        for (side, size, voxels) in [(2.0, 0.5, 3), (2.0, 0.2, 9), (3.0, 0.1, 29), (2.1, 0.7, 2)] {
            let scene = Shape::Mesh(room(side)).scene(&options(size)).unwrap();
            let rim = scene.voxels().filter(|&at| !scene.is_known(at)).count();
            let free = count(&scene, Content::Free);
            assert_eq!(free, voxels * voxels * voxels, "{side} {size}");
            let with_walls = (voxels + 2) * (voxels + 2) * (voxels + 2);
            assert_eq!(count(&scene, Content::Occupied), with_walls - free);
            assert_eq!(scene.voxels().count(), with_walls + rim);
        }
    }

    #[test]
    fn what_has_no_size_or_too_much_of_it_is_refused_with_what_would_do() {
        let error =
            |shape: &Shape, options: &SceneOptions| shape.scene(options).unwrap_err().to_string();
        let points = cloud(&[[0.0; 3], [8.0, 4.0, 3.0]]);
        let none = SceneOptions::default();
        assert!(error(&points, &none).contains("--voxel-size 0.1: it spans 8.0×4.0×3.0 m"));
        assert!(error(&points, &options(0.0)).contains("more than 0"));
        assert!(error(&points, &options(f64::NAN)).contains("more than 0"));
        assert!(error(&points, &options(0.01)).contains("--voxel-size 0.02 or more"));
        assert!(error(&cloud(&[[f64::NAN; 3]]), &options(1.0)).contains("no point"));
        assert!(error(&Shape::Mesh(vec![]), &options(1.0)).contains("no triangle"));
        let far = cloud(&[[5e5, 0.0, 0.0]]);
        assert!(error(&far, &options(1.0)).contains("500000 m from the origin"));
        let rays = SceneOptions {
            free: Some(Free::Rays),
            ..options(1.0)
        };
        assert!(error(&points, &rays).contains("VIEWPOINT"));
        assert!(error(&Shape::Mesh(room(2.0)), &rays).contains("a mesh"));
        let wide = SceneOptions {
            margin: Some(-1.0),
            ..options(1.0)
        };
        assert!(error(&points, &wide).contains("--margin -1"));
    }
}
