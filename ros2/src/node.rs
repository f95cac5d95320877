//! Topics on one side, the robot on the other.

use std::fs::File;
use std::io::BufWriter;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use planner_core::RobotId;
use ros_messages::geometry::{PoseStamped, Twist, TwistStamped};
use ros_messages::nav::{OccupancyGrid, Odometry, Path};
use ros_messages::sensor::LaserScan;
use ros_messages::std_msgs::text::String as Text;
use ros_messages::std_msgs::{Bool, Header, Time, UInt8MultiArray};
use ros_messages::tf::TFMessage;
use ros_messages::visualization::MarkerArray;
use ros_messages::{Message, Recording, RecordingError};
use ros2_client::qos::{Durability, History, QosProfile, WhenFull};
use ros2_client::{
    Context, ContextOptions, MessageTypeName, Name, Node, NodeName, NodeOptions, Publisher,
    ServiceMapping, Subscription,
};
use serde::de::DeserializeOwned;

use crate::arguments::Arguments;
use crate::drive::Velocity;
use crate::geometry::Frames;
use crate::nav2::{Nav2, Outcome};
use crate::parameters::{Drive, Mapped, Parameters, PoseSource};
use crate::robot::{Order, Robot};
use crate::views;

/// Orders a second, whatever the planner's frequency is.
const CONTROL_HZ: f64 = 20.0;
/// Orders to stand still before the node leaves the wheels to others.
const LAST_ORDERS: u32 = 20;

/// Why the node cannot run, or had to end.
#[derive(Debug, thiserror::Error)]
pub(crate) enum NodeError {
    #[error("`{0}` is no name of a topic or node: {1:?}")]
    Name(String, ros2_client::names::NameError),
    #[error("a topic cannot be opened: {0:?}")]
    Open(#[from] ros2_client::ros2::CreateError),
    #[error("the node cannot be made: {0:?}")]
    Node(String),
    #[error("ROS_DOMAIN_ID is `{0}`; it has to be a number from 0 to 232")]
    Domain(String),
    #[error("{0} cannot be written: {1}")]
    Mcap(String, std::io::Error),
    #[error(transparent)]
    Recording(#[from] RecordingError),
    #[error("signals cannot be heard: {0}")]
    Signal(std::io::Error),
    #[error(
        "which robot is this? `{0}` ends with no number below 256: give each robot a parameter \
         robot_id of its own"
    )]
    NoId(String),
}

/// Reliable, for as many messages; who comes later gets none of them. Where a reader hangs,
/// messages are dropped: wheels must not wait for whoever watches.
pub(crate) fn reliable(depth: usize) -> QosProfile {
    best_effort(depth).reliability_reliable(WhenFull::Fail)
}

fn best_effort(depth: usize) -> QosProfile {
    QosProfile::subscription_default().history(History::KeepLast { depth })
}

/// Who comes later gets the last one.
fn latched(depth: usize) -> QosProfile {
    reliable(depth).durability(Durability::TransientLocal)
}

/// The node as DDS sees it, and the record of what passes through it.
struct Ports<'a> {
    node: Node,
    arguments: &'a Arguments,
    recording: Option<Recording<BufWriter<File>>>,
}

struct Out<M: serde::Serialize> {
    topic: String,
    publisher: Publisher<M>,
}

struct In<M> {
    topic: String,
    subscription: Subscription<M>,
}

impl<'a> Ports<'a> {
    fn open(arguments: &'a Arguments, mcap: &str) -> Result<Self, NodeError> {
        let domain = std::env::var("ROS_DOMAIN_ID").unwrap_or_else(|_| "0".to_owned());
        let number = domain.parse().ok().filter(|number| *number <= 232);
        let number: u16 = number.ok_or(NodeError::Domain(domain))?;
        let name = NodeName::new(&arguments.namespace, &arguments.name)
            .map_err(|error| NodeError::Name(arguments.node(), error))?;
        let context = Context::with_options(ContextOptions::new().domain_id(number))?;
        // What it says goes to the terminal; parameters are read once.
        let options = NodeOptions::new()
            .enable_rosout(false)
            .start_parameter_services(false);
        let node = context
            .new_node(name, options)
            .map_err(|error| NodeError::Node(format!("{error:?}")))?;
        let recording = match mcap {
            "" => None,
            path => {
                let file = File::create(path).map_err(|it| NodeError::Mcap(path.to_owned(), it))?;
                Some(Recording::new(BufWriter::new(file))?)
            }
        };
        Ok(Self {
            node,
            arguments,
            recording,
        })
    }

    fn name(&self, topic: &str) -> Result<(String, Name), NodeError> {
        let full = self.arguments.topic(topic);
        let name = Name::parse(&full).map_err(|error| NodeError::Name(full.clone(), error))?;
        Ok((full, name))
    }

    fn publish<M: Message>(&mut self, topic: &str, qos: QosProfile) -> Result<Out<M>, NodeError> {
        let (topic, name) = self.name(topic)?;
        let kind = MessageTypeName::new(M::PACKAGE, M::NAME);
        let dds = self.node.create_topic(&name, kind, &qos)?;
        let publisher = self.node.create_publisher(&dds, Some(qos))?;
        Ok(Out { topic, publisher })
    }

    fn subscribe<M: Message + 'static>(
        &mut self,
        topic: &str,
        qos: QosProfile,
    ) -> Result<In<M>, NodeError> {
        let (topic, name) = self.name(topic)?;
        let kind = MessageTypeName::new(M::PACKAGE, M::NAME);
        let dds = self.node.create_topic(&name, kind, &qos)?;
        let subscription = self.node.create_subscription(&dds, Some(qos))?;
        Ok(In {
            topic,
            subscription,
        })
    }

    /// Sends a message. One that cannot be sent, for a reader is slow, is as good as lost.
    fn send<M: Message>(&mut self, out: &Out<M>, message: M, time: u64) -> Result<(), NodeError> {
        if let Some(recording) = &mut self.recording {
            recording.add(&out.topic, time, &message)?;
        }
        let _ = out.publisher.publish(message);
        Ok(())
    }

    /// The next message that came.
    fn take<M: Message + DeserializeOwned + 'static>(
        &mut self,
        from: &In<M>,
        time: u64,
    ) -> Result<Option<M>, NodeError> {
        // What cannot be read is another's mistake, and said by DDS.
        let Ok(Some((message, _))) = from.subscription.take() else {
            return Ok(None);
        };
        if let Some(recording) = &mut self.recording {
            recording.add(&from.topic, time, &message)?;
        }
        Ok(Some(message))
    }

    fn say(&self, what: &str) {
        eprintln!("[{}]: {what}", self.arguments.node());
    }
}

enum Wheels {
    Twist(Out<Twist>),
    Stamped(Out<TwistStamped>),
    Nav2(Box<Nav2>),
}

struct Explore<'a> {
    ports: Ports<'a>,
    robot: Robot,
    frames: Frames,
    /// Poses, where transforms do not give them.
    odometry: Option<In<Odometry>>,
    transforms: [In<TFMessage>; 2],
    scans: Option<In<LaserScan>>,
    costmaps: Option<In<OccupancyGrid>>,
    wheels: Wheels,
    heard: In<UInt8MultiArray>,
    told: Out<UInt8MultiArray>,
    resume: In<Bool>,
    status: Out<Text>,
    map: Out<OccupancyGrid>,
    goal: Out<PoseStamped>,
    path: Out<Path>,
    markers: Out<MarkerArray>,
    activity: String,
    /// Orders to stand still since it has nothing to drive for.
    still: u32,
    begin: Instant,
}

/// Runs until a signal ends it.
pub(crate) fn run(arguments: &Arguments, parameters: Parameters) -> Result<(), NodeError> {
    let is_over = Arc::new(AtomicBool::new(false));
    for signal in [signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM] {
        signal_hook::flag::register(signal, is_over.clone()).map_err(NodeError::Signal)?;
    }
    let mut explore = Explore::open(arguments, parameters)?;
    let control = Duration::from_secs_f64(1.0 / CONTROL_HZ);
    let every = |hertz: f64| Duration::from_secs_f64(1.0 / hertz);
    let tick = every(explore.robot.parameters.planner_frequency);
    let draw = every(explore.robot.parameters.map_frequency);
    let step = tick.min(control);
    let (mut next, mut tick_at, mut draw_at) = (explore.begin, explore.begin, explore.begin);
    while !is_over.load(Ordering::Relaxed) {
        explore.hear()?;
        if next >= tick_at {
            explore.decide()?;
            tick_at += tick;
        }
        explore.drive()?;
        if next >= draw_at {
            explore.show()?;
            draw_at += draw;
        }
        next += step;
        let now = Instant::now();
        match next.checked_duration_since(now) {
            Some(pause) => std::thread::sleep(pause),
            // The machine was asleep: what was missed is not made up for.
            None => next = now,
        }
        tick_at = tick_at.max(next.checked_sub(tick).unwrap_or(next));
        draw_at = draw_at.max(next.checked_sub(draw).unwrap_or(next));
    }
    explore.end()
}

impl<'a> Explore<'a> {
    fn open(arguments: &'a Arguments, parameters: Parameters) -> Result<Self, NodeError> {
        let id = match parameters.robot_id {
            Some(id) => RobotId(id),
            None => number_of(&arguments.namespace)?,
        };
        let mut ports = Ports::open(arguments, &parameters.mcap)?;
        let p = &parameters;
        let odometry = match p.pose_source {
            PoseSource::Odom => Some(ports.subscribe(&p.odom_topic, best_effort(50))?),
            PoseSource::Tf => None,
        };
        // They say, too, where the scanner is on the robot.
        let transforms = [
            ports.subscribe(&p.tf_topic, best_effort(100))?,
            ports.subscribe(&p.tf_static_topic, latched(100))?,
        ];
        let scans = match p.needs_scans() {
            true => Some(ports.subscribe(&p.scan_topic, best_effort(5))?),
            false => None,
        };
        let costmaps = match p.costmap_topic.as_str() {
            "" => None,
            topic => Some(ports.subscribe(topic, reliable(1))?),
        };
        let wheels = match p.drive {
            Drive::Twist => Wheels::Twist(ports.publish(&p.cmd_vel_topic, reliable(1))?),
            Drive::TwistStamped => Wheels::Stamped(ports.publish(&p.cmd_vel_topic, reliable(1))?),
            Drive::Nav2 => {
                let mapping = match p.service_mapping {
                    Mapped::Enhanced => ServiceMapping::Enhanced,
                    Mapped::Cyclone => ServiceMapping::Cyclone,
                };
                let (_, action) = ports.name(&p.nav2_action)?;
                Wheels::Nav2(Box::new(Nav2::new(&mut ports.node, &action, mapping)?))
            }
        };
        // In what it says, topics have their whole names.
        let named = Parameters {
            odom_topic: ports.arguments.topic(&p.odom_topic),
            scan_topic: ports.arguments.topic(&p.scan_topic),
            tf_topic: ports.arguments.topic(&p.tf_topic),
            costmap_topic: match p.costmap_topic.as_str() {
                "" => String::new(),
                topic => ports.arguments.topic(topic),
            },
            ..parameters.clone()
        };
        let explore = Self {
            odometry,
            transforms,
            scans,
            costmaps,
            wheels,
            heard: ports.subscribe(&p.frames_topic, best_effort(64))?,
            told: ports.publish(&p.frames_topic, best_effort(64))?,
            resume: ports.subscribe("explore/resume", reliable(1))?,
            status: ports.publish("explore/status", latched(1))?,
            map: ports.publish("explore/map", latched(1))?,
            goal: ports.publish("explore/goal", reliable(1))?,
            path: ports.publish("explore/path", reliable(1))?,
            markers: ports.publish("explore/frontiers", reliable(1))?,
            frames: Frames::default(),
            activity: String::new(),
            still: 0,
            begin: Instant::now(),
            robot: Robot::new(named, id),
            ports,
        };
        explore.ports.say(&format!("robot {} is ready", id.0));
        Ok(explore)
    }

    /// Seconds since it began.
    fn now(&self) -> f64 {
        self.begin.elapsed().as_secs_f64()
    }

    /// The robot's time: that of its newest pose, so that a simulation's clock is kept to.
    fn time(&self) -> u64 {
        self.robot.track.newest().map_or(0, |(time, _)| time)
    }

    fn header(&self) -> Header {
        Header {
            stamp: Time::from_nanoseconds(self.time()),
            frame_id: self.robot.parameters.global_frame.clone(),
        }
    }

    /// Takes in all that came.
    fn hear(&mut self) -> Result<(), NodeError> {
        let (now, time) = (self.now(), self.time());
        if let Some(odometry) = &self.odometry {
            while let Some(message) = self.ports.take(odometry, time)? {
                self.robot.odometry(&message);
            }
        }
        for topic in &self.transforms {
            while let Some(message) = self.ports.take(topic, time)? {
                self.frames.add(&message);
                let p = &self.robot.parameters;
                if p.pose_source == PoseSource::Odom {
                    continue;
                }
                let times = message.transforms.iter();
                let newest = times.map(|it| it.header.stamp.nanoseconds()).max();
                let pose = self.frames.find(&p.robot_base_frame, &p.global_frame);
                if let (Some(time), Some(pose)) = (newest, pose.filter(|it| it.is_finite())) {
                    self.robot.track.add(time, pose);
                }
            }
        }
        if let Some(scans) = &self.scans {
            while let Some(scan) = self.ports.take(scans, time)? {
                let base = &self.robot.parameters.robot_base_frame;
                match self.frames.find(&scan.header.frame_id, base) {
                    Some(offset) => self.robot.scan(scan, offset, now),
                    None => self.robot.lose_scanner(scan.header.frame_id),
                }
            }
        }
        if let Some(costmaps) = &self.costmaps {
            while let Some(map) = self.ports.take(costmaps, time)? {
                self.robot.costmap(map);
            }
        }
        while let Some(frame) = self.ports.take(&self.heard, time)? {
            self.robot.receive(&frame.data);
        }
        while let Some(resume) = self.ports.take(&self.resume, time)? {
            self.robot.pause(!resume.data);
        }
        Ok(())
    }

    /// One decision, and what it makes the robot say.
    fn decide(&mut self) -> Result<(), NodeError> {
        let now = self.now();
        self.robot.tick(now);
        let time = self.time();
        while let Some(data) = self.robot.transmit() {
            let message = UInt8MultiArray {
                data,
                ..UInt8MultiArray::default()
            };
            self.ports.send(&self.told, message, time)?;
        }
        if let Some(complaint) = self.robot.take_complaint() {
            self.ports.say(&complaint);
        }
        let activity = self.robot.activity(now, &self.frames);
        if activity != self.activity {
            self.ports.say(&activity);
            let data = activity.clone();
            self.ports.send(&self.status, Text { data }, time)?;
            self.activity = activity;
        }
        Ok(())
    }

    fn drive(&mut self) -> Result<(), NodeError> {
        let now = self.now();
        let order = self.robot.order(now);
        let (header, time) = (self.header(), self.time());
        let velocity = match order {
            Order::Stay => Velocity::default(),
            Order::Go { velocity, .. } | Order::Face { velocity, .. } => velocity,
        };
        // Nothing to drive for: others may.
        let is_idle = order == Order::Stay && (self.robot.has_stopped() || self.robot.is_paused());
        self.still = if is_idle {
            self.still.saturating_add(1)
        } else {
            0
        };
        match &mut self.wheels {
            Wheels::Nav2(nav2) => {
                match order {
                    Order::Stay => nav2.stay(now),
                    Order::Go { to, .. } => {
                        let pose = self.robot.track.newest().map(|(_, pose)| pose);
                        let pose = pose.unwrap_or_default();
                        let yaw = pose.yaw + pose.turn_to(to);
                        nav2.go(views::stamped(to, yaw, header), now);
                    }
                    Order::Face { yaw, .. } => {
                        let pose = self.robot.track.newest().map(|(_, pose)| pose);
                        let pose = pose.unwrap_or_default();
                        nav2.go(views::stamped((pose.x, pose.y), yaw, header), now);
                    }
                }
                if nav2.poll() == Some(Outcome::Refused) {
                    self.ports
                        .say("Nav2 refused the goal: the way counts as blocked");
                    self.robot.refuse();
                }
            }
            _ if self.still > LAST_ORDERS => {}
            Wheels::Twist(out) => self.ports.send(out, velocity.into(), time)?,
            Wheels::Stamped(out) => {
                let header = Header {
                    frame_id: self.robot.parameters.robot_base_frame.clone(),
                    ..header
                };
                let twist = velocity.into();
                self.ports.send(out, TwistStamped { header, twist }, time)?;
            }
        }
        Ok(())
    }

    /// Shows what it knows and where it goes.
    fn show(&mut self) -> Result<(), NodeError> {
        let (header, time) = (self.header(), self.time());
        let p = &self.robot.parameters;
        let map = views::occupancy(self.robot.map(), header.clone(), p);
        let path = views::path(self.robot.way(), header.clone(), p);
        let markers = views::markers(self.robot.map(), &header, p);
        let goal = self.robot.goal().map(|goal| views::middle(goal, p));
        let visualize = p.visualize;
        self.ports.send(&self.map, map, time)?;
        self.ports.send(&self.path, path, time)?;
        if visualize {
            self.ports.send(&self.markers, markers, time)?;
        }
        if let Some(place) = goal {
            let goal = views::stamped(place, 0.0, header);
            self.ports.send(&self.goal, goal, time)?;
        }
        Ok(())
    }

    /// Stands still and closes the record.
    fn end(mut self) -> Result<(), NodeError> {
        let (header, time) = (self.header(), self.time());
        match &mut self.wheels {
            Wheels::Twist(out) => self.ports.send(out, Twist::default(), time)?,
            Wheels::Stamped(out) => {
                let twist = Twist::default();
                self.ports.send(out, TwistStamped { header, twist }, time)?;
            }
            Wheels::Nav2(nav2) => nav2.cancel(),
        }
        if let Some(recording) = self.ports.recording.take() {
            recording.finish()?;
        }
        // The last order is on its way.
        std::thread::sleep(Duration::from_millis(100));
        Ok(())
    }
}

/// The number that a namespace ends with: 3 of `/robot3`.
fn number_of(namespace: &str) -> Result<RobotId, NodeError> {
    let digits = namespace
        .trim_end_matches(|it: char| it.is_ascii_digit())
        .len();
    let number = namespace.get(digits..).unwrap_or_default();
    let number = number
        .parse()
        .map_err(|_| NodeError::NoId(namespace.to_owned()))?;
    Ok(RobotId(number))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_namespace_says_which_robot_it_is() {
        assert_eq!(number_of("/robot3").unwrap(), RobotId(3));
        assert_eq!(number_of("/fleet/r12").unwrap(), RobotId(12));
        for namespace in ["/", "/robot", "/robot256"] {
            let error = number_of(namespace).unwrap_err().to_string();
            assert!(error.contains("robot_id"), "{error}");
        }
    }
}
