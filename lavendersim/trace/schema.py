"""What the log holds: every topic, its schema and encoding, every column with unit and meaning.

| topic | schema | encoding | one message per |
|---|---|---|---|
| `/robot_description` | std_msgs/msg/String | ros2msg, cdr | run: the URDF of the scene |
| `/tf` | foxglove.FrameTransforms | protobuf | recorded step: pose of every body, world frame |
| `/velocities` | lavender.Velocities | protobuf | message of `/tf`, with `record.velocities` |
| `/contacts` | foxglove.PointCloud | protobuf | recorded step: where contacts are, also none |
| `/contact_columns` | lavender.ContactColumns | protobuf | recorded steps: CONTACT_COLUMNS |
| `/step` | lavender.Step | protobuf | step: STEP_COLUMNS |
| `/residuals` | lavender.Residuals | protobuf | step of `record.residuals`: RESIDUAL_COLUMNS |
| `/plot/*` | std_msgs/msg/Float64MultiArray | ros2msg, cdr | step: one number, for viewers |

A log has the topics that its plan requires: `/contacts` and `/plot/*` where something can touch,
`/residuals` where `record.residuals` asks for steps, the others always. The metadata record `trace`
has under `absent` every topic that the log does without, and why. Steps are all of them, unless the
metadata record `recorded` says of which `/tf` and `/contacts` alone are.

`/contacts` is identity-posed in the world frame, and for viewers (`points`): float32, and red green
blue alpha. `/contact_columns` has every column of the same contacts to the last bit, but for those
that follow from others: the channel's metadata has the rules of these under `derived`
(`contact_columns`). Logs of older versions have none; their points are the rows that the engine
wrote, an integer column in two fields: `name` (its low 32 bits, UINT32) and `name_high` (the rest).

Simulation time is the only clock: log_time = publish_time = the step's time_ns, sequence = step.
`trace` has the `timestep` [s], and where it changes `timestep_changes`: [steps done, timestep], ...
Columns are those that the effects declare (`lavendersim.engine.effects`). One that a run does not
need is absent; one that none declares passes through unchanged. Readers
take the columns from the file (the descriptor of lavender.Step, the `fields` of the PointCloud).
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from lavendersim.engine.effects import EFFECTS

FORMAT = "1"  # raised when a reader of the old number would misread the file

# Residuals below this are drawn at the floor: log10(0) has no place on a plot. 1e-18 m/s is far
# below the round-off of any solve (speeds of 1 m/s carry 1e-16).
LOG10_RESIDUAL_FLOOR = -18.0


class Column(NamedTuple):
    """One named number of a record."""

    name: str
    kind: str  # numpy's: f8, i8 or u8
    number: int  # of the protobuf field; fixed for ever
    meaning: str


FORMER_NOT_REPORTED = "untold"  # metadata of older logs: `writer.NOT_REPORTED_COLUMNS`
FORMER_NAMES = {"unsolved": "not_converged"}  # of columns in older logs, and their names now
OF_THE_MESSAGE = "step"  # a row of a contact or a sweep has the number of its step there
STEP_COLUMNS = tuple(
    sorted(
        [
            Column("time_ns", "i8", 2, "simulation time [ns]"),
            *(
                Column(column.name, column.kind, column.number, column.text)
                for effect in EFFECTS
                for column in effect.step_columns
            ),
        ],
        key=lambda column: column.number,
    )
)
RESIDUAL_COLUMNS = tuple(
    Column(column.name, column.kind, column.number, column.text)
    for effect in EFFECTS
    for column in effect.residual_columns
    if column.name != OF_THE_MESSAGE
)
CONTACT_COLUMNS = {
    column.name: column.text
    for effect in EFFECTS
    for column in effect.contact_columns
    if column.name != OF_THE_MESSAGE
}

VELOCITY_MEANINGS = {
    "velocity": "of the centre of mass, world axes [m/s]",
    "angular_velocity": "world axes, right-handed [rad/s]",
}

# topic -> the column of /step it draws
PLOTS = {
    "/plot/force": "total_normal_force",
    "/plot/penetration": "max_penetration",
    "/plot/log10_residual": "residual",
}

EXTRA_FIELD_NUMBER = 500  # where columns not listed above are numbered from
HIGH_WORD = "_high"

# Of protobuf's FieldDescriptorProto: TYPE_DOUBLE, TYPE_SFIXED64, TYPE_FIXED64. A plan is made
# without protobuf, which takes a hundredth of a second to import.
WORDS = {"f8": 1, "i8": 16, "u8": 6}
KINDS = {number: kind for kind, number in WORDS.items()}

# foxglove.PackedElementField.NumericType
NUMERIC_TYPES = {"u1": 1, "i1": 2, "u2": 3, "i2": 4, "u4": 5, "i4": 6, "f4": 7, "f8": 8}
COLOURS = ("red", "green", "blue", "alpha")


@lru_cache(maxsize=64)  # the cells of a sweep have the same
def columns_of(dtype: np.dtype[Any], known: tuple[Column, ...]) -> tuple[Column, ...]:
    """Return the columns present in a structured dtype: the known ones first, then the others."""
    names = list(dtype.names or ())
    present = [column for column in known if column.name in names]
    listed = {column.name for column in present}
    for name in names:
        kind = dtype[name].str[1:]
        if kind not in WORDS:
            raise TypeError(f"column {name!r} is {dtype[name]}; float64, int64 or uint64 needed")
        if name not in listed:
            number = EXTRA_FIELD_NUMBER + len(present)
            present.append(Column(name, kind, number, "not described"))
    return tuple(column._replace(kind=dtype[column.name].str[1:]) for column in present)


STRING_DEFINITION = "string data\n"

_RULE = "=" * 80
MULTI_ARRAY_DEFINITION = f"""\
MultiArrayLayout layout
float64[] data
{_RULE}
MSG: std_msgs/MultiArrayLayout
MultiArrayDimension[] dim
uint32 data_offset
{_RULE}
MSG: std_msgs/MultiArrayDimension
string label
uint32 size
uint32 stride
"""
