"""The launch file starts a node for each robot, each in a namespace of its own. Without a ROS
installation: what it imports of `launch` is stood in for here."""

import runpy
import sys
import types
from pathlib import Path

LAUNCH = Path(__file__).resolve().parent.parent / "launch/explore.launch.py"


def stand_in(values):
    """Modules that take down what the launch file declares; `values` are the user's."""

    def record(kind):
        return lambda *args, **named: types.SimpleNamespace(kind=kind, args=args, **named)

    class LaunchConfiguration:
        def __init__(self, name):
            self.name = name

        def perform(self, context):
            return values.get(self.name, context[self.name])

    modules = {
        "launch": {"LaunchDescription": list},
        "launch.actions": {
            name: record(name)
            for name in ("DeclareLaunchArgument", "ExecuteProcess", "OpaqueFunction")
        },
        "launch.substitutions": {"LaunchConfiguration": LaunchConfiguration},
    }
    for name, members in modules.items():
        module = types.ModuleType(name)
        vars(module).update(members)
        sys.modules[name] = module


def commands(values):
    stand_in(values)
    actions = runpy.run_path(str(LAUNCH))["generate_launch_description"]()
    declared = {it.args[0]: it.default_value for it in actions if hasattr(it, "default_value")}
    (opaque,) = (it for it in actions if it.kind == "OpaqueFunction")
    unknown = set(values) - set(declared)
    assert not unknown, unknown
    return [it.cmd for it in opaque.function(declared)]


three = commands({"robots": "3", "node": "explore"})
assert len(three) == 3, three
for robot, command in enumerate(three, start=1):
    assert command[:4] == ["explore", "--ros-args", "-r", f"__ns:=/robot{robot}"], command
    assert f"robot_id:={robot}" in command, command
    parameters = Path(command[command.index("--params-file") + 1])
    assert parameters.is_file(), parameters
(one,) = commands({})
assert one[0].endswith("target/release/explore"), one
print("the launch file starts what it should")
