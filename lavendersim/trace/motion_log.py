"""Poses and velocities of a log that another program wrote: the least that a step is judged by.

    /tf          foxglove.FrameTransforms   pose of every body in the world, by `child_frame_id`
    /velocities  lavender.Velocities        of its centre of mass, and its spin in world axes
Both by JSON or protobuf, one message of each for a state, with the same `log_time`: the simulation
time [ns]. Chunks, compression, indices and other channels are as their writer likes. Bodies are
named as in the config, an attachment `resolved.json` or `config.yaml`; what is fixed may be absent.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np
from google.protobuf import descriptor_pool, message_factory
from google.protobuf.descriptor_pb2 import FileDescriptorSet
from google.protobuf.json_format import MessageToDict
from mcap.reader import McapReader, make_reader
from mcap.records import Schema
from numpy.typing import NDArray

from lavendersim.errors import TraceError
from lavendersim.trace.index import damage
from lavendersim.trace.layout import POSE, VELOCITY
from lavendersim.trace.writer import AS_WRITTEN, DESCRIPTION, RESOLVED

SCHEMAS: Final = {"/tf": "foxglove.FrameTransforms", "/velocities": "lavender.Velocities"}
State = Mapping[str, list[float]]  # body: its numbers
Decode = Callable[[bytes], dict[str, Any]]


class MotionLog(NamedTuple):
    """States of a log, in the order of their times; a body that has no number somewhere: NaN."""

    times: NDArray[np.int64]  # (rows,) [ns]
    bodies: tuple[str, ...]  # every one that is named
    pose: NDArray[np.float64]  # (rows, bodies, 7) x y z [m], quaternion w x y z
    velocity: NDArray[np.float64]  # (rows, bodies, 6) [m/s], [rad/s]
    config: str  # text of an attachment
    resolved: bool  # whether it is `resolved.json`, else `config.yaml`


def is_own(path: Path) -> bool:
    """Whether a log is one of lavender's, which `open_trace` reads with all its checks."""
    with _reading(path) as reader:
        return any(one.name == DESCRIPTION for one in reader.iter_metadata())


def read_motion_log(path: Path) -> MotionLog:
    """Return what a log of another program has. TraceError where that is not enough, or damaged."""
    with _reading(path) as reader:
        attached = {one.name: one.data for one in reader.iter_attachments()}
        found: dict[str, dict[int, State]] = {topic: {} for topic in SCHEMAS}
        decoders: dict[int, Decode] = {}
        for schema, channel, message in reader.iter_messages(topics=list(SCHEMAS)):
            if channel.id not in decoders:
                decoders[channel.id] = _decoder(
                    path, channel.topic, schema, channel.message_encoding
                )
            rows = _ROWS[channel.topic](decoders[channel.id](message.data))
            found[channel.topic][message.log_time] = dict(rows)
    name = next((one for one in (RESOLVED, AS_WRITTEN) if one in attached), None)
    if name is None:
        raise TraceError(
            f"{path}: a log is judged by its scene: expected an attachment {RESOLVED} or "
            f"{AS_WRITTEN}, found {', '.join(attached) or 'none'}"
        )
    poses, velocities = found["/tf"], found["/velocities"]
    for topic, schema_name in SCHEMAS.items():
        if not found[topic]:
            raise TraceError(f"{path}: this log has no message of {topic} ({schema_name})")
    times = sorted(poses.keys() & velocities.keys())
    if not times:
        raise TraceError(f"{path}: no message of /tf has the log_time of one of /velocities")
    bodies = tuple(dict.fromkeys(name for time in times for name in poses[time]))
    return MotionLog(
        np.array(times, np.int64),
        bodies,
        _table([poses[time] for time in times], bodies, POSE),
        _table([velocities[time] for time in times], bodies, VELOCITY),
        attached[name].decode(),
        name == RESOLVED,
    )


def _table(states: list[State], bodies: tuple[str, ...], width: int) -> NDArray[np.float64]:
    nothing = [np.nan] * width
    rows = [[state.get(name, nothing) for name in bodies] for state in states]
    return np.array(rows, np.float64).reshape(len(states), len(bodies), width)


@contextmanager
def _reading(path: Path) -> Iterator[McapReader]:
    """Open a file; its damage is reported as that of lavender's own logs."""
    if not path.is_file():
        raise TraceError(f"{path}: no such log")
    with damage(path, "the log"), path.open("rb") as stream:
        yield make_reader(stream, validate_crcs=True)


def _decoder(path: Path, topic: str, schema: Schema | None, encoding: str) -> Decode:
    """Return what makes plain data of the messages of a channel."""
    named = schema.name if schema else "none"
    if named != SCHEMAS[topic]:
        raise TraceError(f"{path}: {topic}: expected the schema {SCHEMAS[topic]}, found {named}")
    if encoding == "json":
        return _from_json
    if encoding != "protobuf" or schema is None:
        raise TraceError(
            f"{path}: {topic}: expected messages by json or protobuf, found {encoding}"
        )
    files = FileDescriptorSet.FromString(schema.data)
    pool = descriptor_pool.DescriptorPool()
    for file in files.file:
        pool.Add(file)
    message = message_factory.GetMessageClass(pool.FindMessageTypeByName(named))

    def decode(data: bytes) -> dict[str, Any]:
        plain: dict[str, Any] = MessageToDict(
            message.FromString(data),
            preserving_proto_field_name=True,
            descriptor_pool=pool,
        )
        return plain

    return decode


def _from_json(data: bytes) -> dict[str, Any]:
    plain = json.loads(data)
    if not isinstance(plain, dict):
        raise ValueError("a message is no object")
    return plain


def _poses(message: dict[str, Any]) -> Iterator[tuple[str, list[float]]]:
    for one in message["transforms"]:
        place = [float(one["translation"].get(axis, 0.0)) for axis in "xyz"]
        turn = [float(one["rotation"].get(axis, 0.0)) for axis in "wxyz"]
        yield str(one["child_frame_id"]), [*place, *turn]


def _velocities(message: dict[str, Any]) -> Iterator[tuple[str, list[float]]]:
    for one in message["bodies"]:
        parts = (one.get(name, {}) for name in ("velocity", "angular_velocity"))
        yield str(one["body"]), [float(part.get(axis, 0.0)) for part in parts for axis in "xyz"]


_ROWS: Final = {"/tf": _poses, "/velocities": _velocities}
