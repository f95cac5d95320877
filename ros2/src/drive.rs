//! From a place to go to, to a velocity; and whether the robot gets anywhere.

use ros_messages::geometry::{Twist, Vector3};

use crate::geometry::Pose;
use crate::parameters::Parameters;

/// Radians off the way beyond which the robot turns before it drives.
const ASKEW: f64 = 0.35;
/// Turns a second for each radian off the way.
const GAIN: f64 = 2.0;

/// Ahead in metres a second, and to the left in radians a second.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Velocity {
    pub(crate) ahead: f64,
    pub(crate) turn: f64,
}

impl From<Velocity> for Twist {
    fn from(velocity: Velocity) -> Self {
        Self {
            linear: Vector3 {
                x: velocity.ahead,
                ..Vector3::default()
            },
            angular: Vector3 {
                z: velocity.turn,
                ..Vector3::default()
            },
        }
    }
}

/// Turns in place by an angle to the left.
pub(crate) fn turn_by(angle: f64, parameters: &Parameters) -> Velocity {
    Velocity {
        ahead: 0.0,
        turn: (GAIN * angle).clamp(-parameters.max_turn, parameters.max_turn),
    }
}

/// Towards a place: turns first, slows down before it, and stops for what is ahead; `room`
/// is how far from the robot's middle that is.
pub(crate) fn steer(pose: Pose, to: (f64, f64), room: f64, parameters: &Parameters) -> Velocity {
    let off = pose.turn_to(to);
    let turn = turn_by(off, parameters);
    let left = room - parameters.robot_radius - parameters.stop_distance;
    if off.abs() > ASKEW || left <= 0.0 {
        return turn;
    }
    // It has to come to a stand within what is left, and may take a second for it.
    let ahead = parameters.max_speed.min(pose.distance(to)).min(left);
    Velocity { ahead, ..turn }
}

/// Where the robot was when it last got anywhere, and since when it does not.
#[derive(Debug, Default)]
pub(crate) struct Progress(Option<(Pose, f64)>);

impl Progress {
    /// Whether the robot has not moved by `far` metres, nor turned by a radian, for
    /// `timeout` seconds; asked again, it counts anew.
    pub(crate) fn is_stuck(&mut self, pose: Pose, now: f64, far: f64, timeout: f64) -> bool {
        let has_moved = |from: Pose| {
            let turned = crate::geometry::turn(pose.yaw - from.yaw).abs();
            from.distance((pose.x, pose.y)) >= far || turned >= 1.0
        };
        match self.0 {
            Some((from, since)) if !has_moved(from) => {
                let is_stuck = now - since >= timeout;
                if is_stuck {
                    self.0 = None;
                }
                is_stuck
            }
            _ => {
                self.0 = Some((pose, now));
                false
            }
        }
    }

    /// The robot was not to move.
    pub(crate) fn rest(&mut self) {
        self.0 = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FREE: f64 = f64::INFINITY;

    #[test]
    fn it_drives_to_the_place_and_stays_there() {
        let parameters = Parameters::default();
        let mut pose = Pose {
            yaw: 3.0,
            ..Pose::default()
        };
        let to = (2.0, -1.0);
        for _ in 0..200 {
            let Velocity { ahead, turn } = steer(pose, to, FREE, &parameters);
            assert!(ahead <= parameters.max_speed && turn.abs() <= parameters.max_turn);
            pose = pose.then(Pose {
                x: 0.1 * ahead,
                y: 0.0,
                yaw: 0.1 * turn,
            });
        }
        assert!(pose.distance(to) < 0.05, "{pose:?}");
    }

    #[test]
    fn it_does_not_drive_into_what_is_ahead() {
        let parameters = Parameters::default();
        let velocity = |room| steer(Pose::default(), (2.0, 0.1), room, &parameters);
        assert_eq!(velocity(0.3).ahead, 0.0);
        assert!(velocity(0.3).turn > 0.0, "it may turn");
        assert!((velocity(0.4).ahead - 0.1).abs() < 1e-9);
    }

    #[test]
    fn who_stands_for_long_is_stuck_once() {
        let mut progress = Progress::default();
        let here = Pose::default();
        let mut is_stuck = |pose, now| progress.is_stuck(pose, now, 0.1, 5.0);
        assert!(!is_stuck(here, 0.0) && !is_stuck(here, 4.9));
        let there = Pose { x: 0.2, ..here };
        assert!(!is_stuck(there, 5.0) && !is_stuck(there, 9.9));
        assert!(is_stuck(there, 10.0) && !is_stuck(there, 10.1));
    }
}
