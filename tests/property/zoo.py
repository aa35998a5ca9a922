"""Random small worlds of every shape, frictional and bouncing, run at the default numerics.

One compiled engine serves them all: shapes, masses, surfaces and motions are values.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from hypothesis import Phase, settings
from hypothesis import strategies as st
from laboratory import Bench, body, plane, resolved

from lavendersim.engine.collide import SHAPE_PAIRS
from lavendersim.engine.engine import Rows
from lavendersim.engine.spec import Spec
from lavendersim.experiment.resolve.presets import DEFAULT

# All that the default numerics compile for such worlds, whatever bodies one of them holds.
ZOO = Spec(
    effects=(
        "compliance",
        "compound",
        "contact_log",
        "contact_midpoint",
        "contact_spring",
        "contact_torque",
        "fast_bodies",
        "friction",
        "gravity",
        "gyroscopic",
        "impact_energy",
        "impact_order",
        "impact_time",
        "midpoint",
        "newton",
        "pose_log",
        "projection",
        "restitution",
        "rotation",
        "frictionless_contact",
        "speculative",
        "step_log",
        "warm_start",
    ),
    shape_pairs=tuple(sorted(SHAPE_PAIRS)),
    solver=DEFAULT.solver,
    tolerance=True,
)
NUMERICS = DEFAULT.model_dump(mode="json")
GRAVITY = (0.0, 0.0, -9.81)  # [m/s^2]
NOWHERE = (0.0, 0.0, 0.0)
DT = 1.0 / 240.0  # [s]

# Derandomised: the same worlds on every machine and day. Worlds that break a law are reported as
# drawn: to shrink one takes minutes.
SOME = settings(
    max_examples=30,
    deadline=None,
    derandomize=True,
    database=None,
    phases=[Phase.explicit, Phase.generate],
)

unit = st.floats(-1.0, 1.0, allow_subnormal=False, width=32)
share = st.floats(0.0, 1.0, allow_subnormal=False, width=32)
vector = st.tuples(unit, unit, unit)
rigid = st.just(0.0)
soft = st.floats(0.0, 2.0**-13, allow_subnormal=False, width=32)  # [m/N]

SHAPES = ("sphere", "box", "capsule", "cylinder", "ellipsoid", "cone", "hull", "compound")
HULL = ((0.2, 0, -0.12), (-0.1, 0.17, -0.12), (-0.1, -0.17, -0.12), (0.02, 0.03, 0.25))
# Half a metre apart, so that bodies some 0.4 m wide that fly together meet within a few steps.
CORNERS = 0.5 * np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0)], float)
# Two slopes of irregular triangles, 2 m wide, 0.2 m down from their ridge.
ROOF = {
    "kind": "mesh",
    "vertices": [
        *([-1, -1, -0.2], [0, -1, 0], [1, -1, -0.2], [-1, 1, -0.2], [0, 1, 0], [1, 1, -0.2]),
        *([-0.3, 0.2, -0.06], [0.4, -0.1, -0.08]),
    ],
    "triangles": [
        *([0, 1, 6], [1, 4, 6], [4, 3, 6], [3, 0, 6]),
        *([1, 2, 7], [2, 5, 7], [5, 4, 7], [4, 1, 7]),
    ],
}
FLOOR = -0.3  # a few steps below most bodies at the origin [m]
CAVITY = 0.9  # radius of what the corners are inside of [m]
OUT = np.array([0.6, 0.48, 0.64])  # from its wall, over the origin, to its centre
ACROSS = np.array([0.52, 0.36, 0.8, 0.0]) / np.sqrt(1.04)  # turns the axis of a drum across that


def shape(kind: str, size: float) -> dict[str, Any]:
    """Return a shape some 0.4 m wide, most of its measures times `size`."""
    if kind == "sphere":
        return {"kind": kind, "radius": 0.2 * size}
    if kind == "box":
        return {"kind": kind, "size": [0.36 * size, 0.3 * size, 0.24]}
    if kind == "capsule":
        return {"kind": kind, "radius": 0.12 * size, "length": 0.25}
    if kind == "cylinder":
        return {"kind": kind, "radius": 0.16 * size, "length": 0.3}
    if kind == "ellipsoid":
        return {"kind": kind, "semi_axes": [0.2 * size, 0.14 * size, 0.1]}
    if kind == "cone":
        return {"kind": kind, "radius": 0.16 * size, "height": 0.36}
    if kind == "hull":
        return {"kind": kind, "points": [[size * c for c in point] for point in HULL]}
    ball, block = shape("sphere", 0.6 * size), shape("box", 0.6 * size)
    parts = [{"shape": ball, "position": [0.1, 0, 0]}, {"shape": block, "position": [-0.1, 0, 0]}]
    return {"kind": "compound", "parts": parts}


@st.composite
def zoos(
    draw: Any,
    kinds: tuple[str, ...] = SHAPES,
    count: tuple[int, int] = (2, 5),
    restitution: Any = share,
    friction: Any = share,
    compliance: Any = rigid,
    floor: bool = False,
    cavity: bool = False,
    ground: bool = False,
) -> dict[str, Any]:
    """Bodies that fly and tumble towards the origin, masses over two decades.

    cavity: and beyond it, to the wall of a bowl or a drum that is as far as a floor.
    ground: and down to a roof of triangles whose ridge is there.
    """
    bodies: dict[str, Any] = {}
    down = np.array([0.0, 0.0, 2.0 * (floor or ground)])
    if cavity:
        down = 4.0 * OUT
    for i in range(draw(st.integers(*count))):
        quaternion = np.array([1.0, *draw(vector)])
        bodies[f"body_{i}"] = body(
            shape(draw(st.sampled_from(kinds)), 1.0 + 0.2 * draw(unit)),
            CORNERS[i] + 0.04 * np.array(draw(vector)),
            orientation=quaternion / np.linalg.norm(quaternion),
            mass=10.0 ** draw(unit),
            velocity=-8.0 * CORNERS[i] + np.array(draw(vector)) - down,
            angular_velocity=6.0 * np.array(draw(vector)),
            restitution=draw(restitution),
            friction=draw(friction),
            compliance=draw(compliance),
        )
    if floor:  # last: a body's row is its place in the order, whatever the floor
        bodies["floor"] = plane(offset=FLOOR, friction=1.0)
    if cavity:
        wall = {"kind": draw(st.sampled_from(("bowl", "drum"))), "radius": CAVITY}
        bodies["cavity"] = body(wall, (CAVITY + FLOOR) * OUT, orientation=ACROSS, friction=1.0)
    if ground:
        bodies["ground"] = body(ROOF, (0.1, 0.05, FLOOR), friction=1.0)
    return bodies


def bench(bodies: dict[str, Any], gravity: Any = NOWHERE, **numerics: Any) -> Bench:
    """Return the world at its start."""
    cell = resolved(bodies, gravity, **{**NUMERICS, **numerics})
    cell["record"]["residuals"] = "none"
    return Bench(cell, ZOO)


def run(bodies: dict[str, Any], steps: int, gravity: Any = NOWHERE, **numerics: Any) -> Rows:
    """Return all rows of a run."""
    return bench(bodies, gravity, **numerics).run(steps)


def vectors(rows: np.ndarray, name: str) -> np.ndarray:
    """Return the columns `name`x, `name`y, `name`z, shape (rows, 3)."""
    return np.column_stack([rows[f"{name}{axis}"] for axis in "xyz"])


def impulses(contacts: np.ndarray) -> np.ndarray:
    """Return the impulse on B of every contact row, world axes, shape (rows, 3) [N s]."""
    normal, one = vectors(contacts, "n"), vectors(contacts, "t1")
    two = np.cross(normal, one)
    parts = (normal, "impulse_n"), (one, "impulse_t1"), (two, "impulse_t2")
    return sum(axes * contacts[name][:, None] for axes, name in parts)
