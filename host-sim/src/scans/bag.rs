//! Logs out of recordings (MCAP) of ROS 2: scans of `sensor_msgs/LaserScan`, and poses of TF
//! or of `nav_msgs/Odometry`.
//!
//! A scan's pose is that of its frame at its time in the frame that no other leads to, such
//! as `map`; between two transforms it goes straight from one to the other. Frames that only
//! odometry tells of have their poses from there.

use std::collections::{BTreeMap, HashMap};

use ros_messages::geometry::{Point, Quaternion};
use ros_messages::nav::Odometry;
use ros_messages::sensor::LaserScan;
use ros_messages::std_msgs::Header;
use ros_messages::tf::TFMessage;
use ros_messages::{Message, RecordingError, recorded};

use super::read::{FARTHEST, Problem};
use super::{Log, Look, Reading};
use crate::excerpt::excerpt;

/// A scan farther than this from any pose of its frame has none: nanoseconds.
const LONGEST_GAP: u64 = 1_000_000_000;
/// Frames on the way from a sensor to the map.
const MOST_FRAMES: usize = 32;

/// A pose in the plane: metres and radians.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Pose {
    x: f64,
    y: f64,
    yaw: f64,
}

impl Pose {
    fn of(Point { x, y, .. }: &Point, turn: &Quaternion) -> Self {
        let (x, y) = (*x, *y);
        Self {
            x,
            y,
            yaw: turn.yaw(),
        }
    }

    /// What lies at `self` in a frame that lies at `frame`.
    fn within(self, frame: Self) -> Self {
        let (sin, cos) = frame.yaw.sin_cos();
        Self {
            x: frame.x + self.x * cos - self.y * sin,
            y: frame.y + self.x * sin + self.y * cos,
            yaw: frame.yaw + self.yaw,
        }
    }

    /// Between this pose (0) and another one (1).
    fn towards(self, other: Self, share: f64) -> Self {
        let turn = (other.yaw - self.yaw)
            .sin()
            .atan2((other.yaw - self.yaw).cos());
        Self {
            x: self.x + share * (other.x - self.x),
            y: self.y + share * (other.y - self.y),
            yaw: self.yaw + share * turn,
        }
    }

    fn is_near(self) -> bool {
        let Self { x, y, yaw } = self;
        [x, y, yaw].iter().all(|of| of.abs() <= FARTHEST)
    }
}

/// Where a frame lies in the one that it hangs on.
#[derive(Default)]
struct Frame {
    parent: String,
    /// By nanoseconds.
    poses: BTreeMap<u64, Pose>,
    /// Whether one pose holds for ever.
    is_fixed: bool,
}

impl Frame {
    fn at(&self, time: u64) -> Option<Pose> {
        let before = self.poses.range(..=time).next_back();
        let after = self.poses.range(time..).next();
        if self.is_fixed {
            return before.or(after).map(|(_, pose)| *pose);
        }
        let near = |&(at, _): &(&u64, &Pose)| at.abs_diff(time) <= LONGEST_GAP;
        match (before.filter(near), after.filter(near)) {
            (Some((from, a)), Some((to, b))) if from < to => {
                let share = (time - from) as f64 / (to - from) as f64;
                Some(a.towards(*b, share))
            }
            (Some((_, pose)), _) | (None, Some((_, pose))) => Some(*pose),
            (None, None) => None,
        }
    }
}

/// All frames, by name.
#[derive(Default)]
struct Frames(HashMap<String, Frame>);

impl Frames {
    fn add(&mut self, child: &str, parent: &str, time: u64, pose: Pose, is_fixed: bool) {
        let frame = self.0.entry(plain(child).into()).or_default();
        frame.parent = plain(parent).into();
        frame.is_fixed |= is_fixed;
        frame.poses.insert(time, pose);
    }

    /// Where a frame lies in the outermost one.
    fn pose(&self, name: &str, time: u64) -> Option<Pose> {
        let mut frame = self.0.get(plain(name))?;
        let mut pose = frame.at(time)?;
        for _ in 0..MOST_FRAMES {
            match self.0.get(&frame.parent) {
                None => return Some(pose).filter(|pose| pose.is_near()),
                Some(next) => {
                    pose = pose.within(next.at(time)?);
                    frame = next;
                }
            }
        }
        None
    }
}

/// A frame's name without the slash that old programs write before it.
fn plain(name: &str) -> &str {
    name.trim_start_matches('/')
}

/// The log that a recording holds.
pub(super) fn log(bytes: &[u8]) -> Result<Log, Problem> {
    let wrong = |error: RecordingError| Problem::Bag(error.to_string());
    let (mut frames, mut odometry) = (Frames::default(), Frames::default());
    let mut scans = Vec::new();
    for message in recorded(bytes).map_err(wrong)? {
        let message = message.map_err(wrong)?;
        let unread = |error| wrong(RecordingError::Bytes(error));
        match &*message.kind {
            "sensor_msgs/msg/LaserScan" => {
                scans.push(LaserScan::from_bytes(&message.bytes).map_err(unread)?);
            }
            "tf2_msgs/msg/TFMessage" => {
                let is_fixed = message.topic.ends_with("tf_static");
                let tf = TFMessage::from_bytes(&message.bytes).map_err(unread)?;
                for of in &tf.transforms {
                    let place = &of.transform.translation;
                    let place = Point {
                        x: place.x,
                        y: place.y,
                        z: place.z,
                    };
                    let pose = Pose::of(&place, &of.transform.rotation);
                    let time = of.header.stamp.nanoseconds();
                    let parent = &of.header.frame_id;
                    frames.add(&of.child_frame_id, parent, time, pose, is_fixed);
                }
            }
            "nav_msgs/msg/Odometry" => {
                let of = Odometry::from_bytes(&message.bytes).map_err(unread)?;
                let pose = Pose::of(&of.pose.pose.position, &of.pose.pose.orientation);
                let (time, parent) = (of.header.stamp.nanoseconds(), &of.header.frame_id);
                odometry.add(&of.child_frame_id, parent, time, pose, false);
            }
            _ => {}
        }
    }
    for (name, frame) in odometry.0 {
        frames.0.entry(name).or_insert(frame);
    }
    of_scans(&scans, &frames)
}

fn of_scans(scans: &[LaserScan], frames: &Frames) -> Result<Log, Problem> {
    let pose = |scan: &LaserScan| {
        let Header { stamp, frame_id } = &scan.header;
        frames.pose(frame_id, stamp.nanoseconds())
    };
    let looks: Vec<_> = { scans.iter() }
        .filter_map(|scan| Some(look(scan, pose(scan)?)))
        .collect();
    if looks.is_empty() {
        return Err(match scans.first() {
            None => Problem::NoScanInBag,
            Some(scan) => Problem::NoPoseInBag(excerpt(&scan.header.frame_id)),
        });
    }
    let largest = scans.iter().map(|scan| scan.range_max);
    Ok(Log {
        name: String::new(),
        looks,
        nothing_from: largest.fold(0.0, f32::max),
    })
}

/// Infinite readings hit nothing; others beyond the sensor's limits are none.
fn look(scan: &LaserScan, pose: Pose) -> Look {
    let readings = scan
        .ranges
        .iter()
        .zip(0u32..)
        .map(|(&range, beam)| Reading {
            bearing: scan.angle_min + scan.angle_increment * beam as f32,
            range: match range {
                f32::INFINITY => range,
                _ if (scan.range_min..=scan.range_max).contains(&range) => range,
                _ => -1.0,
            },
        });
    Look {
        x: pose.x,
        y: pose.y,
        heading: pose.yaw,
        readings: readings.filter(|of| of.bearing.is_finite()).collect(),
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;
    use std::io::Cursor;

    use ros_messages::Recording;
    use ros_messages::geometry::{Transform, TransformStamped, Vector3};
    use ros_messages::std_msgs::Time;

    use super::*;

    const SECOND: u64 = 1_000_000_000;

    fn header(time: u64, frame_id: &str) -> Header {
        Header {
            stamp: Time::from_nanoseconds(time),
            frame_id: frame_id.into(),
        }
    }

    fn tf(parent: &str, child: &str, time: u64, (x, y, yaw): (f64, f64, f64)) -> TFMessage {
        TFMessage {
            transforms: vec![TransformStamped {
                header: header(time, parent),
                child_frame_id: child.into(),
                transform: Transform {
                    translation: Vector3 { x, y, z: 0.2 },
                    rotation: Quaternion::from_yaw(yaw),
                },
            }],
        }
    }

    fn odometry(time: u64, x: f64) -> Odometry {
        let mut of = Odometry {
            header: header(time, "odom"),
            child_frame_id: "base".into(),
            ..Odometry::default()
        };
        of.pose.pose.position.x = x;
        of.pose.pose.orientation = Quaternion::from_yaw(0.0);
        of
    }

    fn scan(time: u64, frame: &str) -> LaserScan {
        LaserScan {
            header: header(time, frame),
            angle_min: -1.0,
            angle_increment: 0.5,
            range_min: 0.1,
            range_max: 4.0,
            ranges: vec![1.0, f32::INFINITY, 0.05, 9.0, f32::NAN],
            ..LaserScan::default()
        }
    }

    fn recording(add: impl FnOnce(&mut Recording<Cursor<Vec<u8>>>)) -> Vec<u8> {
        let mut recording = Recording::new(Cursor::new(Vec::new())).unwrap();
        add(&mut recording);
        recording.finish().unwrap().into_inner()
    }

    #[test]
    fn a_scan_is_where_its_frame_was_at_its_time() {
        let bytes = recording(|to| {
            let fixed = [
                tf("map", "/odom", 0, (10.0, 0.0, FRAC_PI_2)),
                tf("base", "laser", 0, (0.5, 0.0, FRAC_PI_2)),
            ];
            for of in &fixed {
                to.add("/tf_static", 0, of).unwrap();
            }
            for (time, x) in [(50, 2.0), (51, 4.0)] {
                to.add("/odom", 0, &odometry(time * SECOND, x)).unwrap();
            }
            for time in [50 * SECOND + SECOND / 4, 90 * SECOND] {
                to.add("/scan", 0, &scan(time, "laser")).unwrap();
            }
        });
        let log = log(&bytes).unwrap();
        // The second scan is long after the last odometry.
        let [look] = &log.looks[..] else {
            panic!("{:?}", log.looks)
        };
        // A quarter of the way from 2 m to 4 m, half a metre before it, up from the map's odom.
        assert!(
            (look.x - 10.0).abs() < 1e-9 && (look.y - 3.0).abs() < 1e-9,
            "{look:?}"
        );
        assert!((look.heading - 2.0 * FRAC_PI_2).abs() < 1e-9, "{look:?}");
        let ranges: Vec<_> = look.readings.iter().map(|of| of.range).collect();
        assert_eq!(ranges, [1.0, f32::INFINITY, -1.0, -1.0, -1.0]);
        assert_eq!((look.readings[1].bearing, log.nothing_from), (-0.5, 4.0));
    }

    #[test]
    fn what_is_missing_in_a_recording_is_named() {
        let error = |bytes: &[u8]| log(bytes).unwrap_err().to_string();
        let nothing = recording(|to| to.add("/odom", 0, &odometry(0, 0.0)).unwrap());
        assert!(error(&nothing).contains("no sensor_msgs/LaserScan"));
        let lost = recording(|to| to.add("/scan", 0, &scan(0, "laser")).unwrap());
        assert!(error(&lost).contains("frame laser"));
        let round = recording(|to| {
            to.add("/tf", 0, &tf("a", "laser", 0, (0.0, 0.0, 0.0)))
                .unwrap();
            to.add("/tf", 0, &tf("laser", "a", 0, (0.0, 0.0, 0.0)))
                .unwrap();
            to.add("/scan", 0, &scan(0, "laser")).unwrap();
        });
        assert!(error(&round).contains("frame laser"));
        assert!(error(b"\x89MCAP0\r\nnothing").contains("cannot be read"));
    }
}
