"""Descriptor sets stand alone, and foxglove's messages have the numbers of its definitions."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from google.protobuf import descriptor_pb2, descriptor_pool, message_factory

from lavendersim.trace import descriptors
from lavendersim.trace.schema import NUMERIC_TYPES, RESIDUAL_COLUMNS, STEP_COLUMNS

LABELS = {"u": "UINT", "i": "INT", "f": "FLOAT"}


def found(data: bytes, name: str) -> Any:
    pool = descriptor_pool.DescriptorPool()
    for file in descriptor_pb2.FileDescriptorSet.FromString(data).file:
        pool.Add(file)  # TypeError where what it depends on is not before it
    return pool.FindMessageTypeByName(name)


def numbers(data: bytes, name: str) -> dict[str, int]:
    return {field.name: field.number for field in found(data, name).fields}


# https://github.com/foxglove/foxglove-sdk, schemas/proto
FOXGLOVE = {
    "foxglove.FrameTransforms": {"transforms": 1},
    "foxglove.FrameTransform": {
        "timestamp": 1,
        "parent_frame_id": 2,
        "child_frame_id": 3,
        "translation": 4,
        "rotation": 5,
    },
    "foxglove.Vector3": {"x": 1, "y": 2, "z": 3},
    "foxglove.Quaternion": {"x": 1, "y": 2, "z": 3, "w": 4},
    "foxglove.Pose": {"position": 1, "orientation": 2},
    "foxglove.PackedElementField": {"name": 1, "offset": 2, "type": 3},
    "foxglove.PointCloud": {
        "timestamp": 1,
        "frame_id": 2,
        "pose": 3,
        "point_stride": 4,
        "fields": 5,
        "data": 6,
    },
}


@pytest.mark.parametrize("name", FOXGLOVE)
def test_numbers_are_those_of_the_public_definitions(name: str) -> None:
    cloud = name.endswith(("PointCloud", "Pose", "PackedElementField"))
    make = descriptors.point_cloud_schema if cloud else descriptors.transforms_schema
    assert numbers(make(), name) == FOXGLOVE[name]


def test_numeric_types_are_called_as_numpys_are() -> None:
    enum = found(descriptors.point_cloud_schema(), "foxglove.PackedElementField").enum_types_by_name
    values = {value.name: value.number for value in enum["NumericType"].values}
    assert values.pop("UNKNOWN") == 0
    assert values == {f"{LABELS[k[0]]}{8 * int(k[1])}": n for k, n in NUMERIC_TYPES.items()}


@pytest.mark.parametrize(
    ("make", "columns", "name"),
    [
        (descriptors.step_schema, STEP_COLUMNS, "lavender.Step"),
        (descriptors.residuals_schema, RESIDUAL_COLUMNS, "lavender.Sweep"),
    ],
)
def test_columns_have_their_numbers_and_words_of_eight_bytes(
    make: Callable[..., bytes], columns: Any, name: str
) -> None:
    data = make(columns)
    assert numbers(data, name) == {column.name: column.number for column in columns}
    message = message_factory.GetMessageClass(found(data, name))
    for column in columns:
        value = 0.1 if column.kind == "f8" else 2**40
        one = message(**{column.name: value})
        # a tag of one or two bytes, and a word of fixed length
        assert len(one.SerializeToString()) == 8 + (1 if column.number < 16 else 2)
        assert getattr(message.FromString(one.SerializeToString()), column.name) == value


def test_velocities_and_contact_columns_stand_alone() -> None:
    data = descriptors.velocities_schema()
    assert numbers(data, "lavender.Velocities") == {"timestamp": 1, "bodies": 2}
    assert numbers(data, "lavender.Velocity") == {"body": 1, "velocity": 2, "angular_velocity": 3}
    columns = numbers(descriptors.contact_columns_schema(), "lavender.ContactColumns")
    assert columns == {name: k for k, name in enumerate(descriptors.CONTACT_COLUMNS, 1)}
    sweeps = found(descriptors.residuals_schema(RESIDUAL_COLUMNS), "lavender.Residuals")
    assert sweeps.fields_by_name["sweeps"].message_type.full_name == "lavender.Sweep"


def test_equal_columns_give_equal_bytes() -> None:
    """A log's bytes are compared: the set may not depend on what was made before."""
    assert descriptors.step_schema(STEP_COLUMNS) == descriptors.step_schema(list(STEP_COLUMNS))
    assert descriptors.point_cloud_schema() == descriptors.point_cloud_schema()
