//! A run as a recording that the viewers of robotics open: maps, poses, goals and scans as
//! ROS 2 messages.

use std::f64::consts::TAU;
use std::io::{Seek, Write};

use planner_core::Cell;
use ros_messages::geometry::{
    Point, Pose, PoseStamped, Quaternion, Transform, TransformStamped, Vector3,
};
use ros_messages::nav::{MapMetaData, OccupancyGrid};
use ros_messages::sensor::LaserScan;
use ros_messages::std_msgs::{Header, Time};
use ros_messages::tf::TFMessage;
use ros_messages::{Recording, RecordingError};

use super::paint::Ground;
use super::replay::Replay;
use crate::dice::Dice;
use crate::record::grid::Trace;
use crate::robot::Deed;
use crate::scans::Laser;
use crate::world::cells;

/// A tick lasts for a tenth of a second.
const TICK: u64 = 100_000_000;
/// Ticks from one map to the next.
const MAP_TICKS: u32 = 10;

/// Records a run: on `/map` what all robots have seen, once a second; on `/tf` and
/// `/robotN/pose` where they are, on `/robotN/goal` where they are going, and on
/// `/robotN/scan` what a laser without errors would have measured from each cell that they
/// entered. A tick is a tenth of a second; metres count from the map's lower left corner, and
/// cells are 0.25 m wide if the map does not say it. Robots have the numbers of the trace.
///
/// # Errors
/// Those of `to`.
pub fn recording<W: Write + Seek>(trace: &Trace, to: W) -> Result<W, RecordingError> {
    let world = &trace.scenario.world;
    let laser = Laser::default();
    let cell = world.metres_per_cell().unwrap_or(laser.cell_size);
    let exact = Laser {
        shift: 0.0,
        range: f64::from(trace.scenario.range) * cell,
        range_error: 0.0,
        place_error: 0.0,
        heading_error: 0.0,
        ..laser
    };
    let mut recorder = Recorder {
        recording: Recording::new(to)?,
        laser: exact,
        dice: Dice::new(exact.seed),
        cell,
        trace,
    };
    let robots = trace.scenario.starts.len();
    let (mut headings, mut goals) = (vec![0.0; robots], vec![None; robots]);
    let mut replay = Replay::new(trace);
    let mut records = trace.records.iter().peekable();
    recorder.poses(0, &trace.scenario.starts, &headings)?;
    for (robot, &start) in trace.scenario.starts.iter().enumerate() {
        recorder.scan(0, robot, start, 0.0)?;
    }
    while replay.tick() {
        let tick = replay.ticks();
        while let Some(record) = records.next_if(|record| record.tick < tick) {
            let robot = usize::from(record.robot);
            if let Deed::Moved(to) = record.deed {
                // East, south, west, north; angles grow the other way round.
                headings[robot] = -TAU / 4.0 * f64::from(to as u8);
                recorder.scan(tick, robot, record.after(), headings[robot])?;
            }
            if let Some(goal) = record.goal.filter(|_| record.goal != goals[robot]) {
                recorder.goal(tick, robot, goal)?;
                goals[robot] = Some(goal);
            }
        }
        recorder.poses(tick, replay.positions(), &headings)?;
        if tick % MAP_TICKS == 1 {
            recorder.map(tick, &replay)?;
        }
    }
    recorder.map(replay.ticks(), &replay)?;
    recorder.recording.finish()
}

struct Recorder<'a, W: Write + Seek> {
    recording: Recording<W>,
    laser: Laser,
    dice: Dice,
    /// Metres.
    cell: f64,
    trace: &'a Trace,
}

impl<W: Write + Seek> Recorder<'_, W> {
    fn header(tick: u32, frame_id: &str) -> Header {
        Header {
            stamp: Time::from_nanoseconds(u64::from(tick) * TICK),
            frame_id: frame_id.to_owned(),
        }
    }

    /// The middle of a cell in metres.
    fn middle(&self, cell: Cell) -> (f64, f64) {
        let height = f64::from(self.trace.scenario.world.extent().height);
        (
            (f64::from(cell.x) + 0.5) * self.cell,
            (height - f64::from(cell.y) - 0.5) * self.cell,
        )
    }

    fn pose(&self, tick: u32, cell: Cell, heading: f64) -> PoseStamped {
        let (x, y) = self.middle(cell);
        PoseStamped {
            header: Self::header(tick, "map"),
            pose: Pose {
                position: Point { x, y, z: 0.0 },
                orientation: Quaternion::from_yaw(heading),
            },
        }
    }

    fn poses(
        &mut self,
        tick: u32,
        positions: &[Cell],
        headings: &[f64],
    ) -> Result<(), RecordingError> {
        let time = u64::from(tick) * TICK;
        let mut transforms = Vec::new();
        for (robot, (&cell, &heading)) in positions.iter().zip(headings).enumerate() {
            let pose = self.pose(tick, cell, heading);
            let Point { x, y, z } = pose.pose.position;
            transforms.push(TransformStamped {
                header: pose.header.clone(),
                child_frame_id: format!("robot{robot}"),
                transform: Transform {
                    translation: Vector3 { x, y, z },
                    rotation: Quaternion::from_yaw(heading),
                },
            });
            let topic = format!("/robot{robot}/pose");
            self.recording.add(&topic, time, &pose)?;
        }
        self.recording.add("/tf", time, &TFMessage { transforms })
    }

    fn goal(&mut self, tick: u32, robot: usize, goal: Cell) -> Result<(), RecordingError> {
        let goal = self.pose(tick, goal, 0.0);
        let topic = format!("/robot{robot}/goal");
        self.recording.add(&topic, u64::from(tick) * TICK, &goal)
    }

    fn scan(
        &mut self,
        tick: u32,
        robot: usize,
        at: Cell,
        heading: f64,
    ) -> Result<(), RecordingError> {
        let world = &self.trace.scenario.world;
        let look = self.laser.look(world, at, heading, &mut self.dice);
        let range = self.laser.range as f32;
        let ranges = look.readings.iter().map(|reading| match reading.range {
            hit if hit < range => hit,
            _ => f32::INFINITY,
        });
        let step = TAU / f64::from(self.laser.beams);
        let scan = LaserScan {
            header: Self::header(tick, &format!("robot{robot}")),
            angle_max: (TAU - step) as f32,
            angle_increment: step as f32,
            range_max: range,
            ranges: ranges.collect(),
            ..LaserScan::default()
        };
        let topic = format!("/robot{robot}/scan");
        self.recording.add(&topic, u64::from(tick) * TICK, &scan)
    }

    fn map(&mut self, tick: u32, replay: &Replay<'_>) -> Result<(), RecordingError> {
        let map = occupancy(replay, Self::header(tick, "map"), self.cell);
        self.recording.add("/map", u64::from(tick) * TICK, &map)
    }
}

/// What all robots have seen, in cells of so many metres.
fn occupancy(replay: &Replay<'_>, header: Header, cell: f64) -> OccupancyGrid {
    let extent = replay.extent();
    let height = extent.height as i16;
    // Rows of a map begin in the south.
    let data =
        cells(extent).map(
            |Cell { x, y }| match replay.ground(Cell::new(x, height - 1 - y)) {
                Ground::Free | Ground::OpenDoor | Ground::Person => 0,
                Ground::Obstacle | Ground::ShutDoor => 100,
                Ground::Unseen | Ground::Unknown | Ground::Mistaken => -1,
            },
        );
    OccupancyGrid {
        info: MapMetaData {
            map_load_time: header.stamp,
            resolution: cell as f32,
            width: extent.width.into(),
            height: extent.height.into(),
            origin: Pose {
                orientation: Quaternion::from_yaw(0.0),
                ..Pose::default()
            },
        },
        header,
        data: data.collect(),
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;
    use std::sync::Arc;

    use planner_core::Extent;

    use super::*;
    use crate::planners::PlannerKind;
    use crate::run::{self, Options};
    use crate::scenario::grid::Scenario;
    use crate::world::World;

    /// A room of 4 × 3 cells with a pillar in its upper right corner; the last column is
    /// walled off.
    fn trace() -> Trace {
        let is_wall = |Cell { x, y }| x == 4 || (x, y) == (3, 0);
        let world = World::from_fn("room", Extent::new(6, 3), is_wall).unwrap();
        let starts = vec![Cell::new(0, 2), Cell::new(1, 2)];
        let scenario = Scenario::new(Arc::new(world), starts, PlannerKind::Explorer);
        let options = Options {
            trace: true,
            ..Options::default()
        };
        run::run(&scenario, options).unwrap().1.unwrap()
    }

    #[test]
    fn the_first_row_of_a_map_is_the_lowest_and_what_nobody_saw_is_unknown() {
        let trace = trace();
        let mut replay = Replay::new(&trace);
        while replay.tick() {}
        let map = occupancy(&replay, Header::default(), 0.5);
        #[rustfmt::skip]
        assert_eq!(map.data, [
            0, 0, 0, 0, 100, -1,
            0, 0, 0, 0, 100, -1,
            0, 0, 0, 100, -1, -1,
        ]);
        assert_eq!(map.info.resolution, 0.5);
    }

    #[test]
    fn a_run_gives_one_recording() {
        let trace = trace();
        let bytes = |trace| {
            recording(trace, Cursor::new(Vec::new()))
                .unwrap()
                .into_inner()
        };
        let recorded = bytes(&trace);
        assert!(recorded.starts_with(b"\x89MCAP0\r\n"));
        assert_eq!(recorded, bytes(&trace));
    }
}
