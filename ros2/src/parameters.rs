//! Parameters of the node. Those that explore_lite has too have its names.

use planner_core::Extent;
use planner_core::explorer::{Config, MAX_CLEARANCE, SensorModel};
use planner_core::radio::LinkConfig;
use planner_core::sight::RangeSensor;
use serde::Deserialize;
use serde_yaml_ng::{Mapping, Value};

/// Tiles of the map each way.
pub(crate) const TILES: usize = 16;
/// Cells of the map each way, at most.
pub(crate) const CELLS: u16 = 8 * TILES as u16;

/// Decisions a second at least. explore_lite, whose files say less, only searches then.
const LEAST_FREQUENCY: f64 = 5.0;

/// What ROS sets on any node, and what only weighs explore_lite's frontiers: not wrong, but
/// without a meaning here.
const IDLE: [&str; 6] = [
    "use_sim_time",
    "potential_scale",
    "orientation_scale",
    "gain_scale",
    "transform_tolerance",
    "costmap_updates_topic",
];

/// All parameters; docs/ros2.md has the table.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(default, deny_unknown_fields)]
pub(crate) struct Parameters {
    /// Decisions a second.
    pub(crate) planner_frequency: f64,
    /// Seconds without progress after which a step counts as blocked.
    pub(crate) progress_timeout: f64,
    /// Metres; smaller frontiers are neither drawn nor gone to at the end.
    pub(crate) min_frontier_size: f64,
    pub(crate) return_to_init: bool,
    /// Whether frontiers are published.
    pub(crate) visualize: bool,
    pub(crate) robot_base_frame: String,
    /// Where maps of others come from; empty: the robot's scans are its sight.
    pub(crate) costmap_topic: String,

    pub(crate) global_frame: String,
    /// The side of a cell in metres.
    pub(crate) resolution: f64,
    /// The corner of least x and y; without it the map lies around the frame's origin.
    pub(crate) origin_x: Option<f64>,
    pub(crate) origin_y: Option<f64>,
    /// In cells.
    pub(crate) width: u16,
    pub(crate) height: u16,

    /// Differs from robot to robot; without it, the number that the namespace ends with.
    pub(crate) robot_id: Option<u8>,
    /// Metres from the scanner to the farthest part of the body, with errors of pose and
    /// control.
    pub(crate) robot_radius: f64,
    pub(crate) pose_source: PoseSource,
    pub(crate) odom_topic: String,
    pub(crate) tf_topic: String,
    pub(crate) tf_static_topic: String,

    pub(crate) scan_topic: String,
    /// Metres up to which every wall answers; 0: the scan's own.
    pub(crate) max_range: f64,
    /// Metres by which the end of a beam may lie elsewhere, with the errors of the pose.
    pub(crate) scan_error: f64,

    pub(crate) drive: Drive,
    pub(crate) cmd_vel_topic: String,
    /// Metres a second.
    pub(crate) max_speed: f64,
    /// Radians a second.
    pub(crate) max_turn: f64,
    /// Metres from the body at which nothing may stand ahead.
    pub(crate) stop_distance: f64,
    /// Seconds without a scan after which the robot stands still.
    pub(crate) sensor_timeout: f64,
    pub(crate) nav2_action: String,
    pub(crate) service_mapping: Mapped,

    /// Where robots exchange frames: the same for all.
    pub(crate) frames_topic: String,
    /// Maps published a second.
    pub(crate) map_frequency: f64,
    /// A file that what the node hears and says is recorded in; empty: none.
    pub(crate) mcap: String,
}

/// Where poses come from.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub(crate) enum PoseSource {
    /// `nav_msgs/Odometry` in the global frame.
    Odom,
    /// `tf2_msgs/TFMessage`.
    Tf,
}

/// Who drives.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Drive {
    /// The node, by `geometry_msgs/Twist`.
    Twist,
    /// The node, by `geometry_msgs/TwistStamped`.
    TwistStamped,
    /// Nav2, by its action `NavigateToPose`.
    Nav2,
}

/// How services are mapped to DDS, which the middleware of the server decides.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Mapped {
    /// As Fast DDS and Connext do.
    Enhanced,
    /// As Cyclone DDS does.
    Cyclone,
}

impl Default for Parameters {
    fn default() -> Self {
        Self {
            planner_frequency: 10.0,
            progress_timeout: 10.0,
            min_frontier_size: 0.0,
            return_to_init: false,
            visualize: true,
            robot_base_frame: "base_link".to_owned(),
            costmap_topic: String::new(),
            global_frame: "map".to_owned(),
            resolution: 0.2,
            origin_x: None,
            origin_y: None,
            width: CELLS,
            height: CELLS,
            robot_id: None,
            robot_radius: 0.2,
            pose_source: PoseSource::Tf,
            odom_topic: "odom".to_owned(),
            tf_topic: "/tf".to_owned(),
            tf_static_topic: "/tf_static".to_owned(),
            scan_topic: "scan".to_owned(),
            max_range: 0.0,
            scan_error: 0.04,
            drive: Drive::Twist,
            cmd_vel_topic: "cmd_vel".to_owned(),
            max_speed: 0.3,
            max_turn: 1.0,
            stop_distance: 0.1,
            sensor_timeout: 1.0,
            nav2_action: "navigate_to_pose".to_owned(),
            service_mapping: Mapped::Enhanced,
            frames_topic: "/explore/frames".to_owned(),
            map_frequency: 1.0,
            mcap: String::new(),
        }
    }
}

/// A parameter that cannot be.
#[derive(Debug, PartialEq, thiserror::Error)]
pub(crate) enum ParameterError {
    /// No such parameter, or of another type.
    #[error("parameter {0}: {1}")]
    Parse(String, String),
    #[error("parameter {name} is {value}; it has to be above {least} and at most {most}")]
    Range {
        name: &'static str,
        value: f64,
        least: f64,
        most: f64,
    },
    #[error(
        "parameter resolution is {0} m; planners reckon in whole millimetres: give a multiple of \
         0.001"
    )]
    Millimetres(f64),
    #[error(
        "parameter {name} is {value}; the map has at most {CELLS} cells each way, and at least \
         one: give a larger resolution instead"
    )]
    Cells { name: &'static str, value: u16 },
    #[error(
        "parameter scan_error is {error} m, more than a quarter of a cell of {resolution} m: \
         give a resolution of {} m or more", 4.0 * error
    )]
    ScanError { error: f64, resolution: f64 },
    #[error(
        "parameter robot_radius is {radius} m, more than {} m, which is what cells of \
         {resolution} m allow: give a larger resolution", 3.5 * resolution
    )]
    Radius { radius: f64, resolution: f64 },
}

impl Parameters {
    /// Reads them; also returns what is to be told of them.
    ///
    /// # Errors
    /// One is unknown, of another type, or impossible.
    pub(crate) fn read(mut values: Mapping) -> Result<(Self, Vec<String>), ParameterError> {
        let idle = IDLE
            .into_iter()
            .filter(|name| values.remove(name).is_some());
        let mut notes: Vec<String> = idle
            .map(|name| format!("parameter {name} has no meaning here"))
            .collect();
        let parse = |values| serde_yaml_ng::from_value::<Self>(Value::Mapping(values));
        let mut read = parse(values.clone()).map_err(|error| {
            // Which one is it? The first that alone is wrong.
            let alone = |(name, value)| Mapping::from_iter([(name, value)]);
            let wrong = values.into_iter().find_map(|(name, value)| {
                let error = parse(alone((name.clone(), value))).err()?;
                Some((name.as_str().unwrap_or("?").to_owned(), error.to_string()))
            });
            let (name, why) = wrong.unwrap_or_else(|| ("?".to_owned(), error.to_string()));
            ParameterError::Parse(name, why)
        })?;
        read.check()?;
        if read.planner_frequency < LEAST_FREQUENCY {
            notes.push(format!(
                "parameter planner_frequency is {}: taken for {LEAST_FREQUENCY}; robots here decide at \
                 every step, and wait for a number of decisions",
                read.planner_frequency
            ));
            read.planner_frequency = LEAST_FREQUENCY;
        }
        Ok((read, notes))
    }

    fn check(&self) -> Result<(), ParameterError> {
        let range = |name, value: f64, least: f64, most: f64| {
            // Not a number is outside too.
            if value > least && value <= most {
                Ok(())
            } else {
                Err(ParameterError::Range {
                    name,
                    value,
                    least,
                    most,
                })
            }
        };
        range("planner_frequency", self.planner_frequency, 0.0, 1000.0)?;
        range("progress_timeout", self.progress_timeout, 0.0, 1e6)?;
        range("min_frontier_size", self.min_frontier_size, -1e-9, 1e3)?;
        range("resolution", self.resolution, 0.0, 65.0)?;
        range("robot_radius", self.robot_radius, 0.0, 1e3)?;
        range("max_range", self.max_range, -1e-9, 1e4)?;
        range("scan_error", self.scan_error, 0.0, 1e3)?;
        range("max_speed", self.max_speed, 0.0, 100.0)?;
        range("max_turn", self.max_turn, 0.0, 100.0)?;
        range("stop_distance", self.stop_distance, 0.0, 100.0)?;
        range("sensor_timeout", self.sensor_timeout, 0.0, 1e6)?;
        range("map_frequency", self.map_frequency, 0.0, 1000.0)?;
        let millimetres = self.resolution * 1000.0;
        if (millimetres - millimetres.round()).abs() > 1e-6 {
            return Err(ParameterError::Millimetres(self.resolution));
        }
        for (name, value) in [("width", self.width), ("height", self.height)] {
            if !(1..=CELLS).contains(&value) {
                return Err(ParameterError::Cells { name, value });
            }
        }
        // As far as a 32-bit number of millimetres reaches.
        range("origin_x", self.origin_x.unwrap_or(0.0), -2e6, 2e6)?;
        range("origin_y", self.origin_y.unwrap_or(0.0), -2e6, 2e6)?;
        let (error, resolution) = (self.scan_error, self.resolution);
        if self.tolerance() > RangeSensor::MAX_TOLERANCE {
            return Err(ParameterError::ScanError { error, resolution });
        }
        if self.clearance() > MAX_CLEARANCE {
            let radius = self.robot_radius;
            return Err(ParameterError::Radius { radius, resolution });
        }
        Ok(())
    }

    /// Whether the node has to see for itself: where no other's map shows the place, and what
    /// is ahead of its wheels.
    pub(crate) fn needs_scans(&self) -> bool {
        self.costmap_topic.is_empty() || self.drive != Drive::Nav2
    }

    fn tolerance(&self) -> f32 {
        (self.scan_error / self.resolution) as f32
    }

    /// Cells that the body reaches beyond its own.
    fn clearance(&self) -> u8 {
        let beyond = self.robot_radius / self.resolution - 0.5;
        // Less than a thousandth of a cell is rounding.
        (beyond - 1e-3).ceil().clamp(0.0, 255.0) as u8
    }

    /// The corner of least x and y, in metres.
    pub(crate) fn origin(&self) -> (f64, f64) {
        let half = |cells: u16| -f64::from(cells) * self.resolution / 2.0;
        (
            self.origin_x.unwrap_or(half(self.width)),
            self.origin_y.unwrap_or(half(self.height)),
        )
    }

    pub(crate) fn extent(&self) -> Extent {
        Extent::new(self.width, self.height)
    }

    /// What the planner is told.
    pub(crate) fn config(&self) -> Config {
        let (x, y) = self.origin();
        let north = y + f64::from(self.height) * self.resolution;
        Config {
            clearance: self.clearance(),
            come_home: self.return_to_init,
            sensor: SensorModel::lidar(),
            link: LinkConfig {
                origin_mm: ((x * 1000.0).round() as i32, (north * 1000.0).round() as i32),
                cell_mm: (self.resolution * 1000.0).round() as u16,
                ..LinkConfig::new()
            },
            ..Config::new()
        }
    }

    /// The sensor, for scans that reach this far in metres.
    pub(crate) fn sensor(&self, reach: f64) -> RangeSensor {
        let range = if self.max_range > 0.0 {
            self.max_range
        } else {
            reach
        };
        RangeSensor {
            max_range: (range / self.resolution) as f32,
            tolerance: self.tolerance(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Parameters, ParameterError> {
        Parameters::read(serde_yaml_ng::from_str(text).unwrap()).map(|(read, _)| read)
    }

    #[test]
    fn what_explore_lite_is_given_is_taken() {
        let text = "{robot_base_frame: base_link, costmap_topic: map, visualize: true, \
                    planner_frequency: 0.15, progress_timeout: 30.0, potential_scale: 3.0, \
                    orientation_scale: 0.0, gain_scale: 1.0, transform_tolerance: 0.3, \
                    min_frontier_size: 0.75, return_to_init: true, use_sim_time: true, \
                    costmap_updates_topic: map_updates}";
        let (read, notes) = Parameters::read(serde_yaml_ng::from_str(text).unwrap()).unwrap();
        assert!(read.return_to_init && read.config().come_home);
        assert_eq!(read.costmap_topic, "map");
        assert_eq!(notes.len(), IDLE.len() + 1, "{notes:?}");
        assert_eq!(read.planner_frequency, LEAST_FREQUENCY);
    }

    #[test]
    fn a_parameter_that_is_none_is_named_with_those_that_are() {
        let error = read("{planer_frequency: 1}").unwrap_err().to_string();
        assert!(error.contains("planer_frequency"), "{error}");
        assert!(error.contains("`planner_frequency`"), "{error}");
        let error = read("{max_speed: fast}").unwrap_err().to_string();
        assert!(error.contains("max_speed"), "{error}");
    }

    #[test]
    fn what_cannot_be_is_refused_with_a_reason() {
        for (text, says) in [
            ("{planner_frequency: 0}", "planner_frequency is 0"),
            ("{max_speed: .nan}", "max_speed is NaN"),
            (
                "{resolution: 0.0005, scan_error: 0.0001}",
                "whole millimetres",
            ),
            ("{width: 129}", "at most 128 cells"),
            ("{height: 0}", "height is 0"),
            ("{scan_error: 0.06}", "resolution of 0.24 m"),
            ("{robot_radius: 0.8}", "larger resolution"),
            ("{origin_x: 1.0e+9}", "origin_x"),
            ("{drive: feet}", "feet"),
        ] {
            let error = read(text).unwrap_err().to_string();
            assert!(error.contains(says), "{text}: {error}");
        }
    }

    #[test]
    fn the_map_lies_around_the_origin_and_begins_in_the_north() {
        let read = read("{resolution: 0.25, width: 64, height: 32}").unwrap();
        assert_eq!(read.origin(), (-8.0, -4.0));
        assert_eq!(read.config().link.origin_mm, (-8000, 4000));
        assert_eq!(read.config().link.cell_mm, 250);
    }

    #[test]
    fn the_clearance_is_the_least_that_holds_the_body() {
        for (radius, clearance) in [(0.1, 0), (0.101, 1), (0.3, 1), (0.31, 2), (0.7, 3)] {
            let read = read(&format!("{{robot_radius: {radius}}}")).unwrap();
            assert_eq!(read.config().clearance, clearance, "{radius}");
        }
    }
}
