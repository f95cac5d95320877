//! Robots as processes that talk by UDP: one is killed on the way, strangers come, the
//! world goes away.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream, UdpSocket};
use std::process::{Child, ChildStdout, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use assert_cmd::cargo::cargo_bin;
use host_sim::live::{RobotReport, WorldReport};

const ROBOTS: u8 = 3;
/// No line of the world, and no end of a process, takes longer than this to come.
const PATIENCE: Duration = Duration::from_secs(60);

/// A process that does not outlive its test.
struct Process(Child);

impl Process {
    fn start(arguments: &[String]) -> Self {
        let mut command = Command::new(cargo_bin("host-sim"));
        command.args(arguments).stdout(Stdio::piped());
        command.stderr(Stdio::piped());
        Self(command.spawn().unwrap())
    }

    /// Waits for its end; its status, and what it has printed of what went wrong.
    fn end(mut self) -> (Option<i32>, String) {
        let began = Instant::now();
        let status = loop {
            match self.0.try_wait().unwrap() {
                Some(status) => break status,
                None if began.elapsed() > PATIENCE => panic!("a process does not end"),
                None => std::thread::sleep(Duration::from_millis(10)),
            }
        };
        let mut text = String::new();
        let mut stderr = self.0.stderr.take().unwrap();
        stderr.read_to_string(&mut text).unwrap();
        (status.code(), text)
    }

    fn stdout(&mut self) -> ChildStdout {
        self.0.stdout.take().unwrap()
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn words(line: &str) -> Vec<String> {
    line.split_whitespace().map(str::to_owned).collect()
}

/// The lines of a process as they come.
fn lines(from: ChildStdout) -> Receiver<String> {
    let (to, lines) = channel();
    std::thread::spawn(move || {
        for line in BufReader::new(from).lines().map_while(Result::ok) {
            let _ = to.send(line);
        }
    });
    lines
}

/// Addresses that are free now.
fn free_addresses() -> Vec<SocketAddr> {
    let sockets: Vec<_> = (0..ROBOTS)
        .map(|_| UdpSocket::bind("127.0.0.1:0").unwrap())
        .collect();
    sockets
        .iter()
        .map(|socket| socket.local_addr().unwrap())
        .collect()
}

fn robot(id: u8, world: &str, addresses: &[SocketAddr]) -> Process {
    let mut arguments = words(&format!("robot --id {id} --world {world}"));
    for (&address, other) in addresses.iter().zip(0..) {
        let option = if other == id { "--listen" } else { "--peer" };
        arguments.extend([option.to_owned(), address.to_string()]);
    }
    Process::start(&arguments)
}

fn report(mut robot: Process) -> RobotReport {
    let mut text = String::new();
    robot.stdout().read_to_string(&mut text).unwrap();
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

/// A served world of rooms for three robots.
struct Served {
    process: Process,
    lines: Receiver<String>,
    address: String,
}

impl Served {
    /// `pace` is in milliseconds.
    fn start(pace: u32) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let map = folder.path().join("rooms.txt");
        let world = host_sim::world::generate(host_sim::world::Family::Rooms, 40, 30, 5).unwrap();
        world.write(&map, 1).unwrap();
        let mut arguments = words("world --listen 127.0.0.1:0 --absence 20");
        let pace = format!("--pace={pace}");
        arguments.extend([
            pace,
            format!("--robots={ROBOTS}"),
            map.display().to_string(),
        ]);
        let mut process = Process::start(&arguments);
        let lines = lines(process.stdout());
        // The map is read before this is said.
        let first = lines
            .recv_timeout(PATIENCE)
            .expect("the world says nothing");
        let address = first.strip_prefix("listening on ").unwrap().to_owned();
        Self {
            process,
            lines,
            address,
        }
    }

    fn next(&self) -> String {
        let next = self.lines.recv_timeout(PATIENCE);
        next.expect("the world says nothing")
    }

    /// Waits for the first progress.
    fn progress(&self) {
        while !self.next().starts_with("tick ") {}
    }

    fn report(&self) -> WorldReport {
        loop {
            let line = self.next();
            if line.starts_with('{') {
                return serde_json::from_str(&line).unwrap();
            }
        }
    }

    fn stranger(&self) -> TcpStream {
        let stranger = TcpStream::connect(&self.address).unwrap();
        stranger.set_read_timeout(Some(PATIENCE)).unwrap();
        stranger
    }
}

/// What the world answers to a stranger.
fn answer(mut stranger: TcpStream, says: &str) -> String {
    stranger.write_all(says.as_bytes()).unwrap();
    let mut line = String::new();
    let _ = BufReader::new(stranger).read_line(&mut line);
    line
}

/// Runs three robots; kills and restarts robot 1 once after `kill_at` ticks.
fn explore(kill_at: Option<u32>) {
    let served = Served::start(2);
    let (address, next) = (served.address.clone(), || served.next());

    let addresses = free_addresses();
    let mut robots: Vec<_> = (0..ROBOTS)
        .map(|id| robot(id, &address, &addresses))
        .collect();
    let result = loop {
        let line = next();
        if line.starts_with('{') {
            break line;
        }
        if kill_at.is_some_and(|tick| line.starts_with(&format!("tick {tick}:"))) {
            drop(robots.remove(1));
            robots.insert(1, robot(1, &address, &addresses));
        }
    };
    let result: WorldReport = serde_json::from_str(&result).unwrap();
    assert!(result.is_complete(), "{result:?}");
    assert!(
        kill_at.is_none_or(|tick| tick < result.ticks),
        "killed too late"
    );
    for report in robots.into_iter().map(report) {
        assert!(
            report
                .stop
                .as_ref()
                .is_some_and(|stop| stop.starts_with("complete"))
        );
        assert_eq!(
            report.free_cells_known, result.reachable_cells,
            "{report:?}"
        );
        assert!(
            report.frames_heard > 0 && report.frames_refused == 0,
            "{report:?}"
        );
        assert!(report.bytes_sent <= 55 * result.ticks);
    }
}

#[test]
fn three_processes_explore_a_map() {
    explore(None);
}

#[test]
fn a_robot_that_is_killed_and_comes_back_empty_learns_everything_again() {
    explore(Some(60));
}

/// Whoever comes and whatever it says: the robots explore, and none of them is taken
/// over.
#[test]
fn strangers_neither_stop_a_world_nor_take_over_a_robot() {
    let served = Served::start(30);
    let silent: Vec<_> = (0..80).map(|_| served.stranger()).collect();
    let addresses = free_addresses();
    let robots: Vec<_> = (0..ROBOTS)
        .map(|id| robot(id, &served.address, &addresses))
        .collect();
    served.progress();
    // A byte now and then, and no end of a line.
    let mut drip = served.stranger();
    let drip = std::thread::spawn(move || {
        for _ in 0..50 {
            if drip.write_all(b"x").is_err() {
                return;
            }
            std::thread::sleep(Duration::from_millis(100));
        }
    });
    // Bytes without an end, until nobody listens any more.
    let mut flood = served.stranger();
    let flood =
        std::thread::spawn(move || (0..10_000).any(|_| flood.write_all(&[b'x'; 10_000]).is_err()));
    for (says, words) in [
        ("{\"hello\":{\"robot\":200}}\n", ["no robot 200", "0 to 2"]),
        ("\"wait\"\n", ["says first", "which one"]),
        ("\u{1b}[2J\n", ["u{1b}[2J", "no meaning here"]),
        (
            "{\"hello\":{\"robot\":0}}\n",
            ["robot 0 is there already", "--id"],
        ),
        (
            "{\"hello\":{\"robot\":1}}\n{\"stop\":{\"reason\":\"complete\"}}\n",
            ["robot 1 is there already", "--id"],
        ),
    ] {
        let answer = answer(served.stranger(), says);
        for word in words {
            assert!(answer.contains(word), "{word:?} is not in: {answer}");
        }
    }
    assert!(served.report().is_complete());
    for report in robots.into_iter().map(report) {
        assert!(report.stop.unwrap().starts_with("complete"));
    }
    assert!(flood.join().unwrap(), "a flood is listened to");
    drip.join().unwrap();
    drop(silent);
    assert_eq!(served.process.end().0, Some(0));
}

#[test]
fn a_second_robot_of_a_number_is_told_so() {
    let served = Served::start(30);
    let addresses = free_addresses();
    let robots: Vec<_> = (0..ROBOTS)
        .map(|id| robot(id, &served.address, &addresses))
        .collect();
    served.progress();
    let world = &served.address;
    let second = words(&format!(
        "robot --id 0 --world {world} --listen 127.0.0.1:0"
    ));
    let (status, message) = Process::start(&second).end();
    assert_eq!(status, Some(2));
    assert!(message.contains("robot 0 is there already"), "{message}");
    assert!(served.report().is_complete());
    for report in robots.into_iter().map(report) {
        assert!(report.stop.is_some());
    }
}

#[test]
fn a_robot_whose_world_goes_away_says_so() {
    let served = Served::start(20);
    let addresses = free_addresses();
    let robots: Vec<_> = (0..ROBOTS)
        .map(|id| robot(id, &served.address, &addresses))
        .collect();
    served.progress();
    let address = served.address.clone();
    drop(served);
    for robot in robots {
        let (status, message) = robot.end();
        assert_eq!(status, Some(2));
        for word in [&*address, "went away", "host-sim world"] {
            assert!(message.contains(word), "{word:?} is not in: {message}");
        }
    }
    let (status, message) = robot(0, &address, &addresses).end();
    assert_eq!(status, Some(2));
    for word in [&*address, "no world answers", "--world"] {
        assert!(message.contains(word), "{word:?} is not in: {message}");
    }
}

/// Something that is no world, or not one of this kind, leads to an error in words.
#[test]
fn a_robot_among_strange_worlds_says_what_is_strange() {
    let welcome = |width, height, x, y| {
        format!(
            "{{\"welcome\":{{\"width\":{width},\"height\":{height},\"robots\":1,\"at\":[{x},{y}]}}}}\n"
        )
    };
    let endless = "x".repeat(70_000);
    for (says, words) in [
        (
            "HTTP/1.1 400 Bad Request\n\n".into(),
            "`HTTP/1.1 400 Bad Request`",
        ),
        ("\u{1b}]0;owned\u{7}\n".into(), r"\u{1b}]0;owned\u{7}"),
        ("\"over\"\n".into(), "has no meaning here"),
        (String::new(), "went away"),
        (endless, "more than 65536 bytes"),
        (welcome(0, 0, 0, 0), "no planner takes"),
        (welcome(65535, 65535, 0, 0), "no planner takes"),
        (welcome(10, 10, -32768, 32767), "no planner takes"),
        (
            welcome(10, 10, 3, 3) + "{\"went\":true}\n",
            "has no meaning here",
        ),
        (
            "{\"refused\":{\"reason\":\"go away\"}}\n".into(),
            "does not take this robot: go away",
        ),
    ] {
        let world = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = world.local_addr().unwrap();
        let arguments = self::words(&format!(
            "robot --id 0 --world {address} --listen 127.0.0.1:0"
        ));
        let robot = Process::start(&arguments);
        let (mut line, _) = world.accept().unwrap();
        let mut hello = [0; 64];
        let _ = line.read(&mut hello).unwrap();
        let _ = line.write_all(says.as_bytes());
        // Until it has read that.
        let _ = line.shutdown(std::net::Shutdown::Write);
        let (status, message) = robot.end();
        assert_eq!(status, Some(2), "{message}");
        assert!(message.contains(words), "{words:?} is not in: {message}");
        assert!(message.chars().count() < 500, "{message}");
    }
}

/// Ticks are for robots that are there: a run without a pause between its ticks is not
/// over before anybody can come back.
#[test]
fn a_world_waits_for_robots_that_are_all_gone() {
    let served = Served::start(0);
    let addresses = free_addresses();
    let robots = || -> Vec<_> {
        (0..ROBOTS)
            .map(|id| robot(id, &served.address, &addresses))
            .collect()
    };
    let first = robots();
    served.progress();
    drop(first);
    std::thread::sleep(Duration::from_millis(500));
    let second = robots();
    assert!(served.report().is_complete());
    for robot in second {
        assert_eq!(robot.end().0, Some(0));
    }
}

/// Who says that it is a robot and then nothing, or half a line, does not keep its place.
#[test]
fn a_stranger_in_a_robots_place_is_replaced() {
    let served = Served::start(0);
    let mut stranger = served.stranger();
    stranger
        .write_all(b"{\"hello\":{\"robot\":1}}\n{\"wai")
        .unwrap();
    let mut welcome = String::new();
    let mut from_world = BufReader::new(stranger.try_clone().unwrap());
    from_world.read_line(&mut welcome).unwrap();
    assert!(welcome.contains("welcome"), "{welcome}");
    let addresses = free_addresses();
    let robots: Vec<_> = (0..ROBOTS)
        .map(|id| robot(id, &served.address, &addresses))
        .collect();
    assert!(served.report().is_complete());
    for robot in robots {
        assert_eq!(robot.end().0, Some(0));
    }
}
