"""Logs of other programs: by protobuf as by JSON, and how lavender's own differ."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from mcap.writer import Writer

from lavendersim.errors import TraceError
from lavendersim.trace import descriptors, motion_log
from lavendersim.trace.motion_log import is_own, read_motion_log

ONE = {
    "/tf": {
        "transforms": [
            {
                "child_frame_id": "ball",
                "translation": {"x": 1.5, "y": -2.0, "z": 0.1},
                "rotation": {"x": 0.0, "y": 0.6, "z": 0.0, "w": 0.8},
            }
        ]
    },
    "/velocities": {"bodies": [{"body": "ball", "velocity": {"z": -3.0}}]},
}
DESCRIBED = {"/tf": descriptors.transforms_schema, "/velocities": descriptors.velocities_schema}


def protobuf_of(topic: str, plain: dict[str, object]) -> bytes:
    """Return a message by the descriptor set that a log carries."""
    from google.protobuf import descriptor_pool, message_factory
    from google.protobuf.descriptor_pb2 import FileDescriptorSet
    from google.protobuf.json_format import ParseDict

    pool = descriptor_pool.DescriptorPool()
    for file in FileDescriptorSet.FromString(DESCRIBED[topic]()).file:
        pool.Add(file)
    kind = message_factory.GetMessageClass(pool.FindMessageTypeByName(motion_log.SCHEMAS[topic]))
    data: bytes = ParseDict(plain, kind()).SerializeToString()
    return data


def write(path: Path, encoding: str, own: bool = False) -> Path:
    with path.open("wb") as stream:
        writer = Writer(stream)
        writer.start()
        writer.add_attachment(0, 0, "config.yaml", "application/yaml", b"scene: {}\n")
        if own:
            writer.add_metadata("trace", {"format": "1"})
        for topic, plain in ONE.items():
            data = DESCRIBED[topic]() if encoding == "protobuf" else b"{}"
            name = motion_log.SCHEMAS[topic]
            schema = writer.register_schema(name, encoding, data)
            channel = writer.register_channel(topic, encoding, schema)
            message = json.dumps(plain).encode()
            if encoding == "protobuf":
                message = protobuf_of(topic, plain)
            for time in (20, 10):  # in any order
                writer.add_message(channel, time, message, time)
        writer.finish()
    return path


@pytest.mark.parametrize("encoding", ["json", "protobuf"])
def test_both_encodings_say_the_same(tmp_path: Path, encoding: str) -> None:
    """What is absent is 0, as in protobuf, and what is first in time comes first."""
    log = read_motion_log(write(tmp_path / "log.mcap", encoding))
    assert log.times.tolist() == [10, 20]
    assert log.bodies == ("ball",)
    assert np.array_equal(log.pose[0], [[1.5, -2.0, 0.1, 0.8, 0.0, 0.6, 0.0]])
    assert np.array_equal(log.velocity[1], [[0.0, 0.0, -3.0, 0.0, 0.0, 0.0]])
    assert (log.config, log.resolved) == ("scene: {}\n", False)


def test_other_encodings_are_refused(tmp_path: Path) -> None:
    with pytest.raises(TraceError, match="expected messages by json or protobuf, found cdr"):
        read_motion_log(write(tmp_path / "log.mcap", "cdr"))


def test_own_logs_are_known_by_their_metadata(tmp_path: Path) -> None:
    assert is_own(write(tmp_path / "own.mcap", "json", own=True))
    assert not is_own(write(tmp_path / "other.mcap", "json"))
