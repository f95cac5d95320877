"""Opens a recording (MCAP) with the reader and the ROS 2 decoder that the field uses, and says
what is in it: `recording.py FILE [TOPIC=TYPE…]` fails where a topic is missing, has another
type, or has a map that knows nothing."""

import sys
from collections import defaultdict

from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory


def read(path):
    """The type and the messages of each topic; every message is decoded."""
    topics = defaultdict(lambda: ["", []])
    with open(path, "rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        if reader.get_summary() is None:
            raise SystemExit(f"{path} has no index")
        for schema, channel, _, message in reader.iter_decoded_messages():
            topics[channel.topic][0] = schema.name
            topics[channel.topic][1].append(message)
    return topics


def check(path, wanted):
    """Fails unless each wanted topic has messages of its type; returns how many there are."""
    topics = read(path)
    for topic, kind in wanted.items():
        has, messages = topics[topic]
        if has != kind:
            raise SystemExit(f"{path}: {topic} is {has or 'not there'}, not {kind}")
        if kind == "nav_msgs/msg/OccupancyGrid":
            last = messages[-1]
            size, known = last.info.width * last.info.height, sum(it >= 0 for it in last.data)
            if size != len(last.data) or known == 0:
                raise SystemExit(f"{path}: the last map on {topic} has {known} of {size} cells")
    return {topic: (kind, len(messages)) for topic, (kind, messages) in topics.items() if messages}


if __name__ == "__main__":
    counts = check(sys.argv[1], dict(word.split("=", 1) for word in sys.argv[2:]))
    for topic, (kind, count) in sorted(counts.items()):
        print(f"{count:>6}  {topic}  {kind}")
