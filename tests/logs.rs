//! What the explorer logs, caught by a logger as a host's: each change once, with its level,
//! and nothing above trace in every tick.

use std::sync::Mutex;

use log::{Level, LevelFilter, Log, Metadata, Record};
use planner_core::explorer::{Config, Explorer};
use planner_core::radio::MAX_LEN;
use planner_core::sight::look;
use planner_core::{Action, Cell, Extent, Motion, Planner, RobotId, Stop};

/// Keeps every line; one test only, for there is one logger a process.
struct Caught(Mutex<Vec<(Level, String)>>);

static CAUGHT: Caught = Caught(Mutex::new(Vec::new()));

impl Log for Caught {
    fn enabled(&self, _: &Metadata<'_>) -> bool {
        true
    }

    fn log(&self, record: &Record<'_>) {
        let line = (record.level(), record.args().to_string());
        self.0.lock().unwrap().push(line);
    }

    fn flush(&self) {}
}

impl Caught {
    /// The lines since the last call.
    fn take(&self) -> Vec<(Level, String)> {
        std::mem::take(&mut self.0.lock().unwrap())
    }

    /// Those above trace, each as one line.
    fn told(&self) -> Vec<String> {
        let lines = self.take().into_iter();
        let told = lines.filter(|(level, _)| *level < Level::Trace);
        told.map(|(level, line)| format!("{level} {line}"))
            .collect()
    }
}

const EXTENT: Extent = Extent::new(12, 8);
const HALL: &[&str] = &[
    "############",
    "#....#.....#",
    "#....#.....#",
    "#..........#",
    "#....#.....#",
    "#....#.....#",
    "#....#.....#",
    "############",
];

type Robot = Explorer<2, 1>;

fn is_blocked(cell: Cell) -> bool {
    let row = usize::try_from(cell.y).ok().and_then(|y| HALL.get(y));
    let place = row.and_then(|row| row.as_bytes().get(usize::try_from(cell.x).ok()?));
    place != Some(&b'.')
}

fn robot(id: u8, start: Cell) -> Robot {
    let mut config = Config::new();
    config.memory = 5;
    Robot::new(config, RobotId(id), EXTENT, start).unwrap()
}

fn see(robot: &mut Robot, at: Cell) {
    robot.observe(&look(at, 4, is_blocked));
}

/// The next frame of a robot that has its turn.
fn frame(robot: &mut Robot) -> Vec<u8> {
    let mut buffer = [0; MAX_LEN];
    let length = robot.transmit(&mut buffer).expect("a frame is due");
    buffer[..length].to_vec()
}

/// Explores until it stops; returns the ticks and the reason.
fn explore(robot: &mut Robot) -> (usize, Stop) {
    for ticks in 1..1000 {
        let at = robot.status().position;
        see(robot, at);
        match robot.tick() {
            Action::Move(_) => robot.report(Motion::Moved),
            Action::Wait => {}
            Action::Stop(stop) => return (ticks, stop),
        }
    }
    panic!("it does not stop");
}

#[test]
fn a_run_tells_each_change_once() {
    log::set_logger(&CAUGHT).unwrap();
    log::set_max_level(LevelFilter::Trace);

    let mut robot = self::robot(1, Cell::new(2, 2));
    let mut other = self::robot(2, Cell::new(9, 2));
    let mut twin = self::robot(1, Cell::new(9, 5));
    assert_eq!(
        CAUGHT.told(),
        [
            "INFO robot 1: starts at 2,2 of 12×8 cells",
            "INFO robot 2: starts at 9,2 of 12×8 cells",
            "INFO robot 1: starts at 9,5 of 12×8 cells",
        ]
    );

    // Nothing is seen yet; the wait is told when it begins.
    for _ in 0..3 {
        assert_eq!(robot.tick(), Action::Wait);
    }
    assert_eq!(CAUGHT.told(), ["DEBUG robot 1: waits at 2,2: Sight"]);

    // The first frame of a robot names it; the second does not.
    see(&mut other, Cell::new(9, 2));
    for _ in 0..2 {
        other.tick();
        robot.receive(&frame(&mut other)).unwrap();
    }
    assert_eq!(CAUGHT.told(), ["DEBUG robot 1: hears robot 2 at 9,2"],);

    // Frames that are refused: damaged; of a twin, which is worth a look once; and its own.
    let mut damaged = frame(&mut robot);
    *damaged.last_mut().unwrap() ^= 1;
    robot.receive(&damaged).unwrap_err();
    let refused = "DEBUG robot 1: refuses a frame: the frame's check bytes do not match";
    assert_eq!(CAUGHT.told(), [refused]);
    see(&mut twin, Cell::new(9, 5));
    for _ in 0..2 {
        twin.tick();
        robot.receive(&frame(&mut twin)).unwrap_err();
    }
    let why = "another robot has the id 1 too: give each robot of the fleet its own id";
    assert_eq!(
        CAUGHT.told(),
        [
            format!("WARN robot 1: {why}"),
            format!("DEBUG robot 1: refuses a frame: {why}"),
        ]
    );
    robot.tick();
    let own = frame(&mut robot);
    robot.receive(&own).unwrap_err();
    let echo = (
        Level::Trace,
        "robot 1: the frame is the robot's own".to_owned(),
    );
    assert!(CAUGHT.take().contains(&echo));

    // Somebody tells otherwise than it sees.
    see(&mut robot, Cell::new(2, 2));
    let mut liar = self::robot(3, Cell::new(3, 3));
    liar.observe(&look(Cell::new(3, 3), 4, |cell| cell != Cell::new(3, 3)));
    liar.tick();
    CAUGHT.take();
    robot.receive(&frame(&mut liar)).unwrap();
    let told = CAUGHT.told();
    let expected = "WARN robot 1: robot 3 tells otherwise than it sees";
    assert!(told.iter().any(|line| line == expected), "{told:#?}");

    // A pose off the grid, and back.
    for _ in 0..2 {
        see(&mut robot, Cell::new(40, 2));
        robot.tick();
    }
    assert_eq!(
        CAUGHT.told(),
        [
            "WARN robot 1: no use for the pose 40,2",
            "DEBUG robot 1: waits at 2,2: Pose",
        ]
    );

    // Alone from now on, it forgets the others, takes the lies back, and stops.
    let (ticks, stop) = explore(&mut robot);
    assert_eq!(stop, Stop::Complete);
    let told = CAUGHT.told();
    let end = format!("INFO robot 1: stops at {}: {stop}", robot.status().position);
    assert_eq!(told.last(), Some(&end));
    let count = |part: &str| told.iter().filter(|line| line.contains(part)).count();
    assert_eq!(count("hears robot 2 no more"), 1, "{told:#?}");
    assert!(count(" walls free, ") > 0, "{told:#?}");
    assert!(told.len() < ticks / 2, "{ticks} ticks: {told:#?}");

    // It has stopped: that is said once.
    robot.tick();
    assert!(CAUGHT.take().is_empty());
}
