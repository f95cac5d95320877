//! Poses in a plane: metres, radians to the left.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::f64::consts::{PI, TAU};

use ros_messages::geometry::{Pose as RosPose, Transform};
use ros_messages::tf::TFMessage;

/// Place and direction in a plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Pose {
    pub(crate) x: f64,
    pub(crate) y: f64,
    /// Radians to the left of x.
    pub(crate) yaw: f64,
}

impl Pose {
    /// What `other`, reckoned from this pose, is in this pose's frame.
    pub(crate) fn then(self, other: Self) -> Self {
        let (sin, cos) = self.yaw.sin_cos();
        Self {
            x: self.x + cos * other.x - sin * other.y,
            y: self.y + sin * other.x + cos * other.y,
            yaw: turn(self.yaw + other.yaw),
        }
    }

    /// The way back.
    pub(crate) fn inverse(self) -> Self {
        let (sin, cos) = self.yaw.sin_cos();
        Self {
            x: -(cos * self.x + sin * self.y),
            y: sin * self.x - cos * self.y,
            yaw: turn(-self.yaw),
        }
    }

    pub(crate) fn distance(self, to: (f64, f64)) -> f64 {
        (to.0 - self.x).hypot(to.1 - self.y)
    }

    /// How far it has to turn left to face a place, -π to π.
    pub(crate) fn turn_to(self, place: (f64, f64)) -> f64 {
        turn((place.1 - self.y).atan2(place.0 - self.x) - self.yaw)
    }

    pub(crate) fn is_finite(self) -> bool {
        [self.x, self.y, self.yaw].iter().all(|it| it.is_finite())
    }

    fn towards(self, other: Self, part: f64) -> Self {
        Self {
            x: self.x + part * (other.x - self.x),
            y: self.y + part * (other.y - self.y),
            yaw: turn(self.yaw + part * turn(other.yaw - self.yaw)),
        }
    }
}

impl From<&RosPose> for Pose {
    fn from(pose: &RosPose) -> Self {
        Self {
            x: pose.position.x,
            y: pose.position.y,
            yaw: pose.orientation.yaw(),
        }
    }
}

impl From<&Transform> for Pose {
    fn from(transform: &Transform) -> Self {
        Self {
            x: transform.translation.x,
            y: transform.translation.y,
            yaw: transform.rotation.yaw(),
        }
    }
}

/// The same direction, -π to π.
pub(crate) fn turn(angle: f64) -> f64 {
    if angle.abs() <= PI {
        angle
    } else {
        (angle + PI).rem_euclid(TAU) - PI
    }
}

/// Poses of the last second or two, to tell where the robot was when a scan was taken.
#[derive(Debug, Default)]
pub(crate) struct Track(VecDeque<(u64, Pose)>);

/// Poses that a track holds: two seconds at 100 a second.
const POSES: usize = 200;

impl Track {
    /// Adds a pose at a time in nanoseconds. One that is older than the newest begins the
    /// track anew: a simulation was started again.
    pub(crate) fn add(&mut self, time: u64, pose: Pose) {
        if self.0.back().is_some_and(|(newest, _)| time < *newest) {
            self.0.clear();
        }
        if self.0.len() == POSES {
            self.0.pop_front();
        }
        self.0.push_back((time, pose));
    }

    /// The newest pose and its time.
    pub(crate) fn newest(&self) -> Option<(u64, Pose)> {
        self.0.back().copied()
    }

    /// The pose at a time, between two that are known; `None` before the first and after the
    /// newest.
    pub(crate) fn at(&self, time: u64) -> Option<Pose> {
        let later = self.0.partition_point(|(at, _)| *at < time);
        let (after, there) = *self.0.get(later)?;
        if after == time {
            return Some(there);
        }
        let (before, here) = *self.0.get(later.checked_sub(1)?)?;
        let part = (time - before) as f64 / (after - before) as f64;
        Some(here.towards(there, part))
    }
}

/// The newest transform to each frame from its parent.
#[derive(Debug, Default)]
pub(crate) struct Frames(BTreeMap<String, (String, Pose)>);

impl Frames {
    /// Takes in transforms.
    pub(crate) fn add(&mut self, message: &TFMessage) {
        for it in &message.transforms {
            let name = |frame: &str| frame.trim_start_matches('/').to_owned();
            let parent = name(&it.header.frame_id);
            self.0.insert(
                name(&it.child_frame_id),
                (parent, Pose::from(&it.transform)),
            );
        }
    }

    /// Names of all frames, each once.
    pub(crate) fn names(&self) -> String {
        let parents = self.0.values().map(|(parent, _)| parent);
        let names: BTreeSet<_> = self.0.keys().chain(parents).map(String::as_str).collect();
        names.into_iter().collect::<Vec<_>>().join(", ")
    }

    /// The pose of a frame in another one above, below or beside it.
    pub(crate) fn find(&self, of: &str, within: &str) -> Option<Pose> {
        let (top, pose) = self.up(of);
        let (other, base) = self.up(within);
        (top == other).then(|| base.inverse().then(pose))
    }

    /// The frame that has no parent, and the pose in it.
    fn up<'a>(&'a self, of: &'a str) -> (&'a str, Pose) {
        let (mut frame, mut pose) = (of.trim_start_matches('/'), Pose::default());
        // A circle of frames ends it too.
        for _ in 0..=self.0.len() {
            let Some((parent, transform)) = self.0.get(frame) else {
                break;
            };
            (frame, pose) = (parent, transform.then(pose));
        }
        (frame, pose)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ros_messages::geometry::{Quaternion, TransformStamped, Vector3};
    use ros_messages::std_msgs::Header;

    fn pose(x: f64, y: f64, yaw: f64) -> Pose {
        Pose { x, y, yaw }
    }

    fn is_near(a: Pose, b: Pose) -> bool {
        a.distance((b.x, b.y)) < 1e-9 && turn(a.yaw - b.yaw).abs() < 1e-9
    }

    fn transform(parent: &str, child: &str, at: Pose) -> TransformStamped {
        TransformStamped {
            header: Header {
                frame_id: parent.to_owned(),
                ..Header::default()
            },
            child_frame_id: child.to_owned(),
            transform: Transform {
                translation: Vector3 {
                    x: at.x,
                    y: at.y,
                    z: 0.0,
                },
                rotation: Quaternion::from_yaw(at.yaw),
            },
        }
    }

    #[test]
    fn there_and_back_is_nowhere() {
        let there = pose(1.0, -2.0, 2.5);
        assert!(is_near(there.then(there.inverse()), Pose::default()));
        assert!(is_near(there.inverse().then(there), Pose::default()));
    }

    #[test]
    fn a_track_tells_where_the_robot_was_between_two_poses() {
        let mut track = Track::default();
        track.add(100, pose(0.0, 0.0, 3.0));
        track.add(200, pose(1.0, 2.0, -3.0));
        let middle = track.at(150).unwrap();
        assert!(is_near(middle, pose(0.5, 1.0, PI)), "{middle:?}");
        assert_eq!(track.at(99), None);
        assert_eq!(track.at(201), None);
        assert_eq!(track.at(200), Some(pose(1.0, 2.0, -3.0)));
        track.add(50, Pose::default());
        assert_eq!(track.at(150), None, "time began anew");
    }

    #[test]
    fn frames_are_found_over_their_parents() {
        let mut frames = Frames::default();
        frames.add(&TFMessage {
            transforms: vec![
                transform("map", "odom", pose(1.0, 0.0, PI / 2.0)),
                transform("odom", "base_link", pose(2.0, 0.0, 0.0)),
                transform("base_link", "laser", pose(0.0, 0.1, 0.0)),
            ],
        });
        let base = frames.find("base_link", "map").unwrap();
        assert!(is_near(base, pose(1.0, 2.0, PI / 2.0)), "{base:?}");
        let laser = frames.find("/laser", "base_link").unwrap();
        assert!(is_near(laser, pose(0.0, 0.1, 0.0)), "{laser:?}");
        assert_eq!(frames.find("camera", "map"), None);
    }

    #[test]
    fn frames_in_a_circle_are_not_found() {
        let mut frames = Frames::default();
        frames.add(&TFMessage {
            transforms: vec![
                transform("a", "b", Pose::default()),
                transform("b", "a", Pose::default()),
            ],
        });
        assert_eq!(frames.find("a", "map"), None);
    }
}
