"""Robots that explore together: one node each, in namespaces /robot1, /robot2 …

    ros2 launch ros2/launch/explore.launch.py robots:=3 params:=ros2/launch/explore.yaml

`node` is the program that `cargo build --release` leaves in ros2/target/release.
"""

from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, OpaqueFunction
from launch.substitutions import LaunchConfiguration

HERE = Path(__file__).resolve().parent


def nodes(context):
    def value(name):
        return LaunchConfiguration(name).perform(context)

    for robot in range(1, int(value("robots")) + 1):
        yield ExecuteProcess(
            cmd=[value("node"), "--ros-args", "-r", f"__ns:=/robot{robot}"]
            + ["-p", f"robot_id:={robot}", "--params-file", value("params")],
            output="screen",
        )


def generate_launch_description():
    program = str(HERE.parent / "target/release/explore")
    return LaunchDescription(
        [
            DeclareLaunchArgument("robots", default_value="1"),
            DeclareLaunchArgument("params", default_value=str(HERE / "explore.yaml")),
            DeclareLaunchArgument("node", default_value=program),
            OpaqueFunction(function=lambda context: list(nodes(context))),
        ]
    )
