//! What a driver wishes for, moment by moment: the law that leads a body along its course.

use parry2d_f64::math::Vec2;

use super::body::{Limits, State, Velocity};
use crate::scenario::Drive;

/// What a body is to do until it is told otherwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Course {
    /// Stop.
    Halt,
    /// Stop, then turn to a place.
    Face(Vec2),
    /// Go to a place and stop there.
    To(Vec2),
}

/// Longest moment in seconds.
pub(super) const LONGEST: f64 = 0.02;
/// A body that would take longer to stop than this many moments counts as one that never
/// does.
const MOST_BRAKING: usize = 10_000;

/// The same until it goes straight to a place.
const MOST_SWINGING: usize = 250;
/// A body whose direction is off by less, in radians, goes straight.
const STRAIGHT: f64 = 0.02;

impl Limits {
    /// Whether a body that goes to a place has its direction, and keeps it.
    fn goes_straight(&self, state: &State, place: Vec2) -> bool {
        let way = place - state.pose.at;
        let along = state.velocity.along;
        match self.drive {
            Drive::Omni => {
                let aside = way.x * along.y - way.y * along.x;
                way.dot(along) >= 0.0 && aside.abs() <= STRAIGHT * way.length() * along.length()
            }
            Drive::DiffDrive => {
                let spin = state.velocity.turn.abs() / self.turn_rate;
                state.pose.turn_to(place).abs().max(spin) <= STRAIGHT
            }
        }
    }
}

impl Course {
    /// The velocity to strive for.
    pub(super) fn wish(self, state: &State, limits: &Limits, dt: f64) -> Velocity {
        match self {
            Self::Halt => Velocity::NONE,
            Self::Face(_) if limits.drive == Drive::Omni || !state.is_standing() => Velocity::NONE,
            Self::Face(place) => Velocity {
                along: Vec2::ZERO,
                turn: turn(state, place, limits, dt),
            },
            Self::To(place) => {
                let way = place - state.pose.at;
                let distance = way.length();
                let speed = most(distance, limits.acceleration, dt).min(limits.speed);
                if limits.drive == Drive::Omni {
                    return Velocity {
                        along: way * (speed / distance.max(f64::MIN_POSITIVE)),
                        turn: 0.0,
                    };
                }
                // The farther it has to turn, the slower it goes meanwhile.
                let ahead = libm::cos(state.pose.turn_to(place)).max(0.0);
                Velocity {
                    along: Vec2::new(speed * ahead * ahead, 0.0),
                    turn: match distance > 1e-3 {
                        true => turn(state, place, limits, dt),
                        false => 0.0,
                    },
                }
            }
        }
    }

    /// Where a body that follows the course for so many moments, and then stops, comes by,
    /// from where it is on; `None` if it does not stop.
    pub(super) fn preview(
        self,
        mut state: State,
        limits: &Limits,
        (moments, dt): (usize, f64),
    ) -> Option<Vec<Vec2>> {
        let mut places = vec![state.pose.at];
        for moment in 0..moments + MOST_BRAKING {
            let course = if moment < moments { self } else { Self::Halt };
            let wished = course.wish(&state, limits, dt);
            state.accelerate(wished, limits, dt);
            if moment >= moments && state.is_standing() {
                return Some(places);
            }
            state.pose = state.pose.moved(state.velocity, dt);
            places.push(state.pose.at);
        }
        None
    }
}

/// Where a body that goes to a place comes by until it goes straight there, the last one
/// included; `None`: not soon.
pub(super) fn swings(place: Vec2, mut state: State, limits: &Limits, dt: f64) -> Option<Vec<Vec2>> {
    let mut places = Vec::new();
    for _ in 0..MOST_SWINGING {
        if limits.goes_straight(&state, place) {
            return Some(places);
        }
        let wished = Course::To(place).wish(&state, limits, dt);
        state.accelerate(wished, limits, dt);
        state.pose = state.pose.moved(state.velocity, dt);
        places.push(state.pose.at);
    }
    None
}

fn turn(state: &State, place: Vec2, limits: &Limits, dt: f64) -> f64 {
    let left = state.pose.turn_to(place);
    let rate = most(left.abs(), limits.turn_acceleration(), dt).min(limits.turn_rate);
    rate.copysign(left)
}

/// The largest speed from which a body stops within a distance, where it loses
/// `acceleration` · `dt` in each moment after the first.
fn most(distance: f64, acceleration: f64, dt: f64) -> f64 {
    let half = acceleration * dt / 2.0;
    ((half * half + 2.0 * acceleration * distance).sqrt() - half).min(distance / dt)
}
