use super::*;
use ros_messages::std_msgs::{Header, Time};

const SIDE: f64 = 0.25;
/// Two rooms, a letter a cell; robots at 1 and 2.
const PLAN: [&str; 9] = [
    "####################",
    "#........##........#",
    "#........##........#",
    "#..................#",
    "#..1............2..#",
    "#..................#",
    "#........##........#",
    "#........##........#",
    "####################",
];

fn is_wall(x: f64, y: f64) -> bool {
    let row = PLAN.len() as f64 - 1.0 - (y / SIDE).floor();
    let row = PLAN.get(row as usize).filter(|_| row >= 0.0);
    let letter = row.and_then(|row| row.as_bytes().get((x / SIDE).floor() as usize));
    letter.is_none_or(|it| *it == b'#')
}

fn start_of(robot: char) -> Pose {
    let (row, column) = PLAN
        .iter()
        .zip((0..PLAN.len()).rev())
        .find_map(|(line, row)| Some((row, line.find(robot)?)))
        .unwrap();
    Pose {
        x: (column as f64 + 0.5) * SIDE,
        y: (row as f64 + 0.5) * SIDE,
        yaw: 0.3,
    }
}

/// What a scanner of 180 beams sees of the walls.
fn scan_from(pose: Pose, time: u64) -> LaserScan {
    let beams = (0..180).map(|beam| {
        let angle = pose.yaw + f64::from(beam) * std::f64::consts::PI / 90.0;
        let steps = (0..1200).map(|step| 0.005 * f64::from(step));
        let mut hit = steps.skip(1);
        let hit =
            hit.find(|range| is_wall(pose.x + range * angle.cos(), pose.y + range * angle.sin()));
        hit.map_or(f32::INFINITY, |range| range as f32)
    });
    LaserScan {
        header: Header {
            stamp: Time::from_nanoseconds(time),
            ..Header::default()
        },
        angle_increment: std::f32::consts::PI / 90.0,
        range_max: 6.0,
        ranges: beams.collect(),
        ..LaserScan::default()
    }
}

fn parameters() -> Parameters {
    Parameters {
        pose_source: PoseSource::Odom,
        resolution: SIDE,
        origin_x: Some(0.0),
        origin_y: Some(0.0),
        width: PLAN[0].len() as u16,
        height: PLAN.len() as u16,
        robot_radius: 0.12,
        max_speed: 1.0,
        max_turn: 3.0,
        ..Parameters::default()
    }
}

/// A robot in the two rooms, whose wheels do as they are told.
struct Body {
    robot: Robot,
    pose: Pose,
    now: f64,
}

impl Body {
    fn new(parameters: Parameters, number: u8) -> Self {
        Self {
            robot: Robot::new(parameters, RobotId(number)),
            pose: start_of(char::from(b'0' + number)),
            now: 0.0,
        }
    }

    fn sense(&mut self) {
        let time = 1 + (self.now * 1e9) as u64;
        self.robot.track.add(time, self.pose);
        let scan = scan_from(self.pose, time);
        self.robot.scan(scan, Pose::default(), self.now);
    }

    /// A tenth of a second.
    fn pass(&mut self) -> Order {
        self.sense();
        self.robot.tick(self.now);
        let order = self.robot.order(self.now);
        if let Order::Go { velocity, .. } | Order::Face { velocity, .. } = order {
            self.pose = self.pose.then(Pose {
                x: 0.1 * velocity.ahead,
                y: 0.0,
                yaw: 0.1 * velocity.turn,
            });
            assert!(!is_wall(self.pose.x, self.pose.y), "it drove into a wall");
        }
        self.now += 0.1;
        order
    }

    fn says(&self) -> String {
        self.robot.activity(self.now, &Frames::default())
    }
}

fn free_cells() -> usize {
    let letters = PLAN.iter().flat_map(|row| row.bytes());
    letters.filter(|letter| *letter != b'#').count()
}

#[test]
fn two_robots_explore_two_rooms_and_share_them() {
    let mut bodies = [1, 2].map(|number| Body::new(parameters(), number));
    let mut ticks = 0;
    while bodies.iter().any(|it| !it.robot.has_stopped()) {
        for at in 0..2 {
            bodies[at].pass();
            while let Some(frame) = bodies[at].robot.transmit() {
                bodies[1 - at].robot.receive(&frame);
                bodies[at].robot.receive(&frame);
            }
        }
        ticks += 1;
        assert!(
            ticks < 2000,
            "{} and {}",
            bodies[0].says(),
            bodies[1].says()
        );
    }
    for body in &mut bodies {
        assert!(body.says().starts_with("complete"), "{}", body.says());
        let map = body.robot.map();
        let grid = views::occupancy(map, Header::default(), &body.robot.parameters);
        let free = grid.data.iter().filter(|it| **it == 0).count();
        assert_eq!(free, free_cells());
        assert_eq!(body.robot.take_complaint(), None);
        assert_eq!(body.pass(), Order::Stay);
    }
}

#[test]
fn it_says_what_it_waits_for() {
    let mut body = Body::new(parameters(), 1);
    body.robot.tick(0.0);
    assert!(
        body.says().contains("no odometry on odom"),
        "{}",
        body.says()
    );
    body.robot.track.add(1, body.pose);
    body.robot.tick(0.1);
    assert!(body.says().contains("waiting for scan"), "{}", body.says());
    assert_eq!(body.robot.order(0.1), Order::Stay);
}

#[test]
fn a_robot_off_the_map_is_told_what_to_change_and_begins_when_it_is_on_it() {
    let mut body = Body::new(parameters(), 1);
    let start = body.pose;
    body.pose.x = -50.0;
    body.robot.track.add(1, body.pose);
    body.robot.tick(0.0);
    let complaint = body.robot.take_complaint().unwrap();
    assert!(
        complaint.contains("(-50.00, 1.12)") && complaint.contains("origin_x"),
        "{complaint}"
    );
    body.pose = start;
    for _ in 0..3 {
        body.pass();
    }
    assert_eq!(body.says(), "exploring");
}

#[test]
fn without_scans_it_stands_still() {
    let mut body = Body::new(parameters(), 1);
    for _ in 0..20 {
        body.pass();
    }
    assert!(matches!(body.robot.order(body.now), Order::Go { .. }));
    let later = body.now + body.robot.parameters.sensor_timeout + 0.1;
    assert_eq!(body.robot.order(later), Order::Stay);
}

#[test]
fn a_paused_robot_stands_until_it_is_to_go_on() {
    let mut body = Body::new(parameters(), 1);
    for _ in 0..20 {
        body.pass();
    }
    body.robot.pause(true);
    assert_eq!(body.pass(), Order::Stay);
    assert_eq!(body.says(), "paused");
    body.robot.pause(false);
    let goes = (0..10).any(|_| matches!(body.pass(), Order::Go { .. }));
    assert!(goes, "{}", body.says());
}

#[test]
fn wheels_that_do_not_turn_are_a_way_that_is_blocked() {
    let mut body = Body::new(parameters(), 1);
    let mut complaints = 0;
    for _ in 0..300 {
        let pose = body.pose;
        body.pass();
        body.pose = pose;
        complaints += usize::from(body.robot.take_complaint().is_some());
    }
    assert!(complaints >= 2, "{complaints}");
}

#[test]
fn robots_of_different_grids_say_so_once() {
    let mut other = parameters();
    other.origin_x = Some(0.5);
    let (mut one, mut two) = (Body::new(parameters(), 1), Body::new(other, 2));
    let mut complaints = Vec::new();
    for _ in 0..5 {
        one.pass();
        two.pass();
        while let Some(frame) = two.robot.transmit() {
            one.robot.receive(&frame);
        }
        complaints.extend(one.robot.take_complaint());
    }
    assert_eq!(complaints.len(), 1, "{complaints:?}");
    assert!(complaints[0].contains("grid"), "{complaints:?}");
}

#[test]
fn frontiers_that_are_too_small_are_left() {
    let mut small = parameters();
    // More than any frontier of these rooms has.
    small.min_frontier_size = 100.0;
    let mut body = Body::new(small, 1);
    for _ in 0..60 {
        body.pass();
    }
    assert!(
        body.says().ends_with("smaller than min_frontier_size"),
        "{}",
        body.says()
    );
    assert_eq!(body.robot.order(body.now), Order::Stay);
}

#[test]
fn a_costmap_serves_as_sight() {
    let mut from_map = parameters();
    from_map.costmap_topic = "map".to_owned();
    let mut robot = Robot::new(from_map.clone(), RobotId(1));
    robot.track.add(1, start_of('1'));
    robot.tick(0.0);
    assert_eq!(
        robot.activity(0.0, &Frames::default()),
        "waiting for a map on map"
    );
    let mut map = views::occupancy(robot.map(), Header::default(), &from_map);
    let rows = PLAN.iter().rev().flat_map(|row| row.bytes());
    map.data = rows
        .map(|letter| if letter == b'#' { 100 } else { 0 })
        .collect();
    robot.costmap(map);
    for tick in 0..5 {
        robot.tick(0.1 * f64::from(tick));
    }
    // Its wheels are the node's: they wait for a scanner that shows what is ahead.
    assert_eq!(
        robot.activity(0.5, &Frames::default()),
        "waiting for scan: no scan came lately"
    );
    assert!(robot.map().is_free(Cell::new(3, 4)) && robot.map().is_obstacle(Cell::new(0, 0)));
}

#[test]
fn a_scanner_that_nothing_places_shows_nothing() {
    let mut robot = Robot::new(parameters(), RobotId(1));
    robot.track.add(1, start_of('1'));
    robot.tick(0.0);
    robot.lose_scanner("laser".to_owned());
    robot.tick(0.1);
    assert_eq!(robot.order(0.1), Order::Stay);
    let frames = Frames::default();
    assert_eq!(
        robot.activity(0.1, &frames),
        "waiting: no transform from laser to base_link yet; nothing came on /tf"
    );
}

#[test]
fn odometry_in_another_frame_and_a_place_off_the_map_are_told_once() {
    let mut robot = Robot::new(parameters(), RobotId(1));
    let mut message = Odometry::default();
    message.header.frame_id = "odom".to_owned();
    message.pose.pose.position.x = 5000.0;
    let mut told = Vec::new();
    for tick in 0..4 {
        robot.odometry(&message);
        told.extend(robot.take_complaint());
        robot.tick(f64::from(tick));
        told.extend(robot.take_complaint());
    }
    assert_eq!(told.len(), 2, "{told:?}");
    assert!(told[0].contains("set global_frame to odom"), "{told:?}");
    assert!(told[1].contains("set origin_x"), "{told:?}");
}
