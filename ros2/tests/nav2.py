"""As much of Nav2 as the node speaks to: the server of the action `NavigateToPose`, with the
services as ROS 2 maps them on Cyclone DDS. It drives straight to its goal, stops for what is
ahead, and gives the goal up when that stays."""

import math
from dataclasses import dataclass, field

from cyclonedds.core import Policy, Qos
from cyclonedds.idl import IdlStruct
from cyclonedds.idl.types import array, int8, int32, sequence, uint8, uint16, uint32
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration

import messages as m

SERVICE = Qos(Policy.Reliability.Reliable(duration(seconds=1)), Policy.History.KeepLast(10))
NAV2 = "nav2_msgs::action::dds_::NavigateToPose"
SUCCEEDED, CANCELED, ABORTED = 4, 5, 6
# Metres from its middle at which something ahead stops it, and orders until it gives up.
CLOSE, PATIENCE = 0.45, 30
Guid = array[uint8, 8]
Uuid = array[uint8, 16]


@dataclass
class SendGoal(IdlStruct, typename=f"{NAV2}_SendGoal_Request_"):
    client: Guid
    high: int32
    low: uint32
    goal_id: Uuid
    pose: m.PoseStamped
    behavior_tree: str


@dataclass
class GoalSent(IdlStruct, typename=f"{NAV2}_SendGoal_Response_"):
    client: Guid
    high: int32
    low: uint32
    accepted: bool
    stamp: m.Time


@dataclass
class GetResult(IdlStruct, typename=f"{NAV2}_GetResult_Request_"):
    client: Guid
    high: int32
    low: uint32
    goal_id: Uuid


@dataclass
class Result(IdlStruct, typename=f"{NAV2}_GetResult_Response_"):
    client: Guid
    high: int32
    low: uint32
    status: int8
    error_code: uint16
    error_msg: str


@dataclass
class CancelGoal(IdlStruct, typename="action_msgs::srv::dds_::CancelGoal_Request_"):
    client: Guid
    high: int32
    low: uint32
    goal_id: Uuid
    stamp: m.Time


@dataclass
class GoalInfo(IdlStruct, typename="action_msgs::msg::dds_::GoalInfo_"):
    goal_id: Uuid
    stamp: m.Time


@dataclass
class GoalCanceled(IdlStruct, typename="action_msgs::srv::dds_::CancelGoal_Response_"):
    client: Guid
    high: int32
    low: uint32
    return_code: int8
    goals_canceling: sequence[GoalInfo] = field(default_factory=list)


class Service:
    """Requests in, replies out."""

    def __init__(self, participant, name, request, reply):
        topic = Topic(participant, f"rq{name}Request", request)
        self.requests = DataReader(participant, topic, qos=SERVICE)
        self.replies = DataWriter(participant, Topic(participant, f"rr{name}Reply", reply), qos=SERVICE)
        self.reply = reply

    def take(self):
        return m.take(self.requests)

    def answer(self, request, *values):
        self.replies.write(self.reply(request.client, request.high, request.low, *values))


class Navigator:
    """The server, and the controller behind it."""

    def __init__(self, participant, space):
        action = f"{space}/navigate_to_pose/_action"
        self.send = Service(participant, f"{action}/send_goal", SendGoal, GoalSent)
        self.cancel = Service(participant, f"{action}/cancel_goal", CancelGoal, GoalCanceled)
        self.result = Service(participant, f"{action}/get_result", GetResult, Result)
        self.goal = None
        self.to = None
        self.ended = {}
        self.asked = {}
        self.count = 0
        self.stopped = 0

    def end(self, status):
        if self.goal is not None:
            self.ended[self.goal] = status
        self.goal = self.to = None

    def order(self, pose, room):
        """The velocity that brings it nearer to the goal, with so much room ahead."""
        for request in self.send.take():
            # A new goal takes the place of the old one.
            self.end(ABORTED)
            self.goal, self.to = bytes(request.goal_id), request.pose.pose
            self.count, self.stopped = self.count + 1, 0
            self.send.answer(request, True, m.Time())
        for request in self.cancel.take():
            if bytes(request.goal_id) == self.goal:
                self.end(CANCELED)
            self.cancel.answer(request, 0)
        for request in self.result.take():
            self.asked[bytes(request.goal_id)] = request
        velocity = self.steer(*pose, room) if self.to else (0.0, 0.0)
        for goal in self.asked.keys() & self.ended.keys():
            self.result.answer(self.asked.pop(goal), self.ended.pop(goal), 0, "")
        return velocity

    def steer(self, x, y, yaw, room):
        there, turned = self.to.position, self.to.orientation
        dx, dy = there.x - x, there.y - y
        distance = math.hypot(dx, dy)
        wanted = math.atan2(dy, dx) if distance > 0.08 else 2 * math.atan2(turned.z, turned.w)
        off = (wanted - yaw + math.pi) % (2 * math.pi) - math.pi
        if distance <= 0.08 and abs(off) < 0.2:
            self.end(SUCCEEDED)
            return 0.0, 0.0
        ahead = min(0.8, distance) if abs(off) < 0.35 and distance > 0.08 else 0.0
        if ahead > 0.0 and room < CLOSE:
            ahead, self.stopped = 0.0, self.stopped + 1
            if self.stopped > PATIENCE:
                self.end(ABORTED)
        else:
            ahead = min(ahead, max(room - CLOSE, 0.1))
        return ahead, max(-1.5, min(1.5, 2 * off))
