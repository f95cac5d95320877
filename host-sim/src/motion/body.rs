//! A body's pose and velocity, and what its wheels make of them.

use parry2d_f64::math::Vec2;

use crate::scenario::{Drive, Motion};

/// Where a body is: metres east and south of the map's corner, and radians from east to
/// south.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pose {
    pub(super) at: Vec2,
    pub(super) yaw: f64,
}

/// How a body moves: metres a second ahead and to its right, and radians a second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Velocity {
    pub(super) along: Vec2,
    pub(super) turn: f64,
}

impl Velocity {
    pub(super) const NONE: Self = Self {
        along: Vec2::ZERO,
        turn: 0.0,
    };
}

/// A body that moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct State {
    pub(super) pose: Pose,
    pub(super) velocity: Velocity,
}

/// What a body can do.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    pub(super) drive: Drive,
    pub(super) speed: f64,
    pub(super) turn_rate: f64,
    pub(super) acceleration: f64,
    /// Distance of a wheel from the middle in metres: a body that turns in place at its
    /// largest rate has wheels at their largest speed.
    half_track: f64,
}

impl Limits {
    pub(super) fn of(motion: &Motion) -> Self {
        Self {
            drive: motion.drive,
            speed: motion.speed,
            turn_rate: motion.turn_rate,
            acceleration: motion.acceleration,
            half_track: motion.speed / motion.turn_rate.max(f64::MIN_POSITIVE),
        }
    }

    /// How fast it gains and loses its rate of turning, in radians a second each second.
    pub(super) fn turn_acceleration(&self) -> f64 {
        self.acceleration / self.half_track
    }

    /// The velocity where each wheel, of a drone each axis, goes so many times as fast.
    pub(super) fn scaled(&self, velocity: Velocity, by: [f64; 2]) -> Velocity {
        if by == [1.0; 2] {
            return velocity;
        }
        match self.drive {
            Drive::Omni => Velocity {
                along: Vec2::new(velocity.along.x * by[0], velocity.along.y * by[1]),
                ..velocity
            },
            Drive::DiffDrive => {
                // Turning from east to south, the left wheel is the outer one.
                let spin = velocity.turn * self.half_track;
                let left = (velocity.along.x + spin) * by[0];
                let right = (velocity.along.x - spin) * by[1];
                Velocity {
                    along: Vec2::new((left + right) / 2.0, 0.0),
                    turn: (left - right) / (2.0 * self.half_track),
                }
            }
        }
    }
}

impl Pose {
    /// Metres east and south that a velocity leads to in `dt` seconds.
    pub(super) fn shift(&self, velocity: Velocity, dt: f64) -> Vec2 {
        let Vec2 { x: ahead, y: right } = velocity.along;
        if velocity.along == Vec2::ZERO {
            return Vec2::ZERO;
        }
        let (sin, cos) = libm::sincos(self.yaw + velocity.turn * dt / 2.0);
        Vec2::new(ahead * cos - right * sin, ahead * sin + right * cos) * dt
    }

    /// The pose after it.
    pub(super) fn moved(&self, velocity: Velocity, dt: f64) -> Self {
        Self {
            at: self.at + self.shift(velocity, dt),
            yaw: turned(self.yaw + velocity.turn * dt),
        }
    }

    /// By how much it has to turn to look at a place, -π to π.
    pub(super) fn turn_to(&self, place: Vec2) -> f64 {
        let way = place - self.at;
        turned(libm::atan2(way.y, way.x) - self.yaw)
    }
}

impl State {
    /// Brings the velocity towards the wished one, as far as `dt` seconds allow.
    pub(super) fn accelerate(&mut self, wished: Velocity, limits: &Limits, dt: f64) {
        let most = limits.acceleration * dt;
        let change = wished.along - self.velocity.along;
        self.velocity.along += match change.length() {
            length if length > most => change * (most / length),
            _ => change,
        };
        let most = limits.turn_acceleration() * dt;
        self.velocity.turn += (wished.turn - self.velocity.turn).clamp(-most, most);
    }

    pub(super) fn is_standing(&self) -> bool {
        self.velocity.along == Vec2::ZERO
    }
}

/// The same angle from -π to π.
fn turned(angle: f64) -> f64 {
    use std::f64::consts::{PI, TAU};
    if (-PI..=PI).contains(&angle) {
        return angle;
    }
    angle - TAU * libm::round(angle / TAU)
}
