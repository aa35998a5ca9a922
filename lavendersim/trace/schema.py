"""What the log holds: every topic, its schema and encoding, every column with unit and meaning.

| topic | schema | encoding | one message per |
|---|---|---|---|
| `/robot_description` | std_msgs/msg/String | ros2msg, cdr | run: the URDF of the scene |
| `/tf` | foxglove.FrameTransforms | protobuf | step: pose of every body in the world frame |
| `/contacts` | foxglove.PointCloud | protobuf | step: all contacts, also when it has none |
| `/step` | lavender.Step | protobuf | step: STEP_COLUMNS |
| `/residuals` | lavender.Residuals | protobuf | step for which it was asked: RESIDUAL_COLUMNS |
| `/plot/*` | std_msgs/msg/Float64MultiArray | ros2msg, cdr | step: one number, for viewers |

A log has the topics that its plan calls for: `/contacts` and `/plot/*` where something can touch,
`/residuals` where `record.residuals` asks for steps, the others always. The metadata record `trace`
has under `absent` every topic that the log does without, and why.

`/contacts` is identity-posed in the world frame and its data is packed: x y z, then the other
columns, then red green blue alpha. PointCloud knows no 64-bit integer, so an integer column is
two fields: `name` (its low 32 bits, UINT32) and `name_high` (the rest, INT32).

Simulation time is the only clock: log_time = publish_time = the step's time_ns, sequence = step.
`trace` has the `timestep` [s], and where it changes `timestep_changes`: [steps done, timestep], ...
A column that a run does not need is absent; one not listed here passes through unchanged. Readers
take the columns from the file (the descriptor of lavender.Step, the `fields` of the PointCloud).
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np
from google.protobuf.descriptor_pb2 import FieldDescriptorProto as Field

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


STEP_COLUMNS = (
    Column("step", "i8", 1, "index of the step; 0 is the initial state"),
    Column("time_ns", "i8", 2, "simulation time [ns]"),
    Column("contact_count", "i8", 3, "number of contacts"),
    Column("sweeps", "i8", 4, "solver sweeps done"),
    Column("residual", "f8", 5, "largest residual over the contacts after the solve [m/s]"),
    Column("residual_contact", "i8", 6, "row of the contact that has it; -1 none"),
    Column("total_normal_force", "f8", 7, "sum of normal forces, each impulse / timestep [N]"),
    Column("max_penetration", "f8", 8, "deepest penetration [m]"),
    Column("kinetic_energy", "f8", 9, "kinetic energy of all movable bodies [J]"),
    Column("potential_energy", "f8", 10, "potential energy under gravity [J]"),
    Column("momentum_x", "f8", 11, "linear momentum, world x [kg m/s]"),
    Column("momentum_y", "f8", 12, "linear momentum, world y [kg m/s]"),
    Column("momentum_z", "f8", 13, "linear momentum, world z [kg m/s]"),
    Column("angular_momentum_x", "f8", 14, "about the world origin, world x [kg m^2/s]"),
    Column("angular_momentum_y", "f8", 15, "about the world origin, world y [kg m^2/s]"),
    Column("angular_momentum_z", "f8", 16, "about the world origin, world z [kg m^2/s]"),
    Column("state_hash", "u8", 17, "hash of positions and velocities; equal states, equal hashes"),
    Column("unsolved", "i8", 18, "1 when the residual stayed above the tolerance asked for"),
    Column("stronge", "i8", 19, "1 when Stronge's law of restitution replaced Newton's"),
    Column("awake", "i8", 20, "number of movable bodies that do not sleep"),
    Column("signorini", "f8", 21, "largest |min((k_n + gamma) lambda_n, w_n)| of a contact [m/s]"),
    Column("signorini_contact", "i8", 22, "row of the contact that has it; -1 none"),
    Column("cone", "f8", 23, "largest |lambda_t| - mu lambda_n or -lambda_n of a contact [N s]"),
    Column("cone_contact", "i8", 24, "row of the contact that has it; -1 none"),
    Column("dissipation", "f8", 25, "largest |lambda_t . w_t + mu lambda_n |w_t||, contacts [J]"),
    Column("dissipation_contact", "i8", 26, "row of the contact that has it; -1 none"),
)

RESIDUAL_COLUMNS = (
    Column("sweep", "i8", 1, "sweeps done; 0 is before the first"),
    Column("residual", "f8", 2, "largest residual over the contacts [m/s]"),
)

CONTACT_COLUMNS = {
    "x": "contact point, world x [m]",
    "y": "contact point, world y [m]",
    "z": "contact point, world z [m]",
    "body_a": "index of body A in the list of bodies",
    "body_b": "index of body B in the list of bodies",
    "feature": "which features of the two shapes touch; stable while they do",
    "nx": "unit normal from A to B, world x",
    "ny": "unit normal from A to B, world y",
    "nz": "unit normal from A to B, world z",
    "separation": "signed distance, negative inside [m]",
    "penetration": "max(-separation, 0) [m]",
    "approach_velocity": "normal velocity of B relative to A before the solve [m/s]",
    "normal_velocity": "normal velocity of B relative to A after the solve [m/s]",
    "impulse_n": "normal impulse on B [N s]",
    "impulse_t1": "tangential impulse on B along t1 [N s]",
    "impulse_t2": "tangential impulse on B along t2 = n x t1 [N s]",
    "slip_t1": "tangential velocity of B relative to A after the solve, along t1 [m/s]",
    "slip_t2": "tangential velocity of B relative to A after the solve, along t2 [m/s]",
    "t1x": "first unit tangent, world x",
    "t1y": "first unit tangent, world y",
    "t1z": "first unit tangent, world z",
    "friction": "coefficient of the pair [-]",
    "angular_impulse_n": "of torsional friction on B about the normal [N m s]",
    "spin_n": "angular velocity of B relative to A after the solve, about the normal [rad/s]",
    "torsional_friction": "coefficient of the pair [m]",
    "angular_impulse_t1": "of rolling friction on B about t1 [N m s]",
    "angular_impulse_t2": "of rolling friction on B about t2 [N m s]",
    "spin_t1": "angular velocity of B relative to A after the solve, about t1 [rad/s]",
    "spin_t2": "angular velocity of B relative to A after the solve, about t2 [rad/s]",
    "rolling_friction": "coefficient of the pair [m]",
    "force_n": "impulse_n / timestep: the step's average [N]",
    "inverse_effective_mass": "along the normal [1/kg]",
    "target": "b + b_rest: the row asked v_n + target + gamma impulse_n >= 0 [m/s]",
    "residual": "natural-map residual after the solve [m/s]",
}

# topic -> the column of /step it draws
PLOTS = {
    "/plot/force": "total_normal_force",
    "/plot/penetration": "max_penetration",
    "/plot/log10_residual": "residual",
}

EXTRA_FIELD_NUMBER = 500  # where columns not listed above are numbered from
HIGH_WORD = "_high"

WORDS = {"f8": Field.TYPE_DOUBLE, "i8": Field.TYPE_SFIXED64, "u8": Field.TYPE_FIXED64}
KINDS = {number: kind for kind, number in WORDS.items()}

# foxglove.PackedElementField.NumericType
NUMERIC_TYPES = {"u1": 1, "i1": 2, "u2": 3, "i2": 4, "u4": 5, "i4": 6, "f4": 7, "f8": 8}
COLOURS = ("red", "green", "blue", "alpha")


def columns_of(dtype: np.dtype[Any], known: Iterable[Column]) -> tuple[Column, ...]:
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
