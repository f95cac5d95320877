//! What the robot sees: scans, or a map that somebody else draws.

use planner_core::Cell;
use planner_core::sight::{Beam, Bearing, MAX_RADIUS, Pose as GridPose, RangeScan, Sighting};
use ros_messages::nav::OccupancyGrid;
use ros_messages::sensor::LaserScan;

use crate::geometry::Pose;
use crate::parameters::Parameters;

/// From this value on a cell of a costmap is one that the robot's centre cannot be in, or a
/// wall.
const BLOCKED: i8 = 65;

/// The pose in cells.
pub(crate) fn on_grid(pose: Pose, parameters: &Parameters) -> GridPose {
    let link = parameters.config().link;
    let (x, y, yaw) = (pose.x as f32, pose.y as f32, pose.yaw as f32);
    GridPose::from_metres(x, y, yaw, link.origin_mm, link.cell_mm)
}

/// Bearings of a scanner, made when it first speaks: a look then takes no sine.
#[derive(Debug, Default)]
pub(crate) struct Bearings {
    angles: (f32, f32),
    bearings: Vec<Bearing>,
}

impl Bearings {
    fn of(&mut self, scan: &LaserScan) -> &[Bearing] {
        let angles = (scan.angle_min, scan.angle_increment);
        if angles != self.angles || self.bearings.len() != scan.ranges.len() {
            self.angles = angles;
            let angle = |beam: usize| angles.0 + beam as f32 * angles.1;
            let beams = 0..scan.ranges.len();
            // The grid's angles grow to the right.
            self.bearings = beams
                .map(|beam| Bearing::from_radians(-angle(beam)))
                .collect();
        }
        &self.bearings
    }

    /// What a scan shows that was taken from `pose`, the scanner's.
    ///
    /// # Errors
    /// The pose or the scan is unusable; the text says which.
    pub(crate) fn look(
        &mut self,
        scan: &LaserScan,
        pose: Pose,
        parameters: &Parameters,
    ) -> Result<Sighting, String> {
        let reach = f64::from(scan.range_max);
        let side = parameters.resolution as f32;
        let (least, most) = (scan.range_min, scan.range_max);
        let beams = self.of(scan).iter().zip(&scan.ranges);
        let beams = beams.map(|(&bearing, &range)| {
            let is_measured = range == f32::INFINITY || (least..=most).contains(&range);
            let range = if is_measured { range / side } else { f32::NAN };
            Beam { bearing, range }
        });
        let scan = RangeScan {
            pose: on_grid(pose, parameters),
            sensor: parameters.sensor(reach),
            beams,
        };
        scan.sighting().map_err(|error| error.to_string())
    }
}

/// The least range, in metres, that a scan shows in the strip ahead that the body would
/// sweep; infinite if none. `offset` is the scanner's pose on the robot.
pub(crate) fn room_ahead(scan: &LaserScan, offset: Pose, radius: f64) -> f64 {
    let mut room = f64::INFINITY;
    for (beam, &range) in scan.ranges.iter().enumerate() {
        if !(scan.range_min..=scan.range_max).contains(&range) {
            continue;
        }
        let angle = f64::from(scan.angle_min) + beam as f64 * f64::from(scan.angle_increment);
        let there = offset.then(Pose {
            x: f64::from(range) * angle.cos(),
            y: f64::from(range) * angle.sin(),
            yaw: 0.0,
        });
        if there.x > 0.0 && there.y.abs() < radius {
            room = room.min(there.x);
        }
    }
    room
}

/// What a map shows around the robot: a cell is blocked where any part of it is, and free
/// where all of it is. `None`: the map is none, or lies turned.
pub(crate) fn read_map(
    map: &OccupancyGrid,
    pose: Pose,
    parameters: &Parameters,
) -> Option<Sighting> {
    let grid = on_grid(pose, parameters);
    let centre = Cell::new(grid.x.floor() as i16, grid.y.floor() as i16);
    let (width, height) = (map.info.width as usize, map.info.height as usize);
    let cell = f64::from(map.info.resolution);
    let corner = Pose::from(&map.info.origin);
    let is_map = cell > 0.0 && width.checked_mul(height) == Some(map.data.len());
    if !is_map || corner.yaw.abs() > 1e-3 || !pose.is_finite() {
        return None;
    }
    let mut sighting = Sighting::new(centre);
    let link = parameters.config().link;
    let half = parameters.resolution / 2.0;
    let reach = MAX_RADIUS as i16;
    for y in centre.y.saturating_sub(reach)..=centre.y.saturating_add(reach) {
        for x in centre.x.saturating_sub(reach)..=centre.x.saturating_add(reach) {
            let (east, north) = Cell::new(x, y).middle_in_metres(link.origin_mm, link.cell_mm);
            // The cells of the other map whose middles lie in this one; at least one.
            let along = |middle: f32, from: f64, count: usize| {
                let middle = f64::from(middle) - from;
                let first = ((middle - half) / cell + 0.5 - 1e-6).floor();
                let last = ((middle + half) / cell - 0.5 + 1e-6).floor();
                let only = (middle / cell).floor();
                let (first, last) = if last < first {
                    (only, only)
                } else {
                    (first, last)
                };
                (first >= 0.0 && last < count as f64).then_some(first as usize..=last as usize)
            };
            let columns = along(east, corner.x, width);
            let rows = along(north, corner.y, height);
            let (Some(columns), Some(rows)) = (columns, rows) else {
                continue;
            };
            let values = rows.flat_map(|row| columns.clone().map(move |it| row * width + it));
            let mut values = values.map(|at| map.data[at]);
            let (mut is_free, mut is_blocked) = (true, false);
            for value in &mut values {
                is_blocked |= value >= BLOCKED;
                is_free &= (0..BLOCKED).contains(&value);
            }
            if is_blocked {
                sighting.see_blocked(Cell::new(x, y));
            } else if is_free {
                sighting.see_free(Cell::new(x, y));
            }
        }
    }
    Some(sighting)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ros_messages::geometry::{Point, Pose as RosPose};
    use ros_messages::nav::MapMetaData;
    use std::f32::consts::{FRAC_PI_2, PI};

    fn parameters() -> Parameters {
        Parameters {
            resolution: 0.5,
            ..Parameters::default()
        }
    }

    fn cell_at(x: f64, y: f64) -> Cell {
        let grid = on_grid(Pose { x, y, yaw: 0.0 }, &parameters());
        Cell::new(grid.x.floor() as i16, grid.y.floor() as i16)
    }

    /// Ahead, left, behind and right.
    fn scan(ranges: [f32; 4]) -> LaserScan {
        LaserScan {
            angle_min: 0.0,
            angle_increment: FRAC_PI_2,
            angle_max: 1.5 * PI,
            range_min: 0.1,
            range_max: 4.0,
            ranges: ranges.to_vec(),
            ..LaserScan::default()
        }
    }

    #[test]
    fn left_is_left_and_what_is_no_measurement_says_nothing() {
        let facing_west = Pose {
            x: 0.25,
            y: 0.25,
            yaw: f64::from(PI),
        };
        let scan = scan([1.5, 2.0, f32::INFINITY, 0.05]);
        let look = Bearings::default().look(&scan, facing_west, &parameters());
        let look = look.unwrap();
        assert!(look.is_blocked(cell_at(-1.25, 0.25)), "ahead is west");
        assert!(look.is_blocked(cell_at(0.25, -1.75)), "left is south");
        assert!(look.is_free(cell_at(0.25, -1.25)));
        assert!(look.is_free(cell_at(3.25, 0.25)), "nothing within reach");
        let north = cell_at(0.25, 0.75);
        assert!(!look.is_free(north) && !look.is_blocked(north));
    }

    #[test]
    fn only_what_is_ahead_stops_the_robot() {
        let room = |offset| room_ahead(&scan([1.5, 0.3, 0.2, 0.3]), offset, 0.2);
        assert!((room(Pose::default()) - 1.5).abs() < 1e-6);
        let behind = Pose {
            yaw: f64::from(PI),
            ..Pose::default()
        };
        assert!((room(behind) - 0.2).abs() < 1e-6);
    }

    #[test]
    fn a_map_of_finer_cells_is_read_where_all_of_a_cell_is_known() {
        // 5 × 5 cells of 0.5 m around the origin, drawn in cells of 0.25 m.
        let mut map = OccupancyGrid {
            info: MapMetaData {
                resolution: 0.25,
                width: 10,
                height: 10,
                origin: RosPose {
                    position: Point {
                        x: -1.5,
                        y: -1.0,
                        z: 0.0,
                    },
                    ..RosPose::default()
                },
                ..MapMetaData::default()
            },
            data: vec![0; 100],
            ..OccupancyGrid::default()
        };
        // A wall at the north-eastern corner; the row of the south is unknown in part.
        map.data[99] = 100;
        map.data[0] = -1;
        let pose = Pose {
            x: 0.1,
            y: 0.1,
            yaw: 1.0,
        };
        let look = read_map(&map, pose, &parameters()).unwrap();
        assert_eq!(look.centre(), cell_at(0.1, 0.1));
        assert!(look.is_blocked(cell_at(0.75, 1.25)));
        assert!(!look.is_free(cell_at(-1.25, -0.75)) && !look.is_blocked(cell_at(-1.25, -0.75)));
        assert_eq!(look.free_cells().count(), 23);
        map.data.pop();
        assert_eq!(read_map(&map, pose, &parameters()), None);
    }
}
