"""What logs of the same bodies, topics and columns have in common, encoded once.

Of a sweep the logs differ in numbers alone: their schemas, channels and layouts are the same, and
often the look of the scene is.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from mcap.records import Channel, Schema

from lavendersim.trace import descriptors, layout
from lavendersim.trace.contact_columns import ColumnForm, column_form, rules_of
from lavendersim.trace.container import Closed, Messages, Registered, closed
from lavendersim.trace.encode import Encoder, Streams, encoders
from lavendersim.trace.schema import (
    CONTACT_COLUMNS,
    MULTI_ARRAY_DEFINITION,
    STRING_DEFINITION,
    VELOCITY_MEANINGS,
    Column,
)
from lavendersim.trace.streams import Light
from lavendersim.trace.wire import INDEX_ENTRY, Template

RULES = "derived"  # of the metadata of /contact_columns: column -> rule, as JSON


class Form(NamedTuple):
    """What logs of the same bodies, topics and columns have in common."""

    columns: tuple[np.dtype[Any], ...]  # of the tables step, contact and residual
    encoders: Streams[Encoder]
    streams: Streams[Registered]  # schemas and channels


@lru_cache(maxsize=64)
def form_of(
    bodies: tuple[str, ...], columns: tuple[np.dtype[Any], ...], topics: frozenset[str]
) -> Form:
    """Return the form of logs with these bodies, columns of step, contact, residual, and topics."""
    encoded = encoders(bodies, columns, topics)
    light = encoded.light
    assert isinstance(light, Light)
    poses = points = numbers = Registered.of((), ())
    if "/tf" in topics:
        form = descriptors.transforms_schema()
        schema = Schema(2, form, "protobuf", "foxglove.FrameTransforms")
        schemas, channels = [schema], [_channel("/tf", 2, "protobuf")]
        if "/velocities" in topics:
            form = descriptors.velocities_schema()
            schemas.append(Schema(8, form, "protobuf", "lavender.Velocities"))
            channels.append(_channel("/velocities", 8, "protobuf", VELOCITY_MEANINGS))
        poses = Registered.of(schemas, channels)
    if "/contacts" in topics:
        form = descriptors.point_cloud_schema()
        schema = Schema(3, form, "protobuf", "foxglove.PointCloud")
        points = Registered.of([schema], [_channel("/contacts", 3, "protobuf")])
        form = descriptors.contact_columns_schema()
        schema = Schema(7, form, "protobuf", "lavender.ContactColumns")
        channel = _channel("/contact_columns", 7, "protobuf", _of_contacts(column_form(columns[1])))
        numbers = Registered.of([schema], [channel])

    step, sweep = light.step_columns, light.residual_columns
    schemas = [Schema(4, descriptors.step_schema(step), "protobuf", "lavender.Step")]
    channels = [_channel("/step", 4, "protobuf", _meanings(step))]
    if "/residuals" in topics:
        form = descriptors.residuals_schema(sweep)
        schemas.append(Schema(5, form, "protobuf", "lavender.Residuals"))
        channels.append(_channel("/residuals", 5, "protobuf", _meanings(sweep)))
    if light.plots:
        form = MULTI_ARRAY_DEFINITION.encode()
        schemas.append(Schema(6, form, "ros2msg", "std_msgs/msg/Float64MultiArray"))
        channels += [_channel(topic, 6, "cdr") for topic in light.plots]
    return Form(columns, encoded, Streams(numbers, points, poses, Registered.of(schemas, channels)))


@lru_cache(maxsize=8)  # the cells of a sweep look alike
def description_chunk(urdf: str) -> Closed:
    """Return the chunk of /robot_description."""
    text, records = urdf.encode() + b"\0", description_records()
    head = bytes([0, 1, 0, 0]) + len(text).to_bytes(4, "little")  # CDR, little endian
    record = layout.record("/robot_description", Template().constant(head + text))
    payload = records.data + record.rows(1).tobytes()  # its slots stay 0: step 0, time 0
    entries = np.array([(0, len(records.data))], INDEX_ENTRY)
    return closed(payload, [Messages(1, entries)])


@lru_cache(maxsize=1)
def description_records() -> Registered:
    """Return the records of /robot_description."""
    schema = Schema(1, STRING_DEFINITION.encode(), "ros2msg", "std_msgs/msg/String")
    return Registered.of([schema], [_channel("/robot_description", 1, "cdr")])


def _channel(
    topic: str, schema: int, encoding: str, meanings: Mapping[str, str] | None = None
) -> Channel:
    """Return a channel record; its metadata says what each column means."""
    return Channel(layout.CHANNELS[topic], topic, encoding, dict(meanings or {}), schema)


def _of_contacts(form: ColumnForm) -> dict[str, str]:
    """Return what each column of a contact means, and the rules of those that are not stored."""
    names = (*form.names, *form.derived)
    meanings = {name: CONTACT_COLUMNS[name] for name in names if name in CONTACT_COLUMNS}
    if form.derived:
        meanings[RULES] = json.dumps(rules_of(form))
    return meanings


def _meanings(columns: Sequence[Column]) -> dict[str, str]:
    return {column.name: column.meaning for column in columns}
