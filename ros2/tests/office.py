"""Three robots of another simulator (ir-sim), over another vendor's DDS (Cyclone), explore an
office with the node. One is killed on the way; the other two have to end with "complete" and
with the office on their maps.

Run by `cargo xtask test --only ros`, in a network of its own.
"""

import argparse
import contextlib
import math
import os
import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import yaml
from cyclonedds.core import Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration

import messages as m
import recording
from nav2 import Navigator

# It says which windows it could not open; none is wanted.
with contextlib.redirect_stdout(None):
    import irsim

HERE = Path(__file__).parent
# Metres of a letter of the plan, and of a cell of the planner.
LETTER, CELL = 0.5, 0.25
# Metres of the map beyond the office.
MARGIN = 2.0
STEP = 0.1
RADIUS = 0.2
STARTS = [(2.25, 5.0, 0.0), (8.0, 4.75, 1.57), (14.0, 5.25, 3.14)]
KILLED = 2
KILLED_AFTER = 10.0
LIMIT = 240.0
# How far the scanner of some robots is turned.
LEFT = 0.5

RELIABLE = Qos(Policy.Reliability.Reliable(duration(seconds=1)), Policy.History.KeepLast(10))
SENSOR = Qos(Policy.Reliability.BestEffort, Policy.History.KeepLast(5))
FRAMES = Qos(Policy.Reliability.BestEffort, Policy.History.KeepLast(500))
LATCHED = Qos(
    Policy.Reliability.Reliable(duration(seconds=1)),
    Policy.Durability.TransientLocal,
    Policy.History.KeepLast(1),
)


def plan():
    """Whether there is a wall, by letters, from the south on."""
    rows = (HERE / "office.txt").read_text().split()[::-1]
    return np.array([[letter == "#" for letter in row] for row in rows])


def walls(of):
    """Rectangles that cover the walls: runs along x, then along y."""
    left = of.copy()
    for y, x in np.argwhere(of).tolist():
        if not left[y, x]:
            continue
        wide = tall = 1
        while x + wide < of.shape[1] and left[y, x + wide]:
            wide += 1
        while wide == 1 and y + tall < of.shape[0] and left[y + tall, x]:
            tall += 1
        left[y : y + tall, x : x + wide] = False
        yield (x + wide / 2) * LETTER, (y + tall / 2) * LETTER, wide * LETTER, tall * LETTER


def world():
    """The simulator's world as its file has it."""
    of = plan()
    robot = {
        "kinematics": {"name": "diff", "noise": True, "alpha": [0.03, 0, 0, 0.03, 0, 0]},
        "shape": {"name": "circle", "radius": RADIUS},
        "vel_max": [1.0, 2.0],
        "vel_min": [-1.0, -2.0],
        "behavior": None,
        "sensors": [
            {
                "name": "lidar2d",
                "range_min": 0.05,
                "range_max": 6.0,
                "angle_range": 2 * math.pi,
                "number": 181,
                "noise": True,
                "std": 0.015,
                "angle_std": 0.002,
            }
        ],
    }
    return {
        "world": {
            "width": of.shape[1] * LETTER,
            "height": of.shape[0] * LETTER,
            "step_time": STEP,
            "sample_time": STEP,
            "collision_mode": "stop",
        },
        "robot": [robot | {"state": list(start)} for start in STARTS],
        "obstacle": [
            {"shape": {"name": "rectangle", "length": w, "width": h}, "state": [x, y, 0]}
            for x, y, w, h in walls(of)
        ],
    }


def turned(yaw):
    return m.Quaternion(0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2))


RECORDED = {
    "/tf": "tf2_msgs/msg/TFMessage",
    "/tf_static": "tf2_msgs/msg/TFMessage",
    "/scan": "sensor_msgs/msg/LaserScan",
    "/cmd_vel": "geometry_msgs/msg/TwistStamped",
    "/explore/map": "nav_msgs/msg/OccupancyGrid",
    "/explore/goal": "geometry_msgs/msg/PoseStamped",
    "/explore/path": "nav_msgs/msg/Path",
    "/explore/frontiers": "visualization_msgs/msg/MarkerArray",
    "/explore/status": "std_msgs/msg/String",
}


class Odometry:
    """Poses as odometry, orders as twists."""

    parameters = {"pose_source": "odom", "tf_static_topic": "tf_static", "drive": "twist"}

    def __init__(self, robot):
        self.odom = robot.writer("odom", m.Odometry, RELIABLE)
        self.cmd_vel = robot.reader("cmd_vel", m.Twist, RELIABLE)
        self.mount(robot, "base_link", 0.0)

    def mount(self, robot, base, yaw):
        """Says where the scanner is on the robot."""
        self.static = robot.writer("tf_static", m.TFMessage, LATCHED)
        scanner = self.transform(base, "laser", (0.0, 0.0, yaw), m.Time())
        self.static.write(m.TFMessage([scanner]))

    @staticmethod
    def transform(parent, child, pose, stamp):
        x, y, yaw = pose
        place = m.Transform(m.Vector3(x, y, 0.0), turned(yaw))
        return m.TransformStamped(m.Header(stamp, parent), child, place)

    def tell(self, x, y, yaw, stamp):
        pose = m.PoseWithCovariance(m.Pose(m.Point(x, y, 0.0), turned(yaw)))
        self.odom.write(m.Odometry(m.Header(stamp, "map"), "base_link", pose))

    def see(self, angles, ranges):
        """The node sees by itself."""

    def orders(self):
        return [(it.linear.x, it.angular.z) for it in m.take(self.cmd_vel)]


class Nav2(Odometry):
    """Poses as odometry, goals to Nav2."""

    parameters = Odometry.parameters | {"drive": "nav2", "service_mapping": "cyclone"}

    def __init__(self, robot):
        super().__init__(robot)
        self.navigator = Navigator(robot.participant, robot.space)
        self.pose, self.room = None, math.inf

    def see(self, angles, ranges):
        angles, ranges = angles[np.isfinite(ranges)], ranges[np.isfinite(ranges)]
        x, y = ranges * np.cos(angles), ranges * np.sin(angles)
        ahead = x[(x > 0) & (np.abs(y) < RADIUS + 0.1)]
        self.room = ahead.min(initial=math.inf)

    def tell(self, x, y, yaw, stamp):
        super().tell(x, y, yaw, stamp)
        self.pose = x, y, yaw

    def orders(self):
        return [self.navigator.order(self.pose, self.room)] if self.pose else []


class Nav2WithMap(Nav2):
    """As explore_lite has it: also a map to see by, drawn of the scans."""

    parameters = Nav2.parameters | {"costmap_topic": "map"}
    # Metres of a cell of the map, and by how much walls are drawn behind what was hit.
    FINE, BEHIND = 0.125, 0.04

    def __init__(self, robot):
        super().__init__(robot)
        self.map = robot.writer("map", m.OccupancyGrid, LATCHED)
        rows, columns = (round(it * LETTER / self.FINE) for it in plan().shape)
        self.votes = np.zeros((rows, columns), dtype=int)
        self.scans = 0

    def see(self, angles, ranges):
        super().see(angles, ranges)
        x, y, yaw = self.pose
        angles = angles + yaw

        def vote(along, beams, votes):
            columns = ((x + along * np.cos(angles[beams])) / self.FINE).astype(int)
            rows = ((y + along * np.sin(angles[beams])) / self.FINE).astype(int)
            inside = (rows >= 0) & (columns >= 0)
            inside &= (rows < self.votes.shape[0]) & (columns < self.votes.shape[1])
            self.votes[rows[inside], columns[inside]] += votes

        for along in np.arange(0.0, 4.0, self.FINE / 2):
            vote(along, ranges > along + self.BEHIND, -1)
        hits = np.isfinite(ranges)
        vote(ranges[hits] + self.BEHIND, hits, 3)
        self.votes.clip(-20, 20, out=self.votes)
        self.scans += 1
        # Shown twice a second.
        if self.scans % 5 == 1:
            height, width = self.votes.shape
            drawn = np.where(self.votes == 0, -1, np.where(self.votes > 0, 100, 0))
            info = m.MapMetaData(m.Time(), self.FINE, width, height, m.Pose())
            header, cells = m.Header(m.Time(), "map"), drawn.ravel().tolist()
            self.map.write(m.OccupancyGrid(header, info, cells))


class Transforms(Odometry):
    """Poses as transforms, orders as stamped twists; the scanner looks to the left."""

    parameters = {
        "pose_source": "tf",
        "tf_topic": "tf",
        "tf_static_topic": "tf_static",
        "robot_base_frame": "base_footprint",
        "drive": "twist_stamped",
    }
    DRIFT = (0.5, -0.3, 0.7)

    def __init__(self, robot):
        self.tf = robot.writer("tf", m.TFMessage, RELIABLE)
        self.cmd_vel = robot.reader("cmd_vel", m.TwistStamped, RELIABLE)
        self.mount(robot, "base_footprint", LEFT)

    def tell(self, x, y, yaw, stamp):
        # What a map's maker corrects, and what the wheels say.
        dx, dy, turn = self.DRIFT
        cos, sin = math.cos(turn), math.sin(turn)
        x, y = x - dx, y - dy
        wheels = (cos * x + sin * y, cos * y - sin * x, yaw - turn)
        self.tf.write(
            m.TFMessage(
                [
                    self.transform("map", "odom", self.DRIFT, stamp),
                    self.transform("odom", "base_footprint", wheels, stamp),
                ]
            )
        )

    def orders(self):
        orders = [it.twist for it in m.take(self.cmd_vel)]
        return [(it.linear.x, it.angular.z) for it in orders]


BODIES = [Nav2, Transforms, Odometry]


class Robot:
    """One robot: its topics and its node."""

    def __init__(self, participant, program, number, folder):
        self.space = f"/robot{number + 1}"
        self.participant = participant
        self.scan = self.writer("scan", m.LaserScan, SENSOR)
        self.body = BODIES[number](self)
        self.turned = LEFT if BODIES[number] is Transforms else 0.0
        self.status = self.reader("explore/status", m.String, LATCHED)
        self.map = self.reader("explore/map", m.OccupancyGrid, LATCHED)
        self.log = folder / f"robot{number + 1}.log"
        self.recording = folder / f"robot{number + 1}.mcap"
        of = plan()
        parameters = {
            "resolution": CELL,
            "origin_x": -MARGIN,
            "origin_y": -MARGIN,
            "robot_radius": RADIUS + 0.05,
            "scan_error": 0.06,
            "max_speed": 0.8,
            "max_turn": 1.5,
            "progress_timeout": 5.0,
            "mcap": self.recording,
            "width": int((of.shape[1] * LETTER + 2 * MARGIN) / CELL),
            "height": int((of.shape[0] * LETTER + 2 * MARGIN) / CELL),
        }
        words = [str(program), "--ros-args", "-r", f"__ns:={self.space}"]
        for name, value in (parameters | self.body.parameters).items():
            words += ["-p", f"{name}:={value}"]
        with open(self.log, "w") as log:
            self.node = subprocess.Popen(words, stderr=log)
        self.began = time.monotonic()
        self.order = (0.0, 0.0)
        self.ordered = 0.0
        self.said = ""
        self.grid = None
        self.at = None
        self.way = 0.0

    def topic(self, name, kind):
        return Topic(self.participant, f"rt{self.space}/{name}", kind)

    def writer(self, name, kind, qos):
        return DataWriter(self.participant, self.topic(name, kind), qos=qos)

    def reader(self, name, kind, qos):
        return DataReader(self.participant, self.topic(name, kind), qos=qos)

    def is_alive(self):
        return self.node.poll() is None

    def tell(self, scan, state, now):
        """Publishes what its sensors say."""
        stamp = m.Time(int(now), int(now % 1 * 1e9))
        ranges = [float(r) if ok else math.inf for r, ok in zip(scan["ranges"], scan["valid"])]
        self.scan.write(
            m.LaserScan(
                m.Header(stamp, "laser"),
                scan["angle_min"] - self.turned,
                scan["angle_max"] - self.turned,
                scan["angle_increment"],
                0.0,
                STEP,
                scan["range_min"],
                scan["range_max"],
                ranges,
            )
        )
        x, y, yaw = (float(it) for it in state.flatten()[:3])
        self.way += math.dist(self.at, (x, y)) if self.at else 0.0
        self.at = x, y
        x, y, yaw = random.gauss(x, 0.005), random.gauss(y, 0.005), random.gauss(yaw, 0.003)
        self.body.tell(x, y, yaw, stamp)
        angles = np.linspace(scan["angle_min"], scan["angle_max"], len(ranges))
        self.body.see(angles, np.array(ranges))

    def ask(self, now):
        """What its node wants its wheels to do; nothing when it is silent."""
        for order in self.body.orders():
            self.order, self.ordered = order, now
        for status in m.take(self.status):
            self.said = status.data
        if now - self.ordered > 0.5:
            self.order = (0.0, 0.0)
        return np.c_[list(self.order)]

    def measure(self):
        """The share of a processor that its node has taken so far."""
        ticks = Path(f"/proc/{self.node.pid}/stat").read_text().rsplit(")", 1)[1].split()
        seconds = (int(ticks[11]) + int(ticks[12])) / os.sysconf("SC_CLK_TCK")
        return seconds / (time.monotonic() - self.began)

    def known(self):
        """Its map, by cells from the south on."""
        for grid in m.take(self.map):
            self.grid = np.array(grid.data).reshape(grid.info.height, grid.info.width)
        return self.grid

    def end(self):
        if self.is_alive():
            self.node.terminate()
        self.node.wait(timeout=10)


def sent():
    """Bytes that went over the loopback so far."""
    for line in Path("/proc/net/dev").read_text().splitlines():
        if line.strip().startswith("lo:"):
            return int(line.split(":")[1].split()[8])
    raise SystemExit("there is no loopback")


def judge(known):
    """The share of the office's free cells that a map has, and the cells that are wrong."""
    per = round(LETTER / CELL)
    truth = np.kron(plan(), np.ones((per, per))).astype(bool)
    margin = round(MARGIN / CELL)
    known = known[margin : margin + truth.shape[0], margin : margin + truth.shape[1]]
    share = np.sum((known == 0) & ~truth) / np.sum(~truth)
    return share, int(np.sum((known == 0) & truth)), int(np.sum((known == 100) & ~truth))


def draw(known, robots):
    """Shows a map: what is unknown, blocked and free, and where the robots are."""
    if known is None:
        return
    letters = np.where(known < 0, "?", np.where(known > 0, "#", "."))
    for number, robot in enumerate(robots):
        x, y = (int((it + MARGIN) / CELL) for it in robot.at)
        letters[y, x] = str(number + 1)
    print("\n".join("".join(row) for row in letters[::-1]))


def run(program, number, folder):
    """One exploration; returns what came of it, or fails with what is wrong."""
    random.seed(number)
    file = folder / "office.yaml"
    file.write_text(yaml.safe_dump(world()))
    env = irsim.make(str(file), display=False, disable_all_plot=True, log_level="ERROR", seed=number)
    participant = DomainParticipant(0)
    frames = DataReader(
        participant, Topic(participant, "rt/explore/frames", m.UInt8MultiArray), qos=FRAMES
    )
    robots = [Robot(participant, program, it, folder) for it in range(len(STARTS))]
    counted = payload = 0
    begin, bytes_before = time.monotonic(), sent()
    try:
        for step in range(int(LIMIT / STEP)):
            now = step * STEP
            for robot, body in zip(robots, env.robot_list):
                if robot.is_alive():
                    robot.tell(body.get_lidar_scan(), body.state, 1000.0 + now)
            for frame in m.take(frames):
                counted, payload = counted + 1, payload + len(frame.data)
            orders = [robot.ask(now) for robot in robots]
            env.step(orders)
            for robot, body in zip(robots, env.robot_list):
                if body.collision:
                    raise SystemExit(f"run {number}: {robot.space} drove into something")
            if now >= KILLED_AFTER and robots[KILLED].is_alive():
                robots[KILLED].node.kill()
                robots[KILLED].node.wait()
            left = [it for at, it in enumerate(robots) if at != KILLED]
            for robot in left:
                if not robot.is_alive():
                    raise SystemExit(f"the node of {robot.space} ended by itself")
            if step % 100 == 0:
                said = ", ".join(f"{it.space} {it.said or 'silent'}" for it in robots)
                print(f"  {now:5.1f} s: {said}", flush=True)
            is_done = all(it.said.startswith(("complete", "gave up")) for it in left)
            if is_done and now > KILLED_AFTER:
                break
            late = begin + (step + 1) * STEP - time.monotonic()
            time.sleep(max(late, 0.0))
        seconds = time.monotonic() - begin
        wire = (sent() - bytes_before) / seconds
        cpu = max(robot.measure() for robot in left)
        time.sleep(1.5)
        for robot in left:
            known = robot.known()
            share, opened, shut = judge(known) if known is not None else (0.0, 0, 0)
            print(
                f"  {robot.space}: {robot.said}; {robot.way:.0f} m; {share:.1%} known, {opened} "
                f"walls taken for free, {shut} free cells for walls",
                flush=True,
            )
            if not robot.said.startswith("complete") or share < 0.97 or robot.way < 3:
                raise SystemExit(f"run {number}: {robot.space} did not explore the office")
        if robots[0].body.navigator.count < 3 or m.take(robots[0].body.cmd_vel):
            raise SystemExit(f"run {number}: {robots[0].space} was not driven by Nav2")
        for robot in left:
            robot.end()
        wanted = {robots[1].space + topic: kind for topic, kind in RECORDED.items()}
        recorded = recording.check(robots[1].recording, wanted)
        print(
            f"run {number}: complete after {now:.0f} s; CPU of a node {cpu:.1%}; "
            f"{wire / 1000:.0f} kB/s on the wire, {counted / seconds:.0f} frames a second of "
            f"{payload / max(counted, 1):.0f} bytes; {sum(it for _, it in recorded.values())} "
            f"messages recorded",
            flush=True,
        )
    except SystemExit:
        for robot in robots:
            draw(robot.known(), robots)
            print(f"{robot.log.name}:\n" + "\n".join(robot.log.read_text().splitlines()[-15:]))
        raise
    finally:
        for robot in robots:
            robot.end()
        env.end(0)


def main():
    options = argparse.ArgumentParser()
    options.add_argument("program", type=Path)
    options.add_argument("--runs", type=int, default=1)
    options.add_argument("--first", type=int, default=1)
    options.add_argument("--map", action="store_true", help="the first robot sees by a map")
    options = options.parse_args()
    if options.map:
        BODIES[0] = Nav2WithMap
    with tempfile.TemporaryDirectory() as folder:
        for number in range(options.first, options.first + options.runs):
            run(options.program.resolve(), number, Path(folder))


if __name__ == "__main__":
    sys.exit(main())
