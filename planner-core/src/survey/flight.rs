//! Which flights are allowed, and how to fly to a place on the ground plan.

use super::{Knowledge, Limits};
use crate::math;
use crate::point::Point;
use crate::surface::{Columns, Height, Surface, body_columns, clearance, reaches_over};

/// Headings that are tried beside the straight one, in radians.
const TURNS: [f32; 7] = [0.0, 0.5, -0.5, 1.0, -1.0, 1.6, -1.6];

/// Shares of a step that are tried.
const LENGTHS: [f32; 4] = [1.0, 0.75, 0.5, 0.25];

/// Places nearer to each other than this, in cells, are the same.
pub(super) const SAME: f32 = 1e-3;

/// How far beside a long straight way everything is open too.
const BESIDE: f32 = 0.01;

/// What is known of straight flights between any two places.
pub(super) struct Sky<'a, const TW: usize, const TH: usize> {
    pub(super) limits: Limits,
    pub(super) surface: &'a Surface<TW, TH>,
}

impl<const TW: usize, const TH: usize> Sky<'_, TW, TH> {
    /// As [`Knowledge::is_open`].
    #[inline(never)] // there are many calls
    pub(super) fn is_open(&self, from: Point, to: Point) -> bool {
        self.is_open_for(from, to, true)
    }

    /// The same, as [`has_room`](Self::has_room) is told.
    #[inline(never)] // there are many calls
    fn is_open_for(&self, from: Point, to: Point, is_there: bool) -> bool {
        let is_rise = (to.x, to.y) == (from.x, from.y) && to.z > from.z;
        to.is_finite()
            && (to.z <= self.limits.ceiling || to.z < from.z)
            && clearance(from, to, |cell| self.surface.height(cell))
                .is_some_and(|least| least >= self.limits.min_altitude || is_rise)
            && (is_rise || self.limits.clearance == 0 || self.has_room(from, to, is_there))
    }

    /// Whether the body is where it must not be, as far as is known.
    ///
    /// Cost: the columns of a body.
    pub(super) fn is_astray(&self, at: Point) -> bool {
        self.limits.clearance > 0 && !self.has_room(at, at, false)
    }

    /// Whether the least altitude is kept over known ground under all of the body, not its
    /// middle alone. If the body `is_there`, what is unknown or too high under it from the start
    /// may stay under it, as long as the robot does not sink: where it began, and where wind has
    /// blown it. From where all is as it should be the answer is the same both ways, bit for bit.
    ///
    /// Cost: for each column crossed those of a body.
    #[inline(never)] // small rather than fast: most robots have one column
    fn has_room(&self, from: Point, to: Point, is_there: bool) -> bool {
        let Limits {
            clearance,
            min_altitude,
            ..
        } = self.limits;
        let may_stay = is_there && to.z >= from.z;
        let is_over = |z: f32, cell| {
            let ground = self.surface.height(cell);
            ground.is_some_and(|ground| z - ground.cells() >= min_altitude)
        };
        let stays =
            |cell| may_stay && reaches_over(clearance, from.cell(), cell) && !is_over(from.z, cell);
        let mut crossings = Columns::new(from, to);
        crossings.all(|crossing| {
            let low = crossing.entered.min(crossing.left);
            body_columns(clearance, crossing.cell).all(|cell| is_over(low, cell) || stays(cell))
        })
    }

    /// The highest known ground under the body on a straight way.
    ///
    /// Cost: for each column crossed those of a body.
    #[inline(never)] // there are many calls
    pub(super) fn highest(&self, from: Point, to: Point) -> Option<Height> {
        let mut highest = None;
        for crossing in Columns::new(from, to) {
            for cell in body_columns(self.limits.clearance, crossing.cell) {
                highest = highest.max(self.surface.height(cell));
            }
        }
        highest
    }

    /// Whether the flight is open in one step, or else in several, whatever their ends are
    /// rounded to: a column that a line near the way crosses is crossed by one of the two
    /// lines beside it, which are open and a little lower.
    ///
    /// Cost: two lines of columns.
    #[inline(never)] // there are many calls
    pub(super) fn is_way(&self, from: Point, to: Point) -> bool {
        let length = math::length(to.x - from.x, to.y - from.y);
        if from.distance(to) <= self.limits.step + 0.5 * SAME || length < SAME {
            return self.is_open(from, to);
        }
        let (east, south) = ((to.x - from.x) / length, (to.y - from.y) / length);
        [BESIDE, -BESIDE].into_iter().all(|side| {
            let beside = |at: Point| at.offset(-side * south, side * east, -SAME);
            self.is_open_for(beside(from), beside(to), false)
        })
    }

    /// Steps of a straight way.
    pub(super) fn steps(&self, from: Point, to: Point) -> u32 {
        let steps = (from.distance(to) - 0.5 * SAME) / self.limits.step;
        -math::floor(-steps).min(0.0) as u32
    }

    /// The end of the next of them.
    pub(super) fn step(&self, from: Point, to: Point) -> Point {
        let distance = from.distance(to);
        if distance <= self.limits.step + 0.5 * SAME {
            return to;
        }
        let share = self.limits.step / distance;
        let (dx, dy, dz) = (to.x - from.x, to.y - from.y, to.z - from.z);
        from.offset(dx * share, dy * share, dz * share)
    }
}

impl<const TW: usize, const TH: usize> Knowledge<TW, TH> {
    /// What is known of straight flights.
    pub(super) const fn sky(&self) -> Sky<'_, TW, TH> {
        Sky {
            limits: self.limits,
            surface: &self.surface,
        }
    }

    /// Whether the robot may fly straight to `to`: known ground all the way, least
    /// altitude over it, below the ceiling, and clear of every robot heard of.
    ///
    /// Cost: the columns crossed, and the robots heard of.
    /// A robot that is too high may sink, and one that is too low may rise.
    // [Renzaglia2019 §3, C(P) ≤ 0]
    pub fn may_fly(&self, to: Point) -> bool {
        self.is_open(to) && self.robot_in_the_way(to).is_none()
    }

    /// The same without a look at other robots.
    #[inline]
    pub(crate) fn is_open(&self, to: Point) -> bool {
        self.sky().is_open(self.position, to)
    }

    /// A robot that a straight flight to `to` would come too near to. One that is
    /// already too near may be flown away from.
    pub(crate) fn robot_in_the_way(&self, to: Point) -> Option<Point> {
        let mut others = self.peers().map(|peer| peer.status.position);
        others.find(|&other| {
            let is_clear = distance_to_segment(other, self.position, to) >= self.limits.separation
                || to.distance_squared(other) > self.position.distance_squared(other);
            !is_clear
        })
    }

    /// One step at heading `heading` (radians from east to south), `length` long on
    /// the plan, rising or sinking to `cruise` over the highest ground on its way;
    /// shortened to one step if that is steep. It may not be allowed.
    ///
    /// Cost: the columns crossed.
    pub(crate) fn step_along(&self, heading: f32, length: f32, cruise: f32) -> Point {
        let (sin, cos) = math::sin_cos(heading);
        let level = self.position.offset(length * cos, length * sin, 0.0);
        let ground = self.sky().highest(self.position, level);
        let ground = ground.map_or(self.position.z, Height::cells);
        let rise = (ground + cruise).min(self.limits.ceiling) - self.position.z;
        // From where it must not be it flies level, or rises.
        let rise = match self.astray {
            true => rise.max(0.0),
            false => rise,
        };
        let whole = math::length(length, rise);
        let share = if whole > self.limits.step {
            self.limits.step / whole
        } else {
            1.0
        };
        self.position
            .offset(length * cos * share, length * sin * share, rise * share)
    }

    /// The step towards the place of `goal` on the plan that terrain and robots
    /// allow, at `cruise` over ground: straight, or turned, or shorter; or a climb;
    /// `None` if nothing is allowed or the robot is there.
    ///
    /// Cost: at most 29 flights looked at.
    pub fn step_towards(&self, goal: Point, cruise: f32) -> Option<Point> {
        let (dx, dy) = (goal.x - self.position.x, goal.y - self.position.y);
        let distance = math::length(dx, dy);
        let heading = math::heading(dx, dy);
        let reach = distance.min(self.limits.step);
        TURNS
            .iter()
            .flat_map(|turn| {
                LENGTHS
                    .iter()
                    .map(move |length| (heading + turn, length * reach))
            })
            .map(|(heading, length)| self.step_along(heading, length, cruise))
            .chain([self.climb()])
            .find(|&to| self.may_fly(to))
            .filter(|to| to.distance_squared(self.position) > 1e-6)
    }

    /// The straight step towards the place of `goal` on the plan, as
    /// [`step_along`](Self::step_along).
    pub(crate) fn step_to(&self, goal: Point, cruise: f32) -> Point {
        let (dx, dy) = (goal.x - self.position.x, goal.y - self.position.y);
        let reach = math::length(dx, dy).min(self.limits.step);
        self.step_along(math::heading(dx, dy), reach, cruise)
    }

    /// Straight up by one step, or to the ceiling; from above it down by as much.
    pub(crate) fn climb(&self) -> Point {
        let Point { x, y, z } = self.position;
        let step = self.limits.step;
        Point::new(x, y, (z + step).min(self.limits.ceiling.max(z - step)))
    }
}

fn distance_to_segment(point: Point, from: Point, to: Point) -> f32 {
    let (ux, uy, uz) = (to.x - from.x, to.y - from.y, to.z - from.z);
    let (px, py, pz) = (point.x - from.x, point.y - from.y, point.z - from.z);
    let along = ux * px + uy * py + uz * pz;
    let length_squared = ux * ux + uy * uy + uz * uz;
    let share = if length_squared > 0.0 {
        (along / length_squared).clamp(0.0, 1.0)
    } else {
        0.0
    };
    point.distance(from.offset(ux * share, uy * share, uz * share))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cell::{Cell, Extent};
    use crate::surface::{Column, MAX_CLEARANCE};
    use proptest::prelude::*;

    const SIDE: i16 = 16;

    /// Places at corners, borders and middles of columns, and some between.
    fn place() -> impl Strategy<Value = Point> {
        let at = || prop_oneof![(0u8..32).prop_map(|it| f32::from(it) * 0.5), 0.0f32..16.0];
        (at(), at(), at()).prop_map(|(x, y, z)| Point::new(x, y, z))
    }

    proptest! {
        /// Whoever flew somewhere may fly back, as wide as it is: the energy for the way home
        /// rests on that.
        #[test]
        fn what_is_open_is_open_back(
            (from, to) in (place(), place()),
            clearance in 0..=MAX_CLEARANCE,
            heights in prop::collection::vec(prop::option::weighted(0.99, 0u8..12), 256),
        ) {
            let mut surface: Surface<2, 2> = Surface::new(Extent::new(16, 16)).unwrap();
            let cells = (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| Cell::new(x, y)));
            for (cell, height) in cells.zip(heights) {
                if let Some(height) = height {
                    surface.learn(Column { cell, height: Height(height) });
                }
            }
            let limits = Limits { range: 4.0, step: 2.0, min_altitude: 3.0, ceiling: 16.0, separation: 1.0, clearance };
            let sky = Sky { limits, surface: &surface };
            let is_good = |at: Point| sky.surface.height(at.cell()).is_some_and(|ground| at.z - ground.cells() >= 3.0);
            if is_good(from) && !sky.is_astray(from) && sky.is_open(from, to) {
                prop_assert!(!sky.is_astray(to));
                prop_assert!(sky.is_open(to, from));
                prop_assert_eq!(sky.is_way(from, to), sky.is_way(to, from));
            }
        }
    }
}
