"""Random small worlds for the property tests, drawn by hypothesis, run by one shared engine."""

from __future__ import annotations

from typing import Any

import numpy as np
from hypothesis import settings
from hypothesis import strategies as st
from laboratory import Bench, box, resolved, sphere

# Worlds are derandomised: the same examples on every machine and day.
FEW = settings(max_examples=60, deadline=None, derandomize=True, database=None)

unit = st.floats(-1.0, 1.0, allow_subnormal=False, width=32)
vector = st.tuples(unit, unit, unit)


@st.composite
def clusters(
    draw, restitution: bool = False, boxes: bool = True, friction: bool = False
) -> dict[str, Any]:
    """Two to four free bodies near the origin that fly towards it and each other."""
    bodies = {}
    for i in range(draw(st.integers(2, 4))):
        corner = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)][i], float)
        place = 0.62 * corner + 0.05 * np.array(draw(vector))
        velocity = -corner + 0.5 * np.array(draw(vector))
        properties = {
            "mass": 10.0 ** draw(unit),
            "velocity": velocity,
            "restitution": draw(st.floats(0.0, 1.0, width=32)) if restitution else 0.0,
            "friction": draw(st.floats(0.0, 1.0, width=32)) if friction else 0.0,
        }
        if not boxes or draw(st.booleans()):
            bodies[f"body_{i}"] = sphere(0.2 + 0.05 * draw(unit), place, **properties)
        else:
            quaternion = np.array([1.0, *(0.5 * np.array(draw(vector)))])
            size = 0.4 + 0.1 * np.array(draw(vector))
            bodies[f"body_{i}"] = box(
                size,
                place,
                orientation=quaternion / np.linalg.norm(quaternion),
                angular_velocity=draw(vector),
                **properties,
            )
    return bodies


def run(bodies: dict[str, Any], steps: int = 60, gravity=(0.0, 0.0, 0.0), **numerics: Any):
    """Return the bench and all rows of a run with 22 sweeps."""
    bench = Bench(resolved(bodies, gravity, **numerics))
    return bench, bench.run(steps)


def vectors(step: np.ndarray, name: str) -> np.ndarray:
    """Return the three columns `name_x, name_y, name_z`, shape (rows, 3)."""
    return np.column_stack([step[f"{name}_{axis}"] for axis in "xyz"])
