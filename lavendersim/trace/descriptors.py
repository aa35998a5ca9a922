"""The protobuf descriptor sets that the schema records of a log carry.

Built as data, so there is no generated code and no protoc. The foxglove messages repeat the public
definitions (https://github.com/foxglove/foxglove-sdk, schemas/proto) field by field.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Final

from google.protobuf import timestamp_pb2
from google.protobuf.descriptor_pb2 import FieldDescriptorProto as Field
from google.protobuf.descriptor_pb2 import FileDescriptorProto, FileDescriptorSet

from lavendersim.trace.schema import WORDS, Column


def _message(file: FileDescriptorProto, name: str, fields: Iterable[tuple[Any, ...]]) -> None:
    """Add message `name` with fields (name, number, type, [type name], [repeated])."""
    message = file.message_type.add(name=name)
    for field_name, number, kind, *rest in fields:
        field = message.field.add(name=field_name, number=number, type=kind)
        field.label = Field.LABEL_REPEATED if "repeated" in rest else Field.LABEL_OPTIONAL
        if rest and rest[0] != "repeated":
            field.type_name = rest[0]


def _file(name: str, package: str, dependencies: Iterable[str] = ()) -> FileDescriptorProto:
    return FileDescriptorProto(name=name, package=package, dependency=dependencies, syntax="proto3")


def _bundle(*files: FileDescriptorProto) -> bytes:
    data: bytes = FileDescriptorSet(file=files).SerializeToString(deterministic=True)
    return data


def step_schema(columns: Iterable[Column]) -> bytes:
    """Return the descriptor set of lavender.Step."""
    file = _file("lavender/Step.proto", "lavender")
    _message(file, "Step", [(c.name, c.number, WORDS[c.kind]) for c in columns])
    return _bundle(file)


def residuals_schema(columns: Iterable[Column]) -> bytes:
    """Return the descriptor set of lavender.Residuals: one Sweep per sweep of the step."""
    file = _file("lavender/Residuals.proto", "lavender")
    _message(file, "Sweep", [(c.name, c.number, WORDS[c.kind]) for c in columns])
    fields = [
        ("step", 1, Field.TYPE_SFIXED64),
        ("sweeps", 2, Field.TYPE_MESSAGE, ".lavender.Sweep", "repeated"),
    ]
    _message(file, "Residuals", fields)
    return _bundle(file)


CONTACT_COLUMNS: Final = (
    *("steps", "times", "counts", "names", "kinds", "keys", "planes"),
    *("predictors", "constants", "bodies"),
)


def contact_columns_schema() -> bytes:
    """Return the descriptor set of lavender.ContactColumns, see `contact_columns`."""
    file = _file("lavender/ContactColumns.proto", "lavender")
    texts = ("names", "kinds")
    fields = [
        (name, number, Field.TYPE_STRING, "repeated")
        if name in texts
        else (name, number, Field.TYPE_BYTES)
        for number, name in enumerate(CONTACT_COLUMNS, 1)
    ]
    _message(file, "ContactColumns", fields)
    return _bundle(file)


def _foxglove(name: str, *dependencies: str) -> FileDescriptorProto:
    paths = [f"foxglove/{dependency}.proto" for dependency in dependencies]
    if name in ("FrameTransform", "PointCloud"):
        paths.insert(0, "google/protobuf/timestamp.proto")
    return _file(f"foxglove/{name}.proto", "foxglove", paths)


def _geometry() -> list[FileDescriptorProto]:
    """Return google.protobuf.Timestamp, foxglove.Vector3 and foxglove.Quaternion."""
    clock = FileDescriptorProto()
    timestamp_pb2.DESCRIPTOR.CopyToProto(clock)
    vector, quaternion = _foxglove("Vector3"), _foxglove("Quaternion")
    _message(vector, "Vector3", [(a, i, Field.TYPE_DOUBLE) for i, a in enumerate("xyz", 1)])
    _message(quaternion, "Quaternion", [(a, i, Field.TYPE_DOUBLE) for i, a in enumerate("xyzw", 1)])
    return [clock, vector, quaternion]


def transforms_schema() -> bytes:
    """Return the descriptor set of foxglove.FrameTransforms."""
    one = _foxglove("FrameTransform", "Vector3", "Quaternion")
    fields = [
        ("timestamp", 1, Field.TYPE_MESSAGE, ".google.protobuf.Timestamp"),
        ("parent_frame_id", 2, Field.TYPE_STRING),
        ("child_frame_id", 3, Field.TYPE_STRING),
        ("translation", 4, Field.TYPE_MESSAGE, ".foxglove.Vector3"),
        ("rotation", 5, Field.TYPE_MESSAGE, ".foxglove.Quaternion"),
    ]
    _message(one, "FrameTransform", fields)
    many = _foxglove("FrameTransforms", "FrameTransform")
    transforms = ("transforms", 1, Field.TYPE_MESSAGE, ".foxglove.FrameTransform", "repeated")
    _message(many, "FrameTransforms", [transforms])
    return _bundle(*_geometry(), one, many)


def velocities_schema() -> bytes:
    """Return the descriptor set of lavender.Velocities: a velocity and a spin of each body."""
    file = _file(
        "lavender/Velocities.proto",
        "lavender",
        ("google/protobuf/timestamp.proto", "foxglove/Vector3.proto"),
    )
    one = [
        ("body", 1, Field.TYPE_STRING),
        ("velocity", 2, Field.TYPE_MESSAGE, ".foxglove.Vector3"),
        ("angular_velocity", 3, Field.TYPE_MESSAGE, ".foxglove.Vector3"),
    ]
    _message(file, "Velocity", one)
    many = [
        ("timestamp", 1, Field.TYPE_MESSAGE, ".google.protobuf.Timestamp"),
        ("bodies", 2, Field.TYPE_MESSAGE, ".lavender.Velocity", "repeated"),
    ]
    _message(file, "Velocities", many)
    return _bundle(*_geometry()[:2], file)


def point_cloud_schema() -> bytes:
    """Return the descriptor set of foxglove.PointCloud."""
    pose = _foxglove("Pose", "Vector3", "Quaternion")
    parts = [
        ("position", 1, Field.TYPE_MESSAGE, ".foxglove.Vector3"),
        ("orientation", 2, Field.TYPE_MESSAGE, ".foxglove.Quaternion"),
    ]
    _message(pose, "Pose", parts)
    packed = _foxglove("PackedElementField")
    fields: list[tuple[Any, ...]] = [
        ("name", 1, Field.TYPE_STRING),
        ("offset", 2, Field.TYPE_FIXED32),
        ("type", 3, Field.TYPE_ENUM, ".foxglove.PackedElementField.NumericType"),
    ]
    _message(packed, "PackedElementField", fields)
    numeric = packed.message_type[0].enum_type.add(name="NumericType")
    labels = ("UNKNOWN", "UINT8", "INT8", "UINT16", "INT16", "UINT32", "INT32", "FLOAT32")
    for number, label in enumerate((*labels, "FLOAT64")):
        numeric.value.add(name=label, number=number)
    cloud = _foxglove("PointCloud", "Pose", "PackedElementField")
    fields = [
        ("timestamp", 1, Field.TYPE_MESSAGE, ".google.protobuf.Timestamp"),
        ("frame_id", 2, Field.TYPE_STRING),
        ("pose", 3, Field.TYPE_MESSAGE, ".foxglove.Pose"),
        ("point_stride", 4, Field.TYPE_FIXED32),
        ("fields", 5, Field.TYPE_MESSAGE, ".foxglove.PackedElementField", "repeated"),
        ("data", 6, Field.TYPE_BYTES),
    ]
    _message(cloud, "PointCloud", fields)
    return _bundle(*_geometry(), pose, packed, cloud)
