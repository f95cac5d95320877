//! Which flights are allowed, and how to fly to a place on the ground plan.

use super::Knowledge;
use crate::math;
use crate::point::Point;
use crate::surface::{Columns, Height, clearance};

/// Headings that are tried beside the straight one, in radians.
const TURNS: [f32; 7] = [0.0, 0.5, -0.5, 1.0, -1.0, 1.6, -1.6];

/// Shares of a step that are tried.
const LENGTHS: [f32; 4] = [1.0, 0.75, 0.5, 0.25];

impl<const TW: usize, const TH: usize> Knowledge<TW, TH> {
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
    pub(crate) fn is_open(&self, to: Point) -> bool {
        let Point { x, y, z } = self.position;
        let is_rise = (to.x, to.y) == (x, y) && to.z > z;
        to.is_finite()
            && (to.z <= self.limits.ceiling || to.z < z)
            && clearance(self.position, to, |cell| self.surface.height(cell))
                .is_some_and(|least| least >= self.limits.min_altitude || is_rise)
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
        let ground = Columns::new(self.position, level)
            .filter_map(|crossing| self.surface.height(crossing.cell))
            .max()
            .map_or(self.position.z, Height::cells);
        let rise = (ground + cruise).min(self.limits.ceiling) - self.position.z;
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
