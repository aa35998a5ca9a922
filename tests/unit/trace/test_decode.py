"""Columns of chunks against google.protobuf, and messages of another layout, which are refused."""

from __future__ import annotations

import numpy as np
import pytest
from logs_of_samples import Logged, logged, messages
from mcap.records import Schema
from sample import BODIES

from lavendersim.trace import decode, descriptors, layout
from lavendersim.trace.index import ChunkContent
from lavendersim.trace.layout import CHANNELS, PackedField
from lavendersim.trace.schema import FORMER_NAMES, NUMERIC_TYPES, Column


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Logged:
    return logged(tmp_path_factory.mktemp("log") / "a.mcap")


def schema_of(log: Logged, topic: str) -> Schema:
    return log.index.schemas[log.index.channels[CHANNELS[topic]].schema_id]


def same(found: np.ndarray, expected: list[float], kind: str) -> bool:
    return found.tobytes() == np.array(expected, kind).tobytes()


def test_steps_are_the_fields_of_their_messages(log: Logged) -> None:
    columns = decode.columns_in(schema_of(log, "/step"), "Step")
    ((_, chunk),) = log.chunks("/step")
    table = decode.decode_steps(chunk, columns)
    parsed = list(messages(log.path, "/step"))
    assert len(table) == len(parsed)
    for column in columns:
        values = [getattr(message, column.name) for _, message in parsed]
        assert same(table[column.name], values, column.kind), column.name
    assert table["time"].tolist() == [record.log_time / 1e9 for record, _ in parsed]


def test_residuals_are_the_sweeps_of_their_messages(log: Logged) -> None:
    columns = decode.columns_in(schema_of(log, "/residuals"), "Sweep")
    ((_, chunk),) = log.chunks("/residuals")
    table = decode.decode_residuals(chunk, columns)
    rows = [
        (m.step, s.sweep, s.residual) for _, m in messages(log.path, "/residuals") for s in m.sweeps
    ]
    assert table["step"].tolist() == [row[0] for row in rows]
    assert table["sweep"].tolist() == [row[1] for row in rows]
    assert same(table["residual"], [row[2] for row in rows], "f8")


def test_poses_are_positions_and_scalar_first_quaternions(log: Logged) -> None:
    ((_, chunk),) = log.chunks("/tf")
    steps, poses = decode.decode_poses(chunk, layout.transforms_layout(BODIES), len(BODIES))
    for step, pose, (record, message) in zip(steps, poses, messages(log.path, "/tf"), strict=True):
        assert step == record.sequence
        for row, one in zip(pose, message.transforms, strict=True):
            t, q = one.translation, one.rotation
            assert same(row, [t.x, t.y, t.z, q.w, q.x, q.y, q.z], "f8")


def test_no_other_columns_have_those_types() -> None:
    former, now = next(iter(FORMER_NAMES.items()))
    columns = (Column("a", "f8", 1, ""), Column(former, "i8", 2, ""))
    schema = Schema(1, descriptors.step_schema(columns), "protobuf", "lavender.Step")
    assert decode.columns_in(schema, "Step") == (columns[0], columns[1]._replace(name=now))
    text = Schema(1, descriptors.velocities_schema(), "protobuf", "lavender.Velocities")
    with pytest.raises(ValueError, match="another type than lavender's"):
        decode.columns_in(text, "Velocity")


@pytest.mark.parametrize("place", [0, 2, 9])  # opcode, length, channel
def test_messages_of_another_layout_are_refused(log: Logged, place: int) -> None:
    ((_, chunk),) = log.chunks("/tf")
    data = chunk.data.copy()
    data[int(chunk.messages[CHANNELS["/tf"]]["offset"][3]) + place] ^= 1
    broken = ChunkContent(data, chunk.prologue, chunk.messages)
    with pytest.raises(ValueError, match="another layout than lavender's"):
        decode.decode_poses(broken, layout.transforms_layout(BODIES), len(BODIES))


def test_a_row_of_points_has_its_step_and_its_time_where_no_column_stands() -> None:
    f8, u4 = NUMERIC_TYPES["f8"], NUMERIC_TYPES["u4"]
    fields = (PackedField("x", 0, f8), PackedField("n", 8, u4), PackedField("n_high", 12, u4))
    row = decode.contact_row(fields, 16)
    assert {name: place[1] for name, place in row.fields.items()} == {"x": 0, "n": 8, "step": 16, "time": 24}  # noqa: E501  # fmt: skip
    assert (row["n"], row["x"]) == (np.dtype("<i8"), np.dtype("<f8"))
    colours = (PackedField("x", 8, f8), PackedField("red", 0, NUMERIC_TYPES["u1"]))
    free = decode.contact_row(colours, 16)
    assert {name: place[1] for name, place in free.fields.items()} == {
        "x": 8,
        "step": 0,
        "time": 16,
    }
    with pytest.raises(ValueError, match="outside its points"):
        decode.contact_row((PackedField("x", 9, f8),), 16)


def test_times_are_nanoseconds() -> None:
    assert decode.seconds(np.array([0, 1, 1_500_000_000])).tolist() == [0.0, 1e-9, 1.5]


def test_no_part_is_a_table_without_rows() -> None:
    table = decode.join((), [("step", "i8"), ("x", "f8")])
    assert (len(table), table.dtype.names) == (0, ("step", "x"))
