//! Discs against cells and against each other.

use parry2d_f64::math::{Pose, Vec2};
use parry2d_f64::query::{self, PointQuery, ShapeCastOptions};
use parry2d_f64::shape::{Ball, Cuboid, Segment, Shape};
use planner_core::Cell;

/// What a body runs into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Hit {
    /// A cell that is not free.
    Wall,
    /// Another body.
    Body,
}

/// What rounding, and the library where it searches, may err in metres. Bodies that met are
/// left so far apart.
const SKIN: f64 = 1e-6;

/// Cells of so many metres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cells {
    pub(super) side: f64,
}

impl Cells {
    /// The cell that a place lies in.
    pub(super) fn of(self, place: Vec2) -> Cell {
        let number = |metres: f64| libm::floor(metres / self.side) as i16;
        Cell::new(number(place.x), number(place.y))
    }

    /// The middle of a cell.
    pub(super) fn middle(self, cell: Cell) -> Vec2 {
        let metres = |number: i16| (f64::from(number) + 0.5) * self.side;
        Vec2::new(metres(cell.x), metres(cell.y))
    }

    fn shape(self) -> Cuboid {
        Cuboid::new(Vec2::splat(self.side / 2.0))
    }

    fn place(self, cell: Cell) -> Pose {
        Pose::from_translation(self.middle(cell))
    }

    /// The distance of a place from a cell in metres.
    fn distance(self, place: Vec2, cell: Cell) -> f64 {
        self.shape()
            .distance_to_point(&self.place(cell), place, true)
    }

    /// The cells that may lie within a distance of a segment: those of its rows, each as far
    /// as the segment goes in it.
    fn near(self, from: Vec2, to: Vec2, reach: f64) -> impl Iterator<Item = Cell> {
        let (top, bottom) = if from.y <= to.y {
            (from, to)
        } else {
            (to, from)
        };
        let first = self.of(Vec2::new(0.0, top.y - reach)).y;
        let last = self.of(Vec2::new(0.0, bottom.y + reach)).y;
        (first..=last).flat_map(move |y| {
            let height = bottom.y - top.y;
            let column = |row: f64| {
                let share = match height > 0.0 {
                    true => ((row - top.y) / height).clamp(0.0, 1.0),
                    false => 0.0,
                };
                top.x + share * (bottom.x - top.x)
            };
            let row = f64::from(y) * self.side;
            let ends = match height > 0.0 {
                true => [column(row - reach), column(row + self.side + reach)],
                false => [top.x, bottom.x],
            };
            let west = self.of(Vec2::new(ends[0].min(ends[1]) - reach, 0.0)).x;
            let east = self.of(Vec2::new(ends[0].max(ends[1]) + reach, 0.0)).x;
            (west..=east).map(move |x| Cell::new(x, y))
        })
    }

    /// Whether a disc that goes straight from one place to another comes no nearer to any
    /// cell that is not free than its radius, or than it is at the beginning.
    pub(super) fn are_clear(
        self,
        (from, to): (Vec2, Vec2),
        radius: f64,
        is_free: impl Fn(Cell) -> bool,
    ) -> bool {
        let way = Segment::new(from, to);
        let is_apart = |cell: Cell| {
            let least = radius.min(self.distance(from, cell)) - SKIN;
            query::distance(&Pose::IDENTITY, &way, &self.place(cell), &self.shape())
                .is_ok_and(|found| found.distance >= least)
        };
        let mut cells = self.near(from, to, radius);
        cells.all(|cell| is_free(cell) || is_apart(cell))
    }

    /// The same of a place that a disc comes to from another one.
    pub(super) fn are_apart(
        self,
        from: Vec2,
        place: Vec2,
        radius: f64,
        is_free: impl Fn(Cell) -> bool,
    ) -> bool {
        let is_apart = |cell: Cell| {
            let least = radius.min(self.distance(from, cell)) - SKIN;
            self.distance(place, cell) >= least
        };
        let mut cells = self.near(place, place, radius);
        cells.all(|cell| is_free(cell) || is_apart(cell))
    }

    /// How far a disc gets on its way `by` before it runs into a cell that is not free or
    /// into another disc of its size, as a share of the way, and what it runs into.
    pub(super) fn advance(
        self,
        (at, by): (Vec2, Vec2),
        radius: f64,
        is_free: impl Fn(Cell) -> bool,
        others: impl Iterator<Item = Vec2>,
    ) -> (f64, Option<Hit>) {
        let length = by.length();
        if length == 0.0 {
            return (0.0, None);
        }
        let disc = Ball::new(radius);
        let reach = radius + length;
        let wall = self.shape();
        let cells = self.near(at, at, reach);
        let walls = cells.filter(|&cell| !is_free(cell) && self.distance(at, cell) <= reach);
        let walls = walls.filter_map(|cell| {
            let share = meet((at, by), &disc, (self.middle(cell), &wall))?;
            Some((share, Hit::Wall))
        });
        let others = others.filter(|&other| (other - at).length() <= reach + radius);
        let bodies = others.filter_map(|other| {
            let share = meet((at, by), &disc, (other, &disc))?;
            Some((share, Hit::Body))
        });
        let first = walls.chain(bodies).min_by(|a, b| a.0.total_cmp(&b.0));
        first.map_or((1.0, None), |(share, hit)| {
            ((share - SKIN / length).max(0.0), Some(hit))
        })
    }
}

/// The share of its way `by` on which a disc meets something that it does not get away from.
fn meet((at, by): (Vec2, Vec2), disc: &Ball, (place, shape): (Vec2, &dyn Shape)) -> Option<f64> {
    let options = ShapeCastOptions {
        max_time_of_impact: 1.0,
        target_distance: 0.0,
        stop_at_penetration: false,
        compute_impact_geometry_on_penetration: true,
    };
    let [at, place] = [at, place].map(Pose::from_translation);
    query::cast_shapes(&at, by, disc, &place, Vec2::ZERO, shape, options)
        .expect("discs and rectangles are known")
        .map(|met| met.time_of_impact)
}
