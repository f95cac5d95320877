//! One robot: poses, scans and frames in; orders, frames and views out. It knows no ROS but
//! its messages, and no clock but what it is told.

use std::collections::VecDeque;

use planner_core::explorer::Explorer;
use planner_core::radio::{FrameError, MAX_LEN};
use planner_core::{Action, Cell, Errands, Map, Motion, Planner, RobotId, Sighting, Stop, Wait};
use ros_messages::nav::{OccupancyGrid, Odometry};
use ros_messages::sensor::LaserScan;

use crate::drive::{Progress, Velocity, steer, turn_by};
use crate::geometry::{Frames, Pose, Track, turn};
use crate::parameters::{Parameters, PoseSource, TILES};
use crate::sight::{Bearings, on_grid, read_map, room_ahead};
use crate::views;

/// Scans that wait for their pose; more than come between two decisions.
const SCANS: usize = 8;
/// Nanoseconds that a scan may be newer than the newest pose when it is taken anyway.
const LATE: u64 = 300_000_000;
/// Decisions between two looks at whether only small frontiers are left.
const SELDOM: u32 = 10;

/// What the robot is to do now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Order {
    /// Stand still.
    Stay,
    /// Turn in place: to a yaw, and how.
    Face { yaw: f64, velocity: Velocity },
    /// Go to a place, and how.
    Go { to: (f64, f64), velocity: Velocity },
}

/// A robot that explores.
pub(crate) struct Robot {
    pub(crate) parameters: Parameters,
    explorer: Box<Explorer<TILES, TILES>>,
    id: RobotId,
    has_started: bool,
    pub(crate) track: Track,
    bearings: Bearings,
    /// With the scanner's pose on the robot.
    scans: VecDeque<(LaserScan, Pose)>,
    costmap: Option<OccupancyGrid>,
    room: f64,
    /// When the last scan came, in seconds.
    scanned_at: Option<f64>,
    progress: Progress,
    is_paused: bool,
    /// How many frontiers were left, all too small, when it stopped for that.
    small: Option<usize>,
    ticks: u32,
    last: Action,
    complaint: Option<String>,
    refused: Option<FrameError>,
    /// The frame of a scanner that no transform places on the robot.
    unplaced: Option<String>,
    /// Whether it was said that odometry is in another frame, and that the robot is off the
    /// map.
    has_said_frame: bool,
    has_said_place: bool,
}

impl Robot {
    pub(crate) fn new(parameters: Parameters, id: RobotId) -> Self {
        Self {
            parameters,
            explorer: Box::new(Explorer::vacant()),
            id,
            has_started: false,
            track: Track::default(),
            bearings: Bearings::default(),
            scans: VecDeque::new(),
            costmap: None,
            room: f64::INFINITY,
            scanned_at: None,
            progress: Progress::default(),
            is_paused: false,
            small: None,
            ticks: 0,
            last: Action::Wait,
            complaint: None,
            refused: None,
            unplaced: None,
            has_said_frame: false,
            has_said_place: false,
        }
    }

    /// A pose out of odometry.
    pub(crate) fn odometry(&mut self, message: &Odometry) {
        let pose = Pose::from(&message.pose.pose);
        if !pose.is_finite() {
            return;
        }
        self.track.add(message.header.stamp.nanoseconds(), pose);
        let (frame, global) = (&message.header.frame_id, &self.parameters.global_frame);
        if frame != global && !self.has_said_frame {
            let what = format!(
                "odometry is in the frame {frame}, and is taken as if it were in {global}: set \
                 global_frame to {frame}, or pose_source to tf"
            );
            self.has_said_frame = true;
            self.complain(what);
        }
    }

    /// A scan came from a frame that no transform places on the robot: nothing is known of
    /// what it shows.
    pub(crate) fn lose_scanner(&mut self, frame: String) {
        self.unplaced = Some(frame);
    }

    /// A scan, from a scanner at `offset` on the robot, that came at `now` seconds.
    pub(crate) fn scan(&mut self, scan: LaserScan, offset: Pose, now: f64) {
        self.unplaced = None;
        self.room = room_ahead(&scan, offset, self.parameters.robot_radius);
        self.scanned_at = Some(now);
        if !self.parameters.costmap_topic.is_empty() {
            return;
        }
        if self.scans.len() == SCANS {
            self.scans.pop_front();
        }
        self.scans.push_back((scan, offset));
    }

    /// A map of somebody else's.
    pub(crate) fn costmap(&mut self, map: OccupancyGrid) {
        self.costmap = Some(map);
    }

    /// A frame of another robot, or the echo of an own one.
    pub(crate) fn receive(&mut self, bytes: &[u8]) {
        if !self.has_started {
            return;
        }
        match self.explorer.receive(bytes) {
            Ok(_) | Err(FrameError::Own) => {}
            Err(error) if self.refused == Some(error) => {}
            Err(error) => {
                self.refused = Some(error);
                self.complain(format!("a frame is not taken: {error}"));
            }
        }
    }

    /// The next frame for the others, if there is one.
    pub(crate) fn transmit(&mut self) -> Option<Vec<u8>> {
        let mut frame = [0; MAX_LEN];
        let length = self.explorer.transmit(&mut frame)?;
        frame.get(..length).map(<[u8]>::to_vec)
    }

    /// Stands still until it is told to go on; to go on is also to try again what was given
    /// up.
    pub(crate) fn pause(&mut self, is_paused: bool) {
        self.is_paused = is_paused;
        if !is_paused {
            self.small = None;
            self.explorer.resume();
        }
    }

    pub(crate) fn is_paused(&self) -> bool {
        self.is_paused
    }

    /// What the robot drives for refused to take it there.
    pub(crate) fn refuse(&mut self) {
        self.explorer.report(Motion::Blocked);
    }

    /// Decides, at `now` seconds.
    pub(crate) fn tick(&mut self, now: f64) {
        self.look();
        let Some((_, pose)) = self.track.newest() else {
            return;
        };
        if !self.has_started && !self.start(pose) {
            return;
        }
        self.ticks = self.ticks.wrapping_add(1);
        self.mind_small();
        self.last = self.explorer.tick();
        if !matches!(self.last, Action::Move(_)) || self.is_paused || self.is_blind(now) {
            self.progress.rest();
            return;
        }
        let (far, timeout) = (self.parameters.resolution / 2.0, self.timeout());
        if self.progress.is_stuck(pose, now, far, timeout) {
            self.complain(format!(
                "no progress for {timeout} s: the way is blocked, or nothing follows the orders"
            ));
            self.refuse();
        }
    }

    /// What to do at `now` seconds: as it was decided, from where the robot is by now.
    pub(crate) fn order(&mut self, now: f64) -> Order {
        self.look();
        let Some((_, pose)) = self.track.newest() else {
            return Order::Stay;
        };
        if self.is_paused || self.is_blind(now) {
            return Order::Stay;
        }
        match (self.last, self.explorer.waiting()) {
            (Action::Move(_), _) => {
                let Some(cell) = self.explorer.waypoint() else {
                    return Order::Stay;
                };
                let to = views::middle(cell, &self.parameters);
                let velocity = steer(pose, to, self.room, &self.parameters);
                Order::Go { to, velocity }
            }
            (Action::Wait, Some(Wait::Look(direction))) => {
                let yaw = direction.yaw().into();
                let velocity = turn_by(turn(yaw - pose.yaw), &self.parameters);
                Order::Face { yaw, velocity }
            }
            (Action::Wait | Action::Stop(_), _) => Order::Stay,
        }
    }

    /// What it does, in words.
    pub(crate) fn activity(&self, now: f64, frames: &Frames) -> String {
        if self.track.newest().is_some() && !self.has_started {
            return "waiting: the pose lies off the map".to_owned();
        }
        if !self.has_started {
            return match self.parameters.pose_source {
                PoseSource::Tf => self.no_transform(&self.parameters.global_frame, frames),
                PoseSource::Odom => {
                    format!("waiting: no odometry on {} yet", self.parameters.odom_topic)
                }
            };
        }
        if let Action::Stop(stop) = self.last {
            return match (stop, self.small) {
                (Stop::Arrived { .. } | Stop::Home { .. }, Some(frontiers)) => {
                    format!("complete; {frontiers} frontiers are smaller than min_frontier_size")
                }
                _ => stop.to_string(),
            };
        }
        match self.explorer.waiting() {
            _ if self.is_paused => "paused".to_owned(),
            _ if self.lacks_map() => {
                format!("waiting for a map on {}", self.parameters.costmap_topic)
            }
            _ if self.is_blind(now) => match &self.unplaced {
                Some(frame) => self.no_transform(frame, frames),
                None => {
                    let topic = &self.parameters.scan_topic;
                    format!("waiting for {topic}: no scan came lately")
                }
            },
            Some(Wait::Pose) => "waiting: the pose lies off the map".to_owned(),
            Some(Wait::Obstructed) => "waiting: something is in the way".to_owned(),
            _ => "exploring".to_owned(),
        }
    }

    fn no_transform(&self, from: &str, frames: &Frames) -> String {
        let (base, topic) = (&self.parameters.robot_base_frame, &self.parameters.tf_topic);
        let heard = match frames.names() {
            names if names.is_empty() => format!("nothing came on {topic}"),
            names => format!("frames on {topic}: {names}"),
        };
        format!("waiting: no transform from {from} to {base} yet; {heard}")
    }

    /// Whether it has come to an end.
    pub(crate) fn has_stopped(&self) -> bool {
        matches!(self.last, Action::Stop(_))
    }

    /// What was wrong since it was last asked.
    pub(crate) fn take_complaint(&mut self) -> Option<String> {
        self.complaint.take()
    }

    pub(crate) fn map(&self) -> &Map<TILES, TILES> {
        self.explorer.map()
    }

    pub(crate) fn goal(&self) -> Option<Cell> {
        self.explorer.status().goal.filter(|_| !self.has_stopped())
    }

    pub(crate) fn way(&self) -> impl Iterator<Item = Cell> + use<> {
        self.explorer.way()
    }

    /// Whether what it has to see by is silent.
    fn is_blind(&self, now: f64) -> bool {
        let is_old = |then: f64| now - then > self.parameters.sensor_timeout;
        self.lacks_map() || self.parameters.needs_scans() && self.scanned_at.is_none_or(is_old)
    }

    /// Whether another's map is still to come; it may then change as seldom as it likes.
    fn lacks_map(&self) -> bool {
        self.costmap.is_none() && !self.parameters.costmap_topic.is_empty()
    }

    fn timeout(&self) -> f64 {
        self.parameters.progress_timeout
    }

    fn complain(&mut self, what: String) {
        self.complaint = Some(what);
    }

    /// Begins where the robot is.
    fn start(&mut self, pose: Pose) -> bool {
        let grid = on_grid(pose, &self.parameters);
        let cell = Cell::new(grid.x.floor() as i16, grid.y.floor() as i16);
        let (config, extent) = (self.parameters.config(), self.parameters.extent());
        match self.explorer.reset(config, self.id, extent, cell) {
            Ok(()) => self.has_started = true,
            Err(_) if self.has_said_place => {}
            Err(error) => {
                self.has_said_place = true;
                self.complain(format!(
                    "the robot is at ({:.2}, {:.2}), and {error}: set origin_x, origin_y, width, \
                     height and resolution so that the map holds it",
                    pose.x, pose.y
                ));
            }
        }
        self.has_started
    }

    /// Takes in what was seen, each look from where the robot was then.
    fn look(&mut self) {
        while let Some((scan, _)) = self.scans.front() {
            let time = scan.header.stamp.nanoseconds();
            let Some((newest, last)) = self.track.newest() else {
                return;
            };
            // A scan without a time is of now.
            let pose = match time {
                0 => Some(last),
                _ if time > newest && time - newest > LATE => Some(last),
                _ if time > newest => return,
                _ => self.track.at(time),
            };
            let Some((scan, offset)) = self.scans.pop_front() else {
                return;
            };
            let (Some(pose), true) = (pose, self.has_started) else {
                continue;
            };
            let look = self
                .bearings
                .look(&scan, pose.then(offset), &self.parameters);
            match look {
                Ok(sighting) => self.observe(&sighting),
                Err(error) => self.complain(error),
            }
        }
        if let (Some(map), Some((_, pose)), true) =
            (&self.costmap, self.track.newest(), self.has_started)
        {
            match read_map(map, pose, &self.parameters) {
                Some(sighting) => self.observe(&sighting),
                None => {
                    let topic = &self.parameters.costmap_topic;
                    let what = format!("the map on {topic} is turned, or its sizes do not agree");
                    self.complain(what);
                    self.costmap = None;
                }
            }
        }
    }

    fn observe(&mut self, sighting: &Sighting) {
        self.explorer.observe(sighting);
    }

    /// Ends where only frontiers are left that are too small, and goes on if others come.
    fn mind_small(&mut self) {
        let is_due = self.parameters.min_frontier_size > 0.0 && self.ticks.is_multiple_of(SELDOM);
        if !is_due || self.is_paused || self.map().frontiers() == 0 {
            return;
        }
        let frontiers = views::frontiers(self.map(), &self.parameters);
        let has_large = frontiers
            .first()
            .is_some_and(|it| views::is_large(it, &self.parameters));
        match (has_large, self.small) {
            (true, Some(_)) => {
                self.small = None;
                self.explorer.resume();
            }
            (false, None) if !self.has_stopped() => {
                self.small = Some(frontiers.len());
                if self.parameters.return_to_init {
                    self.explorer.go_home();
                } else {
                    let here = self.explorer.status().position;
                    self.explorer.go_to(here);
                }
            }
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests;
