"""Drag by both ends of a step is drag's own map of it, also of what contacts push."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from drawn_contacts import random_frame
from interpreted import interpreted, records
from plain_facts import matrix_fields, one_row, vector_fields

from lavendersim.engine.drag_by_mean import (
    make_act_midway,
    make_differs_midway,
    make_note_middle,
    make_slow_by_mean,
)
from lavendersim.engine.effects.drag import make
from lavendersim.engine.records import PLANE, SPHERE
from lavendersim.engine.spec import Spec

SPEC = Spec(("contact_midpoint", "drag", "impact_time", "midpoint", "rotation"))
INVERSE_MASS, INVERSE_INERTIA = 0.7, np.array([0.5, 1.1, 2.3])
LINEAR, QUADRATIC, ANGULAR, DT = 0.4, 0.3, 0.6, 0.2
START, SPIN = np.array([1.0, -2.0, 0.5]), np.array([0.4, -0.3, 0.9])
DRIVEN, TURNED = np.array([-0.6, 0.8, 1.2]), np.array([0.5, 0.7, -0.4])  # by other forces


def dragged(matrix: np.ndarray, **values: Any) -> Any:
    fields = {"drag_linear": LINEAR, "drag_quadratic": 0.0, "drag_angular": ANGULAR, "bound": 0.5}
    nothing = np.zeros(3)
    return one_row(
        **({"inv_m": INVERSE_MASS, "shape": SPHERE} | fields | values),
        **vector_fields("drag_v", START),
        **vector_fields("drag_w", SPIN),
        **vector_fields("slowed_v", nothing),
        **vector_fields("slowed_w", nothing),
        **vector_fields("inv_i", INVERSE_INERTIA),
        **matrix_fields(matrix),
    )


def moving(v: np.ndarray, w: np.ndarray) -> Any:
    return one_row(**vector_fields("v", v), **vector_fields("w", w))


def vectors(row: Any, prefix: str = "") -> tuple[np.ndarray, np.ndarray]:
    return tuple(np.array([row[f"{prefix}{k}{axis}"] for axis in "xyz"]) for k in "vw")  # type: ignore[return-value]


def test_it_is_the_map_of_a_step_by_where_that_ends(rng) -> None:
    """What `accelerate` takes from what other forces do, found again from the end alone.

    Both are some twenty roundings of numbers of the size of 1.
    """
    body = dragged(random_frame(rng))
    ended = moving(DRIVEN, TURNED)
    interpreted(make(SPEC))(body, ended, one_row(dt=DT))
    v, w = vectors(ended)
    linear, angular = interpreted(make_slow_by_mean(SPEC))(
        body, ended, moving(START, SPIN), one_row(dt=DT)
    )
    np.testing.assert_allclose(tuple(linear), v - DRIVEN, atol=20 * 1.1e-16)
    np.testing.assert_allclose(tuple(angular), w - TURNED, atol=20 * 1.1e-16)


def test_a_speed_that_stays_is_slowed_by_its_drag_alone(rng) -> None:
    """v' = v_0: -dt (c_1 + c_2 |v|) v/m, at any timestep, and so the spin about every axis."""
    matrix = random_frame(rng)
    body, same = dragged(matrix, drag_quadratic=QUADRATIC), moving(START, SPIN)
    for dt in (0.01, 5.0):
        linear, angular = interpreted(make_slow_by_mean(SPEC))(body, same, same, one_row(dt=dt))
        rate = (LINEAR + QUADRATIC * np.linalg.norm(START)) * INVERSE_MASS
        np.testing.assert_allclose(tuple(linear), -dt * rate * START, rtol=1e-14)
        turned = matrix @ (INVERSE_INERTIA * (matrix.T @ SPIN))
        np.testing.assert_allclose(tuple(angular), -dt * ANGULAR * turned, rtol=1e-13)


def several(*rows: Any) -> Any:
    return records(np.array([row._row for row in rows], rows[0]._row.dtype))


def test_velocities_of_a_pass_get_it_in_place_of_that_by_the_start(rng) -> None:
    matrix = random_frame(rng)
    poses = several(dragged(matrix), dragged(matrix, inv_m=0.0))
    for k in "vw":
        for axis in "xyz":
            poses[0][f"slowed_{k}{axis}"] = 0.125
    bodies = records(poses.array.copy())
    ends, lead = several(*[moving(DRIVEN, TURNED)] * 2), several(*[moving(START, SPIN)] * 2)
    interpreted(make_note_middle(SPEC))(bodies, ends, lead, True, one_row(dt=DT))
    by_both = interpreted(make_slow_by_mean(SPEC))(poses[0], ends[0], lead[0], one_row(dt=DT))
    np.testing.assert_array_equal(vectors(bodies[0], "slowed_"), by_both)
    interpreted(make_act_midway(SPEC))(bodies, poses, ends)
    for found, before, change in zip(vectors(ends[0]), (DRIVEN, TURNED), by_both, strict=True):
        np.testing.assert_allclose(found, before + np.array(change) - 0.125, atol=4 * 2.3e-16)
    np.testing.assert_array_equal(vectors(ends[1]), (DRIVEN, TURNED))
    # When the passes are over poses bring their own values back.
    interpreted(make_note_middle(SPEC))(poses, ends, lead, False, one_row(dt=DT))
    np.testing.assert_array_equal(vectors(poses[0], "slowed_"), np.full((2, 3), 0.125))


@pytest.mark.parametrize(
    ("push", "differs"), [(0.0, False), (1e-12, False), (1e-3, True), (0.1, True)]
)
def test_passes_are_made_where_a_push_changes_drag_by_more_than_solves_leave(
    push: float, differs: bool
) -> None:
    """By c_1 dt/(2 m) of the push: 0.07 of 1e-12 m/s is not seen."""
    assert asked(push) is differs
    assert not asked(push, inv_m=0.0)
    assert not asked(push, shape=PLANE)


def asked(push: float, **values: Any) -> bool:
    """Whether a body asks for passes that a contact pushes, by what its own drag left."""
    body, ended = dragged(np.eye(3), **values), moving(DRIVEN, TURNED)
    interpreted(make(SPEC))(body, ended, one_row(dt=DT))
    ended.vx += push
    state = SimpleNamespace(
        bodies=several(body), velocities=several(ended), motion=several(moving(START, SPIN))
    )
    return bool(interpreted(make_differs_midway(SPEC))(state, 0, one_row(dt=DT)))


def test_what_a_contact_has_stopped_asks_for_no_pass() -> None:
    body, stopped = dragged(np.eye(3)), moving(np.zeros(3), np.zeros(3))
    state = SimpleNamespace(
        bodies=several(body), velocities=several(stopped), motion=several(moving(START, SPIN))
    )
    assert not interpreted(make_differs_midway(SPEC))(state, 0, one_row(dt=DT))
