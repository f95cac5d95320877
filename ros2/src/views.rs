//! What others see of the planner: its map, its way, its frontiers.

use planner_core::{Cell, Map};
use ros_messages::geometry::{Point, Pose as RosPose, PoseStamped, Quaternion, Vector3};
use ros_messages::nav::{MapMetaData, OccupancyGrid, Path};
use ros_messages::std_msgs::{ColorRGBA, Header};
use ros_messages::visualization::{Marker, MarkerArray};

use crate::parameters::{Parameters, TILES};

type Grid = Map<TILES, TILES>;

/// The map as ROS has it: 0 free, 100 blocked, -1 unknown, from the south on.
pub(crate) fn occupancy(map: &Grid, header: Header, parameters: &Parameters) -> OccupancyGrid {
    let (width, height) = (parameters.width, parameters.height);
    let (x, y) = parameters.origin();
    let rows = (0..height as i16).rev();
    let cells = rows.flat_map(|y| (0..width as i16).map(move |x| Cell::new(x, y)));
    let value = |cell: Cell| match () {
        () if map.is_obstacle(cell) => 100,
        () if map.is_free(cell) => 0,
        () => -1,
    };
    OccupancyGrid {
        info: MapMetaData {
            map_load_time: header.stamp,
            resolution: parameters.resolution as f32,
            width: width.into(),
            height: height.into(),
            origin: pose_at((x, y), 0.0),
        },
        header,
        data: cells.map(value).collect(),
    }
}

/// Frontiers that hang together, each a list of cells, the larger ones first.
pub(crate) fn frontiers(map: &Grid, parameters: &Parameters) -> Vec<Vec<Cell>> {
    let (width, height) = (parameters.width as i16, parameters.height as i16);
    let mut is_left = vec![false; usize::from(parameters.width) * usize::from(parameters.height)];
    let place = |cell: Cell| cell.y as usize * width as usize + cell.x as usize;
    let cells = (0..height).flat_map(|y| (0..width).map(move |x| Cell::new(x, y)));
    let cells: Vec<Cell> = cells.filter(|cell| map.is_frontier(*cell)).collect();
    for cell in &cells {
        is_left[place(*cell)] = true;
    }
    let mut found = Vec::new();
    for first in cells {
        if !std::mem::take(&mut is_left[place(first)]) {
            continue;
        }
        let mut frontier = vec![first];
        let mut next = 0;
        while let Some(&Cell { x, y }) = frontier.get(next) {
            next += 1;
            let around = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| Cell::new(x + dx, y + dy)));
            for cell in around.filter(|cell| parameters.extent().contains(*cell)) {
                if std::mem::take(&mut is_left[place(cell)]) {
                    frontier.push(cell);
                }
            }
        }
        found.push(frontier);
    }
    found.sort_by_key(|frontier| std::cmp::Reverse(frontier.len()));
    found
}

/// Whether a frontier is as large as [`Parameters::min_frontier_size`] asks for.
pub(crate) fn is_large(frontier: &[Cell], parameters: &Parameters) -> bool {
    frontier.len() as f64 * parameters.resolution >= parameters.min_frontier_size
}

/// Frontiers as boxes, those that are large enough.
pub(crate) fn markers(map: &Grid, header: &Header, parameters: &Parameters) -> MarkerArray {
    let marker = |id, action| Marker {
        header: header.clone(),
        ns: "frontiers".to_owned(),
        id,
        action,
        pose: pose_at((0.0, 0.0), 0.0),
        ..Marker::default()
    };
    let frontiers = frontiers(map, parameters);
    let large = frontiers.iter().filter(|it| is_large(it, parameters));
    let boxes = large.zip(0..).map(|(frontier, id)| {
        let side = parameters.resolution;
        let points = frontier.iter().map(|&cell| {
            let (x, y) = middle(cell, parameters);
            Point { x, y, z: 0.0 }
        });
        Marker {
            r#type: Marker::CUBE_LIST,
            scale: Vector3 {
                x: side,
                y: side,
                z: side / 10.0,
            },
            color: ColorRGBA {
                r: 0.1,
                g: 0.5,
                b: 1.0,
                a: 0.9,
            },
            points: points.collect(),
            ..marker(id, Marker::ADD)
        }
    });
    let markers = std::iter::once(marker(0, Marker::DELETE_ALL));
    MarkerArray {
        markers: markers.chain(boxes).collect(),
    }
}

/// A way over cells, each pose towards the next.
pub(crate) fn path(
    way: impl Iterator<Item = Cell>,
    header: Header,
    parameters: &Parameters,
) -> Path {
    let places: Vec<(f64, f64)> = way.map(|cell| middle(cell, parameters)).collect();
    let mut yaw = 0.0;
    let poses = places.iter().enumerate().map(|(at, &(x, y))| {
        if let Some(next) = places.get(at + 1) {
            yaw = (next.1 - y).atan2(next.0 - x);
        }
        stamped((x, y), yaw, header.clone())
    });
    Path {
        poses: poses.collect(),
        header,
    }
}

/// A place and direction with a header.
pub(crate) fn stamped(place: (f64, f64), yaw: f64, header: Header) -> PoseStamped {
    PoseStamped {
        header,
        pose: pose_at(place, yaw),
    }
}

fn pose_at((x, y): (f64, f64), yaw: f64) -> RosPose {
    RosPose {
        position: Point { x, y, z: 0.0 },
        orientation: Quaternion::from_yaw(yaw),
    }
}

/// The middle of a cell in metres.
pub(crate) fn middle(cell: Cell, parameters: &Parameters) -> (f64, f64) {
    let link = parameters.config().link;
    let (x, y) = cell.middle_in_metres(link.origin_mm, link.cell_mm);
    (x.into(), y.into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use planner_core::sight::Sighting;

    /// A room of 5 × 3 cells whose middle is known, with one wall.
    fn room() -> (Grid, Parameters) {
        let parameters = Parameters {
            width: 5,
            height: 3,
            resolution: 0.5,
            ..Parameters::default()
        };
        let mut map = Grid::new(parameters.extent()).unwrap();
        let mut look = Sighting::new(Cell::new(1, 1));
        look.see_free(Cell::new(1, 1));
        look.see_free(Cell::new(2, 1));
        look.see_free(Cell::new(4, 0));
        look.see_blocked(Cell::new(0, 0));
        look.see_blocked(Cell::new(1, 0));
        map.observe(&look);
        (map, parameters)
    }

    #[test]
    fn the_first_row_is_the_south() {
        let (map, parameters) = room();
        let grid = occupancy(&map, Header::default(), &parameters);
        #[rustfmt::skip]
        assert_eq!(grid.data, [
            -1, -1, -1, -1, -1,
            -1, 0, 0, -1, -1,
            100, 100, -1, -1, 0,
        ]);
        assert_eq!((grid.info.width, grid.info.height), (5, 3));
        assert_eq!(grid.info.origin.position.x, -1.25);
        assert_eq!(grid.info.origin.position.y, -0.75);
    }

    #[test]
    fn small_frontiers_are_left_out() {
        let (map, mut parameters) = room();
        let sizes = |parameters: &Parameters| {
            let markers = markers(&map, &Header::default(), parameters).markers;
            assert_eq!(markers[0].action, Marker::DELETE_ALL);
            markers[1..]
                .iter()
                .map(|it| it.points.len())
                .collect::<Vec<_>>()
        };
        assert_eq!(sizes(&parameters), [2, 1]);
        parameters.min_frontier_size = 0.75;
        assert_eq!(sizes(&parameters), [2]);
    }

    #[test]
    fn a_way_leads_through_the_middles_of_its_cells() {
        let (_, parameters) = room();
        let way = [Cell::new(1, 1), Cell::new(1, 0)].into_iter();
        let path = path(way, Header::default(), &parameters);
        let place = |at: usize| &path.poses[at].pose.position;
        assert_eq!((place(0).x, place(0).y), (-0.5, 0.0));
        assert_eq!((place(1).x, place(1).y), (-0.5, 0.5));
        let north = path.poses[0].pose.orientation.yaw();
        assert!((north - std::f64::consts::FRAC_PI_2).abs() < 1e-9);
    }
}
